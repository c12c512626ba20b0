"""From an emitted linear-periodic module and numbers to the system that the solvers take."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection, Iterable, Mapping
from functools import partial
from types import ModuleType
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import LinearPeriodic, Term
from ..core.families.emitted import check_module, dropped_names
from ..core.inputs import require_kind
from ..core.trigonometric import Remembered

if TYPE_CHECKING:
    from .rod import MovingBasis

Array = NDArray[np.float64]

_Row: TypeAlias = tuple[str, int, str | None, str | None, str]
_ANGLE = ""  # stands for the crank angle among names of arguments


def assemble(
    module: ModuleType,
    *,
    geometry: Mapping[str, float],
    parameters: Mapping[str, float],
    modes: int | None = None,
    external: Mapping[str, Callable[[Array], Array]] | None = None,
    basis: MovingBasis | None = None,
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
    at_angles = _AtAngles(module, geometry, external, basis)
    modal: Mapping[str, Array | Callable[[Array], Array]]
    if hasattr(module, "BASIS") and basis is not None:
        modal, size = {row[4]: partial(at_angles, row[4]) for row in rows}, basis.size
    else:
        modal = constant = modal_arrays(module, modes, rows)
        size = len(constant[rows[0][4]])
    if modes is not None and modes != size:
        raise bad("modes", modes, f"{size}, the module's own", "ask for a module of that number")
    terms = []
    for array, power, scale, angle, mode in rows:
        function = modal[mode]
        if angle is not None:
            function = partial(_multiplied, partial(at_angles, angle), function)
        terms.append(Term(array, scale, function, power))
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


def modal_arrays(module: ModuleType, modes: int | None, rows: Iterable[_Row]) -> dict[str, Array]:
    """Return the modal arrays of the rows of a module's terms."""
    arrays: dict[str, Array] = {}
    for kernel, dimension in (("modal_matrices", 2), ("modal_vectors", 1)):
        if kernel not in module.RETURNS:
            continue
        if modes is None or modes < 1:
            raise bad("modes", modes, "a number of modes, from 1", "set model.modes")
        numbers = np.ix_(*[np.arange(1.0, modes + 1.0)] * dimension)
        values = by_name(module.RETURNS[kernel], getattr(module, kernel)(*numbers))
        shape = (modes,) * dimension
        arrays |= {
            name: np.array(np.broadcast_to(value, shape), dtype=float)
            for name, value in values.items()
        }
    own = {row[4] for row in rows} - set(arrays)
    return arrays | {name: np.array(getattr(module, name.upper())) for name in own}


class _AtAngles:
    """Arrays of a module that depend on the crank angle, each computed once for all terms."""

    def __init__(
        self,
        module: ModuleType,
        geometry: Mapping[str, float],
        external: Mapping[str, Callable[[Array], Array]],
        basis: MovingBasis | None,
    ) -> None:
        self._geometry, self._external, self._basis = geometry, external, basis
        self._found: Remembered[dict[str, Array]] = Remembered(_nothing_yet)
        kernels = [name for name in module.RETURNS if name.endswith("_functions")]
        # Of each name the emitted function that returns it among others, and its arguments.
        self._functions: dict[str, tuple[Callable[..., Any], tuple[str, ...], list[str]]] = {}
        if hasattr(module, "BASIS"):
            if basis is None:
                raise bad("basis", "none", "shapes for the module's integrals", "pass a basis")
            kernels.append("place")
            names = module.RETURNS.get("basis_products", ())
            products = getattr(module, "basis_products", tuple)
            wanted = [*inspect.signature(products).parameters] if names else []
            self._functions |= dict.fromkeys(names, (products, names, wanted))
        for kernel in kernels:
            function, names = getattr(module, kernel), module.RETURNS[kernel]
            _, *wanted = inspect.signature(function).parameters
            missing = sorted(set(wanted) - {*geometry, *external})
            if missing:
                raise bad("geometry", f"none for {missing}", "a value each", "supply them")
            self._functions |= dict.fromkeys(names, (function, names, [_ANGLE, *wanted]))

    def __call__(self, name: str, theta: Array) -> Array:
        """Return an array at crank angles, ``(nt, ...)``."""
        found = self._found(theta)
        if name not in found:
            found |= self._computed(name, theta)
        return found[name]

    def _computed(self, name: str, theta: Array) -> dict[str, Array]:
        if name in self._external:
            return {name: self._external[name](theta)}
        if name not in self._functions:
            assert self._basis is not None
            return {name: self._basis.array(name, self("place", theta))}
        function, names, wanted = self._functions[name]
        found = _arrays_by_name(names, function(*(self._argument(w, theta) for w in wanted)))
        if name == "place" and theta.dtype != object:
            # A support at the very end, beyond it by rounding.
            round_off = 8.0 * float(np.finfo(float).eps)
            place = found[name]
            found[name] = np.where(place <= 1.0 + round_off, np.minimum(place, 1.0), place)
        return found

    def _argument(self, name: str, theta: Array) -> Any:
        if name == _ANGLE:
            return theta
        if name in self._geometry:
            # Of the kind of the angles: where these are balls, nothing is rounded.
            number = self._geometry[name]
            return 0.0 * theta + number if theta.dtype == object else number
        if name in self._external:
            return self(name, theta)
        vector, _, side = name.rpartition("_")
        return self(vector, theta)[(..., None) if side == "row" else (..., None, slice(None))]


def _nothing_yet(theta: Array) -> dict[str, Array]:
    return {}


def _arrays_by_name(names: tuple[str, ...], values: Any) -> dict[str, Array]:
    return {name: np.asarray(value) for name, value in by_name(names, values).items()}


def by_name(names: tuple[str, ...], values: Any) -> dict[str, Any]:
    """Return what an emitted function gave by name; a single value stands alone."""
    return dict(zip(names, (values,) if len(names) == 1 else values, strict=True))


def _multiplied(
    factor: Callable[[Array], Array], modal: Array | Callable[[Array], Array], theta: Array
) -> Array:
    """Return the array, or each array, times the value at its angle."""
    values, arrays = factor(theta), modal(theta) if callable(modal) else modal[None]
    return values.reshape(*values.shape, *(1,) * (arrays.ndim - 1)) * arrays
