"""The transcendental eigenproblem of a structure of beams held in one position.

Its members are uniform beams that vibrate harmonically, exact at every frequency.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...generated import beam_dynamic_stiffness
from ..beams.assembly import AngleArrays
from ..beams.frames import eliminated
from ..beams.linear import lumped_values
from ..beams.structure import Freedoms, PlacedElement, Structure, number_freedoms
from ..core.errors import bad
from ..core.families import Array, Transcendental
from ..core.inputs import is_finite, names_problems, numbers, require_kind, require_mapping

Values: TypeAlias = NDArray[Any]

functions: Any = beam_dynamic_stiffness

# Places in the local matrix (row, column, sign, number of the function, power of the length);
# coordinates u1, v1, r1, u2, v2, r2.
_BENDING = (
    (1, 1, 1, 5, 0),
    (1, 2, -1, 3, 1),
    (1, 4, 1, 4, 0),
    (1, 5, 1, 2, 1),
    (2, 2, 1, 1, 2),
    (2, 4, -1, 2, 1),
    (2, 5, 1, 0, 2),
    (4, 4, 1, 5, 0),
    (4, 5, 1, 3, 1),
    (5, 5, 1, 1, 2),
)
_AXIAL = ((0, 0, 0), (0, 3, 1), (3, 3, 0))


@dataclass(frozen=True)
class Members:
    """Uniform beams, ``(n,)`` numbers each.

    Complex stiffnesses stand for sections that lose energy.  An infinite EA gives an inextensible
    beam: of the axial part the mass alone is left, for displacements that are equal at both ends.
    """

    length: Values  # [m]
    bending: Values  # EI [N m^2]
    axial: Values  # EA [N]
    mass: Values  # per length [kg/m]

    def phases(self, omega: ArrayLike) -> tuple[Values, Values]:
        """Return ``z = lambda L`` (Aannaque (5.4)) and ``b = beta L`` (5.9), ``(..., n)``."""
        rate = np.asarray(omega)[..., None]
        z = np.sqrt(rate) * (self.length * np.sqrt(np.sqrt(self.mass / self.bending)))
        b = rate * (self.length * np.sqrt(self.mass / self.axial))
        # Phases are kept above these; the functions are at their static values long before.
        return np.where(np.abs(z) < 1e-30, 1e-30, z), np.where(np.abs(b) < 1e-100, 1e-100, b)

    def matrices(self, omega: ArrayLike) -> tuple[Values, Values]:
        """Return dynamic stiffness and mass in the beams' own axes, ``(..., n, 6, 6)``.

        Aannaque (5.18) and (5.19): ``D(omega)`` gives the end forces of a harmonic motion, and ``M
        = -dD/d(omega^2)`` its generalised mass; ``K = D + omega^2 M`` (5.17).  Rows are u1, v1, r1,
        u2, v2, r2: displacement along and across the beam, rotation, of either end.
        """
        rates = np.asarray(omega)
        if not rates.size or not np.all(np.isfinite(rates)):
            raise bad("omega", repr(omega), "finite frequencies [rad/s]", "correct them")
        z, b = self.phases(rates)
        weight = self.mass * self.length
        stretch, stretch_rates = np.array(functions.axial(b)), np.array(functions.axial_rates(b))
        rigid = np.isinf(self.axial)
        elastic = np.where(rigid, 1.0, self.axial) / self.length * stretch
        along = np.where(rigid, -(rates[..., None] ** 2) * weight * stretch_rates, elastic)
        across = (self.bending / self.length**3) * np.array(functions.bending(z))
        bend_rates = np.array(functions.bending_rates(z))
        mass = _placed(weight * bend_rates, weight * stretch_rates, self.length)
        return _placed(across, along, self.length), mass

    def inertias(self, omega: float) -> Values:
        """Return ``H = (D(0) - D(omega)) / omega^2``, no difference of large numbers."""
        z, b = self.phases(omega)
        weight = self.mass * self.length
        across, along = functions.bending_inertias(z), functions.axial_inertias(b)
        return _placed(weight * np.array(across), weight * np.array(along), self.length)


def _placed(across: Values, along: Values, length: Values) -> Values:
    """Return matrices ``(..., n, 6, 6)`` of the functions of bending and of axial motion."""
    found = np.zeros((*across.shape[1:], 6, 6), np.result_type(across, along))
    for row, column, sign, which, power in _BENDING:
        found[..., row, column] = found[..., column, row] = sign * length**power * across[which]
    for row, column, which in _AXIAL:
        found[..., row, column] = found[..., column, row] = along[which]
    return found


Pieces = Mapping[str, tuple[float, ...]]


@dataclass(frozen=True)
class Assembly:
    """Members, what joins them, and the coordinates left."""

    pieces: tuple[PlacedElement, ...]  # members, or parts of them, each one exact element
    members: Members  # the numbers of the pieces
    angles: Array  # of each piece against the fixed axes [rad], (n,)
    # (n, 6, size): displacements of the ends along and across each piece by the coordinates left
    local: Array
    reduction: Array  # (free, size): the free coordinates by those that are left
    # (free,): on the free coordinates [kg, kg m^2, N/m, N m/rad]
    lumped_mass: Array
    springs: Array
    labels: tuple[str, ...]  # names of the free coordinates

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return int(self.reduction.shape[1])

    def assembled(self, matrices: Array, diagonal: Array) -> Array:
        """Return ``(..., size, size)`` from local matrices and values on the free coordinates."""
        size = self.size
        turned = np.matmul(matrices, self.local)
        rows = turned.reshape(*turned.shape[:-3], -1, size)
        total = np.matmul(self.local.reshape(-1, size).T, rows)
        lumps = np.matmul(self.reduction.T, diagonal[..., :, None] * self.reduction)
        return np.asarray(total + lumps)

    def stiffness(self, omega: ArrayLike) -> Array:
        """Return D at frequencies ``(...)`` [rad/s]: ``(..., size, size)``."""
        rate = np.asarray(omega, dtype=float)
        lumps = self.springs - rate[..., None] ** 2 * self.lumped_mass
        return self.assembled(self.members.matrices(rate)[0], lumps)

    def mass(self, omega: ArrayLike) -> Array:
        """Return ``M = -dD/d(omega^2)`` at frequencies ``(...)``: ``(..., size, size)``."""
        rate = np.asarray(omega, dtype=float)
        lumps = np.broadcast_to(self.lumped_mass, (*rate.shape, len(self.lumped_mass)))
        return self.assembled(self.members.matrices(rate)[1], lumps)

    def poles(self, omega: ArrayLike) -> Array:
        """Return how many frequencies lie below with every node held, ``(...)``."""
        z, b = self.members.phases(np.asarray(omega, dtype=float))
        return np.asarray(np.sum(functions.bending_poles(z) + functions.axial_poles(b), axis=-1))


@dataclass(frozen=True, kw_only=True)
class DynamicStiffness(Transcendental):
    """``D(Omega) q = 0`` of a structure of beams, each one exact element (Aannaque (5.20)).

    Attributes
    ----------
    structure : Structure
        The structure.
    theta : float
        Crank angle at which it is held [rad].
    assembly : Assembly
        Members and coordinates.
    inextensible : tuple of str
        Beams that cannot stretch.
    """

    structure: Structure
    theta: float
    assembly: Assembly
    inextensible: tuple[str, ...] = ()

    @property
    def labels(self) -> tuple[str, ...]:
        """Names of the free coordinates of the nodes; see ``assembly.reduction``."""
        return self.assembly.labels

    def mass(self, omega: ArrayLike) -> Array:
        """Return ``-dD/d(Omega^2)`` at frequencies ``(...)`` [rad/s] (Aannaque (5.16))."""
        return self.assembly.mass(omega)

    def divided(self, pieces: Pieces) -> DynamicStiffness:
        """Return the same structure with beams in several exact pieces: shares by beam."""
        return dynamic_stiffness(
            self.structure, self.theta, inextensible=self.inextensible, pieces=pieces
        )


def dynamic_stiffness(
    structure: Structure,
    theta: float = 0.0,
    *,
    inextensible: bool | tuple[str, ...] = False,
    pieces: Pieces | None = None,
) -> DynamicStiffness:
    """Return the exact eigenproblem of a structure held in one position.

    Every beam is one exact element whatever its ``elements`` and ``kind``: bending without shear
    and rotary inertia, and the motion along it.  Dampers and retarded materials are left out.

    Parameters
    ----------
    structure : Structure
        Frame, or linkage held at a crank angle.
    theta : float
        Crank angle [rad].
    inextensible : bool or tuple of str
        Beams that cannot stretch: True for all.
    pieces : mapping of str to tuple of float, optional
        Shares of the length of the pieces of a beam; the frequencies stay what they are.

    Returns
    -------
    DynamicStiffness

    Raises
    ------
    BadInput
        If the angle is no number, a beam is unknown, or nothing is left that moves.

    References
    ----------
    Aannaque (5.12)-(5.20).

    Examples
    --------
    >>> import elastolink as el
    >>> bar = el.Section.rectangle(0.02, 0.01, modulus=210e9, density=7850.0)
    >>> pinned = {"A": ("x", "y"), "B": ("x", "y")}
    >>> beam = el.frame({"A": (0, 0), "B": (1, 0)}, {"beam": ("A", "B")}, bar, supports=pinned)
    >>> print(el.dynamic_stiffness(beam).count(200.0))
    1
    """
    rigid = rigid_beams("dynamic_stiffness", structure, theta, inextensible)
    shares = {} if pieces is None else pieces
    require_mapping("pieces", shares, 'say {"crank": (0.5, 0.5)}')
    for name in sorted(shares):
        structure.beam(name)  # refuses one that there is not
    held = all({"x", "y", "rotation"} <= set(node.held) for node in structure.nodes)
    usual: tuple[float, ...] = (0.5, 0.5) if held else (1.0,)
    beams = [
        replace(beam, elements=tuple(shares.get(beam.name, usual)), kind="cubic")
        for beam in structure.beams
    ]
    freedoms = number_freedoms(beams, structure.nodes)
    assembly = _assembly(structure, float(theta), freedoms, rigid)
    return DynamicStiffness(
        size=assembly.size,
        stiffness=assembly.stiffness,
        poles=assembly.poles,
        provenance={
            **structure.provenance,
            "theta": repr(float(theta)),
            "inextensible": ", ".join(rigid),
        },
        structure=structure,
        theta=float(theta),
        assembly=assembly,
        inextensible=rigid,
    )


def rigid_beams(
    what: str, structure: Structure, theta: float, inextensible: bool | tuple[str, ...]
) -> tuple[str, ...]:
    """Return the names of the beams that cannot stretch, all arguments checked."""
    require_kind("structure", structure, Structure, "make one with beam_linkage or frame")
    if not is_finite(theta):
        raise bad("theta", repr(theta), "one number", "hold the linkage at one angle")
    structure.require_pinned(what)
    names = tuple(beam.name for beam in structure.beams)
    if isinstance(inextensible, bool):
        return names if inextensible else ()
    if names_problems("", inextensible):
        fix = "say True for all"
        raise bad("inextensible", repr(inextensible), "True, False or names of beams", fix)
    for name in sorted(inextensible):
        structure.beam(name)  # refuses one that there is not
    return tuple(inextensible)


def _assembly(
    structure: Structure, theta: float, freedoms: Freedoms, rigid: tuple[str, ...]
) -> Assembly:
    motion = structure.configuration(np.array([theta]))
    elements, free = freedoms.elements, freedoms.free
    angles = np.array([float(motion[e.beam.name].angle[0]) for e in elements])
    # What turns free coordinates into displacements of the ends of each piece.
    local = np.zeros((len(elements), 6, len(freedoms.all)))
    for ends, element, angle in zip(local, elements, angles, strict=True):
        c, s = np.cos(angle), np.sin(angle)
        turn = np.kron(np.eye(2), [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        ends[:, element.indices[:6]] += turn
    local = local[:, :, free]
    sections = [element.beam.section for element in elements]
    stiff = [np.inf if e.beam.name in rigid else e.beam.section.axial_stiffness for e in elements]
    members = Members(
        np.array([element.length for element in elements]),
        np.array([section.bending_stiffness for section in sections]),
        np.array(stiff),
        np.array([section.mass_per_length for section in sections]),
    )
    # What makes the free coordinates of those that stretch no inextensible piece.
    unstretched = np.isinf(members.axial)
    kept, reduction = eliminated(local[unstretched, 3] - local[unstretched, 0])
    if not kept.size:
        found = "beams that leave no node free to move"
        fix = "let a beam stretch, or divide one into pieces"
        raise bad("inextensible", found, "at least one coordinate", fix)
    mass, springs, _ = lumped_values(structure, freedoms)
    return Assembly(
        pieces=elements,
        members=members,
        angles=angles,
        local=np.asarray(local @ reduction),
        reduction=reduction,
        lumped_mass=mass[free],
        springs=springs[free],
        labels=freedoms.free_labels,
    )


def element_matrices(
    structure: Structure, theta: float = 0.0, *, inextensible: bool | tuple[str, ...] = False
) -> tuple[Array, Array, Array]:
    """Return mass and stiffness of the structure's own elements at a crank angle [rad].

    ``inextensible`` names the beams that cannot stretch, True all.  Beside the two, on the
    coordinates that are left, comes the reduction: the free coordinates by those that are left.  A
    structure in which nothing is left that moves is refused.
    """
    rigid = rigid_beams("element_matrices", structure, theta, inextensible)
    arrays, angle = AngleArrays(structure), np.array([float(theta)])
    made = _assembly(structure, float(theta), structure.freedoms, rigid)
    reduction = made.reduction
    mass = arrays.sum("mass", angle)[0] + np.diag(made.lumped_mass)
    stiffness = arrays.sum("stiffness", angle)[0] + np.diag(made.springs)
    return reduction.T @ mass @ reduction, reduction.T @ stiffness @ reduction, reduction


def log_determinant(problem: Transcendental, omega: ArrayLike) -> tuple[Array, Array]:
    """Return ``log10 |det D|`` and the sign of the determinant at positive frequencies [rad/s].

    Zeros are frequencies at which the nodes move, poles those of the members with held ends; where
    all nodes stand still there is a pole for whole members, and a zero for divided ones.
    """
    require_kind("problem", problem, Transcendental, "make one with dynamic_stiffness")
    rates = numbers("omega", omega)
    if not rates.size or not np.all((rates > 0.0) & np.isfinite(rates)):
        raise bad("omega", repr(omega), "positive frequencies [rad/s]", "leave out the others")
    sign, logarithm = np.linalg.slogdet(problem.stiffness(rates))
    return np.asarray(logarithm / np.log(10.0)), np.asarray(sign)


# Shares of the length, fewer pieces first.
_SHARES: tuple[tuple[float, ...], ...] = (
    (1.0,),
    *((share, 1.0 - share) for share in (0.5, 0.546, 0.578, 0.607, 0.523, 0.637, 0.664)),
    (0.371, 0.335, 0.294),
    (0.412, 0.327, 0.261),
    (0.345, 0.345, 0.31),
    (0.283, 0.262, 0.239, 0.216),
)


def divided_for(problem: DynamicStiffness, *omega: float) -> DynamicStiffness:
    """Return a structure whose pieces have no pole near some frequencies [rad/s].

    One piece for a member wherever that will do; otherwise unequal ones (the fictitious joint of
    Aannaque 5.4.1).
    """
    chosen: dict[str, tuple[float, ...]] = {}
    members = problem.assembly.members
    z, b = members.phases(omega)
    for beam in problem.structure.beams:
        own = [k for k, p in enumerate(problem.assembly.pieces) if p.beam.name == beam.name]
        offered = [shares for shares in _SHARES if len(shares) >= len(own)]
        whole = beam.length / members.length[own[0]]
        scores = []
        for shares in offered:
            # How far the nearest pole is, over a quarter of the distance between poles.
            zs, bs = (np.outer(phase[:, own[0]] * whole, shares) for phase in (z, b))
            bending = np.abs(np.cos(zs) - 1.0 / np.cosh(np.minimum(zs, 700.0)))
            bending = np.where(zs < 3.0, 1.0, bending)
            axial = np.where(bs < 1.5, 1.0, np.abs(np.sin(bs)))
            scores.append(float(min(bending.min(), axial.min())))
            if scores[-1] > 0.6:
                break
        best = offered[int(np.argmax(scores))]
        if len(best) > 1:
            chosen[beam.name] = best
    undivided = len(problem.assembly.pieces) == len(problem.structure.beams)
    return problem if undivided and not chosen else problem.divided(chosen)
