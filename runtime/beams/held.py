"""Whether every motion of a structure of beams meets stiffness, and whether doubles can tell."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..core.errors import BadInput, bad
from .assembly import AngleArrays, Array
from .sliding import Slide
from .turning import rotation

# A mode softer than this, over the stiffest, is taken for one that nothing resists.
_SOFTEST = 1e-14
# Deformation of the elements, over the largest there can be, below which a motion has none.
_RIGID = 1e-9
# Share of a motion from which a coordinate is named.
_NAMED = 0.1


def require_held(arrays: AngleArrays, springs: Array, slide: Slide | None) -> None:
    """Refuse a structure that can move without resistance, at a few angles of the crank.

    Parameters
    ----------
    arrays : AngleArrays
        Of the structure.
    springs : ndarray, shape (n,)
        Stiffness of the springs on the free coordinates.
    slide : Slide or None
        What a sliding pin lets move.

    Raises
    ------
    BadInput
        If a motion meets no stiffness, or one so much smaller than another's that their sum in
        doubles has no digit of it.
    """
    structure = arrays.structure
    theta = structure.period * np.array([0.0, 0.37, 0.61]) if structure.moving else np.zeros(1)
    matrices = arrays.stiffness(theta) + np.diag(springs)
    strains = _strains(arrays, springs, theta)
    if slide is not None:
        basis = slide.basis(theta)
        matrices = np.swapaxes(basis, -1, -2) @ matrices @ basis
        strains = strains @ basis
    for angle, stiffness, strain in zip(theta, matrices, strains, strict=True):
        sizes = np.sqrt(np.diag(stiffness))
        loose: Iterable[int] = np.flatnonzero(sizes == 0.0)
        if not np.any(sizes == 0.0):
            values = np.linalg.eigvalsh(stiffness / np.outer(sizes, sizes))
            if values[0] > _SOFTEST * len(values) * values[-1]:
                continue
            motion = _rigid_motion(strain)
            if motion is None:
                raise _lost_in_rounding(arrays)
            loose = np.flatnonzero(motion > _NAMED * np.max(motion))
        names = ", ".join([structure.labels[i] for i in loose][:6])
        raise bad(
            "structure",
            f"a motion of {names} that nothing resists at crank angle {angle:.4g}",
            "a structure whose every motion is held or sprung",
            "hold a node, join beams, or add a spring",
        )


def _strains(arrays: AngleArrays, springs: Array, theta: Array) -> Array:
    """Return what each element and spring feels of the free coordinates, ``(nt, rows, n)``.

    Of an element: its stretch, the difference of its ends' rotations, and the rotation of its chord
    against their mean, all times lengths.  Stiffnesses are not in it, so that a short element
    is as good as a long one.
    """
    elements = arrays.structure.elements
    longest = max(placed.length for placed in elements)
    motion = arrays.motion(theta)
    parts = rotation(6)
    rows = []
    for placed in elements:
        half = placed.length / 2.0
        own = np.zeros((3, 6))
        own[0, [0, 3]] = -1.0, 1.0
        own[1, [2, 5]] = -longest, longest
        own[2, [1, 4, 2, 5]] = -1.0, 1.0, -half, -half
        c, s = motion.products[placed.beam.name][:, 1:3].T
        turned = parts["1"] + c[:, None, None] * parts["c"] + s[:, None, None] * parts["s"]
        placed_rows = np.zeros((len(theta), 3, arrays.count))
        placed_rows[:, :, placed.indices[:6]] = own @ turned
        rows.append(placed_rows[:, :, arrays.free])
    sprung = np.eye(len(springs))[springs > 0.0]
    rows.append(np.broadcast_to(sprung, (len(theta), *sprung.shape)))
    return np.concatenate(rows, axis=1)


def _rigid_motion(strain: Array) -> Array | None:
    """Return sizes of the coordinates in a motion that strains nothing; None where all do.

    What an element holds beside its ends moves with them or strains it: it is left out.
    """
    felt = np.flatnonzero(np.any(strain != 0.0, axis=0))
    sizes = np.linalg.norm(strain[:, felt], axis=0)
    _, values, across = np.linalg.svd(strain[:, felt] / sizes)
    if len(values) == len(felt) and values[-1] > _RIGID * values[0]:
        return None
    motion = np.zeros(strain.shape[1])
    motion[felt] = np.abs(across[-1] / sizes)
    return motion


def _lost_in_rounding(arrays: AngleArrays) -> BadInput:
    """Return the refusal that names the stiffest and the softest element."""
    stiff = [max(own.stiffness[0, 0], own.stiffness[1, 1]) for _, own in arrays.local]
    soft = [min(own.stiffness[0, 0], own.stiffness[1, 1]) for _, own in arrays.local]
    most, least = int(np.argmax(stiff)), int(np.argmin(soft))
    one, other = arrays.local[most][0], arrays.local[least][0]
    return bad(
        f"beam {one.beam.name}",
        f"an element of {one.length:.3g} m, {stiff[most] / soft[least]:.2g} times as stiff as one "
        f"of {other.length:.3g} m of beam {other.beam.name}: rounding of their sum leaves few "
        "digits, if any, of what resists the softest motion",
        "elements of like length and stiffness",
        "leave the short element out and join its ends, or make it longer",
    )
