"""Mass of a rigid link: mass, first moments and inertia in the link's own frame."""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping
from dataclasses import astuple, dataclass

from ..core.errors import bad, refuse
from ..core.inputs import number_problems


@dataclass(frozen=True)
class MassDistribution:
    """Mass, first moments and inertia of a link: all that its inertia forces depend on.

    The frame of a link has its origin at the link's first joint (crank: A; coupler and block: B;
    follower and rod: D; slider: C) and its x axis along the link.  Two distributions on one link
    add up to a third.

    Attributes
    ----------
    mass : float
        Mass [kg].
    along, across : float
        First moments [kg m] along and across the link: mass times the coordinates of the centre.
    inertia : float
        Moment of inertia [kg m^2] about the first joint (the I of Smith 4.4-4.6).

    Raises
    ------
    BadInput
        If a value is not a finite number, mass or inertia is negative, or no body has them:
        ``along^2 + across^2 > mass inertia``.

    Examples
    --------
    >>> import elastolink as el
    >>> bar = el.MassDistribution.uniform_bar(mass=3.0, length=0.5)
    >>> print(bar.centre, bar.inertia)
    (0.25, 0.0) 0.25
    >>> print((bar + el.MassDistribution.point(1.0, along=-0.75)).along)
    0.0
    """

    mass: float = 0.0
    along: float = 0.0
    across: float = 0.0
    inertia: float = 0.0

    def __post_init__(self) -> None:
        _require({"mass": self.mass, "inertia": self.inertia}, along=self.along, across=self.across)
        moment = math.hypot(self.along, self.across)
        most = math.sqrt(self.mass) * math.sqrt(self.inertia)
        root = moment / math.sqrt(self.mass) if self.mass > 0.0 else math.inf
        # Data with ten digits may lie this far beyond what a rigid body can have, and the least
        # inertia of a first moment may be below the normal numbers.
        if moment > most * (1.0 + 1e-9) and root * root >= sys.float_info.min:
            expected = f"at most sqrt(mass inertia) = {most:g} kg m"
            fix = "no body has these; give the inertia about the first joint of the link"
            raise bad("MassDistribution", f"first moment {moment:g} kg m", expected, fix)

    def __add__(self, other: MassDistribution) -> MassDistribution:
        """Return both together, fixed to one link."""
        if not isinstance(other, MassDistribution):
            return NotImplemented
        pairs = zip(astuple(self), astuple(other), strict=True)
        return MassDistribution(*(own + added for own, added in pairs))

    @property
    def centre(self) -> tuple[float, float]:
        """Coordinates [m] of the centre of mass; the first joint where there is no mass."""
        if self.mass == 0:
            return 0.0, 0.0
        return self.along / self.mass, self.across / self.mass

    @property
    def inertia_about_centre(self) -> float:
        """Moment of inertia [kg m^2] about the centre of mass, never below zero."""
        along, across = self.centre
        return max(self.inertia - along * self.along - across * self.across, 0.0)

    @classmethod
    def uniform_bar(cls, mass: float, length: float) -> MassDistribution:
        """Return a thin uniform bar [kg, m] from the first joint along the link.

        Raises ``BadInput`` if a value is not finite or is negative.
        """
        _require({"mass": mass, "length": length})
        return cls(mass, mass * length / 2.0, 0.0, mass * length * length / 3.0)

    @classmethod
    def point(cls, mass: float, along: float, across: float = 0.0) -> MassDistribution:
        """Return a point mass [kg] at a point [m] of the link's frame.

        Raises ``BadInput`` if a value is not finite, or the mass is negative.
        """
        return cls.about_centre(mass, along, across, 0.0)

    @classmethod
    def disc(
        cls, mass: float, radius: float, along: float, across: float = 0.0
    ) -> MassDistribution:
        """Return a uniform disc [kg, m] whose centre lies at a point [m] of the link's frame.

        Raises ``BadInput`` if a value is not finite, or mass or radius is negative.
        """
        _require({"mass": mass, "radius": radius})
        return cls.about_centre(mass, along, across, mass * radius * radius / 2.0)

    @classmethod
    def about_centre(
        cls, mass: float, along_distance: float, across_distance: float, inertia: float
    ) -> MassDistribution:
        """Return a body by its centre of mass and the inertia about it.

        Parameters
        ----------
        mass : float
            Mass [kg].
        along_distance, across_distance : float
            Centre of mass [m] in the link's frame.
        inertia : float
            Moment of inertia [kg m^2] about the centre of mass.

        Raises
        ------
        BadInput
            If a value is not finite, or mass or inertia is negative.
        """
        _require({"mass": mass, "inertia": inertia}, along=along_distance, across=across_distance)
        square = along_distance * along_distance + across_distance * across_distance
        return cls(mass, mass * along_distance, mass * across_distance, inertia + mass * square)


def _require(sizes: Mapping[str, object], **places: object) -> None:
    problems = number_problems("MassDistribution", sizes, "not negative")
    refuse(problems + number_problems("MassDistribution", places))
