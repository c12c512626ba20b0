"""The vibration of a structure of beams as a linear periodic system (Aannaque 4.31, 6.15, 7.1)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import BadInput, Problem, bad, refuse
from ..core.families import LinearPeriodic, Term
from ..core.inputs import are_finite
from ..core.trigonometric import Remembered
from .assembly import AngleArrays, Array, in_own_axes, rotation, turned
from .elements import shapes_of
from .structure import Freedoms, Structure


def relative_deflection(arrays: AngleArrays, slide: Slide | None, theta: Array) -> Array:
    """Return what turns coordinates into deflections across the beams over their lengths.

    Shape ``(nt, k, n)``: displacement across each element from its place on the rigid beam, at
    its middle and its end.
    """
    watched = np.array([0.5, 1.0])
    found = [
        arrays.rows(placed, shapes_of(placed, watched)["v"] / placed.beam.length, theta)
        for placed in arrays.structure.elements
    ]
    rows = np.concatenate(found, axis=1)
    return rows if slide is None else np.asarray(rows @ slide.basis(theta))


@dataclass(frozen=True, eq=False)
class AxialForces:
    """Axial forces along every element, and the geometric stiffness that they give.

    From the stiffness of springs ``(n, n)``, the lumped mass of every coordinate ``(N,)``, held
    ones included, gravity [m/s^2] in the fixed axes and, of a structure with a sliding pin, its
    slide.
    """

    arrays: AngleArrays
    springs: Array
    lumped: Array
    gravity: tuple[float, float]
    slide: Slide | None = None

    @cached_property
    def node_forces(self) -> Array:
        """Constant loads on the nodes, of every coordinate: ``(N,)``."""
        found = np.zeros(self.arrays.count)
        structure = self.arrays.structure
        for node in structure.nodes:
            for part, value in zip(("x", "y"), node.force, strict=True):
                found[structure.freedoms.places[node.name, part]] += value
        return found

    def force(self, source: str, theta: Array, derivative: int = 2) -> Array:
        """Return the generalised forces of a source at unit crank speed, ``(nt, n)``.

        Those of masses are ``-M r_r''``, or with the first derivative ``-M r_r'``.
        """
        free, motion = self.arrays.free, self.arrays.motion(theta)
        field = motion.second if derivative == 2 else motion.first
        if source == "distributed":
            return -self.arrays.distributed(field, theta)
        if source == "lumped":
            return np.asarray(-(field * self.lumped)[:, free])
        field = self.weight_field(theta)
        weight = self.arrays.distributed(field, theta) + (self.lumped * field)[:, free]
        return np.asarray(weight + self.node_forces[free])

    def weight_field(self, theta: Array) -> Array:
        """Return gravity as values of all coordinates, ``(nt, N)`` [m/s^2]."""
        x, y = self.gravity
        parts = {"x": x, "y": y}
        found = np.zeros((len(theta), self.arrays.count))
        for i, freedom in enumerate(self.arrays.structure.freedoms.all):
            found[:, i] = parts.get(freedom.part, 0.0)
            if freedom.part == "across":
                c, s = self.arrays.motion(theta).products[freedom.beam][:, 1:3].T
                found[:, i] = c * y - s * x
        return found

    def along(self, source: str, theta: Array) -> Array:
        """Return the axial forces of one source, tension positive: factors of 1, xi and xi^2.

        Shape ``(nt, elements, 3)``; ``distributed`` and ``lumped`` at unit crank speed [N s^2],
        ``static`` of weight and constant loads [N].
        """
        arrays = self.arrays
        q = np.zeros((len(theta), arrays.count))
        q[:, arrays.free] = self._at_rest(source, theta)[0]
        motion = arrays.motion(theta)
        # The acceleration that the beams' own mass resists; to lumped masses it is nothing.
        field = motion.second if source == "distributed" else np.zeros_like(q)
        if source == "static":
            field = -self.weight_field(theta)
        found = np.zeros((len(theta), len(arrays.local), 3))
        for e, (placed, own) in enumerate(arrays.local):
            c, s = motion.products[placed.beam.name][:, 1:3].T
            mass = placed.beam.section.mass_per_length * placed.length
            first, last = mass * in_own_axes(field[:, placed.indices], c, s)[:, [0, 3]].T
            local = in_own_axes(q[:, placed.indices], c, s)
            # The element is held at its first end by minus its axial force there.
            found[:, e, 0] = -(local @ own.stiffness[0] + first / 3.0 + last / 6.0)
            found[:, e, 1] = first
            found[:, e, 2] = (last - first) / 2.0
        return found

    def _at_rest(self, source: str, theta: Array) -> tuple[Array, Array]:
        """Return displacements under the loads, and what is left of elastic forces less loads."""
        stiffness = self.arrays.stiffness(theta) + self.springs
        loads = self.force(source, theta)[..., None]
        if self.slide is None:
            solved: Array = np.asarray(np.linalg.solve(stiffness, loads), dtype=float)
            return solved[..., 0], np.zeros(loads.shape[:2])
        basis = self.slide.basis(theta)
        turned = np.swapaxes(basis, -1, -2)
        q: Array = basis @ np.linalg.solve(turned @ stiffness @ basis, turned @ loads)
        rest: Array = stiffness @ q - loads
        return q[..., 0], rest[..., 0]

    def geometric(self, source: str, theta: Array) -> Array:
        """Return ``int P v'^2`` of the axial forces of one source, ``(nt, n, n)`` (4.38)."""
        arrays = self.arrays
        forces = self.along(source, theta)
        motion = arrays.motion(theta)
        total = np.zeros((len(theta), arrays.count, arrays.count))
        for e, (placed, _) in enumerate(arrays.local):
            kernel = self._kernels[e]
            weights = forces[:, e, :, None] * motion.products[placed.beam.name][:, None, :]
            rows, columns = np.ix_(placed.indices, placed.indices)
            total[:, rows, columns] += np.tensordot(weights, kernel, axes=2)
        rows, columns = np.ix_(arrays.free, arrays.free)
        found = np.ascontiguousarray(total[:, rows, columns])
        if self.slide is not None:
            found += self.slide.contact(self._at_rest(source, theta)[1], theta)
        return found

    @cached_property
    def _kernels(self) -> list[Array]:
        """Of each element, the geometric arrays turned: ``(3, 6, n, n)``."""
        found = []
        for _, own in self.arrays.local:
            r = rotation(len(own.mass))
            found.append(np.stack([turned(r, part, r) for part in own.geometric]))
        return found


