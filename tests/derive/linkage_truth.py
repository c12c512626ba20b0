"""The four-bar linkage in many digits, from the closure of its loop and Newton's law alone.

Nothing here shares a formula with the package: the follower angle solves Freudenstein's quadratic
in its half-angle tangent, the coupler angle follows from the place of C, rates and accelerations
from the two closure equations differentiated, pin forces from a 2 x 2 solve of moments.
"""

from dataclasses import dataclass
from functools import lru_cache

import mpmath
import numpy as np
from elastolink.generated import four_bar_kinematics
from judging import Exact, Point, exact_at

LENGTHS = ("frame", "crank", "coupler", "follower")
OUTPUTS = ("theta3", "theta4", "omega3", "omega4", "alpha3", "alpha4", "transmission_angle")
TURN = 2.0 * np.pi


@lru_cache(maxsize=64)
def _cosine_sine(angle, precision):
    return mpmath.mp.cos_sin(angle)


def cosine_sine(angle):
    """Return cosine and sine; one angle of a pose is asked for many times."""
    return _cosine_sine(angle, mpmath.mp.prec)


def angles(theta2, frame, crank, coupler, follower, assembly):
    """Return theta3 and theta4 between -pi and pi; closed to the working precision."""
    bx, by = (crank * part for part in cosine_sine(theta2))
    ex, ey = frame - bx, -by  # from B to D
    # |BD + l4 e4|^2 = l3^2:   2 l4 (ex cos + ey sin) = l3^2 - l4^2 - BD^2 = k
    k = (coupler**2 - follower**2 - ex**2 - ey**2) / (2 * follower)
    # with t = tan(theta4 / 2):   (k + ex) t^2 - 2 ey t + (k - ex) = 0
    if ey**2 + ex**2 < k**2:
        raise ValueError("the linkage does not close at this angle")
    root = mpmath.sqrt(ey**2 + ex**2 - k**2)
    for sign in (1, -1):
        # Of the root's two forms the one whose terms do not cancel.
        ratio = (ey + sign * root, k + ex) if sign * ey >= 0 else (k - ex, ey - sign * root)
        theta4 = 2 * mpmath.atan2(*ratio)
        theta4 = mpmath.atan2(mpmath.sin(theta4), mpmath.cos(theta4))
        cx = ex + follower * mpmath.cos(theta4)
        cy = ey + follower * mpmath.sin(theta4)
        theta3 = mpmath.atan2(cy, cx)
        if mpmath.sign(mpmath.sin(theta4 - theta3)) == mpmath.sign(assembly):
            return theta3, theta4
    raise ValueError("no such assembly at this angle")


def motion(numbers, near=None):
    """Return the outputs of the emitted ``motion`` by name, from mpmath numbers by name.

    Angles are between -pi and pi, or of the multiple of 2 pi next to ``near``.
    """
    theta2 = numbers["theta2"]
    frame, crank, coupler, follower = (numbers[name] for name in LENGTHS)
    theta3, theta4 = angles(theta2, frame, crank, coupler, follower, numbers["assembly"])
    pi2 = 2 * mpmath.pi
    if near is not None:
        theta3 += pi2 * mpmath.nint((near["theta3"] - theta3) / pi2)
        theta4 += pi2 * mpmath.nint((near["theta4"] - theta4) / pi2)
    (c2, s2), (c3, s3), (c4, s4) = map(cosine_sine, (theta2, theta3, theta4))
    matrix = (-coupler * s3, follower * s4, coupler * c3, -follower * c4)
    omega3, omega4 = solve(*matrix, crank * s2, -crank * c2)
    alpha3, alpha4 = solve(
        *matrix,
        crank * c2 + coupler * c3 * omega3**2 - follower * c4 * omega4**2,
        crank * s2 + coupler * s3 * omega3**2 - follower * s4 * omega4**2,
    )
    diagonal2 = frame**2 + crank**2 - 2 * frame * crank * c2
    cosine = (coupler**2 + follower**2 - diagonal2) / (2 * coupler * follower)
    return {
        "theta3": theta3,
        "theta4": theta4,
        "omega3": omega3,
        "omega4": omega4,
        "alpha3": alpha3,
        "alpha4": alpha4,
        "transmission_angle": mpmath.acos(cosine),
    }


