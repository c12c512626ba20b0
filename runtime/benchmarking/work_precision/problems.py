"""Problems: a trajectory, a monodromy matrix, a steady state or a chart of each system."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from importlib.util import find_spec
from typing import Any

import numpy as np

from ...charts import stability_chart
from ...charts.invariants import characteristic
from ...core.families import LinearPeriodic
from ...floquet import monodromy
from ...floquet.first_order import CanonicalForm, canonical_form, even_angles
from ...floquet.period_products import ordered_product
from ...integrators import METHODS, SECOND_ORDER
from ...prepared import Prepared, prepare
from ...response import steady_state
from ...simulation import simulate
from . import reference
from .equation import Array, Equation
from .method import Method, Problem, Work
from .peers import PEERS, Solve, absence, settings_of
from .systems import Case, case

# Angles of a revolution at which motions are compared.
_EACH = 32
_RTOL = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
STEADY = ("cyclic", "harmonic_balance", "shooting")
# Phase of the highest mode in a fixed step [rad].
_PHASES = (2.0, 1.0, 0.5, 0.25, 0.125, 0.0625)
# What extended precision leaves, and doubles where the equation is stiff.
_DIGITS, _STIFF_DIGITS = 1e-16, 1e-11
_STIFF = 300.0
# Speeds that a system is prepared for, from one over this to this times its own.
_NEAR = 2.0**0.5
# Points of a chart that peers solve.
_SAMPLE = 4


def trajectory(name: str, peers: Iterable[str], methods: Iterable[str] | None) -> Problem:
    """Return the problem of a motion from a deflection, or from rest under the forcing."""
    own = case(name)
    forced = own.deflection == 0.0
    equation = own.equation(forced=forced)
    angles = _even(2.0 * np.pi * own.turns, own.turns * _EACH)
    start = equation.start(own.start, np.zeros(own.system.size))
    truth, digits = _motion(equation, start, own.turns)

    march = partial(
        simulate,
        own.system,
        own.speed,
        own.turns,
        initial=(own.start, 0.0),
        samples=_EACH,
        forcing=forced,
    )

    def run(method: str, steps: float) -> Work:
        return partial(march, method=method, steps=int(steps))

    # All angles are ends of steps.
    counts = {_EACH * max(1.0, float(round(s / _EACH))): None for s in _step_counts(equation.rate)}
    ours = [
        Method(f"simulate, {method}", partial(run, method), tuple(counts), ours=True)
        for method in _marching(methods)
    ]

    def wanted(rtol: float) -> Work:
        return partial(march, rtol=rtol)

    if _wanted(methods, "simulate"):
        ours.append(Method("simulate", wanted, _RTOL, ours=True))
    if _wanted(methods, "prepared"):
        ours += _prepared(
            own, lambda ready: ready.simulate(own.speed, own.turns, (own.start, 0.0)), forced=forced
        )
    others, absent = _peers(peers, equation, start[:, None], angles, "heyoka batch")

    def error(found: Any) -> float:
        q = found.q if hasattr(found, "q") else equation.coordinates(found[:, :, 0])
        return _relative(q, truth)

    title = f"{own.turns} revolutions, {own.title}"
    return Problem(f"{name}-trajectory", title, error, digits, (*ours, *others), absent)


def _motion(equation: Equation, start: Array, turns: int) -> tuple[Array, float]:
    if equation.rate < _STIFF:
        states = reference.motion(equation, start, turns, _EACH).astype(float)
        return equation.coordinates(states), _DIGITS
    fine, coarse = (_doubles(equation, phase) for phase in (0.5, 0.8))
    found, other = (equation.coordinates(flows @ start) for flows in (fine, coarse))
    return found, max(_relative(other, found), _STIFF_DIGITS)


def _doubles(equation: Equation, phase: float) -> Array:
    """Return the flows over a period of a stiff equation in doubles, by Gauss's order 16."""
    from ...integrators.gauss_legendre import gauss_maps

    inner = int(np.ceil(2.0 * np.pi * equation.rate / (phase * _EACH)))
    h = equation.period / (_EACH * inner)
    flow = np.eye(equation.states)
    found = [flow]
    for k in range(_EACH):
        theta = k * inner * h + even_angles(inner * h, inner)
        maps = gauss_maps(8, lambda t: equation.form.generator(t)[0], theta, h)
        product, power = ordered_product(maps[None])
        flow = np.ldexp(product[0], int(power[0])) @ flow
        found.append(flow)
    return np.stack(found)