def require_held(arrays: AngleArrays, springs: Array, slide: Slide | None) -> None:
    """Refuse a structure that can move without resistance, at a few angles of the crank.

    A motion that meets no stiffness, or one so much smaller than another's that their sum in
    doubles has no digit of it.
    """
    structure = arrays.structure
    theta = structure.period * np.array([0.0, 0.37, 0.61]) if structure.moving else np.zeros(1)
    matrices = arrays.sum("stiffness", theta) + np.diag(springs)
    strains = _strains(arrays, springs, theta)
    if slide is not None:
        basis = slide.basis(theta)
        matrices = np.swapaxes(basis, -1, -2) @ matrices @ basis
        strains = strains @ basis
    for angle, stiffness, strain in zip(theta, matrices, strains, strict=True):
        sizes = np.sqrt(np.diag(stiffness))
        loose: Iterable[int] = np.flatnonzero(sizes == 0.0)
        if not np.any(sizes == 0.0):
            values = np.linalg.eigvalsh(stiffness / np.outer(sizes, sizes))
            # A mode softer than this, over the stiffest, is taken for one that nothing resists.
            if values[0] > 1e-14 * len(values) * values[-1]:
                continue
            motion = _rigid_motion(strain)
            if motion is None:
                raise _lost_in_rounding(arrays)
            # The coordinates that have a tenth of the motion or more are named.
            loose = np.flatnonzero(motion > 0.1 * np.max(motion))
        names = ", ".join([structure.labels[i] for i in loose][:6])
        found = f"a motion of {names} that nothing resists at crank angle {angle:.4g}"
        fix = "hold a node, join beams, or add a spring"
        raise bad("structure", found, "a structure whose every motion is held or sprung", fix)


