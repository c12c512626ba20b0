"""Periodic motions of beams by dense Fourier collocation, and structures for tests of recovery."""

import elastolink as el
import numpy as np
from elastolink.runtime.beams import linear_system
from elastolink.runtime.core.trigonometric import resampled
from elastolink.runtime.linkages.linkage import LinkMotion
from elastolink.runtime.recovery import BeamMotion
from elastolink.runtime.recovery.stresses import StressResult
from periodic_systems import second_order

STEEL = {"modulus": 210e9, "density": 7850.0}
FOUR_BAR = el.FourBar(crank=0.170, coupler=0.328, follower=0.525, frame=0.547)
BAR = el.Section.rectangle(0.02, 0.01, poisson=0.3, **STEEL)
# Aannaque's Table 4.1.
SECTIONS = {
    name: el.Section(area=area, second_moment=inertia, thickness=thickness, **STEEL)
    for name, area, inertia, thickness in (
        ("crank", 157.5e-6, 520.47e-12, 6.35e-3),
        ("coupler", 85.5e-6, 83.34e-12, 3.42e-3),
        ("follower", 78.75e-6, 65.12e-12, 3.15e-3),
    )
}
# First frequency of a bar of 1 m, 10 mm thick, clamped at one end or (True) pinned at both [rad/s]:
# (lambda L)^2 times sqrt(EI/m) = 14.93 m^2/s.
FIRST = {False: 3.516 * 14.93, True: 9.870 * 14.93}
JOINT_MASSES = {"B": 0.174, "C": 0.174}


