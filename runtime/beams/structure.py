"""Planar structures of beams: nodes, beams between them, and how the rigid beams move."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property
from itertools import pairwise
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..core.errors import Problem, bad, refuse, shown
from ..core.inputs import are_finite, is_finite, names_problems, require_kind, text_problems
from ..linkages.linkage import LinkMotion
from .elements import KINDS
from .section import Section

Indices = NDArray[np.int64]
# Elements of a beam: matrices of some thousands of coordinates.
_MOST_ELEMENTS = 1000


@dataclass(frozen=True)
class Freedom:
    """One coordinate: its name, a beam that has it, where on that beam [m], and its kind.

    ``part`` is ``x`` or ``y``, a displacement along the fixed axes [m]; ``rotation`` [rad];
    ``across``, a displacement across the beam [m]; ``curvature`` of the beam's deflection [1/m].
    One that is held is 0 at all times.
    """

    label: str
    beam: str
    along: float
    part: str
    held: bool = False


@dataclass(frozen=True)
class PlacedElement:
    """An element of a beam with its coordinates."""

    beam: Beam
    number: int  # which of the beam's elements, from 0
    # where it begins along the beam, and its length [m]
    start: float
    length: float
    indices: Indices  # places of its coordinates among all, in the element's own order


@dataclass(frozen=True)
class Freedoms:
    """All coordinates of a structure, held ones included."""

    all: tuple[Freedom, ...]
    free: Indices  # places of those that are not held
    elements: tuple[PlacedElement, ...]  # beam by beam
    # from a node and ``x``, ``y`` or a beam (its rotation there) to the coordinate's place
    places: dict[tuple[str, str], int]

    @property
    def free_labels(self) -> tuple[str, ...]:
        """Names of the free coordinates."""
        return tuple(self.all[i].label for i in self.free)


class _Numbering:
    """Coordinates as they are met."""

    def __init__(self) -> None:
        self.found: list[Freedom] = []
        self.places: dict[tuple[str, str], int] = {}

    def add(
        self, label: str, beam: Beam, place: Node | float, part: str, held: bool = False
    ) -> int:
        if isinstance(place, Node):
            place = 0.0 if beam.start == place.name else beam.length
        self.found.append(Freedom(label, beam.name, float(place), part, held))
        return len(self.found) - 1

    def node(self, node: Node, beams: Sequence[Beam]) -> None:
        """Add the displacement of a node, and the rotations of the beams that meet there."""
        for part in ("x", "y"):
            held = part in node.held
            place = self.add(f"{node.name}.{part}", beams[0], node, part, held)
            self.places[node.name, part] = place
        for beam in beams:
            shared = beam.name in node.joined
            if shared and node.joined[0] != beam.name:
                continue
            held = "rotation" in node.held and (shared or not node.joined)
            label = f"{node.name}.{'rotation' if shared else beam.name}"
            place = self.add(label, beam, node, "rotation", held)
            for name in node.joined if shared else (beam.name,):
                self.places[node.name, name] = place

    def end(self, beam: Beam, node: Node) -> list[int]:
        """Return the coordinates of a beam's end; its curvature there is added."""
        point = [self.places[node.name, part] for part in ("x", "y", beam.name)]
        if beam.kind == "curvature":
            # It is 0 where nothing takes a moment.
            loaded = self.found[point[2]].held or beam.name in node.joined
            if node.carried_by in (None, beam.name):
                springs = (group.get("rotation") for group in (node.stiffness, node.damping))
                loaded |= bool(node.inertia) or any(springs)
            label = f"{node.name}.{beam.name}.curvature"
            point.append(self.add(label, beam, node, "curvature", not loaded))
        return point

    def beam(self, beam: Beam, nodes: dict[str, Node]) -> list[PlacedElement]:
        """Add the inside of a beam and return its elements."""
        places = beam.places
        points = [self.end(beam, nodes[beam.start])]
        parts = (*DIRECTIONS, "curvature") if beam.kind == "curvature" else DIRECTIONS
        for k in range(1, len(places) - 1):
            at = places[k]
            points.append([self.add(f"{beam.name}.{k}.{part}", beam, at, part) for part in parts])
        points.append(self.end(beam, nodes[beam.end]))
        found = []
        for k, (start, stop) in enumerate(pairwise(places)):
            left, right = points[k], points[k + 1]
            indices = [*left[:3], *right[:3], *left[3:], *right[3:]]
            if beam.kind == "internal_node":
                middle = (start + stop) / 2.0
                for part in ("across", "rotation"):
                    label = f"{beam.name}.{k + 1}m.{part}"
                    indices.append(self.add(label, beam, middle, part))
            order = np.array(indices, dtype=np.int64)
            found.append(PlacedElement(beam, k, float(start), float(stop - start), order))
        return found