def _strains(arrays: AngleArrays, springs: Array, theta: Array) -> Array:
    """Return what each element and spring feels of the free coordinates, ``(nt, rows, n)``."""
    # Of an element: its stretch, the difference of its ends' rotations, and the rotation of its
    # chord against their mean, all times lengths.  Stiffnesses are not in it, so that a short
    # element is as good as a long one.
    elements = arrays.structure.elements
    longest = max(placed.length for placed in elements)
    rows = []
    for placed in elements:
        half = placed.length / 2.0
        own = np.zeros((3, 6))
        own[0, [0, 3]] = -1.0, 1.0
        own[1, [2, 5]] = -longest, longest
        own[2, [1, 4, 2, 5]] = -1.0, 1.0, -half, -half
        rows.append(arrays.rows(placed, own, theta))
    sprung = np.eye(len(springs))[springs > 0.0]
    rows.append(np.broadcast_to(sprung, (len(theta), *sprung.shape)))
    return np.concatenate(rows, axis=1)


def _rigid_motion(strain: Array) -> Array | None:
    """Return sizes of the coordinates in a motion that strains nothing; None where all do."""
    # What an element holds beside its ends moves with them or strains it: it is left out.
    felt = np.flatnonzero(np.any(strain != 0.0, axis=0))
    sizes = np.linalg.norm(strain[:, felt], axis=0)
    _, values, across = np.linalg.svd(strain[:, felt] / sizes)
    # Deformation of the elements, over the largest there can be, below which a motion has none.
    if len(values) == len(felt) and values[-1] > 1e-9 * values[0]:
        return None
    motion = np.zeros(strain.shape[1])
    motion[felt] = np.abs(across[-1] / sizes)
    return motion


def _lost_in_rounding(arrays: AngleArrays) -> BadInput:
    """Return the refusal that names the stiffest and the softest element."""
    stiff = [max(own.stiffness[0, 0], own.stiffness[1, 1]) for _, own in arrays.local]
    soft = [min(own.stiffness[0, 0], own.stiffness[1, 1]) for _, own in arrays.local]
    most, least = int(np.argmax(stiff)), int(np.argmin(soft))
    one, other = arrays.local[most][0], arrays.local[least][0]
    return bad(
        f"beam {one.beam.name}",
        f"an element of {one.length:.3g} m, {stiff[most] / soft[least]:.2g} times as stiff as one "
        f"of {other.length:.3g} m of beam {other.beam.name}: rounding of their sum leaves few "
        "digits, if any, of what resists the softest motion",
        "elements of like length and stiffness",
        "leave the short element out and join its ends, or make it longer",
    )


FORMS = ("full", "instantaneous")
# Factors of the structure's own numbers: of every modulus, density and lumped mass.
FACTORS = ("elasticity", "distributed_mass", "lumped_mass")


