"""Independent pieces of work, done here or by an executor, the same by any and in any order."""

from __future__ import annotations

import os
import pickle
import sys
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
from contextlib import contextmanager, suppress
from importlib import import_module
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
    submit: Any = executor.submit
    waiting: dict[Future[Any], int] = {}
    try:
        while True:
            # Two pieces for each worker: one being done and one waiting.
            for number, item in islice(queue, max(0, 2 * at_once(executor) - len(waiting))):
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


def at_once(executor: Executor) -> int:
    """Return how many items an executor does at once; workers of a cluster come and go."""
    count = getattr(executor, "_max_workers", None)
    client = getattr(executor, "_client", None)
    if not count and client is not None:  # Dask's
        count = sum(client.nthreads().values())
    return int(count or os.cpu_count() or 1)


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

    Yields
    ------
    concurrent.futures.Executor

    Raises
    ------
    BadInput
        If that is no such number.

    Notes
    -----
    The processes are started afresh, not copied: a script that opens a pool keeps its own work
    under ``if __name__ == "__main__":``, as with any such pool.

    Examples
    --------
    >>> import elastolink as el
    >>> with el.process_pool(2) as pool:
    ...     print(list(pool.map(abs, [-1, 2])))
    [1, 2]
    """
    import multiprocessing
    from concurrent.futures import ProcessPoolExecutor

    count = check_workers(workers)
    context = multiprocessing.get_context("spawn")
    # The libraries read it as they load, in the processes that start here.
    with (
        environment(dict.fromkeys(THREADS, "1")),
        ProcessPoolExecutor(
            max_workers=count, mp_context=context, initializer=_end_with_parent
        ) as pool,
    ):
        yield pool


def _end_with_parent() -> None:
    """End this worker when the process that began it was killed: it would wait for ever."""
    from multiprocessing import parent_process

    parent = parent_process()
    if parent is None:
        return

    def watch() -> None:
        parent.join()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def check_workers(workers: object, where: str = "workers") -> int:
    """Return a number of workers from 1 to 1024; refuse anything else."""
    return require_whole(where, workers, 1, 1024, "give the number of cores")


_kept = threading.local()


def _call(sent: bytes, item: Any) -> Any:
    """Do the work on one item in a worker, which keeps the work for the next one."""
    if getattr(_kept, "sent", None) != sent:
        _kept.work, _kept.sent = pickle.loads(sent), sent
    return _kept.work(item)


_UNPICKLABLE = (pickle.PicklingError, AttributeError, TypeError)


def _pickled(work: Callable[[Any], Any]) -> bytes:
    """Return work that a worker can read, where cloudpickle is installed also from a notebook."""
    try:
        sent, refusal = pickle.dumps(work), None
    except _UNPICKLABLE as reason:
        sent, refusal = b"", reason
    # What a script or a notebook defines is a mere name to pickle, unknown to workers elsewhere.
    if refusal is not None or b"__main__" in sent:
        with suppress(ImportError, *_UNPICKLABLE):
            return bytes(import_module("cloudpickle").dumps(work))
    if refusal is None:
        return sent
    found = f"a subject or function that cannot be sent to another process ({refusal})"
    expected = "functions of a module, and systems and scenes made of such"
    fix = "define them at the top of a file, install cloudpickle, or use a ThreadPoolExecutor"
    raise bad("executor", found, expected, fix) from refusal


def _lost() -> tuple[type[Exception], ...]:
    """Return what executors raise whose workers end, Dask's where a piece ends them repeatedly."""
    told = getattr(sys.modules.get("distributed"), "KilledWorker", None)
    return (BrokenExecutor,) if told is None else (BrokenExecutor, told)


@contextmanager
def _refusals(of: type[RuntimeError] = BrokenExecutor) -> Iterator[None]:
    """Say in the toolkit's words that workers ended, or ``of`` an executor that takes no work."""
    try:
        yield
    except _lost() as reason:
        raise WorkersLost(
            f"executor: found workers that ended ({reason}); expected them to live until the work "
            "is done; give fewer workers or smaller chunks, and the same store to go on from there"
        ) from reason
    except of as reason:
        found, fix = f"one that says: {reason}", "do the work inside its with block"
        raise bad("executor", found, "one that takes work", fix) from reason
