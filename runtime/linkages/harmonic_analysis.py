"""Harmonics of any function of the crank angle by FFT, with an aliasing check and an accuracy."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import bad
from ..core.inputs import require_whole
from ..core.periodic_function import PeriodicFunction
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check, Result, provenance
from ..core.trigonometric import GOLDEN, irregular_angles, values_at
from .linkage import EPS, TURN, Array

Function = Callable[[Array], ArrayLike]
Source: TypeAlias = Function | tuple[Any, ...]

_PROBES = 257


@dataclass(frozen=True, kw_only=True)
class Harmonics(Result):
    """Harmonics of a function of the crank angle.

    The function is ``secular theta + a[0] + sum_m (a[m] cos m theta + b[m] sin m theta)`` and what
    lies beyond the order.  ``error`` is that of every coefficient, absolute.

    Attributes
    ----------
    name : str
        What was analysed.
    a, b : ndarray, shape (order + 1,)
        Cosine and sine coefficients; ``a[0]`` is the mean of the periodic part, ``b[0]`` is zero.
    secular : float
        Growth per radian of crank angle: the whole number of turns that an angle makes in each
        turn of the crank (theta4 of a drag link: 1), else 0.
    largest : float
        Largest size of the periodic part that was met.
    remainder : float
        Estimate of the largest deviation of the harmonics up to the order from the function.
    evaluations : int
        Angles at which the function was asked for.

    Notes
    -----
    No set of samples shows a feature that is narrower than their spacing.  A function that seems
    constant is therefore asked for at 131072 angles and more, and ``error`` then admits a pulse
    between two of them, as high as the constant or as 1, whichever is more.  Of other functions
    it is assumed that nothing hides in less than 1/64 of a turn.
    """

    name: str
    a: Array
    b: Array
    secular: float
    largest: float
    remainder: float
    evaluations: int

    arrays_along: ClassVar = {"harmonic": "a b amplitude phase"}
    exported: ClassVar[tuple[str, ...]] = ("amplitude", "phase")
    column_units: ClassVar = {"rad": "phase"}

    @property
    def order(self) -> int:
        """The highest harmonic."""
        return len(self.a) - 1

    @property
    def amplitude(self) -> Array:
        """Amplitude of each harmonic, ``|a[0]|`` the first, shape (order + 1,)."""
        return np.hypot(self.a, self.b)

    @property
    def phase(self) -> Array:
        """Phase [rad] in ``amplitude cos(m theta - phase)``, shape (order + 1,)."""
        return np.arctan2(self.b, self.a)

    @property
    def series(self) -> PeriodicFunction:
        """The periodic part up to the order; its error is ``remainder``."""
        return PeriodicFunction(self.a, self.b, error=self.remainder)

    def __call__(self, theta: ArrayLike) -> Array:
        """Return secular part and harmonics at angles [rad] of any shape."""
        return np.asarray(self.secular * np.asarray(theta, dtype=float) + self.series(theta))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw cosine and sine coefficients as bars beside each other (Smith Fig. 7)."""
        ax = axes_or_new(ax)
        m = np.arange(1, self.order + 1)
        ax.bar(m - 0.2, self.a[1:], 0.38, color="tab:blue", label="cosine $a_m$")
        ax.bar(m + 0.2, self.b[1:], 0.38, color="tab:orange", label="sine $b_m$")
        ax.axhline(0.0, color="0.4", lw=0.8)
        growth = f", growing by {self.secular:g} per radian" if self.secular else ""
        mean = self.a[0] if abs(self.a[0]) > self.error else 0.0
        ax.set(
            title=f"{self.name}: mean {mean:.6g}{growth}", xlabel="harmonic", ylabel="coefficient"
        )
        if self.order <= 24:
            ax.set_xticks(m)
        ax.legend()
        return ax


