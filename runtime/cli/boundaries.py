"""``elastolink boundaries`` and ``elastolink perturb``: edges of unstable regions, two ways."""

from __future__ import annotations

import argparse
import re
from functools import partial
from itertools import chain
from math import sqrt
from typing import TYPE_CHECKING, Any

from .. import hill, stability
from ..core.errors import BadInput, bad
from . import options as opt
from .linkages import around, moving_scene, speed_of, speed_range

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..core.families import Array, LinearPeriodic
    from ..core.periodic_function import PeriodicFunction
    from ..scenes import Scene

_REGIONS = "1:4"
_HIGHEST = 8
_SPAN = re.compile(r"(\d{1,4}):(\d{1,4})")


def add(commands: Any) -> None:
    """Add the two subcommands."""
    name, numbers = "--regions N,...", f"numbers of the regions, 1,3,5 or 1:6; default {_REGIONS}"
    one = "of one undamped mode, without --speed"
    edges = opt.command(commands, "boundaries", _boundaries)
    opt.add(
        edges,
        {
            name: f"{one}: {numbers}",
            "--mu VALUES": "of a Hill equation: a number or START:STOP:COUNT (--mu=-1:1:5 where it"
            " begins with a minus); default parameters.mu",
            "--speed LOW:HIGH": "crank speeds of a linkage whose modes are several or damped, such"
            " as 300rpm:900rpm; default operation.speed_range, or chosen by the scene",
        },
    )
    beside = f"{one}: beside the exact ones those by perturbation, order 1 to {_HIGHEST}"
    opt.add(edges, {"--order N": beside}, type=_order)
    opt.switches(edges, {"--certified": f"{one}: proved enclosures by exact arithmetic"})
    series = opt.command(commands, "perturb", _perturb)
    opt.add(series, {name: numbers})
    opt.add(series, {"--order N": f"1 to {_HIGHEST}; default %(default)s"}, type=_order, default=2)
    formulas = (
        "print the formulas instead, as sums, to order 6 at most: for any n, or for the --regions "
        "given"
    )
    opt.switches(series, {"--latex": formulas})


def _order(text: str) -> int:
    if not text.isdecimal() or not 1 <= int(text) <= _HIGHEST:
        raise argparse.ArgumentTypeError(f"found {text!r}; expected 1 to {_HIGHEST}")
    return int(text)


def _regions(given: str | None) -> tuple[int, ...]:
    """Return the numbers of ``1,3,5`` or ``1:6``, each once."""
    text = _REGIONS if given is None else given
    span = _SPAN.fullmatch(text.strip())
    if span:
        first, last = int(span.group(1)), int(span.group(2))
        numbers = tuple(range(first, last + 1))
    else:
        parts = [part.strip() for part in text.split(",")]
        # More digits than that are no region, and Python may refuse to read them.
        known = all(part.isdecimal() and len(part) < 10 for part in parts)
        numbers = tuple(dict.fromkeys(int(part) for part in parts)) if known else ()
    if not numbers:
        raise bad("--regions", repr(text), "whole numbers such as 1,3,5 or 1:6", "correct it")
    return numbers


def _boundaries(options: argparse.Namespace) -> int:
    """Boundaries of unstable regions: exact, certified, and by perturbation.

    elastolink boundaries mathieu --mu 0:2:41 --order 4 --plot mathieu.png
    elastolink boundaries smith_1972_101104_sixteenth_inch --regions 2:6
    elastolink boundaries smith_1972_5152_sixteenth_inch --set model.modes=2
    """
    from ..hill.form import is_hill

    regions = _regions(options.regions)
    scene = moving_scene(options)
    if scene.model["mechanism"] == "hill":
        opt.refuse_unused(options, ("speed",), "a scene of a linkage")
        return _of_hill(options, scene, hill.hill_form(scene.linear_system()), regions)
    opt.refuse_unused(options, ("mu",), "a scene of Hill's equation")
    system = scene.linear_system()
    if is_hill(system):
        form = hill.hill_form(system)
        if not form.elastic and form.damping() == 0.0 and options.speed is None:
            return _of_mode(options, form, regions)
    unused = ("regions", "order", "certified")
    opt.refuse_unused(options, unused, "one undamped mode, and no range of speeds")
    return _of_modes(options, scene, system)


