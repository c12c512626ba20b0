"""Which links of a linkage turn fully: Grashof's theorem, Barker's classes, change points."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from numbers import Real
from typing import Any, Literal, overload

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad, shown
from ..core.inputs import require_one_of
from ..core.plotting import Axes
from ..core.results import Result, provenance
from .four_bar import FourBar, LoopSums
from .linkage import EPS, finite_array
from .quick_return import QuickReturn
from .slider_crank import SliderCrank

# A four-bar linkage can lie flat, and so change its assembly, where one of three sums is zero:
#
#     S_2 = (frame + crank)    - (coupler + follower)
#     S_3 = (frame + coupler)  - (crank + follower)
#     S_4 = (frame + follower) - (crank + coupler)
#
# named after the link beside the frame.  s + l - p - q of Grashof's theorem is, up to its sign, the
# least of the three in magnitude.  Their signs, taken exactly of the lengths as doubles, decide
# everything: the class, and which links turn fully against which.
Category = Literal["Grashof", "non-Grashof", "change point"]

LINKS = ("frame", "crank", "coupler", "follower")


@dataclass(frozen=True)
class BarkerClass:
    """One of the fourteen rows of Barker's table (Aannaque Table 3.1, corrected)."""

    number: int  # the row, 1 to 14
    category: Category  # s + l below, above or equal to p + q
    characteristic: str  # the link that marks the class, or what does
    class_number: int  # Barker's class within the category
    # name, symbol: Barker's; input, coupler and output link in this order
    name: str
    symbol: str
    also: str  # what else such a linkage is called


def _table() -> tuple[BarkerClass, ...]:
    shapes = (
        ("frame", "crank-crank-crank", "CCC", "double crank (drag link)"),
        ("input", "crank-rocker-rocker", "CRR", "crank rocker"),
        ("coupler", "rocker-crank-rocker", "RCR", "double rocker with turning coupler"),
        ("output", "rocker-rocker-crank", "RRC", "rocker crank"),
    )
    grashof, others, change = list[Any](), list[Any](), list[Any]()
    for i, (role, kind, letters, called) in enumerate(shapes, start=1):
        least, name = f"{role} shortest", f"Class {i} rocker-rocker-rocker"
        grashof.append(("Grashof", least, i, f"Grashof {kind}", f"G{letters}", called))
        others.append(("non-Grashof", f"{role} longest", i, name, f"RRR{i}", "triple rocker"))
        name, also = f"Change point {kind}", f"{called} at a change point"
        change.append(("change point", least, i, name, f"CP{letters}", also))
    pairs, two = "two pairs of equal links", "parallelogram linkage or kite"
    change.append(("change point", pairs, 5, "Double change point", "CP2X", two))
    change.append(
        ("change point", "four equal links", 6, "Triple change point", "CP3X", "rhombus linkage")
    )
    rows = [*grashof, *others, *change]
    return tuple(BarkerClass(number, *row) for number, row in enumerate(rows, start=1))


CLASSES = _table()


def number_of_signs(signs: Sequence[int]) -> int:
    """Return the row of Barker's table for the signs of S_2, S_3, S_4.

    Without zeros, three equal signs mark the frame, otherwise the odd one out marks its link: as
    the shortest of a Grashof linkage where the product of the signs is negative, and otherwise as
    the longest of a non-Grashof one.  Every zero lies on the surface between two such cells; a
    single one belongs to the same shortest link as the Grashof cell that it bounds.
    """
    zeros = list(signs).count(0)
    if zeros >= 2:
        return 11 + zeros
    product = int(np.prod([sign or 1 for sign in signs]))
    cell = [sign or -product for sign in signs]
    if len(set(cell)) == 1:
        link = 0
    else:
        odd = 1 if cell.count(1) == 1 else -1
        link = cell.index(odd) + 1
    grashof = int(np.prod(cell)) < 0
    return link + (9 if zeros else 1 if grashof else 5)


def turning(signs: Sequence[int]) -> dict[tuple[str, str], bool]:
    """Return for each pair of links whether one turns fully against the other.

    Two links turn fully against each other where the vector sum of the two stays, in any direction
    of theirs, within the reach of the sum of the other two.  (The order of the vectors in a loop
    does not matter, so this holds for opposite links as for adjacent ones.)  With the frame and
    link i that is ``S_i <= 0`` and ``S_j S_k >= 0``; with the other two of the links the signs of
    S_i and of the product are reversed.  Equality: the links turn through a change point.
    """
    pairs = {}
    for i in range(3):
        beside = LINKS[i + 1]
        others = tuple(link for link in LINKS[1:] if link != beside)
        product = int(np.prod([sign for j, sign in enumerate(signs) if j != i]))
        pairs["frame", beside] = signs[i] <= 0 <= product
        pairs[others[0], others[1]] = signs[i] >= 0 >= product
    return pairs


