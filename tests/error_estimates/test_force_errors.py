"""The error estimate of the forces against 60 digits, over random machines of every linkage."""

import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar, SliderCrank
from elastolink.runtime.rigid import Load, Machine, MassDistribution, rigid_forces
from forces_truth import cross, inertia_pushes, links, reactions
from honesty import over_scenes
from random_linkages import KINDS, random_linkage

DIGITS = 60
_NAMES = {"FourBar": "four_bar", "SliderCrank": "slider_crank", "QuickReturn": "quick_return"}
ANGLES = 2


def forces(machine, theta, speed, acceleration, outside):
    """Return every force by name, as mpmath numbers.

    Masses and gravity are the machine's; ``outside`` is, by link, force and couple at its first
    joint.
    """
    mechanism = _NAMES[type(machine.linkage).__name__]
    linkage = machine.linkage
    numbers = {**linkage.lengths, "assembly": linkage.branch, "theta2": theta}
    numbers |= {"speed": speed, "acceleration": acceleration}
    for n, link in enumerate(machine.linkage.links, start=2):
        mass = machine.mass(link)
        numbers |= {f"{x}{n}": getattr(mass, x) for x in ("mass", "along", "across", "inertia")}
    with mpmath.workdps(DIGITS):
        numbers = {name: mpmath.mpf(float(value)) for name, value in numbers.items()}
        bodies, _ = links(mechanism, numbers)
        gravity = mpmath.mpc(*machine.gravity)
        pushes = []
        for n, (link, body, (force, moment)) in enumerate(
            zip(machine.linkage.links, bodies, inertia_pushes(numbers, bodies), strict=True), 2
        ):
            fx, fy, couple = map(mpmath.mpf, outside.get(link, (0.0, 0.0, 0.0)))
            arm = mpmath.mpc(numbers[f"along{n}"], numbers[f"across{n}"]) * body[2]
            push = force - numbers[f"mass{n}"] * gravity - mpmath.mpc(fx, fy)
            pushes.append((push, moment - cross(arm, gravity) - couple))
        return reactions(mechanism, numbers, pushes)


def compared(machine, found, outside=None):
    """Return the actual error at each angle in the norm of the error estimate, and the estimate."""
    longest = max(abs(length) for length in machine.linkage.lengths.values())
    worst = []
    for i, theta in enumerate(found.theta2):
        speed = np.broadcast_to(found.speed, found.theta2.shape)[i]
        acceleration = np.broadcast_to(found.acceleration, found.theta2.shape)[i]
        with mpmath.workdps(DIGITS):
            exact = forces(machine, theta, speed, acceleration, outside or {})
            gaps = [
                abs(mpmath.mpf(float(value[i])) - exact[name])
                / (longest if name in ("torque", "shaking_moment", "couple34", "couple41") else 1)
                for name, value in found.values.items()
            ]
            worst.append(float(max(gaps)))
    return np.array(worst), np.asarray(found.error)


def random_machine(kind, random):
    linkage = random_linkage(random, kind, 10.0 ** random.uniform(-3, 3))
    size = max(linkage.lengths.values())
    masses = {}
    for link in linkage.links:
        if random.random() < 0.2:
            continue
        mass = 10.0 ** random.uniform(-2, 2)
        along, across = random.uniform(-0.7, 1.0) * size, random.uniform(-0.3, 0.3) * size
        across = 0.0 if random.random() < 0.3 else across
        inertia = mass * size**2 * random.uniform(0.0, 0.2)
        masses[link] = MassDistribution.about_centre(mass, along, across, inertia)
    if not masses:
        masses["coupler" if "coupler" in linkage.links else "rod"] = MassDistribution(inertia=1.0)
    wrenches = {}
    if random.random() < 0.4:
        wrenches[linkage.links[2]] = tuple(random.normal(size=3) * (1.0, 1.0, size))
    loads = tuple(Load(link, force[:2], force[2]) for link, force in wrenches.items())
    gravity = (0.0, -9.81) if random.random() < 0.4 else (0.0, 0.0)
    return Machine(linkage, masses, gravity, loads), wrenches


def random_angles(linkage, random):
    low, high = linkage.crank_ranges()[int(random.integers(len(linkage.crank_ranges())))]
    # Now and then a hair's breadth from the fold, or from where a full turn comes nearest to one.
    share = random.uniform(0.001, 0.999, ANGLES)
    if random.random() < 0.2:
        share[0] = 10.0 ** random.uniform(-6, -3)
    return low + share * (high - low)


@over_scenes(20260, few=20, many=80, floor=np.finfo(float).tiny)
@pytest.mark.parametrize("kind", KINDS)
def test_the_estimate_covers_the_error_and_is_not_idle(rng, kind):
    machine, wrenches = random_machine(kind, rng)
    theta = random_angles(machine.linkage, rng)
    speed = 10.0 ** rng.uniform(-1, 3)
    acceleration = float(rng.choice([0.0, 1.0])) * rng.normal() * speed**2
    found = rigid_forces(machine, theta, speed, acceleration)
    actual, estimate = compared(machine, found, outside=wrenches)
    assert found.passed == bool(np.all(np.isfinite(estimate)))
    return estimate, actual


