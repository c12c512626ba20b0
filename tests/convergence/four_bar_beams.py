"""The four-bar of Table 4.1 (Aannaque), all links beams: a system for tests of the response."""

from functools import cache

import elastolink as el
from elastolink.runtime.beams.linear import linear_system
from elastolink.runtime.beams.linkages import beam_linkage
from elastolink.runtime.beams.section import Section
from elastolink.runtime.systems import with_modal_damping

# Areas [m^2], second moments [m^4], thicknesses [m].
SECTIONS = {
    "crank": (157.5e-6, 520.47e-12, 6.35e-3),
    "coupler": (85.5e-6, 83.34e-12, 3.42e-3),
    "follower": (78.75e-6, 65.12e-12, 3.15e-3),
}


@cache
def four_bar(elements=1, damping=0.02, coupler=0.328, kind="cubic"):
    """Return the linkage's vibration, with the same damping ratio in all modes."""
    sections = {
        link: Section(
            area=area, second_moment=moment, thickness=thickness, modulus=210e9, density=7850.0
        )
        for link, (area, moment, thickness) in SECTIONS.items()
    }
    linkage = el.FourBar(frame=0.547, crank=0.170, coupler=coupler, follower=0.525)
    joints = {"B": 0.174, "C": 0.174}
    structure = beam_linkage(linkage, sections, elements=elements, kind=kind, joint_masses=joints)
    system = linear_system(structure)
    return with_modal_damping(system, damping) if damping else system
