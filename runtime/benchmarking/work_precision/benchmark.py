"""Measures chosen problems and says where a peer is ahead."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

from ...core.errors import ElastolinkWarning, bad
from ...core.results import Check
from ...integrators import METHODS, SECOND_ORDER
from ..records import one_thread
from . import constrained
from .method import Point, Problem, measured
from .peers import PEERS
from .problems import STEADY, TASKS
from .result import WorkPrecision, leads
from .systems import SYSTEMS

_PAIRS = [(system, task) for system in SYSTEMS for task in TASKS]
# A chart of the stiff four-bar is the report stress-curve.
_PAIRS.remove(("four-bar", "chart"))
PROBLEMS = (*(f"{system}-{task}" for system, task in _PAIRS), constrained.NAME)


def benchmark_work_precision(
    problems: Sequence[str] | None = None,
    *,
    methods: Sequence[str] | None = None,
    peers: Sequence[str] | None = None,
    rounds: int = 5,
    progress: bool = False,
) -> WorkPrecision:
    """Measure run time against error beside what a user would pick instead.

    Parameters
    ----------
    problems : sequence of str, optional
        Problems, systems or tasks: ``"hill-monodromy"``, ``"hill"``, ``"monodromy"``; all by
        default.
    methods : sequence of str, optional
        Of ours: integrators and steady-state methods by name, ``"monodromy"``, ``"simulate"``,
        ``"prepared"``; all by default.  A chart is always measured.
    peers : sequence of str, optional
        Some of ``PEERS``; all by default.  Those that are not installed are named and left out.
    rounds : int
        How often each runs, in turn.
    progress : bool
        Whether to show how many methods of each problem are prepared.

    Returns
    -------
    WorkPrecision
        Its check ``behind`` counts the levels of error at which a peer is ahead, but for single
        trajectories below 1e-11; it is left out where ``methods`` are chosen.

    Raises
    ------
    BadInput
        If a name is unknown or ``rounds`` is not positive.
    """
    chosen = selected(problems)
    unknown = sorted(set(peers or ()) - set(PEERS))
    if unknown:
        raise bad("peers", unknown, f"some of {list(PEERS)}", "correct the name")
    known = {"monodromy", "simulate", "prepared"}
    known |= {*METHODS, *SECOND_ORDER, *STEADY, *constrained.METHODS}
    odd = sorted(set(methods or ()) - known)
    if odd:
        raise bad("methods", odd, f"some of {sorted(known)}", "correct the name")
    if rounds < 1:
        raise bad("rounds", rounds, "a whole number from 1", "take 5")
    rivals = tuple(PEERS if peers is None else peers)
    return one_thread(_measure, chosen, methods, rivals, rounds, progress)


def selected(names: Sequence[str] | None) -> tuple[str, ...]:
    """Return the problems that names of problems, systems or tasks stand for, in order.

    Raises
    ------
    BadInput
        If a name is unknown.
    """
    if not names:
        return PROBLEMS
    unknown = sorted(set(names) - {*PROBLEMS, *SYSTEMS, *TASKS, "constrained"})
    if unknown:
        known = ", ".join((*SYSTEMS, "constrained", *TASKS))
        expected = f"some of {known}, or one of each: hill-monodromy"
        raise bad("problems", ", ".join(unknown), expected, "correct the name")
    parts = {p: p.rpartition("-") for p in PROBLEMS}
    return tuple(p for p in PROBLEMS if {p, parts[p][0], parts[p][2]} & set(names))


def _problem(name: str, peers: tuple[str, ...], methods: Sequence[str] | None) -> Problem:
    if name == constrained.NAME:
        return constrained.problem(peers, methods)
    system, _, task = name.rpartition("-")
    return TASKS[task](system, peers, methods)


def _measure(
    names: tuple[str, ...],
    methods: Sequence[str] | None,
    peers: tuple[str, ...],
    rounds: int,
    progress: bool,
) -> WorkPrecision:
    points: list[Point] = []
    titles: dict[str, str] = {}
    absent: list[str] = []
    for name in names:
        problem = _problem(name, peers, methods)
        titles[name] = problem.title
        with warnings.catch_warnings():
            # Long steps are meant; resonant motions leave the linear range for all alike.
            warnings.simplefilter("ignore", ElastolinkWarning)
            own, left_out = measured(problem, rounds, progress=progress)
        points += own
        absent += [f"{name}: {reason}" for reason in left_out]
    found = leads(points, titles)
    behind = [lead for lead in found if lead.lost and not lead.excused]
    return WorkPrecision(
        method="interleaved timing, one thread",
        error=max((p.error for p in points if p.ours), default=0.0),
        error_norm="largest error of any of our settings, relative; see the points",
        # A choice of our methods proves nothing about the best of them.
        checks={} if methods is not None else {"behind": Check(float(len(behind)), 0.0)},
        points=tuple(points),
        titles=titles,
        absent=tuple(absent),
    )