def _of_hill(
    options: argparse.Namespace, scene: Scene, form: hill.HillForm, regions: tuple[int, ...]
) -> int:
    """Boundaries in lam2 at the values of mu: a row for each of their ends."""
    mu = _values(options.mu) if options.mu is not None else [float(scene["parameters"]["mu"])]
    found = _solved(options, form.function(1.0, mu=1.0), mu, regions, 0.5 * form.damping())
    rows = [
        (str(n), f"{mu[j]:g}", *(_number(e[i, j]) for one in found for e in (one.lower, one.upper)))
        for i, n in enumerate(regions)
        for j in sorted({0, len(mu) - 1})
    ]
    lines = _table(options, ("region", "mu", "lam2 from", "to"), rows, found)
    if len(mu) > 2:
        lines.append(f"(the ends of {len(mu)} values of mu; --json gives all)")

    def draw(ax: Any) -> None:
        found[0].plot(ax)
        for one in found[1:]:
            for end in chain(*zip(one.lower, one.upper, strict=True)):
                ax.plot(end, one.mu, "k--", lw=0.9)

    return opt.finish(options, found[0], lines, draw, more=_perturbation(found))


def _of_mode(options: argparse.Namespace, form: hill.HillForm, regions: tuple[int, ...]) -> int:
    """Boundaries in crank speed of the only mode, without damping."""
    frequency = sqrt(form.stiffness())
    found = _solved(options, form.function(1.0), [1.0], regions, 0.0)
    # A region without a lower end in lam2 has no upper end in speed.
    rows = [
        (str(n), *(_speed(frequency, e[i, 0]) for one in found for e in (one.upper, one.lower)))
        for i, n in enumerate(regions)
    ]
    lines = [f"natural frequency {_speed(frequency, 1.0)}; crank speeds:", ""]
    lines += _table(options, ("region", "from", "to"), rows, found)
    more = {"natural_frequency": frequency, **_perturbation(found)}
    draw = partial(_bars, exact=found[0], frequency=frequency)
    return opt.finish(options, found[0], lines, draw, more=more)


def _range(
    options: argparse.Namespace, scene: Scene
) -> tuple[tuple[float, float], tuple[str, ...]]:
    """Return a range of crank speeds, and the line that says how it was chosen."""
    from ..core.units import describe

    if options.speed is None and scene.get("operation.speed_range", None) is None:
        if scene.get("chart.x", None) == "speed" and scene.get("chart.x_range", None):
            low, high = scene["chart"]["x_range"]
            middle = 0.5 * (low + high)
            ends = " to ".join(describe(end, "frequency") for end in (middle, high))
            return (middle, high), (f"speed {ends}, chosen: the upper half of chart.x_range", "")
        if speed := scene.get("operation.speed", None):
            low, high, told = around("speed", speed, "frequency")
            return (low, high), (told, "")
    return speed_range(options.speed, scene, "--speed"), ()


def _of_modes(options: argparse.Namespace, scene: Scene, system: LinearPeriodic) -> int:
    span, said = _range(options, scene)
    edges = stability.stability_edges(system, span)
    rows = [
        (f"{label} ?" if doubtful else label, _rpm(first), _rpm(last), _rpm(last - first, 3))
        for label, doubtful, first, last, error in zip(
            edges.labels, edges.doubtful, edges.lower, edges.upper, edges.error, strict=True
        )
        if not last - first <= 2.0 * error
    ]
    closed = len(edges.labels) - len(rows)
    low, high, least = (_rpm(end, 6) for end in (*span, float(f"{edges.least_width:.1g}")))
    none = f"none between {low} and {high}; regions narrower than {least} are left out"
    lines = [*said, *(opt.table(("region", "from", "to", "width"), rows) if rows else [none])]
    if any(row[0].endswith("?") for row in rows):
        lines.append("?: so far from the resonances of the mean motion that the name is a guess")
    if closed:
        those = "1 region that is" if closed == 1 else f"{closed} regions that are"
        lines.append(f"and {those} closed, or narrower than the error")
    return opt.finish(options, edges, lines)


def _solved(
    options: argparse.Namespace,
    f: PeriodicFunction,
    mu: Sequence[float] | Array,
    regions: tuple[int, ...],
    damping: float,
) -> list[Any]:
    """Return the exact boundaries, then those by perturbation where they are wanted."""
    exact = hill.hill_boundaries(f, mu, regions, damping=damping, certified=options.certified)
    if options.order is None:
        return [exact]
    return [exact, hill.perturbation_boundaries(f, mu, regions, options.order, damping)]


def _table(
    options: argparse.Namespace,
    header: Sequence[str],
    rows: Sequence[Sequence[str]],
    found: Sequence[Any],
) -> list[str]:
    """Return a table of ends, and why there is no number where the perturbation gives none."""
    more = (f"order {options.order} from", "to") * len(found[1:])
    lines = opt.table((*header, *more), rows)
    if any(one.outside.any() for one in found[1:]):
        reason = "outside the range in which its orders converge"
        lines.append(f"no number of the perturbation: {reason}")
    return lines


def _perturbation(found: Sequence[Any]) -> dict[str, Any]:
    return {"perturbation": [one.to_dict() for one in found[1:]]}


