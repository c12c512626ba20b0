"""Structures of beams from the linkages of one loop."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from ..core.errors import Problem, bad, refuse
from ..core.families import LinearPeriodic
from ..core.inputs import require_kind, require_mapping
from ..linkages import FourBar, Linkage, QuickReturn, SliderCrank
from ..linkages.linkage import LinkMotion
from .assembly import Array
from .linear import linear_system
from .section import Section
from .structure import (
    DIRECTIONS,
    Structure,
    missing_problems,
    node_value_problems,
    structure_of,
)

# The crank turns with its shaft; pins to the frame hold a place; a slider moves along x.
_HELD: Mapping[type[Linkage], Mapping[str, tuple[str, ...]]] = {
    FourBar: {"A": DIRECTIONS, "D": ("x", "y")},
    SliderCrank: {"A": DIRECTIONS, "C": ("y",)},
    QuickReturn: {"A": DIRECTIONS, "D": ("x", "y")},
}
# Pins that slide along a bar.
_SLIDING: Mapping[type[Linkage], Mapping[str, str]] = {QuickReturn: {"B": "rod"}}


def beam_linkage(
    linkage: Linkage,
    sections: Mapping[str, Section],
    *,
    elements: int | Mapping[str, int | tuple[float, ...]] = 3,
    kind: str = "cubic",
    joint_masses: Mapping[str, float] | None = None,
    nodes: Mapping[str, Mapping[str, Any]] | None = None,
    provenance: Mapping[str, str] | None = None,
) -> Structure:
    """Return a linkage all of whose links are beams.

    The crank is clamped to a shaft that turns as prescribed; the other joints are pins.  The block
    of a quick-return is one that slides along the rod without friction, a point of mass.

    Parameters
    ----------
    linkage, sections, elements, kind, joint_masses, nodes, provenance
        As :func:`linkage_system`.

    Returns
    -------
    Structure

    Raises
    ------
    BadInput
        As :func:`linkage_system`.

    Examples
    --------
    >>> import elastolink as el
    >>> bar = el.Section.rectangle(0.025, 0.006, modulus=71e9, density=2710.0)
    >>> linkage = el.FourBar(frame=0.25, crank=0.11, coupler=0.28, follower=0.27)
    >>> structure = el.beams.beam_linkage(linkage, dict.fromkeys(linkage.links, bar), elements=1)
    >>> print(structure.size, structure.labels[:4])
    9 ('B.x', 'B.y', 'B.crank', 'B.coupler')
    """
    if type(linkage) not in _HELD:
        found = type(linkage).__name__
        expected = f"one of {', '.join(known.__name__ for known in _HELD)}"
        raise bad("beam_linkage", found, expected, "make a Structure from its beams and nodes")
    linkage.require_full_turn()
    # The links that bend: a slider and a block have one joint.
    bars = {name: (ends[0], ends[1]) for name, ends in linkage.bars.items() if len(ends) == 2}
    _check_names(bars, sections, elements, joint_masses, nodes)
    lengths = {name: float(linkage.lengths[name]) for name in bars}
    own: dict[str, dict[str, Any]] = {}
    for letter in _letters(bars):
        own[letter] = {
            "held": _HELD[type(linkage)].get(letter, ()),
            "slides_on": _SLIDING.get(type(linkage), {}).get(letter),
            "mass": (joint_masses or {}).get(letter, 0.0),
            **(nodes or {}).get(letter, {}),
        }
    motion = partial(_configuration, linkage, tuple(bars))
    told = {**(provenance or {}), **linkage.provenance}
    return structure_of(
        bars, lengths, sections, elements, kind, own, configuration=motion, provenance=told
    )


def linkage_system(
    linkage: Linkage,
    sections: Mapping[str, Section],
    *,
    form: str = "full",
    geometric_stiffness: bool = True,
    rayleigh: tuple[float, float] = (0.0, 0.0),
    gravity: tuple[float, float] = (0.0, 0.0),
    **structure: Any,
) -> LinearPeriodic:
    """Return the vibration of a linkage of beams, with its lengths as geometry to vary.

    Parameters
    ----------
    linkage : FourBar, SliderCrank or QuickReturn
        Lengths and assembly; the crank must be able to turn fully.
    sections : mapping of str to Section
        By link: crank, coupler and, of a four-bar, follower; of a quick-return crank and rod.
    form, geometric_stiffness, rayleigh, gravity
        As :func:`linear_system` takes them.
    elements : int or mapping
        Number of elements of every link, or by link as :class:`Beam` takes them; 3 by default.
    kind : str
        Element: ``cubic``, the default, ``internal_node``, ``curvature`` or ``timoshenko``.
    joint_masses : mapping of str to float, optional
        Lumped masses [kg] by joint: A, B, C, D; of a slider-crank's slider at C.
    nodes : mapping of str to mapping, optional
        By joint, values of :class:`Node` that replace those of the linkage: ``{"A": {"held":
        ("x", "y"), "stiffness": {"rotation": 2e4}}}`` puts the crank on a sprung shaft, ``{"D":
        {"held": ("y",), "stiffness": {"x": 1e6}}}`` the follower's pivot on a spring.
    provenance : mapping, optional
        Scene and options to record.

    Returns
    -------
    LinearPeriodic
        ``with_geometry(frame=0.6)`` is the same linkage with another length.

    Raises
    ------
    BadInput
        If the linkage is of another kind or its crank cannot turn fully, a link has no section, a
        name or value is unusable, or a motion of the structure meets no stiffness.

    Examples
    --------
    >>> import elastolink as el
    >>> bar = el.Section.rectangle(0.025, 0.006, modulus=71e9, density=2710.0)
    >>> linkage = el.FourBar(frame=0.25, crank=0.11, coupler=0.28, follower=0.27)
    >>> system = el.linkage_system(linkage, dict.fromkeys(linkage.links, bar), elements=1)
    >>> print(system.size, el.natural_frequencies(system, 0.0, count=2).frequency.round(1))
    9 [[ 448.5 1264.2]]
    """
    options = {
        "form": form,
        "geometric_stiffness": geometric_stiffness,
        "rayleigh": rayleigh,
        "gravity": gravity,
    }
    require_kind("linkage", linkage, Linkage, "make a FourBar, SliderCrank or QuickReturn")
    return _made(linkage, sections, structure, options, linkage.lengths)


def _made(
    linkage: Linkage,
    sections: Mapping[str, Section],
    structure: Mapping[str, Any],
    options: Mapping[str, Any],
    geometry: Mapping[str, float],
) -> LinearPeriodic:
    changed = replace(linkage, **geometry)  # type: ignore[type-var]
    system = linear_system(beam_linkage(changed, sections, **structure), **options)
    rebuild = partial(_made, linkage, sections, structure, options)
    return replace(system, geometry=dict(geometry), rebuild=rebuild)


def _letters(bars: Mapping[str, tuple[str, str]]) -> tuple[str, ...]:
    return tuple(sorted({letter for pair in bars.values() for letter in pair}))


def _configuration(
    linkage: Linkage, names: tuple[str, ...], theta: Array
) -> Mapping[str, LinkMotion]:
    motion = linkage.motion(theta)
    return {name: motion.link(name) for name in names}


def _check_names(
    bars: Mapping[str, tuple[str, str]],
    sections: Mapping[str, Section],
    elements: object,
    masses: Mapping[str, float] | None,
    nodes: Mapping[str, Mapping[str, Any]] | None,
) -> None:
    require_mapping("sections", sections, 'say {"crank": Section(...), ...}')
    if masses is not None:
        require_mapping("joint_masses", masses, 'say {"B": 0.2}, for example')
    problems = node_value_problems(nodes)
    refuse(problems)
    links, letters = set(bars), set(_letters(bars))
    known = {
        "sections": (set(sections), links),
        "elements": (set(elements) if isinstance(elements, Mapping) else links, links),
        "joint_masses": (set(masses or {}), letters),
        "nodes": (set(nodes or {}), letters),
    }
    for name, (found, expected) in known.items():
        strange = sorted(map(str, found - expected))
        if strange:
            expectation = f"some of {sorted(expected)}"
            problems.append(Problem(name, ", ".join(strange), expectation, "correct the name"))
    problems += missing_problems("sections", sections, links)
    refuse(problems + missing_problems("elements", elements, links))
