"""Forces of rigid linkages in many digits: Newton and Euler for each link, solved as a whole.

Positions, rates and accelerations come from the closures of ``linkage_truth`` and
``sliding_truth``; the nine or ten equations are put up as they stand and solved by elimination.
"""

from __future__ import annotations

import mpmath
import numpy as np
from linkage_truth import motion as four_bar_motion
from sliding_truth import rod_motion, slider_motion

DIGITS = 60


def rotated(angle, along, across):
    cos, sin = mpmath.cos(angle), mpmath.sin(angle)
    return mpmath.mpc(cos * along - sin * across, sin * along + cos * across)


def cross(a, b):
    return a.real * b.imag - a.imag * b.real


def _rates(first, second, speed, acceleration):
    return first * speed, second * speed**2 + first * acceleration


def _bodies(linkage, theta, speed, acceleration):
    """Return (origin, its acceleration, angle, speed, angular acceleration) of links 2, 3, 4."""
    given = {name: mpmath.mpf(float(value)) for name, value in linkage.geometry.items()}
    given["theta2"] = theta
    turning = mpmath.mpc(-(speed**2), acceleration)
    crank = (mpmath.mpc(0), mpmath.mpc(0), theta, speed, acceleration)
    pin = given["crank"] * mpmath.expj(theta)
    kind = type(linkage).__name__
    if kind == "FourBar":
        m = four_bar_motion(given)
        w3, a3 = _rates(m["omega3"], m["alpha3"], speed, acceleration)
        w4, a4 = _rates(m["omega4"], m["alpha4"], speed, acceleration)
        coupler = (pin, turning * pin, m["theta3"], w3, a3)
        last = (mpmath.mpc(given["frame"]), mpmath.mpc(0), m["theta4"], w4, a4)
        meeting = last[0] + given["follower"] * mpmath.expj(m["theta4"])
    elif kind == "SliderCrank":
        m = slider_motion(given)
        w3, a3 = _rates(m["omega3"], m["alpha3"], speed, acceleration)
        _, a4 = _rates(m["slider_velocity"], m["slider_acceleration"], speed, acceleration)
        coupler = (pin, turning * pin, m["theta3"], w3, a3)
        meeting = mpmath.mpc(m["position"], given["offset"])
        zero = mpmath.mpf(0)
        last = (meeting, mpmath.mpc(a4), zero, zero, zero)
    else:
        m = rod_motion(given)
        w4, a4 = _rates(m["omega4"], m["alpha4"], speed, acceleration)
        coupler = (pin, turning * pin, m["theta4"], w4, a4)
        last = (mpmath.mpc(-given["frame"]), mpmath.mpc(0), m["theta4"], w4, a4)
        meeting = pin
    return (crank, coupler, last), meeting


def _inertia(body, mass):
    _, start, angle, omega, alpha = body
    arm = rotated(angle, mpmath.mpf(mass.along), mpmath.mpf(mass.across))
    momentum = mass.mass * start + mpmath.mpc(-(omega**2), alpha) * arm
    return momentum, mass.inertia * alpha + cross(arm, start)


def forces(machine, theta, speed, acceleration=0.0, outside=None, springs=None):
    """Return every force by name, as mpmath numbers.

    Parameters
    ----------
    machine : Machine
        Its masses and gravity are taken; loads and springs are not.
    theta, speed, acceleration : float
        Of the crank.
    outside, springs : mapping of str to (float, float, float), optional
        Force and couple at the first joint of a link, from outside and from springs.
    """
    with mpmath.workdps(DIGITS):
        t, w, a = (mpmath.mpf(float(item)) for item in (theta, speed, acceleration))
        bodies, meeting = _bodies(machine.linkage, t, w, a)
        pushes = []
        frame, frame_moment = mpmath.mpc(0), mpmath.mpf(0)
        for link, body in zip(machine.linkage.links, bodies, strict=True):
            mass = machine.mass(link)
            force, moment = (-item for item in _inertia(body, mass))
            arm = rotated(body[2], mpmath.mpf(mass.along), mpmath.mpf(mass.across))
            gravity = mpmath.mpc(*machine.gravity)
            fx, fy, couple = (outside or {}).get(link, (0.0, 0.0, 0.0))
            force += mass.mass * gravity + mpmath.mpc(fx, fy)
            moment += cross(arm, gravity) + mpmath.mpf(couple)
            frame += force
            frame_moment += moment + cross(body[0], force)
            fx, fy, couple = (springs or {}).get(link, (0.0, 0.0, 0.0))
            pushes.append((force + mpmath.mpc(fx, fy), moment + mpmath.mpf(couple)))
        found = _solved(machine.linkage, bodies, meeting, pushes)
        found["shaking_x"], found["shaking_y"] = frame.real, frame.imag
        found["shaking_moment"] = frame_moment
        return found


def _solved(linkage, bodies, meeting, pushes):
    kind = type(linkage).__name__
    slides = {"SliderCrank": "couple41", "QuickReturn": "couple34"}.get(kind)
    names = [axis + joint for joint in ("12", "23", "34", "41") for axis in "xy"] + ["torque"]
    names += [slides] if slides else []
    matrix = mpmath.zeros(len(names), len(names))
    right = mpmath.zeros(len(names), 1)
    joints = (("12", "23"), ("23", "34"), ("34", "41"))
    places = {"12": mpmath.mpc(0), "23": bodies[1][0], "34": meeting, "41": bodies[2][0]}
    for n, (pair, body, (force, moment)) in enumerate(zip(joints, bodies, pushes, strict=True)):
        for joint, sign in zip(pair, (1, -1), strict=True):
            x, y = names.index("x" + joint), names.index("y" + joint)
            arm = places[joint] - body[0]
            matrix[3 * n, x] += sign
            matrix[3 * n + 1, y] += sign
            matrix[3 * n + 2, x] -= sign * arm.imag
            matrix[3 * n + 2, y] += sign * arm.real
            if slides == "couple" + joint:
                matrix[3 * n + 2, names.index(slides)] += sign
        if n == 0:
            matrix[2, names.index("torque")] = 1
        right[3 * n], right[3 * n + 1], right[3 * n + 2] = -force.real, -force.imag, -moment
    if slides == "couple41":  # nothing along the guide
        matrix[9, names.index("x41")] = 1
    elif slides:  # nothing along the rod
        matrix[9, names.index("x34")] = mpmath.cos(bodies[2][2])
        matrix[9, names.index("y34")] = mpmath.sin(bodies[2][2])
    solution = mpmath.lu_solve(matrix, right)
    return dict(zip(names, solution, strict=True))


def errors(machine, found, outside=None, springs=None):
    """Return the actual error at each angle in the norm of the figure, and the figure."""
    longest = max(abs(length) for length in machine.linkage.lengths.values())
    worst = []
    for i, theta in enumerate(found.theta2):
        speed = np.broadcast_to(found.speed, found.theta2.shape)[i]
        acceleration = np.broadcast_to(found.acceleration, found.theta2.shape)[i]
        with mpmath.workdps(DIGITS):
            exact = forces(machine, theta, speed, acceleration, outside, springs)
            gaps = [
                abs(mpmath.mpf(float(value[i])) - exact[name])
                / (longest if name in ("torque", "shaking_moment", "couple34", "couple41") else 1)
                for name, value in found.values.items()
            ]
            worst.append(float(max(gaps)))
    return np.array(worst), np.asarray(found.error)