def linear_system(
    structure: Structure,
    *,
    form: str = "full",
    geometric_stiffness: bool = True,
    rayleigh: tuple[float, float] = (0.0, 0.0),
    gravity: tuple[float, float] = (0.0, 0.0),
) -> LinearPeriodic:
    """Return the vibration of a structure about its rigid-body motion.

    Coordinates are the elastic displacements of the nodes along the fixed axes [m] and the
    rotations [rad], see ``structure.labels``.

    Parameters
    ----------
    structure : Structure
        A linkage or a frame, for example from :func:`beam_linkage`.
    form : str
        ``"full"``: all terms of the Lagrangian (4.27).  ``"instantaneous"``: Coriolis,
        centripetal and Euler terms of the elastic motion left out, as in (7.1); it is not
        conservative.
    geometric_stiffness : bool
        Whether axial forces stiffen the beams (4.38): those of the rigid-body motion, and of
        weight and constant loads.
    rayleigh : pair of float
        a [1/s] and b [s] of ``C = a M + b K``.
    gravity : pair of float
        Acceleration of gravity [m/s^2] along the fixed axes.

    Returns
    -------
    LinearPeriodic
        With the factors ``elasticity``, ``distributed_mass`` and ``lumped_mass`` (1) as
        parameters, ``rayleigh_mass`` and ``rayleigh_stiffness`` (a, b) where given, ``retardation``
        (factor, 1) where a material is viscous.  Add modal damping with ``with_modal_damping``.
        With a sliding pin it keeps no structure: stresses cannot be computed.

    Raises
    ------
    BadInput
        If an argument is unusable, or a motion of the structure meets no stiffness.

    Examples
    --------
    >>> import elastolink as el
    >>> bar = el.Section.rectangle(0.025, 0.006, modulus=71e9, density=2710.0)
    >>> linkage = el.FourBar(frame=0.25, crank=0.11, coupler=0.28, follower=0.27)
    >>> structure = el.beams.beam_linkage(linkage, dict.fromkeys(linkage.links, bar))
    >>> system = el.beams.linear_system(structure, rayleigh=(0.0, 1e-5))
    >>> print(system.size, system.parameters["rayleigh_stiffness"])
    27 1e-05
    """
    _check(structure, form, rayleigh, gravity)
    arrays = AngleArrays(structure)
    lumped, springs, dampers = lumped_values(structure)
    free = arrays.free
    slide = Slide(arrays) if structure.sliding else None
    require_held(arrays, springs[free], slide)
    mass, stiffness, drag = (np.diag(values[free]) for values in (lumped, springs, dampers))
    axial = AxialForces(arrays, stiffness, lumped, gravity, slide)
    moving, full, damped = structure.moving, form == "full", any(rayleigh)
    heavy, loaded = moving and np.any(lumped), any(gravity) or np.any(axial.node_forces)
    viscous = any(beam.section.retardation for beam in structure.beams)
    rows: list[tuple[str, str | None, Any, int, Any]] = [
        # array, scale, function, extra power of the speed, and whether there is such a term
        ("M", "distributed_mass", partial(arrays.sum, "mass"), 0, True),
        ("K", "elasticity", arrays.stiffness, 0, True),
        ("f", "distributed_mass", partial(axial.force, "distributed"), 0, moving),
        ("g", "distributed_mass", partial(axial.force, "distributed", derivative=1), 0, moving),
        ("A", "distributed_mass", partial(arrays.sum, "coupling"), 0, full and moving),
        ("B", "distributed_mass", partial(arrays.sum, "centripetal"), 0, full and moving),
        # The family's equation holds M' qd, which this form lacks: the damping takes it out again.
        ("C", "distributed_mass", partial(_minus_mass_slope, arrays), 1, not full),
        ("M", "lumped_mass", mass, 0, np.any(mass)),
        ("K", None, stiffness, 0, np.any(stiffness)),
        ("C", None, drag, 0, np.any(drag)),
        ("C", "rayleigh distributed", partial(arrays.sum, "mass"), 0, damped),
        ("C", "rayleigh lumped", mass, 0, damped),
        ("C", "rayleigh elastic", arrays.stiffness, 0, damped),
        ("C", "rayleigh springs", stiffness, 0, damped),
        ("C", "viscous", partial(arrays.sum, "retarded"), 0, viscous),
        ("D", "viscous", partial(arrays.sum, "retarded slope"), 0, viscous and moving),
        ("f", "lumped_mass", partial(axial.force, "lumped"), 0, heavy),
        ("g", "lumped_mass", partial(axial.force, "lumped", derivative=1), 0, heavy),
        ("p", None, partial(axial.force, "static"), 0, loaded),
    ]
    if geometric_stiffness:
        rows += [
            ("Kg", "distributed_mass", partial(axial.geometric, "distributed"), 2, moving),
            ("Kg", "lumped_mass", partial(axial.geometric, "lumped"), 2, heavy),
            ("Kg", None, partial(axial.geometric, "static"), 0, loaded),
        ]
    terms = [Term(*row) for *row, there in rows if there]
    if slide is not None:
        terms = slid_terms(terms, slide, form=form)
    if not moving:
        terms = [replace(term, function=term(np.zeros(1))[0]) for term in terms]
    parameters = dict.fromkeys(FACTORS, 1.0)
    if damped:
        parameters |= {"rayleigh_mass": rayleigh[0], "rayleigh_stiffness": rayleigh[1]}
    if viscous:
        parameters["retardation"] = 1.0
    told = {"form": form, "geometric_stiffness": str(geometric_stiffness).lower()}
    made_with = {
        "form": form,
        "geometric_stiffness": geometric_stiffness,
        "rayleigh": rayleigh,
        "gravity": gravity,
    }
    return LinearPeriodic(
        size=structure.size,
        terms=tuple(terms),
        parameters=parameters,
        scales=_scales,
        period=structure.period,
        labels=structure.labels,
        provenance={**structure.provenance, **told},
        limits={name: "non-negative" for name in parameters} | dict.fromkeys(FACTORS, "positive"),
        relative_deflection=partial(relative_deflection, arrays, slide),
        structure=structure if slide is None else None,
        remesh=partial(_remeshed, structure, made_with),
    )


