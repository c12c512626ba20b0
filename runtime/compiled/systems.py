"""Systems whose emitted functions are evaluated by compiled loops."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from types import ModuleType
from typing import Any, TypeVar

from ..core.errors import bad
from ..core.families import Constrained, LinearPeriodic
from .functions import compiled_function
from .modules import CompiledModule, compiled_module
from .rewriting import is_emitted
from .store import require_numba, version

System = TypeVar("System", LinearPeriodic, Constrained)


def compiled(system: System) -> System:
    """Return the same system with its emitted functions evaluated by compiled loops.

    Every solver takes it as it takes the system itself.  Results agree to about 1e-13 of the terms
    that make them up, see :func:`compiled_function`; the provenance says that loops were used.

    Parameters
    ----------
    system : LinearPeriodic or Constrained
        A coupler, a rod, a linkage in redundant coordinates, or a system assembled from a module
        of one's own.

    Returns
    -------
    LinearPeriodic or Constrained
        Of the same type.  ``with_parameters``, ``with_geometry``, ``with_terms`` and modal damping
        return compiled systems again; copies and pickled ones load the loops where they arrive.

    Raises
    ------
    BadInput
        If numba is not installed (extra ``fast``), the system is of another family, or it holds no
        emitted function: Hill's equation, whose function is a Fourier series, and structures of
        beams, whose arrays are constant matrices turned.

    Notes
    -----
    It pays where a function is asked for few points at a time: see :func:`compiled_function`.
    The solvers of linear systems sample their terms once and work on the samples, so that there a
    whole answer gains little.
    """
    if not isinstance(system, LinearPeriodic | Constrained):
        found = type(system).__name__
        raise bad("system", found, "a LinearPeriodic or Constrained system", "pass scene.system()")
    require_numba("compiled")
    exchange = _Exchange()
    made: System = exchange(system)
    if not exchange.found:
        raise bad(
            "system",
            "no emitted function in its terms",
            "a system whose coefficients an emitted module gives",
            "solve it as it is",
        )
    return made


class _Exchange:
    """Replaces emitted functions by compiled ones in whatever a system is made of.

    What was one object before is one object afterwards, so that terms go on sharing values.
    """

    def __init__(self) -> None:
        self.found = False
        # The old objects are kept, so that no other one takes the place that tells them apart.
        self._made: dict[int, tuple[object, Any]] = {}

    def __call__(self, value: Any) -> Any:
        known = self._made.get(id(value))
        if known is None:
            known = self._made[id(value)] = (value, self._changed(value))
        return known[1]

    def _changed(self, value: Any) -> Any:
        if isinstance(value, LinearPeriodic):
            return self._linear(value)
        if isinstance(value, Constrained):
            return self._constrained(value)
        if isinstance(value, partial):
            return self._partial(value)
        if isinstance(value, tuple):
            return tuple(self(item) for item in value)
        if isinstance(value, ModuleType) and hasattr(value, "RETURNS"):
            self.found = True
            return compiled_module(value)
        if is_emitted(value):
            self.found = True
            return compiled_function(value)
        self.found = self.found or hasattr(value, "at_numbers") or isinstance(value, CompiledModule)
        change: Callable[..., Any] | None = getattr(value, "with_functions", None)
        return value if change is None else change(self)

    def _partial(self, value: partial[Any]) -> partial[Any]:
        given = (self(item) for item in value.args)
        named = {name: self(item) for name, item in value.keywords.items()}
        return partial(self(value.func), *given, **named)

    def _linear(self, system: LinearPeriodic) -> LinearPeriodic:
        terms = tuple(
            term if term.constant else replace(term, function=self(term.function))
            for term in system.terms
        )
        more: dict[str, Any] = {}
        if system.rebuild is not None:
            more["rebuild"] = _again(system.rebuild)
        if system.remesh is not None:
            more["remesh"] = _again(system.remesh)
        return replace(system, terms=terms, provenance=_told(system.provenance), **more)

    def _constrained(self, system: Constrained) -> Constrained:
        names = ("dynamics", "violation", "variations")
        changed = {name: self(getattr(system, name)) for name in names}
        return replace(system, provenance=_told(system.provenance), **changed)


def _again(make: Callable[[Any], LinearPeriodic]) -> Callable[[Any], LinearPeriodic]:
    """Return what makes a system anew and compiles it."""
    if isinstance(make, partial) and make.func is _made_again:
        return make
    return partial(_made_again, make)


def _made_again(make: Callable[[Any], LinearPeriodic], given: object) -> LinearPeriodic:
    return compiled(make(given))


def _told(provenance: Mapping[str, str]) -> dict[str, str]:
    """Return the provenance with the remark that functions were compiled."""
    return {**provenance, "functions": f"compiled by numba {version()}"}
