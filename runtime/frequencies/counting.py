"""Wittrick and Williams' algorithm: every natural frequency of a frame, none missed.

Axial stiffness exceeds bending stiffness a millionfold, and a plain eigenvalue solver leaves
errors of the largest eigenvalue's size times the machine's precision.  Its eigenvectors are good
enough: quadratic forms in them, summed member by member in the member's own axes, are exact but
for rounding.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import Problem, bad, refuse
from ..core.families import Array, Transcendental
from ..core.inputs import is_finite, is_whole, numbers_in_a_row, require_kind
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check, Result, provenance
from .frames import Assembly, DynamicStiffness, divided_for, functions

UNIT = 2.0**-53


def quadratic_forms(
    assembly: Assembly, omega: float, vectors: Array, mass: Array | None = None
) -> tuple[Array, Array, Array]:
    """Return ``X^T D X``, ``X^T M X`` and the sizes of the terms of the first one's diagonal.

    X has the columns ``vectors``, ``(size, k)``.  The sizes, ``(k,)``, sum all that is added, mass
    included: u times them is what rounding does.
    """
    if mass is None:
        _, mass = assembly.members.matrices(omega)
    # (D(0) - D(omega)) / omega^2 of the pieces.
    inertia = assembly.members.inertias(omega)
    ends = assembly.local @ vectors
    felt = np.abs(assembly.local) @ np.abs(vectors)  # what rounding sees
    nodes = assembly.reduction @ vectors
    strained, strained_sizes = _strain_forms(assembly, ends, felt)
    lumps = assembly.springs - omega**2 * assembly.lumped_mass
    moved = nodes.T @ (lumps[:, None] * nodes)
    plain = strained - omega**2 * _forms(inertia, ends) + moved
    heavy = _forms(mass, ends) + nodes.T @ (assembly.lumped_mass[:, None] * nodes)
    # omega dH/d(omega) is of the size of M: what a rounded length or section does.
    entries = omega**2 * (np.abs(inertia) + 4.0 * np.abs(mass))
    sizes = strained_sizes + np.einsum("nak,nab,nbk->k", felt, entries, felt, optimize=True)
    weights = assembly.springs + omega**2 * assembly.lumped_mass
    sizes = sizes + np.sum(weights[:, None] * nodes**2, axis=0)
    return (plain + plain.T) / 2.0, (heavy + heavy.T) / 2.0, sizes


def _strain_forms(assembly: Assembly, ends: Array, felt: Array) -> tuple[Array, Array]:
    """Return the static strain energy, twice, by stretch and turning against the chord."""
    members = assembly.members
    length, bending = members.length, members.bending
    stiff = np.where(np.isinf(members.axial), 0.0, members.axial) / length
    span = length[:, None]
    stretch = ends[:, 3] - ends[:, 0]
    chord = (ends[:, 4] - ends[:, 1]) / span
    first, second = ends[:, 2] - chord, ends[:, 5] - chord
    turn = (bending / length)[:, None]
    moments = turn * (4.0 * first + 2.0 * second), turn * (2.0 * first + 4.0 * second)
    forms = stretch.T @ (stiff[:, None] * stretch) + first.T @ moments[0] + second.T @ moments[1]
    seen = felt[:, 2] + felt[:, 5] + 2.0 * (felt[:, 1] + felt[:, 4]) / span
    sizes = stiff[:, None] * np.abs(stretch) * (felt[:, 0] + felt[:, 3])
    sizes = sizes + (np.abs(moments[0]) + np.abs(moments[1])) * seen
    return np.asarray(forms), np.asarray(np.sum(sizes, axis=0))


def _forms(matrices: Array, ends: Array) -> Array:
    count = ends.shape[-1]
    return np.asarray(ends.reshape(-1, count).T @ (matrices @ ends).reshape(-1, count))


def signs(assembly: Assembly, omega: float) -> tuple[int, bool]:
    """Return the number of negative eigenvalues of D at a frequency, and whether it is certain."""
    local, _ = assembly.members.matrices(omega)
    lumps = assembly.springs - omega**2 * assembly.lumped_mass
    matrix = assembly.assembled(local, lumps)
    if not np.all(np.isfinite(matrix)):
        return 0, False  # on a pole
    sizes = np.einsum(
        "nai,nab,nbi->i", np.abs(assembly.local), np.abs(local), np.abs(assembly.local)
    )
    sizes = sizes + (np.abs(lumps)[:, None] * assembly.reduction**2).sum(axis=0)
    scale = 1.0 / np.sqrt(sizes)
    values = np.linalg.eigvalsh(matrix * np.outer(scale, scale))
    # Scaled eigenvalues below this, over the largest, may have the wrong sign.
    certain = bool(np.min(np.abs(values)) > 1e-11 * np.max(np.abs(values)))
    return int(np.sum(values < 0.0)), certain


def modal(assembly: Assembly, omega: float) -> tuple[Array, Array]:
    """Return mu, rising, and x of ``D x = mu M x`` at a frequency [rad/s] away from the poles.

    mu is what is missing to the squares of the frequencies; the columns x ``(size, n)`` have unit
    generalised mass.
    """
    from scipy.linalg import eigh

    local, local_mass = assembly.members.matrices(omega)
    lumps = assembly.springs - omega**2 * assembly.lumped_mass
    stiffness = assembly.assembled(local, lumps)
    mass = assembly.assembled(local_mass, assembly.lumped_mass)
    scale = 1.0 / np.sqrt(np.diagonal(mass))
    both = np.outer(scale, scale)
    values, turned = eigh(stiffness * both, mass * both)
    vectors = scale[:, None] * turned
    # Modes whose eigenvalue is within this, over omega^2, are brought in order by quadratic forms.
    near = np.abs(values) <= 30.0 * omega**2
    if near.any():
        values[near], vectors[:, near] = projected(assembly, omega, vectors[:, near], local_mass)
    return values, vectors


def projected(
    assembly: Assembly, omega: float, vectors: Array, mass: Array | None = None
) -> tuple[Array, Array]:
    """Return the values and vectors of :func:`modal` within the span of some columns."""
    from scipy.linalg import eigh

    stiffness, heavy, _ = quadratic_forms(assembly, omega, vectors, mass)
    values, inner = eigh(stiffness, heavy)
    return values, np.asarray(vectors @ inner)


@dataclass(frozen=True)
class Mode:
    """One natural frequency of a structure."""

    omega: float  # frequency [rad/s]
    error: float  # bound of its error [rad/s]
    problem: DynamicStiffness  # the structure, divided so that the frequency is no pole
    vector: Array  # coordinates of that, of unit generalised mass, (problem.size,)
    certified: bool  # whether the counts on both sides confirm the bound


@dataclass(frozen=True)
class Interval:
    """Frequencies number ``first + 1`` to ``last`` lie between two frequencies."""

    low: float
    high: float
    first: int
    last: int


def certain_count(problem: DynamicStiffness, omega: float) -> tuple[float, int]:
    """Return how many frequencies lie below one close to ``omega``, and that one."""
    for _ in range(3):
        negative, certain = signs(problem.assembly, omega)
        if certain:
            return omega, round(float(problem.poles(omega))) + negative
        omega *= 1.0 + 1e-7
    return omega, _count(divided_for(problem, omega), omega)


def _count(finer: DynamicStiffness, omega: float) -> int:
    """Return how many frequencies lie below one that is no pole of the pieces."""
    negative = np.sum(modal(finer.assembly, omega)[0] < 0.0)
    return round(float(finer.poles(omega))) + int(negative)


# From a frequency to one close to it, and how many lie below that.
Counted = Callable[[float], tuple[float, int]]


def isolate(
    counted: Counted, whole: Interval, narrow: Callable[[Interval], bool]
) -> list[Interval]:
    """Return narrow intervals with all frequencies of one, in ascending order."""
    found, pending = [], [whole]
    while pending:
        item = pending.pop()
        if item.first == item.last:
            continue
        middle = float(((np.sqrt(item.low) + np.sqrt(item.high)) / 2.0) ** 2)
        if narrow(item) or not item.low < middle < item.high:
            found.append(item)
            continue
        place, count = counted(middle)
        count = min(max(count, item.first), item.last)
        pending.append(Interval(place, item.high, count, item.last))
        pending.append(Interval(item.low, place, item.first, count))
    return found


def _solvable(problem: DynamicStiffness, item: Interval) -> bool:
    """Return whether an interval is narrow enough for its frequencies to be computed."""
    width = (item.high - item.low) / item.high
    # Within this, 2 % at most, no member's phase changes by 0.3.
    z, b = problem.assembly.members.phases(item.high)
    narrow = float(min(0.02, 0.3 / max(np.max(z) / 2.0, np.max(b))))
    return width <= narrow and (item.last == item.first + 1 or width <= narrow**2)


def solve(problem: DynamicStiffness, item: Interval) -> list[Mode]:
    """Return the modes of an interval to full precision."""
    finer = divided_for(problem, item.low, item.high)
    numbers = range(item.first + 1, item.last + 1)
    rough = np.sort([_newton(finer, item, number) for number in numbers])
    modes: list[Mode] = []
    # Near ones are computed together, in the span of their vectors.
    for near in np.split(rough, np.flatnonzero(np.diff(rough) >= 1e-7 * rough[1:]) + 1):
        modes += _together(finer, near, item.first + len(modes))
    return modes


def _newton(finer: DynamicStiffness, item: Interval, number: int) -> float:
    """Return a frequency by its number, counted from 1."""
    # The eigenvalue of that number of D x = mu M x falls steadily through zero, and mu is Newton's
    # step of the squared frequency.
    low, high = item.low, item.high
    omega = (low + high) / 2.0
    for _ in range(100):
        values, _ = modal(finer.assembly, omega)
        index = number - round(float(finer.poles(omega))) - 1
        step = float(values[min(max(index, 0), finer.size - 1)])
        low, high = (omega, high) if step > 0.0 else (low, omega)
        square = omega**2 + step
        if abs(step) <= 1e-8 * omega**2:  # Newton's error is the square of this
            return float(np.sqrt(square))
        new = float(np.sqrt(square)) if square > 0.0 else low
        omega = new if low < new < high else (low + high) / 2.0
    return omega


def _together(finer: DynamicStiffness, rough: Array, before: int) -> list[Mode]:
    """Return modes that are close, or a single one, with error bounds that counts confirm."""
    omega = float(np.mean(rough))
    _, every = modal(finer.assembly, omega)
    index = before - round(float(finer.poles(omega)))
    index = min(max(index, 0), finer.size - len(rough))
    chosen = every[:, index : index + len(rough)]
    values, vectors = projected(finer.assembly, omega, chosen)
    places = np.sqrt(np.maximum(omega**2 + values, 0.0))
    _, mass, sizes = quadratic_forms(finer.assembly, omega, vectors)
    # To first order, an entry of a local matrix being off by 6 u of its size, functions, products
    # and turn together: of 500 frequencies of random frames the least bound was 5 times the error.
    spread = 6.0 * UNIT * sizes / (2.0 * omega * np.diagonal(mass))
    # The largest component of each is positive.
    largest = np.argmax(np.abs(vectors), axis=0)[None]
    vectors = vectors * np.sign(np.take_along_axis(vectors, largest, axis=0))
    width, certified = _confirmed(finer, places, before, np.max(spread))
    return [
        Mode(float(place), float(width + own), finer, vector, certified)
        for place, own, vector in zip(places, spread, vectors.T, strict=True)
    ]


def _confirmed(
    finer: DynamicStiffness, places: Array, before: int, least: float
) -> tuple[float, bool]:
    """Return the smallest distance on either side of frequencies that counts confirm."""
    width = max(4.0 * UNIT * places[-1], least / 1.5)
    for _ in range(12):
        below = _count(finer, float(places[0] - width))
        above = _count(finer, float(places[-1] + width))
        if below == before and above == before + len(places):
            return float(width), True
        width *= 4.0
    return float(width), False


@dataclass(frozen=True)
class MemberShape:
    """Displacement of a beam along its length, at m places."""

    eta: Array  # places, in lengths, (m,)
    along: Array  # displacement in the beam's own axes [m], (m,)
    across: Array
    # derivatives of ``across`` by the place [rad, 1/m, 1/m^2], (m,)
    slope: Array
    curvature: Array
    third: Array
    strain: Array  # derivative of ``along`` by the place, (m,)
    displacement: Array  # in the fixed axes [m], (m, 2)


def _across(xi: Array, z: float, length: float, ends: Array) -> Array:
    """Return deflection and three derivatives: the left end's shapes are mirrored ones."""
    phase = np.full_like(xi, z)
    right, left = (np.array(functions.bending_shapes(phase, at)) for at in (xi, 1.0 - xi))
    mirror = np.array([1.0, -1.0, 1.0, -1.0])[:, None]
    total = right[:4] * ends[4] + right[4:] * (length * ends[5])
    total += mirror * (left[:4] * ends[1] - left[4:] * (length * ends[2]))
    return np.asarray(total / length ** np.arange(4.0)[:, None])


