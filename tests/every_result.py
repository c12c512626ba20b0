"""One cheap instance of every class of results."""

from collections.abc import Callable, Iterator
from functools import cache, partial
from importlib import import_module
from inspect import isabstract
from pkgutil import walk_packages

import elastolink as el
import elastolink.runtime as package
import numpy as np
from elastolink.runtime import design, frequencies, nonlinear, recovery, rigid, stability
from elastolink.runtime.core.results import Result
from elastolink.runtime.design import procedure
from elastolink.runtime.gallery import reproduce
from elastolink.runtime.hill import Mathieu
from elastolink.runtime.linkages.base_planes import base_plane
from elastolink.runtime.recovery.beam_result import BeamResult, StationResult
from elastolink.runtime.systems.rod.overhang import OverhangBasis

RPM = np.pi / 30.0
SMITH, BEAMS = "smith_1972_5152_sixteenth_inch", "aannaque_1996_table_4_1"
COSINE = el.PeriodicFunction([0.0, 1.0])
ANGLES = np.linspace(0.0, 6.0, 7)
# Bases of others, of which no instance is made.
BASES = (BeamResult, StationResult)


def result_classes() -> Iterator[type[Result]]:
    """Yield the classes of results of the package."""
    for found in walk_packages(package.__path__, f"{package.__name__}."):
        import_module(found.name)

    def below(kind: type) -> Iterator[type]:
        for child in kind.__subclasses__():
            own = child.__module__.startswith(package.__name__) and child not in BASES
            if own and not isabstract(child):
                yield child
            yield from below(child)

    return below(Result)


@cache
def coupler(modes: int = 1, damping: float = 0.0) -> el.LinearPeriodic:
    system = el.load_scene(SMITH, {"model.modes": modes}).system()
    return system.with_parameters(damping=damping)


@cache
def beams() -> el.LinearPeriodic:
    return el.load_scene(BEAMS, {"mesh.elements": 1}).system()


@cache
def rod(**changes: float) -> el.LinearPeriodic:
    return el.load_scene("beale_1992_flexible_rod", {**changes}).system()


@cache
def free_rod() -> el.Constrained:
    changes = {"model.formulation": "free_free", "model.modes": 2}
    return el.load_scene("beale_1992_flexible_rod", changes).system()


def four_bar() -> el.FourBar:
    return el.FourBar(12.0, 6.0, 12.0, 12.0)


def machine() -> el.Machine:
    return el.load_scene("smith_1972_12_6_12_12").machine()


def duffing(damping: float = 0.05) -> el.Nonlinear:
    from planted import duffing as planted

    return planted(damping)


@cache
def made(kind: str) -> Result:
    """Return the instance of a class, by its name."""
    return MAKERS[kind]()


def _tongue() -> Result:
    resonance, *_ = stability.resonances(coupler(), (700 * RPM, 800 * RPM))
    return stability.tongue(coupler(), resonance)


def _identified() -> Result:
    edges = el.stability_edges(coupler(), (60.0, 90.0))
    points = [
        design.Point(kind, float(speed))
        for ends in zip(edges.lower, edges.upper, strict=True)
        for kind, speed in zip(("unstable from", "unstable to"), ends, strict=True)
    ]
    return design.identify(coupler(), points, ["bending_stiffness"])


def _basins() -> Result:
    motions = made("CoexistingMotions").motions
    return nonlinear.basins(duffing(0.2), 1.2, motions[:1], [-0.5, 0.5], [-0.5, 0.5])


def _special_curve() -> Result:
    return nonlinear.special_curve(made("ResponseCurve"), 0, "force", (0.8, 1.2))


def _consistent() -> Result:
    orbit = made("PeriodicOrbit")
    return el.consistent_state(free_rod(), orbit.q[:2], orbit.qd[:2], orbit.t[:2])


def _marched() -> Result:
    orbit = made("PeriodicOrbit")
    return el.constrained_motion(
        free_rod(), orbit.q[0], orbit.qd[0], 0.2 * orbit.period, rtol=1e-6, samples=9
    )


def _fatigue() -> Result:
    steel = el.Material(tensile_strength=600e6, endurance_limit=200e6, exponent=9.0, knee=1e6)
    return el.fatigue(made("StressResult"), steel)


