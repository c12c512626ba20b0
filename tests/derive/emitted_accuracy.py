"""Write docs/accuracy.md: the error of every emitted function, measured against 80 digits.

Run it after a change of a model or of the lowering:  python tests/derive/emitted_accuracy.py
"""

from __future__ import annotations

import importlib
import itertools
import json
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import mpmath
import numpy as np
from beam_truth import MODULES as BEAMS
from beam_truth import SANDWICH, exact_beams
from elastolink import generated
from elastolink.derive.checks import ALLOWED, Exact, Judgement, Point, exact_at, judge, worst
from forces_truth import VARIANTS
from forces_truth import exact_points as exact_forces
from free_free_truth import MODES_MODULE, ROD_MODULES, exact_free_free
from frequency_truth import MODULE as FREQUENCY_FUNCTIONS
from frequency_truth import exact_frequency_functions
from linkage_truth import exact_points
from meissner_truth import exact_meissner
from multibody_truth import exact_points as exact_multibody
from newmark_truth import exact_newmark
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
    (module, function, output): _SHORT_FRAME
    for module, output in (
        *itertools.product((f"four_bar_forces{v}" for v in VARIANTS), ("y12", "y23")),
        *((f"quick_return_forces{v}", "y23") for v in VARIANTS[:2]),
    )
    for function in ("forces", "pin_forces")
}


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


def emitted_functions() -> dict[tuple[str, str], tuple[str, ...]]:
    """Return the names of what each function of each packaged module returns.

    Without the recursions: their functions take an algebra, not numbers.  What they compute in
    double precision is compared with exact fractions in
    ``tests/runtime/hill/test_hill_effective.py``.
    """
    entries = json.loads(MANIFEST.read_text())["modules"].values()
    modules = [importlib.import_module(f"{generated.__name__}.{e['module']}") for e in entries]
    return {
        (module.__name__.rsplit(".", 1)[1], function): tuple(names)
        for module in sorted(modules, key=lambda m: m.__name__)
        if module.FAMILY != "recursion"
        for function, names in module.RETURNS.items()
    }


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


def _boundaries(numbers: dict) -> dict:
    """Return Smith's (7.46), (7.49): n^2/4 - a0 mu +- sqrt(mu^2 (an^2 + bn^2)/4 - n^2 K^2)."""
    n, mu, damping = numbers["n"], numbers["mu"], numbers["damping"]
    amplitude2 = numbers["an"] ** 2 + numbers["bn"] ** 2
    return {
        "centre": n**2 / 4 - numbers["a0"] * mu,
        "half_width_squared": mu**2 * amplitude2 / 4 - n**2 * damping**2,
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


def _closing_tongues() -> Iterator[Point]:
    """Yield points at which damping closes the tongue up to the last digit."""
    for n in (1, 2, 7, 60):
        for mu in (1e-6, 0.3, 2.0):
            damping = mu * math.hypot(0.3, 0.4) / (2 * n)
            for nudge, word in ((0.0, "closed"), (1e-15, "a hair from closed")):
                inputs = {"mu": mu, "a0": 0.1, "an": 0.3, "bn": 0.4, "damping": damping + nudge}
                yield Point(f"tongue {n} at mu {mu:g}, {word}", inputs, {"n": float(n)})


@lru_cache(maxsize=1)
def _scale_points() -> tuple[Exact, ...]:
    return tuple(exact_at(_products, p) for p in _random(PARAMETERS, 200, 21))


@lru_cache(maxsize=1)
def _hill_points() -> tuple[Exact, ...]:
    def same(numbers):
        return {name: numbers[name] for name in ("lam2", "mu", "damping")}

    return tuple(exact_at(same, p) for p in _random(("lam2", "mu", "damping"), 200, 22))


@lru_cache(maxsize=1)
def _boundary_points() -> tuple[Exact, ...]:
    names = ("mu", "a0", "an", "bn", "damping")
    points = [*_random(names, 200, 23, n=tuple(range(1, 61))), *_closing_tongues()]
    return tuple(exact_at(_boundaries, p) for p in points)


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
        yield Exact(Point(name, {}, fixed), values, fair)


# ---------------------------------------------------------------- the table


def _exact(module: str, function: str) -> tuple[Exact, ...]:
    if module == SANDWICH or module in BEAMS:
        return exact_beams(module)
    if module == FREQUENCY_FUNCTIONS:
        return exact_frequency_functions(function)
    if module == "newmark_stability":
        return exact_newmark()
    if module == "quick_return_overhang_modes":
        return exact_overhang(function)
    if "_multibody" in module:
        return exact_multibody(module)
    if "_forces" in module:
        return exact_forces(module, function)
    if module == MODES_MODULE or module.startswith(ROD_MODULES):
        return exact_free_free(module, function)
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
    if module == "hill_boundaries_first_order":
        return _boundary_points()
    if module == "hill_meissner":
        return exact_meissner(function)
    if function == "scales":
        return _scale_points()
    return exact_points()


@lru_cache(maxsize=1)
def rows() -> tuple[Row, ...]:
    """Judge every emitted function at all its points."""
    found = []
    for (module, function), names in emitted_functions().items():
        exact = _exact(module, function)
        judged = worst(
            judgement for at in exact for judgement in judge(_function(module, function), names, at)
        )
        found += [Row(module, function, len(exact), judged[name]) for name in names]
    return tuple(found)


def _page(found: tuple[Row, ...]) -> str:
    lines = [
        "# Accuracy of the emitted functions",
        "",
        "Written by `python tests/derive/emitted_accuracy.py`; a test keeps it current.",
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
        "rhombi and parallelograms a hair's breadth from folding; mode numbers to 60; tongues that",
        "damping closes.  Slider-cranks also with cranks that cannot turn, and a hair's breadth",
        "from crank + offset = coupler; quick-returns a hair's breadth from crank = frame.  Forces",
        "at 80 random and many nasty poses, masses or loads all drawn at random, or one of them",
        "alone; equations in redundant coordinates at 12 random states.  Intervals of Meissner's",
        "equation with phases to 1e6 and growth to exp(600), levels down to 5e-324, whole quarter",
        "turns, and several intervals where both ends of a region meet.  Beam elements: lengths",
        "and stiffnesses over twelve decades, their shapes at nodes, a hair's breadth from nodes,",
        "and where they change sign; beams of Timoshenko with next to no shear and next to no",
        "bending.",
        "",
        "| module | function | output | points | worst measure | at |",
        "| --- | --- | --- | ---: | ---: | --- |",
    ]
    for row in found:
        cells = (
            row.module,
            row.function,
            f"`{row.judgement.output}`",
            str(row.points),
            f"{row.judgement.measure:.2g}",
            row.judgement.point.name if row.judgement.measure else "exact everywhere",
        )
        lines.append("| " + " | ".join(cells) + " |")
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


def page_rows(text: str) -> dict[tuple[str, str, str], float]:
    """Return the worst measures that the page states."""
    table = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| ")]
    return {(m, f, output.strip("`")): float(w) for m, f, output, _, w, _ in table[2:]}


def main() -> None:
    """Write the page."""
    PAGE.write_text(_page(rows()))


if __name__ == "__main__":
    main()
