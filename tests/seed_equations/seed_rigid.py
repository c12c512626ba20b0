"""Forces of rigid linkages by the package, complex numbers, in the units of the documents."""

from types import SimpleNamespace

from elastolink.runtime.linkages import FourBar
from elastolink.runtime.rigid import Machine, case_counterweights, rigid_forces, with_counterweights
from elastolink.runtime.rigid import MassDistribution as Link
from seed_truth import motion

GRAVITY = 386.09
SMITH_LENGTHS = (12.0, 6.0, 12.0, 12.0)
TABLE_3_2 = (0.547, 0.170, 0.328, 0.525)


def plane(pairs):
    """Return pairs of components as complex numbers."""
    return pairs[..., 0] + 1j * pairs[..., 1]


def _machine(lengths, links, assembly="open"):
    linkage = FourBar(*lengths, assembly)
    return Machine(linkage, dict(zip(linkage.links, links, strict=True)))


def forces(lengths, links, speed=1.0, assembly="open", unsteady=0.0, count=512):
    """Return forces, torque and moment over a turn, and the accelerations of the centres of mass.

    Force ``fij`` is that of link i upon link j; the frame is link 1.
    """
    machine = _machine(lengths, links, assembly)
    m = motion(lengths, assembly, count, unsteady)
    drive = m.theta2, speed * m.omega2, speed**2 * m.alpha2
    moved, found = machine.linkage.motion(*drive), rigid_forces(machine, *drive)
    pins = {name: plane(getattr(found, name)) for name in ("f12", "f23", "f34", "f41")}
    centres = {
        f"a{k}": plane(moved.point(name, *link.centre).acceleration)
        for k, (name, link) in enumerate(zip(machine.linkage.links, links, strict=True), 2)
    }
    whole = {"torque": found.torque, "moment": found.shaking_moment}
    return SimpleNamespace(**pins, **centres, **whole, shaking_force=plane(found.shaking_force))


def smith_links(gravity=GRAVITY):
    """Return the links of Figs. 12-16: printed weights and inertias [lbf, in, s]."""
    crank = Link.uniform_bar(0.5 / gravity, 6.0)
    other = Link(1.0 / gravity, 6.0 / gravity, inertia=0.125)
    return crank, other, other


def balanced(case, links, lengths=SMITH_LENGTHS, offsets=(6.0, 6.0, 6.0), **cylinders):
    """Return the links of Fig. 20 (a)-(d) with their counterweights behind their pivots."""
    machine = _machine(lengths, links)
    names = machine.linkage.links
    distances = dict(zip(names, offsets, strict=True))
    weights = case_counterweights(machine, case, distances, **cylinders)
    machine = with_counterweights(machine, weights.values())
    return tuple(machine.mass(name) for name in names)