MAKERS: dict[str, Callable[[], Result]] = {
    # Linkages.
    "FourBarMotion": lambda: four_bar().motion(ANGLES),
    "SliderCrankMotion": lambda: el.SliderCrank(crank=0.1, coupler=0.3).motion(ANGLES),
    "QuickReturnMotion": lambda: el.QuickReturn(frame=0.3, crank=0.1, rod=0.6).motion(ANGLES),
    "TransmissionAngle": lambda: el.transmission_angle(four_bar()),
    "MechanicalAdvantage": lambda: made("TransmissionAngle").mechanical_advantage(ANGLES),
    "Classification": lambda: el.classify(four_bar()),
    "SlidingClassification": lambda: el.classify(el.SliderCrank(crank=0.1, coupler=0.3)),
    "BasePlane": lambda: base_plane(3.0, 21),
    "CouplerCurve": lambda: el.coupler_curve(four_bar(), 6.0, 4.0, points=90),
    "ClearanceRange": lambda: el.clearance_range(four_bar(), 0.01, ANGLES),
    "Mobility": lambda: el.mobility([("a", "b"), ("b", "c"), ("c", "d"), ("d", "a")]),
    "Harmonics": lambda: el.harmonics(lambda theta: np.cos(theta) ** 3),
    # Rigid machines.
    "RigidForces": lambda: el.rigid_forces(machine(), ANGLES, 10.0),
    "Balancing": lambda: el.balance(
        machine(), 10.0, weights={"torque": 1.0, "shaking_force": 1.0}, angles=ANGLES
    ),
    "TradeOff": lambda: el.trade_off(machine(), 10.0, points=3, angles=ANGLES),
    "TorqueFluctuation": lambda: rigid.torque_fluctuation(machine(), 10.0),
    "Flywheel": lambda: el.flywheel_inertia(machine(), 10.0),
    "RunUp": lambda: el.run_up(machine(), 2.0, revolutions=1.0, speed0=5.0, samples=21),
    # Hill's equation.
    "HalfTrace": lambda: el.discriminant(COSINE, np.linspace(0.1, 2.0, 9), 0.3),
    "Boundaries": lambda: el.hill_boundaries(COSINE, [0.1, 0.2, 0.3]),
    "PerturbationBoundaries": lambda: el.perturbation_boundaries(COSINE, [0.1, 0.2], order=2),
    "CertifiedBoundaries": lambda: el.hill_boundaries(COSINE, [0.1, 0.2], certified=True),
    "BoundarySeries": lambda: el.boundary_series(COSINE, 1, order=3),
    "BoundarySolution": lambda: el.boundary_solution(COSINE, 0.3, 1),
    "CharacteristicExponents": lambda: el.characteristic_exponents(
        COSINE, np.linspace(0.1, 2.0, 9), 0.3
    ),
    "MathieuCharacteristic": lambda: Mathieu.characteristic(2, np.linspace(0.0, 3.0, 5)),
    "Thresholds": lambda: el.critical_damping(COSINE, [0.2, 0.4]),
    # Linear periodic systems.
    "Monodromy": lambda: el.monodromy(coupler(2), [30.0, 40.0]),
    "FloquetMultipliers": lambda: el.floquet_multipliers(coupler(2), [30.0, 40.0]),
    "SteadyState": lambda: el.steady_state(coupler(2, 0.5), [30.0, 32.0], samples=16),
    "Trajectory": lambda: el.simulate(coupler(2), 30.0, 1.0, samples=16),
    "ResonanceCurve": lambda: el.resonance_curve(
        coupler(2, 0.5), np.linspace(30.0, 40.0, 9), x=0.5
    ),
    "SpeedBoundaries": lambda: el.speed_boundaries(coupler(), speed_range=(60.0, 90.0)),
    "StabilityEdges": lambda: el.stability_edges(coupler(), (60.0, 90.0)),
    "StabilityChart": lambda: el.stability_chart(
        coupler(), ("speed", np.linspace(60.0, 90.0, 9)), ("damping", [0.0, 0.5, 1.0])
    ),
    "TongueCurves": lambda: stability.tongue_curves(
        rod(), "crank_ratio", [0.02, 0.05], (1600.0, 1900.0), highest=1
    ),
    "Tongue": _tongue,
    "Sweep": lambda: el.sweep(
        "floquet_multipliers", coupler(), {"speed": [30.0, 40.0, 50.0], "damping": [0.0, 1.0]}
    ),
    # Beams.
    "NaturalFrequencies": lambda: el.natural_frequencies(beams(), ANGLES, count=3),
    "FrameFrequencies": lambda: el.wittrick_williams(
        el.dynamic_stiffness(beams().structure), count=3
    ),
    "LinkFrequencies": lambda: frequencies.link_frequencies(
        beams(), "coupler", "length", [0.4, 0.5]
    ),
    "CriticalSpeeds": lambda: el.critical_speeds(beams(), (30.0, 70.0)),
    "Campbell": lambda: el.campbell(beams(), np.linspace(30.0, 40.0, 4), modes=1),
    "BeamForces": lambda: el.recover(beams(), 20.0, stations=3),
    "StressResult": lambda: el.stress(beams(), 20.0, stations=3),
    "ElasticCurve": lambda: recovery.elastic_coupler_curve(beams(), 20.0),
    "PinReactions": lambda: el.pin_reactions(beams(), 20.0),
    "BeamEnergies": lambda: recovery.beam_energies(beams(), 20.0),
    "StressCurve": lambda: el.stress_curve(beams(), [20.0, 25.0, 30.0], whole=False),
    # Constrained and nonlinear systems.
    "PeriodicOrbit": lambda: el.periodic_orbit(free_rod()),
    "ConstrainedMultipliers": lambda: el.orbit_multipliers(made("PeriodicOrbit")),
    "ConsistentState": _consistent,
    "ConstrainedMotion": _marched,
    "OverhangFrequencies": lambda: OverhangBasis(2).frequencies(
        [0.4, 0.5], length=0.3, bending_stiffness=1.0, mass_per_length=1.0
    ),
    "ResponseCurve": lambda: el.response_curve(duffing(), "speed", (0.8, 1.6)),
    "SpecialCurve": _special_curve,
    "CoexistingMotions": lambda: nonlinear.coexisting_motions(
        duffing(0.2), "speed", 1.2, largest=5.0
    ),
    "SweepResponse": lambda: el.sweep_response(duffing(), (1.0, 1.1), 5e-3),
    "Basins": _basins,
    "AmplitudeLaw": lambda: nonlinear.amplitude_law(
        el.load_scene(SMITH, {"model.formulation": "inextensible"}), ANGLES
    ),
    # Design.
    "Sensitivities": lambda: design.sensitivities(
        coupler(), el.floquet_multipliers(coupler(), 40.0), ["bending_stiffness"]
    ),
    "Margins": lambda: design.margins(el.load_scene(SMITH), 765.0 * RPM, ["links.coupler"]),
    "Diagnosis": lambda: design.diagnose(el.load_scene(SMITH), 765.0 * RPM),
    "ClosingDamping": lambda: design.closing_damping(
        coupler(), el.stability_edges(coupler(), (75.0, 85.0))
    ),
    "Certificate": lambda: design.certify(coupler(1, 0.3), (300.0 * RPM, 302.0 * RPM)),
    "Stabilisation": lambda: design.stabilise(
        el.load_scene(SMITH), (740.0 * RPM, 780.0 * RPM), ["coupler.damping"]
    ),
    "StressEffect": lambda: procedure.effect_of(
        beams(), "damping_ratio", np.array([0.02, 0.06]), [20.0, 25.0], 1e-3
    ),
    "Fatigue": _fatigue,
    "Identification": _identified,
    "QuietSpeeds": lambda: el.quiet_speeds(beams(), [28.0, 29.0, 30.0], 200e6),
    "RunningSpeed": lambda: el.running_speed(
        beams(), np.linspace(28.0, 36.0, 12), 200e6, values=[0.547], rtol=1e-2
    ),
    "Transient": lambda: el.run_through(
        beams(), el.SpeedProfile(times=(0.0, 0.05), speeds=(20.0, 22.0)), modes=2, stations=3
    ),
    "ToleranceBands": lambda: design.tolerance_bands(
        el.load_scene("smith_1972_12_6_12_12", {"links.coupler": "12 in +- 0.1 mm"}),
        "forces",
        ANGLES,
        trials=4,
        samples=200,
    ),
    # What commands return.
    "Explanation": lambda: el.explain(SMITH),
    "Gallery": partial(reproduce, "aannaque", "table_5.1"),
}
