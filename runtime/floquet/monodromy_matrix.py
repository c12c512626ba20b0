"""Monodromy matrices and Floquet multipliers of linear periodic systems of any size."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.results import Check, Result, provenance
from .eigenvalues import eigenvalues
from .first_order import CanonicalForm, at_geometry, canonical_form, even_angles
from .krein import SignatureSource
from .period_products import STAGES
from .refined_products import PHASE, rounding_error
from .speed_tables import looked_up

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_EPS = float(np.finfo(float).eps)
# Error of a multiplier up to which it says anything about stability.
_TELLING = 0.1


@dataclass(frozen=True, kw_only=True)
class Monodromy(Result):
    """Monodromy matrices of the canonical variables (q, p = M q' + A q) over one period.

    Attributes
    ----------
    speed : ndarray
        Crank speeds [rad/s], shape ``batch``.
    matrix : ndarray
        Shape ``(*batch, 2n, 2n)``; the monodromy matrix is ``matrix * 2**exponent``.
    exponent : ndarray
        Power of two taken out where the growth would overflow, else 0; shape ``batch``.
    scale : ndarray
        Sizes of the state's components, shape ``(*batch, 2n)``; the error and the checks refer to
        the scaled matrix ``matrix[i, j] * scale[j] / scale[i]``.
    error : ndarray
        Shape ``batch``, in the norm that ``error_norm`` names.
    segments : ndarray
        Number of segments per period that were used, shape ``batch``.
    """

    speed: Array
    matrix: Array
    exponent: NDArray[np.int64]
    scale: Array
    segments: NDArray[np.int64]

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {}

    @property
    def scaled(self) -> Array:
        """The matrices in scaled variables, shape ``(*batch, 2n, 2n)``."""
        value: Array = self.matrix / self.scale[..., :, None] * self.scale[..., None, :]
        return value

    @property
    def determinant(self) -> Array:
        """Determinant of each monodromy matrix, shape ``batch``; may underflow with damping."""
        sign, logarithm = np.linalg.slogdet(self.matrix)
        shift = self.matrix.shape[-1] * self.exponent * np.log(2.0)
        value: Array = sign * np.exp(logarithm + shift)
        return value


def monodromy(
    system: LinearPeriodic, speed: ArrayLike, *, rtol: float = 1e-11, **parameters: ArrayLike
) -> Monodromy:
    """Return the monodromy matrix of the canonical variables over one period.

    The equation is ``q' = M^-1 (p - A q)``,
    ``p' = A^T q' + B q - (K + Kg) q/w^2 - (C q' + D q)/w`` with theta as variable.  It is solved by
    Gauss-Legendre collocation of order 16, or by commutator-free exponentials of order 6 where a
    few segments show that these take less work; the number of segments is doubled until two
    results agree.  Arrays of another namespace are turned into NumPy's: see
    :func:`monodromy_matrices`.

    Parameters
    ----------
    system : LinearPeriodic
        The system; forcing plays no part.
    speed : array_like
        Crank speeds w [rad/s], positive.
    rtol : float
        Wanted error, in the norm of ``error_norm``; 1e-13 to 1e-2.  Long periods with many
        oscillations may not reach it, because of round-off: see ``error``.
    **parameters : array_like
        Parameter values that replace the system's own; they broadcast with ``speed``.  Geometry
        too, one number each, where the system can be made anew for it.

    Returns
    -------
    Monodromy
        Its checks: ``converged``, the error at the worst place against ``rtol`` or what round-off
        allows there; ``liouville``, the determinant against ``exp(-integral trace(M^-1 C)/w)``; and
        ``symplectic``, the defect of ``X^T J X = J`` over ``|X|^2``, where conservative.

    Raises
    ------
    BadInput
        If speeds or parameters are unusable (see :func:`~.first_order.canonical_form`), or more
        than a million segments would be needed.
    """
    if not 1e-13 <= rtol <= 1e-2:
        raise bad("rtol", rtol, "a number from 1e-13 to 1e-2", "choose 1e-11")
    system, parameters = at_geometry(system, parameters)
    form = canonical_form(system, speed, parameters)
    m = 2 * system.size
    scaled, exponent, error, segments = looked_up(form, parameters, rtol)
    allowed, over = np.full(len(error), rtol), np.flatnonzero(error > rtol)
    if len(over):
        least = rounding_error(form.take(over), segments[over])
        allowed[over] = np.maximum(rtol, 100 * least)
    checks = monodromy_checks(form, scaled, exponent, error, np.minimum(allowed, 1e-2))
    # The exponent stays only where the unscaled matrix would overflow.
    size = np.log2(np.maximum(np.max(np.abs(scaled), axis=(-2, -1)), 1e-300)) + exponent
    spread = 2 * np.max(np.abs(np.log2(form.scale)), axis=-1, initial=0.0)
    kept = np.where(size + spread < 1000, 0, exponent)
    scaled = np.ldexp(scaled, (exponent - kept)[:, None, None])
    scale = form.scale
    matrix = scaled * scale[:, :, None] / scale[:, None, :]
    batch = form.batch
    return Monodromy(
        method=f"Gauss-Legendre collocation, order {2 * STAGES}, or exponentials, order 6",
        error=error.reshape(batch),
        error_norm="largest entry of the error, relative to the largest entry of the matrix, "
        "both in scaled variables",
        checks=checks,
        provenance=provenance(system.changed_provenance(**parameters)),
        speed=form.speed.reshape(batch),
        matrix=matrix.reshape(*batch, m, m),
        exponent=kept.reshape(batch),
        scale=scale.reshape(*batch, m),
        segments=segments.reshape(batch),
    )


def symplectic_unit(n: int) -> Array:
    """Return J = [[0, I], [-I, 0]], shape ``(2n, 2n)``."""
    return np.kron(np.array([[0.0, 1.0], [-1.0, 0.0]]), np.eye(n))


def trace_integral(form: CanonicalForm) -> Array:
    """Return the integral of trace L over a period, by the trapezoidal rule on the circle."""
    count = max(64, 2 ** int(np.ceil(np.log2(2 * form.reach + 1))))
    before: Array | None = None
    while True:
        theta = even_angles(form.system.period, count)
        value: Array = form.trace(theta).mean(axis=1) * form.system.period
        if before is not None:
            change = np.abs(value - before)
            if np.all(change <= 1e-13 * np.abs(value)) or count >= 4096:
                return value
        before, count = value, 2 * count


def monodromy_checks(
    form: CanonicalForm, scaled: Array, exponent: NDArray[np.int64], error: Array, allowed: Array
) -> Mapping[str, Check]:
    """Convergence, Liouville's determinant and symplecticity, of the worst of the batch."""
    if not len(error):
        return {}
    n = form.system.size
    norm = np.linalg.norm(scaled, axis=(-2, -1))
    last = int(np.argmax(error / allowed))
    checks = {"converged": Check(float(error[last]), float(allowed[last]))}
    sign, logarithm = np.linalg.slogdet(scaled)
    expected = trace_integral(form) - 2 * n * exponent * np.log(2.0)
    # A determinant is known to the error of the matrix times its condition.
    with np.errstate(over="ignore"):
        condition = np.linalg.cond(scaled)
    known = condition * error < 0.01
    gap = np.where(sign > 0, np.abs(logarithm - expected), np.inf) / np.maximum(condition, 1.0)
    if np.any(known):
        limit = 8 * n * float(np.max(error[known]))
        checks["liouville"] = Check(float(np.max(gap[known])), limit)
    if form.conservative:
        unit = symplectic_unit(n)
        shrink = np.ldexp(1.0, np.clip(-2 * exponent, -1060, 1000))[:, None, None]
        defect = np.swapaxes(scaled, -1, -2) @ unit @ scaled - unit * shrink
        worst = np.max(np.linalg.norm(defect, axis=(-2, -1)) / norm**2)
        checks["symplectic"] = Check(float(worst), min(8 * n * float(np.max(error)), 1e-3))
    return checks


@dataclass(frozen=True, kw_only=True)
class FloquetMultipliers(Result):
    """Floquet multipliers: the eigenvalues of the monodromy matrix.

    Attributes
    ----------
    speed : ndarray
        Crank speeds [rad/s], shape ``batch``.
    multipliers : ndarray of complex
        Shape ``(*batch, 2n)``, by falling modulus, then by the size of the argument, upper half
        plane first; inf where one overflows.
    exponents : ndarray of complex
        Their logarithms, growth and turning per period; finite where a multiplier overflows.
    error : ndarray
        Absolute error of each multiplier, shape ``(*batch, 2n)``: condition times error of the
        matrix, or the square root that holds near a double multiplier.
    period : float
        Period of the coefficients [rad].
    source : SignatureSource or None
        What :attr:`signatures` is made of.
    """

    speed: Array
    multipliers: ComplexArray
    exponents: ComplexArray
    period: float
    source: SignatureSource | None = None

    exported: ClassVar[tuple[str, ...]] = ("stable", "growth")

    @property
    def stable(self) -> NDArray[np.bool_]:
        """True where no multiplier is outside the unit circle by more than its error.

        An error of 0.1 or more says nothing: the multiplier then has to be inside by its error.
        """
        modulus = np.abs(self.multipliers)
        slack = np.where(self.error < _TELLING, self.error, -self.error)
        inside = np.isfinite(modulus) & (modulus <= 1.0 + slack)
        value: NDArray[np.bool_] = np.all(inside, axis=-1)
        return value

    @property
    def signatures(self) -> NDArray[np.int8]:
        """Krein signatures, shape ``(*batch, 2n)``, worked out when first asked for.

        +1 or -1 on the unit circle of a conservative system, by the convention of
        :mod:`~.krein`; 0 off the circle, where multiple and indefinite, where errors leave the
        sign open, and wherever there is damping.
        """
        if self.source is None:
            return np.zeros(self.multipliers.shape, dtype=np.int8)
        return self.source.signs(self.multipliers)

    @property
    def growth(self) -> Array:
        """Largest growth rate of the logarithm of the amplitude [1/s], shape ``batch``."""
        value: Array = np.max(self.exponents.real, axis=-1) * self.speed / self.period
        return value

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the multipliers and the unit circle into ``ax`` and return the axes."""
        from ..core.plotting import multiplier_plane

        ax = multiplier_plane(ax)
        values = self.multipliers.ravel()
        ax.plot(values.real, values.imag, "o", markersize=3)
        return ax


def floquet_multipliers(
    system: LinearPeriodic,
    speed: ArrayLike,
    *,
    rtol: float = 1e-11,
    executor: Any = None,
    **parameters: ArrayLike,
) -> FloquetMultipliers:
    """Return the Floquet multipliers over one period, each with its error.

    Where growth hides the small multipliers in the rounding of the monodromy matrix, the product
    of its segments is decomposed without being formed, so that all multipliers keep their digits.
    Where damping makes multipliers small, their absolute error alone is held: see
    :func:`relative_multipliers`.  Of stiff systems, :func:`characteristic_exponents` gives the
    lowest modes at a small part of the cost.

    Parameters
    ----------
    system : LinearPeriodic
        The system; forcing plays no part.
    speed : array_like
        Crank speeds [rad/s], positive.
    rtol : float
        Wanted error of the monodromy matrix, see :func:`monodromy`.
    executor : concurrent.futures.Executor, optional
        Threads, processes or Dask's ``client.get_executor()``, for fixed pieces of the batch: the
        answer does not depend on which, nor on the number of workers.
    **parameters : array_like
        Parameter values that replace the system's own; they broadcast with ``speed``.  Geometry
        too, one number each, where the system can be made anew for it.

    Returns
    -------
    FloquetMultipliers
        Its checks: those of the monodromy matrix, and ``product``, the product of the
        multipliers against Liouville's determinant; ``reciprocal pairs`` where undamped.

    Raises
    ------
    BadInput
        As :func:`monodromy`.
    """
    if executor is not None:
        from ..sweeps.batches import multipliers_in_pieces

        return multipliers_in_pieces(system, speed, parameters, {"rtol": rtol}, executor)
    return _multipliers(system, speed, rtol, False, parameters)


def relative_multipliers(
    system: LinearPeriodic, speed: ArrayLike, *, rtol: float = 1e-11, **parameters: ArrayLike
) -> FloquetMultipliers:
    """Return the Floquet multipliers with the relative digits of the small ones too.

    As :func:`floquet_multipliers`, and dearer: the decay of every mode is resolved by segments, and
    their product is decomposed without being formed, so that a multiplier of 1e-200 keeps as many
    digits as one of 1.  Where one is below the smallest number, its logarithm in ``exponents``
    still has them.

    Parameters
    ----------
    system : LinearPeriodic
        The system; forcing plays no part.
    speed : array_like
        Crank speeds [rad/s], positive.
    rtol : float
        Wanted error of the monodromy matrix, see :func:`monodromy`.
    **parameters : array_like
        Parameter values that replace the system's own.

    Returns
    -------
    FloquetMultipliers
        ``error`` is absolute, and small beside each multiplier.

    Raises
    ------
    BadInput
        As :func:`monodromy`.
    """
    return _multipliers(system, speed, rtol, True, parameters)


def _multipliers(
    system: LinearPeriodic,
    speed: ArrayLike,
    rtol: float,
    relative: bool,
    parameters: Mapping[str, ArrayLike],
) -> FloquetMultipliers:
    system, parameters = at_geometry(system, parameters)
    matrices = monodromy(system, speed, rtol=rtol, **parameters)
    form = canonical_form(system, speed, parameters)
    count, m = len(form.speed), form.size
    volume = trace_integral(form)
    segments = matrices.segments.reshape(count)
    if relative:
        decay = np.ceil(np.log2(np.maximum(form.rate * system.period / PHASE, 1.0)))
        segments = np.maximum(segments, 2 ** np.minimum(decay, 18).astype(np.int64))
    logarithm, angle, error = eigenvalues(
        form,
        matrices.scaled.reshape(count, m, m),
        matrices.exponent.reshape(count),
        matrices.error.reshape(count),
        segments,
        volume,
        relative,
    )
    with np.errstate(over="ignore"):
        modulus, absolute = np.exp(logarithm), np.exp(error)
    turning = np.cos(angle) + 1j * np.where(np.abs(angle) == np.pi, 0.0, np.sin(angle))
    finite = np.isfinite(modulus)
    values = np.where(finite, np.where(finite, modulus, 0.0) * turning, np.inf)
    checks = {**matrices.checks, "product": _product(logarithm, error, volume)}
    if form.conservative:
        checks["reciprocal pairs"] = _reciprocal(logarithm, angle, error)
    shape = (*form.batch, m)
    return FloquetMultipliers(
        method=f"eigenvalues of the monodromy matrix ({matrices.method})",
        error=absolute.reshape(shape),
        error_norm="absolute, of each multiplier",
        checks=checks,
        provenance=provenance(system.changed_provenance(**parameters)),
        speed=form.speed.reshape(form.batch),
        multipliers=values.reshape(shape),
        exponents=(logarithm + 1j * angle).reshape(shape),
        period=system.period,
        source=_signature_source(form, matrices),
    )


def _signature_source(form: CanonicalForm, matrices: Monodromy) -> SignatureSource | None:
    if not form.conservative:
        return None
    with np.errstate(over="ignore"):
        scaled = np.ldexp(matrices.scaled, matrices.exponent[..., None, None])
    return SignatureSource(scaled, matrices.error)


def _product(logarithm: Array, error: Array, volume: Array) -> Check:
    """Product of the multipliers against the determinant, in logarithms, at the worst place."""
    own = np.exp(np.minimum(error - np.maximum(logarithm, -1e4), 0.0))
    limit = 2 * np.sum(own, axis=-1) + 64 * _EPS * (1 + np.abs(volume))
    # One multiplier lost in round-off, and the product says nothing.
    finite = np.all(np.isfinite(logarithm) & (own < 1.0), axis=-1)
    total = np.sum(np.where(np.isfinite(logarithm), logarithm, 0.0), axis=-1)
    value = np.where(finite, np.abs(total - volume), 0.0)
    worst = int(np.argmax(value / limit))
    return Check(float(value[worst]), float(limit[worst]))


def _reciprocal(logarithm: Array, angle: Array, error: Array) -> Check:
    """How far the multipliers are from reciprocal pairs, at the worst place against the error."""
    pair = logarithm[:, :, None] + logarithm[:, None, :]
    turn = angle[:, :, None] + angle[:, None, :]
    defect = np.abs(np.expm1(np.clip(pair, -50, 50) + 1j * turn))
    partner = np.argmin(defect, axis=-1)
    value = np.take_along_axis(defect, partner[..., None], axis=-1)[..., 0]
    own = np.exp(np.clip(error - logarithm, -50, 50))
    limit = 2 * (own + np.take_along_axis(own, partner, axis=-1)) + 64 * _EPS
    worst = np.unravel_index(np.argmax(value / limit), value.shape)
    return Check(float(value[worst]), float(limit[worst]))
