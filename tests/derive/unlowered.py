"""Exact values of emitted functions from their derived expressions before any lowering.

That these expressions are right is proved elsewhere, symbolically or against mechanics by hand;
here is what the digits of the emitted functions are judged by, and at which points.
"""

import importlib
from collections.abc import Iterator
from contextlib import ExitStack
from functools import cache
from unittest import mock

import mpmath
import numpy as np
import sympy as sp
from derivations import model_of, system_of
from elastolink import generated
from elastolink.derive import entries, lowering, separation
from elastolink.derive.pipeline import lower
from elastolink.derive.spec import ModelSpec
from free_free_truth import MODES_MODULE, mode_points
from judging import Exact, Point, Reference, exact_at, reference_of
from linkage_truth import nasty_points, random_points
from meissner_truth import meissner_points
from overhang_truth import overhang_points
from sliding_truth import nasty_rods, random_rods

SANDWICH, ROD_POLYNOMIALS = "beam_section_sandwich", "quick_return_rod_polynomials"
MOVING_ROD = "quick_return_rod_moving_basis"
MODES = (*range(1, 13), 30, 59, 60)
OVERHANG, MEISSNER = "quick_return_overhang_modes", "hill_meissner"
PREFIXES = ("beam_element_", "beam_shapes_", SANDWICH, ROD_POLYNOMIALS, MOVING_ROD)
SENSITIVITIES, CLEARANCE = "four_bar_sensitivities", "four_bar_clearance"
HARMONICS = "beam_tangent_harmonics"
LAW, CUBIC = "beam_amplitude_law", "_coupler_inextensible_cubic_"
PREFIXES += (OVERHANG, MEISSNER, MODES_MODULE, SENSITIVITIES, CLEARANCE, HARMONICS, LAW)
PREFIXES += tuple(f"{mechanism}{CUBIC}" for mechanism in ("four_bar", "slider_crank"))


def judged_unlowered(module: str, function: str) -> bool:
    """Return True where the points of a function are those of this file."""
    modal = function in ("modal_matrices", "modal_vectors", "scales")
    return modal or module.startswith(PREFIXES) or module.endswith("_multibody")


@cache
def references(module: str) -> dict[str, Reference]:
    """Return the functions of a packaged module in many digits, before their lowering."""
    emitted = importlib.import_module(f"{generated.__name__}.{module}")
    spec = ModelSpec.from_mapping(eval(emitted.SPEC, {"null": None}))
    found: dict[str, Reference] = {}
    plain = lowering.lower_kernel

    def kept(name, summary, arguments, steps, outputs):
        values = [sp.sympify(e) for _, e in outputs]
        free = {s.name: s for e in (*values, *dict(steps.steps).values()) for s in e.free_symbols}
        inputs = [free.get(a.name, sp.Symbol(a.name)) for a in arguments]
        names = [result.name for result, _ in outputs]
        found[name] = reference_of(inputs, list(zip(names, values, strict=True)), steps)
        return plain(name, summary, arguments, steps, outputs)

    with ExitStack() as stack:
        for module_ in (lowering, entries, separation):
            stack.enter_context(mock.patch.object(module_, "lower_kernel", kept))
        lower(spec, system_of(spec), model_of(spec).describe(spec))
    return found


@cache
def exact_unlowered(module: str, function: str) -> tuple[Exact, ...]:
    """Return the exact values of one emitted function at random and nasty points."""
    reference = references(module)[function]

    def chopped(numbers):
        """What cancels exactly leaves some 1e-80 of its terms: zero."""
        return {k: mpmath.chop(v, mpmath.mpf(10) ** -65) for k, v in reference(numbers).items()}

    of_beams = module.startswith(("beam_", ROD_POLYNOMIALS))
    wanted = chopped if of_beams else reference
    return tuple(exact_at(wanted, point) for point in _points(module, function))


