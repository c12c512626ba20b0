"""Forces of the rigid four-bar linkage in closed form.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism four_bar, formulation forces.
Equations: Smith (4.1)-(4.13).

Link 1 is the frame, 2 the crank; each moving link has axes of its own from its first joint along
the link.  The forces are linear in masses, moments and inertias: at unit values of one of these
they are the derivatives by it.

Cost per evaluation:
    forces: 233 operations
    pin_forces: 187 operations
    driving_torque: 134 operations
    shaking_force: 166 operations
    shaking_moment: 149 operations
    load_forces: 99 operations
Content hash 714e3801ea04c7456577f72cdb886ace; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = [
    "forces", "pin_forces", "driving_torque", "shaking_force", "shaking_moment", "load_forces",
]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"forces","mechanism":"four_bar","modes":'
    'null,"outputs":[]}'
)
CONTENT = "714e3801ea04c7456577f72cdb886ace"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "theta2": ("rad", "Crank angle"),
    "speed": ("rad/s", "Crank speed"),
    "acceleration": ("rad/s^2", "Crank acceleration"),
    "frame": ("m", "Length of the fixed link AD"),
    "crank": ("m", "Length of the crank AB"),
    "coupler": ("m", "Length of the coupler BC"),
    "follower": ("m", "Length of the follower DC"),
    "assembly": ("", "+1 for the open, -1 for the crossed assembly"),
    "mass2": ("kg", "Mass of link 2"),
    "along2": ("kg m", "First moment along link 2"),
    "across2": ("kg m", "First moment across link 2"),
    "inertia2": ("kg m^2", "Inertia, about its first joint, of link 2"),
    "mass3": ("kg", "Mass of link 3"),
    "along3": ("kg m", "First moment along link 3"),
    "across3": ("kg m", "First moment across link 3"),
    "inertia3": ("kg m^2", "Inertia, about its first joint, of link 3"),
    "mass4": ("kg", "Mass of link 4"),
    "along4": ("kg m", "First moment along link 4"),
    "across4": ("kg m", "First moment across link 4"),
    "inertia4": ("kg m^2", "Inertia, about its first joint, of link 4"),
    "x12": ("N", "Force of link 1 on link 2 along x"),
    "y12": ("N", "Force of link 1 on link 2 along y"),
    "x23": ("N", "Force of link 2 on link 3 along x"),
    "y23": ("N", "Force of link 2 on link 3 along y"),
    "x34": ("N", "Force of link 3 on link 4 along x"),
    "y34": ("N", "Force of link 3 on link 4 along y"),
    "x41": ("N", "Force of link 4 on link 1 along x"),
    "y41": ("N", "Force of link 4 on link 1 along y"),
    "torque": ("N m", "Torque of the drive on the crank, anticlockwise"),
    "shaking_x": ("N", "Force on the frame along x"),
    "shaking_y": ("N", "Force on the frame along y"),
    "shaking_moment": ("N m", "Moment on the frame about A, the drive's reaction in it"),
    "fx2": ("N", "Force along x at the first joint of link 2"),
    "fy2": ("N", "Force along y at the first joint of link 2"),
    "couple2": ("N m", "Couple on link 2"),
    "fx3": ("N", "Force along x at the first joint of link 3"),
    "fy3": ("N", "Force along y at the first joint of link 3"),
    "couple3": ("N m", "Couple on link 3"),
    "fx4": ("N", "Force along x at the first joint of link 4"),
    "fy4": ("N", "Force along y at the first joint of link 4"),
    "couple4": ("N m", "Couple on link 4"),
}
PARAMETERS = ()

# Names of what each function returns, in order.
RETURNS = {
    "forces": (
        "x12", "y12", "x23", "y23", "x34", "y34", "x41", "y41", "torque", "shaking_x", "shaking_y",
        "shaking_moment",
    ),
    "pin_forces": ("x12", "y12", "x23", "y23", "x34", "y34", "x41", "y41"),
    "driving_torque": ("torque",),
    "shaking_force": ("shaking_x", "shaking_y"),
    "shaking_moment": ("shaking_moment",),
    "load_forces": (
        "x12", "y12", "x23", "y23", "x34", "y34", "x41", "y41", "torque", "shaking_x", "shaking_y",
        "shaking_moment",
    ),
}

# Terms of the energies that may be left out, to the names of what then vanishes, or to the
# separated terms that go and those that come.
DROPS = {
    ("across",): ("across2", "across3", "across4"),
    ("crank_acceleration",): ("acceleration",),
    ("across", "crank_acceleration"): ("across2", "across3", "across4", "acceleration"),
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def forces(
    theta2, speed, acceleration, frame, crank, coupler, follower, assembly, mass2, along2, across2,
    inertia2, mass3, along3, across3, inertia3, mass4, along4, across4, inertia4,
):
    """Return every joint force, the torque, and the force and moment on the frame.

    theta2 : ndarray or float, shape (...)
    speed, acceleration : float or ndarray, shape (...)
    frame, crank, coupler, follower, assembly : float
    mass2 to inertia4 : float or ndarray
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    straight = coupler + follower
    folded = coupler - follower
    half_tangent = xp.tan(theta2 / 2)
    cosine_squared = 1 / (half_tangent**2 + 1)
    half_sine2 = cosine_squared * half_tangent
    sine_squared = half_sine2 * half_tangent
    c0 = 2 * crank
    rise = c0 * sine_squared
    travel = frame * rise
    crank_x = crank - rise
    crank_y = c0 * half_sine2
    base_x = near + rise
    del half_tangent, half_sine2, rise
    x0 = near**2
    c1 = x0 / 2
    diagonal = c1 + travel
    x1 = folded * straight
    c2 = x0 / 2 + x1 / 2
    p = c2 + travel
    c3 = x1 / 2 - x0 / 2
    q = travel - c3
    c4 = (near + straight) * (near - straight) / 2
    c5 = (far + straight) * (far - straight) / 2
    stretch = -c4 * cosine_squared - c5 * sine_squared
    c6 = (folded + near) * (folded - near) / 2
    fold = travel - c6
    area = assembly * xp.sqrt(fold * stretch)
    del cosine_squared, sine_squared, fold, stretch
    inverse = -1 / area
    x4 = 0.5 / diagonal
    per_x = x4 * base_x
    per_y = x4 * crank_y
    del diagonal, base_x, x4
    x5 = area * per_y
    coupler_x = p * per_x + x5
    x6 = area * per_x
    coupler_y = x6 - p * per_y
    follower_x = x5 - per_x * q
    del p, per_x, x5
    follower_y = per_y * q + x6
    del per_y, q, x6
    c7 = folded**2 / 4 + straight**2 / 4 - x0 / 2
    dot = travel - c7
    lean = -frame * inverse
    slip3 = follower_y * lean
    spread = crank_y * lean
    w3 = inverse * (crank_x * follower_y - crank_y * follower_x)
    w4 = spread + w3
    pace = dot * inverse * spread
    del travel, dot, spread
    facing = coupler_x * crank_x + coupler_y * crank_y
    a3 = pace * slip3 - follower_x * lean * w4
    a4 = -facing * inverse * slip3 - pace * w4
    square = speed**2
    spin_th3 = square * w3**2
    x7 = acceleration * w3
    turn_th3 = square * a3 + x7
    del lean, pace, a3
    spin_th4 = square * w4**2
    x8 = acceleration * w4
    turn_th4 = square * a4 + x8
    x9 = 1 / crank
    c8 = x9 * across2
    c9 = x9 * along2
    x10 = acceleration * crank_x - square * crank_y
    x11 = acceleration * crank_y + square * crank_x
    push2_x = -c8 * x10 - c9 * x11
    push2_y = c9 * x10 - c8 * x11
    push2_moment = acceleration * inertia2
    x13 = 1 / coupler
    c10 = x13 * across3
    c11 = x13 * along3
    x14 = coupler_x * spin_th3 + coupler_y * turn_th3
    x15 = coupler_x * turn_th3 - coupler_y * spin_th3
    push3_x = -c10 * x15 - c11 * x14 - mass3 * x11
    del a4, spin_th3, x11
    push3_y = c11 * x15 - c10 * x14 + mass3 * x10
    del x10, x14, x15
    x16 = inertia3 * turn_th3
    x17 = square * facing
    x18 = area * w4
    x19 = square * x18
    push3_moment = c10 * (x8 * area + x17) + c11 * (acceleration * facing - x19) + x16
    x20 = 1 / follower
    c12 = x20 * across4
    c13 = x20 * along4
    x21 = follower_x * turn_th4 - follower_y * spin_th4
    x22 = follower_x * spin_th4 + follower_y * turn_th4
    del area, x8, spin_th4
    push4_x = -c12 * x21 - c13 * x22
    push4_y = c13 * x21 - c12 * x22
    push4_moment = inertia4 * turn_th4
    del x21, x22, turn_th4
    x34 = inverse * (coupler_x * push4_moment + follower_x * push3_moment)
    y34 = inverse * (coupler_y * push4_moment + follower_y * push3_moment)
    del coupler_x, follower_x, coupler_y, follower_y, inverse, push3_moment
    x23 = push3_x + x34
    x12 = push2_x + x23
    y23 = push3_y + y34
    y12 = push2_y + y23
    x41 = x34 - push4_x
    y41 = y34 - push4_y
    c14 = acceleration * mass3
    x24 = x17 * slip3
    x25 = turn_th3 + x7
    x26 = x19 * slip3
    del x17, x7, x19
    x27 = c14 * (crank_x**2 + crank_y**2) + push2_moment
    x28 = acceleration + turn_th3
    del crank_x, crank_y, turn_th3
    x29 = 2 - slip3
    return (
        x12, y12, x23, y23, x34, y34, x41, y41,
        (
            c10 * (x24 * w3 + x18 * x25) + c11 * (x25 * facing - x26 * w3) + push4_moment * w4 +
            x16 * w3 + x27
        ),
        -push2_x - push3_x - push4_x, -push2_y - push3_y - push4_y,
        (
            -c10 * (x18 * x28 + x24 * x29) + c11 * (x26 * x29 - x28 * facing) - frame * push4_y -
            push4_moment - x16 - x27
        ),
    )


