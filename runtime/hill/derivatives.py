"""Derivatives of exact boundaries with respect to any parameter, by their eigenvectors."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import bad
from ..core.periodic_function import PeriodicFunction
from ..core.results import Result, provenance
from .boundaries import hill_boundaries
from .checks import EPS, LARGEST, Array, Mask, check_function, check_regions, points
from .fourier_matrix import LEFT_OUT, finest, layout, matrix, real_pairs, stacked

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

    def size(self, harmonic: float, mu: float) -> float:
        """Return about the norm of the change, on harmonics that matter."""
        if self.function is None:
            return 2.0 * harmonic
        return self.function.bound() * (abs(mu) if self.by_mu else 1.0)


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
        raise bad(
            f"directions[{place}]",
            repr(item),
            "'mu', 'K', a coefficient such as 'a2' or 'b1', or a PeriodicFunction",
            "correct the name",
        )
    if len(named[2]) > 9 or int(named[2]) > max(2 * LARGEST, f.harmonics):
        raise bad(
            f"directions[{place}]",
            repr(str(item)[:20]),
            f"a harmonic up to {2 * LARGEST}",
            "higher ones couple nothing that the boundaries depend on",
        )
    unit = np.zeros(int(named[2]) + 1)
    unit[-1] = 1.0
    function = PeriodicFunction(unit) if named[1] == "a" else PeriodicFunction([0.0], unit)
    return _Direction(str(item), function, by_mu=True)


class _Slice:
    """One problem, of either parity, at one mu and K, with its real eigenvalues and vectors."""

    def __init__(self, f: PeriodicFunction, mu: float, k: float, odd: int, highest: int) -> None:
        self.f, self.mu, self.k, self.odd = f, mu, k, odd
        # Far below a rounding, so that the truncation need not be weighed against it.
        self.cut = finest(f, abs(mu), highest + 2, k * k, (1e-20, LEFT_OUT))
        # The highest k that matters to the solutions.
        self.level = 0.5 * (highest + 2) + (abs(mu) * f.bound()) ** 0.5
        self.harmonic = self.cut.harmonic + odd
        whole = stacked(f, odd, self.harmonic, np.array([mu]), k)[0]
        self.squares = layout(odd, self.harmonic).squares
        # Vectors of norm 1, and the residuals of the right and the left one together, as columns.
        if k:
            self.values, self.rights, self.lefts = real_pairs(whole)
        else:
            self.values, self.rights = np.linalg.eigh(whole)
            self.lefts = self.rights
        self.residual = np.abs(whole @ self.rights - self.rights * self.values)
        self.residual += np.abs(whole.T @ self.lefts - self.lefts * self.values)

    def derivatives(
        self, wanted: Sequence[_Direction], n: int, ends: tuple[float, float], error: float
    ) -> tuple[Array, bool]:
        """Return lower, upper and error ``(3, len(wanted))`` of region n, and whether double."""
        out = np.full((3, len(wanted)), np.nan)
        if np.isnan(ends[1]):
            return out, False
        changes = [item.change(self.odd, self.harmonic, self.mu) for item in wanted]
        if n and not self.k and ends[1] - ends[0] <= 4.0 * error:
            pair = self.rights[:, n - 1 : n + 1]
            for j, (item, change) in enumerate(zip(wanted, changes, strict=True)):
                if item.function is not None:
                    out[:2, j] = np.linalg.eigvalsh(pair.T @ change @ pair)
                    out[2, j] = self._error(item, (n - 1, n), 1.0)
            return out, True
        mean = self.mu * self.f.a[0]
        sides = (0, 1) if n else (1,)
        if self.values.size < len(sides):
            return out, False
        columns = {int(np.abs(self.values - mean - ends[i]).argmin()): i for i in sides}
        if len(columns) < len(sides):
            # The two are a complex pair in doubles: the tip is nearer than they resolve.
            return out, False
        out[2] = 0.0
        for i, side in columns.items():
            right, left = self.rights[:, i], self.lefts[:, i]
            # Exact orthogonality would be a tip met exactly: then everything below overflows.
            share = float(left @ right) or 5e-324
            for j, (item, change) in enumerate(zip(wanted, changes, strict=True)):
                out[side, j] = float(left @ change @ right) / share
                out[2, j] = max(out[2, j], self._error(item, (i,), abs(share)))
        return out, False

    def _error(self, item: _Direction, group: tuple[int, ...], share: float) -> float:
        """Return the norm of the change times the error of both vectors, magnified by damping."""
        size = item.size(self.level, self.mu)
        given = item.function.error if item.function is not None else 0.0
        # The residuals are round-off themselves.
        mixing = 4.0 * self._mixing(group[0]) if self.k else 0.0
        return float(size * ((self._tilt(group) + EPS) / (share * share) + mixing / share) + given)

    def _tilt(self, group: tuple[int, ...]) -> float:
        """Estimate the error of the vectors of a group.

        The residual of harmonic k counts over the distance of k^2, or that of the nearest
        eigenvalue outside the group.
        """
        # What the truncation adds to lam2 is analytic in the parameter: so small is its slope too.
        further = self.f.error * abs(self.mu) + 100.0 * self.cut.left_out
        others = np.delete(self.values, group)
        most = 0.0
        for i in group:
            near = max(float(np.abs(others - self.values[i]).min(initial=np.inf)), 5e-324)
            apart = np.maximum(np.abs(self.squares - self.values[i]), near)
            most = max(most, float(np.linalg.norm(self.residual[:, i] / apart)) + further / near)
        return most + EPS

    def _mixing(self, i: int) -> float:
        """Estimate the share of the nearest other solution in one, next to the tip of a region.

        Damping lets the two come together: their distance and the inner product of the other's
        two vectors, both small there, divide the residual.
        """
        apart = np.abs(self.values - self.values[i])
        apart[i] = np.inf
        other = int(apart.argmin())
        right, left = self.rights[:, other], self.lefts[:, other]
        # From this cosine on two solutions count as coming together.
        if other == i or abs(float(right @ self.rights[:, i])) < 0.95:
            return 0.0
        felt = float((np.abs(left) + np.abs(right)) @ self.residual[:, i])
        return felt / max(float(apart[other]) * abs(float(left @ right)), 5e-324)