def fourier_derivative(count, period=2 * np.pi):
    """Return the matrix of the derivative of trigonometric interpolation at even angles."""
    eye = np.fft.fft(np.eye(count), axis=0)
    waves = np.fft.fftfreq(count, 1.0 / count)
    waves[count // 2] = 0.0
    return np.real(np.fft.ifft(2j * np.pi / period * waves[:, None] * eye, axis=0))


def periodic_motion(system, speed, count=64):
    """Return the steady state at one speed by collocation of the second-order equation."""
    n, theta = system.size, system.period * np.arange(count) / count
    stiffness, damping, mass, force = second_order(system, theta, speed)
    first = fourier_derivative(count, system.period)
    blocks = np.einsum("st,sij->sitj", first @ first, speed**2 * mass)
    blocks += np.einsum("st,sij->sitj", first, speed * damping)
    places = np.arange(count)
    blocks[places, :, places, :] += stiffness
    q = np.linalg.solve(blocks.reshape(count * n, count * n), force.reshape(-1))
    q = q.reshape(count, n)
    return BeamMotion(theta=theta, q=q, qd=speed * (first @ q), speed=speed, period=system.period)


def peaks(values, count):
    """Return the largest sizes of periodic histories ``(nt, ...)``, by parabolas between angles."""
    size = np.abs(resampled(values, count))
    before, after = np.roll(size, 1, axis=0), np.roll(size, -1, axis=0)
    bend = 2.0 * size - before - after
    top = (size >= before) & (size >= after) & (bend > 0.0)
    return np.max(size + (before - after) ** 2 / (8.0 * np.where(top, bend, np.inf)), axis=0)


def turning_bar(angle, *, pinned=False, modulus=210e9, thickness=0.01, drag=0.0, **beam):
    """Return a bar of 1 m whose rigid angle is given with two derivatives by the crank angle.

    Clamped to what turns at its first end and free at the other; or, pinned, held there.  The drag
    is that of its elastic motion, over the mass [1/s].
    """
    section = el.Section.rectangle(0.02, thickness, modulus=modulus, density=7850.0, poisson=0.3)

    def configuration(theta):
        phi, rate, acceleration = angle(theta)
        still = np.zeros((len(theta), 2))
        return {"bar": LinkMotion(still, still, still, phi, rate, acceleration)}

    ends = (("x", "y"), ("x", "y")) if pinned else (("x", "y", "rotation"), ())
    return linear_system(
        el.Structure(
            beams=(el.Beam(name="bar", start="O", end="P", section=section, length=1.0, **beam),),
            nodes=(el.Node(name="O", held=ends[0]), el.Node(name="P", held=ends[1])),
            configuration=configuration,
        ),
        rayleigh=(drag, 0.0),
    )


def cantilever(
    kind="cubic", elements=1, length=1.0, angle=0.0, force=(0.0, 0.0), gravity=(0.0, 0.0)
):
    """Return a bar clamped at O with a force at its end, without stiffness from axial forces."""
    structure = el.frame(
        {"O": (0.0, 0.0), "P": (length * np.cos(angle), length * np.sin(angle))},
        {"bar": ("O", "P")},
        BAR,
        supports={"O": ("x", "y", "rotation")},
        elements=elements,
        kind=kind,
        nodes={"P": {"force": force}},
    )
    return linear_system(structure, gravity=gravity, geometric_stiffness=False)


def steadily(theta):
    """Return an angle that grows with the crank angle, and its derivatives."""
    return theta, np.ones_like(theta), np.zeros_like(theta)


def swinging(size, second=0.0, order=2):
    """Return a function of the crank angle: an angle that swings, and its derivatives."""

    def angle(theta):
        phi = size * np.sin(theta) + second * np.cos(order * theta)
        rate = size * np.cos(theta) - order * second * np.sin(order * theta)
        return phi, rate, -size * np.sin(theta) - order**2 * second * np.cos(order * theta)

    return angle


rocking = swinging(0.4)


def rocking_bar(rng, elements=1, *, thickness=0.01, drag=True):
    """Return a random rocking bar of 1 m and its first frequency."""
    angle = swinging(rng.uniform(0.02, 0.5), rng.uniform(-0.2, 0.2), int(rng.integers(2, 4)))
    pinned = bool(rng.integers(2))
    first = FIRST[pinned] * thickness / 0.01
    loss = 10.0 ** rng.uniform(-2.5, -0.7) * first if drag else 0.0
    made = turning_bar(angle, pinned=pinned, thickness=thickness, drag=loss, elements=elements)
    return made, first


def four_bar(elements=1, sections=SECTIONS, **options):
    """Return the elastic four-bar without modal damping."""
    return el.linkage_system(
        FOUR_BAR, sections, joint_masses=JOINT_MASSES, elements=elements, **options
    )


def damped_four_bar(elements=1, **options):
    """Return the elastic four-bar with 2 % of modal damping."""
    return el.with_modal_damping(four_bar(elements, **options), 0.02)


def rigid_machine(linkage, masses):
    """Return the machine of rigid bars and point masses at the ends of the links named; weight."""
    bars = {
        name: el.MassDistribution.uniform_bar(section.mass_per_length * length, length)
        for name, section in SECTIONS.items()
        if (length := linkage.lengths.get(name))
    }
    for link, mass in masses.items():
        point = el.MassDistribution.point(mass, along=linkage.lengths.get(link, 0.0))
        bars[link] = bars.get(link, el.MassDistribution()) + point
    return el.Machine(linkage, bars, gravity=(0.0, -9.81))


def of_history(history, error=0.0):
    """Return the stress of a bar, all of it axial, ``(nt,)`` or ``(nt, places)``."""
    values = np.reshape(history, (len(history), -1))
    count, places = values.shape
    none = np.zeros_like(values)
    return StressResult(
        method="hand",
        error=error,
        error_norm="none",
        speed=10.0,
        theta=2 * np.pi * np.arange(count) / count,
        links=("bar",) * places,
        places=np.linspace(0.1, 0.9, places),
        axial=values,
        bending=none,
        static_axial=none,
        static_bending=none,
        motion_error=0.0,
        mesh_error=0.0,
        period=2 * np.pi,
    )


def random_linkage(rng, kind):
    """Return a random linkage whose crank turns fully, of a usable transmission angle."""
    while True:
        crank = rng.uniform(0.03, 0.3)
        lengths = {name: rng.uniform(0.2, 0.8) for name in ("coupler", "follower", "frame")}
        try:
            if kind is el.SliderCrank:
                offset = crank * rng.uniform(-0.3, 0.3)
                return el.SliderCrank(crank=crank, coupler=crank * rng.uniform(2, 5), offset=offset)
            found = el.FourBar(crank=crank, **lengths)
            found.require_full_turn()
        except el.BadInput:
            continue
        b, f = lengths["coupler"], lengths["follower"]
        sides = lengths["frame"] + crank * np.array([-1.0, 1.0])
        if np.all(np.abs((b**2 + f**2 - sides**2) / (2 * b * f)) < np.cos(np.radians(25.0))):
            return found


def elastic_linkage(rng, kind, elements):
    """Return a random elastic linkage and its speed, over its least frequency at any angle."""
    made = random_linkage(rng, kind)
    names = ("crank", "coupler", "follower") if kind is el.FourBar else ("crank", "coupler")
    sections = {
        name: el.Section.rectangle(rng.uniform(0.01, 0.03), 10 ** rng.uniform(-2.6, -1.9), **STEEL)
        for name in names
    }
    masses = {"B": rng.uniform(0.0, 0.3), "C": rng.uniform(0.0, 0.3)}
    bare = el.linkage_system(made, sections, joint_masses=masses, elements=elements)
    system = el.with_modal_damping(bare, 10 ** rng.uniform(-2.3, -1.3))
    theta = np.linspace(0.0, 2 * np.pi, 16, endpoint=False)
    flexible = np.linalg.solve(system.array("K", theta), system.array("M", theta))
    least = np.min(np.max(np.linalg.eigvals(flexible).real, axis=1) ** -0.5)
    return system, rng.uniform(0.03, 0.45) * least