# Row of the table for each pattern of signs, at 9 (S_2 + 1) + 3 (S_3 + 1) + (S_4 + 1).
_ROWS = np.array(
    [number_of_signs(signs) for signs in itertools.product((-1, 0, 1), repeat=3)], dtype=np.int64
)


Input = Literal["crank", "follower"]
SYMBOLS = ("", *(row.symbol for row in CLASSES))

_CONDITIONS = tuple(
    f"frame + {beside} = {' + '.join(link for link in LINKS[1:] if link != beside)}"
    for beside in LINKS[1:]
)
_ERROR: Mapping[str, Any] = {
    "error": 2.0**-53,
    "error_norm": "distances over the sum of lengths, absolute, worst",
    "error_kind": "bound",
}


@dataclass(frozen=True, kw_only=True)
class Classification(Result):
    """Class of a four-bar linkage, what turns in it, and how far it is from another class.

    A distance is divided by the sum of the four lengths.  Its magnitude is then the least relative
    tolerance which, given to every length at once, reaches the surface; its sign says on which
    side the linkage lies.  ``error`` is that of the distances.

    Attributes
    ----------
    frame, crank, coupler, follower : float
        Lengths, as given.
    input : {"crank", "follower"}
        The driven link; in Barker's words the other one is the output.
    number, class_number : int
        Row of Barker's table, 1 to 14, and his class within the category.
    category : {"Grashof", "non-Grashof", "change point"}
        s + l below, above or equal to p + q.
    name, symbol, also : str
        Barker's name and symbol, and a common one.
    characteristic : str
        The link that marks the class, in the words of Barker's table.
    turns : mapping of str to bool
        For crank, coupler and follower: turns fully against the frame.  At a change point: turns
        when it is led through the positions where all links lie in one line.
    relative_turns : mapping of str to bool
        The same for every pair of links, such as ``"crank-coupler"``.
    inversions : mapping of str to str
        Symbol of the linkage that has this link as its frame, input being the next link in the
        order frame, crank, coupler, follower, frame.
    distance : float
        (s + l - p - q)/(s + l + p + q): negative for Grashof linkages.
    change_distances : mapping of str to float
        Signed distance to each of the three change surfaces, left side less right side.
    nearest_change : str
        Condition of the nearest of them.
    closing_distances : mapping of str to float
        Signed distance to the zero-mobility planes (Aannaque 3.2), each link less the other three:
        all negative, and zero where the linkage is stretched and cannot move.
    tolerance : float
        Relative tolerance of every length within which a change point counts as reached.
    """

    frame: float
    crank: float
    coupler: float
    follower: float
    input: Input
    number: int
    class_number: int
    category: Category
    name: str
    symbol: str
    also: str
    characteristic: str
    turns: Mapping[str, bool]
    relative_turns: Mapping[str, bool]
    inversions: Mapping[str, str]
    distance: float
    change_distances: Mapping[str, float]
    nearest_change: str
    closing_distances: Mapping[str, float]
    tolerance: float

    @property
    def described(self) -> str:
        """The class in one line: what it is called, then Barker's name and symbol."""
        return f"{self.also}, in Barker's table {self.name} ({self.symbol})"

    @property
    def lengths(self) -> dict[str, float]:
        """Lengths by name."""
        return {name: getattr(self, name) for name in LINKS}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the base plane of Barker's solution space with this linkage in it."""
        from .base_planes import base_plane

        frame, crank, coupler, follower = self.lengths.values()
        if self.input == "follower":
            crank, follower = follower, crank
        ratios = (coupler / crank, follower / crank, frame / crank)
        return base_plane(sum(ratios) / 3.0**0.5).plot(ax, mark=ratios)


