"""Progress of long work: a bar with the time left where steps are counted, else the time taken."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Event, Thread
from time import monotonic

# Time without a sign of life, and between two signs [s].
_SILENCE, _BETWEEN = 2.0, 1.0
_bars: list[object] = []


@contextmanager
def bar(
    wanted: bool, total: int, *, begun: int = 0, unit: str = "it"
) -> Iterator[Callable[[int], None]]:
    """Show a progress bar where it is wanted; yield a function of how much is done.

    What was ``begun`` of the ``total`` beforehand does not count in the time left.
    """
    from .inputs import require_flag

    require_flag("progress", wanted)
    if not wanted:
        yield lambda done: None
        return
    from tqdm import tqdm

    with tqdm(total=total, initial=begun, unit=unit, unit_scale=total > 10_000) as display:

        def tick(done: int) -> None:
            display.update(done - display.n)

        _bars.append(display)
        try:
            yield tick
        finally:
            _bars.remove(display)


@contextmanager
def time_taken() -> Iterator[None]:
    """Show on a terminal how long work has taken, from two seconds on, while there is no bar."""
    if not sys.stderr.isatty():
        yield
        return
    done, start = Event(), monotonic()

    def show() -> None:
        wait = _SILENCE
        while not done.wait(wait):
            wait = _BETWEEN
            if not _bars:
                # Back to the line's start, so that what is written next covers it.
                text = f"{monotonic() - start:.0f} s"
                print(f"{text}\r", end="", file=sys.stderr, flush=True)

    clock = Thread(target=show, daemon=True)
    clock.start()
    try:
        yield
    finally:
        done.set()
        clock.join()
