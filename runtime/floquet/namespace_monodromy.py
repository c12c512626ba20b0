"""Monodromy matrices of large batches in the array namespace of the speeds and parameters given.

The host decides, with NumPy: which arguments are usable, the scales of the state and the number of
steps.  What grows with the batch and the steps runs where the arrays are: generators, step
matrices, their products and the comparison that tells the error.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from functools import cached_property, partial
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.inputs import is_whole
from ..core.namespaces import carried, common_array, is_foreign, namespace_of, to_numpy
from ..core.results import Check, DeferredChecks, Result, provenance
from ..integrators import METHODS
from ..integrators.protocol import OneStep
from .first_order import CanonicalForm, at_geometry, canonical_form
from .monodromy_matrix import monodromy_checks, trace_integral
from .period_products import period_product
from .refined_products import MOST_SEGMENTS, rounding_error, segment_groups

Array = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
# Explicit methods begin with steps of a fraction of those of collocation.
_EXPLICIT = 8
# Part of what halving the steps promises that is counted on, and the most that ever is.
_MARGIN, _LEAST_GAIN = 4.0, 1e-3
# Changes above which the steps are taken for too long to tell how fast the error falls.
_ROUGH = 1e-3


@dataclass(frozen=True)
class NamespaceForm(CanonicalForm):
    """A canonical form whose generators are arrays of another namespace than NumPy's.

    Attributes
    ----------
    like : array
        Gives namespace and device.
    """

    like: Any

    @classmethod
    def of(cls, form: CanonicalForm, like: Any) -> NamespaceForm:
        """Return a form in the namespace of an array."""
        return cls(**{f.name: getattr(form, f.name) for f in fields(CanonicalForm)}, like=like)

    def _combined(self, factors: Array, samples: Array) -> Array:
        flat = carried(samples.reshape(len(samples), -1), self.like)
        shape = (len(self.speed), *samples.shape[1:])
        shaped: Array = namespace_of(flat).reshape(carried(factors, self.like) @ flat, shape)
        return shaped

    @cached_property
    def scale(self) -> Array:
        """Scale of each component of the state, shape ``(nb, m)``; decided on the host."""
        host = CanonicalForm(**{f.name: getattr(self, f.name) for f in fields(CanonicalForm)})
        moved: Array = carried(host.scale, self.like)
        return moved


@dataclass(frozen=True, kw_only=True)
class MonodromyMatrices(Result):
    """Monodromy matrices in the array namespace of what they were asked for with.

    Attributes
    ----------
    speed : array
        Crank speeds [rad/s], shape ``batch``.
    matrix : array
        Shape ``(*batch, 2n, 2n)``; the monodromy matrix is ``matrix * 2**exponent``.
    exponent : array of int64
        Power of two taken out where the growth would overflow, else 0; shape ``batch``.
    scale : array
        Sizes of the state's components, shape ``(*batch, 2n)``; the error and the checks refer to
        ``matrix[i, j] * scale[j] / scale[i]``.
    determinant : array
        Liouville's determinant, ``exp(-integral trace(M^-1 C)/w)``, shape ``batch``.
    error : float
        Of the worst member of the batch, in the norm that ``error_norm`` names.
    steps : ndarray of int
        Steps per period that were used, shape ``batch``; of NumPy.
    """

    speed: Any
    matrix: Any
    exponent: Any
    scale: Any
    determinant: Any
    steps: NDArray[np.int64]

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {}

    @property
    def half_trace(self) -> Any:
        """Half the trace of each matrix, shape ``batch``; inf where it overflows."""
        xp = namespace_of(self.matrix)
        half = 0.5 * xp.linalg.trace(self.matrix)
        power = np.clip(to_numpy(self.exponent), 0, 2000)
        with np.errstate(over="ignore"):
            for part in (power // 2, power - power // 2):
                half = half * carried(np.ldexp(1.0, part), self.matrix)
        return half

    @property
    def stable(self) -> Any:
        """True where no multiplier is outside the unit circle by more than the error explains.

        Of one degree of freedom, by half trace and determinant: ``|half trace| <= (1 + det)/2`` and
        ``det <= 1``.  The error is that of the worst member of the batch.

        Raises
        ------
        BadInput
            If the system has several degrees of freedom: the array API has no eigenvalues for it.
        """
        if self.matrix.shape[-1] != 2:
            n = self.matrix.shape[-1] // 2
            fix = "use floquet_multipliers"
            raise bad("stable", f"{n} degrees of freedom", "one, for half the trace", fix)
        xp = namespace_of(self.matrix)
        slack = self.error * xp.max(xp.abs(self._scaled), axis=(-2, -1))
        inside = xp.abs(self.half_trace) <= 0.5 * (1.0 + self.determinant) + slack
        return inside & (self.determinant <= 1.0 + 64 * _EPS)

    @property
    def _scaled(self) -> Any:
        return self.matrix / self.scale[..., :, None] * self.scale[..., None, :]

    def to_numpy(self) -> MonodromyMatrices:
        """Return the same result with NumPy's arrays."""
        names = ("speed", "matrix", "exponent", "scale", "determinant")
        moved: dict[str, Any] = {name: to_numpy(getattr(self, name)) for name in names}
        return replace(self, **moved)

    def arrays(self) -> dict[str, np.ndarray[Any, Any]]:
        """Return the numeric fields by name, as NumPy's arrays."""
        if is_foreign(self.matrix):
            return self.to_numpy().arrays()
        return super().arrays()

    def to_dict(self) -> dict[str, Any]:
        """Return plain lists, numbers and strings, ready for JSON."""
        if is_foreign(self.matrix):
            return self.to_numpy().to_dict()
        return super().to_dict()


