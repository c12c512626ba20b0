"""The error of every emitted function, measured against 80 digits.

After a change of a model or of the lowering:  python tests/derive/emitted_accuracy.py
writes docs/accuracy.md, a line a module;  with --table  it prints every output instead.
"""

from __future__ import annotations

import importlib
import itertools
import json
import math
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, lru_cache, partial
from pathlib import Path

import mpmath
import numpy as np
from beam_truth import MODULES as BEAMS
from beam_truth import SANDWICH, exact_beams
from elastolink import generated
from forces_truth import exact_points as exact_forces
from free_free_truth import MODES_MODULE, ROD_MODULE, WithModes, exact_modes, exact_rod
from frequency_truth import MODULE as FREQUENCY_FUNCTIONS
from frequency_truth import exact_frequency_functions
from judging import ALLOWED, Exact, Judgement, Point, exact_at, judge, worst
from linkage_truth import exact_points
from meissner_truth import exact_meissner
from multibody_truth import exact_points as exact_multibody
from overhang_truth import exact_points as exact_overhang
from rod_polynomial_truth import MODULE as ROD_POLYNOMIALS
from rod_polynomial_truth import exact_polynomials
from rod_truth import MODULES as MOVING_RODS
from rod_truth import exact_moving
from sensitivity_truth import EXACT as SENSITIVITIES
from sliding_truth import EXACT as SLIDING

PAGE = Path(__file__).resolve().parents[2] / "docs" / "accuracy.md"
MANIFEST = Path(generated.__path__[0]) / "manifest.json"
MODES = (*range(1, 13), 30, 59, 60)
_SHORT_FRAME = (
    "frame 1e-6 of the links, crank in line with it: link 3 moves as one with the crank, and the "
    "components across of its inertia and of force 34 cancel but for 1e-8 of either"
)
# Outputs that may exceed the measure, with the reason.
EXCEPTIONS: dict[tuple[str, str, str], str] = {
    (f"{mechanism}_forces", function, output): _SHORT_FRAME
    for mechanism, output in (("four_bar", "y12"), ("four_bar", "y23"), ("quick_return", "y23"))
    for function in ("forces", "pin_forces")
}
COUNTS = (1, 2, 3)  # numbers of modes that a module for any number is judged with


@dataclass(frozen=True)
class Row:
    """One output of one emitted function and the worst of its judgements."""

    module: str
    function: str
    points: int
    judgement: Judgement

    @property
    def key(self) -> tuple[str, str, str]:
        return self.module, self.function, self.judgement.output


@cache
def emitted_functions() -> dict[str, dict[str, tuple[str, ...]]]:
    """Return the names of what each function of each packaged module returns.

    Without the recursions: their functions take an algebra, not numbers.  What they compute in
    double precision is compared with exact fractions in
    ``tests/runtime/hill/test_hill_effective.py``.
    """
    entries = json.loads(MANIFEST.read_text())["modules"].values()
    names = sorted(entry["module"] for entry in entries)
    modules = {name: importlib.import_module(f"{generated.__name__}.{name}") for name in names}
    return {name: m.RETURNS for name, m in modules.items() if m.FAMILY != "recursion"}


def _function(module: str, function: str) -> Callable:
    return getattr(importlib.import_module(f"{generated.__name__}.{module}"), function)


# ---------------------------------------------------------------- what is exact


def _products(numbers: dict) -> dict:
    """Return the factors of the coupler's terms: each parameter over the mass per length."""
    mass = numbers["mass_per_length"]
    return {
        "damping_over_mass_per_length": numbers["damping"] / mass,
        "coupler_inertia_over_mass_per_length": numbers["coupler_inertia"] / mass,
        "coupler_first_moment_over_mass_per_length": numbers["coupler_first_moment"] / mass,
        "follower_inertia_over_mass_per_length": numbers["follower_inertia"] / mass,
        "bending_stiffness_over_mass_per_length": numbers["bending_stiffness"]
        / (mass * numbers["coupler"] ** 4),
    }


def cosine_moment(power: int, j: int):
    """Return ``int_0^1 xi^power cos(j pi xi) d xi`` for power 0, 1, 2 and any integer j."""
    if j == 0:
        return mpmath.mpf(1) / (power + 1)
    sign, wave = (-1) ** j, j * mpmath.pi
    return (mpmath.mpf(0), (sign - 1) / wave**2, 2 * sign / wave**2)[power]


def slopes(weight: tuple[int, int, int], m: int, n: int):
    """Return ``2 int w(xi) phi_m' phi_n' d xi`` for sine modes, ``w = sum weight_k xi^k``."""
    total = mpmath.mpf(0)
    for power, factor in enumerate(weight):
        both = cosine_moment(power, m - n) + cosine_moment(power, m + n)
        total += factor * both * m * n * mpmath.pi**2
    return total