def matrix(name: str, peers: Iterable[str], methods: Iterable[str] | None) -> Problem:
    """Return the problem of a monodromy matrix at one speed."""
    own = case(name)
    equation = own.equation(forced=False)
    truth, digits = _matrix(equation)
    form = canonical_form(own.system, own.speed, forcing=False)

    def wanted(rtol: float) -> Work:
        return partial(monodromy, own.system, own.speed, rtol=rtol)

    ours = [Method("monodromy", wanted, _RTOL, ours=True)] if _wanted(methods, "monodromy") else []
    ours += [
        Method(f"{m}, fixed steps", partial(_fixed, form, m), _step_counts(equation.rate), True)
        for m in _stepping(methods)
    ]
    if _wanted(methods, "prepared"):
        ours += _prepared(own, lambda ready: ready.monodromy(own.speed))
    ends = np.array([0.0, equation.period])
    others, absent = _peers(peers, equation, np.eye(equation.states), ends, "heyoka")
    scale = equation.scale

    def error(found: Any) -> float:
        if hasattr(found, "matrix"):
            value = np.ldexp(found.matrix, int(found.exponent)) / scale[:, None] * scale
        else:
            value = found if found.ndim == 2 else found[-1]
        return float(np.max(np.abs(value - truth)) / np.max(np.abs(truth)))

    title = f"monodromy matrix, {own.title}"
    return Problem(f"{name}-monodromy", title, error, digits, (*ours, *others), absent)


def _matrix(equation: Equation) -> tuple[Array, float]:
    if equation.rate < _STIFF:
        return reference.flows(equation, 1.0, 1)[-1].astype(float), _DIGITS
    fine, coarse = (_doubles(equation, phase)[-1] for phase in (0.5, 0.8))
    gap = float(np.max(np.abs(fine - coarse)) / np.max(np.abs(fine)))
    return fine, max(gap, _STIFF_DIGITS)


def _fixed(form: CanonicalForm, name: str, steps: float) -> Work:
    method, period = METHODS[name], form.system.period
    number = max(1, round(steps * period / (2.0 * np.pi)))

    def work() -> Array:
        theta = even_angles(period, number)
        maps = method.maps(lambda t: form.generator(t)[0], theta, period / number)
        product, power = ordered_product(maps[None])
        found: Array = np.ldexp(product[0], int(power[0]))
        return found

    return work