def number_freedoms(beams: Sequence[Beam], nodes: Sequence[Node]) -> Freedoms:
    """Return the numbering of all coordinates: node by node, then the inside of each beam."""
    numbering = _Numbering()
    for node in nodes:
        numbering.node(node, [b for b in beams if node.name in (b.start, b.end)])
    known = {node.name: node for node in nodes}
    elements = [element for beam in beams for element in numbering.beam(beam, known)]
    free = [i for i, freedom in enumerate(numbering.found) if not freedom.held]
    if not free:
        raise bad("structure", "every coordinate held", "something that moves", "free a node")
    return Freedoms(
        tuple(numbering.found), np.array(free, dtype=np.int64), tuple(elements), numbering.places
    )


Array = NDArray[np.float64]
Configuration = Callable[[Array], Mapping[str, LinkMotion]]
_Item = TypeVar("_Item", "Beam", "Node")

DIRECTIONS = ("x", "y", "rotation")
# Ends of beams that meet at a node may be so far apart, over the longest beam.
_CLOSURE = 1e-9


@dataclass(frozen=True, kw_only=True)
class Beam:
    """A uniform straight beam between two nodes.

    Parameters
    ----------
    name : str
        Its name.
    start, end : str
        Names of the nodes at its ends; x runs from the first to the second.
    section : Section
        Section and material.
    length : float
        Length [m].
    elements : int or sequence of float
        Number of equal elements, or their shares of the length, which add up to 1.
    kind : str
        Element: ``cubic``, ``internal_node``, ``curvature`` or ``timoshenko``.

    Raises
    ------
    BadInput
        If a value is unusable; every problem is listed.

    Examples
    --------
    >>> import elastolink as el
    >>> bar = el.Section.rectangle(0.02, 0.01, modulus=210e9, density=7850.0)
    >>> print(el.Beam(name="coupler", start="B", end="C", section=bar, length=0.4).kind)
    cubic
    """

    name: str
    start: str
    end: str
    section: Section
    length: float
    elements: int | tuple[float, ...] = 3
    kind: str = "cubic"

    def __post_init__(self) -> None:
        refuse(text_problems("Beam", name=self.name, start=self.start, end=self.end))
        where = f"beam {self.name}"
        problems = []
        if not (is_finite(self.length) and self.length > 0):
            fix = "a beam of no length cannot bend: join its nodes"
            problems.append(Problem(f"{where}: length", repr(self.length), "positive", fix))
        if self.start == self.end:
            problems.append(Problem(where, f"both ends at {self.start}", "two nodes", "name both"))
        if self.kind not in KINDS:
            problems.append(Problem(f"{where}: kind", repr(self.kind), f"one of {KINDS}", "choose"))
        if not isinstance(self.section, Section):
            found = type(self.section).__name__
            problems.append(Problem(f"{where}: section", found, "a Section", "make one"))
        elif self.kind == "timoshenko" and self.section.shear_stiffness is None:
            fix = "give Section.shear_stiffness, or poisson to Section.rectangle"
            problems.append(Problem(where, "no shear stiffness", "one for 'timoshenko'", fix))
        problems += _division_problems(where, self.elements)
        refuse(problems)
        if not isinstance(self.elements, int):
            object.__setattr__(self, "elements", tuple(float(part) for part in self.elements))

    @property
    def places(self) -> Array:
        """Places of the element ends along the beam [m], from 0 to the length."""
        if isinstance(self.elements, int):
            return np.linspace(0.0, self.length, self.elements + 1)
        inner = self.length * np.cumsum((0.0, *self.elements))
        inner[-1] = self.length
        return inner


