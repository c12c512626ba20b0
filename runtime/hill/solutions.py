"""The periodic solutions on the boundaries of Hill's equation, to an order or exactly.

On a boundary of region n the equation ``y'' + 2 K y' + (lam2 + F(theta)) y = 0`` has a solution
of period 2 pi (n even) or one that changes sign after 2 pi (n odd).

The exact one is a null vector of Hill's matrix.  Where the region is narrow, the direction of the
solution in the plane of ``exp(+-i n theta/2)`` hangs on a coupling far below the round-off of that
matrix.  Elimination of all other harmonics gives that coupling as a sum over paths, each factor of
which is known to round-off: its own relative error is small.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import BadInput, bad
from ..core.inputs import is_one_of
from ..core.periodic_function import PeriodicFunction
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check, Result, provenance
from ..core.trigonometric import finite_angles
from .bloch import BEYOND, effective_operator, wave_columns
from .boundaries import hill_boundaries
from .checks import EPS, LARGEST, Array, Complex, check_regions
from .fourier_matrix import couplings, stacked
from .perturbation import Sums, check_order, combined, parameters_of

End = Literal["lower", "upper"]


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

    arrays_along: ClassVar = {"wave_number": "wave_numbers a b", "parameter": "mu"}

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
        ax = axes_or_new(ax)
        theta = np.linspace(0.0, self.period, 721)
        ax.plot(theta, self(theta))
        ax.set(xlabel=r"$\theta$ [rad]", ylabel="$y$")
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
        compares the residual of the equation with the one that the errors predict.

    Raises
    ------
    BadInput
        If an argument is out of range, damping closes the region, the orders do not visibly
        converge at these parameters, or Hill's matrix would need more than 2048 harmonics.

    Notes
    -----
    Smith (7.13)-(7.36), (7.41)-(7.47): the columns of Bloch's wave operator and the eigenvector
    of the effective operator.

    Examples
    --------
    >>> import elastolink as el
    >>> solution = el.boundary_solution(el.PeriodicFunction(a=[0.0, 1.0]), mu=0.1, n=1)
    >>> print(round(solution.lam2, 6), round(solution.period, 4))
    0.198781 12.5664
    """
    functions, (*amps, friction), shape = parameters_of(f, mu, damping)
    (n,) = check_regions((n,))
    if not is_one_of(end, ("lower", "upper")) or (end == "lower" and n == 0):
        expected = "'upper'" if n == 0 else "'lower' or 'upper'"
        raise bad("end", repr(end), expected, "region 0 has an upper end alone")
    if shape:
        raise bad("mu, damping", f"arrays of shape {shape}", "numbers", "call once for each point")
    point = np.concatenate(amps)
    if float(np.sum(np.abs(point) * [item.bound() for item in functions])) > 1e100:
        raise bad("mu", "a product mu f beyond 1e100", "a moderate one", "scale the equation")
    whole, damping = combined(functions, point), float(friction[0])
    if order is None:
        solution = _exact(whole, n, end, damping)
    else:
        check_order(order)
        order = int(order)
        solution = _to_order(whole, n, end, order, damping)
    # Normalised, and turned into cosines and sines.
    v = solution.coefficients
    k = _wave_numbers(v)
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
    share = solution.residual / solution.predicted
    # The errors are estimates; the residual may exceed what they predict by so much.
    return BoundarySolution(
        method="Hill matrix" if order is None else f"perturbation, order {order}",
        error=solution.error / size,
        error_norm="absolute, largest over theta; the mean square of y is 1",
        checks={"residual of the equation over what the errors predict": Check(share, 4.0)},
        provenance=provenance(),
        wave_numbers=k,
        a=scale * a,
        b=scale * b,
        lam2=solution.lam2,
        mu=point,
        damping=damping,
        n=n,
        end=end,
        order=order,
        residual=solution.residual / size,
        degenerate=solution.degenerate,
    )


class _Solution(NamedTuple):
    """A solution as coefficients of ``exp(i (m - n/2) theta)``, m = -r ... n + r."""

    lam2: float
    coefficients: Complex
    error: float
    residual: float
    predicted: float
    degenerate: bool


def _wave_numbers(v: Complex) -> Array:
    return np.asarray(np.arange(v.size) - 0.5 * (v.size - 1))


def _residual(f: PeriodicFunction, v: Complex, lam2: float, damping: float) -> float:
    """Return the norm of the residual of the coefficients; the mean of f belongs to it."""
    c = np.asarray(0.5 * (f.a - 1j * f.b), dtype=complex)
    c[0] = f.a[0]
    out = np.convolve(v, np.concatenate([c[:0:-1].conj(), c]))
    h, k = f.harmonics, _wave_numbers(v)
    out[h : h + v.size] += (lam2 - k * k + 2j * damping * k) * v
    return float(np.linalg.norm(out))