def _bars(ax: Any, exact: hill.Boundaries, frequency: float) -> None:
    """Draw the unstable bands of crank speed, a row per region."""
    for i, n in enumerate(exact.regions):
        low, high = (float(end[i, 0]) for end in (exact.lower, exact.upper))
        if high > 0.0:
            right = frequency / sqrt(low) if low > 0.0 else 2.0 * frequency / sqrt(high)
            left = frequency / sqrt(high)
            ax.barh(str(n), (right - left) * opt.RPM, left=left * opt.RPM, height=0.6)
    ax.set(xlabel="crank speed [rpm]", ylabel="region")


def _perturb(options: argparse.Namespace) -> int:
    """Coefficients of the boundaries as power series, and their formulas.

    elastolink perturb mathieu --order 8
    elastolink perturb hill_example --order 3 --latex
    """
    regions = _regions(options.regions)
    if options.latex:
        return _formulas(options)
    f, ratio, remarks = _function(options, opt.load(options))
    found, rows = [], []
    for n in regions:
        try:
            one = hill.boundary_series(f, n, options.order, ratio)
        except BadInput as error:
            # Damping closes this region, and perhaps no other.
            closed = all(problem.where == "damping_ratio" for problem in error.problems)
            remarks.append(f"region {n}: closed by the scene's damping" if closed else str(error))
            continue
        found.append(one)
        rows += _series_rows(one)
    if not found:
        raise bad("--regions", options.regions or _REGIONS, "a region that is open", remarks[-1])
    powers = [f"mu^{k}" if k > 1 else "mu" for k in range(1, options.order + 1)]
    lines = [*opt.table(("region", "boundary", "1", *powers), rows), *remarks]
    worst = max(found, key=lambda one: float(one.error.max()))

    def draw(ax: Any) -> None:
        found[0].plot(ax)
        ax.set_title(f"region {found[0].region}")

    if options.plot and len(found) > 1:
        lines.append(f"the picture shows region {found[0].region}; choose one by --regions")
    more = {"series": [one.to_dict() for one in found]}
    return opt.finish(options, worst, lines, draw, more=more)


def _function(
    options: argparse.Namespace, scene: Scene
) -> tuple[PeriodicFunction, float, list[str]]:
    """Return what mu multiplies in a scene, beta of K = beta mu, and what is to be said of them."""
    form = hill.hill_form(scene.linear_system())
    if scene.model["mechanism"] == "hill":
        damping, mu = 0.5 * form.damping(), abs(float(scene["parameters"]["mu"]))
        if damping and not mu:
            raise bad("parameters.mu", "0, with damping", "another mu, for K = beta mu", "set it")
        ratio = damping / mu if damping else 0.0
        said = [f"with damping K = {ratio:g} mu"] if ratio else []
        return form.function(1.0, mu=1.0), ratio, said
    said = ["mu multiplies all that changes with the crank angle; it is 1 in this scene"]
    ratio = 0.0
    if form.damping():
        ratio = 0.5 * form.damping() / speed_of(options, scene)
        said.insert(0, f"with damping K = {ratio:g} mu at the scene's speed")
    return form.function(1.0), ratio, said


def _series_rows(one: hill.BoundarySeries) -> list[tuple[str, ...]]:
    import numpy as np

    rows = []
    ends = (("lower", one.lower, one.error[0]), ("upper", one.upper, one.error[1]))
    for name, alpha, error in ends if one.region else ends[1:]:
        known = np.where(np.abs(alpha) > error + one.function.error, alpha, 0.0)
        start = f"{0.25 * one.region**2:g}"
        rows.append((str(one.region), name, start, *(f"{item:+.9g}" for item in known)))
    return rows


def _formulas(options: argparse.Namespace) -> int:
    """Print the formulas of the boundaries, of any region or of those that are given."""
    opt.refuse_unused(options, ("plot", "save"), "without --latex")
    from ..hill.series import boundary_latex

    damped = hill.hill_form(opt.load(options).linear_system()).damping() > 0.0
    regions = (None,) if options.regions is None else _regions(options.regions)
    texts = [boundary_latex(options.order, n, damped) for n in regions]
    content = {"order": options.order, "regions": regions, "latex": texts}
    return opt.say(options, content, "\n\n".join(texts))


def _values(text: str) -> Array | list[float]:
    if ":" in text:
        return opt.values(text, "dimensionless", "--mu")
    return [opt.quantity(text, "dimensionless", "--mu")]


def _number(value: float) -> str:
    return f"{value:.12g}" if value == value else "-"


def _speed(frequency: float, lam2: float) -> str:
    """Return the crank speed at which lam2 = (Omega/speed)^2, in rpm."""
    return _rpm(frequency / sqrt(lam2)) if lam2 > 0.0 else "-"


def _rpm(speed: float, digits: int = 8) -> str:
    return f"{speed * opt.RPM:.{digits}g} rpm" if speed == speed else "-"