def harmonics(source: Source, *, order: int = 8, accuracy: float = 1e-12) -> Harmonics:
    """Return the harmonics of a function of the crank angle (Smith 2.6).

    Parameters
    ----------
    source : callable, (Linkage, str) or (Machine, str, float)
        A vectorised function of the crank angle [rad], shape (n,) to shape (n,); or a linkage and
        the name of a place or rate of its motion (``"theta4"``, ``"omega3"``, ``"position"``); or a
        machine, the name of a force (``"x34"``, ``"torque"``, ``"shaking_moment"``) and the
        constant crank speed [rad/s].
    order : int
        Highest harmonic wanted, 1 to 4096.
    accuracy : float
        Wanted size of the error of each coefficient, over the largest size of the function.

    Returns
    -------
    Harmonics
        Its check "change on doubling" fails where the accuracy is out of reach with 131072
        angles - a function that jumps, or noise - and ``error`` says what was reached.

    Raises
    ------
    BadInput
        If a value is not finite, the function is not periodic (an angle may grow by whole turns
        in a turn), the linkage's crank cannot turn, or a number is impossible.

    Notes
    -----
    The angles are doubled until two doublings in a row change no coefficient by more than the
    accuracy.  Each set starts at another, irrational part of its spacing: a harmonic of thousands,
    which regular sets of 64, 128, 256 angles all take for a mean, then shows at once.  Before it
    ends, the whole series is compared with the function at irregular angles.

    Examples
    --------
    >>> import elastolink as el
    >>> import numpy as np
    >>> print(el.harmonics(lambda theta: np.cos(theta) ** 3, order=3).amplitude.round(6))
    [0.   0.75 0.   0.25]
    """
    name, f, known = _function(source)
    require_whole("order", order, 1, 4096)
    if not (isinstance(accuracy, (int, float)) and 0.0 < accuracy < 1.0):
        raise bad("accuracy", repr(accuracy), "a number between 0 and 1", "try 1e-12")
    f, secular, growing = _without_growth(f, name)
    count = max(64, 4 * 2 ** int(np.ceil(np.log2(order + 1))))
    probes = irregular_angles(_PROBES)
    at_probes = values_at(f, probes, name)
    largest, evaluations = float(np.max(np.abs(at_probes))), _PROBES + 2
    before: np.ndarray[Any, Any] | None = None
    changes: list[float] = []
    while True:
        settled = False
        # From an irrational part of a step on; the highest coefficient is known in part alone.
        start = (GOLDEN * np.log2(count)) % 1.0
        theta = np.asarray(TURN * (np.arange(count) + start) / count, dtype=np.float64)
        values = values_at(f, theta, name)
        full = np.fft.rfft(values)[:-1] / count
        full *= np.exp(-1j * TURN * start / count * np.arange(len(full)))
        full[1:] *= 2.0
        evaluations += count
        largest = max(largest, float(np.max(np.abs(values))))
        # A pulse that one set has met and the next ones miss must not be forgotten.
        ends = [int(np.argmin(values)), int(np.argmax(values))]
        probes = np.concatenate([probes, theta[ends]])
        at_probes = np.concatenate([at_probes, values[ends]])
        constant = bool(np.ptp(at_probes) <= 4.0 * EPS * largest)
        low = full[: order + 1]
        if before is not None:
            changes.append(float(np.max(np.abs(low - before))))
        before = low
        goal = accuracy * largest
        if len(changes) > 1 and max(changes[-2:]) <= goal:
            gap = float(np.max(np.abs(at_probes - _series(full)(probes))))
            # What the samples do not show may be folded into a coefficient whole.
            settled = gap <= max(1e3 * goal, 1e-11 * largest)
            # Nothing but a constant: a pulse may lie between the samples.
            if settled and not constant:
                break
        if 2 * count > 2**17:
            break
        count *= 2
    series = _series(low)
    rest = float(np.max(np.abs(at_probes - series(probes))))
    dropped = float(np.sum(np.abs(full[order + 1 :])))
    error = 2.0 * _last_change(changes, settled) + 2.0 * EPS * largest
    if constant:
        # A pulse between two samples, of this height or of 1: 2/turn times its area.
        error += 2.0 * max(largest, 1.0) / count
    change = max(changes[-2:]) / max(largest, 5e-324)
    return Harmonics(
        name=name,
        a=series.a,
        b=series.b,
        secular=secular,
        largest=largest,
        remainder=max(2.0 * rest, min(dropped, 4.0 * rest)) + error,
        evaluations=evaluations,
        method="FFT",
        error=error + growing,
        error_norm="largest error of a coefficient, absolute",
        checks={"change on doubling over the largest value": Check(change, accuracy)},
        provenance=provenance(known),
    )


def _series(coefficients: np.ndarray[Any, Any]) -> PeriodicFunction:
    """Return the function of coefficients ``a - i b``."""
    b = -coefficients.imag
    b[0] = 0.0
    return PeriodicFunction(coefficients.real, b)


def _last_change(changes: list[float], settled: bool) -> float:
    """Return the last change of a coefficient, or what slow convergence leads one to expect."""
    # Where the changes fall by less than a thousand a time, or have not settled in the end - a
    # function that jumps, or noise - the last one may be small by chance.
    worst = changes[-1]
    if not settled:
        # A pulse that few samples meet: the changes it makes halve with the spacing.
        return float(max(change / 2**back for back, change in enumerate(changes[:-6:-1])))
    for back, (before, after) in enumerate(zip(changes[-2::-1], changes[:0:-1], strict=True), 1):
        if after <= 1e-3 * before or back > 2:
            break
        worst = max(worst, before / 4**back)
    return worst


def _function(source: Source) -> tuple[str, Function, dict[str, str]]:
    """Return name, function and provenance of a source, or raise BadInput."""
    if callable(source) and not isinstance(source, type):
        return str(getattr(source, "__name__", type(source).__name__)), source, {}
    forms = "write f, (linkage, 'theta4') or (machine, 'torque', 10.0)"
    if not (isinstance(source, tuple) and len(source) > 1):
        expected = "a callable, (linkage, name) or (machine, name, speed)"
        raise bad("source", type(source).__name__, expected, forms)
    what, name, *drive = source
    try:
        function = what.course(name, *drive)
    except (AttributeError, TypeError) as refusal:
        expected = "a linkage and a name, or a machine, a name and a speed"
        given = ", ".join(type(item).__name__ for item in source)
        raise bad("source", f"({given})", expected, forms) from refusal
    speed = {"speed": repr(float(drive[0]))} if drive else {}
    return name, function, {**what.provenance, **speed}


def _without_growth(f: Function, name: str) -> tuple[Callable[[Array], Array], float, float]:
    """Return the function less its whole turns in a turn, how many these are, and what is left."""
    ends = values_at(f, np.array([0.5, 0.5 + TURN]), name)
    growth = float(ends[1] - ends[0])
    turns = float(np.rint(growth / TURN))
    gap = abs(growth - turns * TURN)
    # A gap over one turn up to this part of the function's size is noise, and enters the error.
    if gap > 1e-5 * max(float(np.max(np.abs(ends))), 5e-324):
        found = f"a change of {growth:.6g} over one turn"
        expected = "a function of period 2 pi, or an angle that grows by whole turns"
        raise bad(f"function {name!r}", found, expected, "check its period, or take off what grows")

    def periodic(theta: Array) -> Array:
        values = values_at(f, theta, name)
        return np.asarray(values - turns * theta) if turns else values

    # Round-off of the two angles is no gap.
    return periodic, turns, gap if gap > 1e-11 * float(np.max(np.abs(ends))) else 0.0