def monodromy_matrices(
    system: LinearPeriodic,
    speed: ArrayLike,
    *,
    method: str = "gauss_legendre16",
    steps: int | None = None,
    rtol: float = 1e-11,
    **parameters: ArrayLike,
) -> MonodromyMatrices:
    """Return monodromy matrices in the array namespace of the speeds and parameters.

    The equation is that of :func:`monodromy`.  Speeds and parameters may be arrays of any one
    namespace of the Python array API standard with its ``linalg``, on any one device: what is
    returned is of that namespace and device, NumPy's where all of them are NumPy's.  Their values
    are read on the host, so that nothing can be differentiated through.

    Parameters
    ----------
    system : LinearPeriodic
        The system; forcing plays no part.
    speed : array_like
        Crank speeds w [rad/s], positive; arrays of another namespace in double precision.
    method : str
        Name of a one-step method of ``METHODS`` that takes first-order systems; ``srkn4`` and
        ``srkn6`` only without damping and Coriolis terms.
    steps : int, optional
        Steps per period, from 2; half as many are taken too, to tell the error.  By default they
        are doubled until the error is below ``rtol`` or round-off.
    rtol : float
        Wanted error, 1e-13 to 1e-2.
    **parameters : array_like
        Parameter values that replace the system's own; they broadcast with ``speed``.  Geometry
        too, one number each, where the system can be made anew for it.

    Returns
    -------
    MonodromyMatrices
        Its checks, made when they are looked at, are those of :func:`monodromy`.

    Raises
    ------
    BadInput
        If an argument is unusable, arrays are of several namespaces or devices or of single
        precision, or more than a million steps would be needed.

    Notes
    -----
    All other solvers take arrays of another namespace too and turn them into NumPy's.
    """
    given: Mapping[str, Any] = {"speed": speed, **parameters}
    like = common_array(given)
    rule = _method(method)
    if not 1e-13 <= rtol <= 1e-2:
        raise bad("rtol", rtol, "a number from 1e-13 to 1e-2", "choose 1e-11")
    if steps is not None and not is_whole(steps, 2, MOST_SEGMENTS):
        raise bad("steps", steps, f"a whole number from 2 to {MOST_SEGMENTS}", "choose 64")
    empty = [name for name, value in given.items() if 0 in getattr(value, "shape", (1,))]
    if empty:
        raise bad(empty[0], f"shape {given[empty[0]].shape}", "a number at the least", "give some")
    system, parameters = at_geometry(system, parameters)
    host = canonical_form(system, speed, parameters)
    form = host if like is None else NamespaceForm.of(host, like)
    groups = segment_groups(host) if steps is None else [(np.arange(len(host.speed)), steps)]
    found = [_solved(host, form, rule, own, first, steps, rtol) for own, first in groups]
    scaled, exponent = (_gathered([one[k] for one in found], groups) for k in (0, 1))
    error, used = (np.zeros(len(host.speed)) for _ in range(2))
    for (own, _), (_, _, figure, number) in zip(groups, found, strict=True):
        error[own], used[own] = figure, number
    return _result(form, host, rule, scaled, exponent, error, used.astype(np.int64), rtol)


def _method(name: str) -> OneStep:
    usable = sorted(set(METHODS) - {"de_vogelaere"})  # which carries a state of its own
    if name not in usable:
        raise bad("method", repr(name), f"one of {usable}", "choose gauss_legendre16")
    return METHODS[name]