def _to_order(f: PeriodicFunction, n: int, end: End, order: int, damping: float) -> _Solution:
    """Return the solution by the columns of the wave operator."""
    damped = damping > 0.0
    operator = effective_operator((f,), n, order + BEYOND, damped)
    at = np.array([1.0, damping] if damped else [1.0])
    a, b = (item[:, None] for item in operator.components(at))
    reach = f.bound() + n * damping
    noise = np.array([4.0 * EPS * (0.25 * n * n + reach) + f.error])
    with np.errstate(all="ignore"):
        sums = Sums.of(n, order, a, b, noise, noise + reach)
        ends = sums.ends(np.array([damped]))
    if ends.outside[0]:
        found = f"orders that do not converge visibly in region {n} (order {order})"
        fix = "use order=None for the exact solution"
        raise bad("boundary_solution", found, "smaller parameters", fix)
    if np.isnan(ends.half[0]):
        raise _closed(n)
    half = float(ends.half[0]) * (1.0 if end == "upper" else -1.0)
    sum_a, sum_b = complex(a[:order].sum()), complex(b[:order].sum())
    lost = float(np.abs(a[order:]).sum() + np.abs(b[order:]).sum() + noise[0])
    phase, turn, degenerate = (
        _direction(sum_a.imag, sum_b, (lost, lost), end) if n else (0.0, 0.0, False)
    )
    columns = wave_columns(f, n, order + BEYOND, damping)
    every = np.exp(1j * phase) * columns
    if n:
        every = every + every[:, ::-1].conj()
    v, rest = every[: order + 1].sum(axis=0), np.abs(every[order + 1 :])
    k = _wave_numbers(v)
    geometric = 1.0 / (1.0 - min(float(sums.ratio[0]), 0.95))
    body = float(np.abs(v).sum())
    error = 2.0 * geometric * float(rest.sum()) + (turn + 8.0 * EPS) * body
    detours = float((np.abs(k * k - 0.25 * n * n) * rest).sum())
    lam2 = float(ends.centre[0]) + half
    rounding = 4.0 * EPS * float((np.abs(v) * (np.abs(k * k - lam2) + reach)).sum())
    predicted = geometric * (detours + 2.0 * lost * body) + rounding
    return _Solution(lam2, v, error, _residual(f, v, lam2, damping), predicted, degenerate)


def _closed(n: int) -> BadInput:
    return bad("boundary_solution", f"region {n}, closed by damping", "an open region", "lower K")


def _direction(
    a: float, b: complex, lost: tuple[float, float], end: str
) -> tuple[float, float, bool]:
    """Return the phase of the eigenvector, its error, and whether it is arbitrary."""
    # A u + B conj(u) = (Re A -+ sqrt(|B|^2 - (Im A)^2)) u with u = exp(i phase), from Im A and B
    # and their errors.
    size, (lost_a, lost_b) = abs(b), lost
    if size <= lost_b:
        return (0.0 if end == "upper" else 0.5 * np.pi), 0.0, True
    half = float(np.sqrt(max((size - a) * (size + a), 0.0)))
    phase = -0.5 * float(np.angle(complex(half if end == "upper" else -half, -a) / b))
    near = np.arcsin(min(1.0, abs(a) / size))
    far = np.arcsin(min(1.0, (abs(a) + lost_a) / (size - lost_b)))
    return phase, 0.5 * float(np.arcsin(lost_b / size) + far - near), False


# ---------------------------------------------------------------- the exact solution


