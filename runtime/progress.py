"""A progress bar for long work, loaded only when it is wanted."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def bar(wanted: bool, total: int) -> Iterator[Callable[[int], None] | None]:
    """Show a progress bar; yield a function that is told how much is done, or None.

    Parameters
    ----------
    wanted : bool
        Whether to show it.
    total : int
        Amount of work.
    """
    if not wanted:
        yield None
        return
    from tqdm import tqdm

    with tqdm(total=total) as display:

        def tick(done: int) -> None:
            display.update(done - display.n)

        yield tick