def _gathered(parts: list[Any], groups: list[tuple[NDArray[np.intp], int]]) -> Any:
    """Return the parts of the groups as one array in the order of the batch."""
    if len(parts) == 1:
        return parts[0]
    xp = namespace_of(parts[0])
    order = np.argsort(np.concatenate([own for own, _ in groups]))
    places = xp.asarray(order) if xp is np else xp.asarray(order, device=parts[0].device)
    return xp.take(xp.concat(parts, axis=0), places, axis=0)


def _solved(
    host: CanonicalForm,
    form: CanonicalForm,
    method: OneStep,
    own: NDArray[np.intp],
    first: int,
    steps: int | None,
    rtol: float,
) -> tuple[Any, Any, Array, int]:
    """Return matrices, powers of two, errors and steps of some members of the batch."""
    host, form = host.take(own), form.take(own)
    begun = first * (_EXPLICIT if method.explicit else 1)
    number = begun if steps is None else (steps + 1) // 2
    value, power = period_product(form, number, method)
    before = np.ones(len(own))
    while True:
        finer = 2 * number if steps is None else steps
        new, new_power = period_product(form, finer, method)
        change = _distance(value, power, new, new_power)
        gain = np.clip(change / before, max(_MARGIN * 0.5**method.order, _LEAST_GAIN), 1.0)
        gain[change > _ROUGH] = 1.0
        error = change * gain + rounding_error(host, finer)
        # Round-off, not truncation, where halving the steps no longer helps.
        stuck = (change > 0.25 * before) & (change < _ROUGH)
        error[stuck] += 2 * change[stuck]
        done = steps is not None or bool(np.all((error <= rtol) | stuck))
        if done or 2 * finer > MOST_SEGMENTS:
            return new, new_power, error, finer
        value, power, before, number = new, new_power, change, finer


def _distance(first: Any, first_power: Any, second: Any, second_power: Any) -> Array:
    """Return the largest difference of entries over the largest entry of the second, in NumPy."""
    xp = namespace_of(second)
    shift = np.clip(to_numpy(first_power) - to_numpy(second_power), -1000, 1000)
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        aligned = first * carried(np.ldexp(1.0, shift), second)[:, None, None]
        top = xp.max(xp.abs(second), axis=(-2, -1))
        found = to_numpy(xp.max(xp.abs(aligned - second), axis=(-2, -1)) / top)
    return np.where(np.isfinite(found), found, 1.0)


def _result(
    form: CanonicalForm,
    host: CanonicalForm,
    method: OneStep,
    scaled: Any,
    exponent: Any,
    error: Array,
    used: NDArray[np.int64],
    rtol: float,
) -> MonodromyMatrices:
    xp, m = namespace_of(scaled), host.size
    power = to_numpy(exponent)
    top = to_numpy(xp.max(xp.abs(scaled), axis=(-2, -1)))
    # The exponent stays only where the unscaled matrix would overflow.
    size = np.log2(np.maximum(top, 1e-300)) + power
    spread = 2 * np.max(np.abs(np.log2(host.scale)), axis=-1)
    kept = np.where(size + spread < 1000, 0, power)
    moved = scaled
    for part in ((power - kept) // 2, power - kept - (power - kept) // 2):
        moved = moved * carried(np.ldexp(1.0, part), scaled)[:, None, None]
    scale = form.scale
    matrix = moved * scale[:, :, None] / scale[:, None, :]
    where = {} if xp is np else {"device": scaled.device}
    volume = np.exp(trace_integral(host))
    allowed = np.maximum(rtol, 100 * rounding_error(host, used))
    return MonodromyMatrices(
        method=f"{method.name}, order {method.order}",
        error=float(np.max(error)),
        error_norm="largest entry of the error, relative to the largest entry of the matrix, both "
        "in scaled variables; of the worst member of the batch",
        checks=DeferredChecks(
            partial(_checks, host, moved, kept, error, np.minimum(allowed, 1e-2))
        ),
        provenance=provenance(host.system.provenance),
        speed=xp.reshape(carried(host.speed, scaled), host.batch),
        matrix=xp.reshape(matrix, (*host.batch, m, m)),
        exponent=xp.reshape(xp.asarray(kept, **where), host.batch),
        scale=xp.reshape(scale, (*host.batch, m)),
        determinant=xp.reshape(carried(volume, scaled), host.batch),
        steps=used.reshape(host.batch),
    )


def _checks(
    host: CanonicalForm,
    scaled: Any,
    exponent: NDArray[np.int64],
    error: Array,
    allowed: Array,
) -> Mapping[str, Check]:
    return monodromy_checks(host, to_numpy(scaled), exponent, error, allowed)