def modal_arrays(module: str, m: int, n: int) -> dict[tuple[str, str | None], mpmath.mpf]:
    """Return the modal factor of each term of the coupler, by array and function of angle.

    Tension and spin of the beam: ``B = spin delta_mn - 2 int N phi_m' phi_n'`` per modal mass.
    """
    one = mpmath.mpf(m == n)
    formulation = module.rsplit("_", 1)[1]
    found = {
        ("M", None): one,
        ("C", None): one,
        ("K", None): one * (m * mpmath.pi) ** 4,
        ("B", "angle_omega3"): one,
    }
    for name in ("coupler_inertia", "coupler_first_moment", "follower_inertia"):
        pulled = slopes((1, 0, 0), m, n)
        found["B", f"angle_end_load_{name}_speed"] = pulled
        found["S", f"acceleration_end_load_{name}_acceleration"] = pulled
    if formulation == "complete":
        found["B", "angle_omega3"] -= slopes((1, 0, -1), m, n) / 2
        for array, angle in (("B", "angle_cos23"), ("S", "acceleration_sin23")):
            found[array, angle] = 2 * slopes((1, -1, 0), m, n)
    return found


def modal_vectors(m: int) -> dict[tuple[str, str], mpmath.mpf]:
    """Return the modal factor of each forcing term: the load's moments with a sine mode."""
    sign, wave = (-1) ** m, m * mpmath.pi
    linear, even = sign / wave, (sign - 1) / wave  # -int xi sin, -int sin
    return {
        ("f", "forcing_alpha3"): linear,
        ("f", "forcing_sin23"): even,
        ("g", "acceleration_forcing_omega3"): linear,
        ("g", "acceleration_forcing_cos23"): even,
    }


# ---------------------------------------------------------------- points


def _random(names: tuple[str, ...], count: int, seed: int, **fixed: tuple[float, ...]):
    """Yield points with log-uniform inputs of both signs where that makes sense."""
    random = np.random.default_rng(seed)
    for i in range(count):
        inputs = {name: float(10.0 ** random.uniform(-6, 6)) for name in names}
        chosen = {name: float(random.choice(values)) for name, values in fixed.items()}
        yield Point(f"random {i}", inputs, chosen)


PARAMETERS = (
    "bending_stiffness",
    "mass_per_length",
    "damping",
    "coupler_inertia",
    "coupler_first_moment",
    "follower_inertia",
    "coupler",
)


@lru_cache(maxsize=1)
def _scale_points() -> tuple[Exact, ...]:
    return tuple(exact_at(_products, p) for p in _random(PARAMETERS, 200, 21))


@lru_cache(maxsize=1)
def _hill_points() -> tuple[Exact, ...]:
    def same(numbers):
        return {name: numbers[name] for name in ("lam2", "mu", "damping")}

    return tuple(exact_at(same, p) for p in _random(("lam2", "mu", "damping"), 200, 22))


def _modal_points(module: str, function: str) -> Iterator[tuple[tuple[str, ...], Exact]]:
    """Yield, for the names of modal arrays that one role gives a value, exact points."""
    emitted = importlib.import_module(f"{generated.__name__}.{module}")
    matrices = function == "modal_matrices"
    pairs = itertools.product(MODES, MODES) if matrices else ((m, 0) for m in MODES)
    for m, n in pairs:
        with mpmath.workdps(60):
            roles = modal_arrays(module, m, n) if matrices else modal_vectors(m)
            values: dict[str, mpmath.mpf] = {}
            for array, _, _, angle, modal in emitted.TERMS:
                if (array, angle) not in roles:
                    continue
                value = roles[array, angle]
                assert values.setdefault(modal, value) == value, (modal, array, angle)
        fixed = {"m": float(m), "n": float(n)} if matrices else {"m": float(m)}
        name = f"modes {m}, {n}" if matrices else f"mode {m}"
        fair = {key: abs(value) for key, value in values.items()}
        yield Exact(Point(name, {}, fixed), partial(_given, values, fair))


def _given(values: dict, fair: dict) -> tuple[dict, dict]:
    return values, fair


# ---------------------------------------------------------------- the table


def _exact(module: str, function: str) -> tuple[Exact, ...]:
    if module == SANDWICH or module in BEAMS:
        return exact_beams(module)
    if module == FREQUENCY_FUNCTIONS:
        return exact_frequency_functions(function)
    if module == "quick_return_overhang_modes":
        return exact_overhang(function)
    if "_multibody" in module:
        return exact_multibody(module)
    if "_forces" in module:
        return exact_forces(module, function)
    if module == MODES_MODULE:
        return exact_modes(function)
    if module == ROD_POLYNOMIALS:
        return exact_polynomials(function)
    if module in MOVING_RODS:
        return exact_moving(module, function)
    if module in SENSITIVITIES:
        return SENSITIVITIES[module]()
    if module in SLIDING:
        return SLIDING[module]()
    if function in ("modal_matrices", "modal_vectors"):
        return tuple(_modal_points(module, function))
    if module == "hill_plain":
        return _hill_points()
    if module == "hill_meissner":
        return exact_meissner(function)
    if function == "scales":
        return _scale_points()
    return exact_points()


