"""The same sums and products compiled by numba, for one speed at a time (extra ``fast``)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from ..core.errors import bad
from .tables import Array, Table


@dataclass(frozen=True)
class CompiledTable:
    """A table in the order in which compiled loops read it."""

    # Ends of the inverse speed [s/rad].
    low: float
    high: float
    # Chebyshev coefficients, (groups, nodes, m, m) and (nt, nodes, m, m).
    groups: Array
    inner: Array
    within: np.ndarray[Any, np.dtype[np.intp]]  # the group of each angle

    @classmethod
    def of(cls, table: Table) -> CompiledTable:
        """Return a table in that order."""
        groups, inner = (
            np.ascontiguousarray(np.swapaxes(part, 0, 1)) for part in (table.groups, table.inner)
        )
        if not len(inner):
            inner = np.zeros((len(table.within), *groups.shape[1:]))
            inner[:, 0] = np.eye(groups.shape[-1])
        return cls(table.low, table.high, groups, inner, table.within)

    def whole(self, inverse: float) -> Array:
        """Return the flow over the period at one inverse speed, ``(m, m)``."""
        flow: Array = kernels()[0](self.groups, self.inner[:0], self.within, self._at(inverse))[1]
        return flow

    def march(self, inverse: float, start: Array, periods: int) -> tuple[Array, Array]:
        """Return states ``(periods nt + 1, m)``, and the largest of each component at starts."""
        states: tuple[Array, Array] = kernels()[1](
            self.groups, self.inner, self.within, self._at(inverse), start, periods
        )
        return states

    def periodic(self, inverse: float, unit: float) -> tuple[Array, Array, float]:
        """Return the periodic states ``(nt, m)``, the flow over the period, and the reach.

        ``unit`` is the state's last component.  The reach is the largest sum of a row of
        ``(I - X)^-1``.
        """
        motion: tuple[Array, Array, float] = kernels()[2](
            self.groups, self.inner, self.within, self._at(inverse), unit
        )
        return motion

    def _at(self, inverse: float) -> float:
        """Return the place between -1 and 1."""
        if self.high == self.low:
            return 0.0
        place = (2.0 * inverse - self.low - self.high) / (self.high - self.low)
        return min(1.0, max(-1.0, place))


def require_numba() -> None:
    """Compile; refuse where numba is not installed."""
    try:
        import numba  # noqa: F401 - looked for
    except ImportError as missing:
        fix = "install the extra: pip install 'elastolink[fast]'"
        raise bad("compiled", "numba is not installed", "the extra fast", fix) from missing
    kernels()


@cache
def kernels() -> tuple[Callable[..., Any], Callable[..., Any], Callable[..., Any]]:
    """Return the compiled functions: flows, motions, periodic motions."""
    import numba

    flows = numba.njit(_flows_with(numba.njit(_mixed_into), numba.njit(_product_into)))
    march = numba.njit(_march_with(flows))
    periodic = numba.njit(_periodic_with(flows))
    return flows, march, periodic


def _flows_with(
    mixed_into: Callable[..., None], product_into: Callable[..., None]
) -> Callable[..., Any]:
    def flows(groups: Array, inner: Array, within: Any, place: float) -> tuple[Array, Array]:
        count, nodes, m = groups.shape[0], groups.shape[1], groups.shape[2]
        weights = np.ones(nodes)
        if nodes > 1:
            weights[1] = place
        for k in range(2, nodes):
            weights[k] = 2.0 * place * weights[k - 1] - weights[k - 2]
        found = np.empty((inner.shape[0], m, m))
        flow, single, product = np.eye(m), np.empty((m, m)), np.empty((m, m))
        angle = 0
        for k in range(count + 1):
            while angle < inner.shape[0] and (k == count or within[angle] == k):
                mixed_into(single, weights, inner[angle])
                product_into(found[angle], single, flow)
                angle += 1
            if k < count:
                mixed_into(single, weights, groups[k])
                product_into(product, single, flow)
                flow[:] = product
        return found, flow

    return flows


def _mixed_into(out: Array, weights: Array, table: Array) -> None:
    for i in range(out.shape[0]):
        for j in range(out.shape[1]):
            total = 0.0
            for k in range(len(weights)):
                total += weights[k] * table[k, i, j]
            out[i, j] = total


def _product_into(out: Array, left: Array, right: Array) -> None:
    for i in range(out.shape[0]):
        for j in range(out.shape[1]):
            total = 0.0
            for k in range(left.shape[1]):
                total += left[i, k] * right[k, j]
            out[i, j] = total


def _march_with(flows_of: Callable[..., Any]) -> Callable[..., Any]:
    def march(
        groups: Array, inner: Array, within: Any, place: float, start: Array, periods: int
    ) -> tuple[Array, Array]:
        flows, whole = flows_of(groups, inner, within, place)
        nt, m = inner.shape[0], len(start)
        states = np.empty((periods * nt + 1, m))
        state, after = start.copy(), np.empty(m)
        largest = np.zeros(m)
        for r in range(periods + 1):
            for i in range(m):
                largest[i] = max(largest[i], abs(state[i]))
            if r == periods:
                break
            for t in range(nt):
                for i in range(m):
                    total = 0.0
                    for j in range(m):
                        total += flows[t, i, j] * state[j]
                    states[r * nt + t, i] = total
            for i in range(m):
                total = 0.0
                for j in range(m):
                    total += whole[i, j] * state[j]
                after[i] = total
            state[:] = after
        states[periods * nt] = state
        return states, largest

    return march


def _periodic_with(flows_of: Callable[..., Any]) -> Callable[..., Any]:
    def periodic(
        groups: Array, inner: Array, within: Any, place: float, unit: float
    ) -> tuple[Array, Array, float]:
        flows, whole = flows_of(groups, inner, within, place)
        nt, m = inner.shape[0], inner.shape[2] - 1
        inverse = np.linalg.inv(np.eye(m) - whole[:m, :m])
        first = np.full(m + 1, unit)
        reach = 0.0
        for i in range(m):
            total, row = 0.0, 0.0
            for j in range(m):
                total += inverse[i, j] * whole[j, m]
                row += abs(inverse[i, j])
            first[i] = total * unit
            reach = max(reach, row)
        states = np.empty((nt, m + 1))
        for t in range(nt):
            for i in range(m + 1):
                total = 0.0
                for j in range(m + 1):
                    total += flows[t, i, j] * first[j]
                states[t, i] = total
        return states, whole, reach

    return periodic
