"""What the solvers of linear periodic systems refuse: one line that names the argument."""

from dataclasses import replace

import numpy as np
from elastolink.runtime.core.families import Term
from elastolink.runtime.periodic import monodromy, prepare, reduced_system, simulate, steady_state
from periodic_systems import forced_mathieu, system_of, wave
from refusals import each_of, refused

SYSTEM = forced_mathieu()
FREE = SYSTEM.without("p")
STILL = FREE.with_terms(Term("p", None, lambda theta: np.zeros((len(theta), 1))))
BROKEN = FREE.with_terms(
    Term("Kg", None, lambda theta: np.where(theta > 3.0, np.nan, 1.0)[:, None, None])
)
SWINGING_MASS = system_of(M=wave(np.eye(1)), K=np.eye(1))
DAMPED = replace(SYSTEM, limits={"c": "non-negative"})


def prepared(call, speeds=(70.0, 90.0), **options):
    return lambda system: call(prepare(system, speeds, **options))


# What is given where a case does not change it.
GIVEN = {
    monodromy: {"speed": 1.0},
    simulate: {"speed": 2.0, "revolutions": 1.0, "initial": (0.1, 0.0)},
    steady_state: {"speed": 1.0},
    prepare: {"speeds": 80.0},
}
CASES = {
    monodromy: [
        ({"speed": 0.0}, "speed"),
        ({"speed": [1.0, -1.0]}, "speed"),
        ({"speed": np.nan}, "speed"),
        ({"rtol": 1e-20}, "rtol"),
        ({"weight": 3.0}, "weight"),
        ({"mu": np.inf}, "mu"),
        ({"speed": [1.0, 2.0], "mu": [1.0, 2.0, 3.0]}, "broadcast"),
        ({"speed": 1e-7, "c": 0.0}, "speed"),
        ({"system": BROKEN}, r"term Kg \(None\): found a value that is not finite at"),
    ],
    simulate: [
        ({"method": "rk5"}, "method"),
        ({"speed": -3.0}, "speed"),
        ({"speed": np.array([1.0, 2.0])}, "speed"),
        ({"speed": "2"}, "speed"),
        ({"revolutions": 0.0}, "revolutions"),
        ({"revolutions": np.nan}, "revolutions"),
        ({"revolutions": "2"}, "revolutions"),
        ({"revolutions": 1e9}, "revolutions"),
        ({"samples": 0}, "samples"),
        ({"samples": 2.5}, "samples"),
        ({"rtol": 2.0}, "rtol"),
        ({"rtol": "1e-3"}, "rtol"),
        ({"initial": 3.0}, "initial"),
        ({"initial": ([1.0, 2.0], 0.0)}, "initial q"),
        ({"initial": (1.0, np.inf)}, "initial qd"),
        ({"initial": ("a", 0.0)}, "initial q"),
        ({"bound": -1.0}, "bound"),
        ({"start": np.inf}, "start"),
        ({"start": "0"}, "start"),
        ({"system": SWINGING_MASS}, "mass matrix M"),
        ({"system": SYSTEM.without("M")}, "no mass term"),
        ({"system": FREE, "initial": None}, "no forcing acts"),
    ],
    steady_state: [
        ({"method": "harmonics"}, "one of"),
        ({"rtol": 0.0}, "rtol"),
        ({"rtol": "x"}, "rtol"),
        ({"samples": 0}, "samples"),
        ({"samples": "x"}, "samples"),
        ({"samples": np.nan}, "samples"),
        ({"speed": []}, "no speed at all"),
        ({"speed": "x"}, "speed"),
        ({"speed": -1.0}, "positive"),
        ({"speed": np.ones(100), "samples": 2**20}, "take the speeds in parts"),
        ({"stiffness": 2.0}, "parameters"),
        ({"system": STILL}, "forcing that is zero"),
        ({"system": FREE}, "without forcing"),
        ({"system": DAMPED, "method": "harmonic_balance", "c": -0.1}, "c: found"),
    ],
    prepare: [
        ({"speeds": (90.0, 70.0)}, "speeds"),
        ({"speeds": -1.0}, "speeds"),
        ({"speeds": "fast"}, "speeds"),
        ({"samples": 0}, "samples"),
        ({"mu": [1e-3, 2e-3]}, "mu"),
        ({"weight": 1.0}, "weight"),
        ({"system": system_of(M=(None, np.eye(1), 1), K=np.eye(1))}, "power of the speed"),
    ],
    prepared(lambda ready: ready.monodromy(91.0)): [({}, "speed")],
    prepared(lambda ready: ready.monodromy(np.nan), 80.0): [({}, "speed")],
    prepared(lambda ready: ready.simulate([80.0, 81.0], 1, (0, 1))): [({}, "speed")],
    prepared(lambda ready: ready.simulate(80.0, 1.5, (0, 1))): [({}, "revolutions")],
    prepared(lambda ready: ready.simulate(80.0, 1, 1.0)): [({}, "initial")],
    prepared(lambda ready: ready.simulate(80.0, 1, (np.nan, 0.0))): [({}, "initial")],
    prepared(lambda ready: ready.steady_state(80.0), forcing=False): [({}, "steady_state")],
    reduced_system: [({"modes": modes}, "modes") for modes in (0, 10, 2.5, True)],
}


test_bad_input_is_refused_in_one_line = refused(
    lambda call, changes: call(**{"system": SYSTEM, **GIVEN.get(call, {}), **changes}),
    each_of(CASES),
)
