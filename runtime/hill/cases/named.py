"""Named equations of Hill's kind and their classical notations: Mathieu, Whittaker-Hill, Meissner.

Each gives its periodic function(s) in the notation of the toolkit, ``y'' + (lam2 + mu f(theta)) y
= 0`` with f of period 2 pi, and turns parameters from one notation into the other.  Times scaled
by ``theta = 2 x`` divide all the coefficients by four.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.errors import bad
from ...core.inputs import is_whole
from ...core.periodic_function import PeriodicFunction
from ...core.results import BROADCAST, Result, provenance
from ..exact.matrix import Boundaries, hill_boundaries
from ..half_trace import finite
from ..transfer import EPS
from .meissner import meissner_boundaries

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
Kind = Literal["a", "b"]

_LARGEST_NUMBER = 500
_LARGEST_Q = 1e6
_MOST_HARMONICS = 100_000


@dataclass(frozen=True)
class Mathieu:
    """Mathieu's equation ``y'' + (a - 2 q cos 2x) y = 0`` (DLMF 28.2.1).

    With ``theta = 2 x`` it is ``y'' + (lam2 + mu cos theta) y = 0`` with ``lam2 = a/4`` and
    ``mu = -q/2``.

    Attributes
    ----------
    a, q : float or ndarray
        The parameters, which broadcast.
    """

    a: ArrayLike
    q: ArrayLike

    @staticmethod
    def function() -> PeriodicFunction:
        """Return f = cos theta."""
        return PeriodicFunction([0.0, 1.0])

    @property
    def lam2(self) -> Array:
        """``a / 4``."""
        return 0.25 * finite("a", self.a)

    @property
    def mu(self) -> Array:
        """``-q / 2``."""
        return -0.5 * finite("q", self.q)

    @classmethod
    def from_hill(cls, lam2: ArrayLike, mu: ArrayLike) -> Mathieu:
        """Return the equation with given lam2 and mu of f = cos theta."""
        return cls(4.0 * finite("lam2", lam2), -2.0 * finite("mu", mu))

    @classmethod
    def from_cosine(cls, d: ArrayLike, eps: ArrayLike) -> Mathieu:
        """Return ``y'' + (d + eps cos 2t) y = 0`` (Aannaque 7.2.3): a = d, q = -eps/2."""
        return cls(finite("d", d), -0.5 * finite("eps", eps))

    @property
    def d(self) -> Array:
        """The d of ``y'' + (d + eps cos 2t) y = 0``: a."""
        return finite("a", self.a)

    @property
    def eps(self) -> Array:
        """The eps of ``y'' + (d + eps cos 2t) y = 0``: -2 q."""
        return -2.0 * finite("q", self.q)


@dataclass(frozen=True)
class WhittakerHill:
    """The equation of Whittaker and Hill, ``y'' + (A + B cos 2x + C cos 4x) y = 0``.

    With ``theta = 2 x`` it is ``y'' + (lam2 + eps_1 cos theta + eps_2 cos 2 theta) y = 0`` with
    ``lam2 = A/4``, ``eps_1 = B/4``, ``eps_2 = C/4``: a case of two parameters.

    Attributes
    ----------
    constant, first, second : float or ndarray
        A, B and C, which broadcast.
    """

    constant: ArrayLike
    first: ArrayLike
    second: ArrayLike

    @staticmethod
    def functions() -> tuple[PeriodicFunction, PeriodicFunction]:
        """Return f_1 = cos theta and f_2 = cos 2 theta."""
        return PeriodicFunction([0.0, 1.0]), PeriodicFunction([0.0, 0.0, 1.0])

    @property
    def lam2(self) -> Array:
        """``A / 4``."""
        return 0.25 * finite("constant", self.constant)

    @property
    def parameters(self) -> tuple[Array, Array]:
        """``(B / 4, C / 4)``, to pass as ``mu``."""
        return 0.25 * finite("first", self.first), 0.25 * finite("second", self.second)

    @classmethod
    def from_hill(cls, lam2: ArrayLike, first: ArrayLike, second: ArrayLike) -> WhittakerHill:
        """Return the equation with given lam2 and factors of cos theta and cos 2 theta."""
        given = {"lam2": lam2, "first": first, "second": second}
        return cls(*(4.0 * finite(name, value) for name, value in given.items()))

    @classmethod
    def ince(cls, eta: ArrayLike, p: ArrayLike, xi: ArrayLike) -> WhittakerHill:
        """Return the equation that Ince's equation turns into (DLMF 28.31.2).

        ``A = eta - xi^2/8``, ``B = -(p + 1) xi``, ``C = xi^2/8``.  For a whole number p >= 0 two
        independent solutions of the same period coexist on the boundaries of all the regions
        p + 2, p + 4, ...: these are closed.
        """
        e, n, x = finite("eta", eta), finite("p", p), finite("xi", xi)
        return cls(e - x * x / 8.0, -(n + 1.0) * x, x * x / 8.0)


@dataclass(frozen=True)
class Meissner:
    """Meissner's equation: f takes two values in turn.

    Attributes
    ----------
    levels : tuple of float
        Value of f on the first interval, which begins at theta = 0, and on the second.
    lengths : tuple of float
        Their lengths [rad], together 2 pi.
    """

    levels: tuple[float, float] = (1.0, -1.0)
    lengths: tuple[float, float] = (pi, pi)

    def __post_init__(self) -> None:
        """Refuse levels that are not numbers and lengths that do not make a turn."""
        levels, lengths = finite("levels", self.levels), finite("lengths", self.lengths)
        if levels.shape != (2,) or lengths.shape != (2,):
            raise bad("Meissner", f"{levels.shape}, {lengths.shape}", "two of each", "give pairs")
        if lengths.min() <= 0.0 or abs(float(lengths.sum()) - 2.0 * pi) > 1e-12:
            raise bad(
                "lengths", tuple(self.lengths), "two positive lengths, together 2 pi", "scale them"
            )

    @property
    def jump(self) -> float:
        """First level less the second."""
        return self.levels[0] - self.levels[1]

    def __call__(self, theta: ArrayLike) -> Array:
        """Evaluate f itself at angles [rad] of any shape."""
        place = np.mod(finite("theta", theta), 2.0 * pi)
        return np.asarray(np.where(place < self.lengths[0], *self.levels))

    def function(self, harmonics: int = 64) -> PeriodicFunction:
        """Return the Fourier series cut after a harmonic, for solvers that want one.

        The coefficients fall like 1/m.  Beside a jump the sum stays half the jump away from f
        whatever the number of harmonics, and so ``error`` is half the jump: for the boundaries
        themselves that is far too much, and :meth:`boundaries` has them in closed form.

        Raises
        ------
        BadInput
            If ``harmonics`` is not a whole number from 1 to 100000.
        """
        if not is_whole(harmonics, 1, _MOST_HARMONICS):
            expected = f"a whole number from 1 to {_MOST_HARMONICS}"
            raise bad("harmonics", repr(harmonics), expected, "correct it")
        m = np.arange(1, harmonics + 1)
        # Whole turns are taken off before the multiplication by pi: sin(m pi) is an exact zero.
        turn = np.mod(m * (self.lengths[0] / pi), 2.0)
        half = 0.5 * turn * pi
        sine = np.where(turn % 1.0 == 0.0, 0.0, np.sin(turn * pi))
        size = self.jump / (pi * m)
        mean = float(np.dot(self.levels, self.lengths)) / (2.0 * pi)
        a = np.concatenate([[mean], size * sine])
        b = np.concatenate([[0.0], size * (2.0 * np.sin(half) ** 2)])
        # Round-off of a sum of so many terms.
        noise = 4.0 * EPS * (abs(mean) + abs(self.jump) * harmonics)
        return PeriodicFunction(a, b, error=0.5 * abs(self.jump) + noise)

    def boundaries(self, mu: ArrayLike, regions: Sequence[int] = (1, 2)) -> Boundaries:
        """Return the exact boundaries; see :func:`meissner_boundaries`."""
        return meissner_boundaries(mu, regions, self.levels, self.lengths)


@dataclass(frozen=True, kw_only=True)
class MathieuCharacteristic(Result):
    """A characteristic value of Mathieu's equation.

    Attributes
    ----------
    value : ndarray
        ``a_m(q)`` or ``b_m(q)``, in the shape of q.
    error : ndarray
        Estimate of the absolute error.
    q : ndarray
        As given.
    m : int
        Number of the value.
    kind : str
        ``"a"`` (even solutions) or ``"b"`` (odd solutions).
    """

    value: Array
    q: Array
    m: int
    kind: str

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = dict.fromkeys(
        ("value", "error", "q", "relative_error"), BROADCAST
    )
    exported: ClassVar[tuple[str, ...]] = ("relative_error",)

    @property
    def relative_error(self) -> Array:
        """``error / |value|``; infinite where the value is zero."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(np.where(self.error == 0.0, 0.0, self.error / np.abs(self.value)))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the value over q.

        Raises
        ------
        BadInput
            If q is not one-dimensional.
        """
        from ...core.plotting import axes_or_new

        if self.q.ndim != 1:
            shape = f"q of shape {self.q.shape}"
            raise bad("MathieuCharacteristic.plot", shape, "a line of q", "slice it")
        ax = axes_or_new(ax)
        ax.plot(self.q, self.value)
        ax.set_xlabel("$q$")
        ax.set_ylabel(f"${self.kind}_{{{self.m}}}$")
        return ax


def mathieu_characteristic(m: int, q: ArrayLike, kind: Kind = "a") -> MathieuCharacteristic:
    """Return the characteristic value a_m(q) or b_m(q) of ``y'' + (a - 2 q cos 2x) y = 0``.

    Parameters
    ----------
    m : int
        Number, from 0 for ``"a"`` and from 1 for ``"b"``, at most 500.
    q : array_like
        Any shape, any sign, ``|q| <= 1e6``.
    kind : {"a", "b"}
        Even or odd solutions.

    Returns
    -------
    MathieuCharacteristic
        For ``|q| <= 1e4`` good to 12 digits of ``max(|value|, 2 |q|)``; near a zero of the value
        its relative error is larger, as stated.  The check is that of :func:`hill_boundaries`.

    Raises
    ------
    BadInput
        If m, q or kind is out of range.

    Notes
    -----
    DLMF 28.2(v).  For q > 0 region m of the toolkit reaches from b_m / 4 to a_m / 4; for q < 0 and
    odd m the two change places, ``a_m(-q) = b_m(q)``.
    """
    if kind not in ("a", "b"):
        raise bad("kind", repr(kind), "'a' or 'b'", "choose one")
    least = 0 if kind == "a" else 1
    if not is_whole(m, least, _LARGEST_NUMBER):
        expected = f"a whole number from {least} to {_LARGEST_NUMBER}"
        raise bad("m", repr(m), expected, "correct it")
    values = finite("q", q)
    if values.size and float(np.abs(values).max()) > _LARGEST_Q:
        raise bad("q", float(np.abs(values).max()), f"at most {_LARGEST_Q:g}", "correct it")
    found = hill_boundaries(Mathieu.function(), -0.5 * values, (int(m),))
    lower, upper = found.lower[0], found.upper[0]
    odd_solution_below = (values >= 0.0) | (m % 2 == 0)
    take_upper = odd_solution_below if kind == "a" else ~odd_solution_below
    # Multiplication by four is exact.
    return MathieuCharacteristic(
        method="Hill matrix",
        error=4.0 * found.error[0],
        error_norm="absolute, entrywise",
        checks=found.checks,
        provenance=provenance(),
        value=np.asarray(4.0 * np.where(take_upper, upper, lower)),
        q=values,
        m=int(m),
        kind=kind,
    )
