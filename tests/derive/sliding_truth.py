"""Slider-crank and quick-return in many digits, from the closure of their loops alone.

Nothing here shares a formula with the package: the slider's place solves the quadratic equation of
Pythagoras in the triangle of the coupler, the rod's angle is the argument of a complex number, and
rates solve the closure equations differentiated, two by two.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import product

import mpmath
import numpy as np
from elastolink.generated import quick_return_kinematics, slider_crank_kinematics
from judging import Exact, Point, exact_at
from linkage_truth import _ANGLES, TURN, solve

# Half of 5e-324 is 0, and an angle that is proportional to it has no digits that could be kept.
ANGLES = {name: angle for name, angle in _ANGLES.items() if name != "5e-324"}
SLIDER = slider_crank_kinematics.RETURNS["motion"]
ROD = quick_return_kinematics.RETURNS["motion"]


def slider_motion(numbers):
    """Return what the emitted ``motion`` of the slider-crank should."""
    theta2, crank, coupler, offset, assembly = (
        numbers[name] for name in ("theta2", "crank", "coupler", "offset", "assembly")
    )
    cosine, sine = mpmath.cos(theta2), mpmath.sin(theta2)
    # |C - B|^2 = l3^2:   s^2 - 2 s l2 cos + l2^2 + e^2 - 2 e l2 sin - l3^2 = 0
    rest = crank**2 + offset**2 - 2 * offset * crank * sine - coupler**2
    discriminant = (crank * cosine) ** 2 - rest
    if discriminant < 0:
        raise ValueError("the linkage does not close at this angle")
    place = crank * cosine + assembly * mpmath.sqrt(discriminant)
    dx, dy = place - crank * cosine, offset - crank * sine
    theta3 = mpmath.atan2(dy, dx)
    if assembly < 0 and theta3 < 0:
        theta3 += 2 * mpmath.pi
    # Rows: x and y of B C; unknowns omega3, velocity.
    matrix = (-dy, -1, dx, 0)
    omega3, velocity = solve(*matrix, crank * sine, -crank * cosine)
    alpha3, acceleration = solve(
        *matrix, crank * cosine + dx * omega3**2, crank * sine + dy * omega3**2
    )
    return {
        "theta3": theta3,
        "position": place,
        "omega3": omega3,
        "alpha3": alpha3,
        "slider_velocity": velocity,
        "slider_acceleration": acceleration,
        "transmission_angle": mpmath.acos(dy / coupler),
    }


def rod_motion(numbers, near=None):
    """Return what the emitted ``motion`` of the quick-return should.

    theta4 is between -pi and pi, or of the multiple of 2 pi next to ``near``.
    """
    theta2, frame, crank = (numbers[name] for name in ("theta2", "frame", "crank"))
    pin = crank * mpmath.expj(theta2)
    reach = frame + pin
    slide, theta4 = abs(reach), mpmath.arg(reach)
    if near is not None:
        theta4 += 2 * mpmath.pi * mpmath.nint((near - theta4) / (2 * mpmath.pi))
    ahead = reach / slide
    # slide e^(i theta4) differentiated: (v + i slide w) e^(i theta4) = i pin
    turned = mpmath.mpc(0, 1) * pin / ahead
    velocity, omega4 = turned.real, turned.imag / slide
    turned = -pin / ahead
    acceleration = turned.real + slide * omega4**2
    alpha4 = (turned.imag - 2 * velocity * omega4) / slide
    return {
        "theta4": theta4,
        "slide": slide,
        "omega4": omega4,
        "alpha4": alpha4,
        "slide_velocity": velocity,
        "slide_acceleration": acceleration,
    }


@dataclass(frozen=True)
class Slider:
    """Lengths and assembly of a slider-crank."""

    crank: float
    coupler: float
    offset: float
    assembly: float = 1.0

    def point(self, name: str, theta2: float) -> Point:
        lengths = {"crank": self.crank, "coupler": self.coupler, "offset": self.offset}
        return Point(name, {"theta2": float(theta2), **lengths}, {"assembly": self.assembly})

    def reaches(self, theta2: float) -> bool:
        return abs(self.offset - self.crank * np.sin(theta2)) < self.coupler * (1 - 1e-12)


def rod_point(name: str, frame: float, crank: float, theta2: float) -> Point:
    """Return a point of the quick-return's emitted function."""
    inputs = {"theta2": float(theta2), "frame": float(frame), "crank": float(crank)}
    return Point(name, inputs, {"winding": float(crank > frame)})


