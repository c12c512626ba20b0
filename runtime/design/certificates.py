"""Proof that a damped system is stable at every crank speed of a range."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from ..core.errors import bad
from ..core.families import Array, LinearPeriodic, require_system
from ..core.inputs import require_between, speed_span
from ..core.plotting import RPM, Axes, axes_or_new
from ..core.results import Check, Result, provenance
from ..periodic import floquet_multipliers
from ..periodic.equation import SPEED_POWER

if TYPE_CHECKING:
    from .enclosures import Band, Matrices, Revolution

# Part of the way from the largest multiplier to 1 at which a bound is tried; what a multiplier that
# is told to occur is lowered by; intervals, and speeds of each, compared with computed multipliers;
# part of the range over which the matrix has to be enclosed.
_PART, _LOWER, _COMPARED, _PLACES, _COARSE = 0.1, (1e-6, 1e-4, 1e-2), 5, 13, 1.0 / 256.0


@dataclass(frozen=True, kw_only=True)
class Certificate(Result):
    """Speeds at which a system is proved stable, proved unstable, or neither.

    Together the three kinds of intervals cover the range; intervals hold their ends.

    Attributes
    ----------
    proved : ndarray, shape (k, 2)
        Intervals of crank speed [rad/s] at which the equilibrium is asymptotically stable.
    bound : ndarray, shape (k,)
        What every multiplier of a period is smaller than in modulus, at every speed of each.
    open : ndarray, shape (m, 2)
        Intervals [rad/s] where nothing could be proved.
    unstable : ndarray, shape (j, 2)
        Intervals [rad/s] with a multiplier outside the unit circle at every speed.
    """

    proved: Array
    bound: Array
    open: Array
    unstable: Array

    arrays_along: ClassVar = {
        "proved end": "proved",
        "proved": "bound error",
        "open end": "open",
        "unstable end": "unstable",
    }
    column_units: ClassVar = {"rad/s": "proved open unstable"}

    @property
    def stable(self) -> bool:
        """Whether the system is proved stable at every speed of the range, and its check passed."""
        return self.passed and len(self.open) == len(self.unstable) == 0

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw what is proved over the speed, and the bounds of the multipliers."""
        ax = axes_or_new(ax)
        for (low, high), bound in zip(self.proved * RPM, self.bound, strict=True):
            ax.plot((low, high), (bound, bound), color="tab:green")
        for name, color, spans in (
            ("proved stable", "tab:green", self.proved),
            ("proved unstable", "tab:red", self.unstable),
            ("not proved", "0.5", self.open),
        ):
            for k, (low, high) in enumerate(spans * RPM):
                label = name if k == 0 else None
                ax.axvspan(low, high, color=color, alpha=0.3, label=label)
        ax.axhline(1.0, color="0.3", linewidth=0.8)
        ax.set(xlabel="crank speed [rpm]", ylabel="bound of the multipliers")
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, frameon=False)
        return ax


class _Piece(NamedTuple):
    """An interval of speed; ``stable`` is None where it is open."""

    low: float
    high: float
    stable: bool | None
    bound: float = np.nan
    reached: float = np.nan


def certify(
    system: LinearPeriodic, speeds: tuple[float, float], *, resolution: float | None = None
) -> Certificate:
    """Prove that a system is asymptotically stable at every crank speed of a range.

    No speed is sampled.  The coefficients of the equation are enclosed in ball arithmetic, as
    functions of a complex crank angle; power series with proved rests give the matrices of
    segments of the period, and interpolation with proved errors the matrix of the period as
    polynomials of 1/speed.  On an interval of speeds a quadratic form is shown to fall over every
    period, so that all multipliers lie inside a circle, or not all where it is not positive
    (Stein).  Intervals are halved until one or the other is proved, or they are short.

    What is proved holds for the separated equation of the system.  Parameters and lengths are taken
    as exactly the given doubles, and so are the factors of the terms and constant arrays, as they
    were computed.  It is assumed that the functions of the angle have the period of the system; one
    that is 2 pi over a whole number as a double counts as that.

    Parameters
    ----------
    system : LinearPeriodic
        Damped, of one to three coordinates; its functions of the angle must be analytic, and made
        of arithmetic, sine, cosine and roots, as those of emitted modules are.
    speeds : pair of float
        Lowest and highest crank speed [rad/s].
    resolution : float, optional
        Length of an interval that is not halved again [rad/s]; by default 1/10000 of the range.

    Returns
    -------
    Certificate
        Its ``error``: how far each bound may be above the largest multiplier of its interval,
        proved.  Its check ``multipliers``: those of :func:`floquet_multipliers` at 13
        speeds of each of the five longest intervals, over the bounds.

    Raises
    ------
    BadInput
        If an argument is unusable, the system is not damped, has more than three coordinates, or
        a function that cannot be enclosed; or if python-flint is not installed.

    Notes
    -----
    The work rises with the number of oscillations per revolution.  Multipliers within 1e-8 or so
    of the unit circle, as of hardly any damping, are left open.

    Examples
    --------
    >>> import elastolink as el
    >>> scene = el.load_scene("smith_1972_5152_sixteenth_inch", {"coupler.damping": 0.3})
    >>> proof = el.design.certify(scene.system(), (40.0, 40.2))
    >>> print(proof.stable, proof.bound.max() < 1.0)
    True True
    """
    low, high = _checked(system, speeds)
    least = 1e-4 * (high - low) if resolution is None else resolution
    require_between("resolution", least, 1e-9 * high, high, "try 1/10000 of the range")
    _require_flint()
    from .enclosures import Revolution, require_analytic

    require_analytic(system)
    revolution = Revolution(system, low, high)
    coarse = max(float(least), _COARSE * (high - low))
    pieces = _merged(list(_pieces(revolution, low, high, float(least), coarse)))
    stable = [piece for piece in pieces if piece.stable]
    return Certificate(
        method="enclosed matrices of a period, quadratic forms that fall",
        error=np.array([piece.bound - piece.reached for piece in stable]),
        error_norm="of each bound, above the largest modulus that occurs, absolute",
        error_kind="bound",
        checks=_compared(system, stable),
        provenance=provenance(system.provenance),
        proved=_spans(stable),
        bound=np.array([piece.bound for piece in stable]),
        open=_spans([piece for piece in pieces if piece.stable is None]),
        unstable=_spans([piece for piece in pieces if piece.stable is False]),
    )


