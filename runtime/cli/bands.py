"""``elastolink tolerance-bands``: what tolerances of a scene's numbers do to an answer."""

from __future__ import annotations

import argparse
from typing import Any

from .. import design
from . import options as opt

_KINDS = ("frequencies", "edges", "boundaries", "stress", "motion", "forces")


def add(commands: Any) -> None:
    """Add the subcommand."""
    parser = opt.command(commands, "tolerance-bands", _bands)
    opt.add(parser, {"--of": "which answer"}, choices=_KINDS, required=True)
    at = "crank angles; of edges, boundaries and stress speeds, of edges their ends alone"
    opt.add(parser, {"--at START:STOP:COUNT[UNIT]": at})
    over = "of boundaries: the second parameter and its values; default five of the chart's y"
    opt.add(parser, {"--over NAME=START:STOP:COUNT[UNIT]": over})
    trials = "machines at random that check the bands; default %(default)s"
    opt.add(parser, {"--trials N": trials}, type=int, default=32)
    opt.add(parser, {"--seed N": "of all that is random; default 0"}, type=int, default=0)
    opt.add(parser, {"--row NAME": "the row that --plot draws; default those of the first unit"})


def _bands(options: argparse.Namespace) -> int:
    r"""Worst case and spread of an answer within tolerances of any of a scene's numbers.

    elastolink tolerance-bands smith_1972_10_8_10_10 --of motion \
        --set 'links.crank=8 in +- 0.05 mm' --plot bands.png
    elastolink tolerance-bands smith_1972_5152_sixteenth_inch --of edges --at 600:900:2rpm \
        --set 'follower.inertia=655e-6 kg*m**2 +- 2 %'
    """
    scene = opt.load(options)
    angles = options.of in ("frequencies", "motion", "forces")
    at = options.at and opt.values(options.at, "angle" if angles else "frequency", "--at")
    if at is not None and options.of in ("edges", "boundaries"):
        at = at[[0, -1]]
    over = None
    if options.over is not None:
        example = "follower_inertia=0.0006:0.002:5"
        name, values = opt.pair(options.over, "--over", "NAME=START:STOP:COUNT", example)
        dimension = scene.layout.parameters.get(name, "dimensionless")
        over = name, opt.values(values, dimension, "--over")
    drawn = {"trials": options.trials, "seed": options.seed}
    found = design.tolerance_bands(scene, options.of, at, over=over, **drawn)
    return opt.finish(options, found, _lines(found), lambda ax: found.plot(ax, options.row))


def _lines(found: Any) -> list[str]:
    """Return of every row its widest band, and what has a share in it."""
    import numpy as np

    at = np.argmax(found.upper - found.lower, axis=1)
    rows, places = np.arange(len(at)), found.place[at]
    places = np.degrees(places) if found.across.endswith("[rad]") else places
    names = {"value": "value", "lower": "worst case from", "upper": "to"}
    names |= {"likely_lower": "95 of 100 from", "likely_upper": "to"}
    return opt.columns(
        ("widest", "", [f"{n} [{u}]" for n, u in zip(found.rows, found.units, strict=True)]),
        *[(found.across.replace("[rad]", "[deg]"), ".6g", places)][: len(found.place) - 1],
        *((words, ".6g", getattr(found, name)[rows, at]) for name, words in names.items()),
        *(
            (f"{name} [%]", ".1f", 100.0 * found.share[rows, at, k])
            for k, name in enumerate(found.numbers)
        ),
    )