@dataclass(frozen=True, kw_only=True)
class SlidingClassification(Result):
    """Class of a slider-crank or quick-return linkage.

    Distances are divided by the sum of the lengths, as those of :class:`Classification`.

    Attributes
    ----------
    mechanism : {"slider-crank", "quick-return"}
        Which of the two.
    lengths : mapping of str to float
        Those that decide, as given; an offset with its sign.
    category : {"Grashof", "non-Grashof", "change point"}
        As that of the four-bar linkage of which it is the limit.
    name : str
        What it is called.
    turns : mapping of str to bool
        For each moving link: turns fully against the frame.
    distance : float
        To the nearest change surface.  Slider-crank: shorter link + abs(offset) - longer link,
        negative for Grashof linkages.  Quick return: crank - frame, negative where the rod
        oscillates.
    change_distances : mapping of str to float
        Signed distance to each change condition, left side less right side.
    nearest_change : str
        Condition of the nearest of them.
    closing_distance : float or None
        Signed distance to where a slider-crank cannot close; None where there is no such limit.
    tolerance : float
        Relative tolerance of every length within which a change point counts as reached.
    """

    mechanism: Literal["slider-crank", "quick-return"]
    lengths: Mapping[str, float]
    category: Category
    name: str
    turns: Mapping[str, bool]
    distance: float
    change_distances: Mapping[str, float]
    nearest_change: str
    closing_distance: float | None
    tolerance: float

    @property
    def described(self) -> str:
        """The class in one line: what it is called, and its category by Grashof's theorem."""
        return f"{self.name} ({self.category})"


@overload
def classify(
    linkage: FourBar | Sequence[float], *, input: Input = "crank", tolerance: float = 0.0
) -> Classification: ...


@overload
def classify(
    linkage: SliderCrank | QuickReturn, *, input: Input = "crank", tolerance: float = 0.0
) -> SlidingClassification: ...


@overload
def classify(
    linkage: NDArray[Any], *, input: Input = "crank", tolerance: float = 0.0
) -> NDArray[np.int64]: ...


def classify(
    linkage: FourBar | SliderCrank | QuickReturn | Sequence[float] | NDArray[Any],
    *,
    input: Input = "crank",
    tolerance: float = 0.0,
) -> Classification | SlidingClassification | NDArray[np.int64]:
    """Return the class of a linkage by Grashof's theorem (Aannaque 3.4, Barker 1985).

    Lengths are taken as doubles, and the class is exact for them: no round-off can change it.
    With equal lengths nothing is left to choose: where s + l differs from p + q, the shortest link
    of a Grashof linkage and the longest of another are always alone, and where it does not, two
    links can only be equally short if the other two are equally long, which is a class of its own.
    Only a tolerance may leave two links equally short; then the first one of frame, crank, coupler
    and follower counts.

    Parameters
    ----------
    linkage : FourBar, SliderCrank, QuickReturn, sequence of 4 floats or ndarray (..., 4)
        The linkage, or lengths of frame, crank, coupler and follower in one unit; of many at once
        in an array of two axes or more.
    input : {"crank", "follower"}
        The driven link; of a four-bar linkage it decides between crank rocker and rocker crank.
    tolerance : float
        Relative tolerance of every length, at least 0 and below 1.  The linkage counts as a change
        point where some lengths within the tolerance make it one; of several such classes the
        most degenerate counts: CP3X, then CP2X.

    Returns
    -------
    Classification, SlidingClassification or ndarray of int, shape (...)
        For many four-bar linkages the rows of Barker's table, 1 to 14, and 0 where the four cannot
        close or cannot move; ``SYMBOLS[...]`` names them.

    Raises
    ------
    BadInput
        If a length is not a positive number, the links cannot close or cannot move, or the
        tolerance or the input has no meaning.

    Examples
    --------
    >>> import elastolink as el
    >>> found = el.classify(el.FourBar(frame=12.0, crank=6.0, coupler=12.0, follower=12.0))
    >>> print(found.name, found.symbol)
    Grashof crank-rocker-rocker GCRR
    """
    if isinstance(linkage, np.ndarray) and linkage.ndim > 1:
        if input != "crank" or tolerance != 0.0:
            raise bad("classify", "an array of lengths with an option", "none", "leave it out")
        return _many(linkage)
    if not (isinstance(tolerance, Real) and 0 <= tolerance < 1):
        expected = "a relative tolerance of at least 0 and below 1"
        raise bad("tolerance", repr(tolerance), expected, "0 asks for exact change points")
    require_one_of("input", input, ("crank", "follower"))
    if isinstance(linkage, (SliderCrank, QuickReturn)):
        if input != "crank":
            driven = f"the follower of a {type(linkage).__name__}"
            raise bad("input", driven, "'crank'", "leave it out")
        kind = _slider_crank if isinstance(linkage, SliderCrank) else _quick_return
        return kind(linkage, Fraction(tolerance))
    four_bar = linkage if isinstance(linkage, FourBar) else _four_bar_of(linkage)
    return _four_bar(four_bar, input, Fraction(tolerance))


