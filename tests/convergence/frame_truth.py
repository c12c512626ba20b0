"""Random frames, and their frequencies from the determinant of the exact stiffness, many digits."""

import frequency_truth
import mpmath
import numpy as np
from elastolink.runtime.beams import Section, frame
from elastolink.runtime.frequencies import dynamic_stiffness

CLAMPED = ("x", "y", "rotation")
DIGITS = 60


def random_section(rng):
    """Return a section of a bar whose thickness is 1/300 to 1/20 of the lengths here."""
    thickness = float(10.0 ** rng.uniform(-2.5, -1.3))
    return Section.rectangle(
        float(10.0 ** rng.uniform(-2, -1)),
        thickness,
        modulus=float(10.0 ** rng.uniform(9, 11.5)),
        density=float(10.0 ** rng.uniform(3, 4)),
    )


def random_frame(rng, elements=1, kind="cubic"):
    """Return a frame of 2 to 4 members with masses, springs and pins here and there."""
    count = int(rng.integers(2, 5))
    letters = "ABCDE"[: count + 1]
    angle = rng.uniform(0, 2 * np.pi)
    places, at = {}, np.zeros(2)
    for letter in letters:
        places[letter] = (float(at[0]), float(at[1]))
        angle += rng.uniform(-1.8, 1.8)
        at = at + rng.uniform(0.3, 1.5) * np.array([np.cos(angle), np.sin(angle)])
    members = {f"m{i}": (letters[i], letters[i + 1]) for i in range(count)}
    if count > 2 and rng.uniform() < 0.4:
        members["tie"] = (letters[0], letters[2])
    sections = {name: random_section(rng) for name in members}
    nodes: dict[str, dict] = {letter: {} for letter in letters}
    inner = letters[1:-1]
    pins = [letter for letter in inner if rng.uniform() < 0.2]
    for letter in inner:
        if rng.uniform() < 0.4:
            nodes[letter]["mass"] = float(10.0 ** rng.uniform(-3, 1))
        if rng.uniform() < 0.3:
            nodes[letter]["stiffness"] = {"x": float(10.0 ** rng.uniform(2, 7))}
        if letter not in pins and rng.uniform() < 0.3:
            nodes[letter]["inertia"] = float(10.0 ** rng.uniform(-5, -1))
    supports = {letters[0]: CLAMPED}
    supports[letters[-1]] = (CLAMPED, ("x", "y"), ("y",), ())[int(rng.integers(4))]
    if pins:  # no mechanism
        supports[letters[-1]] = CLAMPED
        pins = pins[:1]
    return frame(
        places,
        members,
        sections,
        supports=supports,
        pins=pins,
        elements=elements,
        kind=kind,
        nodes=nodes,
    )


def portal(elements=1, kind="cubic"):
    """Return the frame of Aannaque's Table 5.1: sqrt(EI / (rho A)) = 1 m^2/s, bars of 1 m."""
    bar = Section(area=1e-4, second_moment=1e-9, modulus=1e9, density=1e4)
    return frame(
        {"A": (0, 0), "B": (0, 1), "C": (1, 1), "D": (1, 0)},
        {"left": ("A", "B"), "beam": ("B", "C"), "right": ("D", "C")},
        bar,
        supports={"A": CLAMPED, "D": CLAMPED},
        elements=elements,
        kind=kind,
    )


def exact_stiffness(problem, omega):
    """Return D of a structure of one element for each member as an mpmath matrix."""
    assembly, structure_freedoms = problem.assembly, problem.structure.freedoms
    size = assembly.size
    total = mpmath.zeros(size)
    lengths, bending, axial, mass = (
        [mpmath.mpf(float(value)) for value in getattr(assembly.members, name)]
        for name in ("length", "bending", "axial", "mass")
    )
    for k, (length, ei, ea, m) in enumerate(zip(lengths, bending, axial, mass, strict=True)):
        local = _local(omega, length, ei, ea, m)
        turn = _turn(mpmath.mpf(float(assembly.angles[k])))
        matrix = turn.T * local * turn
        places = _places(structure_freedoms, k)
        for i, row in enumerate(places):
            for j, column in enumerate(places):
                if row >= 0 and column >= 0:
                    total[row, column] += matrix[i, j]
    for i in range(size):
        total[i, i] += mpmath.mpf(float(assembly.springs[i]))
        total[i, i] -= omega**2 * mpmath.mpf(float(assembly.lumped_mass[i]))
    return total


def _places(freedoms, k):
    """Return the coordinate of each ground value of a member's ends, -1 where it is held."""
    place = np.full(len(freedoms.all), -1)
    place[freedoms.free] = np.arange(len(freedoms.free))
    return place[freedoms.elements[k].indices]


def _local(omega, length, ei, ea, m):
    z = mpmath.sqrt(omega) * length * mpmath.root(m / ei, 4)
    b = omega * length * mpmath.sqrt(m / ea)
    along = frequency_truth.axial(b)
    bend = frequency_truth.stiffness(z)
    scale = (1, length, 1, length)
    local = mpmath.zeros(6)
    spots = (1, 2, 4, 5)
    for i, row in enumerate(spots):
        for j, column in enumerate(spots):
            local[row, column] = ei / length**3 * scale[i] * scale[j] * bend[i, j]
    local[0, 0] = local[3, 3] = ea / length * along["F7"]
    local[0, 3] = local[3, 0] = ea / length * along["F8"]
    return local


def _turn(angle):
    c, s = mpmath.cos(angle), mpmath.sin(angle)
    turn = mpmath.eye(6)
    for node in (0, 3):
        turn[node, node] = turn[node + 1, node + 1] = c
        turn[node, node + 1], turn[node + 1, node] = s, -s
    return turn


def exact_frequency(structure, near):
    """Return the root of the determinant next to a frequency that is right to ten digits."""
    problem = dynamic_stiffness(structure)
    with mpmath.workdps(DIGITS):
        start = mpmath.mpf(float(near))

        scale = mpmath.det(exact_stiffness(problem, start * (1 + mpmath.mpf("1e-6"))))

        def determinant(factor):
            return mpmath.det(exact_stiffness(problem, start * factor)) / scale

        nearby = (1 - mpmath.mpf("1e-10"), 1 + mpmath.mpf("1e-10"))
        root = mpmath.findroot(determinant, nearby, tol=1e-50, verify=False)
        assert abs(determinant(root)) < 1e-30
        return start * root
