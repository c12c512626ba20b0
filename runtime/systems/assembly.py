"""From an emitted linear-periodic module and numbers to the system that the solvers take."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import bad
from ..families import MATRICES, LinearPeriodic, Term
from ..families.emitted import check_module

Array = NDArray[np.float64]


def assemble(
    module: ModuleType,
    *,
    geometry: Mapping[str, float],
    parameters: Mapping[str, float],
    modes: int | None = None,
    external: Mapping[str, Callable[[Array], Array]] | None = None,
    forcing: bool = True,
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
    forcing : bool
        Whether the forcing terms are taken along.
    **attributes
        Further attributes of :class:`~elastolink.runtime.families.LinearPeriodic`.

    Raises
    ------
    BadInput
        If the module is of another family, or a parameter, argument or function is missing.
    """
    check_module(module, "linear_periodic", parameters)
    missing = sorted(set(module.EXTERNAL) - set(external or {}))
    if missing:
        raise bad("external", f"none for {missing}", "a function of angle each", "pass them")
    modal = _modal_arrays(module, modes)
    shared = _angle_kernels(module, geometry, external or {})
    terms = []
    for array, power, scale, angle, mode in module.TERMS:
        if array in MATRICES or forcing:
            function = _function(angle, modal[mode], shared, external or {})
            terms.append(Term(array, scale, function, power))
    size = next(iter(modal.values())).shape[0]
    if modes is not None and modes != size:
        raise bad("modes", modes, f"{size}, the module's own", "ask for a module of that number")
    if "scales" in module.RETURNS:
        used = inspect.signature(module.scales).parameters
        fixed = {name: geometry[name] for name in used if name in geometry}
        # Parameters that no term uses (pruned, or forcing left out) stay known to the user.
        scales = _scales(module, tuple(name for name in used if name not in fixed), fixed)
    else:
        scales = _no_scales
    return LinearPeriodic(
        size=size, terms=tuple(terms), parameters=dict(parameters), scales=scales, **attributes
    )


def _no_scales(values: Mapping[str, ArrayLike]) -> Mapping[str, Array]:
    return {}


def _scales(
    module: ModuleType, names: tuple[str, ...], fixed: Mapping[str, float]
) -> Callable[[Mapping[str, ArrayLike]], Mapping[str, Array]]:
    returned = module.RETURNS["scales"]

    def evaluate(values: Mapping[str, ArrayLike]) -> Mapping[str, Array]:
        given = {name: np.asarray(values[name], dtype=float) for name in names}
        result = module.scales(**given, **fixed)
        if len(returned) == 1:
            result = (result,)
        return {name: np.asarray(v) for name, v in zip(returned, result, strict=True)}

    return evaluate


def _modal_arrays(module: ModuleType, modes: int | None) -> dict[str, Array]:
    found: dict[str, Array] = {}
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
        found |= {
            name: np.array(np.broadcast_to(value, shape), dtype=float)
            for name, value in zip(names, result, strict=True)
        }
    for _, _, _, _, name in module.TERMS:
        if name not in found:
            found[name] = np.array(getattr(module, name.upper()))
    return found


class _Shared:
    """An emitted function of angle, evaluated once for all the terms that ask at one array."""

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
        if self._last is None or not np.array_equal(self._last[0], theta):
            passed = {name: given(theta) for name, given in self._external.items()}
            result = self._function(theta, **self._fixed, **passed)
            values = (result,) if len(self.names) == 1 else result
            table = {n: np.asarray(v) for n, v in zip(self.names, values, strict=True)}
            self._last = (theta.copy(), table)
        return self._last[1]


def _angle_kernels(
    module: ModuleType,
    geometry: Mapping[str, float],
    external: Mapping[str, Callable[[Array], Array]],
) -> dict[str, _Shared]:
    """Return, for each function of angle, the emitted kernel that gives it."""
    found: dict[str, _Shared] = {}
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
        found |= dict.fromkeys(names, _Shared(function, names, fixed, passed))
    return found


def _function(
    angle: str | None,
    modal: Array,
    shared: Mapping[str, _Shared],
    external: Mapping[str, Callable[[Array], Array]],
) -> Array | Callable[[Array], Array]:
    """Return the constant modal array, or the function of angle that multiplies it."""
    if angle is None:
        return modal
    if angle in shared:
        kernel = shared[angle]
        return lambda theta: _outer(kernel(theta)[angle], modal)
    given = external[angle]
    return lambda theta: _outer(given(theta), modal)


def _outer(values: Array, modal: Array) -> Array:
    return values.reshape(*values.shape, *(1,) * modal.ndim) * modal
