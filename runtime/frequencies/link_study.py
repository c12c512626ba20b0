"""Mean natural frequencies against the lengths and sections of the links (Aannaque 9.2)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..beams.element_forms import required_structure
from ..beams.structure import Structure
from ..core.errors import bad
from ..core.families import Array, LinearPeriodic
from ..core.inputs import numbers, require_whole
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check, Result, provenance
from ..core.trigonometric import even_angles
from .held import held_frequencies, mean_frequencies

# Powers of thickness and width in area and second moment of a flat bar.
_POWERS: Mapping[str, tuple[int, int]] = {"thickness": (1, 3), "width": (1, 1)}
QUANTITIES = ("length", *_POWERS)


@dataclass(frozen=True, kw_only=True)
class LinkFrequencies(Result):
    """Mean natural frequencies of a mechanism against one number of one link.

    The error is that of ``mean`` [rad/s], ``(nv, count)``: of the integral and of round-off.
    """

    link: str
    quantity: str  # ``length`` [m], or ``thickness`` or ``width`` over the link's own
    value: Array  # its values, (nv,)
    mean: Array  # over the period, crank held, rank by rank [rad/s], (nv, count)
    # range over the period [rad/s], (nv, count), from 64 angles
    least: Array
    largest: Array
    # first frequency of each link by itself, pinned at both ends [rad/s], (nv, links)
    pinned: Array
    links: tuple[str, ...]

    arrays_along: ClassVar = {
        "value": "value",
        "value mode": "mean least largest error",
        "value link": "pinned",
    }
    column_units: ClassVar = {"rad/s": "least largest pinned error"}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the means with their ranges, and the pinned links dashed (Fig. 9.1)."""
        ax = axes_or_new(ax)
        for k in range(self.mean.shape[1]):
            colour = f"C{k}"
            ax.plot(self.value, self.mean[:, k], color=colour, label=f"mean of mode {k + 1}")
            ax.fill_between(
                self.value, self.least[:, k], self.largest[:, k], color=colour, alpha=0.15, lw=0
            )
        for name, values, style in zip(self.links, self.pinned.T, ("-.", "--", ":"), strict=False):
            ax.plot(self.value, values, style, color="0.3", lw=1.0, label=f"{name}, pinned")
        unit = "[m]" if self.quantity == "length" else "over its own"
        ax.set_xlabel(f"{self.quantity} of the {self.link} {unit}")
        top = 1.15 * float(np.max(self.largest))
        ax.set(ylabel="natural frequency [rad/s]", ylim=(0.0, top))
        ax.legend(fontsize=8)
        return ax


def link_frequencies(
    system: LinearPeriodic, link: str, quantity: str, value: ArrayLike, *, count: int = 1
) -> LinkFrequencies:
    """Return the mean natural frequencies against the length or section of a link of a linkage.

    All else stays: parameters, lumped masses, and weight and constant loads with the stiffening by
    their axial forces.

    Parameters
    ----------
    system : LinearPeriodic
        Of a linkage of beams.
    link, quantity : str
        ``length`` [m] of a link or the ``frame``; ``thickness`` or ``width`` of a flat bar over the
        link's own: the area goes with both, the second moment with the cube of the thickness.
    value : array_like, shape (nv,)
        Its values.
    count : int
        How many frequencies.

    Returns
    -------
    LinkFrequencies

    Raises
    ------
    BadInput
        If an argument is unusable, or with a value the crank cannot turn fully.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    >>> found = el.frequencies.link_frequencies(system, "coupler", "length", [0.4, 0.5])
    >>> print(found.mean.round(1).ravel())
    [183.9 183.2]
    """
    names = tuple(beam.name for beam in required_structure(system).beams)
    if not isinstance(quantity, str) or quantity not in QUANTITIES:
        raise bad("quantity", repr(quantity), f"one of {QUANTITIES}", "choose one")
    known = tuple(system.geometry) if quantity == "length" else names
    if not isinstance(link, str) or link not in known:
        raise bad("link", repr(link), f"one of {known}", "correct the name")
    values = np.atleast_1d(numbers("value", value))
    if values.ndim != 1 or not len(values) or not np.all(np.isfinite(values) & (values > 0)):
        raise bad("value", value, "positive numbers, one row", "correct them")
    require_whole("count", count, 1, system.size)
    # What the factors of moduli and densities make of a beam's own frequency.
    given = system.parameters
    factor = np.sqrt(given.get("elasticity", 1.0) / given.get("distributed_mass", 1.0))
    rows, pinned = [], []
    for number in values:
        changed = _changed(system, link, quantity, float(number))
        beams = [(beam.section, beam.length) for beam in required_structure(changed).beams]
        squares = [s.bending_stiffness / s.mass_per_length / span**4 for s, span in beams]
        pinned.append(factor * np.pi**2 * np.sqrt(squares))
        # Means, their errors, and least and largest values over the period.
        mean, error = mean_frequencies(changed, count, 1e-8)
        seen = held_frequencies(changed, even_angles(changed.period, 64), {})[0][:, :count]
        rows.append((mean, error, seen.min(axis=0), seen.max(axis=0)))
    mean, error, least, largest = (np.stack([row[i] for row in rows]) for i in range(4))
    return LinkFrequencies(
        method="means over the period of the frequencies with the crank held",
        error=error,
        error_norm="absolute, of each mean [rad/s], as that of the finite elements",
        checks={"mean": Check(float(np.max(error / mean)), 1e-8)},
        provenance=provenance(system.provenance),
        link=link,
        quantity=quantity,
        value=values,
        mean=mean,
        least=least,
        largest=largest,
        pinned=np.array(pinned),
        links=names,
    )


def _changed(system: LinearPeriodic, link: str, quantity: str, value: float) -> LinearPeriodic:
    """Return the system with another length of a link, or its thickness or width times a value."""
    if quantity == "length":
        return system.with_geometry(**{link: value})
    area, second = (value**power for power in _POWERS[quantity])

    def change(structure: Structure) -> Structure:
        beam = structure.beam(link)
        section, shear = beam.section, beam.section.shear_stiffness
        made = replace(
            section,
            area=section.area * area,
            second_moment=section.second_moment * second,
            # k G A goes with the area.
            shear_stiffness=None if shear is None else shear * area,
        )
        changed = replace(beam, section=made)
        beams = tuple(changed if one is beam else one for one in structure.beams)
        return replace(structure, beams=beams)

    return system.remeshed(change)
