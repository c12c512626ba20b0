"""From an emitted linear-periodic module and numbers to the system that the solvers take."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection, Iterable, Mapping
from functools import partial
from types import ModuleType
from typing import Any, Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import MATRICES, LinearPeriodic, Term
from ..core.families.emitted import check_module, dropped_names

Array = NDArray[np.float64]

_Row: TypeAlias = tuple[str, int, str | None, str | None, str]
_ROUND = 8.0 * float(np.finfo(float).eps)


class BasisArrays(Protocol):
    """Shapes that depend on the place of a support, by the integrals that a module needs."""

    @property
    def size(self) -> int:
        """Number of shapes."""

    def array(self, name: str, place: Array) -> Array:
        """Return integrals at places ``(nt,)`` of the support: ``(nt, n, n)`` or ``(nt, n)``."""


def assemble(
    module: ModuleType,
    *,
    geometry: Mapping[str, float],
    parameters: Mapping[str, float],
    modes: int | None = None,
    external: Mapping[str, Callable[[Array], Array]] | None = None,
    basis: BasisArrays | None = None,
    forcing: bool = True,
    drop: Collection[str] = (),
    **attributes: Any,
) -> LinearPeriodic:
    """Return the linear-periodic system of an emitted module.

    Parameters
    ----------
    module : module
        Emitted, with ``FAMILY = "linear_periodic"``.
    geometry : mapping
        Arguments of its functions of angle, beside the angle, in SI units.
    parameters : mapping
        Its inertial and elastic parameters, in SI units.
    modes : int, optional
        Number of modes; needed where the module serves any number.
    external : mapping, optional
        Functions of angle that the module wants passed in, by argument name.
    basis : object, optional
        Shapes of a module whose arrays consist of integrals over them: its ``size`` is their
        number, its ``array(name, place)`` gives the integrals that the module's ``BASIS`` defines.
    forcing : bool
        Whether the forcing terms are taken along.
    drop : collection of str
        Terms of the energies to leave out (of the module's ``DROPS``).
    **attributes
        Further attributes of :class:`~elastolink.runtime.core.families.LinearPeriodic`.

    Raises
    ------
    BadInput
        If the module is of another family, if a parameter, argument, function or basis is missing,
        or if the module cannot leave out a term.
    """
    check_module(module, "linear_periodic", parameters)
    missing = sorted(set(module.EXTERNAL) - set(external or {}))
    if missing:
        raise bad("external", f"none for {missing}", "a function of angle each", "pass them")
    rows = _rows(module, drop)
    integrals = _integrals(module, geometry, basis, rows)
    modal = _modal_arrays(module, modes, integrals, rows)
    shared = _angle_kernels(module, geometry, external or {})
    terms = []
    for array, power, scale, angle, mode in rows:
        if array in MATRICES or forcing:
            function = _function(angle, modal[mode], shared, external or {})
            terms.append(Term(array, scale, function, power))
    size = (
        next(v.shape[0] for v in modal.values() if not callable(v)) if basis is None else basis.size
    )
    if modes is not None and modes != size:
        raise bad("modes", modes, f"{size}, the module's own", "ask for a module of that number")
    scales: Callable[[Mapping[str, ArrayLike]], Mapping[str, Array]] = _no_scales
    if "scales" in module.RETURNS:
        used = inspect.signature(module.scales).parameters
        fixed = {name: geometry[name] for name in used if name in geometry}
        # Parameters that no term uses (pruned, or forcing left out) stay known to the user.
        names = tuple(name for name in used if name not in fixed)
        scales = partial(_scales, module.scales, module.RETURNS["scales"], names, fixed)
    return LinearPeriodic(
        size=size, terms=tuple(terms), parameters=dict(parameters), scales=scales, **attributes
    )


def _rows(module: ModuleType, drop: Collection[str]) -> tuple[_Row, ...]:
    """Return the separated terms, without those of the terms of the energies that are left out."""
    rows: tuple[_Row, ...] = module.TERMS
    if not drop:
        return rows
    gone, come = dropped_names(module, drop)
    return (*(row for row in rows if row not in gone), *come)


# Functions with some arguments given, and no module among them, so that systems can be pickled.


def _no_scales(values: Mapping[str, ArrayLike]) -> Mapping[str, Array]:
    return {}


def _scales(
    function: Callable[..., Any],
    returned: tuple[str, ...],
    names: tuple[str, ...],
    fixed: Mapping[str, float],
    values: Mapping[str, ArrayLike],
) -> Mapping[str, Array]:
    given = {name: np.asarray(values[name], dtype=float) for name in names}
    result = function(**given, **fixed)
    if len(returned) == 1:
        result = (result,)
    return {name: np.asarray(v) for name, v in zip(returned, result, strict=True)}


def _modal_arrays(
    module: ModuleType, modes: int | None, integrals: _Integrals | None, rows: Iterable[_Row]
) -> dict[str, Array | Callable[[Array], Array]]:
    arrays: dict[str, Array | Callable[[Array], Array]] = {}
    if integrals is not None:
        arrays |= {name: partial(integrals, name) for name in integrals.names}
    for kernel in ("modal_matrices", "modal_vectors"):
        if kernel not in module.RETURNS:
            continue
        if modes is None or modes < 1:
            raise bad("modes", modes, "a number of modes, from 1", "set model.modes")
        m = np.arange(1.0, modes + 1.0)
        result = (
            module.modal_matrices(m[:, None], m[None, :])
            if kernel == "modal_matrices"
            else module.modal_vectors(m)
        )
        names = module.RETURNS[kernel]
        result = (result,) if len(names) == 1 else result
        shape = (modes, modes) if kernel == "modal_matrices" else (modes,)
        arrays |= {
            name: np.array(np.broadcast_to(value, shape), dtype=float)
            for name, value in zip(names, result, strict=True)
        }
    for _, _, _, _, name in rows:
        if name not in arrays:
            arrays[name] = np.array(getattr(module, name.upper()))
    return arrays


def _integrals(
    module: ModuleType,
    geometry: Mapping[str, float],
    basis: BasisArrays | None,
    rows: Iterable[_Row],
) -> _Integrals | None:
    if not hasattr(module, "BASIS"):
        return None
    if basis is None:
        raise bad("basis", "none", "shapes for the module's integrals", "pass a basis")
    wanted = list(inspect.signature(module.place).parameters)[1:]
    missing = sorted(set(wanted) - set(geometry))
    if missing:
        raise bad("geometry", f"none for {missing}", "a value each", "supply them")
    names = {row[4] for row in rows}
    return _Integrals(module, basis, {name: geometry[name] for name in wanted}, names)


class _Integrals:
    """Integrals over shapes that follow a support, computed once for all terms."""

    def __init__(
        self,
        module: ModuleType,
        basis: BasisArrays,
        geometry: Mapping[str, float],
        names: Collection[str],
    ) -> None:
        self._place, self._basis, self._geometry = module.place, basis, geometry
        self._products: tuple[str, ...] = module.RETURNS.get("basis_products", ())
        self._multiply: Callable[..., Any] = getattr(module, "basis_products", tuple)
        self.names = names
        self._last: tuple[Array, Array, dict[str, Array]] | None = None

    def __call__(self, name: str, theta: Array) -> Array:
        last = self._last
        if last is None or not np.array_equal(last[0], theta):
            place = np.asarray(self._place(theta, **self._geometry))
            # A support at the very end, beyond it by rounding.
            place = np.where(place <= 1.0 + _ROUND, np.minimum(place, 1.0), place)
            last = self._last = (theta.copy(), place, {})
        _, place, arrays = last
        if name in self._products:
            return self._product(name, place, arrays)
        if name not in arrays:
            arrays[name] = self._basis.array(name, place)
        return arrays[name]

    def _product(self, name: str, place: Array, arrays: dict[str, Array]) -> Array:
        """Return a matrix that is a product of vectors."""
        if name not in arrays:
            given = {}
            for argument in inspect.signature(self._multiply).parameters:
                vector, _, end = argument.rpartition("_")
                if vector not in arrays:
                    arrays[vector] = self._basis.array(vector, place)
                value = arrays[vector]
                given[argument] = value[..., None] if end == "row" else value[..., None, :]
            products = self._multiply(**given)
            products = (products,) if len(self._products) == 1 else products
            arrays |= dict(zip(self._products, products, strict=True))
        return arrays[name]


class _Shared:
    """An emitted function of angle, evaluated once for all terms at one array of angles."""

    def __init__(
        self,
        function: Callable[..., Any],
        names: tuple[str, ...],
        fixed: Mapping[str, float],
        external: Mapping[str, Callable[[Array], Array]],
    ) -> None:
        self.names = names
        self._function, self._fixed, self._external = function, fixed, external
        self._last: tuple[Array, dict[str, Array]] | None = None

    def __call__(self, theta: Array) -> dict[str, Array]:
        last = self._last
        if last is None or not np.array_equal(last[0], theta):
            passed = {name: given(theta) for name, given in self._external.items()}
            result = self._function(theta, **self._fixed, **passed)
            values = (result,) if len(self.names) == 1 else result
            table = {n: np.asarray(v) for n, v in zip(self.names, values, strict=True)}
            last = self._last = (theta.copy(), table)
        return last[1]


def _angle_kernels(
    module: ModuleType,
    geometry: Mapping[str, float],
    external: Mapping[str, Callable[[Array], Array]],
) -> dict[str, _Shared]:
    """Return, for each function of angle, the emitted kernel that gives it."""
    kernels: dict[str, _Shared] = {}
    for kernel, names in module.RETURNS.items():
        if not kernel.endswith("_functions"):
            continue
        function = getattr(module, kernel)
        wanted = list(inspect.signature(function).parameters)[1:]
        missing = sorted(set(wanted) - set(geometry) - set(external))
        if missing:
            raise bad("geometry", f"none for {missing}", "a value each", "supply them")
        fixed = {name: geometry[name] for name in wanted if name in geometry}
        passed = {name: external[name] for name in wanted if name in external}
        kernels |= dict.fromkeys(names, _Shared(function, names, fixed, passed))
    return kernels


def _function(
    angle: str | None,
    modal: Array | Callable[[Array], Array],
    shared: Mapping[str, _Shared],
    external: Mapping[str, Callable[[Array], Array]],
) -> Array | Callable[[Array], Array]:
    """Return the modal array, or the function of angle that multiplies it."""
    if angle is None:
        return modal
    emitted = angle in shared
    factor = partial(_of_kernel, shared[angle], angle) if emitted else external[angle]
    return partial(_multiplied, factor, modal)


def _of_kernel(kernel: _Shared, name: str, theta: Array) -> Array:
    return kernel(theta)[name]


def _multiplied(
    factor: Callable[[Array], Array], modal: Array | Callable[[Array], Array], theta: Array
) -> Array:
    return _each(factor(theta), modal(theta) if callable(modal) else modal[None])


def _each(values: Array, arrays: Array) -> Array:
    """Return each array times the value at its angle."""
    return values.reshape(*values.shape, *(1,) * (arrays.ndim - 1)) * arrays
