"""Fields of a result that are computed when they are first looked at."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any


@dataclass(frozen=True)
class Deferred:
    """A value to be: ``make()`` returns it; it must bear pickling where the result should."""

    make: Callable[[], Any]


class DeferredField:
    """Descriptor of a dataclass field that takes a value, or a :class:`Deferred` one.

    For error estimates that would take longer than the work whose error they measure.
    """

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __set__(self, instance: object, value: object) -> None:
        """Keep what is given; called once, when the dataclass is made."""
        instance.__dict__[self._name] = value

    def __get__(self, instance: object | None, owner: type | None = None) -> Any:
        if instance is None:  # the dataclass asks for a default: there is none
            raise AttributeError(self._name)
        value = instance.__dict__[self._name]
        if isinstance(value, Deferred):
            value = instance.__dict__[self._name] = value.make()
        return value


@dataclass(frozen=True)
class DeferredGroup:
    """Fields that are computed together, when the first of them is looked at.

    ``make()`` returns the values by name; it must bear pickling where the result should.
    """

    make: Callable[[], Mapping[str, Any]]

    @cached_property
    def _made(self) -> Mapping[str, Any]:
        return self.make()

    def value(self, name: str) -> Any:
        """Return one value, having computed all of them."""
        return self._made[name]

    def later(self, name: str) -> Deferred:
        """Return one value to be."""
        return Deferred(partial(self.value, name))