def _points(module: str, function: str) -> Iterator[Point]:
    emitted = getattr(importlib.import_module(f"{generated.__name__}.{module}"), function)
    names = emitted.__code__.co_varnames[: emitted.__code__.co_argcount]
    of_function = {
        OVERHANG: overhang_points,
        MEISSNER: meissner_points,
        MODES_MODULE: mode_points,
        ROD_POLYNOMIALS: _polynomial_points,
    }
    if module in of_function:
        return of_function[module](function)
    if module == SENSITIVITIES:
        points = random_points(60, seed=27) + nasty_points()[::3]
        # Some are in proportion to the angle, which then has no digits that could be kept.
        return (p for p in points if not 0 < abs(p.inputs["theta2"]) < 1e-100)
    if module == CLEARANCE:
        return _clearance_points()
    if module == HARMONICS:
        return (Point(f"harmonic {n}", {}, {"n": float(n)}) for n in MODES)
    if module == LAW:
        return _law_points()
    if CUBIC in module:
        return _bent_points(names)
    if module.startswith("beam_element_"):
        return _element_points(names)
    if module.startswith("beam_shapes_"):
        return _shape_points(module, names)
    if module.endswith("_multibody"):
        return _state_points(names)
    if function == "basis_products":
        return _vector_points()
    if function in ("modal_matrices", "modal_vectors"):
        return _mode_points(names)
    if "theta2" in names:
        return _rod_points(names)
    return _random_points(names, 200 if function == "scales" else 40)


def _draw(random, names, low=-6, high=6, signs=(1.0,)):
    return {n: float(random.choice(signs) * 10.0 ** random.uniform(low, high)) for n in names}


def _random_points(names, count) -> Iterator[Point]:
    random = np.random.default_rng(601)
    for i in range(count):
        yield Point(f"random {i}", _draw(random, names))
    if "core_loss" in names:
        for loss in (0.0, 1e-9):
            yield Point(f"loss {loss:g}", {**_draw(random, names, -1, 1), "core_loss": loss})


def _clearance_points() -> Iterator[Point]:
    """Yield plays from 1e-12 to half of a link."""
    for i, point in enumerate(random_points(200, seed=28) + nasty_points()):
        share = (1e-12, 1e-6, 1e-3, 1e-2, 0.1, 0.5)[i % 6]
        inputs = {name: point.inputs[name] for name in ("theta2", "frame", "crank")}
        links = {"turning": point.inputs["follower"], "opposite": point.inputs["coupler"]}
        play = {"play": share * min(links.values())}
        yield Point(f"{point.name}, play {share:g}", {**inputs, **links, **play})


def _law_points() -> Iterator[Point]:
    """Yield transmission angles down to a hundredth, modes up to the tenth."""
    random = np.random.default_rng(611)
    for i in range(40):
        mode, other = random.choice(np.arange(1, 11), 2, replace=False)
        angle = random.choice([0.01, 0.1, 1.0, 0.5 * np.pi, 2.5]) * random.uniform(0.9, 1.1)
        inputs = {"transmission_angle": float(angle), "driven_mass": 10.0 ** random.uniform(-4, 4)}
        yield Point(f"random {i}", inputs, {"mode": float(mode), "other": float(other)})


def _bent_points(names) -> Iterator[Point]:
    """Yield couplers of linkages that close, bent by up to half a radian."""
    random = np.random.default_rng(612)
    size = {"theta_d1": 50.0, "theta_d2": 1e3, "gravity_x": 9.8, "gravity_y": 9.8, "bow": 0.1}
    positive = {"bending_stiffness", "mass_per_length", "damping", "follower_inertia"}
    lengths = ("frame", "crank", "coupler", "follower") if "frame" in names else ()
    for i in range(12):
        crank = 10.0 ** random.uniform(-2, 0)
        inputs = {"theta": random.uniform(-3.0, 3.0), "crank": crank}
        inputs |= {"coupler": crank * random.uniform(3.0, 6.0)}
        inputs |= {name: crank * random.uniform(3.0, 6.0) for name in lengths if name != "crank"}
        if "frame" in names:  # the shortest link turns by Grashof's rule
            inputs["follower"] = inputs["coupler"] * random.uniform(0.6, 0.9)
            inputs["frame"] = inputs["coupler"] * random.uniform(0.95, 1.05)
        else:
            inputs["offset"] = crank * random.uniform(-0.5, 0.5)
        for name in names:
            if name in inputs or name in ("t", "assembly"):
                continue
            scale = size.get(name, 50.0 if name.endswith("dot") else 0.5)
            sign = 1.0 if name in positive or name.endswith("mass") else random.choice((-1.0, 1.0))
            inputs[name] = float(sign * scale * 10.0 ** random.uniform(-1, 0))
        yield Point(f"random {i}", inputs, {"t": 0.0, "assembly": float(random.choice((-1, 1)))})


def _element_points(names) -> Iterator[Point]:
    yield from _random_points(names, 25)
    random = np.random.default_rng(604)
    # Ratios of bending and shear at which an entry changes its sign, and the two limits.
    for ratio in (1 / 6, 1 / 60, 0.0833, 1e-12, 1e12) if "shear_stiffness" in names else ():
        inputs = _draw(random, names, -1, 1)
        inputs["shear_stiffness"] = inputs["bending_stiffness"] / (ratio * inputs["length"] ** 2)
        yield Point(f"shear ratio {ratio:.3g}", inputs)


