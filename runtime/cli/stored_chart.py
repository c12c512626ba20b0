"""Charts at scale: by several processes, in pieces that are kept and resumed, estimated."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from ..core.errors import bad
from . import options as opt

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from ..core.families import LinearPeriodic
    from ..sweeps import Sweep
    from ..sweeps.result import AnyArray

Axis = tuple[str, list[float]]


def add_options(chart: argparse.ArgumentParser) -> None:
    """Add what concerns large charts to the subcommand."""
    chart.add_argument(
        "--workers", metavar="N", help="work in N processes; the answer does not depend on it"
    )
    chart.add_argument(
        "--store",
        metavar="PATH",
        help="keep the chart, without boundaries, in this folder or .npz file, piece by piece; the "
        "same command goes on from there after it was stopped",
    )
    chart.add_argument(
        "--estimate",
        action="store_true",
        help="with --store: tell time and memory, and work nothing out",
    )


@contextmanager
def workers(options: argparse.Namespace) -> Iterator[Executor | None]:
    """Open the processes that were asked for; None for none."""
    count = _count(options)
    if count == 1:
        yield None
        return
    from ..sweeps import process_pool

    with process_pool(count) as pool:
        yield pool


def _count(options: argparse.Namespace) -> int:
    if options.workers is None:
        return 1
    from ..core.workers import check_workers

    text = options.workers.strip()
    return check_workers(int(text) if text.isdecimal() else text, "--workers")


def check(options: argparse.Namespace) -> None:
    """Refuse options that do not go together."""
    _count(options)
    if options.store is None:
        opt.refuse_unused(options, ("estimate",), "--store PATH")
        return
    opt.refuse_unused(options, ("edges",), "a chart without --store")
    if options.order != 1:
        fix = "leave one of them out"
        raise bad("--order", options.order, "none beside --store, which has no boundaries", fix)


def run(
    options: argparse.Namespace, system: LinearPeriodic, x: Axis, y: Axis, speed: float | None
) -> int:
    """Work out a chart piece by piece, or estimate what that takes."""
    from ..sweeps import estimate_sweep, sweep

    values = {y[0]: y[1], x[0]: x[1]}
    told = {} if speed is None else {"speed": speed}
    if options.estimate:
        found = estimate_sweep(
            "stability_chart", system, values, options=told, workers=_count(options)
        )
        if options.json:
            opt.print_json(vars(found))
        else:
            print(found)
        return 0
    with workers(options) as pool:
        chart = sweep(
            "stability_chart",
            system,
            values,
            options=told,
            executor=pool,
            store=options.store,
            progress=opt.progress(options),
        )
    return opt.finish(options, chart, _lines(chart, x, y))


def shares(names: tuple[str, str], stable: AnyArray, kind: AnyArray) -> list[str]:
    """Return what share of a chart ``(ny, nx)`` is unstable, and how much of it by combination."""
    ny, nx = stable.shape
    unstable, mixed = 100.0 * float((~stable).mean()), 100.0 * float((kind == 2).mean())
    lines = [f"{names[0]} x {names[1]}: {nx} x {ny} points, {unstable:.3g} % unstable"]
    if mixed > 0:
        lines.append(f"{mixed:.3g} % by combination (complex multipliers)")
    return lines


def _lines(chart: Sweep, x: Axis, y: Axis) -> list[str]:
    lines = shares((x[0], y[0]), chart["stable"], chart["kind"])
    left = 100.0 * float(chart["undecided"].mean())
    lines.append(f"{left:.3g} % undecided")
    lines.append(
        f"{chart.pieces} pieces, {chart.resumed} of them found there, in {chart.store}: "
        + ", ".join(sorted(chart.outputs))
    )
    return lines
