"""First-order perturbation boundaries of Hill's equation (Smith 7.1.3 and 7.1.4)."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...generated import hill_boundaries_first_order
from ..errors import bad
from ..results import Check, provenance
from ..series.periodic import PeriodicFunction
from .half_trace import arguments, check_function
from .matrix import Boundaries, check_regions
from .transfer import EPS

Array = NDArray[np.float64]


def perturbation_boundaries(
    f: PeriodicFunction,
    mu: ArrayLike,
    regions: Sequence[int] = (1, 2),
    order: int = 1,
    damping: ArrayLike = 0.0,
) -> Boundaries:
    """Return the boundaries of unstable regions to first order in mu (and K).

    ``lam2 = n^2/4 - a0 mu -+ 1/2 sqrt(mu^2 (an^2 + bn^2) - 4 K^2 n^2)``

    Parameters
    ----------
    f : PeriodicFunction
        Coefficient of period 2 pi.
    mu : array_like
        Any shape, any sign.
    regions : sequence of int
        Numbers n >= 0; region 0 has ``lower`` = -inf and ``upper`` = -a0 mu.
    order : int
        Only 1 in this version.
    damping : array_like
        K of Smith (7.38), at least zero; broadcasts with mu.

    Returns
    -------
    Boundaries
        ``lower``, ``upper`` and ``error`` of shape ``(len(regions), *mu.shape)`` (the broadcast
        shape of mu and damping); NaN where damping closes the region (Smith (7.50)).  ``error``
        estimates what the formula leaves out: the second-order terms in full, and a majorant of
        the third order.  A check fails where it exceeds half the width that an open region would
        have without damping: what the formula leaves out is then as large as what it gives.
        Regions that have no width to first order are left out of it.

    Raises
    ------
    BadInput
        If an argument is not finite, a region is not a whole number >= 0, K is negative, or
        ``order`` is not 1.

    Notes
    -----
    Smith (7.23)-(7.25), (7.46)-(7.50).  The error uses the uniform second-order form
    ``w0 mu^2 -+ |c_n mu - W mu^2|`` with ``c_m = (a_m - i b_m) / 2``.
    """
    check_function(f)
    numbers = check_regions(regions)
    if order != 1 or isinstance(order, bool):
        raise bad("order", repr(order), "1", "use hill_boundaries for the exact boundaries")
    (amp, k), shape = arguments(mu=mu, damping=damping)
    lower = np.empty((len(numbers), *shape))
    upper, error = np.empty_like(lower), np.empty_like(lower)
    for i, n in enumerate(numbers):
        lower[i], upper[i] = _ends(f, n, amp, k)
        error[i] = np.where(np.isnan(upper[i]), np.nan, _left_out(f, n, amp, k))
    return Boundaries(
        method="perturbation, first order",
        error=error,
        error_norm="absolute, entrywise, for either end",
        checks=_checks(f, numbers, amp, error),
        provenance=provenance(),
        lower=lower,
        upper=upper,
        regions=numbers,
        mu=np.broadcast_to(amp, shape),
        damping=np.broadcast_to(k, shape),
    )


def _checks(
    f: PeriodicFunction, regions: tuple[int, ...], mu: Array, error: Array
) -> dict[str, Check]:
    """Return the largest error figure over half the undamped width, where there is a width."""
    known = [(i, n) for i, n in enumerate(regions) if 0 < n <= f.harmonics]
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = [error[i] / (0.5 * f.amplitudes[n] * np.abs(mu)) for i, n in known]
    found = np.ravel(shares)[np.isfinite(np.ravel(shares))]
    if found.size == 0:
        return {}
    return {"error over half the width": Check(float(found.max()), 1.0)}


def _ends(f: PeriodicFunction, n: int, mu: Array, k: Array) -> tuple[Array, Array]:
    """Return both ends of region n."""
    if n == 0:
        return np.full(mu.shape, -np.inf), -f.a[0] * mu
    an, bn = (float(f.a[n]), float(f.b[n])) if n <= f.harmonics else (0.0, 0.0)
    return _first_order(n, mu, float(f.a[0]), an, bn, k)


def _first_order(
    n: int, mu: Array, a0: float, an: float, bn: float, damping: Array
) -> tuple[Array, Array]:
    """Return lower and upper boundary of region n, Smith (7.46) and (7.49)."""
    emitted: Callable[..., tuple[Array, Array]] = hill_boundaries_first_order.first_order
    middle, square = emitted(float(n), mu, a0, an, bn, damping)
    half = np.sqrt(np.where(square < 0.0, np.nan, square))
    return middle - half, middle + half


def _left_out(f: PeriodicFunction, n: int, mu: Array, k: Array) -> Array:
    """Estimate the error of the first-order boundaries of region n."""
    c = np.asarray(0.5 * (f.a - 1j * f.b), dtype=np.complex128)
    c[0] = 0.0
    size = len(c)
    m = np.arange(1, size)
    strength = np.abs(c[1:]) ** 2
    near = np.where(m == n, np.inf, m * (m - n)).astype(float)
    # Second order: the diagonal and the coupling of the harmonics n/2 and -n/2 by way of others.
    diagonal = float(np.sum(strength / (m * (m + n)) + strength / near))
    absolute = float(np.sum(strength / (m * (m + n)) + strength / np.abs(near)))
    both = np.arange(-size + 1, n + size)
    both = both[(both != 0) & (both != n) & (np.abs(n - both) < size) & (np.abs(both) < size)]
    products = _at(c, both) * _at(c, n - both) / (both * (both - n)) if n else np.zeros(1)
    coupling = abs(complex(products.sum()))
    second = np.abs(mu) ** 2
    # Third order: each further step brings mu f or 2 K d/d theta over the distance of the levels.
    step = (np.abs(mu) * float(f.amplitudes[1:].sum()) + 2.0 * k) / max(1, n - 1)
    third = second * (absolute + float(np.abs(products).sum())) * step
    middle = second * abs(diagonal) + third
    # The same through the square root that damping brings.
    split = np.abs(c[n]) * np.abs(mu) if 0 < n < size else np.zeros_like(mu)
    change, drag = second * coupling + third, k * n
    half = np.sqrt(np.maximum(split * split - drag * drag, 0.0))
    outer = np.sqrt(np.maximum((split + change) ** 2 - drag * drag, 0.0)) - half
    inner = half - np.sqrt(np.maximum(np.maximum(split - change, 0.0) ** 2 - drag * drag, 0.0))
    noise = 4.0 * EPS * (0.25 * n * n + np.abs(mu) * f.bound()) + np.abs(mu) * f.error
    return np.asarray(middle + np.maximum(outer, inner) + noise)


def _at(c: NDArray[np.complex128], m: NDArray[np.intp]) -> NDArray[np.complex128]:
    """Return the complex Fourier coefficients at numbers of either sign."""
    found = c[np.abs(m)]
    return np.asarray(np.where(m < 0, found.conj(), found))