def _shape_points(module, names) -> Iterator[Point]:
    """Yield nodes, a hair's breadth from them, where shapes change sign, and random places."""
    random = np.random.default_rng(602)
    places = [0.0, 1.0, 0.5, 1e-9, 1.0 - 2.0**-40, 0.5 + 2.0**-40, *_roots(module)]
    for place in (*places, *random.uniform(0.0, 1.0, 15)):
        yield Point(f"xi = {place:.6g}", {**_draw(random, names), "xi": float(place)})


def _roots(module: str) -> list[float]:
    """Return where shapes of a beam without shear change their sign inside."""
    space = importlib.import_module(f"{generated.__name__}.{module}")
    xi, more = np.linspace(0.0, 1.0, 4001), {}
    if module.endswith("timoshenko"):
        more = {"bending_stiffness": 1e-12, "shear_stiffness": 1.0}
    found = set()
    for values in space.shapes(xi + 1e-5, 1.0, **more):
        at = np.broadcast_to(values, xi.shape)
        steps = np.flatnonzero(at[:-1] * at[1:] < 0.0)
        shares = at[steps] / (at[steps] - at[steps + 1])
        found |= {round(float(x), 6) for x in xi[steps] + 1e-5 + shares * (xi[1] - xi[0])}
    return sorted(found)


def _state_points(names) -> Iterator[Point]:
    """Yield coordinates of any size, joints open."""
    random = np.random.default_rng(41)
    for i in range(12):
        inputs = _draw(random, [n for n in names if n != "t"], -2, 2, (-1.0, 1.0))
        yield Point(f"random state {i}", inputs, {"t": 0.0})


def _mode_points(names) -> Iterator[Point]:
    for m in MODES:
        for n in MODES if "n" in names else (0,):
            yield Point(f"modes {m}, {n}", {}, {"m": float(m), "n": float(n)})


def _rod_points(names) -> Iterator[Point]:
    """Yield rods that just reach the block, or are longer."""
    random = np.random.default_rng(41)
    for p in random_rods(60, 44) + nasty_rods():
        reach = p.inputs["frame"] + p.inputs["crank"]
        more = {"length": reach * random.choice([1, 3])} if "length" in names else {}
        yield Point(p.name, {**p.inputs, **more}, p.fixed)


def _vector_points() -> Iterator[Point]:
    """Yield random integrals, those of nearly rigid shapes among them."""
    random = np.random.default_rng(42)
    for i in range(200):
        mean = random.standard_normal(2)
        # The moment is half the mean of even shapes, 2/3 of it for those that turn about the pin.
        moment = mean * random.choice([0.5, 2 / 3, 0.75, 1.5], 2)
        moment += random.choice([0.0, 1e-15, 1e-8, 1.0]) * random.standard_normal(2)
        values = dict(zip(("mean_row", "mean_column"), mean.tolist(), strict=True))
        values |= dict(zip(("moment_row", "moment_column"), moment.tolist(), strict=True))
        yield Point(f"random integrals {i}", values)


def _polynomial_points(function: str) -> Iterator[Point]:
    random = np.random.default_rng(91)
    letter = "p" if function.startswith("through") else "j"
    places = [("pin or block", 0.0, 0.6), ("other end", 1.0, 0.6), ("near it", 1 - 2.0**-40, 0.6)]
    for i in range(40):
        u, v = random.uniform(0.0, 1.0, 2) if i % 2 else 10.0 ** random.uniform(-9, 0, 2)
        places.append((f"random {i}", float(u), float(v)))
    if letter == "j":
        places += [
            (f"a change of sign, {s:.3f}", s, 0.37) for s in (1 / 3, 0.4, 2 / 3, 0.75, 4 / 7)
        ]
    for name, s, length in places:
        size = random.normal(size=4) * np.array([1.0, 10.0, 1e3, 1e5])
        values = dict(zip((letter, *(f"{letter}_d{k}" for k in (1, 2, 3))), size, strict=True))
        at = {"s": s, "length": length}
        if function == "through_bay":
            at = {"eta": s * length, "gap": -length * (1.0 - s)}
        elif function == "through_tail":
            at = {"gap": s * (1.0 - length), "xi": length}
        yield Point(name, {**at, **{key: float(value) for key, value in values.items()}})