def _many(lengths: NDArray[Any]) -> NDArray[np.int64]:
    """Return the rows of Barker's table of lengths (..., 4), 0 where they cannot close."""
    # Exact for any doubles: a sum whose sign rounding may have changed is taken in fractions.
    array = finite_array("lengths", lengths, "positive lengths")
    if array.shape[-1] != 4:
        raise bad("lengths", f"shape {array.shape}", "shape (..., 4)", "put the four links last")
    if not np.all(array > 0.0):
        raise bad("lengths", "a value that is none", "positive lengths", "correct it")
    flat = array.reshape(-1, 4)
    frame, crank, coupler, follower = flat.T
    with np.errstate(over="ignore", invalid="ignore"):
        perimeter = np.sum(flat, axis=1)
        sums = (
            (frame - coupler) + (crank - follower),
            (frame - crank) + (coupler - follower),
            (frame - coupler) + (follower - crank),
            perimeter - 2.0 * np.max(flat, axis=1),
        )
        # Beyond the three roundings of a sum of four; where the perimeter overflows nothing is.
        certain = np.min(np.abs(sums), axis=0) > 4.0 * EPS * perimeter
        two, three, four, spare = np.where(certain, np.sign(sums), 0.0).astype(np.int64)
    rows = np.where(spare > 0, _ROWS[9 * (two + 1) + 3 * (three + 1) + four + 1], 0)
    for i in np.flatnonzero(~certain):
        exact = LoopSums.of(map(Fraction, flat[i].tolist()), sum)
        signs = [(value > 0) - (value < 0) for value in exact.pairs]
        rows[i] = number_of_signs(signs) if min(exact.less) > 0 else 0
    return np.asarray(rows.reshape(array.shape[:-1]), dtype=np.int64)


def _four_bar_of(lengths: Iterable[float]) -> FourBar:
    wanted = "4 lengths: frame, crank, coupler, follower"
    try:
        four: list[Any] = [*lengths]
    except (TypeError, KeyError) as refusal:
        found = shown(lengths)
        raise bad("lengths", found, f"a linkage, or {wanted}", "give four lengths") from refusal
    if len(four) != 4:
        raise bad("lengths", f"{len(four)} of them", wanted, "give four lengths")
    return FourBar(*four)


def _four_bar(linkage: FourBar, driven: Input, tolerance: Fraction) -> Classification:
    lengths: dict[str, Any] = {link: float(size) for link, size in linkage.lengths.items()}
    exact = [Fraction(value) for value in lengths.values()]
    sums = LoopSums.of(exact, sum)
    signs, least = _signs(exact, sums.pairs, tolerance)
    shortest, p, q, longest = sorted(exact)
    pairs = turning(signs)
    # Input, coupler and output in this order: the other way round where the follower is driven.
    seen = signs if driven == "crank" else signs[::-1]
    order = LINKS if driven == "crank" else (LINKS[0], *LINKS[:0:-1])
    # The sums of an inversion, the frame going round in this order, are those of the linkage in
    # another one, some with their sign turned.
    s_2, s_3, s_4 = seen
    turned = (seen, (-s_4, -s_3, s_2), (-s_2, s_3, -s_4), (s_4, -s_3, -s_2))
    inverted = [SYMBOLS[number_of_signs(each)] for each in turned]
    row = CLASSES[number_of_signs(seen) - 1]
    if row.symbol == "CP2X":
        row = replace(row, also="parallelogram linkage" if signs[1] else "kite linkage")
    return Classification(
        **lengths,
        input=driven,
        **vars(row),
        turns={link: pairs["frame", link] for link in LINKS[1:]},
        relative_turns={"-".join(pair): turns for pair, turns in sorted(pairs.items())},
        inversions=dict(zip(order, inverted, strict=True)),
        distance=float((shortest + longest - p - q) / sums.total),
        change_distances={
            name: float(value / sums.total)
            for name, value in zip(_CONDITIONS, sums.pairs, strict=True)
        },
        nearest_change=_CONDITIONS[least],
        closing_distances={
            link: float(-less / sums.total) for link, less in zip(LINKS, sums.less, strict=True)
        },
        tolerance=float(tolerance),
        method="signs of three sums of links, in exact arithmetic",
        **_ERROR,
        provenance=provenance({f"links.{k}": repr(v) for k, v in lengths.items()}),
    )


