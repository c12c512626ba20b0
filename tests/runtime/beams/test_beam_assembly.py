"""Arrays of moving structures of beams against energies by quadrature and complex steps."""

from dataclasses import replace
from functools import partial
from itertools import product

import numpy as np
import pytest
from beam_energies import Energies, SlidingEnergies, array_gaps, distance, places_of, scaled, slope
from elastolink.runtime.beams import KINDS, Section, beam_linkage, linear_system
from elastolink.runtime.linkages import FourBar, QuickReturn, SliderCrank
from elastolink.runtime.rigid import Load, Machine, rigid_forces
from elastolink.runtime.rigid import MassDistribution as Bar

ROUND = 2e-12


def random_section(rng, retardation=0.0):
    width, thickness = rng.uniform(0.004, 0.03), rng.uniform(0.002, 0.01)
    return Section.rectangle(
        width,
        thickness,
        modulus=rng.uniform(50e9, 250e9),
        density=rng.uniform(2000.0, 9000.0),
        poisson=0.3,
        retardation=retardation,
    )


LINKAGES = {
    "open": FourBar(crank=0.170, coupler=0.328, follower=0.525, frame=0.547),
    "crossed": FourBar(crank=0.1, coupler=0.41, follower=0.35, frame=0.37, assembly="crossed"),
    "slider": SliderCrank(crank=0.1, coupler=0.37, offset=0.06),
}
# The crank pin slides along the bent rod.
SLIDING = {
    "quick-return": QuickReturn(frame=0.6, crank=0.13, rod=1.0),
    "Whitworth": QuickReturn(frame=0.2, crank=0.45, rod=0.8),
}
LINKS = {"open": ("crank", "coupler", "follower"), "slider": ("crank", "coupler")}
LINKS |= {"crossed": LINKS["open"]} | dict.fromkeys(SLIDING, ("crank", "rod"))


def made(name, kind, seed, elements=2):
    """Return a structure with random sections, lumped values, springs and loads."""
    rng = np.random.default_rng(seed)
    sections = {link: random_section(rng, rng.uniform(1e-6, 1e-4)) for link in LINKS[name]}
    nodes = {
        "A": {
            "held": ("x", "y"),
            "stiffness": {"rotation": rng.uniform(1e3, 2e4)},
            "damping": {"rotation": 0.3},
            "inertia": rng.uniform(1e-4, 1e-2),
        },
        "B": {"inertia": rng.uniform(1e-4, 1e-3), "force": (3.0, -2.0)},
        "C": {"mass": rng.uniform(0.0, 0.5), "force": (1.0, 4.0)},
    }
    if name not in SLIDING:
        nodes["B"]["carried_by"] = "coupler"
    if "follower" in LINKS[name]:
        nodes["D"] = {"held": ("y",), "stiffness": {"x": 1e5}, "damping": {"x": 7.0}, "mass": 0.05}
    if name == "open" and kind == "curvature":
        elements = (0.3, 0.7)
    return beam_linkage(
        (LINKAGES | SLIDING)[name],
        sections,
        elements=elements,
        kind=kind,
        joint_masses={"B": rng.uniform(0.05, 0.3)},
        nodes=nodes,
    )


def cases(*quick, slow):
    return [*quick, *(pytest.param(*case, marks=pytest.mark.slow) for case in slow)]


CASES = cases(
    ("open", "cubic"),
    ("slider", "internal_node"),
    slow=[("open", "timoshenko"), ("open", "curvature"), ("crossed", "cubic")],
)
ALL = CASES + cases(
    ("quick-return", "cubic"),
    slow=[*product(["quick-return"], KINDS[1:]), ("Whitworth", "internal_node")],
)


def energies_of(name, structure):
    made = SlidingEnergies if name in SLIDING else Energies
    return made(structure, partial(places_of, (LINKAGES | SLIDING)[name]))


@pytest.mark.parametrize(("name", "kind"), ALL)
def test_the_arrays_are_those_of_the_energies(name, kind):
    structure = made(name, kind, seed=1)
    system, energies = linear_system(structure), energies_of(name, structure)
    for theta in (0.3, 2.9, 5.1):
        for array, gap in array_gaps(system, energies, theta).items():
            assert gap < ROUND, (array, theta)


