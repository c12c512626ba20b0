"""The transverse vibration of the rod on a moving basis, as a linear periodic system."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from functools import partial
from importlib import import_module

from ....derive.spec import ModelSpec
from ...core.errors import bad
from ...core.families import LinearPeriodic
from ...core.inputs import require_one_of
from ...core.modules import EmittedModule, find_module
from ...linkages import QuickReturn
from ..assembly import assemble
from .basis import Array, MovingBasis, require_drop, require_numbers

DROPPED = ("frame", "tension")
# Bases by name: one needs nothing of the others.
BASES = {
    "overhang": (".overhang", "OverhangBasis"),
    "two_segment": (".polynomials", "TwoSegmentBasis"),
    "polynomial": (".polynomials", "PolynomialBasis"),
    "free_free": (".free_free", "FreeFreeBasis"),
}


def rod_system(
    basis: MovingBasis | str = "overhang",
    modes: int = 3,
    *,
    crank_ratio: float,
    frame: float,
    length: float,
    bending_stiffness: float,
    mass_per_length: float,
    damping: float = 0.0,
    internal_damping: float = 0.0,
    drop: Collection[str] = (),
    provenance: Mapping[str, str] | None = None,
) -> LinearPeriodic:
    """Return the vibration of the flexible rod of a quick-return (Beale & Scott (16), (18)).

    The coordinates are those of ``v = L sum_i q_i e_i``, the action has been divided by m L^3.

    Parameters
    ----------
    basis : {"overhang", "two_segment", "polynomial", "free_free"} or MovingBasis
        Shapes of the rod: the exact modes of the rod held still, polynomials on both sides of the
        block, the paper's polynomials, free-free modes bent through the block; or your own shapes.
    modes : int
        How many shapes; shapes of your own have their number.
    crank_ratio : float
        Crank length over base length G/a_x, positive; not 1.
    frame : float
        Base length a_x [m].
    length : float
        Length L of the rod from pin to tip [m].
    bending_stiffness : float
        EI [N m^2].
    mass_per_length : float
        m [kg/m].
    damping : float
        Viscous damping c per length, on dv/dt [N s/m^2].
    internal_damping : float
        Kelvin-Voigt damping c_i: the bending moment is ``EI v'' + c_i dv''/dt`` [N m^2 s].
    drop : collection of str
        Terms to leave out.  The centrifugal tension on v is the sum of ``tension``, on the
        deflection from Buckens' frame, and ``frame``, what that frame's small rotation adds.
        ``()`` keeps both; ``("frame", "tension")`` is the system as printed.
    provenance : mapping, optional
        Scene and options to record.

    Returns
    -------
    LinearPeriodic
        With parameters ``bending_stiffness mass_per_length damping internal_damping`` and
        geometry ``crank_ratio frame length``.

    Raises
    ------
    BadInput
        If a number is not usable, a basis or a term to drop is unknown, or the crank cannot turn
        fully with the block on the rod.

    Examples
    --------
    >>> import elastolink as el
    >>> numbers = {"crank_ratio": 0.1, "frame": 0.6, "length": 1.0}
    >>> numbers |= {"bending_stiffness": 36456.0, "mass_per_length": 7.15}
    >>> rod = el.systems.rod_system("overhang", 2, **numbers)
    >>> print(el.natural_frequencies(rod, 0.0).frequency.round(1))
    [[1004.7 2416.5]]
    """
    geometry = {"crank_ratio": crank_ratio, "frame": frame, "length": length}
    parameters = {
        "bending_stiffness": bending_stiffness,
        "mass_per_length": mass_per_length,
        "damping": damping,
        "internal_damping": internal_damping,
    }
    shapes: MovingBasis
    if isinstance(basis, str):
        require_one_of("basis", basis, BASES)
        module, kind = BASES[basis]
        shapes = getattr(import_module(module, __package__), kind)(modes)
    elif all(hasattr(basis, name) for name in ("array", "labels")):
        shapes = basis
    else:
        fix = f"choose one of {list(BASES)}"
        raise bad("basis", type(basis).__name__, "a name or a MovingBasis", fix)
    dropped = require_drop(drop, DROPPED)
    spec = ModelSpec("quick_return", "moving_basis", flexible=("rod",), drop=dropped)
    return _assembled(shapes, parameters, find_module(spec), dict(provenance or {}), geometry)


def _assembled(
    basis: MovingBasis,
    parameters: Mapping[str, float],
    emitted: EmittedModule,
    origin: Mapping[str, str],
    geometry: Mapping[str, float],
) -> LinearPeriodic:
    free = ("damping", "internal_damping")
    require_numbers({**parameters, **geometry}, zero=free)
    frame, length = float(geometry["frame"]), float(geometry["length"])
    linkage = QuickReturn(frame=frame, crank=float(geometry["crank_ratio"]) * frame, rod=length)
    linkage.require_full_turn()
    system = assemble(
        emitted.module,
        geometry={"frame": frame, "crank": linkage.crank, "length": length},
        parameters=parameters,
        basis=basis,
        drop=emitted.dropped,
        labels=basis.labels,
        reference_length=length,
        limits={name: "non-negative" if name in free else "positive" for name in parameters},
        rebuild=partial(_assembled, basis, parameters, emitted, origin),
        moving_shape=partial(_shapes, basis, linkage),
        provenance={**origin, **emitted.provenance},
    )
    return replace(system, geometry=dict(geometry))


def _shapes(basis: MovingBasis, linkage: QuickReturn, x: Array, theta: Array) -> Array:
    return basis.shapes(x, linkage.motion(theta).slide / linkage.rod)
