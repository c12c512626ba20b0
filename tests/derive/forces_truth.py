"""Forces of rigid linkages in many digits: free bodies, moments first, then sums of forces.

Angles and their derivatives come from the closures of ``linkage_truth`` and ``sliding_truth``;
vectors are complex numbers.  No formula is shared with the package.
"""

from functools import lru_cache

import linkage_truth
import mpmath
import numpy as np
import sliding_truth
from judging import Point, exact_at
from linkage_truth import solve

MECHANISMS = ("four_bar", "slider_crank", "quick_return")
MOMENTS = tuple(f"{name}{n}" for n in (2, 3, 4) for name in ("mass", "along", "across", "inertia"))
LOADS = tuple(f"{name}{n}" for n in (2, 3, 4) for name in ("fx", "fy", "couple"))
_GEOMETRY = {
    "four_bar": ("frame", "crank", "coupler", "follower", "assembly"),
    "slider_crank": ("crank", "coupler", "offset", "assembly"),
    "quick_return": ("frame", "crank"),
}
_ANGLES = (0.0, np.pi / 2, np.pi, 1e-8, np.pi + 1e-8, 0.7, 1000 * 2 * np.pi + 1.0)


def cross(a, b):
    return a.real * b.imag - a.imag * b.real


@lru_cache(maxsize=256)
def _motion(mechanism, precision, theta2, *geometry):
    numbers = dict(zip(_GEOMETRY[mechanism], geometry, strict=True), theta2=theta2)
    if mechanism == "four_bar":
        m = linkage_truth.motion(numbers)
        return (m["theta3"], m["omega3"], m["alpha3"]), (m["theta4"], m["omega4"], m["alpha4"])
    if mechanism == "slider_crank":
        m = sliding_truth.slider_motion(numbers)
        slider = (m["position"], m["slider_velocity"], m["slider_acceleration"])
        return (m["theta3"], m["omega3"], m["alpha3"]), slider
    m = sliding_truth.rod_motion(numbers)
    rod = (m["theta4"], m["omega4"], m["alpha4"])
    return rod, rod


def links(mechanism, numbers):
    """Return origin, its acceleration, direction, squared speed and acceleration of each link.

    The place of joint 34 comes last.
    """
    geometry = [numbers[name] for name in _GEOMETRY[mechanism]]
    third, fourth = _motion(mechanism, mpmath.mp.prec, numbers["theta2"], *geometry)
    speed2, acceleration = numbers.get("speed", 0) ** 2, numbers.get("acceleration", 0)

    def turning(w, a):
        return w**2 * speed2, a * speed2 + w * acceleration

    zero = mpmath.mpf(0)
    pin = numbers["crank"] * mpmath.expj(numbers["theta2"])
    lifted = pin * mpmath.mpc(-speed2, acceleration)
    first = (mpmath.mpc(0), mpmath.mpc(0), mpmath.expj(numbers["theta2"]), speed2, acceleration)
    if mechanism == "slider_crank":  # exactly along the guide where it is; an angle is never pi
        place = mpmath.mpc(fourth[0], numbers["offset"])
        ahead = (place - pin) / numbers["coupler"]
    else:
        ahead = mpmath.expj(third[0])
    second = (pin, lifted, ahead, *turning(*third[1:]))
    if mechanism == "four_bar":
        pivot = mpmath.mpc(numbers["frame"])
        last = (pivot, mpmath.mpc(0), mpmath.expj(fourth[0]), *turning(*fourth[1:]))
        return (first, second, last), pivot + numbers["follower"] * last[2]
    if mechanism == "slider_crank":
        last = (place, mpmath.mpc(turning(*fourth[1:])[1]), mpmath.mpc(1), zero, zero)
        return (first, second, last), place
    last = (mpmath.mpc(-numbers["frame"]), mpmath.mpc(0), ahead, *turning(*fourth[1:]))
    return (first, second, last), pin


def inertia_pushes(numbers, bodies):
    """Return force and moment about the first joint that the motion of each link takes."""
    found = []
    for n, (_, lifted, ahead, square, turn) in zip((2, 3, 4), bodies, strict=True):
        mass, along, across, inertia = (
            numbers.get(f"{name}{n}", 0) for name in ("mass", "along", "across", "inertia")
        )
        arm = mpmath.mpc(along, across) * ahead
        force = mass * lifted + arm * mpmath.mpc(-square, turn)
        found.append((force, inertia * turn + cross(arm, lifted)))
    return found


def load_pushes(numbers):
    return [
        (-mpmath.mpc(numbers[f"fx{n}"], numbers[f"fy{n}"]), -numbers[f"couple{n}"])
        for n in (2, 3, 4)
    ]