def random_sliders(count: int, seed: int, *, turning: bool = False) -> list[Point]:
    """Return points of random slider-cranks, those whose crank cannot turn among them."""
    random, points = np.random.default_rng(seed), []
    while len(points) < count:
        scale = 10.0 ** random.uniform(-3.0, 3.0)
        crank, coupler, offset = scale * 10.0 ** random.uniform(-1.0, 1.0, 3)
        offset *= random.choice([-1.0, 0.0, 1.0, 1.0])
        slider = Slider(
            float(crank), float(coupler), float(offset), float(random.choice([-1.0, 1.0]))
        )
        theta = random.uniform(-3 * TURN, 3 * TURN)
        turns = coupler > (crank + abs(offset)) * (1 + 1e-9)
        if slider.reaches(theta) and (turns or not turning):
            word = "turning" if turns else "swinging"
            points.append(slider.point(f"random {word} slider-crank {len(points)}", theta))
    return points


def random_rods(count: int, seed: int) -> list[Point]:
    """Return points of random quick-returns, cranks shorter and longer than the frame."""
    random, points = np.random.default_rng(seed), []
    for i in range(count):
        frame, crank = 10.0 ** random.uniform(-3.0, 3.0) * 10.0 ** random.uniform(-1.0, 1.0, 2)
        theta = random.uniform(-3 * TURN, 3 * TURN)
        points.append(rod_point(f"random quick-return {i}", frame, crank, theta))
    return points


_SLIDERS = {
    "engine": (1.0, 3.5, 0.0),
    "engine, offset": (1.0, 3.5, 0.7),
    "offset below": (1.0, 3.5, -1.3),
    "crank and coupler a hair from equal": (1.0, 1.0 + 1e-13, 0.0),
    "crank and coupler 1e-9 from equal": (1.0, 1.0 + 1e-9, 0.0),
    "coupler a hair longer than crank and offset": (1.0, 3.0 + 1e-13, 2.0),
    "coupler a hair longer than crank and offset below": (1.0, 3.0 + 1e-13, -2.0),
    "offset a hair from nothing": (1.0, 2.0, 1e-13),
    "crank 1e-6 of the coupler": (1e-6, 1.0, 0.0),
    "crank 1e-6, offset": (1e-6, 1.0, 0.5),
    "crank 1e-6, coupler nearly across": (1e-6, 1.0, 0.99),
    "coupler 1e6": (1.0, 1e6, 3.0),
    "offset far over the crank": (1.0, 1e3, 9e2),
}
_RODS = {
    "half": (2.0, 1.0),
    "Whitworth": (1.0, 2.0),
    "crank a hair shorter": (1.0, 1.0 - 1e-13),
    "crank a hair longer": (1.0, 1.0 + 1e-13),
    "crank 1e-9 shorter": (1.0, 1.0 - 1e-9),
    "crank 1e-6 of the frame": (1.0, 1e-6),
    "frame 1e-6 of the crank": (1e-6, 1.0),
}


def nasty_sliders() -> list[Point]:
    """Return the named points at which a careless formula loses its digits."""
    return [
        Slider(*lengths, assembly).point(f"{shape}, {word}, {angle}", theta)
        for (shape, lengths), (assembly, word), (angle, theta) in product(
            _SLIDERS.items(), ((1.0, "open"), (-1.0, "crossed")), ANGLES.items()
        )
    ]


def nasty_rods() -> list[Point]:
    """Return the named points of the quick-return."""
    return [
        rod_point(f"{shape}, {angle}", *lengths, theta)
        for (shape, lengths), (angle, theta) in product(_RODS.items(), ANGLES.items())
    ]


@lru_cache(maxsize=1)
def exact_sliders() -> tuple[Exact, ...]:
    """Return the exact motion of 200 random and all nasty slider-cranks."""
    points = random_sliders(200, seed=24) + nasty_sliders()
    return tuple(exact_at(slider_motion, point) for point in points)


@lru_cache(maxsize=1)
def exact_rods() -> tuple[Exact, ...]:
    """Return the exact motion of 200 random and all nasty quick-returns."""
    found = []
    for point in random_rods(200, seed=25) + nasty_rods():
        theta4 = quick_return_kinematics.motion(**point.arguments)[0]

        def reference(numbers, near=theta4):
            return rod_motion(numbers, mpmath.mpf(float(near)))

        found.append(exact_at(reference, point))
    return tuple(found)


EXACT: dict[str, Callable[[], tuple[Exact, ...]]] = {
    "slider_crank_kinematics": exact_sliders,
    "quick_return_kinematics": exact_rods,
}