@dataclass(frozen=True, kw_only=True)
class Node:
    """A point where beams meet: pinned to each other unless joined.

    Parameters
    ----------
    name : str
        Its name.
    mass : float
        Lumped mass [kg].
    inertia : float
        Lumped moment of inertia [kg m^2], turning with ``carried_by``.
    carried_by : str, optional
        Beam whose rotation turns the inertia; by default the joined ones, or the only one.
    joined : tuple of str
        Beams that share one rotation here; all others have a rotation each.
    held : tuple of str
        Of ``x``, ``y`` and ``rotation``, those whose elastic displacement is 0; the rotation is
        that of the joined beams, of all where none is joined.
    stiffness, damping : mapping of str to float
        Springs [N/m, N m/rad] and dampers [N s/m, N m s/rad] on ``x``, ``y``, ``rotation``, which
        act on the elastic displacement.
    force : pair of float
        Constant load [N] in the fixed axes.
    slides_on : str, optional
        Beam along which the node slides without friction.

    Raises
    ------
    BadInput
        If a value is unusable; every problem is listed.

    Examples
    --------
    >>> import elastolink as el
    >>> pin = el.Node(name="B", mass=0.05, joined=("crank", "coupler"))
    >>> print(pin.mass, pin.joined)
    0.05 ('crank', 'coupler')
    """

    name: str
    mass: float = 0.0
    inertia: float = 0.0
    carried_by: str | None = None
    joined: tuple[str, ...] = ()
    held: tuple[str, ...] = ()
    stiffness: Mapping[str, float] = field(default_factory=dict)
    damping: Mapping[str, float] = field(default_factory=dict)
    force: tuple[float, float] = (0.0, 0.0)
    slides_on: str | None = None

    def __post_init__(self) -> None:
        refuse(text_problems("Node", name=self.name))
        where = f"node {self.name}"
        values = {"mass": self.mass, "inertia": self.inertia}
        for group in ("stiffness", "damping"):
            if not isinstance(getattr(self, group), Mapping):
                found, fix = repr(getattr(self, group)), 'say {"x": 1e6}, for example'
                raise bad(f"{where}: {group}", found, "values by direction", fix)
            values |= {f"{group} along {k}": v for k, v in getattr(self, group).items()}
        problems = [
            Problem(f"{where}: {name}", repr(value), "a number, 0 or more", "correct the sign")
            for name, value in values.items()
            if not (is_finite(value) and value >= 0)
        ]
        unnamed = names_problems(f"{where}: held", self.held)
        held = () if unnamed else self.held
        problems += unnamed + names_problems(f"{where}: joined", self.joined)
        strange = {*held, *self.stiffness, *self.damping} - set(DIRECTIONS)
        if strange:
            found = ", ".join(sorted(map(str, strange)))
            problems.append(Problem(where, found, f"some of {DIRECTIONS}", "correct the name"))
        if not are_finite(self.force, 2):
            problems.append(
                Problem(f"{where}: force", str(self.force), "two numbers", "correct it")
            )
        refuse(problems)