def reactions(mechanism, numbers, pushes):
    """Return everything that ``forces`` returns, by name."""
    bodies, meeting = links(mechanism, numbers)
    pin, pivot = bodies[1][0], bodies[2][0]
    (f2, m2), (f3, m3), (f4, m4) = pushes
    couple34 = couple41 = mpmath.mpf(0)
    bc, dc = meeting - pin, meeting - pivot
    if mechanism == "four_bar":  # moments of coupler about B, of follower about D
        f34 = mpmath.mpc(*solve(bc.imag, -bc.real, -dc.imag, dc.real, m3, m4))
        f41 = f34 - f4
    elif mechanism == "slider_crank":  # nothing along the guide; moment of the coupler about B
        f34 = mpmath.mpc(f4.real, (-m3 + bc.imag * f4.real) / bc.real)
        f41, couple41 = f34 - f4, -m4
        f41 = mpmath.mpc(0, f41.imag)
    else:  # the block's moment about B; the rod's about D; nothing along the rod
        couple34 = -m3
        normal = (m4 - couple34) / abs(dc)
        f34 = mpmath.mpc(0, 1) * normal * dc / abs(dc)
        f41 = f34 - f4
    f23 = f3 + f34
    f12 = f2 + f23
    torque = m2 + cross(pin, f23)
    shaking = f41 - f12
    at = meeting if mechanism == "slider_crank" else pivot
    found = {
        f"{axis}{joint}": part
        for joint, force in (("12", f12), ("23", f23), ("34", f34), ("41", f41))
        for axis, part in (("x", force.real), ("y", force.imag))
    }
    return found | {
        "couple34": couple34,
        "couple41": couple41,
        "torque": torque,
        "shaking_x": shaking.real,
        "shaking_y": shaking.imag,
        "shaking_moment": cross(at, f41) + couple41 - torque,
    }


def forces(mechanism):
    """Return the exact ``forces`` of a linkage as a function of mpmath numbers by name."""

    def reference(numbers):
        bodies, _ = links(mechanism, numbers)
        return reactions(mechanism, numbers, inertia_pushes(numbers, bodies))

    return reference


def loads(mechanism):
    """Return the exact ``load_forces``."""
    return lambda numbers: reactions(mechanism, numbers, load_pushes(numbers))


# ---------------------------------------------------------------- points


def _poses(mechanism):
    """Return points of the geometry alone: random ones and the named nasty shapes."""
    if mechanism == "four_bar":
        points = linkage_truth.random_points(80, seed=31)
        for shape, lengths in {**linkage_truth._SHAPES, **linkage_truth._HAIR}.items():
            for assembly, word in ((1.0, "open"), (-1.0, "crossed")):
                linkage = linkage_truth.Linkage(*lengths, assembly)
                points += [linkage.point(f"{shape}, {word}, {a:.9g}", a) for a in _ANGLES]
        return points
    if mechanism == "slider_crank":
        points = sliding_truth.random_sliders(80, seed=32)
        return points + sliding_truth.nasty_sliders()[::3]
    return sliding_truth.random_rods(80, seed=33) + sliding_truth.nasty_rods()[::3]


def points(mechanism, *, loaded=False):
    """Return poses with masses or loads: all at random, or one of them alone."""
    random = np.random.default_rng(34)
    names = list(LOADS if loaded else MOMENTS)
    found = []
    for i, pose in enumerate(_poses(mechanism)):
        drawn = {
            name: float(random.choice([-1.0, 1.0]) * 10.0 ** random.uniform(-2, 2))
            for name in names
        }
        words = ""
        if i % 3:
            only = names[i % len(names)]
            drawn = {name: drawn[name] if name == only else 0.0 for name in names}
            words = f", {only} alone"
        if not loaded:
            drawn["speed"] = float(10.0 ** random.uniform(-1, 2))
            drawn["acceleration"] = float(random.choice([0.0, 1.0, -30.0]))
        fixed = {k: v for k, v in pose.fixed.items() if k != "winding"}
        found.append(Point(pose.name + words, {**pose.inputs, **drawn}, fixed))
    return found


@lru_cache(maxsize=32)
def exact_points(module, function):
    mechanism = module.split("_forces")[0]
    if function == "load_forces":
        made, reference = points(mechanism, loaded=True), loads(mechanism)
    elif function != "forces":
        return exact_points(module, "forces")
    else:
        made, reference = points(mechanism), forces(mechanism)
    return tuple(exact_at(reference, point) for point in made)