def _remeshed(
    structure: Structure, options: Mapping[str, Any], change: Callable[[Structure], Structure]
) -> LinearPeriodic:
    """Return the system of a changed structure, made with the same options."""
    return linear_system(change(structure), **options)


def _scales(values: Mapping[str, ArrayLike]) -> Mapping[str, Array]:
    """Return the factors and the products of them that the terms name."""
    found = {name: np.asarray(value, dtype=float) for name, value in values.items()}
    one = np.ones(())
    a, b = found.get("rayleigh_mass", one), found.get("rayleigh_stiffness", one)
    tau = found.get("retardation", one)
    return {
        **found,
        "rayleigh distributed": a * found["distributed_mass"],
        "rayleigh lumped": a * found["lumped_mass"],
        "rayleigh elastic": b * found["elasticity"],
        "rayleigh springs": b,
        "viscous": tau * found["elasticity"],
    }


def _check(
    structure: Structure, form: str, rayleigh: tuple[float, float], gravity: tuple[float, float]
) -> None:
    problems = []
    if not isinstance(structure, Structure):
        found, fix = type(structure).__name__, "make one with beam_linkage or frame"
        problems.append(Problem("structure", found, "a Structure", fix))
    if form not in FORMS:
        problems.append(Problem("form", repr(form), f"one of {FORMS}", "choose 'full'"))
    if not (are_finite(rayleigh, 2) and min(rayleigh) >= 0):
        found, fix = repr(rayleigh), "negative damping drives the motion"
        problems.append(Problem("rayleigh", found, "two numbers, 0 or more", fix))
    if not are_finite(gravity, 2):
        problems.append(Problem("gravity", repr(gravity), "two finite numbers", "correct them"))
    refuse(problems)


def lumped_values(
    structure: Structure, freedoms: Freedoms | None = None
) -> tuple[Array, Array, Array]:
    """Return lumped mass, springs and dampers of all coordinates, held ones included.

    By the structure's own numbering of the coordinates, or by another one.
    """
    freedoms = structure.freedoms if freedoms is None else freedoms
    mass, springs, dampers = (np.zeros(len(freedoms.all)) for _ in range(3))
    for node in structure.nodes:
        meeting = [b.name for b in structure.beams if node.name in (b.start, b.end)]
        turning = node.carried_by or (node.joined or tuple(meeting))[0]
        needs = node.inertia or node.stiffness.get("rotation") or node.damping.get("rotation")
        if needs and not (node.carried_by or node.joined or len(meeting) == 1):
            found = "an inertia, spring or damper on the rotation where several beams are pinned"
            fix = f"set carried_by to one of {', '.join(meeting)}"
            raise bad(f"node {node.name}", found, "the beam that it turns with", fix)
        masses = (("x", "x", node.mass), ("y", "y", node.mass), ("rotation", turning, node.inertia))
        for part, name, inertia in masses:
            place = freedoms.places[node.name, name]
            mass[place] += inertia
            springs[place] += node.stiffness.get(part, 0.0)
            dampers[place] += node.damping.get(part, 0.0)
    return mass, springs, dampers