def steady(name: str, peers: Iterable[str], methods: Iterable[str] | None) -> Problem:
    """Return the problem of the periodic motion at one speed."""
    own = case(name)
    equation = own.equation(forced=True)
    truth, digits = _periodic(equation)

    def run(method: str, rtol: float) -> Work:
        return partial(
            steady_state, own.system, own.speed, method=method, rtol=rtol, stability=False,
            samples=_EACH,
        )  # fmt: skip

    ours = [
        Method(f"steady_state, {m}", partial(run, m), _RTOL, ours=True)
        for m in STEADY
        # Shooting follows the fastest mode: minutes where the system is stiff.
        if _wanted(methods, m) and (m != "shooting" or equation.rate < _STIFF)
    ]
    if _wanted(methods, "prepared"):
        ours += _prepared(
            own, lambda ready: ready.steady_state(own.speed, stability=False), forced=True
        )
    angles = _even(equation.period, _EACH)
    others, absent = _peers(peers, equation, np.eye(equation.states), angles, "heyoka", _shot)

    def error(found: Any) -> float:
        if not hasattr(found, "q"):
            return _relative(equation.coordinates(found), truth)
        q = found.q.reshape(-1, found.q.shape[-1])
        return _relative(q[:: len(q) // _EACH], truth)

    title = f"periodic motion, {own.title}"
    return Problem(f"{name}-steady", title, error, digits, (*ours, *others), absent)


def _shot(solve: Solve, start: Array, angles: Array) -> Work:
    """Return shooting by a peer: the matrix over the period, then the start that repeats."""

    def work() -> Array:
        flows = solve(start, angles)
        m = start.shape[1] - 1
        whole = flows[-1]
        first = np.linalg.solve(np.eye(m) - whole[:m, :m], whole[:m, m])
        found: Array = flows[:-1] @ np.append(first, 1.0)
        return found

    return work


def _periodic(equation: Equation) -> tuple[Array, float]:
    if equation.rate < _STIFF:
        return equation.coordinates(reference.periodic(equation, _EACH).astype(float)), _DIGITS
    found = []
    m = equation.states - 1
    for phase in (0.5, 0.8):
        flows = _doubles(equation, phase)
        first = np.linalg.solve(np.eye(m) - flows[-1, :m, :m], flows[-1, :m, m])
        found.append(equation.coordinates(flows[:-1] @ np.append(first, 1.0)))
    return found[0], max(_relative(found[1], found[0]), _STIFF_DIGITS)


def chart(name: str, peers: Iterable[str], methods: Iterable[str] | None) -> Problem:
    """Return the problem of a stability chart; peers solve a sample of its points."""
    own = case(name)
    if own.chart is None:
        raise KeyError(name)
    values = [(axis[0], np.linspace(*axis[1:])) for axis in own.chart]
    rng = np.random.default_rng(7)
    columns, rows = (rng.integers(0, axis[3], _SAMPLE) for axis in own.chart)
    equations = [
        _at(own, {axis[0]: float(axis[1][k]) for axis, k in zip(values, pair, strict=True)})
        for pair in zip(columns, rows, strict=True)
    ]
    truth = np.stack([characteristic(_matrix(e)[0][None], reduced=True)[0] for e in equations])
    share = _SAMPLE / (own.chart[0][3] * own.chart[1][3])

    def error(found: Any) -> float:
        if hasattr(found, "invariants"):
            value = found.invariants[rows, columns]
            # Of Hill's equation a chart keeps half the trace.
            value = -2.0 * value if own.system.size == 1 else value
        else:
            value = characteristic(found, reduced=True)
        size = np.maximum(1.0, np.max(np.abs(truth), axis=-1, keepdims=True))
        return float(np.max(np.abs(value - truth) / size))

    def ours(_: float) -> Work:
        return partial(stability_chart, own.system, *values)

    def many(peer: str) -> Method:
        def prepare(setting: float) -> Work:
            solves = [PEERS[peer](e, setting) for e in equations]
            unit, ends = np.eye(equations[0].states), np.array([0.0, equations[0].period])
            return lambda: np.stack([s(unit, ends)[-1] for s in solves if s is not None])

        return Method(peer, prepare, settings_of(peer, equations[0]), share=share)

    reasons = {peer: absence(peer, equations[0]) for peer in peers if peer != "heyoka"}
    absent = tuple(f"{peer}: {reason}" for peer, reason in reasons.items() if reason)
    others = [many(peer) for peer, reason in reasons.items() if not reason]
    size = " x ".join(f"{axis[3]} values of {axis[0]}" for axis in own.chart)
    title = f"stability over {size}, {own.title}"
    first = Method("stability_chart", ours, (0.0,), ours=True)
    return Problem(f"{name}-chart", title, error, _DIGITS, (first, *others), absent)


def _at(own: Case, values: dict[str, float]) -> Equation:
    """Return the equation at a point of a chart."""
    speed = values.pop("speed", own.speed)
    geometry = {k: v for k, v in values.items() if k in own.system.geometry}
    system: LinearPeriodic = own.system.with_geometry(**geometry) if geometry else own.system
    rest = {k: v for k, v in values.items() if k not in geometry}
    if rest:
        system = system.with_parameters(**rest)
    return Equation.of(system, speed, forced=False)


def _prepared(own: Case, work: Callable[[Prepared], Any], *, forced: bool = False) -> list[Method]:
    """Return the prepared system as a method, for a range of 2 to 1; for one speed where stiff."""
    near = (
        (own.speed / _NEAR, own.speed * _NEAR)
        if own.equation(forced=False).rate < _STIFF
        else own.speed
    )

    def prepare_for(compiled: bool, _: float) -> Work:
        ready = prepare(own.system, near, samples=_EACH, forcing=forced, compiled=compiled)
        return lambda: work(ready)

    found = [Method("prepared", partial(prepare_for, False), (0.0,), ours=True)]
    if find_spec("numba") is not None:
        found.append(Method("prepared, compiled", partial(prepare_for, True), (0.0,), ours=True))
    return found


def _peers(
    wanted: Iterable[str],
    equation: Equation,
    start: Array,
    angles: Array,
    unsuited: str,
    task: Callable[[Solve, Array, Array], Work] | None = None,
) -> tuple[list[Method], tuple[str, ...]]:
    """Return the peers as methods, and why some are left out."""
    made, absent = [], []
    for peer in wanted:
        if peer == unsuited:
            continue
        if reason := absence(peer, equation):
            absent.append(f"{peer}: {reason}")
            continue

        def prepare(setting: float, peer: str = peer) -> Work:
            own = PEERS[peer](equation, setting)
            assert own is not None
            if task is not None:
                return task(own, start, angles)
            return lambda: own(start, angles)

        made.append(Method(peer, prepare, settings_of(peer, equation)))
    return made, tuple(absent)


def _even(length: float, count: int) -> Array:
    """Return even angles with the end."""
    return np.linspace(0.0, length, count + 1, dtype=np.float64)


def _wanted(methods: Iterable[str] | None, name: str) -> bool:
    """Return whether a method is wanted: all are where none are named."""
    return methods is None or name in set(methods)


def _relative(found: Array, truth: Array) -> float:
    if len(found) < len(truth):
        return float("inf")
    return float(np.max(np.abs(found - truth)) / np.max(np.abs(truth)))


def _step_counts(rate: float) -> tuple[float, ...]:
    return tuple(2.0 * np.pi * rate / phase for phase in _PHASES)


def _stepping(methods: Iterable[str] | None) -> list[str]:
    """Return the one-step methods on the canonical state that are wanted."""
    own = [name for name in METHODS if name != "de_vogelaere"]
    return own if methods is None else [name for name in own if name in set(methods)]


def _marching(methods: Iterable[str] | None) -> list[str]:
    """Return the methods with fixed steps of ``simulate`` that are wanted."""
    return [name for name in (*METHODS, *SECOND_ORDER) if _wanted(methods, name)]


TASKS: dict[str, Callable[[str, Iterable[str], Iterable[str] | None], Problem]] = {
    "trajectory": trajectory,
    "monodromy": matrix,
    "steady": steady,
    "chart": chart,
}
