"""Cross-section and material of a beam."""

from __future__ import annotations

from dataclasses import dataclass

from ..core.errors import bad, refuse
from ..core.inputs import is_finite, number_problems, require_positive


@dataclass(frozen=True, kw_only=True)
class Section:
    """Section and material of a uniform beam that bends in the plane of motion.

    Parameters
    ----------
    area : float
        Cross-section area A [m^2].
    second_moment : float
        Second moment of area I about the axis across the plane [m^4].
    modulus : float
        Young's modulus E [Pa].
    density : float
        Mass per volume rho [kg/m^3].
    thickness : float, optional
        Extent in the plane of motion [m]; the outer fibres lie half of it from the axis.  Needed
        for stresses alone.
    shear_stiffness : float, optional
        k G A [N], for Timoshenko's beam.
    retardation : float
        tau [s] of Kelvin and Voigt's material, ``stress = E (strain + tau d strain/dt)``.

    Raises
    ------
    BadInput
        If a number is not finite, or not positive (retardation: not negative); every problem is
        listed.

    Examples
    --------
    >>> import elastolink as el
    >>> bar = el.Section.rectangle(width=0.02, thickness=0.01, modulus=210e9, density=7850.0)
    >>> print(round(bar.bending_stiffness, 6), round(bar.mass_per_length, 6))
    350.0 1.57
    """

    area: float
    second_moment: float
    modulus: float
    density: float
    thickness: float | None = None
    shear_stiffness: float | None = None
    retardation: float = 0.0

    def __post_init__(self) -> None:
        names = ["area", "second_moment", "modulus", "density"]
        optional = ("thickness", "shear_stiffness")
        names += [name for name in optional if getattr(self, name) is not None]
        positive = {name: getattr(self, name) for name in names}
        fix = "give SI units, lengths in metres"
        problems = number_problems("Section", positive, "positive", fix)
        problems += number_problems("Section", {"retardation": self.retardation}, "not negative")
        refuse(problems)

    @classmethod
    def rectangle(
        cls,
        width: float,
        thickness: float,
        *,
        modulus: float,
        density: float,
        poisson: float | None = None,
        retardation: float = 0.0,
    ) -> Section:
        """Return the section of a flat bar.

        Parameters
        ----------
        width : float
            Extent across the plane of motion [m].
        thickness : float
            Extent in the plane of motion [m].
        modulus, density : float
            Young's modulus [Pa], mass per volume [kg/m^3].
        poisson : float, optional
            Poisson's ratio; with it the section gets the shear stiffness ``k G A`` with Cowper's
            ``k = 10 (1 + nu) / (12 + 11 nu)``.
        retardation : float
            tau [s] of Kelvin and Voigt's material.

        Raises
        ------
        BadInput
            If a number is not usable.
        """
        require_positive("Section.rectangle", width=width, thickness=thickness)
        shear = None
        if poisson is not None:
            if not (is_finite(poisson) and 0.0 <= poisson <= 0.5):
                where = "Section.rectangle: poisson"
                raise bad(where, repr(poisson), "a number from 0 to 0.5", "0.3 for steel")
            require_positive("Section.rectangle", modulus=modulus)
            factor = 10.0 * (1.0 + poisson) / (12.0 + 11.0 * poisson)
            shear = factor * modulus / (2.0 * (1.0 + poisson)) * width * thickness
        return cls(
            area=width * thickness,
            second_moment=width * thickness**3 / 12.0,
            modulus=modulus,
            density=density,
            thickness=thickness,
            shear_stiffness=shear,
            retardation=retardation,
        )

    @property
    def mass_per_length(self) -> float:
        """Rho A [kg/m]."""
        return self.density * self.area

    @property
    def axial_stiffness(self) -> float:
        """E A [N]."""
        return self.modulus * self.area

    @property
    def bending_stiffness(self) -> float:
        """E I [N m^2]."""
        return self.modulus * self.second_moment

    @property
    def rotary_inertia(self) -> float:
        """Rho I [kg m]."""
        return self.density * self.second_moment
