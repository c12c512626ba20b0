"""Mathieu's equation in its classical notation, and its characteristic values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import bad
from ..core.inputs import require_whole
from ..core.periodic_function import PeriodicFunction
from ..core.plotting import Axes
from ..core.results import Result, provenance
from .boundaries import hill_boundaries
from .checks import Array, axes_over, finite

Kind = Literal["a", "b"]

_LARGEST_Q = 1e6


@dataclass(frozen=True)
class Mathieu:
    """Mathieu's equation ``y'' + (a - 2 q cos 2x) y = 0`` (DLMF 28.2.1).

    With ``theta = 2 x`` it is ``y'' + (lam2 + mu cos theta) y = 0`` with ``lam2 = a/4`` and
    ``mu = -q/2``; ``y'' + (d + eps cos 2t) y = 0`` (Aannaque 7.2.3) has a = d and q = -eps/2.

    Attributes
    ----------
    a, q : float or ndarray
        The parameters, which broadcast.

    Examples
    --------
    >>> import elastolink as el
    >>> case = el.Mathieu(a=1.0, q=0.2)
    >>> print(el.discriminant(case.function(), case.lam2, case.mu).stable)
    False
    >>> print(el.Mathieu.characteristic(1, q=0.2, kind="a").value.round(6))
    1.194874
    """

    a: ArrayLike
    q: ArrayLike

    def __post_init__(self) -> None:
        finite("a", self.a)
        finite("q", self.q)

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

    @staticmethod
    def characteristic(m: int, q: ArrayLike, kind: Kind = "a") -> MathieuCharacteristic:
        """Return the characteristic value a_m(q) or b_m(q).

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
            For ``|q| <= 1e4`` good to 12 digits of ``max(|value|, 2 |q|)``.  The check is that
            of :func:`.boundaries.hill_boundaries`.

        Raises
        ------
        BadInput
            If m, q or kind is out of range.

        Notes
        -----
        DLMF 28.2(v).  For q > 0 region m reaches from b_m / 4 to a_m / 4; for q < 0 and odd m the
        two change places, ``a_m(-q) = b_m(q)``.
        """
        if kind not in ("a", "b"):
            raise bad("kind", repr(kind), "'a' or 'b'", "choose one")
        m = require_whole("m", m, 0 if kind == "a" else 1, 500)
        values = finite("q", q)
        if values.size and float(np.abs(values).max()) > _LARGEST_Q:
            raise bad("q", float(np.abs(values).max()), f"at most {_LARGEST_Q:g}", "correct it")
        ends = hill_boundaries(Mathieu.function(), -0.5 * values, (m,))
        odd_below = (values >= 0.0) | (m % 2 == 0)
        upper = odd_below if kind == "a" else ~odd_below
        # Multiplication by four is exact.
        return MathieuCharacteristic(
            method="Hill matrix",
            error=4.0 * ends.error[0],
            error_norm="absolute, entrywise",
            checks=ends.checks,
            provenance=provenance(),
            value=np.asarray(4.0 * np.where(upper, ends.upper[0], ends.lower[0])),
            q=values,
            m=m,
            kind=kind,
        )


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

    arrays_along: ClassVar = {"...": "value error q"}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the value over q.

        Raises ``BadInput`` if q is not one-dimensional.
        """
        ax = axes_over(ax, "MathieuCharacteristic.plot", "q", self.q)
        ax.plot(self.q, self.value)
        ax.set(xlabel="$q$", ylabel=f"${self.kind}_{{{self.m}}}$")
        return ax