def pin_forces(
    theta2, speed, acceleration, frame, crank, coupler, follower, assembly, mass2, along2, across2,
    inertia2, mass3, along3, across3, inertia3, mass4, along4, across4, inertia4,
):
    """Return every joint force.

    theta2 : ndarray or float, shape (...)
    speed, acceleration : float or ndarray, shape (...)
    frame, crank, coupler, follower, assembly : float
    mass2 to inertia4 : float or ndarray
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    straight = coupler + follower
    folded = coupler - follower
    half_tangent = xp.tan(theta2 / 2)
    cosine_squared = 1 / (half_tangent**2 + 1)
    half_sine2 = cosine_squared * half_tangent
    sine_squared = half_sine2 * half_tangent
    c0 = 2 * crank
    rise = c0 * sine_squared
    travel = frame * rise
    crank_x = crank - rise
    crank_y = c0 * half_sine2
    base_x = near + rise
    del half_tangent, half_sine2, rise
    x0 = near**2
    c1 = x0 / 2
    diagonal = c1 + travel
    x1 = folded * straight
    c2 = x0 / 2 + x1 / 2
    p = c2 + travel
    c3 = x1 / 2 - x0 / 2
    q = travel - c3
    c4 = (near + straight) * (near - straight) / 2
    c5 = (far + straight) * (far - straight) / 2
    stretch = -c4 * cosine_squared - c5 * sine_squared
    c6 = (folded + near) * (folded - near) / 2
    fold = travel - c6
    area = assembly * xp.sqrt(fold * stretch)
    del cosine_squared, sine_squared, fold, stretch
    inverse = -1 / area
    x4 = 0.5 / diagonal
    per_x = x4 * base_x
    per_y = x4 * crank_y
    del diagonal, base_x, x4
    x5 = area * per_y
    coupler_x = p * per_x + x5
    x6 = area * per_x
    coupler_y = x6 - p * per_y
    follower_x = x5 - per_x * q
    del p, per_x, x5
    follower_y = per_y * q + x6
    del per_y, q, x6
    c7 = folded**2 / 4 + straight**2 / 4 - x0 / 2
    dot = travel - c7
    lean = -frame * inverse
    slip3 = follower_y * lean
    spread = crank_y * lean
    w3 = inverse * (crank_x * follower_y - crank_y * follower_x)
    w4 = spread + w3
    pace = dot * inverse * spread
    del travel, dot, spread
    facing = coupler_x * crank_x + coupler_y * crank_y
    a3 = pace * slip3 - follower_x * lean * w4
    a4 = -facing * inverse * slip3 - pace * w4
    del lean, pace, slip3
    square = speed**2
    spin_th3 = square * w3**2
    turn_th3 = square * a3 + acceleration * w3
    spin_th4 = square * w4**2
    x7 = acceleration * w4
    turn_th4 = square * a4 + x7
    del a3, w3, a4
    x8 = 1 / crank
    c8 = x8 * across2
    c9 = x8 * along2
    x9 = acceleration * crank_x - square * crank_y
    x10 = acceleration * crank_y + square * crank_x
    push2_x = -c8 * x9 - c9 * x10
    push2_y = c9 * x9 - c8 * x10
    x11 = 1 / coupler
    c10 = x11 * across3
    c11 = x11 * along3
    x13 = coupler_x * spin_th3 + coupler_y * turn_th3
    x14 = coupler_x * turn_th3 - coupler_y * spin_th3
    del crank_x, crank_y, spin_th3
    push3_x = -c10 * x14 - c11 * x13 - mass3 * x10
    push3_y = c11 * x14 - c10 * x13 + mass3 * x9
    del x10, x13, x14, x9
    push3_moment = (
        c10 * (x7 * area + square * facing) + c11 * (acceleration * facing - square * area * w4) +
        inertia3 * turn_th3
    )
    del area, facing, turn_th3, w4, x7
    x15 = 1 / follower
    c12 = x15 * across4
    c13 = x15 * along4
    x16 = follower_x * turn_th4 - follower_y * spin_th4
    x17 = follower_x * spin_th4 + follower_y * turn_th4
    push4_x = -c12 * x16 - c13 * x17
    push4_y = c13 * x16 - c12 * x17
    del spin_th4, x16, x17
    push4_moment = inertia4 * turn_th4
    x34 = inverse * (coupler_x * push4_moment + follower_x * push3_moment)
    del turn_th4, coupler_x, follower_x
    y34 = inverse * (coupler_y * push4_moment + follower_y * push3_moment)
    del coupler_y, follower_y, inverse, push3_moment, push4_moment
    x23 = push3_x + x34
    x12 = push2_x + x23
    y23 = push3_y + y34
    del push3_x, push2_x, push3_y
    y12 = push2_y + y23
    x41 = x34 - push4_x
    y41 = y34 - push4_y
    del push2_y, push4_x, push4_y
    return x12, y12, x23, y23, x34, y34, x41, y41


def driving_torque(
    theta2, speed, acceleration, frame, crank, coupler, follower, assembly, mass2, along2, across2,
    inertia2, mass3, along3, across3, inertia3, mass4, along4, across4, inertia4,
):
    """Return the torque on the crank, by virtual power.

    theta2 : ndarray or float, shape (...)
    speed, acceleration : float or ndarray, shape (...)
    frame, crank, coupler, follower, assembly : float
    mass2 to inertia4 : float or ndarray
    Returns ndarray, shape (...).
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    straight = coupler + follower
    folded = coupler - follower
    half_tangent = xp.tan(theta2 / 2)
    cosine_squared = 1 / (half_tangent**2 + 1)
    half_sine2 = cosine_squared * half_tangent
    sine_squared = half_sine2 * half_tangent
    c0 = 2 * crank
    rise = c0 * sine_squared
    travel = frame * rise
    crank_x = crank - rise
    crank_y = c0 * half_sine2
    base_x = near + rise
    del half_tangent, half_sine2, rise
    x0 = near**2
    c1 = x0 / 2
    diagonal = c1 + travel
    x1 = folded * straight
    c2 = x0 / 2 + x1 / 2
    p = c2 + travel
    c3 = x1 / 2 - x0 / 2
    q = travel - c3
    c4 = (near + straight) * (near - straight) / 2
    c5 = (far + straight) * (far - straight) / 2
    stretch = -c4 * cosine_squared - c5 * sine_squared
    c6 = (folded + near) * (folded - near) / 2
    fold = travel - c6
    area = assembly * xp.sqrt(fold * stretch)
    del cosine_squared, sine_squared, fold, stretch
    inverse = -1 / area
    x4 = 0.5 / diagonal
    per_x = x4 * base_x
    per_y = x4 * crank_y
    del diagonal, base_x, x4
    x5 = area * per_y
    coupler_x = p * per_x + x5
    x6 = area * per_x
    coupler_y = x6 - p * per_y
    follower_x = x5 - per_x * q
    del p, per_x, x5
    follower_y = per_y * q + x6
    del per_y, q, x6
    c7 = folded**2 / 4 + straight**2 / 4 - x0 / 2
    dot = travel - c7
    lean = -frame * inverse
    slip3 = follower_y * lean
    spread = crank_y * lean
    w3 = inverse * (crank_x * follower_y - crank_y * follower_x)
    w4 = spread + w3
    pace = dot * inverse * spread
    del travel, follower_y, dot, spread
    facing = coupler_x * crank_x + coupler_y * crank_y
    a3 = pace * slip3 - follower_x * lean * w4
    del coupler_x, coupler_y, follower_x, lean
    x7 = facing * slip3
    a4 = -x7 * inverse - pace * w4
    square = speed**2
    x8 = acceleration * w3
    turn_th3 = square * a3 + x8
    del inverse, pace, a3
    turn_th4 = square * a4 + acceleration * w4
    push2_moment = acceleration * inertia2
    push4_moment = inertia4 * turn_th4
    c8 = acceleration * mass3
    x9 = 1 / coupler
    c9 = x9 * across3
    c10 = x9 * along3
    x10 = square * w3
    x11 = turn_th3 + x8
    del a4, turn_th4, x8
    x12 = area * w4
    return (
        c10 * (x11 * facing - x10 * x12 * slip3) + c8 * (crank_x**2 + crank_y**2) + c9 * (x10 * x7
        + x11 * x12) + inertia3 * turn_th3 * w3 + push2_moment + push4_moment * w4
    )


