"""Mobility of planar chains: Kutzbach's count, and the true one by the rank of the constraints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from numbers import Integral

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import bad
from ..core.inputs import require_one_of
from ..core.results import Check, Result, provenance
from .linkage import Array, finite_array


@dataclass(frozen=True, kw_only=True)
class Mobility(Result):
    """Mobility of a planar chain, by count and, where coordinates are given, by rank.

    Attributes
    ----------
    links, lower_pairs : int
        Links with the frame; simple pins: one that joins three links counts two.
    kutzbach : int
        3(k - 1) - 2 j_1 - j_2.
    gruebler : bool
        True where 3k - 2 j_1 - 4 = 0, Gruebler's condition for one degree of freedom.
    instantaneous : int or None
        Degrees of freedom of the velocities at the coordinates, None without them.  At a flat or
        stretched configuration it may exceed that of finite motion.
    redundant : int or None
        How many constraints depend on the others there.
    singular_values : ndarray
        Of the constraint Jacobian, lengths over the size of the chain, largest first.
    """

    links: int
    lower_pairs: int
    kutzbach: int
    gruebler: bool
    instantaneous: int | None
    redundant: int | None
    singular_values: Array


def mobility(
    pins: Sequence[Sequence[str]],
    *,
    higher_pairs: int = 0,
    coordinates: Sequence[Sequence[float]] | None = None,
    frame: str | None = None,
) -> Mobility:
    """Return the mobility of a planar chain of links joined by pins (Aannaque 3.2).

    Parameters
    ----------
    pins : sequence of sequences of str
        For each pin the names of the links that it joins, two or more; sliders count alike.
    higher_pairs : int
        Pairs with two degrees of freedom, counted by Kutzbach alone.
    coordinates : sequence of pairs of float, optional
        Where each pin is [any one unit]; gives the true mobility of the velocities there.
    frame : str, optional
        The fixed link; by default the first that is named.

    Returns
    -------
    Mobility
        By Kutzbach and by Gruebler, and that of the velocities where there are coordinates.

    Raises
    ------
    BadInput
        If a pin joins fewer than two links or one twice, the frame is no link, or the coordinates
        are not finite pairs, one for each pin.

    Examples
    --------
    >>> import elastolink as el
    >>> pins = [("bed", "crank"), ("crank", "coupler"), ("coupler", "rocker"), ("rocker", "bed")]
    >>> print(el.mobility(pins).kutzbach)
    1
    """
    try:
        joined = [tuple(pin) for pin in pins]
        wrong = [pin for pin in joined if len(pin) < 2 or len(set(pin)) < len(pin)]
    except (TypeError, KeyError) as refusal:
        fix = 'name links by joint: [("frame", "crank"), ...]'
        raise bad("pins", type(pins).__name__, "links in rows", fix) from refusal
    if wrong:
        raise bad("pins", repr(wrong[0]), "two or more different links", "name the links it joins")
    names = list(dict.fromkeys(link for pin in joined for link in pin))
    if not names:
        raise bad("pins", "none", "at least one pin", "describe the chain")
    fixed = names[0] if frame is None else frame
    require_one_of("frame", fixed, names, "name a link of the chain")
    if not isinstance(higher_pairs, Integral) or higher_pairs < 0:
        raise bad("higher_pairs", repr(higher_pairs), "a whole number, at least 0", "count again")
    if higher_pairs and coordinates is not None:
        raise bad("higher_pairs", "with coordinates", "pins alone", "leave one out")
    pairs = sum(len(pin) - 1 for pin in joined)
    count = 3 * (len(names) - 1) - 2 * pairs - int(higher_pairs)
    values = np.zeros(0)
    free: int | None = None
    gap = Check(0.0, 0.1)
    if coordinates is not None:
        values, rank, gap = _rank(joined, _points(coordinates, len(joined)), names, fixed)
        free = 3 * (len(names) - 1) - rank
    return Mobility(
        links=len(names),
        lower_pairs=pairs,
        kutzbach=count,
        gruebler=count == 1,
        instantaneous=free,
        redundant=None if free is None else free - count,
        singular_values=values,
        method="Kutzbach's count" + ("" if free is None else ", rank of the constraint Jacobian"),
        error=0.0,
        error_norm="mobility, a whole number; the check says how clearly the rank stands out",
        checks={"largest neglected over least kept singular value": gap},
        provenance=provenance({"pins": "; ".join("-".join(pin) for pin in joined)}),
    )


def _points(coordinates: ArrayLike, count: int) -> Array:
    """Return finite coordinates, one row for each pin, centred and over their size."""
    points = finite_array("coordinates", coordinates, "pairs, one for each pin")
    if points.shape != (count, 2):
        raise bad("coordinates", f"shape {points.shape}", f"{count} pairs", "give one per pin")
    points = points / (np.abs(points).max() or 1.0)
    points = points - points.mean(axis=0)
    return np.asarray(points / (np.abs(points).max() or 1.0))


def _rank(
    pins: Sequence[tuple[str, ...]], points: Array, names: Sequence[str], frame: str
) -> tuple[Array, int, Check]:
    """Return singular values and rank of "both links have the same velocity at the pin"."""
    moving = [name for name in names if name != frame]
    place: Mapping[str, int] = {name: 3 * i for i, name in enumerate(moving)}
    rows = []
    for pin, (x, y) in zip(pins, points, strict=True):
        for other in pin[1:]:
            pair = np.zeros((2, 3 * len(moving)))
            for link, sign in ((pin[0], 1.0), (other, -1.0)):
                if link in place:
                    at = slice(place[link], place[link] + 3)
                    pair[:, at] += sign * np.array([[1.0, 0.0, -y], [0.0, 1.0, x]])
            rows.append(pair)
    values = np.linalg.svd(np.vstack(rows), compute_uv=False)
    # Round-off of coordinates and decomposition, with room for coordinates known to 10 digits.
    limit = 1e-9 * float(values[0])
    rank = int(np.count_nonzero(values > limit))
    below = float(values[rank]) if rank < len(values) else 0.0
    return values, rank, Check(below / float(values[rank - 1]), 1e-6)
