"""Krein signatures of multipliers on the unit circle of a conservative periodic system.

With J = [[0, I], [-I, 0]] the monodromy matrix X of the canonical variables obeys X^T J X = J.
The form kappa(x) = -i x^H J x is real; its sign on the eigenvector of a multiplier on the circle
is the multiplier's signature.  Convention: +1 means that the multiplier moves anticlockwise where
the Hamiltonian grows (a positive definite term is added), and for constant coefficients that
exp(i w T), w > 0, belongs to a motion of positive energy.  Conjugate multipliers have opposite
signatures.  Multipliers that meet can leave the circle only where their signatures differ.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.results import Check, Result
from ..periodic.multipliers import conditions, multiplier_order
from ..periodic.signatures import form_matrix

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Signs = NDArray[np.int8]

_EPS = float(np.finfo(float).eps)
# Largest entry whose square, and the condition numbers made of it, do not overflow.
_LARGEST = 1e100
# Defect of X^T J X = J, over |X|^2, from which a matrix is refused.
_MOST_DEFECT = 1e-6


@dataclass(frozen=True, kw_only=True)
class KreinSignatures(Result):
    """Krein signatures of the multipliers of symplectic monodromy matrices.

    Attributes
    ----------
    multipliers : ndarray of complex
        Shape ``(*batch, 2n)``, in the order of :func:`floquet_multipliers`.
    signatures : ndarray of int8
        Shape ``(*batch, 2n)``: +1 or -1; 0 where the multiplier is off the circle, where it is
        multiple and the form indefinite (always at +-1), or where errors leave the sign open.
    inertia : ndarray of int
        Shape ``(*batch, 2n, 2)``: how many positive and how many negative directions the form has
        on the invariant subspace of the multiplier and those that errors do not tell from it;
        (0, 0) off the circle or where open.
    form : ndarray
        kappa of the unit eigenvector, from -1 to 1, shape ``(*batch, 2n)``; NaN where the
        multiplier is multiple.  1/abs(kappa) is the condition number of the multiplier.
    error : ndarray
        Absolute error of ``form``, or of the form on the subspace; shape ``(*batch, 2n)``; inf
        where nothing is known.
    """

    multipliers: ComplexArray
    signatures: Signs
    inertia: NDArray[np.int64]
    form: Array

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {}


def krein_signatures(matrices: ArrayLike, error: ArrayLike | None = None) -> KreinSignatures:
    """Return the Krein signatures of the multipliers of symplectic matrices.

    Parameters
    ----------
    matrices : array_like, shape (*batch, 2n, 2n)
        Monodromy matrices of canonical variables (q, p), q first; such as
        ``monodromy(...).scaled``, where the entries have like sizes.
    error : array_like, shape batch, optional
        Largest error of an entry over the largest entry, as ``monodromy(...).error``; round-off
        by default.

    Returns
    -------
    KreinSignatures
        Its checks: ``symplectic``, the worst defect of ``X^T J X = J`` over ``|X|^2``; and
        ``balanced``, the largest sum of decided signatures of a matrix all of which are decided:
        conjugates cancel.

    Raises
    ------
    BadInput
        If the matrices are not of real numbers, not square of even size, not finite, beyond 1e100
        or not symplectic; if an error is missing or negative, or does not broadcast.
    """
    given = _given("matrices", matrices)
    if (
        given.ndim < 2
        or given.shape[-1] != given.shape[-2]
        or given.shape[-1] % 2
        or given.size < 1
    ):
        raise bad("matrices", f"shape {given.shape}", "shape (*batch, 2n, 2n)", "correct it")
    if not np.all(np.isfinite(given)):
        raise bad("matrices", "infinite or missing entries", "finite matrices", "leave them out")
    if np.max(np.abs(given)) > _LARGEST:
        raise bad(
            "matrices",
            f"an entry of size {np.max(np.abs(given)):.2g}",
            f"entries of size {_LARGEST:g} at most",
            "scale the variables, or leave out periods with such growth",
        )
    batch, m = given.shape[:-2], given.shape[-1]
    flat = given.reshape(-1, m, m)
    relative = _relative(error, batch)
    defect = _defect(flat)
    worst = float(np.max(defect - 8 * m * relative))
    if worst > _MOST_DEFECT:
        raise bad(
            "matrices",
            f"a defect of {worst:.2g} of X^T J X = J",
            "symplectic matrices of an undamped system",
            "order the state as (q, p), leave out damping",
        )
    found = [_one(*row) for row in zip(*_spectra(flat, relative), strict=True)]
    values, signs, inertia, form, uncertain = (
        np.stack(part).reshape(*batch, *np.shape(part[0])) for part in zip(*found, strict=True)
    )
    decided = np.all(signs != 0, axis=-1)
    balance = np.where(decided, np.abs(np.sum(signs, axis=-1, dtype=int)), 0)
    return KreinSignatures(
        method="form -i x^H J x on eigenvectors and invariant subspaces",
        error=uncertain,
        error_norm="absolute, of the form on unit vectors",
        checks={
            "symplectic": Check(float(np.max(defect)), max(1e-10, 8 * m * float(relative.max()))),
            "balanced": Check(float(np.max(balance)), 0.0),
        },
        multipliers=values,
        signatures=signs,
        inertia=inertia,
        form=form,
    )


def _given(name: str, value: object) -> Array:
    """Return real numbers as floats; raise :class:`BadInput` where they are none."""
    try:
        given = np.asarray(value)
    except ValueError as ragged:
        raise bad(name, "rows of unequal length", "an array of real numbers", "correct it") from (
            ragged
        )
    if given.size and given.dtype.kind not in "iuf":
        raise bad(
            name,
            f"entries of type {given.dtype}",
            "real numbers",
            "give the real matrices themselves",
        )
    return given.astype(np.float64)


def _relative(error: ArrayLike | None, batch: tuple[int, ...]) -> Array:
    """Return the relative error of each matrix, flat."""
    given = _given("error", 64 * _EPS if error is None else error)
    if not np.all(given >= 0):
        raise bad("error", "a missing or negative one", "errors of at least 0", "give one")
    try:
        # Beyond 1 nothing more can be lost.
        return np.minimum(np.broadcast_to(given, batch), 1.0).reshape(-1)
    except ValueError as mismatch:
        raise bad(
            "error", f"shape {given.shape}", f"a shape that broadcasts to {batch}", "correct it"
        ) from mismatch


def _defect(matrices: Array) -> Array:
    """Return the defect of X^T J X = J over |X|^2, shape ``(nb,)``."""
    n = matrices.shape[-1] // 2
    unit = np.kron(np.array([[0.0, 1.0], [-1.0, 0.0]]), np.eye(n))
    norm = np.linalg.norm(matrices, axis=(-2, -1))
    with np.errstate(over="ignore"):
        size = np.maximum(norm, 1.0)[:, None, None]
        scaled = matrices / size
        gap = np.swapaxes(scaled, -1, -2) @ unit @ scaled - unit / size**2
    value: Array = np.linalg.norm(gap, axis=(-2, -1))
    return value


def _spectra(
    matrices: Array, relative: Array
) -> tuple[Array, ComplexArray, ComplexArray, Array, Array]:
    """Return matrices, multipliers, unit eigenvectors, radii of uncertainty and shifts."""
    m = matrices.shape[-1]
    values, vectors = np.linalg.eig(matrices)
    values, vectors = values.astype(complex), vectors.astype(complex)
    with np.errstate(divide="ignore"):
        order = multiplier_order(np.log(np.abs(values)), np.angle(values))
    values = np.take_along_axis(values, order, axis=-1)
    vectors = np.take_along_axis(vectors, order[:, None, :], axis=-1)
    norm = np.linalg.norm(matrices, axis=(-2, -1))
    top = np.max(np.abs(matrices), axis=(-2, -1))
    shift = m * relative * top + 4 * m * _EPS * norm
    simple = _conditions(vectors) * shift[:, None]
    root = 2 * np.sqrt(norm * shift)[:, None]
    return matrices, values, vectors, np.minimum(simple, root), shift


def _conditions(vectors: ComplexArray) -> Array:
    """Return the condition numbers of the multipliers; inf where vectors all but agree."""
    out = np.full(vectors.shape[:2], np.inf)
    for place, columns in enumerate(vectors):
        try:
            # Beyond the square root of the largest number, nothing is left of the sign.
            with np.errstate(over="ignore", invalid="ignore"):
                out[place] = conditions(columns[None])[0]
        except np.linalg.LinAlgError:
            continue
    out[np.isnan(out)] = np.inf
    return out


Signed = tuple[ComplexArray, Signs, NDArray[np.int64], Array, Array]


def _one(
    matrix: Array, values: ComplexArray, vectors: ComplexArray, radius: Array, shift: float
) -> Signed:
    """Return multipliers, signatures, inertias, forms and their errors of one matrix."""
    m = len(values)
    signs = np.zeros(m, dtype=np.int8)
    inertia = np.zeros((m, 2), dtype=np.int64)
    form, error = np.full(m, np.nan), np.full(m, np.inf)
    distance = np.abs(values[:, None] - values)
    for members in _clusters(distance <= radius[:, None] + radius):
        others = np.setdiff1d(np.arange(m), members)
        reach = float(np.max(radius[members]))
        gap = float(np.min(distance[np.ix_(members, others)], initial=np.inf))
        if gap <= 0.0 or abs(float(np.mean(np.abs(values[members]))) - 1.0) > reach:
            continue
        basis = vectors[:, members] if len(members) == 1 else _subspace(matrix, values, members)
        if basis is None:
            continue
        levels = np.linalg.eigvalsh(form_matrix(basis))
        # A subspace turns by the shift of the matrix, magnified by the other multipliers' own
        # conditions, over their distance.
        apart = np.min(distance[np.ix_(members, others)], axis=0, initial=np.inf)
        magnified = np.maximum(radius[others] / shift, 1.0) / apart
        error[members] = 2 * shift * float(np.sum(magnified)) + 8 * m * _EPS
        if len(members) == 1:
            form[members] = levels
        positive, negative = (int(np.sum(sign * levels > error[members[0]])) for sign in (1, -1))
        if positive + negative == len(members):
            inertia[members] = positive, negative
            signs[members] = (negative == 0) - (positive == 0)
    return values, signs, inertia, form, error


def _clusters(linked: NDArray[np.bool_]) -> list[NDArray[np.intp]]:
    """Return the connected groups of a symmetric relation."""
    reached = linked | np.eye(len(linked), dtype=bool)
    for _ in range(len(linked).bit_length()):
        reached = (reached.astype(int) @ reached.astype(int)) > 0
    firsts = np.argmax(reached, axis=1)
    return [np.flatnonzero(firsts == first) for first in np.unique(firsts)]


def _subspace(
    matrix: Array, values: ComplexArray, members: NDArray[np.intp]
) -> ComplexArray | None:
    """Return an orthonormal basis of the invariant subspace of a group of multipliers."""
    from scipy.linalg import schur

    centre = complex(np.mean(values[members]))
    inner = float(np.max(np.abs(values[members] - centre)))
    others = np.abs(np.delete(values, members) - centre)
    limit = 0.5 * (inner + float(np.min(others))) if len(others) else np.inf

    def chosen_ones(value: complex) -> bool:
        return abs(value - centre) <= limit

    select: Any = chosen_ones
    try:
        _, basis, count = schur(matrix, output="complex", sort=select)
    except np.linalg.LinAlgError:
        # Too ill-conditioned to be ordered: nothing is known.
        return None
    if count != len(members):
        return None
    chosen: ComplexArray = np.asarray(basis[:, :count], dtype=complex)
    return chosen