def shaking_force(
    theta2, speed, acceleration, frame, crank, coupler, follower, assembly, mass2, along2, across2,
    inertia2, mass3, along3, across3, inertia3, mass4, along4, across4, inertia4,
):
    """Return the force on the frame, the change of momentum.

    theta2 : ndarray or float, shape (...)
    speed, acceleration : float or ndarray, shape (...)
    frame, crank, coupler, follower, assembly : float
    mass2 to inertia4 : float or ndarray
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    straight = coupler + follower
    folded = coupler - follower
    half_tangent = xp.tan(theta2 / 2)
    cosine_squared = 1 / (half_tangent**2 + 1)
    half_sine2 = cosine_squared * half_tangent
    sine_squared = half_sine2 * half_tangent
    c0 = 2 * crank
    rise = c0 * sine_squared
    travel = frame * rise
    crank_x = crank - rise
    crank_y = c0 * half_sine2
    base_x = near + rise
    del half_tangent, half_sine2, rise
    x0 = near**2
    c1 = x0 / 2
    diagonal = c1 + travel
    x1 = folded * straight
    c2 = x0 / 2 + x1 / 2
    p = c2 + travel
    c3 = x1 / 2 - x0 / 2
    q = travel - c3
    c4 = (near + straight) * (near - straight) / 2
    c5 = (far + straight) * (far - straight) / 2
    stretch = -c4 * cosine_squared - c5 * sine_squared
    c6 = (folded + near) * (folded - near) / 2
    fold = travel - c6
    area = assembly * xp.sqrt(fold * stretch)
    del cosine_squared, sine_squared, fold, stretch
    inverse = -1 / area
    x4 = 0.5 / diagonal
    per_x = x4 * base_x
    per_y = x4 * crank_y
    del diagonal, base_x, x4
    x5 = area * per_y
    coupler_x = p * per_x + x5
    x6 = area * per_x
    coupler_y = x6 - p * per_y
    follower_x = x5 - per_x * q
    del area, p, per_x, x5
    follower_y = per_y * q + x6
    del per_y, q, x6
    c7 = folded**2 / 4 + straight**2 / 4 - x0 / 2
    dot = travel - c7
    lean = -frame * inverse
    slip3 = follower_y * lean
    spread = crank_y * lean
    w3 = inverse * (crank_x * follower_y - crank_y * follower_x)
    w4 = spread + w3
    pace = dot * inverse * spread
    del travel, dot, spread
    facing = coupler_x * crank_x + coupler_y * crank_y
    a3 = pace * slip3 - follower_x * lean * w4
    a4 = -facing * inverse * slip3 - pace * w4
    del lean, facing, inverse, pace, slip3
    square = speed**2
    spin_th3 = square * w3**2
    turn_th3 = square * a3 + acceleration * w3
    spin_th4 = square * w4**2
    turn_th4 = square * a4 + acceleration * w4
    del a3, w3, a4, w4
    x7 = 1 / crank
    c8 = x7 * across2
    c9 = x7 * along2
    x8 = acceleration * crank_x - square * crank_y
    x9 = acceleration * crank_y + square * crank_x
    push2_x = -c8 * x8 - c9 * x9
    push2_y = c9 * x8 - c8 * x9
    x10 = 1 / coupler
    c10 = x10 * across3
    c11 = x10 * along3
    x11 = coupler_x * spin_th3 + coupler_y * turn_th3
    x12 = coupler_x * turn_th3 - coupler_y * spin_th3
    del crank_x, crank_y, coupler_x, coupler_y, spin_th3, turn_th3
    push3_x = -c10 * x12 - c11 * x11 - mass3 * x9
    push3_y = c11 * x12 - c10 * x11 + mass3 * x8
    del x9, x11, x12, x8
    x13 = 1 / follower
    c12 = x13 * across4
    c13 = x13 * along4
    x14 = follower_x * turn_th4 - follower_y * spin_th4
    x15 = follower_x * spin_th4 + follower_y * turn_th4
    del follower_x, follower_y, spin_th4, turn_th4
    push4_x = -c12 * x14 - c13 * x15
    push4_y = c13 * x14 - c12 * x15
    return -push2_x - push3_x - push4_x, -push2_y - push3_y - push4_y


def shaking_moment(
    theta2, speed, acceleration, frame, crank, coupler, follower, assembly, mass2, along2, across2,
    inertia2, mass3, along3, across3, inertia3, mass4, along4, across4, inertia4,
):
    """Return the moment on the frame about A, the change of moment of momentum.

    theta2 : ndarray or float, shape (...)
    speed, acceleration : float or ndarray, shape (...)
    frame, crank, coupler, follower, assembly : float
    mass2 to inertia4 : float or ndarray
    Returns ndarray, shape (...).
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    straight = coupler + follower
    folded = coupler - follower
    half_tangent = xp.tan(theta2 / 2)
    cosine_squared = 1 / (half_tangent**2 + 1)
    half_sine2 = cosine_squared * half_tangent
    sine_squared = half_sine2 * half_tangent
    c0 = 2 * crank
    rise = c0 * sine_squared
    travel = frame * rise
    crank_x = crank - rise
    crank_y = c0 * half_sine2
    base_x = near + rise
    del half_tangent, half_sine2, rise
    x0 = near**2
    c1 = x0 / 2
    diagonal = c1 + travel
    x1 = folded * straight
    c2 = x0 / 2 + x1 / 2
    p = c2 + travel
    c3 = x1 / 2 - x0 / 2
    q = travel - c3
    c4 = (near + straight) * (near - straight) / 2
    c5 = (far + straight) * (far - straight) / 2
    stretch = -c4 * cosine_squared - c5 * sine_squared
    c6 = (folded + near) * (folded - near) / 2
    fold = travel - c6
    area = assembly * xp.sqrt(fold * stretch)
    del cosine_squared, sine_squared, fold, stretch
    inverse = -1 / area
    x4 = 0.5 / diagonal
    per_x = x4 * base_x
    per_y = x4 * crank_y
    del diagonal, base_x, x4
    x5 = area * per_y
    coupler_x = p * per_x + x5
    x6 = area * per_x
    coupler_y = x6 - p * per_y
    follower_x = x5 - per_x * q
    del p, per_x, x5
    follower_y = per_y * q + x6
    del per_y, q, x6
    c7 = folded**2 / 4 + straight**2 / 4 - x0 / 2
    dot = travel - c7
    lean = -frame * inverse
    slip3 = follower_y * lean
    spread = crank_y * lean
    w3 = inverse * (crank_x * follower_y - crank_y * follower_x)
    w4 = spread + w3
    pace = dot * inverse * spread
    del travel, dot, spread
    facing = coupler_x * crank_x + coupler_y * crank_y
    a3 = pace * slip3 - follower_x * lean * w4
    del coupler_x, coupler_y, lean
    x7 = facing * slip3
    a4 = -x7 * inverse - pace * w4
    square = speed**2
    turn_th3 = square * a3 + acceleration * w3
    del inverse, pace, a3, w3
    spin_th4 = square * w4**2
    turn_th4 = square * a4 + acceleration * w4
    push2_moment = acceleration * inertia2
    x8 = 1 / follower
    c8 = x8 * along4
    c9 = x8 * across4
    push4_y = (
        c8 * (follower_x * turn_th4 - follower_y * spin_th4) - c9 * (follower_x * spin_th4 +
        follower_y * turn_th4)
    )
    del a4, follower_x, follower_y, spin_th4
    push4_moment = inertia4 * turn_th4
    x9 = 1 / coupler
    c10 = x9 * along3
    c11 = acceleration * mass3
    c12 = x9 * across3
    x10 = acceleration + turn_th3
    x11 = area * w4
    del turn_th4, area, w4
    x12 = square * (2 - slip3)
    return (
        c10 * (x11 * x12 * slip3 - x10 * facing) - c11 * (crank_x**2 + crank_y**2) - c12 * (x10 *
        x11 + x12 * x7) - frame * push4_y - inertia3 * turn_th3 - push2_moment - push4_moment
    )