def _exact(f: PeriodicFunction, n: int, end: End, damping: float) -> _Solution:
    """Return the solution by Hill's matrix, cut where the harmonics left out do not matter."""
    bounds = hill_boundaries(f, 1.0, (n,), damping)
    boundary = float(getattr(bounds, end)[0]), float(bounds.error[0])
    if np.isnan(boundary[0]):
        raise _closed(n)
    harmonic = n + 8 + f.harmonics + int(np.sqrt(2.0 * f.bound()))
    pair = 0.5 * n, 0.0
    # While f is small the others are far from resonance.
    if float(f.amplitudes[1:].sum()) > 0.5 * max(n - 1, 1):
        pair = _leading_pair(f, n, harmonic, boundary[0], damping)
    while harmonic <= LARGEST:
        solution = _joined(f, n, end, damping, boundary, pair, harmonic)
        if solution is not None:
            return solution
        harmonic += max(harmonic // 2, f.harmonics)
    found = f"{f.harmonics} harmonics, mu f up to {f.bound():.3g}"
    expected = f"a problem that {LARGEST} harmonics settle"
    raise bad("boundary_solution", found, expected, "truncate the function or take a smaller mu")


def _leading_pair(
    f: PeriodicFunction, n: int, harmonic: int, target: float, damping: float
) -> tuple[float, float]:
    """Return the k >= 0 of the two harmonics exp(+-i k theta) that all others are eliminated from.

    Those of n/2 where they are large, else the largest ones of the solutions near the boundary.
    Also how far the next solution is.
    """
    odd = n % 2
    matrix = stacked(f, odd, harmonic + odd, np.ones(1), damping)[0]
    matrix[np.diag_indices_from(matrix)] -= target + f.mean
    _, sizes, right = np.linalg.svd(matrix)
    # The second solution counts where the two are hardly apart.
    share = (sizes[-1] + EPS * sizes[0]) / (sizes[-2] + EPS * sizes[0])
    size = right[-1] ** 2 + share * right[-2] ** 2
    if not odd:
        size = np.concatenate([[0.0], size])
    size = size.reshape(-1, 2).sum(axis=1)
    k = np.arange(size.size) + 0.5 * odd
    here = int(np.argmax(k == 0.5 * n))
    # From this share of the largest pair of harmonics on, that of n/2 eliminates the others.
    chosen = here if size[here] >= 0.1 * size.max() else int(size.argmax())
    return float(k[chosen]), float(sizes[-2])


def _joined(
    f: PeriodicFunction,
    n: int,
    end: str,
    damping: float,
    boundary: tuple[float, float],
    pair: tuple[float, float],
    harmonic: int,
) -> _Solution | None:
    """Return the solution by the elimination of all harmonics but a pair ``+-k``.

    ``boundary`` is lam2 and its error, ``pair`` what :func:`_leading_pair` gives.  None where the
    harmonics beyond the cut may matter.
    """
    lam2, slack = boundary[0], boundary[1] + f.error
    k = np.arange(-harmonic - n, harmonic + 1) + 0.5 * n
    up, down = (int(np.argmax(k == side * pair[0])) for side in (1, -1))
    rest = np.delete(np.arange(k.size), [up, down])
    turned = -2.0 * damping * k
    coupling = couplings(f, k.size)
    sizes, drag = np.abs(coupling), np.abs(turned)
    levels = k * k - lam2 - f.mean + 1j * turned
    matrix = coupling[np.ix_(rest, rest)]
    matrix[np.diag_indices_from(matrix)] += levels[rest]
    inverse = np.linalg.inv(matrix)
    # ``(H - lam2) y = -H_up`` among the others, ``y = 1`` at the upper one of the pair.
    y = np.zeros(k.size, dtype=complex)
    y[rest] = -inverse @ coupling[rest, up]
    y[up] = 1.0
    ends = [*range(f.harmonics + 1), *range(-f.harmonics - 1, 0)]
    # What the harmonics beyond the cut may hold, relative to the resonant ones.
    if float(np.abs(y[ends]).max()) > 1e-18:
        return None
    weight = np.abs(y)
    weight[up] = 0.0
    # Roundings of one factor of a path: the coefficient, the elimination, its way back.
    steps = 4.0 * (n + 2.0) * EPS
    # The sizes of the entries of the inverse bound, to first order, what round-off and the doubt of
    # the boundary do to y.
    loss = steps * ((k * k + abs(lam2) + abs(f.mean)) * weight + sizes @ weight)
    loss += steps * sizes[:, up] + slack * weight
    loss += f.error * (1.0 + weight.sum())
    doubt = np.abs(inverse) @ loss[rest]
    if up == down:
        phase, turn, degenerate = 0.0, 0.0, False
    else:
        b = complex(coupling[down] @ y).conjugate()
        # The Hermitian part of H leaves A real: no round-off of it enters.
        a = float(turned @ np.abs(y) ** 2)
        lost_a = steps * float(drag[up] + drag @ weight**2)
        lost_a += 2.0 * float(drag[rest] @ (weight[rest] * doubt))
        lost_b = steps * float(sizes[down, up] + sizes[down] @ weight)
        lost_b += slack * float(weight @ weight[::-1])
        lost_b += f.error * float(1.0 + weight.sum()) ** 2
        # Re A less lam2 shows which of the two eigenvalues is zero, except where both are.
        centre = float((levels[up] + coupling[up] @ y).real)
        size = k[up] ** 2 + abs(lam2) + f.bound()
        if abs(centre) > 4.0 * (slack + EPS * size) * (1.0 + float(weight @ weight)):
            end = "upper" if centre < 0.0 else "lower"
        phase, turn, degenerate = _direction(a, b, (lost_a, lost_b), end)
    # ``u y`` and its mirror, with ``u = exp(i phase)``.
    v = np.exp(1j * phase) * y
    v = v + v[::-1].conj()
    norm = float(np.abs(v) @ (k * k + abs(lam2) + f.bound()))
    predicted = 4.0 * EPS * norm + slack * float(np.linalg.norm(v))
    residual = _residual(f, v, lam2, damping)
    error = 4.0 * float(doubt.sum()) + (turn + 8.0 * EPS) * float(np.abs(v).sum())
    # Or by the residual over the distance of the next solution, where that is far away.
    largest = np.sqrt(2.0 * np.count_nonzero(np.abs(v) > EPS * np.abs(v).max()))
    apart = max(pair[1] - slack, 1e-300)
    error = min(error, float(largest) * 2.0 * (residual + predicted) / apart)
    return _Solution(lam2, v, error, residual, predicted, degenerate)