def _minus_mass_slope(arrays: AngleArrays, theta: Array) -> Array:
    half = arrays.sum("mass slope", theta)
    return -half - np.swapaxes(half, -1, -2)


# What a term becomes: its new array, and whether Z or Z' stands to its left and right, or whether
# the transposed of the term stands between.
_RULES = {
    "M": (("M", "Z", "Z"), ("A", "Z", "Z'"), ("B", "Z'", "Z'")),
    "A": (("A", "Z", "Z"), ("B", "Z'", "Z"), ("B", "Z^T", "Z'")),
    "B": (("B", "Z", "Z"),),
    "C": (("C", "Z", "Z"), ("D", "Z", "Z'")),
    "D": (("D", "Z", "Z"),),
    "K": (("K", "Z", "Z"),),
    "Kg": (("Kg", "Z", "Z"),),
}


class Slide:
    """The coordinates of a structure that has one node which slides along a beam.

    The pin B lies on the bent axis of the beam.  With t and n along and across the rigid beam, x1
    the rigid place of the pin and v the deflection, its displacement is ``s t + v(x1) n`` to first
    order: the one new coordinate is s.  All coordinates are ``Z(theta) y``; with ' = d/dtheta the
    arrays become

        M: Z^T M Z,   A: Z^T (M Z' + A Z),   B: Z'^T M Z' + Z'^T A Z + Z^T A^T Z' + Z^T B Z,
        C: Z^T C Z,   D: Z^T (D Z + C Z'),   K: Z^T K Z,   f: Z^T f,   g: Z^T g.

    To second order the pin has also moved along the beam, by ``r = s - u(x1)``, to where the
    deflection is ``v + v' r``: the force F upon the beam, that of the rigid motion, has the
    potential ``-F v'(x1) r``, a part of the geometric stiffness.
    """

    def __init__(self, arrays: AngleArrays) -> None:
        structure = arrays.structure
        node = next(node for node in structure.nodes if node.slides_on is not None)
        self.arrays = arrays
        self.carried = structure.beam(str(node.slides_on))
        self.guided = next(beam for beam in structure.beams if node.name in (beam.start, beam.end))
        self.along = 0.0 if self.guided.start == node.name else self.guided.length
        places = [structure.freedoms.places[node.name, part] for part in ("x", "y")]
        self.x, self.y = np.searchsorted(arrays.free, places)
        self.elements = [placed for placed in structure.elements if placed.beam is self.carried]
        # Z and Z' at crank angles, (nt, n, n - 1).
        self.basis, self.basis_slope = Remembered(self._basis), Remembered(self._basis_slope)

    def place(self, theta: Array) -> tuple[Array, Array]:
        """Return the rigid place x1 of the pin on the beam [m] and its derivative."""
        motion = self.arrays.structure.configuration(theta)
        link, pin = motion[self.carried.name], motion[self.guided.name].point(self.along)
        axis = np.stack([np.cos(link.angle), np.sin(link.angle)], axis=-1)
        place = np.sum((pin.position - link.origin) * axis, axis=-1)
        # What the turning of the axis adds is across it: nothing, for the pin lies on it.
        return place, np.sum((pin.velocity - link.velocity) * axis, axis=-1)

    def shape(self, name: str, theta: Array, *, by_angle: bool = False) -> Array:
        """Return a shape function of the beam at the pin, or its derivative by the beam's angle.

        By the free coordinates along the fixed axes, ``(nt, n)``; for names see :func:`shapes_of`.
        """
        place, _ = self.place(theta)
        ends = np.array([placed.start for placed in self.elements])
        number = np.clip(np.searchsorted(ends, place, side="right") - 1, 0, len(ends) - 1)
        c, s = self._axis(theta)
        if by_angle:
            c, s = -s, c
        # The coordinates that turn with the beam.
        turning = [0, 1, 3, 4] if by_angle else slice(None)
        found = np.zeros((len(theta), self.arrays.count))
        for k in np.unique(number):
            placed, here = self.elements[k], np.flatnonzero(number == k)
            xi = np.clip((place[here] - placed.start) / placed.length, 0.0, 1.0)
            row = in_own_axes(shapes_of(placed, xi)[name], c[here], -s[here])
            found[np.ix_(here, placed.indices[turning])] = row[:, turning]
        return found[:, self.arrays.free]

    def _basis(self, theta: Array) -> Array:
        c, s = self._axis(theta)
        normal = np.stack([-s, c], axis=-1)
        found = normal[:, :, None] * self.shape("v", theta)[:, None, :]
        found[:, 0, self.x] += c
        found[:, 1, self.x] += s
        return self._reduced(found, unit=1.0)

    def _basis_slope(self, theta: Array) -> Array:
        c, s = self._axis(theta)
        turn = self.arrays.motion(theta).turning[self.carried.name][:, None]
        _, rate = self.place(theta)
        hurried = rate[:, None] * self.shape("slope", theta)
        hurried += turn * self.shape("v", theta, by_angle=True)
        normal, tangent = np.stack([-s, c], axis=-1), np.stack([c, s], axis=-1)
        found = normal[:, :, None] * hurried[:, None, :]
        found -= (turn * tangent)[:, :, None] * self.shape("v", theta)[:, None, :]
        found[:, :, self.x] += turn * normal
        return self._reduced(found, unit=0.0)

    def contact(self, rest: Array, theta: Array) -> Array:
        """Return the stiffness of the contact force, by the coordinates before Z: ``(nt, n, n)``.

        ``rest``, ``(nt, n)``, are elastic forces less loads: what the contact does.
        """
        c, s = self._axis(theta)
        force = s * rest[:, self.x] - c * rest[:, self.y]
        relative = -self.shape("u", theta)
        relative[:, self.x] += c
        relative[:, self.y] += s
        slope = self.shape("slope", theta)
        half = -force[:, None, None] * slope[:, :, None] * relative[:, None, :]
        return np.asarray(half + np.swapaxes(half, -1, -2))

    def _axis(self, theta: Array) -> Array:
        cosines: Array = self.arrays.motion(theta).products[self.carried.name][:, 1:3].T
        return cosines

    def _reduced(self, rows: Array, unit: float) -> Array:
        """Return the basis: the pin's two rows, all else as it is; y of the pin is gone."""
        count = len(self.arrays.free)
        found = np.zeros((len(rows), count, count))
        others = np.delete(np.arange(count), [self.x, self.y])
        found[:, others, others] = unit
        found[:, [self.x, self.y], :] = rows
        return np.delete(found, self.y, axis=2)


