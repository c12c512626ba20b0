"""The periodic solutions on the boundaries of Hill's equation, to an order or exactly.

On a boundary of region n the equation ``y'' + 2 K y' + (lam2 + F(theta)) y = 0`` has a solution
of period 2 pi (n even) or one that changes sign after 2 pi (n odd).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.errors import bad
from ...core.periodic_function import PeriodicFunction
from ...core.results import Check, Result, provenance
from ...core.sampling import finite_angles
from ..exact.layout import LARGEST, layout, stacked
from ..exact.matrix import check_regions, hill_boundaries
from ..transfer import EPS
from .boundaries import amplitudes_of, check_order, combined, parameters_of
from .effective import effective_operator
from .orders import BEYOND, Components, contraction, uniform
from .pair_solutions import direction, reduced_solution

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
End = Literal["lower", "upper"]

# The figures are estimates; the residual may exceed what they predict by so much.
_LIMIT = 4.0


@dataclass(frozen=True, kw_only=True)
class BoundarySolution(Result):
    """A periodic solution on a boundary, ``sum_k a_k cos k theta + b_k sin k theta``.

    Its mean square over a period is 1, and the larger of ``a_k``, ``b_k`` at ``k = n/2`` is
    positive (where both vanish, the largest of all).

    Attributes
    ----------
    wave_numbers : ndarray, shape (L,)
        Numbers k, whole for even n, half-whole for odd n.
    a, b : ndarray, shape (L,)
        Coefficients.
    lam2 : float
        The boundary, to the order.
    mu : ndarray, shape (p,)
        The parameters.
    damping : float
        K.
    n : int
        Number of the region.
    end : str
        ``"lower"`` or ``"upper"``.
    order : int or None
        Order of the perturbation; None where Hill's matrix gave the solution.
    residual : float
        Root mean square of ``y'' + 2 K y' + (lam2 + F) y`` over a period.
    degenerate : bool
        True where the two ends cannot be told apart: every solution is periodic there, and
        ``error`` is the distance from those.
    """

    wave_numbers: Array
    a: Array
    b: Array
    lam2: float
    mu: Array
    damping: float
    n: int
    end: str
    order: int | None
    residual: float
    degenerate: bool

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "wave_numbers": ("wave_number",),
        "a": ("wave_number",),
        "b": ("wave_number",),
        "mu": ("parameter",),
    }

    @property
    def period(self) -> float:
        """Period [rad]: 2 pi for even, 4 pi for odd n."""
        return 2.0 * np.pi * (1 + self.n % 2)

    def __call__(self, theta: ArrayLike) -> Array:
        """Evaluate at angles [rad] of any shape; the result has the same shape."""
        angles = finite_angles(theta)
        # Horner in exp(i theta), times the half turn that odd regions have.
        z, first = np.exp(1j * angles), np.exp(1j * self.wave_numbers[0] * angles)
        total = np.zeros(angles.shape, dtype=complex)
        for c in (self.a - 1j * self.b)[::-1]:
            total = total * z + c
        return np.asarray((total * first).real)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the solution over a period."""
        from ...core.plotting import axes_or_new

        ax = axes_or_new(ax)
        theta = np.linspace(0.0, self.period, 721)
        ax.plot(theta, self(theta))
        ax.set_xlabel(r"$\theta$ [rad]")
        ax.set_ylabel("$y$")
        return ax


