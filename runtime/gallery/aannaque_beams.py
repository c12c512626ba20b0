"""The beams of Aannaque's Table 4.1: models, the "exact" one too; frequencies (chapters 4, 5)."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import zip_longest
from typing import Any, NamedTuple, SupportsFloat

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.signal import find_peaks

from ..beams import Section, Structure, frame
from ..beams.element_forms import required_structure
from ..core.families import LinearPeriodic, Term
from ..core.trigonometric import even_angles, interpolated
from ..frequencies import dynamic_stiffness, element_matrices, log_determinant, wittrick_williams
from ..frequencies.held import held_frequencies
from ..recovery.stress_over_speed import StressCurve, stress_curve
from ..scenes import load_scene
from ..systems import with_modal_damping
from .drawing import COLOURS, Array, Looks, Panels, turn
from .records import Drawn, contents

SCENE = "aannaque_1996_table_4_1"
# The thesis' form (7.1), without stiffening; and the whole of the equations.
THESIS: tuple[str, ...] = ("as_printed",)
FULL: tuple[str, ...] = ()
FRAME = 0.547
# The distances of the pivots [m] of Figs. 8.19 to 8.23, and one more of chapter 7.
FRAMES = (0.547, 0.600, 0.632, 0.642, 0.652, 0.662)
CRITICAL = 62.0
# Angles of a turn at which the matrices of the "exact" model are formed.
_ANGLES = 128
LINKS = ("crank", "coupler", "follower")


@lru_cache(maxsize=24)
def beams(
    elements: int = 3,
    drop: tuple[str, ...] = THESIS,
    *,
    kind: str = "cubic_beams",
    ratio: float = 0.02,
    frame: float = FRAME,
) -> LinearPeriodic:
    """Return the mechanism of Table 4.1 with modal damping.

    So many elements for each link; the form :data:`THESIS` or :data:`FULL`; the scene's
    formulation, which names the elements; the damping ratio of every mode; L4 [m].
    """
    overrides = {
        "mesh.elements": elements,
        "model.drop": list(drop),
        "model.formulation": kind,
        "damping.ratio": ratio,
        "links.frame": f"{frame} m",
    }
    return load_scene(SCENE, overrides=overrides).linear_system()


def stresses(system: LinearPeriodic, speeds: Array, rtol: float = 1e-3) -> StressCurve:
    """Return the largest stresses over the speed, by the shapes as in the thesis."""
    return stress_curve(system, speeds, rtol=rtol, method="shape", stability=False, whole=False)


def midpoint(system: LinearPeriodic, link: str, theta: Array) -> Array:
    """Return what turns coordinates into the displacement across a link's midpoint [m], (nt, n)."""
    placed, deflection = required_structure(system).elements, system.relative_deflection
    assert deflection is not None, "beams have deflections"
    at = [i for i, item in enumerate(placed) if item.beam.name == link]
    count = len(at)
    # Two places to each element: its middle and its end.
    row = 2 * at[count // 2] if count % 2 else 2 * at[count // 2 - 1] + 1
    return np.asarray(deflection(theta)[:, row] * placed[at[0]].beam.length)


def moved(system: LinearPeriodic, link: str, theta: Array, q: Array) -> Array:
    """Return the displacement across a link's midpoint [m], shape ``(..., nt)``."""
    return np.asarray(np.einsum("tn,...tn->...t", midpoint(system, link, theta), q))


def rms(values: Array) -> Array:
    """Return the root of the mean square along the last axis."""
    return np.asarray(np.sqrt(np.mean(np.square(values), axis=-1)))


def tops(speed: Array, values: Array, prominence: float | None = None) -> Array:
    """Return the speeds of local maxima that stand out of a curve, each refined by a parabola."""
    at = find_peaks(values, prominence=prominence)[0]
    before, here, after = values[at - 1], values[at], values[at + 1]
    shift = 0.5 * (before - after) / (before - 2.0 * here + after)
    return np.asarray(speed[at] + shift * (speed[1] - speed[0]))


def maxima(speed: Array, values: Array, prominence: float = 0.02) -> Array:
    """Return the speeds of local maxima that stand out of a curve by a part of their height."""
    return tops(speed, np.log(values), prominence)


def nearest(places: Array, speed: float) -> float:
    """Return the place nearest to a speed."""
    return float(places[np.argmin(np.abs(places - speed))])


def held(system: LinearPeriodic, theta: Array, count: int = 4) -> Array:
    """Return the lowest natural frequencies [rad/s] with the crank held, ``(nt, count)``."""
    return np.asarray(held_frequencies(system, theta, {})[0][:, :count])


def exact_frequencies(structure: Structure, theta: Array, count: int) -> Array:
    """Return the lowest natural frequencies [rad/s] by dynamic stiffness, ``(nt, count)``."""
    problems = (dynamic_stiffness(structure, float(angle)) for angle in theta)
    return np.stack([wittrick_williams(one, count=count).frequencies[:count] for one in problems])


class HybridMatrices(NamedTuple):
    """Mass and stiffness of one element for each link at crank angles [rad], at their first mode.

    M and K ``(nt, n, n)`` as in (5.16) and (5.17), that frequency [rad/s], how often the matrices
    were formed anew, and the names of the coordinates.
    """

    mass: Array
    stiffness: Array
    first: Array
    iterations: NDArray[np.int64]
    labels: tuple[str, ...]


def hybrid_matrices(structure: Structure, theta: Array, rtol: float = 1e-3) -> HybridMatrices:
    """Return the matrices of the thesis' "exact" model at crank angles.

    At each angle the first frequency of the cubic elements gives M(omega) and K(omega), these a
    better frequency, and so on until it changes by less than ``rtol``.  That is Newton's method on
    the exact eigenproblem, so that few steps suffice; it needs a cubic element that is not far off.
    """
    rows = []
    for angle in theta:
        problem = dynamic_stiffness(structure, float(angle))
        omega, formed, steps = 0.0, -1.0, -1
        while steps < 1 or abs(omega - formed) > rtol * omega:
            formed, steps = omega, steps + 1
            mass = problem.mass(formed)
            stiffness = problem.stiffness(formed) + formed**2 * mass
            square = eigh(stiffness, mass, eigvals_only=True, subset_by_index=(0, 0))[0]
            omega = float(np.sqrt(square))
        rows.append((mass, stiffness, omega, steps))
    mass, stiffness, first, iterations = (np.array(part) for part in zip(*rows, strict=True))
    return HybridMatrices(mass, stiffness, first, iterations, problem.labels)


@lru_cache(maxsize=2)
def hybrid(rtol: float) -> HybridMatrices:
    """Return the matrices of the beams of Table 4.1 at even crank angles."""
    return hybrid_matrices(required_structure(beams(1)), even_angles(2.0 * np.pi, _ANGLES), rtol)


@lru_cache(maxsize=1)
def hybrid_model() -> LinearPeriodic:
    """Return the thesis' "exact" model: one element for each link, M and K at the first frequency.

    Damping 2 %, the form of the thesis; the inertia of the rigid motion by the same masses.
    """
    base, exact, theta = beams(1), hybrid(1e-10), even_angles(2.0 * np.pi, _ANGLES)
    order = [exact.labels.index(label) for label in base.labels]
    places = np.ix_(range(_ANGLES), order, order)
    push = exact.mass[places] @ np.linalg.solve(
        base.array("M", theta), base.array("f", theta)[..., None]
    )
    mass, stiffness, force = (
        interpolated(values, 2.0 * np.pi)
        for values in (exact.mass[places], exact.stiffness[places], push[..., 0])
    )
    terms = (
        Term("M", None, mass),
        # The family's own M' is taken out, as of any instantaneous form.
        Term("C", None, lambda angles: -mass.derivative(angles), power=1),
        Term("K", None, stiffness),
        Term("f", None, force),
    )
    kept = {name: getattr(base, name) for name in ("labels", "relative_deflection", "structure")}
    return with_modal_damping(LinearPeriodic(base.size, terms, {}, lambda _: {}, **kept), 0.02)


@lru_cache(maxsize=1)
def _models() -> dict[str, tuple[int, Array]]:
    """Return freedoms and four frequencies of the five models at 120 crank angles."""
    theta, found = even_angles(2.0 * np.pi, 120), {}
    for name, model in contents("aannaque")["models"].items():
        system = beams(drop=FULL, **model)
        found[name] = system.size, held(system, theta)
    return found


def elements(axes: Panels, mode: int, looks: Looks) -> Drawn:
    """Draw one natural frequency over the crank angle, five models (Fig. 4.6)."""
    models, curves = _models(), {}
    for (name, (size, frequencies)), look in zip(models.items(), looks, strict=True):
        curve = curves[name] = frequencies[:, mode - 1]
        label = f"{name}, {size} freedoms"
        turn(axes[0], even_angles(2.0 * np.pi, 120), curve, label=label, **look)
    one, two, three, p1, p2 = curves.values()
    values: list[SupportsFloat] = [
        float(np.max(three / two)) - 1.0,
        float(np.max(p2 / one)),
        np.mean(p2) / np.mean(p1),
        np.mean(p2) / np.mean(three) - 1.0,
    ]
    if mode in (1, 4):
        values.insert(0, 100.0 * (float(np.mean(one / three)) - 1.0))
    if mode > 1:
        return Drawn(values)
    rows = [(name, size, *curves.mean(axis=0)) for name, (size, curves) in models.items()]
    freedoms = [models[name][0] for name in ("3 elements", "p-version 2")]
    return Drawn([*values, *freedoms], tables=[rows])


# Table 5.1 as printed.
_TABLE = contents("aannaque")["table_5_1"]
# Rows (from 1) whose exact value is wrong: both are of bars with clamped ends, q = 0 in (5.20).
_WRONG = (4, 10)
# sqrt(EI/(rho A))/L^2 [rad/s]: fits all printed frequencies but those two.
_FACTOR = 17.66323


def _portal(column: str = "1 element") -> Structure:
    """Return the frame of three equal bars with sqrt(EI/(rho A))/L^2 = 1 rad/s."""
    bar = Section(area=1e-4, second_moment=1e-9, modulus=1e9, density=1e4)
    held = ("x", "y", "rotation")
    return frame(
        {"A": (0, 0), "B": (0, 1), "C": (1, 1), "D": (1, 0)},
        {"left": ("A", "B"), "beam": ("B", "C"), "right": ("D", "C")},
        bar,
        supports={"A": held, "D": held},
        elements=int(column[0]) if column[0].isdigit() else 1,
        kind="cubic" if column[0].isdigit() else "internal_node",
    )


def _problem(pieces: int = 1) -> Any:
    shares = (1.0 / pieces,) * pieces
    cut = dict.fromkeys(("left", "beam", "right"), shares) if pieces > 1 else None
    return dynamic_stiffness(_portal(), inextensible=True, pieces=cut)


@lru_cache(maxsize=1)
def _exact() -> Array:
    """Return the first 21 frequencies [rad/s]."""
    return np.asarray(_FACTOR * wittrick_williams(_problem(), count=21).frequencies)


@lru_cache(maxsize=8)
def _elements(column: str) -> Array:
    """Return all frequencies of a column's elements [rad/s]."""
    mass, stiffness, _ = element_matrices(_portal(column), inextensible=True)
    return np.asarray(_FACTOR * np.sqrt(eigh(stiffness, mass, eigvals_only=True)))


def figure_5_1(axes: Panels, looks: Looks) -> Drawn:
    """Draw the logarithm of the determinant of D over the frequency, bars whole and halved."""
    low, high = 20.0, 1200.0
    known = _exact()
    inside = known[known < high]
    near = [
        center + side * np.geomspace(1e-5, 20.0, 60) for center in inside for side in (-1.0, 1.0)
    ]
    omega = np.unique(np.concatenate([np.linspace(low, high, 1500), *near]))
    omega = omega[(omega > low) & (omega < high)]
    for pieces, ax in enumerate(axes, start=1):
        value = log_determinant(_problem(pieces), omega / _FACTOR)[0]
        for place, frequency in enumerate(inside, start=1):
            ax.axvline(frequency, ls=(0, (3, 2)), **looks[place in _WRONG])
        ax.plot(omega, value, color=COLOURS[0], lw=1.0, label=r"$\log_{10}|\det D|$")
    beside = known[3] / _FACTOR * (1.0 + np.array([1e-7, 1e-5]))
    slopes = (np.diff(log_determinant(_problem(pieces), beside)[0]) for pieces in (1, 2))
    return Drawn([float(slope[0]) / 2.0 for slope in slopes])


def table_5_1(axes: Panels) -> Drawn:
    """Draw the relative errors of Table 5.1.b, recomputed, with the printed ones."""
    ax, exact, columns = axes[0], _exact(), {name: _elements(name) for name in _TABLE["columns"]}

    def gaps(computed: Array, printed: Sequence[float]) -> Array:
        # Three decimals are printed; the roots were sought to 2.5e-7 more.
        known = np.array(printed)
        return np.asarray(np.abs(computed - known) / (1e-3 + 2.5e-7 * known))

    # The worst gaps to what is printed over the last digit; what is wrong there by itself.
    right = ~np.isin(np.arange(1, 22), _WRONG)
    values = [np.max(gaps(exact, _TABLE["exact"])[right]), *exact[~right]]
    of_errors: list[float] = []
    largest = 0.0
    for (name, computed), colour in zip(columns.items(), COLOURS, strict=False):
        values.append(np.max(gaps(computed, _TABLE["columns"][name]["frequencies"])))
        printed = np.array(_TABLE["columns"][name]["errors"])
        errors, numbers = 100.0 * (computed / exact[: len(printed)] - 1.0), np.arange(len(printed))
        limit = np.where(np.round(printed, 2) == printed, 1e-2, 2e-3)
        of_errors += [np.max((np.abs(errors - printed) / limit)[numbers != 3]), *errors[3:4]]
        if "element" in name:
            largest = max(largest, float(np.max(errors)))
        ax.semilogy(numbers + 1, errors, "-", color=colour, lw=1.0, label=name)
        shown = printed > 0.0
        ax.plot(numbers[shown] + 1, printed[shown], "o", color=colour, ms=3.5)
    ax.plot([], [], "o", color="0.4", ms=3.5, label="printed")
    ax.axvline(4, color="0.6", lw=0.7, ls=(0, (1, 3)))
    ax.set_xticks(range(1, 22, 2))
    rows = zip_longest(range(1, 22), _TABLE["exact"], exact, *columns.values(), fillvalue="")
    return Drawn([*values, *of_errors, largest], tables=[rows])


@lru_cache(maxsize=1)
def _both() -> tuple[Array, Array, Array]:
    """Return 48 crank angles, four frequencies there of three elements, and the exact ones."""
    theta, system = even_angles(2.0 * np.pi, 48), beams(3, FULL)
    return theta, held(system, theta), exact_frequencies(required_structure(system), theta, 4)


def exact_and_elements(axes: Panels, mode: int) -> Drawn:
    """Draw one natural frequency, three elements and exact, and their gap (Fig. 5.3)."""
    theta, three, exact = _both()
    turn(axes[0], theta, three[:, mode - 1], color=COLOURS[0], label="3 elements")
    turn(axes[0], theta, exact[:, mode - 1], "--", color=COLOURS[1], label="dynamic stiffness")
    gaps = 100.0 * (three / exact - 1.0)
    gap = gaps[:, mode - 1]
    turn(axes[1], theta, gap, color=COLOURS[2], label="difference")
    axes[1].set_ylim(0.0, 1.15 * float(np.max(gap)))
    return Drawn([np.max(gaps if mode == 4 else gap)])