@cache
def rows(module: str, most: int | None = None) -> tuple[Row, ...]:
    """Judge the functions of a module, each at most at so many of its points, evenly chosen."""
    found = []
    for function, names in emitted_functions()[module].items():
        if module == ROD_MODULE:
            called = [WithModes(function, count) for count in COUNTS]
            cases = [(c, c.names, exact_rod(c)) for c in called]
        else:
            cases = [(_function(module, function), names, _exact(module, function))]
        judged: dict[str, Judgement] = {}
        points = 0
        for emitted, outputs, exact in cases:
            chosen = exact[:: 1 if most is None else -(-len(exact) // most)]
            made = worst(j for at in chosen for j in judge(emitted, outputs, at))
            judged = worst([*judged.values(), *made.values()])
            points += len(chosen)
        found += [Row(module, function, points, judged[name]) for name in sorted(judged)]
    return tuple(found)


def bound(measure: float) -> int:
    """Return a measure rounded up to a power of two: what another processor leaves alone."""
    return 2 ** max(0, math.ceil(math.log2(measure))) if measure else 1


def _page(found: dict[str, tuple[Row, ...]]) -> str:
    lines = [
        "# Accuracy of the emitted functions",
        "",
        "Written by `python tests/derive/emitted_accuracy.py`; a test compares it.",
        "",
        "Each function is evaluated in double precision and compared with a definition that shares",
        "no formula with it, in 80 digits at the doubles that were passed in: loop closure and its",
        "derivatives, the balance of moments of coupler and follower, integrals of mode shapes.",
        "The measure is the error over `u (|f| + sum_i |x_i df/dx_i|)`, `u = 2^-53`: what rounding",
        f"the result and each input once would do.  At most {ALLOWED:g} is allowed.",
        "",
        "Points: 200 random ones (crank rockers and drag links, both assemblies, link ratios to",
        "100, lengths from 1e-4 to 1e4; parameters over twelve decades), and named nasty ones:",
        "every quarter turn, angles down to 5e-324, 1e-8 around the dead centres, 1000 turns,",
        "Smith's linkages, equal links, crank or frame 1e-6 of the others, change points, kites,",
        "rhombi and parallelograms a hair's breadth from folding; mode numbers to 60.",
        "Slider-cranks also with cranks that cannot turn, and a hair's breadth",
        "from crank + offset = coupler; quick-returns a hair's breadth from crank = frame.  Forces",
        "at 80 random and many nasty poses, masses or loads all drawn at random, or one of them",
        "alone; equations in redundant coordinates at 12 random states.  Intervals of Meissner's",
        "equation with phases to 1e6 and growth to exp(600), levels down to 5e-324, whole quarter",
        "turns, and several intervals where both ends of a region meet.  Beam elements: lengths",
        "and stiffnesses over twelve decades, their shapes at nodes, a hair's breadth from nodes,",
        "and where they change sign; beams of Timoshenko with next to no shear and next to no",
        "bending.",
        "",
        "Rounded up to a power of two, for mathematics libraries differ in the last digit.  Every",
        "output with its measure: `python tests/derive/emitted_accuracy.py --table`.",
        "",
        "| module | outputs | points | worst measure at most | of |",
        "| --- | ---: | ---: | ---: | --- |",
    ]
    for module, judged in found.items():
        kept = [row for row in judged if row.key not in EXCEPTIONS]
        last = max(kept, key=lambda row: row.judgement.measure)
        of = f"`{last.function}`: `{last.judgement.output}`"
        points = max(row.points for row in judged)
        lines.append(
            f"| {module} | {len(judged)} | {points} | {bound(last.judgement.measure)} | {of} |"
        )
    lines += ["", "## Exceptions", ""]
    if EXCEPTIONS:
        for reason in sorted(set(EXCEPTIONS.values())):
            keys = [" ".join(key) for key, why in EXCEPTIONS.items() if why == reason]
            lines += [f"- {reason}:", *(f"  - {key}" for key in keys)]
    else:
        lines.append("None.")
    lines += [
        "",
        "## Not in the table",
        "",
        "`hill_recursion` is generic: its functions take the operations of an algebra.  With words",
        "for an algebra they return the derived words; with doubles, the coefficients of Hill's",
        "equation are within 8 u of exact fractions, relative to the sum of the sizes of the terms",
        "(`tests/derive/test_bloch_emission.py`, `tests/runtime/hill/test_hill_effective.py`).",
    ]
    return "\n".join(lines) + "\n"


def page_bounds(text: str) -> dict[str, int]:
    """Return the bounds that the page states, by module."""
    table = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| ")]
    return {module: int(most) for module, _, _, most, _ in table[2:]}


def main() -> None:
    """Write the page, or print the whole table."""
    found = {module: rows(module) for module in emitted_functions()}
    if "--table" not in sys.argv:
        PAGE.write_text(_page(found))
        return
    for row in (row for judged in found.values() for row in judged):
        j = row.judgement
        at = j.point.name if j.measure else "exact everywhere"
        print(f"{row.module:30} {row.function:30} {j.output:30} {j.measure:7.2g}  {at}")


if __name__ == "__main__":
    main()