@dataclass(frozen=True, kw_only=True)
class Structure:
    """A linkage or a frame of beams.

    Parameters
    ----------
    beams : tuple of Beam
        The beams.
    nodes : tuple of Node
        The nodes.
    configuration : callable
        Crank angles ``(nt,)`` [rad] to the motion of each rigid beam, by name, at unit crank
        speed: its origin at the start node.
    period : float
        Period of the motion in the crank angle [rad].
    moving : bool
        Whether anything moves.
    provenance : mapping of str to str
        Where it comes from.

    Raises
    ------
    BadInput
        If names are unknown or occur twice, a node has no beam, or ends that should meet do not.

    Examples
    --------
    >>> import elastolink as el
    >>> structure = el.load_scene("aannaque_1996_table_4_1").system().structure
    >>> print([beam.name for beam in structure.beams], structure.size, structure.labels[:3])
    ['crank', 'coupler', 'follower'] 27 ('B.x', 'B.y', 'B.crank')
    """

    beams: tuple[Beam, ...]
    nodes: tuple[Node, ...]
    configuration: Configuration
    period: float = 2.0 * np.pi
    moving: bool = True
    provenance: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for what, given, kind in (("beams", self.beams, Beam), ("nodes", self.nodes, Node)):
            require_kind(what, given, (tuple, list), "give them in a row")
            for one in given:
                require_kind(what, one, kind, f"make each with {kind.__name__}")
        refuse(_name_problems(self.beams, self.nodes))
        self._require_connected()
        self._require_closed()

    @cached_property
    def freedoms(self) -> Freedoms:
        """Numbering of all coordinates, held ones included."""
        return number_freedoms(self.beams, self.nodes)

    @property
    def labels(self) -> tuple[str, ...]:
        """Names of the free coordinates.

        ``B.x``, ``B.y`` [m]; ``B.crank``, the rotation of the crank at B [rad]; ``crank.1.x`` of
        its first inner node.  Of a node B that slides along a beam there is one displacement,
        ``B.along`` that beam [m].
        """
        found = self.freedoms.free_labels
        for name in self.sliding:
            kept = (label for label in found if label != f"{name}.y")
            found = tuple(f"{name}.along" if label == f"{name}.x" else label for label in kept)
        return found

    @property
    def sliding(self) -> tuple[str, ...]:
        """Names of the nodes that slide along a beam: none or one."""
        return tuple(node.name for node in self.nodes if node.slides_on is not None)

    @property
    def size(self) -> int:
        """Number of free coordinates."""
        return len(self.freedoms.free) - len(self.sliding)

    @property
    def elements(self) -> tuple[PlacedElement, ...]:
        """The elements, beam by beam, with their places and coordinates."""
        return self.freedoms.elements

    def beam(self, name: str) -> Beam:
        """Return a beam by name.

        Raises ``BadInput`` if there is none of that name.
        """
        return _named("beam", self.beams, name)

    def node(self, name: str) -> Node:
        """Return a node by name.

        Raises ``BadInput`` if there is none of that name.
        """
        return _named("node", self.nodes, name)

    def require_pinned(self, what: str) -> None:
        """Refuse a node that slides along a beam, with which ``what`` cannot be done."""
        for name in self.sliding:
            found = f"node {name}, which slides along beam {self.node(name).slides_on}"
            raise bad(what, found, "nodes that are pinned or joined", "use linear_system instead")

    def places(self, theta: Array) -> Mapping[str, Array]:
        """Return the rigid places of the nodes at crank angles ``(nt,)``: ``(nt, 2)`` each [m]."""
        motion = self.configuration(np.atleast_1d(np.asarray(theta, dtype=float)))
        found: dict[str, Array] = {}
        for beam in self.beams:
            for node, along in ((beam.start, 0.0), (beam.end, beam.length)):
                if node not in found:
                    found[node] = motion[beam.name].point(along).position
        return found

    def _require_connected(self) -> None:
        """Refuse parts that nothing connects: each would be a structure of its own."""
        reached = {self.beams[0].start}
        pairs = [{beam.start, beam.end} for beam in self.beams]
        pairs += [{n.name, self.beam(n.slides_on).start} for n in self.nodes if n.slides_on]
        growing = True
        while growing:
            new = {node for pair in pairs if reached & pair for node in pair}
            growing = not new <= reached
            reached |= new
        apart = sorted({node.name for node in self.nodes} - reached)
        if apart:
            found = f"nodes {', '.join(apart)} that nothing connects with {self.beams[0].start}"
            fix = "add the missing beam, or make two structures"
            raise bad("structure", found, "one connected structure", fix)

    def _require_closed(self) -> None:
        """Refuse beams whose ends do not meet at their nodes, at a few crank angles."""
        theta = self.period * np.array([0.0, 0.3, 0.7]) if self.moving else np.zeros(1)
        motion = self.configuration(theta)
        longest = max(beam.length for beam in self.beams)
        for beam in self.beams:
            if beam.name not in motion:
                fix = "let the configuration return it"
                raise bad("configuration", f"no motion of beam {beam.name}", "one", fix)
        places = self.places(theta)
        self._require_on_beam(motion, places, _CLOSURE * longest)
        for beam in self.beams:
            for node, along in ((beam.start, 0.0), (beam.end, beam.length)):
                gap = motion[beam.name].point(along).position - places[node]
                widest = float(np.max(np.abs(gap)))
                if not widest <= _CLOSURE * longest:
                    found = f"its end {widest:.3g} m away from node {node}"
                    fix = "let length, places and configuration agree"
                    raise bad(f"beam {beam.name}", found, "ends that meet", fix)

    def _require_on_beam(
        self, motion: Mapping[str, LinkMotion], places: Mapping[str, Array], allowed: float
    ) -> None:
        """Refuse a sliding node that does not lie on its beam."""
        for name in self.sliding:
            beam = self.beam(str(self.node(name).slides_on))
            link = motion[beam.name]
            axis = np.stack([np.cos(link.angle), np.sin(link.angle)], axis=-1)
            arm = places[name] - link.origin
            along = np.sum(arm * axis, axis=-1)
            beside = np.abs(arm[:, 1] * axis[:, 0] - arm[:, 0] * axis[:, 1])
            beyond = np.maximum(-along, along - beam.length)
            widest = float(max(np.max(beside), np.max(beyond)))
            if not widest <= allowed:
                found = f"{widest:.3g} m away from beam {beam.name}, on which it slides"
                fix = "let places and configuration agree"
                raise bad(f"node {name}", found, "a node on the beam", fix)