def boundary_solution(
    f: PeriodicFunction | Sequence[PeriodicFunction],
    mu: float | Sequence[float],
    n: int,
    end: End = "lower",
    order: int | None = None,
    damping: float = 0.0,
) -> BoundarySolution:
    """Return the periodic solution on one boundary of an unstable region.

    Parameters
    ----------
    f : PeriodicFunction or sequence of PeriodicFunction
        Coefficient of period 2 pi, or one for each parameter.
    mu : float or sequence of float
        The parameter, or one for each function.
    n : int
        Number of the region; region 0 has an upper end alone.
    end : {"lower", "upper"}
        Which end of the region.
    order : int, optional
        1 to 8 for the solution to that order in the parameters and K (Smith's ``y_0 + mu y_1 +
        ...``); by default the eigenvector of Hill's matrix.
    damping : float
        K, at least zero.

    Returns
    -------
    BoundarySolution
        ``error`` estimates the largest deviation over theta from the true solution.  Its check
        compares the residual of the equation with the one that the figures predict.

    Raises
    ------
    BadInput
        If an argument is out of range, damping closes the region, the orders do not visibly
        converge at these parameters, or Hill's matrix would need more than 2048 harmonics.

    Notes
    -----
    Smith (7.13)-(7.36), (7.41)-(7.47): the columns of Bloch's wave operator and the eigenvector
    of the effective operator.
    """
    functions, values = parameters_of(f, mu)
    (number,) = check_regions((n,))
    if end not in ("lower", "upper") or (end == "lower" and number == 0):
        expected = "'upper'" if number == 0 else "'lower' or 'upper'"
        raise bad("end", repr(end), expected, "region 0 has an upper end alone")
    amps, k, shape = amplitudes_of(values, damping)
    if shape:
        raise bad("mu, damping", f"arrays of shape {shape}", "numbers", "call once for each point")
    point = np.array([float(v) for v in amps])
    if float(np.sum(np.abs(point) * [item.bound() for item in functions])) > 1e100:
        raise bad("mu", "a product mu f beyond 1e100", "a moderate one", "scale the equation")
    whole = combined(functions, point)
    if order is None:
        found = _exact(whole, number, end, float(k))
    else:
        check_order(order)
        found = _to_order(whole, number, end, int(order), float(k))
    return _result(found, point, end, order)


@dataclass(frozen=True)
class _Found:
    """A solution as coefficients of ``exp(i (m - n/2) theta)``, m = -r ... n + r."""

    n: int
    lam2: float
    damping: float
    coefficients: Complex
    error: float
    residual: float
    predicted: float
    degenerate: bool


def _result(found: _Found, point: Array, end: str, order: int | None) -> BoundarySolution:
    """Normalise, and turn into cosines and sines."""
    v, n = found.coefficients, found.n
    k: Array = np.arange(v.size, dtype=np.float64) - 0.5 * (v.size - 1)
    there = k >= 0.0
    k, v = k[there], v[there]
    a, b = 2.0 * v.real, -2.0 * v.imag
    if n % 2 == 0:
        a[0], b[0] = v[0].real, 0.0
    weight = np.where(k == 0.0, 1.0, 0.5)
    size = float(np.sqrt(np.sum(weight * (a * a + b * b))))
    at = int(np.flatnonzero(k == 0.5 * n)[0])
    leading = np.array([a[at], b[at]])
    if float(np.abs(leading).max()) < 1e-8 * size:
        leading = np.concatenate([a, b])
    scale = 1.0 / size if leading[np.argmax(np.abs(leading))] > 0.0 else -1.0 / size
    residual, error = found.residual / size, found.error / size
    explained = found.predicted / size
    return BoundarySolution(
        method="Hill matrix" if order is None else f"perturbation, order {order}",
        error=error,
        error_norm="absolute, largest over theta; the mean square of y is 1",
        checks={
            "residual of the equation over what the figures predict": Check(
                residual / explained, _LIMIT
            )
        },
        provenance=provenance(),
        wave_numbers=k,
        a=scale * a,
        b=scale * b,
        lam2=found.lam2,
        mu=point,
        damping=found.damping,
        n=n,
        end=end,
        order=None if order is None else int(order),
        residual=residual,
        degenerate=found.degenerate,
    )


def _residual(f: PeriodicFunction, v: Complex, lam2: float, damping: float) -> float:
    """Return the norm of the residual of the coefficients; the mean of f belongs to it."""
    c = np.asarray(0.5 * (f.a - 1j * f.b), dtype=complex)
    c[0] = f.a[0]
    taps = np.concatenate([c[:0:-1].conj(), c])
    out = np.convolve(v, taps)
    h = f.harmonics
    k = np.arange(v.size) - 0.5 * (v.size - 1)
    out[h : h + v.size] += (lam2 - k * k + 2j * damping * k) * v
    return float(np.linalg.norm(out))


