"""What no single key can show: lengths that close, a crank that turns, bodies, axes, lists."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from ..core.errors import BadInput, Problem
from ..core.units import describe, to_si
from .linkage_tables import LINKS
from .schema import Layout

Values = Mapping[str, dict[str, Any]]
# Data are rounded: an inertia may fall short of the least possible one by so much.
_ROUNDED = 1e-3
# Parameters of a chart that may be zero; speed, mass and stiffness may not.
_VANISH = ("follower_inertia", "damping", "coupler_inertia", "coupler_first_moment")


def geometry_problems(values: Values, layout: Layout) -> list[Problem]:
    """Check that four lengths close, and that the crank turns fully where a link bends.

    The diagonal between the crank pin and the second fixed pivot runs from ``|l1 - l2|`` to
    ``l1 + l2`` as the crank turns, and coupler and follower reach from ``|l3 - l4|`` to
    ``l3 + l4``; equality is a change point, where the motion is not determined.  A table with
    problems of its own may lack keys.
    """
    links = values.get("links", {})
    if layout.mechanism == "slider_crank":
        return _slider_problems(links)
    if layout.mechanism == "quick_return":
        return _rod_problems(links)
    if layout.mechanism != "four_bar" or any(name not in links for name in LINKS):
        return []
    lengths = {name: float(links[name]) for name in LINKS}
    longest = max(lengths, key=lambda name: lengths[name])
    rest = sum(length for name, length in lengths.items() if name != longest)
    if lengths[longest] >= rest:
        found, limit = describe(lengths[longest], "length"), describe(rest, "length")
        expected = f"less than {limit}, the sum of the other three"
        fix = f"the lengths cannot close: shorten the {longest} or lengthen another link"
        return [Problem(f"links.{longest}", found, expected, fix)]
    return _turning_problems(*(lengths[name] for name in LINKS)) if layout.flexible else []


def _slider_problems(links: Mapping[str, Any]) -> list[Problem]:
    """Check that coupler and crank together reach the line of the slider."""
    crank, coupler, offset = (links.get(n, math.nan) for n in ("crank", "coupler", "offset"))
    if not abs(offset) >= crank + coupler:
        return []
    limit = describe(crank + coupler, "length")
    fix = "the slider's line is out of reach: lower the offset or lengthen a link"
    found = describe(offset, "length")
    return [Problem("links.offset", found, f"less than {limit}, crank and coupler", fix)]


def _rod_problems(links: Mapping[str, Any]) -> list[Problem]:
    """Check that the rod reaches the crank pin wherever it is, and never passes its own pivot."""
    frame, rod = (links.get(name, math.nan) for name in ("frame", "rod"))
    crank = links.get("crank", links.get("crank_ratio", math.nan) * frame)
    if frame == crank:
        fix = "the crank pin would pass the rod's pivot: change one of the two"
        return [Problem("links.crank", describe(crank, "length"), "another length than frame", fix)]
    if rod < frame + crank:
        limit = describe(frame + crank, "length")
        fix = "the block would leave the rod: lengthen it"
        found = describe(rod, "length")
        return [Problem("links.rod", found, f"at least {limit}, frame and crank", fix)]
    return []


def _turning_problems(frame: float, crank: float, coupler: float, follower: float) -> list[Problem]:
    near, far = abs(frame - crank), frame + crank
    shortest, longest = abs(coupler - follower), coupler + follower
    if near > shortest and far < longest:
        return []
    limit = min(longest - frame, frame - shortest)
    fix = "the crank cannot turn fully: change the lengths"
    if limit > 0:
        fix = f"the crank cannot turn fully: make it shorter than {describe(limit, 'length')}"
    return [
        Problem(
            "links",
            f"a diagonal from {describe(near, 'length')} to {describe(far, 'length')}",
            f"between {describe(shortest, 'length')} and {describe(longest, 'length')}, exclusive",
            fix,
        )
    ]


def body_problems(values: Values, layout: Layout) -> list[Problem]:
    """Check that mass, first moment and inertia of each link can belong to one body.

    About the same joint the inertia is at least the square of the first moment over the mass,
    what the whole mass at its centre would have.
    """
    problems: list[Problem] = []
    for link in layout.links:
        body = values.get(link, {})
        if not {"mass", "first_moment", "inertia"} <= set(body):
            continue
        mass, moment, inertia = (body[key] for key in ("mass", "first_moment", "inertia"))
        least = (moment * moment + body.get("transverse_moment", 0.0) ** 2) / mass
        if inertia < least * (1.0 - _ROUNDED):
            found = f"{describe(inertia, 'inertia')}, with mass {describe(mass, 'mass')}"
            found += f" and first moment {moment:.6g} kg m"
            expected = f"at least {describe(least, 'inertia')}, first_moment^2 / mass"
            fix = "no body has these three: correct first_moment (by default a uniform bar's)"
            problems.append(Problem(f"{link}.inertia", found, expected, fix))
    return problems


def chart_problems(values: Values, layout: Layout) -> list[Problem]:
    """Convert the ranges of a chart by the dimension of its axes; check what belongs together.

    The ranges are replaced in place, since only the axis says their dimension.
    """
    chart = values.get("chart", {})
    problems: list[Problem] = []
    for axis in ("x", "y"):
        given = chart.get(f"{axis}_range")
        if given is None:
            continue
        name = chart.get(axis)
        if name is None:
            fix = f"say which of {sorted(layout.parameters)} the range is for"
            problems.append(Problem(f"chart.{axis}", "nothing", "a parameter's name", fix))
            continue
        problems += _read_range(chart, axis, name, layout.parameters[name])
    if "x" in chart and chart.get("x") == chart.get("y"):
        problems.append(
            Problem("chart.y", repr(chart["y"]), "another parameter than chart.x", "change one")
        )
    return problems


def _read_range(chart: dict[str, Any], axis: str, name: str, dimension: str) -> list[Problem]:
    where = f"chart.{axis}_range"
    numbers: list[float] = []
    problems: list[Problem] = []
    for i, item in enumerate(chart[f"{axis}_range"]):
        try:
            numbers.append(to_si(item, dimension, f"{where}[{i}]"))
        except BadInput as error:
            problems.extend(error.problems)
    if not problems:
        lowest = numbers[0]
        if dimension != "dimensionless" and not (lowest > 0 or (lowest == 0 and name in _VANISH)):
            start = "from 0 up" if name in _VANISH else "above 0"
            problems.append(Problem(where, f"{lowest:g}", f"values {start}", "raise the lower end"))
        elif numbers[1] <= numbers[0]:
            problems.append(Problem(where, f"{numbers}", "values that increase", "swap them"))
    chart[f"{axis}_range"] = tuple(numbers)
    return problems


def measured_problems(values: Values, layout: Layout) -> list[Problem]:
    """Check that lists which belong together are equally long."""
    measured = values.get("measured", {})
    problems = []
    for first, *others in (
        ("follower_inertias", "follower_inertia_tolerances"),
        ("speeds", "regions", "inertias"),
    ):
        for other in others:
            a, b = measured.get(first, ()), measured.get(other, ())
            if other in measured and len(a) != len(b):
                found, expected = f"{len(b)} values", f"{len(a)}, as many as measured.{first}"
                problems.append(
                    Problem(f"measured.{other}", found, expected, "complete the shorter list")
                )
    return problems


def series_problems(values: Values, layout: Layout) -> list[Problem]:
    """Check the unused ``b[0]`` of a Fourier series."""
    if layout.mechanism != "hill":
        return []
    first = values.get("function", {}).get("b", (0.0,))[0]
    if first != 0.0:
        fix = "put the coefficient of sin theta second"
        return [Problem("function.b[0]", f"{first:g}", "0, for sin 0 is zero", fix)]
    return []