def solve(a, b, c, d, right, below):
    """Return the solution of ``[[a, b], [c, d]] v = (right, below)``."""
    determinant = a * d - b * c
    return (right * d - b * below) / determinant, (a * below - right * c) / determinant


def end_load(numbers, m, inertia3=0, moment3=0, inertia4=0, rate=1, acceleration=0):
    """Return the pull of the follower on the coupler along BC: Newton and Euler, Smith (4.4)-(4.6).

    Moments of the coupler about the moving crank pin B, of the follower about the fixed pin D.
    """
    coupler, follower = numbers["coupler"], numbers["follower"]
    turn = numbers["theta2"] - m["theta3"]
    alpha3 = m["alpha3"] * rate**2 + m["omega3"] * acceleration
    alpha4 = m["alpha4"] * rate**2 + m["omega4"] * acceleration
    # Acceleration of B across BC, for its moment of momentum.
    cosine, sine = cosine_sine(turn)
    across = numbers["crank"] * (-(rate**2) * sine + acceleration * cosine)
    (c3, s3), (c4, s4) = cosine_sine(m["theta3"]), cosine_sine(m["theta4"])
    force_x, force_y = solve(
        -coupler * s3,
        coupler * c3,
        follower * s4,
        -follower * c4,
        inertia3 * alpha3 + moment3 * across,
        inertia4 * alpha4,
    )
    return force_x * c3 + force_y * s3


def coupler_functions(numbers, m):
    """Return the functions of angle in the emitted coupler equations by name.

    From the balance of the coupler's element: the tension is the end load and what the part
    beyond x needs for its acceleration along BC; the load across is that of the rigid link.
    """
    coupler, crank = numbers["coupler"], numbers["crank"]
    cosine, sine = cosine_sine(numbers["theta2"] - m["theta3"])
    found = {
        "angle_omega3": m["omega3"] ** 2,
        "angle_cos23": -cosine * crank / (2 * coupler),
        "acceleration_sin23": -sine * crank / (2 * coupler),
        "forcing_alpha3": 2 * m["alpha3"],
        "forcing_sin23": -2 * crank * sine / coupler,
        "acceleration_forcing_omega3": 2 * m["omega3"],
        "acceleration_forcing_cos23": 2 * crank * cosine / coupler,
    }
    for argument, name in (
        ("inertia3", "coupler_inertia"),
        ("moment3", "coupler_first_moment"),
        ("inertia4", "follower_inertia"),
    ):
        unit = {argument: 1}
        steady = end_load(numbers, m, **unit)
        starting = end_load(numbers, m, **unit, rate=0, acceleration=1)
        found[f"angle_end_load_{name}_speed"] = -steady / coupler**2
        found[f"acceleration_end_load_{name}_acceleration"] = -starting / coupler**2
    return found


@lru_cache(maxsize=1)
def exact_points() -> tuple[Exact, ...]:
    """Return exact motion and coupler functions at 200 random and all nasty points."""
    return tuple(exact_near(point) for point in random_points(200, seed=20) + nasty_points())


def exact_near(point) -> Exact:
    """Return exact motion and coupler functions on the branch of the emitted motion."""
    emitted = dict(zip(OUTPUTS, four_bar_kinematics.motion(**point.arguments), strict=True))
    near = {name: mpmath.mpf(float(emitted[name])) for name in ("theta3", "theta4")}

    def reference(numbers):
        m = motion(numbers, near)
        return {**m, **coupler_functions(numbers, m)}

    return exact_at(reference, point)


@dataclass(frozen=True)
class Linkage:
    """Lengths and assembly of a four-bar linkage whose crank turns fully."""

    frame: float
    crank: float
    coupler: float
    follower: float
    assembly: float

    @property
    def lengths(self) -> dict[str, float]:
        return {name: getattr(self, name) for name in LENGTHS}

    def point(self, name: str, theta2: float) -> Point:
        fixed = {"assembly": self.assembly, "winding": float(self.crank > self.frame)}
        return Point(name, {"theta2": float(theta2), **self.lengths}, fixed)