def _checked(system: LinearPeriodic, speeds: tuple[float, float]) -> tuple[float, float]:
    """Return the ends of the range; refuse what cannot be certified."""
    require_system(system)
    low, high = speed_span(speeds)
    if system.size > 3:
        raise bad("system", f"{system.size} coordinates", "1 to 3", "take fewer modes")
    if not system.is_damped():
        fix = "set a damping: multipliers on the unit circle are not proved stable"
        raise bad("system", "no damping", "a damped system", fix)
    for term in system.terms:
        power = term.power + SPEED_POWER.get(term.array, 0)
        if power > 0 or (power and term.array in ("M", "A")):
            found = f"term {term.array} with power {term.power} of the speed"
            raise bad("system", found, "M and A without, others at most the square", "leave it out")
    return low, high


def _require_flint() -> None:
    try:
        import flint  # noqa: F401 - looked for
    except ImportError as missing:
        fix = "python -m pip install python-flint, or elastolink with its extra fast"
        raise bad("certify", "no python-flint", "it installed", fix) from missing


def _pieces(
    source: Revolution | Band | Matrices, low: float, high: float, least: float, coarse: float
) -> Iterator[_Piece]:
    """Yield intervals that cover a range, rising."""
    # What is not enclosed over `coarse` is left open; `least`: of an interval not halved again.
    from .enclosures import Matrices

    if isinstance(source, Matrices):
        yield from _decided(source, low, high, least)
    elif (found := source.over(low, high)) is not None:
        yield from _pieces(found, low, high, least, coarse)
    elif high - low <= coarse:
        yield _Piece(low, high, None)
    else:
        for part in _halves(low, high):
            yield from _pieces(source, *part, least, coarse)


def _halves(low: float, high: float) -> tuple[tuple[float, float], tuple[float, float]]:
    middle = 0.5 * (low + high)
    return (low, middle), (middle, high)


def _decided(matrices: Matrices, low: float, high: float, least: float) -> Iterator[_Piece]:
    """Yield the intervals of a range of speeds, halved where nothing is proved."""
    from .enclosures import all_inside, largest_modulus

    over, last = matrices.over(low, high), high - low <= least
    moduli = {x: largest_modulus(over, x) for x in (0.0, -1.0, 1.0)}
    radius, x = max((modulus, x) for x, modulus in moduli.items())
    for bound in (radius + _PART * (1.0 - radius), 1.0)[: 1 + last] if radius < 1.0 else ():
        if all_inside(over, bound):
            lower = [radius - less for less in _LOWER]
            reached = [r for r in lower if all_inside(over, r, 0.999 * x) is False]
            yield _Piece(low, high, True, bound, max(reached, default=0.0))
            return
    if min(moduli.values()) > 1.0 and all_inside(over, 1.0) is False:
        yield _Piece(low, high, False)
    elif last:
        yield _Piece(low, high, None)
    else:
        for part in _halves(low, high):
            yield from _decided(matrices, *part, least)


def _merged(pieces: list[_Piece]) -> list[_Piece]:
    """Return the intervals, neighbours of one kind as one."""
    found: list[_Piece] = []
    for piece in pieces:
        if found and found[-1].stable is piece.stable:
            last = found.pop()
            bound, reached = max(last.bound, piece.bound), max(last.reached, piece.reached)
            piece = _Piece(last.low, piece.high, piece.stable, bound, reached)
        found.append(piece)
    return found


def _spans(pieces: list[_Piece]) -> Array:
    return np.array([(piece.low, piece.high) for piece in pieces]).reshape(-1, 2)


def _compared(system: LinearPeriodic, stable: list[_Piece]) -> dict[str, Check]:
    """Return the check that multipliers computed otherwise keep to the bounds."""
    if not stable:
        return {}
    longest = sorted(stable, key=lambda piece: piece.low - piece.high)[:_COMPARED]
    speeds = np.array([np.linspace(piece.low, piece.high, _PLACES) for piece in longest])
    moduli = np.max(np.abs(floquet_multipliers(system, speeds).multipliers), axis=-1)
    worst = np.max(moduli / np.array([piece.bound for piece in longest])[:, None])
    return {"multipliers": Check(float(worst), 1.0)}
