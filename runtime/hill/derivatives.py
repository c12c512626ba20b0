"""Derivatives of exact boundaries with respect to any parameter, by their eigenvectors."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import bad
from ..core.periodic_function import PeriodicFunction
from ..core.results import Result, provenance
from .boundaries import hill_boundaries
from .checks import EPS, LARGEST, Array, Mask, check_function, check_regions, points
from .fourier_matrix import LEFT_OUT, finest, layout, matrix, stacked

_COEFFICIENT = re.compile(r"([ab])([0-9]+)")


@dataclass(frozen=True, kw_only=True)
class BoundaryDerivatives(Result):
    """Derivatives of the ends of unstable regions.

    Attributes
    ----------
    lower, upper : ndarray, shape (len(directions), len(regions), *mu.shape)
        d lam2 / d parameter at both ends.  NaN at the lower end of region 0, where damping has
        closed the region or is so near to it that doubles do not resolve the two ends, and for K
        at a double edge (damping closes the region at once).
    error : ndarray, same shape
        Estimate of the absolute error, for either end; NaN where both are.
    double : ndarray of bool, shape (len(regions), *mu.shape)
        True where the two ends coincide within their error: there the derivatives are one-sided,
        for a parameter that grows (for one that falls, the two change places).
    regions : tuple of int
        Numbers n.
    directions : tuple of str
        Names of the parameters; ``"g0"``, ``"g1"``, ... for functions, by their place.
    mu, damping : ndarray
        In their broadcast shape.
    """

    lower: Array
    upper: Array
    double: Mask
    regions: tuple[int, ...]
    directions: tuple[str, ...]
    mu: Array
    damping: Array

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        **dict.fromkeys(("lower", "upper", "error"), ("direction", "region", "mu")),
        "double": ("region", "mu"),
        "regions": ("region",),
        **dict.fromkeys(("mu", "damping"), ("mu",)),
    }


@dataclass(frozen=True)
class _Direction:
    """What a parameter adds to the equation: a function (times mu), or damping."""

    name: str
    function: PeriodicFunction | None
    by_mu: bool = False

    def change(self, odd: int, harmonic: int, mu: float) -> Array:
        """Return the derivative of the matrix whose eigenvalues are lam2."""
        if self.function is None:
            return -layout(odd, harmonic).slope
        factor = -mu if self.by_mu else -1.0
        whole: Array = factor * matrix(self.function, odd, harmonic)
        whole[np.diag_indices_from(whole)] += factor * self.function.a[0]
        return whole


def boundary_derivatives(
    f: PeriodicFunction,
    mu: ArrayLike,
    regions: Sequence[int] = (1, 2),
    directions: Sequence[str | PeriodicFunction] = ("mu",),
    damping: ArrayLike = 0.0,
) -> BoundaryDerivatives:
    """Return how the boundaries of y'' + 2 K y' + (lam2 + mu f) y = 0 move with its parameters.

    Parameters
    ----------
    f : PeriodicFunction
        Coefficient of period 2 pi.
    mu : array_like
        Any shape, any sign.
    regions : sequence of int
        Numbers n >= 0.
    directions : sequence of (str or PeriodicFunction)
        ``"mu"``, ``"K"``, a Fourier coefficient of f such as ``"a0"``, ``"a3"`` or ``"b2"``, or a
        function g: the parameter eps of a further term ``eps g y`` at eps = 0.  A parameter p of a
        scene that enters through mu f has g = d(mu f)/dp.
    damping : array_like
        K, at least zero; broadcasts with mu.

    Returns
    -------
    BoundaryDerivatives
        ``lower``, ``upper`` and ``error`` of shape ``(len(directions), len(regions), *mu.shape)``.

    Raises
    ------
    BadInput
        If a direction is unknown, and as :func:`.boundaries.hill_boundaries`.

    Notes
    -----
    With y the periodic solution on the boundary and z that of the adjoint equation (K to -K; y
    itself without damping), ``d lam2 / d eps = -<z, g y> / <z, y>`` and
    ``d lam2 / d K = -2 <z, y'> / <z, y>``.  Where two ends coincide, the derivatives are the
    eigenvalues of the 2 x 2 matrix ``-<y_i, g y_j>`` of two orthonormal solutions.

    Examples
    --------
    >>> import elastolink as el
    >>> cosine = el.PeriodicFunction(a=[0.0, 1.0])
    >>> found = el.boundary_derivatives(cosine, mu=0.0, regions=(1,))
    >>> print(found.lower.round(6), found.upper.round(6))
    [[-0.5]] [[0.5]]
    """
    check_function(f)
    numbers = check_regions(regions)
    (flat, friction), shape = points(mu=mu, damping=damping)
    if not isinstance(directions, (tuple, list)):
        raise bad("directions", repr(directions), "directions in a row", 'say ("mu", "K")')
    wanted = [_direction(f, item, i) for i, item in enumerate(directions)]
    ends = hill_boundaries(f, flat, numbers, friction)
    out = np.full((3, len(wanted), len(numbers), flat.size), np.nan)
    double: Mask = np.zeros((len(numbers), flat.size), dtype=bool)
    highest = max(numbers, default=0)
    for column in range(flat.size):
        point = float(flat[column]), float(friction[column])
        halves = {odd: _Slice(f, *point, odd, highest) for odd in {n % 2 for n in numbers}}
        for row, n in enumerate(numbers):
            near = float(ends.lower[row, column]), float(ends.upper[row, column])
            out[:, :, row, column], double[row, column] = halves[n % 2].derivatives(
                wanted, n, near, float(ends.error[row, column])
            )
    full = (len(wanted), len(numbers), *shape)
    return BoundaryDerivatives(
        method="eigenvectors of Hill's matrix",
        error=out[2].reshape(full),
        error_norm="absolute, entrywise, for either end",
        provenance=provenance(),
        lower=out[0].reshape(full),
        upper=out[1].reshape(full),
        double=double.reshape(full[1:]),
        regions=numbers,
        directions=tuple(item.name for item in wanted),
        mu=flat.reshape(shape),
        damping=friction.reshape(shape),
    )


def _direction(f: PeriodicFunction, item: object, place: int) -> _Direction:
    if isinstance(item, PeriodicFunction):
        return _Direction(f"g{place}", item)
    if isinstance(item, str) and item == "K":
        return _Direction("K", None)
    if isinstance(item, str) and item == "mu":
        return _Direction("mu", f)
    named = _COEFFICIENT.fullmatch(item) if isinstance(item, str) else None
    if named is None or item == "b0":
        expected = "'mu', 'K', a coefficient such as 'a2' or 'b1', or a PeriodicFunction"
        raise bad(f"directions[{place}]", repr(item), expected, "correct the name")
    if len(named[2]) > 9 or int(named[2]) > max(2 * LARGEST, f.harmonics):
        expected = f"a harmonic up to {2 * LARGEST}"
        fix = "higher ones couple nothing that the boundaries depend on"
        raise bad(f"directions[{place}]", repr(str(item)[:20]), expected, fix)
    unit = np.zeros(int(named[2]) + 1)
    unit[-1] = 1.0
    function = PeriodicFunction(unit) if named[1] == "a" else PeriodicFunction([0.0], unit)
    return _Direction(str(item), function, by_mu=True)


class _Slice:
    """One problem, of either parity, at one mu and K, with its eigenvalues and vectors."""

    def __init__(self, f: PeriodicFunction, mu: float, k: float, odd: int, highest: int) -> None:
        self.mean, self.mu, self.odd = mu * f.a[0], mu, odd
        # Far below a rounding, so that the truncation need not be weighed against it.
        cut = finest(f, abs(mu), highest + 2, k * k, (1e-20, LEFT_OUT))
        self.harmonic = cut.harmonic + odd
        whole = stacked(f, odd, self.harmonic, np.array([mu]), k)[0]
        # Vectors of norm 1.  Only real eigenvalues are boundaries.
        if k:
            import scipy.linalg

            solved: Any = scipy.linalg.eig(whole, left=True, check_finite=False)
            self.values, self.lefts, self.rights = solved
        else:
            self.values, self.rights = np.linalg.eigh(whole)
            self.lefts = self.rights
        real = np.flatnonzero(self.values.imag == 0.0)
        self.real = real[np.argsort(self.values[real].real)]
        # Exact orthogonality would be a tip met exactly: then what is divided by it overflows.
        self.shares = np.abs(np.sum(self.lefts.conj() * self.rights, axis=0)) + 5e-324
        self.residuals = (
            np.abs(whole @ self.rights - self.rights * self.values),
            np.abs(whole.T @ self.lefts - self.lefts * self.values.conj()),
        )
        # What the truncation adds to lam2 is analytic in the parameter: so small is its slope too.
        self.further = f.error * abs(mu) + 100.0 * cut.left_out

    def derivatives(
        self, wanted: Sequence[_Direction], n: int, ends: tuple[float, float], error: float
    ) -> tuple[Array, bool]:
        """Return lower, upper and error ``(3, len(wanted))`` of region n, and whether double."""
        out = np.full((3, len(wanted)), np.nan)
        if np.isnan(ends[1]):
            return out, False
        changes = [item.change(self.odd, self.harmonic, self.mu) for item in wanted]
        undamped = self.lefts is self.rights
        if n and undamped and ends[1] - ends[0] <= 4.0 * error:
            group = [n - 1, n]
            pair = self.rights[:, group]
            for j, (item, change) in enumerate(zip(wanted, changes, strict=True)):
                if item.function is not None:
                    out[:2, j] = np.linalg.eigvalsh(pair.T @ change @ pair)
                    out[2, j] = self._error(item, change, group)
            return out, True
        sides = (0, 1) if n else (1,)
        if self.real.size < len(sides):
            return out, False
        places = self.values[self.real].real - self.mean
        columns = {int(self.real[np.abs(places - ends[i]).argmin()]): i for i in sides}
        if len(columns) < len(sides):
            # The two are a complex pair in doubles: the tip is nearer than they resolve.
            return out, False
        out[2] = 0.0
        for i, side in columns.items():
            right, left = self.rights[:, i].real, self.lefts[:, i].real
            share = float(left @ right) or 5e-324
            for j, (item, change) in enumerate(zip(wanted, changes, strict=True)):
                out[side, j] = float(left @ change @ right) / share
                out[2, j] = max(out[2, j], self._error(item, change, [i]))
        return out, False

    def _error(self, item: _Direction, change: Array, group: list[int]) -> float:
        """Estimate the error that residuals of the vectors of a group make, to first order.

        A right vector is off by others' ones, each times the product of its left one with the
        residual over its distance in lam2 and the product of its own two, small next to the tip of
        a region, where damping lets two solutions come together; so with left and right exchanged.
        """
        given = item.function.error if item.function is not None else 0.0
        total = 0.0
        for i in group:
            apart = np.abs(self.values - self.values[i]) * self.shares
            apart[group] = np.inf
            apart = np.maximum(apart, 5e-324)
            whole = 0.0
            for (one, other), residual in zip(
                ((self.lefts, self.rights), (self.rights, self.lefts)), self.residuals, strict=True
            ):
                turned = change if one is self.lefts else change.T
                felt = np.abs(one[:, group].conj().T @ turned @ other).max(axis=0)
                mixed = np.abs(one).T @ residual[:, i] + self.further
                whole += float(felt @ (mixed / apart))
            rounded = np.abs(self.lefts[:, i]) @ np.abs(change) @ np.abs(self.rights[:, i])
            total += (whole + EPS * float(rounded) + given) / float(self.shares[i])
        # Residuals are round-off themselves: of 3600 derivatives the factor was 2.2 once and up to
        # 1.3 for all others.
        return 3.0 * total
