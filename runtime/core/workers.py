"""Independent pieces of work, done here or by an executor, the same by any and in any order."""

from __future__ import annotations

import os
import pickle
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    Executor,
    Future,
    ThreadPoolExecutor,
    wait,
)
from contextlib import contextmanager
from itertools import islice
from typing import Any

from .errors import ElastolinkError, bad
from .inputs import require_whole
from .threads import THREADS, environment


class WorkersLost(ElastolinkError):  # noqa: N818 - reads as what it is
    """The workers of an executor ended before their work did."""


def run_on(
    executor: Executor | None, work: Callable[[Any], Any], items: Iterable[Any]
) -> Iterator[tuple[int, Any]]:
    """Yield the number of an item and ``work(item)``, as they are done.

    The executor is of threads, of processes, or what :meth:`distributed.Client.get_executor`
    returns; None does everything here.  The work is sent once and kept by each worker: for
    anything but threads it must bear pickling, or is refused.  Workers that end, for example for
    want of memory, raise `WorkersLost`; an executor that was shut down, BadInput.
    """
    check_executor(executor)
    queue = enumerate(items)
    if executor is None:
        for number, item in queue:
            yield number, work(item)
        return
    here = isinstance(executor, ThreadPoolExecutor)
    given = (work,) if here else (_call, _pickled(work))
    # Dask's executor does not tell how many workers it has.
    count = getattr(executor, "_max_workers", None) or os.cpu_count() or 1
    submit: Any = executor.submit
    waiting: dict[Future[Any], int] = {}
    try:
        while True:
            # Two pieces for each worker: one being done and one waiting.
            for number, item in islice(queue, 2 * int(count) - len(waiting)):
                with _refusals(of=RuntimeError):
                    waiting[submit(*given, item)] = number
            if not waiting:
                return
            done, _ = wait(waiting, return_when=FIRST_COMPLETED)
            for future in sorted(done, key=waiting.__getitem__):
                number = waiting.pop(future)
                with _refusals():
                    found = future.result()
                yield number, found
    finally:
        for future in waiting:
            future.cancel()


def in_order(executor: Executor) -> Callable[..., Iterable[Any]]:
    """Return what maps a function over items by an executor, as ``map`` does.

    Unlike ``executor.map`` it sends the function once, and each worker keeps it.
    """

    def run(work: Callable[[Any], Any], items: Iterable[Any]) -> list[Any]:
        found = dict(run_on(executor, work, items))
        return [found[number] for number in range(len(found))]

    return run


def check_executor(executor: object) -> None:
    """Refuse what is neither None nor an executor."""
    if executor is not None and not isinstance(executor, Executor):
        found, expected = type(executor).__name__, "a concurrent.futures.Executor"
        fix = "give a pool of threads or processes, or Dask's client.get_executor()"
        raise bad("executor", found, expected, fix)


@contextmanager
def process_pool(workers: int) -> Iterator[Executor]:
    """Open a pool of processes for sweeps, each with its numerical libraries on one thread.

    Parameters
    ----------
    workers : int
        How many, 1 to 1024.

    Raises
    ------
    BadInput
        If that is no such number.

    Notes
    -----
    The processes are started afresh, not copied: a script that opens a pool keeps its own work
    under ``if __name__ == "__main__":``, as with any such pool.
    """
    import multiprocessing
    from concurrent.futures import ProcessPoolExecutor

    count = check_workers(workers)
    context = multiprocessing.get_context("spawn")
    # The libraries read it as they load, in the processes that start here.
    with (
        environment(dict.fromkeys(THREADS, "1")),
        ProcessPoolExecutor(max_workers=count, mp_context=context) as pool,
    ):
        yield pool


def check_workers(workers: object, where: str = "workers") -> int:
    """Return a number of workers from 1 to 1024; refuse anything else."""
    return require_whole(where, workers, 1, 1024, "give the number of cores")


_kept = threading.local()


def _call(sent: bytes, item: Any) -> Any:
    """Do the work on one item in a worker, which keeps the work for the next one."""
    if getattr(_kept, "sent", None) != sent:
        _kept.work, _kept.sent = pickle.loads(sent), sent
    return _kept.work(item)


def _pickled(work: Callable[[Any], Any]) -> bytes:
    try:
        return pickle.dumps(work)
    except (pickle.PicklingError, AttributeError, TypeError) as reason:
        found = f"a subject or function that cannot be sent to another process ({reason})"
        expected = "functions of a module, and systems and scenes made of such"
        fix = "define them at the top of a file, or use a ThreadPoolExecutor"
        raise bad("executor", found, expected, fix) from reason


@contextmanager
def _refusals(of: type[RuntimeError] = BrokenExecutor) -> Iterator[None]:
    """Say in the toolkit's words that workers ended, or ``of`` an executor that takes no work."""
    try:
        yield
    except BrokenExecutor as reason:
        raise WorkersLost(
            f"executor: found workers that ended ({reason}); expected them to live until the work "
            "is done; give fewer workers or smaller chunks, and the same store to go on from there"
        ) from reason
    except of as reason:
        found, fix = f"one that says: {reason}", "do the work inside its with block"
        raise bad("executor", found, "one that takes work", fix) from reason
