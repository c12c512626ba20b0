"""A progress bar for long work, with the time left, loaded only when it is wanted."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def bar(
    wanted: bool, total: int, *, begun: int = 0, unit: str = "it"
) -> Iterator[Callable[[int], None] | None]:
    """Show a progress bar; yield a function that is told how much is done, or None.

    Parameters
    ----------
    wanted : bool
        Whether to show it.
    total : int
        Amount of work.
    begun : int
        What of it was there beforehand: the time left is reckoned from the rest.
    unit : str
        What is counted.
    """
    if not wanted:
        yield None
        return
    from tqdm import tqdm

    with tqdm(total=total, initial=begun, unit=unit, unit_scale=total > 10_000) as display:

        def tick(done: int) -> None:
            display.update(done - display.n)

        yield tick