def _to_order(f: PeriodicFunction, n: int, end: End, order: int, damping: float) -> _Found:
    """Return the solution by the columns of the wave operator."""
    damped = damping > 0.0
    operator = effective_operator((f,), n, order + BEYOND, damped)
    at = np.array([1.0, damping] if damped else [1.0])
    a, b = (item[:, None] for item in operator.components(at))
    reach = f.bound() + n * damping
    noise = np.array([4.0 * EPS * (0.25 * n * n + reach) + f.error])
    strength = noise + reach
    parts = Components(n, order, a, b, noise, strength, np.array([damped]))
    with np.errstate(all="ignore"):
        ends = uniform(parts)
        fall = float(contraction(np.abs(a) + np.abs(b), parts.distance)[0])
    _refuse(n, order, bool(ends.outside[0]), bool(np.isnan(ends.half[0])))
    half = float(ends.half[0]) * (1.0 if end == "upper" else -1.0)
    sum_a, sum_b = complex(a[:order].sum()), complex(b[:order].sum())
    lost = float(np.abs(a[order:]).sum() + np.abs(b[order:]).sum() + noise[0])
    phase, turn, degenerate = (
        direction(sum_a.imag, sum_b, (lost, lost), end) if n else (0.0, 0.0, False)
    )
    _, columns = operator.solution(at)
    u = np.exp(1j * phase)
    every = u * columns
    if n:
        every = every + u.conjugate() * columns[:, ::-1].conj()
    v = every[: order + 1].sum(axis=0)
    rest = every[order + 1 :]
    k = np.arange(v.size) - 0.5 * (v.size - 1)
    levels = np.abs(k * k - 0.25 * n * n)
    geometric = 1.0 / (1.0 - min(1.25 * fall, 0.95))
    body = float(np.abs(v).sum())
    error = 2.0 * geometric * float(np.abs(rest).sum()) + (turn + 8.0 * EPS) * body
    predicted = geometric * (float((levels * np.abs(rest)).sum()) + 2.0 * lost * body)
    lam2 = float(ends.centre[0]) + half
    residual = _residual(f, v, lam2, damping)
    rounding = 4.0 * EPS * float((np.abs(v) * (np.abs(k * k - lam2) + reach)).sum())
    return _Found(n, lam2, damping, v, error, residual, predicted + rounding, degenerate)


def _refuse(n: int, order: int, outside: bool, closed: bool) -> None:
    if outside:
        raise bad(
            "boundary_solution",
            f"orders that do not converge visibly in region {n} (order {order})",
            "smaller parameters",
            "use order=None for the exact solution",
        )
    if closed:
        raise bad(
            "boundary_solution", f"region {n}, closed by damping", "an open region", "lower K"
        )


def _exact(f: PeriodicFunction, n: int, end: End, damping: float) -> _Found:
    """Return the solution by Hill's matrix, cut where its residual no longer falls."""
    bounds = hill_boundaries(f, 1.0, (n,), damping)
    target, slack = float(getattr(bounds, end)[0]), float(bounds.error[0])
    if np.isnan(target):
        _refuse(n, 0, outside=False, closed=True)
    near = reduced_solution(f, n, target, slack, damping, end) if n else None
    if near is not None:
        v = near.coefficients
        norm = _rounding_norm(f, v, target)
        noise = 4.0 * EPS * norm + (slack + f.error) * float(np.linalg.norm(v))
        residual = _residual(f, v, target, damping)
        return _Found(n, target, damping, v, near.error, residual, noise, near.degenerate)
    harmonic = 8 + n + int(2.0 * np.sqrt(f.bound())) + min(f.harmonics, 64)
    best: _Found | None = None
    while harmonic <= LARGEST:
        matrix, squares = _damped_matrix(f, n % 2, harmonic, damping)
        matrix[np.diag_indices_from(matrix)] -= target + f.mean
        found = _null(f, matrix, squares, (n, target, damping, end), slack)
        if best is not None and found.residual > 0.5 * best.residual:
            return best if best.residual <= found.residual else found
        if found.residual <= 0.1 * found.predicted:
            return found
        best, harmonic = found, harmonic + harmonic // 2
    raise bad(
        "boundary_solution",
        f"{f.harmonics} harmonics, mu f up to {f.bound():.3g}",
        f"a problem that {LARGEST} harmonics settle",
        "truncate the function or take a smaller mu",
    )