def structure_of(
    ends: Mapping[str, tuple[str, str]],
    lengths: Mapping[str, float],
    sections: Section | Mapping[str, Section],
    elements: int | Mapping[str, int | tuple[float, ...]],
    kind: str,
    nodes: Mapping[str, Mapping[str, Any]],
    **fields: Any,
) -> Structure:
    """Return a structure of beams between pairs of nodes, and of nodes with values by name.

    Beams have their own or the same section and elements; ``fields`` are others of it.
    """
    beams = tuple(
        Beam(
            name=name,
            start=start,
            end=end,
            section=sections[name] if isinstance(sections, Mapping) else sections,
            length=lengths[name],
            elements=elements[name] if isinstance(elements, Mapping) else elements,
            kind=kind,
        )
        for name, (start, end) in ends.items()
    )
    made = tuple(Node(name=name, **values) for name, values in nodes.items())
    return Structure(beams=beams, nodes=made, **fields)


def _named(what: str, items: tuple[_Item, ...], name: str) -> _Item:
    """Return the one of that name, or refuse the name."""
    for item in items:
        if item.name == name:
            return item
    known = ", ".join(item.name for item in items)
    raise bad(what, repr(name), f"one of {known}", "correct the name")


def node_value_problems(nodes: object) -> list[Problem]:
    """Return what is wrong with values for nodes, given by the names of both."""
    where = "nodes"
    if nodes is None:
        return []
    if not isinstance(nodes, Mapping) or not all(isinstance(v, Mapping) for v in nodes.values()):
        fix = 'say {"B": {"mass": 0.2}}, for example'
        return [Problem(where, repr(nodes), "mappings of values by node", fix)]
    known = sorted({item.name for item in fields(Node)} - {"name"})
    return [
        Problem(f"{where}.{name}", repr(key), f"one of {', '.join(known)}", "correct the name")
        for name, values in nodes.items()
        for key in values
        if key not in known
    ]


