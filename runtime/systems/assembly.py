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
from ..core.families import LinearPeriodic, Term
from ..core.families.emitted import check_module, dropped_names
from ..core.inputs import require_kind
from ..core.trigonometric import Remembered

Array = NDArray[np.float64]

_Row: TypeAlias = tuple[str, int, str | None, str | None, str]
_Kernel: TypeAlias = Remembered[dict[str, Array]]  # all terms share one evaluation


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
    drop : collection of str
        Terms of the energies to leave out (of the module's ``DROPS``).
    **attributes
        Further attributes of :class:`~elastolink.runtime.core.families.LinearPeriodic`.

    Returns
    -------
    LinearPeriodic
        Of the given parameters and attributes.

    Raises
    ------
    BadInput
        If the module is of another family, if a parameter, argument, function or basis is missing,
        or if the module cannot leave out a term.

    Examples
    --------
    >>> import elastolink as el
    >>> import numpy as np
    >>> from elastolink.generated import hill_plain
    >>> numbers = {"lam2": 0.25, "mu": 0.1, "damping": 0.0}
    >>> system = el.assemble(hill_plain, geometry={}, parameters=numbers, external={"f": np.cos})
    >>> print(system.size, el.floquet_multipliers(system, speed=1.0).stable)
    1 False
    """
    require_kind("module", module, ModuleType, "import one of elastolink.generated")
    check_module(module, "linear_periodic", parameters)
    external = external or {}
    missing = sorted(set(module.EXTERNAL) - set(external))
    if missing:
        raise bad("external", f"none for {missing}", "a function of angle each", "pass them")
    rows: tuple[_Row, ...] = module.TERMS
    if drop:
        gone, come = dropped_names(module, drop)
        rows = (*(row for row in rows if row not in gone), *come)
    integrals = _integrals(module, geometry, basis, rows)
    modal = modal_arrays(module, modes, integrals, rows)
    shared = _angle_kernels(module, geometry, external)
    terms = []
    for array, power, scale, angle, mode in rows:
        function = modal[mode]
        if angle is not None:
            kernel = shared.get(angle)
            factor = partial(_of_kernel, kernel, angle) if kernel else external[angle]
            function = partial(_multiplied, factor, function)
        terms.append(Term(array, scale, function, power))
    size = (
        next(v.shape[0] for v in modal.values() if not callable(v)) if basis is None else basis.size
    )
    if modes is not None and modes != size:
        raise bad("modes", modes, f"{size}, the module's own", "ask for a module of that number")
    if "scales" in module.RETURNS:
        used = inspect.signature(module.scales).parameters
        fixed = {name: geometry[name] for name in used if name in geometry}
        # Parameters that no term uses, pruned ones, stay known to the user.
        names = tuple(name for name in used if name not in fixed)
        attributes["scales"] = partial(
            _scales, module.scales, module.RETURNS["scales"], names, fixed
        )
    return LinearPeriodic(size=size, terms=tuple(terms), parameters=dict(parameters), **attributes)


# Functions with some arguments given, and no module among them, so that systems can be pickled.


def _scales(
    function: Callable[..., Any],
    returned: tuple[str, ...],
    names: tuple[str, ...],
    fixed: Mapping[str, float],
    values: Mapping[str, ArrayLike],
) -> Mapping[str, Array]:
    given = {name: np.asarray(values[name], dtype=float) for name in names}
    return _arrays_by_name(returned, function(**given, **fixed))


def modal_arrays(
    module: ModuleType, modes: int | None, integrals: _Integrals | None, rows: Iterable[_Row]
) -> dict[str, Array | Callable[[Array], Array]]:
    """Return the modal arrays, or integrals, of the rows of a module's terms."""
    arrays: dict[str, Array | Callable[[Array], Array]] = {}
    if integrals is not None:
        arrays |= {name: partial(integrals, name) for name in integrals.names}
    for kernel, dimension in (("modal_matrices", 2), ("modal_vectors", 1)):
        if kernel not in module.RETURNS:
            continue
        if modes is None or modes < 1:
            raise bad("modes", modes, "a number of modes, from 1", "set model.modes")
        numbers = np.ix_(*[np.arange(1.0, modes + 1.0)] * dimension)
        values = _arrays_by_name(module.RETURNS[kernel], getattr(module, kernel)(*numbers))
        shape = (modes,) * dimension
        arrays |= {
            name: np.array(np.broadcast_to(value, shape), dtype=float)
            for name, value in values.items()
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
    lengths = {name: geometry[name] for name in _arguments(module.place, geometry)}
    return _Integrals(module, basis, lengths, {row[4] for row in rows})


def _arguments(function: Callable[..., Any], given: Collection[str]) -> list[str]:
    """Return the arguments behind the angle, refused where one is not given."""
    wanted = list(inspect.signature(function).parameters)[1:]
    missing = sorted(set(wanted) - set(given))
    if missing:
        raise bad("geometry", f"none for {missing}", "a value each", "supply them")
    return wanted


class _Integrals:
    """Integrals over shapes that follow a support, each computed once for all terms."""

    def __init__(
        self,
        module: ModuleType,
        basis: BasisArrays,
        geometry: Mapping[str, float],
        names: Collection[str],
    ) -> None:
        self.names = names
        self._arrays = Remembered(partial(_at_place, module.place, geometry))
        self._basis = basis
        self._products: tuple[str, ...] = module.RETURNS.get("basis_products", ())
        self._multiply: Callable[..., Any] = getattr(module, "basis_products", tuple)

    def __call__(self, name: str, theta: Array) -> Array:
        arrays = self._arrays(theta)
        if name not in arrays:
            if name in self._products:
                arrays |= self._multiply_vectors(theta)
            else:
                arrays[name] = self._basis.array(name, arrays["place"])
        return arrays[name]

    def _multiply_vectors(self, theta: Array) -> dict[str, Array]:
        """Return the matrices that are products of vectors."""
        given = {}
        for argument in inspect.signature(self._multiply).parameters:
            vector, _, end = argument.rpartition("_")
            value = self(vector, theta)
            given[argument] = value[..., None] if end == "row" else value[..., None, :]
        return _arrays_by_name(self._products, self._multiply(**given))


def _at_place(
    function: Callable[..., Array], geometry: Mapping[str, float], theta: Array
) -> dict[str, Array]:
    """Return the support's place at each angle, where its integrals are to be kept beside it."""
    place = np.asarray(function(theta, **_beside(theta, geometry)))
    if place.dtype == object:
        return {"place": place}
    # A support at the very end, beyond it by rounding.
    round_off = 8.0 * float(np.finfo(float).eps)
    return {"place": np.where(place <= 1.0 + round_off, np.minimum(place, 1.0), place)}


def _arrays_by_name(names: tuple[str, ...], values: Any) -> dict[str, Array]:
    return {name: np.asarray(value) for name, value in by_name(names, values).items()}


def by_name(names: tuple[str, ...], values: Any) -> dict[str, Any]:
    """Return what an emitted function gave by name; a single value stands alone."""
    return dict(zip(names, (values,) if len(names) == 1 else values, strict=True))


def _kernel_values(
    function: Callable[..., Any],
    names: tuple[str, ...],
    fixed: Mapping[str, float],
    external: Mapping[str, Callable[[Array], Array]],
    theta: Array,
) -> dict[str, Array]:
    passed = {name: given(theta) for name, given in external.items()}
    return _arrays_by_name(names, function(theta, **_beside(theta, fixed), **passed))


def _beside(theta: Array, numbers: Mapping[str, float]) -> Mapping[str, Any]:
    """Return numbers of the kind of the angles: where these are balls, nothing is rounded."""
    if theta.dtype != object:
        return numbers
    return {name: 0.0 * theta + value for name, value in numbers.items()}


def _angle_kernels(
    module: ModuleType,
    geometry: Mapping[str, float],
    external: Mapping[str, Callable[[Array], Array]],
) -> dict[str, _Kernel]:
    """Return, for each function of angle, the emitted kernel that gives it."""
    kernels: dict[str, _Kernel] = {}
    for kernel, names in module.RETURNS.items():
        if not kernel.endswith("_functions"):
            continue
        function = getattr(module, kernel)
        wanted = _arguments(function, {*geometry, *external})
        fixed = {name: geometry[name] for name in wanted if name in geometry}
        passed = {name: external[name] for name in wanted if name in external}
        shared = Remembered(partial(_kernel_values, function, names, fixed, passed))
        kernels |= dict.fromkeys(names, shared)
    return kernels


def _of_kernel(kernel: _Kernel, name: str, theta: Array) -> Array:
    return kernel(theta)[name]


def _multiplied(
    factor: Callable[[Array], Array], modal: Array | Callable[[Array], Array], theta: Array
) -> Array:
    """Return the array, or each array, times the value at its angle."""
    values, arrays = factor(theta), modal(theta) if callable(modal) else modal[None]
    return values.reshape(*values.shape, *(1,) * (arrays.ndim - 1)) * arrays
