"""Beams of three layers with a viscoelastic core: equivalent stiffness and damping.

The layers bend together; the outer ones stretch, the core between them shears and loses energy.
Stiffness and loss depend on the wave length of the deflection.  Aannaque 9.2 proposes such links.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...generated import beam_section_sandwich
from ..core.errors import BadInput, bad, refuse
from ..core.inputs import is_finite, number_problems, require_kind, require_positive
from .section import Section

Array = NDArray[np.float64]

# Sizes beyond which products of them could leave the range of doubles.
_LARGEST = 1e18


@dataclass(frozen=True)
class ElasticLayer:
    """Outer layer of a sandwich; every number is positive.

    Attributes
    ----------
    thickness, modulus, density : float
        [m], [Pa], [kg/m^3].

    Examples
    --------
    >>> import elastolink as el
    >>> steel = el.beams.ElasticLayer(thickness=0.001, modulus=210e9, density=7850.0)
    >>> print(round(steel.thickness * steel.density, 3))
    7.85
    """

    thickness: float  # extent in the plane of bending [m]
    modulus: float  # Young's modulus [Pa]
    density: float  # mass per volume [kg/m^3]

    def __post_init__(self) -> None:
        refuse(number_problems("ElasticLayer", vars(self), "positive", _SI))


@dataclass(frozen=True)
class ViscoelasticLayer:
    """Core of a sandwich, of complex shear modulus ``shear_modulus (1 + i loss_factor)``.

    Attributes
    ----------
    thickness, shear_modulus, loss_factor, density : float
        [m], [Pa], none, [kg/m^3]; positive, but the loss factor may be 0.

    Examples
    --------
    >>> import elastolink as el
    >>> core = el.beams.ViscoelasticLayer(2e-4, shear_modulus=1e6, loss_factor=0.8, density=1e3)
    >>> print(core.shear_modulus * complex(1.0, core.loss_factor))
    (1000000+800000j)
    """

    thickness: float  # extent in the plane of bending [m]
    shear_modulus: float  # its real part [Pa]
    loss_factor: float  # imaginary part of the modulus over the real part
    density: float  # mass per volume [kg/m^3]

    def __post_init__(self) -> None:
        positive = dict(vars(self))
        free = {"loss_factor": positive.pop("loss_factor")}
        problems = number_problems("ViscoelasticLayer", positive, "positive", _SI)
        refuse(problems + number_problems("ViscoelasticLayer", free, "not negative"))


@dataclass(frozen=True)
class SandwichSection:
    """Equivalent uniform section of a sandwich at one wave number and one frequency."""

    bending_stiffness: float  # real part of EI [N m^2]
    loss_factor: float  # imaginary part of EI over its real part
    mass_per_length: float  # [kg/m]
    axial_stiffness: float  # EA of the outer layers [N]
    area: float  # of all layers [m^2]
    # [rad/m], and [rad/s], for which it holds
    wave_number: float
    frequency: float
    # EI without any resistance of the core to shear, and with a core rigid in shear [N m^2]
    slack: float
    bonded: float

    @property
    def retardation(self) -> float:
        """Tau [s] of the material of Kelvin and Voigt with the same loss at this frequency."""
        return self.loss_factor / self.frequency

    def section(self) -> Section:
        """Return a homogeneous section with the same EI, EA, mass per length and retardation.

        Its axial damping is that of bending, and it has no thickness: stresses in a sandwich do
        not follow from the distance to one axis.
        """
        modulus = self.axial_stiffness / self.area
        return Section(
            area=self.area,
            second_moment=self.bending_stiffness / modulus,
            modulus=modulus,
            density=self.mass_per_length / self.area,
            retardation=self.retardation,
        )


def sandwich_section(
    base: ElasticLayer,
    core: ViscoelasticLayer,
    cover: ElasticLayer,
    *,
    width: float,
    wave_number: float | None = None,
    frequency: float | None = None,
) -> SandwichSection:
    """Return the equivalent section of a three-layer beam (Aannaque 9.2).

    The outer layers do not shear and the core is not stretched: the model holds for a core that is
    soft beside the outer layers, and wave lengths long beside the thickness.

    Parameters
    ----------
    base, core, cover : ElasticLayer, ViscoelasticLayer, ElasticLayer
        The layers in order.
    width : float
        Across the plane of bending [m].
    wave_number, frequency : float, optional
        Of the deflection [rad/m], ``n pi / L`` for mode n of a pinned beam, and [rad/s]; where one
        of the two is left out it is that of free bending waves.

    Returns
    -------
    SandwichSection

    Raises
    ------
    BadInput
        If a number is not positive.

    Examples
    --------
    >>> import elastolink as el
    >>> steel = el.beams.ElasticLayer(0.001, modulus=210e9, density=7850.0)
    >>> core = el.beams.ViscoelasticLayer(0.0002, 1e6, loss_factor=0.8, density=1000.0)
    >>> section = el.beams.sandwich_section(steel, core, steel, width=0.02, wave_number=10.0)
    >>> print(round(section.bending_stiffness, 3), round(section.loss_factor, 3))
    1.803 0.275
    """
    for where, layer in (("base", base), ("cover", cover)):
        require_kind(where, layer, ElasticLayer, "make one with ElasticLayer")
    require_kind("core", core, ViscoelasticLayer, "make one with ViscoelasticLayer")
    given = {"width": width, "wave_number": wave_number, "frequency": frequency}
    numbers = {name: value for name, value in given.items() if value is not None or name == "width"}
    require_positive("sandwich_section", **numbers)
    mass = width * sum(layer.density * layer.thickness for layer in (base, core, cover))
    stiffness = _stiffness(base, core, cover, width)
    if wave_number is None:
        if frequency is None:
            raise bad("sandwich_section", "no wave number, no frequency", "one", "give one of them")
        wave_number = _free_wave(stiffness, mass, frequency)
    values = [float(value) for value in stiffness(wave_number)]
    if frequency is None:
        with np.errstate(all="ignore"):
            frequency = float(np.float64(wave_number) ** 2 * np.sqrt(values[0] / np.float64(mass)))
    outer = base.modulus * base.thickness + cover.modulus * cover.thickness
    found = SandwichSection(
        bending_stiffness=values[0],
        loss_factor=values[1],
        mass_per_length=mass,
        axial_stiffness=width * outer,
        area=width * (base.thickness + core.thickness + cover.thickness),
        wave_number=float(wave_number),
        frequency=float(frequency),
        slack=values[2],
        bonded=values[3],
    )
    sizes = (mass, found.axial_stiffness, found.area, found.frequency)
    if not all(is_finite(size) and size > 0 for size in sizes):
        raise _beyond(f"mass, EA, area and frequency {sizes}")
    return found


_SI = "give SI units"


def _stiffness(
    base: ElasticLayer, core: ViscoelasticLayer, cover: ElasticLayer, width: float
) -> Callable[[float], tuple[Array, ...]]:
    """Return the emitted function of the wave number alone, for sizes within doubles."""
    arguments = {
        "width": float(width),
        "base_modulus": float(base.modulus),
        "base_thickness": float(base.thickness),
        "core_shear_modulus": float(core.shear_modulus),
        "core_loss": float(core.loss_factor),
        "core_thickness": float(core.thickness),
        "cover_modulus": float(cover.modulus),
        "cover_thickness": float(cover.thickness),
    }

    def at(wave_number: float) -> tuple[Array, ...]:
        for name, size in {**arguments, "wave_number": wave_number}.items():
            lowest = 0.0 if name == "core_loss" else 1.0 / _LARGEST
            if not lowest <= size <= _LARGEST:
                raise _beyond(f"{name} of {size}")
        found: tuple[Array, ...] = beam_section_sandwich.sandwich(  # type: ignore[no-untyped-call]
            np.asarray(wave_number, dtype=float), **arguments
        )
        return found

    return at


def _beyond(found: str) -> BadInput:
    expected = f"sizes from {1.0 / _LARGEST:g} to {_LARGEST:g}"
    return bad("sandwich", found, expected, "give SI units")


def _free_wave(
    stiffness: Callable[[float], tuple[Array, ...]], mass: float, frequency: float
) -> float:
    """Return the wave number of free bending waves: ``k^4 EI(k) = m w^2``, EI between its limits.

    k^4 EI(k) grows with k, so that the root between the limits is the only one.
    """
    from scipy.optimize import brentq

    with np.errstate(all="ignore"):
        _, _, slack, bonded = stiffness(1.0)
        load = float(np.float64(mass) * np.float64(frequency) ** 2)
        ends = [float((load / limit) ** 0.25) for limit in (bonded, slack)]
    if not all(is_finite(end) and end > 0 for end in (load, *ends)):
        raise _beyond(f"free waves with wave numbers from {ends[0]} to {ends[1]}")
    wide = (ends[0] * (1.0 - 1e-12), ends[1] * (1.0 + 1e-12))

    def excess(wave_number: float) -> float:
        return float(wave_number**4 * stiffness(wave_number)[0] / load - 1.0)

    return float(brentq(excess, *wide, xtol=1e-15 * ends[0], rtol=4 * np.finfo(float).eps))