def _rounding_norm(f: PeriodicFunction, v: Complex, lam2: float) -> float:
    """Return what round-off, relative to each term, is multiplied by in the residual."""
    k = np.arange(v.size) - 0.5 * (v.size - 1)
    return float(np.abs(v) @ (k * k + abs(lam2) + f.bound()))


def _damped_matrix(
    f: PeriodicFunction, odd: int, harmonic: int, damping: float
) -> tuple[Array, Array]:
    """Return the matrix of ``k^2 - 2 K d/d theta - (f - mean)`` in cosines and sines."""
    matrix = stacked(f, odd, harmonic + odd, np.ones(1))[0]
    squares = layout(odd, harmonic + odd).squares
    cos = np.arange(1 - odd, squares.size, 2)
    drag = 2.0 * damping * np.sqrt(squares[cos])
    matrix[cos + 1, cos] += drag
    matrix[cos, cos + 1] -= drag
    return matrix, squares


def _null(
    f: PeriodicFunction,
    matrix: Array,
    squares: Array,
    where: tuple[int, float, float, End],
    slack: float,
) -> _Found:
    """Return the null vector of Hill's matrix less the boundary, with its error figure."""
    n, target, damping, end = where
    left, sizes, right = np.linalg.svd(matrix)
    x, gap = right[-1], float(sizes[-2])
    noise = 4.0 * EPS * float(np.abs(x) @ (squares + abs(target) + f.bound()))
    doubt = slack + f.error
    degenerate = gap <= 4.0 * (noise + doubt)
    if degenerate:
        # Any mixture will do: the one that is nearest to the cosine, or to the sine.
        first = max(n - 1, 0)
        pair = right[-2:]
        x = pair[:, first + (end == "lower")] @ pair
        x, gap = x / np.linalg.norm(x), float(sizes[-3])
        # The decomposition leaves round-off of the largest entries of the matrix in the tail.
        x[np.abs(x) < 4.0 * EPS] = 0.0
        noise += 4.0 * EPS * float(squares[x != 0.0].max())
        wrong = float(np.linalg.norm(matrix @ x)) + noise + doubt
    else:
        # Elimination, row by row, does not: one step of inverse iteration cleans it.
        shifted = matrix.copy()
        shifted[np.diag_indices_from(matrix)] += EPS * (1.0 + abs(target))
        y = np.linalg.solve(shifted, x)
        x = y / np.linalg.norm(y)
        gap -= doubt
        wrong = _own_residual(matrix, left[:, -1], x, noise, damping > 0.0) + f.error
    v = _exponentials(x, n % 2)
    residual = _residual(f, v, target, damping)
    spread = np.sqrt(2.0 * np.count_nonzero(np.abs(x) > EPS))
    error = float(spread) * (2.0 * wrong / gap + 4.0 * EPS)
    return _Found(n, target, damping, v, error, residual, noise + doubt, degenerate)


def _own_residual(matrix: Array, left: Array, x: Array, noise: float, damped: bool) -> float:
    """Return a bound of the residual of a null vector with its own eigenvalue.

    What the boundary itself is wrong by turns the vector not at all.
    """
    image = matrix @ x
    along = float(left @ x)
    own = float(left @ image) / along if damped else float(x @ image)
    wrong = float(np.linalg.norm(image - own * x)) + noise
    # The eigenvectors of a symmetric matrix are at right angles: there this error is along x.
    return wrong + noise / abs(along) if damped else wrong


def _exponentials(x: Array, odd: int) -> Complex:
    """Turn coefficients of 1, sqrt 2 cos k theta, sqrt 2 sin k theta into those of exp(i k theta).

    The order of the functions is that of :func:`.layout.layout`.
    """
    pairs = x[1 - odd :].reshape(-1, 2)
    positive = np.sqrt(0.5) * (pairs[:, 0] - 1j * pairs[:, 1])
    middle = np.zeros(0) if odd else x[:1]
    return np.concatenate([positive[::-1].conj(), middle, positive])