def missing_problems(where: str, given: object, names: Iterable[str]) -> list[Problem]:
    """Return what is wrong with values by name that lack some; one value for all lacks none."""
    missing = sorted(set(names) - set(given)) if isinstance(given, Mapping) else []
    found = f"none for {', '.join(missing)}"
    return [Problem(where, found, "one each", "add them")] if missing else []


def _division_problems(where: str, elements: Any) -> list[Problem]:
    name = f"{where}: elements"
    if isinstance(elements, int) and not isinstance(elements, bool):
        if 1 <= elements <= _MOST_ELEMENTS:
            return []
        return [Problem(name, shown(elements), f"1 to {_MOST_ELEMENTS}", "choose 3")]
    shares = tuple(elements) if isinstance(elements, (tuple, list, np.ndarray)) else ()
    if not shares or not all(is_finite(part) for part in shares):
        return [Problem(name, repr(elements), "a number or shares of the length", "choose 3")]
    if min(shares) <= 0:
        return [Problem(name, repr(elements), "positive shares", "leave the empty element out")]
    if abs(sum(shares) - 1.0) > 1e-12:
        return [Problem(name, f"shares that add up to {sum(shares):.6g}", "1", "scale them")]
    return []


def _name_problems(beams: tuple[Beam, ...], nodes: tuple[Node, ...]) -> list[Problem]:
    """Return what is wrong with the names of beams and nodes."""
    if not beams:
        return [Problem("structure", "no beam", "at least one", "add beams")]
    problems = []
    for kind, names in (("beam", [b.name for b in beams]), ("node", [n.name for n in nodes])):
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            found = f"{kind}s named twice: {', '.join(twice)}"
            problems.append(Problem("structure", found, "a name each", "rename one"))
    known = {node.name for node in nodes}
    problems += _sliding_problems(beams, nodes)
    for beam in beams:
        missing = sorted({beam.start, beam.end} - known)
        if missing:
            found = f"end at {', '.join(missing)}"
            fix = "add the node"
            problems.append(Problem(f"beam {beam.name}", found, "nodes that are there", fix))
    for node in nodes:
        meeting = [beam.name for beam in beams if node.name in (beam.start, beam.end)]
        named = {*node.joined, *([node.carried_by] if node.carried_by else [])}
        strange = sorted(named - set(meeting))
        where = f"node {node.name}"
        if not meeting:
            problems.append(Problem(where, "no beam", "a beam that ends there", "leave it out"))
        elif strange:
            found = f"{', '.join(strange)}, which does not end there"
            problems.append(Problem(where, found, f"some of {meeting}", "correct the name"))
    return problems


def _sliding_problems(beams: tuple[Beam, ...], nodes: tuple[Node, ...]) -> list[Problem]:
    """Return what is wrong with nodes that slide along a beam."""
    sliding = [node for node in nodes if node.slides_on is not None]
    problems = []
    if len(sliding) > 1:
        found = f"nodes {', '.join(node.name for node in sliding)} that slide"
        problems.append(Problem("structure", found, "one at most", "pin the others"))
    for node in sliding:
        where = f"node {node.name}: slides_on"
        own = [beam.name for beam in beams if node.name in (beam.start, beam.end)]
        others = [beam.name for beam in beams if beam.name not in own]
        if node.slides_on not in others:
            found = repr(node.slides_on)
            problems.append(Problem(where, found, f"one of {others}", "name another beam"))
        if {"x", "y"} & set(node.held):
            problems.append(Problem(where, "a node that is held", "a free one", "free x and y"))
    return problems
