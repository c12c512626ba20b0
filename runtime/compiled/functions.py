"""Emitted functions evaluated by one compiled loop over the broadcast points."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from .layouts import NUMBERS, Layout, lay_out
from .rewriting import PLAIN, SCALAR, emitted_module, loop_of
from .store import compile_loop, require_numba

Array: TypeAlias = NDArray[np.float64]

_FLOAT = np.dtype(np.float64)
# Layouts of calls that a function remembers.
_LAYOUTS = 256
_ALL_FLOATS = {float}


class CompiledFunction:
    """An emitted function as one compiled loop; make it with :func:`compiled_function`.

    Attributes
    ----------
    function : callable
        The emitted function.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        loop = loop_of(function)
        require_numba("compiled")
        functools.update_wrapper(self, function)
        self.function = function
        self._loop, self._run = loop, compile_loop(loop)
        self._layouts: dict[tuple[object, ...], Layout | None] = {}
        self._count, returned = len(loop.arguments), len(loop.outputs)
        self._returned = returned
        # Numbers alone stand in one row, and so do the outputs.
        self._numbers = np.zeros(2 * (self._count + returned), dtype=np.int64)
        self._numbers[::2] = [*range(self._count), *range(returned)]
        constants = [output.constant for output in loop.outputs]
        self._constants = [(k, own) for k, own in enumerate(constants) if own is not None]
        kinds = [output.kind for output in loop.outputs]
        self._plain = kinds.count(PLAIN) == returned
        self._mixed = [(k, kind) for k, kind in enumerate(kinds) if kind != SCALAR]

    def __reduce__(self) -> tuple[object, ...]:
        """Make copies and pickled ones from the emitted function, in the process that wants it."""
        return compiled_function, (self.function,)

    def __call__(self, *arguments: Any, **named: Any) -> Any:
        """Evaluate, arguments and returned values as of the emitted function."""
        if named:
            rest = self._loop.arguments[len(arguments) :]
            if len(named) != len(rest) or not all(name in named for name in rest):
                return self.function(*arguments, **named)  # which says what is wrong
            arguments = (*arguments, *(named[name] for name in rest))
        if len(arguments) == self._count and set(map(type, arguments)) == _ALL_FLOATS:
            return self._of_numbers(arguments)
        kinds: list[object] = []
        for item in arguments:
            kind: object = NUMBERS.get(type(item))
            if kind is None:
                if type(item) is not np.ndarray or item.dtype != _FLOAT:
                    return self.function(*arguments)
                kind = item.shape
            kinds.append(kind)
        key = tuple(kinds)
        if key in self._layouts:
            layout = self._layouts[key]
        else:
            if len(self._layouts) >= _LAYOUTS:
                self._layouts.clear()
            layout = self._layouts[key] = lay_out(self._loop.outputs, self._count, key)
        if layout is None:
            return self.function(*arguments)
        found = layout.evaluated(self._run, arguments)
        return found[0] if self._loop.single else found

    def _of_numbers(self, arguments: Sequence[float]) -> Any:
        """Evaluate at Python's own numbers, as the integrators of one motion ask."""
        out = self.at_numbers(arguments)
        if self._plain:
            found = out.tolist()
        else:
            found = list(out)
            for k, kind in self._mixed:
                found[k] = float(found[k]) if kind == PLAIN else np.array(found[k])
        for k, value in self._constants:
            found[k] = value
        return found[0] if self._loop.single else tuple(found)

    def at_numbers(self, numbers: Sequence[float]) -> Array:
        """Return the outputs at single numbers in one row, ``(outputs,)``.

        Parameters
        ----------
        numbers : sequence of float
            A value of each argument, in order.
        """
        values, out = np.array(numbers, dtype=float), np.empty(self._returned)
        self._run(1, self._numbers, values, out)
        return out


def compiled_function(function: Callable[..., Any]) -> CompiledFunction:
    """Return an emitted function evaluated by one compiled loop instead of hundreds of passes.

    The loop is made from the statements of the emitted function: the same operations in the same
    order, without any rearrangement by the compiler.  Sines and powers are those of the system's
    library and not NumPy's, so that values differ in their last digits: by less than 1e-13 of
    ``|f| + sum_i |x_i df/dx_i|``.

    Parameters
    ----------
    function : callable
        A function of an emitted module: arithmetic on arguments that broadcast.

    Returns
    -------
    CompiledFunction
        Takes and returns what the function does, with the same shapes and types.

    Raises
    ------
    BadInput
        If numba is not installed (extra ``fast``), or the function is not of that kind.

    Notes
    -----
    It is compiled when it is first asked for, in about a second, and kept in the user's cache
    folder; a later process loads it from there.

    A call costs a few microseconds, whatever the function.  Up to a hundred points it is two to
    eighteen times as fast as NumPy's passes, with a thousand up to twice.  From ten thousand on
    the two are about even: NumPy takes several numbers at a time, and where it has arc tangents
    that do so, a function of these is up to half as slow again.  At Python's own numbers, where
    the emitted function is plain arithmetic, a short one gains nothing.

    The emitted function itself is evaluated where an argument is not of double precision, there is
    no point at all, or every number is a whole one.  Where NumPy warns of a division by zero, the
    loop returns the same infinity or NaN and says nothing.
    """
    if isinstance(function, CompiledFunction):
        return function
    emitted_module(function)  # refuses what is none
    return _made(function)


@functools.cache
def _made(function: Callable[..., Any]) -> CompiledFunction:
    """Return the one compiled form that a function has in this process."""
    return CompiledFunction(function)