def near_change(kind, random):
    """Return a linkage near a change point, and a crank angle near a fold or near the change."""
    while True:
        lengths = 10.0 ** random.uniform(-1.5, 0.0, 4) * 10.0 ** random.uniform(-3, 6)
        off = 1.0 + 10.0 ** random.uniform(-12, -3) * random.choice([-1.0, 1.0])
        one, two, three, last = random.permutation(4)
        lengths[last] = abs(lengths[one] + lengths[two] - lengths[three]) * off
        branch = random.choice(["open", "crossed"])
        try:
            if kind == "four-bar":
                linkage = FourBar(*map(float, lengths), branch)
            else:
                crank, coupler = map(float, lengths[:2])
                offset = random.choice([0.0, abs(crank - coupler) * off])
                linkage = SliderCrank(crank, coupler, float(offset), branch)
            ranges = linkage.crank_ranges()
            low, high = ranges[int(random.integers(len(ranges)))]
            share = 10.0 ** random.uniform(-10, 0)
            theta = random.choice([low + share * (high - low), high - share * (high - low)])
            linkage.motion(theta)
            return linkage, float(theta)
        except BadInput:
            continue


def lumps(linkage):
    """Return masses of every link, off its line."""
    size = linkage.lengths["crank"]
    sizes = {link: linkage.lengths.get(link, size) for link in linkage.links}
    return {
        link: MassDistribution.about_centre(1.0, 0.3 * own, 0.1 * own, 0.2 * own**2)
        for link, own in sizes.items()
    }


@pytest.mark.parametrize("scenes", [30, pytest.param(120, marks=pytest.mark.slow)])
@pytest.mark.parametrize("kind", ["four-bar", "slider-crank"])
def test_the_estimate_covers_the_error_near_change_points_and_folds(kind, scenes) -> None:
    random = np.random.default_rng(90)
    shares, known = [], 0
    for _ in range(scenes):
        linkage, theta = near_change(kind, random)
        machine = Machine(linkage, lumps(linkage))
        try:
            found = rigid_forces(machine, [theta], 10.0 ** random.uniform(-3, 2), random.normal())
            actual, estimate = compared(machine, found)
        except ValueError:  # refused, or in many digits the linkage does not reach the angle
            continue
        assert found.passed == bool(np.isfinite(estimate[0]))
        known += bool(np.isfinite(estimate[0]))
        shares.append(float(actual[0] / estimate[0]))
    assert known > 0.8 * len(shares)
    assert len(shares) > 0.8 * scenes
    assert max(shares) <= 1.0
    assert np.median(shares) >= 1e-3


@pytest.mark.parametrize(
    ("linkage", "theta", "speed", "acceleration"),
    [
        (
            FourBar(
                0.22870767452519397, 0.1328884680702529, 0.14214426318859136, 0.2194518793383923
            ),
            -3.140645789157872,
            10.0,
            0.0,
        ),
        (
            FourBar(987635.9984780651, 690374.4558117427, 1675199.272225518, 2811.182003136147),
            -3.141459496765695,
            1e-3,
            0.0,
        ),
        (SliderCrank(0.0016513553304968302, 8.298065090076801e-05), 0.04780407482999341, 10.0, 5.0),
        # Here the coupler's height is a small difference of large parts of the crank.
        (
            SliderCrank(70.74758551208086, 0.42933700970465943),
            0.006034717525772312,
            0.002547284828053281,
            1.3338402777555505e-05,
        ),
    ],
)
def test_the_estimate_covers_known_bad_cases(linkage, theta, speed, acceleration) -> None:
    machine = Machine(linkage, lumps(linkage))
    found = rigid_forces(machine, [theta], speed, acceleration)
    actual, estimate = compared(machine, found)
    assert actual[0] <= estimate[0] < np.inf
    assert found.passed


def test_exactly_at_a_fold_nothing_is_known() -> None:
    linkage = FourBar(0.3, 0.25, 0.1, 0.1)
    machine = Machine(linkage, {"coupler": MassDistribution.uniform_bar(1.0, 0.1)})
    low, high = linkage.crank_ranges()[0]
    inside, end = 0.5 * (low + high), np.nextafter(high, low)
    for theta in (end, [inside, end, inside]):
        found = rigid_forces(machine, theta, 1.0)
        assert np.max(found.error) == np.inf
        assert not found.checks["error over what is added up"].passed
    assert rigid_forces(machine, inside, 1.0).passed


def test_forces_that_cancel_are_no_fold() -> None:
    """A crank whose weight is borne by a load: no force is left, and none is lost."""
    weight = Load("crank", (0.0, 9.81), along=0.1)
    crank = MassDistribution.point(1.0, 0.1)
    machine = Machine(FourBar(0.3, 0.1, 0.28, 0.25), {"crank": crank}, (0.0, -9.81), (weight,))
    found = rigid_forces(machine, np.linspace(0.0, 6.0, 7), 0.0)
    assert np.max(np.abs(found.torque)) < 1e-15
    assert found.passed
    assert np.all(np.isfinite(found.error))