def random_linkage(random: np.random.Generator, kind: str) -> Linkage:
    """Return a crank rocker (``"rocker"``) or drag link (``"drag"``), sizes over six decades."""
    while True:
        shortest, *others = np.sort(10.0 ** random.uniform(-1.0, 1.0, 4))
        others = random.permutation(others)
        if kind == "rocker":
            lengths = (others[0], shortest, others[1], others[2])
        else:
            lengths = (shortest, *others)
        frame, crank, coupler, follower = lengths
        if abs(frame - crank) > abs(coupler - follower) * (1 + 1e-9) and frame + crank < (
            coupler + follower
        ) * (1 - 1e-9):
            scale = 10.0 ** random.uniform(-3.0, 3.0)
            sign = random.choice([-1.0, 1.0])
            return Linkage(*(float(scale * length) for length in lengths), float(sign))


def random_points(count: int, seed: int) -> list[Point]:
    """Return points of random linkages, both types and assemblies, over a few turns."""
    random = np.random.default_rng(seed)
    points = []
    for i in range(count):
        kind = "drag" if i % 2 else "rocker"
        linkage = random_linkage(random, kind)
        theta = random.uniform(-3 * TURN, 3 * TURN)
        points.append(linkage.point(f"random {kind} {i}", theta))
    return points


_HAIR = {
    # Change points: the crank only just passes (or the linkage only just turns).
    "coupler and follower a hair longer than frame and crank": (3.0, 1.0, 2.0 + 1e-13, 2.0),
    "frame a hair longer than crank and follower less coupler": (3.0 + 1e-13, 1.0, 4.0, 2.0),
    "kite, a hair from folding": (2.0 + 1e-12, 1.0, 2.0, 1.0 + 2e-12),
    "parallelogram, a hair from folding": (2.0, 1.0, 2.0 + 5e-13, 1.0 + 1e-12),
    "near parallelogram, 1e-9": (2.0, 1.0, 2.0 + 5e-10, 1.0 + 1e-9),
    "rhombus, a hair from folding": (1.0 + 3e-10, 1.0, 1.0 + 1e-10, 1.0 + 3e-10),
    "drag link, a hair from folding": (1.0, 2.0, 2.0 + 5e-13, 1.0 + 1e-12),
    "drag link at its other change point": (1.0, 3.0, 2.0 + 1e-13, 2.0),
}
_SHAPES = {
    "Smith 5,1,5,2": (5.0, 1.0, 5.0, 2.0),
    "Smith 10,1,10,4": (10.0, 1.0, 10.0, 4.0),
    "Smith 10,8,10,10": (10.0, 8.0, 10.0, 10.0),
    "three equal links": (2.0, 1.0, 2.0, 2.0),
    "drag link": (2.0, 4.0, 5.0, 4.5),
    "drag link, three equal links": (1.0, 2.0, 2.0, 2.0),
    "crank 1e-6 of the frame": (1.0, 1e-6, 1.0, 0.5),
    "crank 1e-6 of equal links": (1.0, 1e-6, 1.0, 1.0),
    "frame 1e-6 of the crank": (1e-6, 1.0, 1.0, 0.5),
    "frame 1e-6 of equal links": (1e-6, 1.0, 1.0, 1.0),
}
_ANGLES = {
    **{f"{k} quarter turns": k * np.pi / 2 for k in range(-3, 5)},
    "5e-324": 5e-324,
    "1e-300": 1e-300,
    "1e-12": 1e-12,
    "1e-8 beyond the inner dead centre": 1e-8,
    "1e-8 before the inner dead centre": -1e-8,
    "1e-8 beyond the outer dead centre": np.pi + 1e-8,
    "1e-8 before the outer dead centre": np.pi - 1e-8,
    "1000 turns": 1000 * TURN,
    "1000 turns and a bit": 1000 * TURN + 1.0,
    "-1000 turns and a half": -1000 * TURN - np.pi,
    "generic": 0.7,
}


def nasty_points() -> list[Point]:
    """Return the named points at which a careless formula loses its digits."""
    points = []
    for shape, lengths in {**_SHAPES, **_HAIR}.items():
        for assembly, word in ((1.0, "open"), (-1.0, "crossed")):
            linkage = Linkage(*lengths, assembly)
            for angle, theta in _ANGLES.items():
                points.append(linkage.point(f"{shape}, {word}, {angle}", theta))
    return points