def _signs(
    exact: Sequence[Fraction], sums: Sequence[Fraction], tolerance: Fraction
) -> tuple[list[int], int]:
    """Return the signs of the three sums, zero where the tolerance lets them be, and the least."""
    # The least in magnitude is the one with the shortest and the longest link on one side.
    shortest, longest = exact.index(min(exact)), exact.index(max(exact))
    beside = shortest + longest if 0 in (shortest, longest) else 6 - shortest - longest
    least = beside - 1 if shortest != longest else 0
    signs = [(value > 0) - (value < 0) for value in sums]
    one, two, three, four = sorted(exact)
    if four - one <= tolerance * (four + one):
        return [0, 0, 0], least
    if two - one <= tolerance * (two + one) and four - three <= tolerance * (four + three):
        # Two pairs: only the sum that has a whole pair on one side keeps its sign.
        largest = max(range(3), key=lambda i: abs(sums[i]))
        return [sign if i == largest else 0 for i, sign in enumerate(signs)], least
    if abs(sums[least]) <= tolerance * sum(exact):
        signs[least] = 0
    return signs, least


def _slider_crank(linkage: SliderCrank, tolerance: Fraction) -> SlidingClassification:
    """Classify as a four-bar linkage whose frame and follower are endless, and differ by offset."""
    crank, coupler, offset = (Fraction(float(size)) for size in linkage.lengths.values())
    offset = abs(offset)
    total = crank + coupler + offset
    sums = {
        "crank + offset = coupler": crank + offset - coupler,
        "coupler + offset = crank": coupler + offset - crank,
    }
    least = min(sums.values())
    reached = abs(least) <= tolerance * total
    turns = {
        link: excess <= 0 or (reached and excess <= tolerance * total)
        for link, excess in zip(("crank", "coupler"), sums.values(), strict=True)
    }
    who = " and ".join(link for link, full in turns.items() if full)
    kind = "offset" if offset else "in-line"
    return _sliding(
        linkage,
        sums,
        total,
        tolerance,
        category="change point" if reached else "Grashof" if least < 0 else "non-Grashof",
        name=f"{kind} slider-crank, " + (f"{who} turning" if who else "no link turning"),
        turns={**turns, "slider": False},
        closing_distance=float((offset - crank - coupler) / total),
    )


def _quick_return(linkage: QuickReturn, tolerance: Fraction) -> SlidingClassification:
    """Classify by Beale and Scott's eps = crank/frame: the rod turns where it is above 1."""
    frame, crank = Fraction(float(linkage.frame)), Fraction(float(linkage.crank))
    excess, total = crank - frame, crank + frame
    reached = abs(excess) <= tolerance * total
    turns = reached or excess > 0
    name = "Whitworth quick return, rod turning" if turns else "quick return, rod oscillating"
    return _sliding(
        linkage,
        {"crank = frame": excess},
        total,
        tolerance,
        category="change point" if reached else "Grashof",
        name="quick return at its change point" if reached else name,
        turns={"crank": True, "block": turns, "rod": turns},
        closing_distance=None,
    )


def _sliding(
    linkage: SliderCrank | QuickReturn,
    changes: Mapping[str, Fraction],
    total: Fraction,
    tolerance: Fraction,
    **found: Any,
) -> SlidingClassification:
    """Return the result, given how far each change condition is off, in lengths."""
    distances = {name: float(excess / total) for name, excess in changes.items()}
    nearest = min(changes, key=lambda name: changes[name])
    lengths = {name: float(size) for name, size in linkage.lengths.items()}
    mechanism: Any = linkage.mechanism.replace("_", "-")
    return SlidingClassification(
        mechanism=mechanism,
        lengths=lengths,
        distance=distances[nearest],
        change_distances=distances,
        nearest_change=nearest,
        tolerance=float(tolerance),
        **found,
        method="signs of sums of lengths, in exact arithmetic",
        **_ERROR,
        provenance=provenance({f"links.{name}": repr(size) for name, size in lengths.items()}),
    )