def _along(xi: Array, b: float, length: float, ends: Array) -> Array:
    phase = np.full_like(xi, b)
    right, left = (np.array(functions.axial_shapes(phase, at)) for at in (xi, 1.0 - xi))
    total = right * ends[3] + np.array([[1.0], [-1.0]]) * left * ends[0]
    return np.asarray(total / length ** np.arange(2.0)[:, None])


@dataclass(frozen=True, kw_only=True)
class FrameFrequencies(Result):
    """Natural frequencies of a structure of beams.

    Attributes
    ----------
    frequencies : ndarray, shape (n,)
        Ascending [rad/s], each as often as its multiplicity.
    multiplicity : ndarray, shape (n,)
        How many cannot be told apart within their errors.
    modes : tuple of Mode
        Their shapes; empty where the problem has no members.
    problem : Transcendental
        What they are frequencies of.
    error : ndarray, shape (n,)
        Bound of the error of each [rad/s].
    """

    frequencies: Array
    multiplicity: NDArray[np.int64]
    modes: tuple[Mode, ...]
    problem: Transcendental

    arrays_along: ClassVar = {"mode": "frequencies multiplicity error hertz"}
    exported: ClassVar[tuple[str, ...]] = ("hertz",)
    column_units: ClassVar = {"rad/s": "error"}

    @property
    def hertz(self) -> Array:
        """The frequencies in Hz."""
        return self.frequencies / (2.0 * np.pi)

    def vectors(self) -> Array:
        """Return the displacements of the nodes in each mode, ``(n, free)``.

        In the order of ``problem.labels`` [m, rad], of unit generalised mass; all zero where the
        nodes stand still.

        Raises ``BadInput`` if there are no shapes.
        """
        problem = self._members()
        places = {label: i for i, label in enumerate(problem.labels)}
        found = np.zeros((len(self.modes), len(places)))
        for row, mode in zip(found, self.modes, strict=True):
            inner = mode.problem.assembly.reduction @ mode.vector
            for label, value in zip(mode.problem.labels, inner, strict=True):
                if label in places:
                    row[places[label]] = value
        return found

    def shape(self, mode: int, beam: str, eta: ArrayLike) -> MemberShape:
        """Return the exact shape of a beam in a mode.

        Parameters
        ----------
        mode : int
            Which of the modes, from 0.
        beam : str
            Its name.
        eta : array_like, shape (m,)
            Places along it, in lengths, 0 to 1.

        Raises
        ------
        BadInput
            If there are no shapes, no such mode or beam, or a place lies outside.
        """
        self._members()
        if not is_whole(mode, 0, len(self.modes) - 1):
            raise bad("mode", repr(mode), f"0 to {len(self.modes) - 1}", "ask for more frequencies")
        chosen = self.modes[mode]
        places = numbers_in_a_row("eta", eta)
        if not np.all((places >= 0.0) & (places <= 1.0)):
            raise bad("eta", repr(eta), "places from 0 to 1 in a row", "divide by the length")
        assembly = chosen.problem.assembly
        own = [k for k, piece in enumerate(assembly.pieces) if piece.beam.name == beam]
        if not own:
            known = ", ".join(dict.fromkeys(piece.beam.name for piece in assembly.pieces))
            raise bad("beam", repr(beam), f"one of {known}", "correct the name")
        z, b = assembly.members.phases(chosen.omega)
        whole = assembly.pieces[own[0]].beam.length
        starts = np.array([assembly.pieces[k].start for k in own]) / whole
        which = np.clip(np.searchsorted(starts, places, side="right") - 1, 0, len(own) - 1)
        rows = np.zeros((6, len(places)))
        for number, k in enumerate(own):
            here = which == number
            length = assembly.pieces[k].length
            inner = np.clip((places[here] - starts[number]) * whole / length, 0.0, 1.0)
            ends = assembly.local[k] @ chosen.vector
            rows[1:5, here] = _across(inner, float(z[k]), length, ends)
            rows[np.ix_([0, 5], here)] = _along(inner, float(b[k]), length, ends)
        along, across, slope, curvature, third, strain = rows
        turned = (along + 1j * across) * np.exp(1j * assembly.angles[own[0]])
        fixed = np.stack([turned.real, turned.imag], axis=-1)
        return MemberShape(places, along, across, slope, curvature, third, strain, fixed)

    def _members(self) -> DynamicStiffness:
        if not isinstance(self.problem, DynamicStiffness):
            fix = "build it with dynamic_stiffness()"
            raise bad("problem", "one without members", "a structure of beams", fix)
        return self.problem

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the frequencies [Hz] over their number, those of several modes marked."""
        axes = axes_or_new(ax)
        number = np.arange(1, len(self.frequencies) + 1)
        axes.plot(number, self.hertz, "o", ms=4)
        several = self.multiplicity > 1
        axes.plot(number[several], self.hertz[several], "s", ms=9, mfc="none", label="multiple")
        if several.any():
            axes.legend()
        axes.locator_params(axis="x", integer=True)
        axes.set(xlabel="mode", ylabel="natural frequency [Hz]")
        return axes


def wittrick_williams(
    problem: Transcendental, *, upto: float | None = None, count: int | None = None
) -> FrameFrequencies:
    """Return the natural frequencies of a transcendental eigenproblem, all of them.

    The number of frequencies below any trial frequency is that of the clamped members plus the
    number of negative eigenvalues of the dynamic stiffness (Aannaque (5.21)).  Bisection on that
    number isolates each frequency; Newton's method on the eigenvalue that goes through zero brings
    it to the last digits, with members divided where the nodes would stand still; counts on both
    sides confirm it.

    Parameters
    ----------
    problem : Transcendental
        From :func:`dynamic_stiffness`; of another one, an emitted one say, frequencies are found
        by bisection alone, to 1e-12, and there are no shapes.
    upto : float, optional
        All frequencies below this one [rad/s].
    count : int, optional
        That many frequencies, the lowest ones; give one of the two.

    Returns
    -------
    FrameFrequencies
        A frequency stands as often as its multiplicity; motions that meet no stiffness stand as
        frequencies 0 in front.

    Raises
    ------
    BadInput
        If not exactly one of ``upto`` and ``count`` is given, or one is not usable.

    Examples
    --------
    >>> import elastolink as el
    >>> bar = el.Section.rectangle(0.02, 0.01, modulus=210e9, density=7850.0)
    >>> pinned = {"A": ("x", "y"), "B": ("x", "y")}
    >>> beam = el.frame({"A": (0, 0), "B": (1, 0)}, {"beam": ("A", "B")}, bar, supports=pinned)
    >>> print(el.wittrick_williams(el.dynamic_stiffness(beam), count=3).frequencies.round(2))
    [ 147.36  589.45 1326.25]
    """
    _check(upto, count)
    require_kind("problem", problem, Transcendental, "make one with dynamic_stiffness")
    modes: list[Mode] = []
    if isinstance(problem, DynamicStiffness):
        method = "Wittrick-Williams count, Newton's method on the eigenvalue of D"
        modes, total = _solved(problem, upto, count)
        omega, error = np.array([(mode.omega, mode.error) for mode in modes]).reshape(-1, 2).T
    else:
        method = "Wittrick-Williams count, bisection"
        omega, error, total = _bisected(problem, upto, count)
    chosen = slice(count if upto is None else int(np.sum(omega < upto)))
    checks = {"frequencies not found": Check(float(abs(len(omega) - total)), 0.0)}
    if isinstance(problem, DynamicStiffness):
        uncertain = sum(not mode.certified for mode in modes[chosen])
        checks["frequencies that counts do not confirm"] = Check(float(uncertain), 0.0)
    # Those no farther from each other than their errors are a group.
    apart = np.append(True, np.diff(omega) > error[1:] + error[:-1])
    group = np.cumsum(apart[: len(omega)])
    return FrameFrequencies(
        frequencies=omega[chosen],
        multiplicity=np.bincount(group)[group][chosen],
        modes=tuple(modes[chosen]),
        problem=problem,
        method=method,
        error=error[chosen],
        error_norm="each frequency, absolute [rad/s]",
        error_kind="bound",
        checks=checks,
        provenance=provenance(problem.provenance),
    )


def _bisected(
    problem: Transcendental, upto: float | None, count: int | None
) -> tuple[Array, Array, int]:
    """Return the frequencies of a problem by bisection on their number, their errors, and it."""

    def counted(omega: float) -> tuple[float, int]:
        return omega, int(problem.count(omega))

    high, total = counted(upto) if upto is not None else _above(counted, 1e-3, count or 1)
    found = isolate(
        counted,
        Interval(0.0, high, 0, total),
        lambda item: item.high - item.low <= 1e-12 * item.high,
    )
    number = [item.last - item.first for item in found]
    ends = np.repeat([(item.low, item.high) for item in found], number, axis=0).reshape(-1, 2)
    return ends.mean(axis=1), np.diff(ends)[:, 0] / 2.0, total


def _solved(
    problem: DynamicStiffness, upto: float | None, count: int | None
) -> tuple[list[Mode], int]:
    """Return the modes of a structure, and how many there are to be."""
    _, vectors = modal(problem.assembly, 0.0)
    forms, _, sizes = quadratic_forms(problem.assembly, 0.0, vectors)
    # Motions whose strain energy is below this, over the sizes of its terms, meet no stiffness.
    soft = np.abs(np.diagonal(forms)) <= 1e-11 * sizes
    modes = [Mode(0.0, 0.0, problem, vector, True) for vector in vectors.T[soft]]
    counted = partial(certain_count, problem)
    low, total = _below_all(problem, len(modes)), len(modes)
    high = upto if upto is not None else _above(counted, low, count or 1)[0]
    if high > low:
        high, total = counted(high)
        whole = Interval(low, high, len(modes), total)
        for item in isolate(counted, whole, partial(_solvable, problem)):
            modes += solve(problem, item)
    return modes, total


def _below_all(problem: DynamicStiffness, rigid: int) -> float:
    """Return a frequency below all that are not 0."""
    members = problem.assembly.members
    # Of the size of the members' own.
    low = float(np.min(np.sqrt(members.bending / members.mass) / members.length**2))
    for _ in range(200):
        low, found = certain_count(problem, low)
        if found <= rigid:
            return low
        low /= 4.0
    motion = "a motion that meets next to no stiffness"
    fix = "hold the structure, or stiffen the soft spring"
    raise bad("structure", motion, "frequencies well above 0", fix)


def _above(counted: Counted, low: float, count: int) -> tuple[float, int]:
    """Return a frequency with at least so many below, and how many."""
    high = low
    for _ in range(400):
        high, found = counted(1.7 * high)
        if found >= count:
            return high, found
    raise bad("count", str(count), "fewer frequencies", "ask for fewer")


def _check(upto: float | None, count: int | None) -> None:
    problems = []
    if (upto is None) == (count is None):
        found = "neither" if upto is None else "both"
        problems.append(Problem("upto, count", found, "one of the two", "choose"))
    if upto is not None and not (is_finite(upto) and upto > 0):
        problems.append(Problem("upto", repr(upto), "a positive frequency [rad/s]", "correct it"))
    if count is not None and not is_whole(count, 1):
        problems.append(Problem("count", repr(count), "a whole number from 1", "correct it"))
    refuse(problems)