@pytest.mark.parametrize(("name", "kind"), ALL)
def test_forces_are_those_of_the_kinetic_energy(name, kind):
    structure = made(name, kind, seed=2, elements=1)
    system = linear_system(structure, gravity=(1.3, -9.81))
    energies = energies_of(name, structure)
    # td b . qd + td^2 a . q in L gives the forces td^2 (a - b') - tdd b.
    for theta in (0.4, 4.4):
        here = energies.kinetic(theta)
        changing = slope(lambda angle: energies.kinetic(angle)["b"], theta)
        assert distance(system.array("g", theta)[0], -here["b"]) < ROUND
        # The differences lose two digits to round-off and have an error of the order STEP^8.
        limit = 1e-10 if name in SLIDING else 1e-11
        assert distance(system.array("f", theta)[0], here["a"] - changing) < limit
        weight = energies.weight(theta, (1.3, -9.81))
        assert distance(system.array("p", theta)[0], weight) < ROUND


def rigid_machine(name, structure, gravity=(0.0, 0.0)):
    """Return the same machine of rigid links, and its masses per length.

    Lumped masses at B belong to the crank, at C to the follower or to the slider.
    """
    linkage = LINKAGES[name]
    last = "slider" if name == "slider" else "follower"
    mass = {node.name: node.mass for node in structure.nodes}
    bars = {b.name: b.section.mass_per_length for b in structure.beams}
    masses = {b.name: Bar.uniform_bar(bars[b.name] * b.length, b.length) for b in structure.beams}
    for beam in structure.beams:
        if beam.kind == "timoshenko":
            masses[beam.name] += Bar(inertia=beam.section.rotary_inertia * beam.length)
    masses["coupler"] += Bar(inertia=structure.node("B").inertia)
    masses["crank"] += Bar.point(mass["B"], along=linkage.crank)
    tip = Bar.point(mass["C"], along=0.0 if last == "slider" else linkage.follower)
    masses[last] = masses.get(last, Bar()) + tip
    forces = [node.force for node in structure.nodes if node.name in "BC"]
    loads = [
        Load(link, force=force, along=along)
        for link, force, along in (
            ("crank", forces[0], linkage.crank),
            (last, forces[1], 0.0 if last == "slider" else linkage.follower),
        )
        if any(force)
    ]
    machine = Machine(linkage, masses, gravity=gravity, loads=tuple(loads))
    return machine, bars


def axial_forces_are_those_of_rigid_links(name, structure, speed, gravity=(0.0, 0.0)):
    """Compare the geometric stiffness with what rigid links carry, and return the system."""
    machine, bars = rigid_machine(name, structure, gravity)
    system, energies = linear_system(structure, gravity=gravity), energies_of(name, structure)
    for theta in (0.5, 3.3, 5.7):
        forces = rigid_forces(machine, theta, speed)
        motion = LINKAGES[name].motion(theta, speed)
        first = {"crank": forces.f12, "coupler": forces.f23, "follower": -forces.f41}

        def tension(beam, along, first=first, motion=motion):
            link = motion.link(beam.name)
            axis = np.array([np.cos(link.angle), np.sin(link.angle)])
            start = (link.point(0.0).acceleration - np.array(gravity)) @ axis
            resisted = start * along - link.speed**2 * along**2 / 2.0
            return -first[beam.name] @ axis + bars[beam.name] * resisted

        known, mass = energies.geometric(theta, tension), system.array("M", theta)[0]
        assert scaled(system.array("Kg", theta, speed=speed)[0], known, mass) < 1e-9
    return system


@pytest.mark.parametrize(("name", "kind"), CASES)
def test_axial_forces_are_those_of_rigid_links(name, kind):
    structure = made(name, kind, seed=3)
    bare = tuple(replace(node, force=(0.0, 0.0)) for node in structure.nodes)
    system = axial_forces_are_those_of_rigid_links(name, replace(structure, nodes=bare), 1.0)
    once, twice = (system.array("Kg", 3.3, speed=speed)[0] for speed in (1.0, 2.0))
    assert scaled(twice, 4.0 * once, system.array("M", 3.3)[0]) < 1e-9


@pytest.mark.parametrize("name", list(LINKAGES))
def test_constant_loads_and_weight_stiffen_as_rigid_links_carry_them(name):
    """At rest only weights and loads are left."""
    structure = made(name, "cubic", seed=4)
    axial_forces_are_those_of_rigid_links(name, structure, 0.0, (2.0, -9.81))