def load_forces(
    theta2, frame, crank, coupler, follower, assembly, fx2, fy2, couple2, fx3, fy3, couple3, fx4,
    fy4, couple4,
):
    """Return what external loads alone call forth.

    theta2 : ndarray or float, shape (...)
    frame, crank, coupler, follower, assembly : float
    fx2 to couple4 : float or ndarray
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    straight = coupler + follower
    folded = coupler - follower
    half_tangent = xp.tan(theta2 / 2)
    cosine_squared = 1 / (half_tangent**2 + 1)
    half_sine2 = cosine_squared * half_tangent
    sine_squared = half_sine2 * half_tangent
    c0 = 2 * crank
    rise = c0 * sine_squared
    travel = frame * rise
    crank_x = crank - rise
    crank_y = c0 * half_sine2
    base_x = near + rise
    del half_tangent, half_sine2, rise
    x0 = near**2
    c1 = x0 / 2
    diagonal = c1 + travel
    x1 = folded * straight
    c2 = x0 / 2 + x1 / 2
    p = c2 + travel
    c3 = x1 / 2 - x0 / 2
    q = travel - c3
    c4 = (near + straight) * (near - straight) / 2
    c5 = (far + straight) * (far - straight) / 2
    stretch = -c4 * cosine_squared - c5 * sine_squared
    c6 = (folded + near) * (folded - near) / 2
    fold = travel - c6
    del cosine_squared, sine_squared, travel
    area = assembly * xp.sqrt(fold * stretch)
    inverse = -1 / area
    x4 = 0.5 / diagonal
    del fold, stretch, diagonal
    per_x = x4 * base_x
    per_y = x4 * crank_y
    x5 = area * per_y
    coupler_x = p * per_x + x5
    x6 = area * per_x
    del base_x, x4, area
    coupler_y = x6 - p * per_y
    follower_x = x5 - per_x * q
    del p, per_x, x5
    follower_y = per_y * q + x6
    del per_y, q, x6
    x34 = inverse * (-couple3 * follower_x - couple4 * coupler_x)
    y34 = inverse * (-couple3 * follower_y - couple4 * coupler_y)
    del coupler_x, follower_x, coupler_y, follower_y, inverse
    x23 = x34 - fx3
    x12 = x23 - fx2
    y23 = y34 - fy3
    y12 = y23 - fy2
    torque = crank_x * y23 - couple2 - crank_y * x23
    x41 = fx4 + x34
    y41 = fy4 + y34
    c7 = -couple2 - couple3 - couple4 - fy4 * frame
    return (
        x12, y12, x23, y23, x34, y34, x41, y41, torque, fx2 + fx3 + fx4, fy2 + fy3 + fy4,
        fy3 * crank_x - c7 - fx3 * crank_y,
    )