def slid_terms(terms: Iterable[Term], slide: Slide, *, form: str) -> list[Term]:
    """Return terms by the coordinates before Z as terms by those after it.

    Of the instantaneous form neither A, B nor D come of Z', and the damping takes out all of the
    mass matrix's derivative.
    """
    found = []
    for term in terms:
        if term.array not in _RULES:
            found.append(replace(term, function=partial(_slid_vector, term, slide)))
            continue
        for array, left, right in _RULES[term.array]:
            if form == "full" or "Z'" not in (left, right):
                between = partial(_slid_matrix, term, slide, (left, right))
                found.append(replace(term, array=array, function=between))
        if form != "full" and term.array == "M":
            found.append(Term("C", term.scale, partial(_minus_slope, term, slide), term.power + 1))
    return found


def _slid_vector(term: Term, slide: Slide, theta: Array) -> Array:
    return np.asarray(np.einsum("tij,ti->tj", slide.basis(theta), term(theta)))


def _slid_matrix(term: Term, slide: Slide, sides: tuple[str, str], theta: Array) -> Array:
    between = term(theta)
    if sides[0] == "Z^T":
        between = np.swapaxes(between, -1, -2)
    left, right = (
        slide.basis_slope(theta) if side == "Z'" else slide.basis(theta) for side in sides
    )
    return np.asarray(np.swapaxes(left, -1, -2) @ between @ right)


def _minus_slope(term: Term, slide: Slide, theta: Array) -> Array:
    half = _slid_matrix(term, slide, ("Z", "Z'"), theta)
    return np.asarray(-(half + np.swapaxes(half, -1, -2)))
