"""What no single key can show: lengths that close, a crank that turns, bodies, axes, lists."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from ..core.errors import BadInput, Problem, bad, refuse
from ..core.units import describe, to_si
from .linkage_tables import LINKS
from .schema import Layout

Values = Mapping[str, dict[str, Any]]
# Data are rounded: an inertia may fall short of the least possible one by so much.
_ROUNDED = 1e-3
# Parameters of a chart that may be zero; speed, mass and stiffness may not.
_VANISH = ("follower_inertia", "damping", "coupler_inertia", "coupler_first_moment")


@contextmanager
def collecting(problems: list[Problem]) -> Iterator[None]:
    """Take in what is refused inside, so that every problem can be told at once."""
    try:
        yield
    except BadInput as error:
        problems.extend(error.problems)


def check_geometry(values: Values, layout: Layout) -> None:
    """Check that four lengths close, and that the crank turns fully where a link bends.

    The diagonal between the crank pin and the second fixed pivot runs from ``|l1 - l2|`` to
    ``l1 + l2`` as the crank turns, and coupler and follower reach from ``|l3 - l4|`` to
    ``l3 + l4``; equality is a change point, where the motion is not determined.  A table with
    problems of its own may lack keys.
    """
    links = values.get("links", {})
    if layout.mechanism == "slider_crank":
        _check_slider(links)
    elif layout.mechanism == "quick_return":
        _check_rod(links)
    elif layout.mechanism == "four_bar" and all(name in links for name in LINKS):
        lengths = {name: float(links[name]) for name in LINKS}
        longest = max(lengths, key=lambda name: lengths[name])
        rest = sum(length for name, length in lengths.items() if name != longest)
        if lengths[longest] >= rest:
            expected = f"less than {describe(rest, 'length')}, the sum of the other three"
            fix = f"the lengths cannot close: shorten the {longest} or lengthen another link"
            raise bad(f"links.{longest}", describe(lengths[longest], "length"), expected, fix)
        if layout.flexible:
            _check_turning(**lengths)


def _check_slider(links: Mapping[str, Any]) -> None:
    """Check that coupler and crank together reach the line of the slider."""
    crank, coupler, offset = (links.get(n, math.nan) for n in ("crank", "coupler", "offset"))
    if abs(offset) >= crank + coupler:
        expected = f"less than {describe(crank + coupler, 'length')}, crank and coupler"
        fix = "the slider's line is out of reach: lower the offset or lengthen a link"
        raise bad("links.offset", describe(offset, "length"), expected, fix)


def _check_rod(links: Mapping[str, Any]) -> None:
    """Check that the rod reaches the crank pin wherever it is, and never passes its own pivot."""
    frame, rod = (links.get(name, math.nan) for name in ("frame", "rod"))
    crank = links.get("crank", links.get("crank_ratio", math.nan) * frame)
    if frame == crank:
        fix = "the crank pin would pass the rod's pivot: change one of the two"
        raise bad("links.crank", describe(crank, "length"), "another length than frame", fix)
    if rod < frame + crank:
        expected = f"at least {describe(frame + crank, 'length')}, frame and crank"
        fix = "the block would leave the rod: lengthen it"
        raise bad("links.rod", describe(rod, "length"), expected, fix)


def _check_turning(frame: float, crank: float, coupler: float, follower: float) -> None:
    near, far = abs(frame - crank), frame + crank
    shortest, longest = abs(coupler - follower), coupler + follower
    if near > shortest and far < longest:
        return
    limit = min(longest - frame, frame - shortest)
    fix = "the crank cannot turn fully: change the lengths"
    if limit > 0:
        fix = f"the crank cannot turn fully: make it shorter than {describe(limit, 'length')}"
    found = f"a diagonal from {describe(near, 'length')} to {describe(far, 'length')}"
    ends = f"{describe(shortest, 'length')} and {describe(longest, 'length')}"
    raise bad("links", found, f"between {ends}, exclusive", fix)


def check_body(link: str, body: Mapping[str, Any]) -> None:
    """Check that mass, first moment and inertia of a link can belong to one body.

    About the same joint the inertia is at least the square of the first moment over the mass,
    what the whole mass at its centre would have.
    """
    if not {"mass", "first_moment", "inertia"} <= set(body):
        return
    mass, moment, inertia = (body[key] for key in ("mass", "first_moment", "inertia"))
    least = (moment * moment + body.get("transverse_moment", 0.0) ** 2) / mass
    if inertia < least * (1.0 - _ROUNDED):
        found = f"{describe(inertia, 'inertia')}, with mass {describe(mass, 'mass')}"
        found += f" and first moment {moment:.6g} kg m"
        expected = f"at least {describe(least, 'inertia')}, first_moment^2 / mass"
        fix = "no body has these three: correct first_moment (by default a uniform bar's)"
        raise bad(f"{link}.inertia", found, expected, fix)


def check_chart(values: Values, layout: Layout) -> None:
    """Convert the ranges of a chart by the dimension of its axes; check what belongs together.

    The ranges are replaced in place, since only the axis says their dimension.
    """
    chart = values.get("chart", {})
    problems: list[Problem] = []
    for axis in ("x", "y"):
        if f"{axis}_range" in chart:
            with collecting(problems):
                _read_range(chart, axis, layout)
    if "x" in chart and chart.get("x") == chart.get("y"):
        found, expected = repr(chart["y"]), "another parameter than chart.x"
        problems.append(Problem("chart.y", found, expected, "change one"))
    refuse(problems)


def _read_range(chart: dict[str, Any], axis: str, layout: Layout) -> None:
    where, name = f"chart.{axis}_range", chart.get(axis)
    if name is None:
        fix = f"say which of {sorted(layout.parameters)} the range is for"
        raise bad(f"chart.{axis}", "nothing", "a parameter's name", fix)
    dimension = layout.parameters[name]
    numbers: list[float] = []
    problems: list[Problem] = []
    for i, item in enumerate(chart[f"{axis}_range"]):
        with collecting(problems):
            numbers.append(to_si(item, dimension, f"{where}[{i}]"))
    refuse(problems)
    lowest = numbers[0]
    if dimension != "dimensionless" and not (lowest > 0 or (lowest == 0 and name in _VANISH)):
        start = "from 0 up" if name in _VANISH else "above 0"
        raise bad(where, f"{lowest:g}", f"values {start}", "raise the lower end")
    if numbers[1] <= numbers[0]:
        raise bad(where, f"{numbers}", "values that increase", "swap them")
    chart[f"{axis}_range"] = tuple(numbers)


def check_measured(values: Values, layout: Layout) -> None:
    """Check that lists which belong together are equally long."""
    measured = values.get("measured", {})
    problems = []
    for first, other in (
        ("follower_inertias", "follower_inertia_tolerances"),
        ("speeds", "regions"),
        ("speeds", "inertias"),
    ):
        a, b = measured.get(first, ()), measured.get(other, ())
        if other in measured and len(a) != len(b):
            found, expected = f"{len(b)} values", f"{len(a)}, as many as measured.{first}"
            fix = "complete the shorter list"
            problems.append(Problem(f"measured.{other}", found, expected, fix))
    refuse(problems)


def check_series(values: Values, layout: Layout) -> None:
    """Check the unused ``b[0]`` of a Fourier series."""
    first = values.get("function", {}).get("b", (0.0,))[0]
    if layout.mechanism == "hill" and first != 0.0:
        fix = "put the coefficient of sin theta second"
        raise bad("function.b[0]", f"{first:g}", "0, for sin 0 is zero", fix)
