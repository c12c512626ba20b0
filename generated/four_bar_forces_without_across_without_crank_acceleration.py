"""Forces of the rigid four-bar linkage in closed form.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism four_bar, formulation forces, without across, crank_acceleration.
Equations: Smith (4.1)-(4.13).

Link 1 is the frame, 2 the crank; each moving link has axes of its own from its first joint along
the link.  The forces are linear in masses, moments and inertias: at unit values of one of these
they are the derivatives by it.

For a crank of constant speed.

For links whose masses lie along their lines.

Cost per evaluation:
    forces: 179 operations
    pin_forces: 154 operations
    driving_torque: 114 operations
    shaking_force: 139 operations
    shaking_moment: 122 operations
    load_forces: 99 operations
Content hash 4951775104d1145563ae48a37e798bf0; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = [
    "driving_torque",
    "forces",
    "load_forces",
    "pin_forces",
    "shaking_force",
    "shaking_moment",
]

FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":["across","crank_acceleration"],"flexible":[],"formulation":"forces","m'
    'echanism":"four_bar","modes":null,"outputs":[]}'
)
CONTENT = "4951775104d1145563ae48a37e798bf0"

# Parameters: name, unit, meaning.
PARAMETERS = (
)

# Names of what each function returns, in order.
RETURNS = {
    "forces": (
        "x12",
        "y12",
        "x23",
        "y23",
        "x34",
        "y34",
        "x41",
        "y41",
        "torque",
        "shaking_x",
        "shaking_y",
        "shaking_moment",
    ),
    "pin_forces": (
        "x12",
        "y12",
        "x23",
        "y23",
        "x34",
        "y34",
        "x41",
        "y41",
    ),
    "driving_torque": (
        "torque",
    ),
    "shaking_force": (
        "shaking_x",
        "shaking_y",
    ),
    "shaking_moment": (
        "shaking_moment",
    ),
    "load_forces": (
        "x12",
        "y12",
        "x23",
        "y23",
        "x34",
        "y34",
        "x41",
        "y41",
        "torque",
        "shaking_x",
        "shaking_y",
        "shaking_moment",
    ),
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def forces(
    theta2, speed, frame, crank, coupler, follower, assembly, mass2, along2, inertia2, mass3,
    along3, inertia3, mass4, along4, inertia4,
):
    """Return every joint force, the torque, and the force and moment on the frame.

    Parameters
    ----------
    theta2 : ndarray or float, shape (...)
        Crank angle [rad].
    speed : float or ndarray, shape (...)
        Crank speed [rad/s].
    frame : float
        Length of the fixed link AD [m].
    crank : float
        Length of the crank AB [m].
    coupler : float
        Length of the coupler BC [m].
    follower : float
        Length of the follower DC [m].
    assembly : float
        +1 for the open, -1 for the crossed assembly.
    mass2 : float or ndarray
        Mass of link 2 [kg].
    along2 : float or ndarray
        First moment along link 2 [kg m].
    inertia2 : float or ndarray
        Inertia, about its first joint, of link 2 [kg m^2].
    mass3 : float or ndarray
        Mass of link 3 [kg].
    along3 : float or ndarray
        First moment along link 3 [kg m].
    inertia3 : float or ndarray
        Inertia, about its first joint, of link 3 [kg m^2].
    mass4 : float or ndarray
        Mass of link 4 [kg].
    along4 : float or ndarray
        First moment along link 4 [kg m].
    inertia4 : float or ndarray
        Inertia, about its first joint, of link 4 [kg m^2].

    Returns
    -------
    x12 : ndarray, shape (...)
        Force of link 1 on link 2 along x [N].
    y12 : ndarray, shape (...)
        Force of link 1 on link 2 along y [N].
    x23 : ndarray, shape (...)
        Force of link 2 on link 3 along x [N].
    y23 : ndarray, shape (...)
        Force of link 2 on link 3 along y [N].
    x34 : ndarray, shape (...)
        Force of link 3 on link 4 along x [N].
    y34 : ndarray, shape (...)
        Force of link 3 on link 4 along y [N].
    x41 : ndarray, shape (...)
        Force of link 4 on link 1 along x [N].
    y41 : ndarray, shape (...)
        Force of link 4 on link 1 along y [N].
    torque : ndarray, shape (...)
        Torque of the drive on the crank, anticlockwise [N m].
    shaking_x : ndarray, shape (...)
        Force on the frame along x [N].
    shaking_y : ndarray, shape (...)
        Force on the frame along y [N].
    shaking_moment : ndarray, shape (...)
        Moment on the frame about A, the drive's reaction in it [N m].

    Notes
    -----
    Smith (4.1)-(4.13).
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
    along2_s = along2 * square
    mass3_s = mass3 * square
    along3_s = along3 * square
    inertia3_s = inertia3 * square
    along4_s = along4 * square
    inertia4_s = inertia4 * square
    spin_th3 = w3**2
    spin_th4 = w4**2
    c8 = along2_s / crank
    push2_x = -c8 * crank_x
    push2_y = -c8 * crank_y
    c9 = along3_s / coupler
    push3_x = -c9 * (a3 * coupler_y + coupler_x * spin_th3) - mass3_s * crank_x
    del lean, pace, crank_x
    push3_y = c9 * (a3 * coupler_x - coupler_y * spin_th3) - mass3_s * crank_y
    x7 = inertia3_s * a3
    x8 = area * w4
    push3_moment = x7 - c9 * x8
    c10 = along4_s / follower
    push4_x = -c10 * (a4 * follower_y + follower_x * spin_th4)
    push4_y = c10 * (a4 * follower_x - follower_y * spin_th4)
    del crank_y, spin_th3, spin_th4
    push4_moment = inertia4_s * a4
    x34 = inverse * (coupler_x * push4_moment + follower_x * push3_moment)
    del a4, coupler_x, follower_x
    y34 = inverse * (coupler_y * push4_moment + follower_y * push3_moment)
    del coupler_y, follower_y, inverse, push3_moment
    x23 = push3_x + x34
    x12 = push2_x + x23
    y23 = push3_y + y34
    y12 = push2_y + y23
    x41 = x34 - push4_x
    y41 = y34 - push4_y
    x9 = a3 * facing
    return (
        x12,
        y12,
        x23,
        y23,
        x34,
        y34,
        x41,
        y41,
        c9 * (x9 - x8 * slip3 * w3) + push4_moment * w4 + x7 * w3,
        -push2_x - push3_x - push4_x,
        -push2_y - push3_y - push4_y,
        c9 * (area * slip3 * w4 * (2 - slip3) - x9) - frame * push4_y - push4_moment - x7,
    )


def pin_forces(
    theta2, speed, frame, crank, coupler, follower, assembly, mass2, along2, inertia2, mass3,
    along3, inertia3, mass4, along4, inertia4,
):
    """Return every joint force.

    Parameters
    ----------
    theta2 : ndarray or float, shape (...)
        Crank angle [rad].
    speed : float or ndarray, shape (...)
        Crank speed [rad/s].
    frame : float
        Length of the fixed link AD [m].
    crank : float
        Length of the crank AB [m].
    coupler : float
        Length of the coupler BC [m].
    follower : float
        Length of the follower DC [m].
    assembly : float
        +1 for the open, -1 for the crossed assembly.
    mass2 : float or ndarray
        Mass of link 2 [kg].
    along2 : float or ndarray
        First moment along link 2 [kg m].
    inertia2 : float or ndarray
        Inertia, about its first joint, of link 2 [kg m^2].
    mass3 : float or ndarray
        Mass of link 3 [kg].
    along3 : float or ndarray
        First moment along link 3 [kg m].
    inertia3 : float or ndarray
        Inertia, about its first joint, of link 3 [kg m^2].
    mass4 : float or ndarray
        Mass of link 4 [kg].
    along4 : float or ndarray
        First moment along link 4 [kg m].
    inertia4 : float or ndarray
        Inertia, about its first joint, of link 4 [kg m^2].

    Returns
    -------
    x12 : ndarray, shape (...)
        Force of link 1 on link 2 along x [N].
    y12 : ndarray, shape (...)
        Force of link 1 on link 2 along y [N].
    x23 : ndarray, shape (...)
        Force of link 2 on link 3 along x [N].
    y23 : ndarray, shape (...)
        Force of link 2 on link 3 along y [N].
    x34 : ndarray, shape (...)
        Force of link 3 on link 4 along x [N].
    y34 : ndarray, shape (...)
        Force of link 3 on link 4 along y [N].
    x41 : ndarray, shape (...)
        Force of link 4 on link 1 along x [N].
    y41 : ndarray, shape (...)
        Force of link 4 on link 1 along y [N].

    Notes
    -----
    Smith (4.1)-(4.13).
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
    del lean, facing, pace, slip3
    square = speed**2
    along2_s = along2 * square
    mass3_s = mass3 * square
    along3_s = along3 * square
    inertia3_s = inertia3 * square
    along4_s = along4 * square
    inertia4_s = inertia4 * square
    spin_th3 = w3**2
    spin_th4 = w4**2
    c8 = along2_s / crank
    push2_x = -c8 * crank_x
    push2_y = -c8 * crank_y
    c9 = along3_s / coupler
    push3_x = -c9 * (a3 * coupler_y + coupler_x * spin_th3) - mass3_s * crank_x
    push3_y = c9 * (a3 * coupler_x - coupler_y * spin_th3) - mass3_s * crank_y
    del w3, crank_x, crank_y, spin_th3
    push3_moment = inertia3_s * a3 - c9 * area * w4
    del a3, area, w4
    c10 = along4_s / follower
    push4_x = -c10 * (a4 * follower_y + follower_x * spin_th4)
    push4_y = c10 * (a4 * follower_x - follower_y * spin_th4)
    push4_moment = inertia4_s * a4
    x34 = inverse * (coupler_x * push4_moment + follower_x * push3_moment)
    del spin_th4, a4, coupler_x, follower_x
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
    return (
        x12,
        y12,
        x23,
        y23,
        x34,
        y34,
        x41,
        y41,
    )


def driving_torque(
    theta2, speed, frame, crank, coupler, follower, assembly, mass2, along2, inertia2, mass3,
    along3, inertia3, mass4, along4, inertia4,
):
    """Return the torque on the crank, by virtual power.

    Parameters
    ----------
    theta2 : ndarray or float, shape (...)
        Crank angle [rad].
    speed : float or ndarray, shape (...)
        Crank speed [rad/s].
    frame : float
        Length of the fixed link AD [m].
    crank : float
        Length of the crank AB [m].
    coupler : float
        Length of the coupler BC [m].
    follower : float
        Length of the follower DC [m].
    assembly : float
        +1 for the open, -1 for the crossed assembly.
    mass2 : float or ndarray
        Mass of link 2 [kg].
    along2 : float or ndarray
        First moment along link 2 [kg m].
    inertia2 : float or ndarray
        Inertia, about its first joint, of link 2 [kg m^2].
    mass3 : float or ndarray
        Mass of link 3 [kg].
    along3 : float or ndarray
        First moment along link 3 [kg m].
    inertia3 : float or ndarray
        Inertia, about its first joint, of link 3 [kg m^2].
    mass4 : float or ndarray
        Mass of link 4 [kg].
    along4 : float or ndarray
        First moment along link 4 [kg m].
    inertia4 : float or ndarray
        Inertia, about its first joint, of link 4 [kg m^2].

    Returns
    -------
    torque : ndarray, shape (...)
        Torque of the drive on the crank, anticlockwise [N m].

    Notes
    -----
    Smith (4.1)-(4.13).
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
    del coupler_x, coupler_y, crank_x, crank_y
    a3 = pace * slip3 - follower_x * lean * w4
    a4 = -facing * inverse * slip3 - pace * w4
    del follower_x, lean, inverse, pace
    square = speed**2
    along3_s = along3 * square
    inertia3_s = inertia3 * square
    inertia4_s = inertia4 * square
    push4_moment = inertia4_s * a4
    c8 = along3_s / coupler
    return inertia3_s * a3 * w3 + c8 * (a3 * facing - area * slip3 * w3 * w4) + push4_moment * w4


def shaking_force(
    theta2, speed, frame, crank, coupler, follower, assembly, mass2, along2, inertia2, mass3,
    along3, inertia3, mass4, along4, inertia4,
):
    """Return the force on the frame, the change of momentum.

    Parameters
    ----------
    theta2 : ndarray or float, shape (...)
        Crank angle [rad].
    speed : float or ndarray, shape (...)
        Crank speed [rad/s].
    frame : float
        Length of the fixed link AD [m].
    crank : float
        Length of the crank AB [m].
    coupler : float
        Length of the coupler BC [m].
    follower : float
        Length of the follower DC [m].
    assembly : float
        +1 for the open, -1 for the crossed assembly.
    mass2 : float or ndarray
        Mass of link 2 [kg].
    along2 : float or ndarray
        First moment along link 2 [kg m].
    inertia2 : float or ndarray
        Inertia, about its first joint, of link 2 [kg m^2].
    mass3 : float or ndarray
        Mass of link 3 [kg].
    along3 : float or ndarray
        First moment along link 3 [kg m].
    inertia3 : float or ndarray
        Inertia, about its first joint, of link 3 [kg m^2].
    mass4 : float or ndarray
        Mass of link 4 [kg].
    along4 : float or ndarray
        First moment along link 4 [kg m].
    inertia4 : float or ndarray
        Inertia, about its first joint, of link 4 [kg m^2].

    Returns
    -------
    shaking_x : ndarray, shape (...)
        Force on the frame along x [N].
    shaking_y : ndarray, shape (...)
        Force on the frame along y [N].

    Notes
    -----
    Smith (4.1)-(4.13).
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
    along2_s = along2 * square
    mass3_s = mass3 * square
    along3_s = along3 * square
    along4_s = along4 * square
    spin_th3 = w3**2
    spin_th4 = w4**2
    c8 = along2_s / crank
    push2_x = -c8 * crank_x
    push2_y = -c8 * crank_y
    c9 = along3_s / coupler
    push3_x = -c9 * (a3 * coupler_y + coupler_x * spin_th3) - mass3_s * crank_x
    del w3, w4, crank_x
    push3_y = c9 * (a3 * coupler_x - coupler_y * spin_th3) - mass3_s * crank_y
    del a3, coupler_x, coupler_y, crank_y, spin_th3
    c10 = along4_s / follower
    push4_x = -c10 * (a4 * follower_y + follower_x * spin_th4)
    push4_y = c10 * (a4 * follower_x - follower_y * spin_th4)
    del a4, follower_x, follower_y, spin_th4
    return (
        -push2_x - push3_x - push4_x,
        -push2_y - push3_y - push4_y,
    )


def shaking_moment(
    theta2, speed, frame, crank, coupler, follower, assembly, mass2, along2, inertia2, mass3,
    along3, inertia3, mass4, along4, inertia4,
):
    """Return the moment on the frame about A, the change of moment of momentum.

    Parameters
    ----------
    theta2 : ndarray or float, shape (...)
        Crank angle [rad].
    speed : float or ndarray, shape (...)
        Crank speed [rad/s].
    frame : float
        Length of the fixed link AD [m].
    crank : float
        Length of the crank AB [m].
    coupler : float
        Length of the coupler BC [m].
    follower : float
        Length of the follower DC [m].
    assembly : float
        +1 for the open, -1 for the crossed assembly.
    mass2 : float or ndarray
        Mass of link 2 [kg].
    along2 : float or ndarray
        First moment along link 2 [kg m].
    inertia2 : float or ndarray
        Inertia, about its first joint, of link 2 [kg m^2].
    mass3 : float or ndarray
        Mass of link 3 [kg].
    along3 : float or ndarray
        First moment along link 3 [kg m].
    inertia3 : float or ndarray
        Inertia, about its first joint, of link 3 [kg m^2].
    mass4 : float or ndarray
        Mass of link 4 [kg].
    along4 : float or ndarray
        First moment along link 4 [kg m].
    inertia4 : float or ndarray
        Inertia, about its first joint, of link 4 [kg m^2].

    Returns
    -------
    shaking_moment : ndarray, shape (...)
        Moment on the frame about A, the drive's reaction in it [N m].

    Notes
    -----
    Smith (4.1)-(4.13).
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
    del travel, w3, dot, spread
    facing = coupler_x * crank_x + coupler_y * crank_y
    del coupler_x, coupler_y, crank_x, crank_y
    a3 = pace * slip3 - follower_x * lean * w4
    a4 = -facing * inverse * slip3 - pace * w4
    del lean, inverse, pace
    square = speed**2
    along3_s = along3 * square
    inertia3_s = inertia3 * square
    along4_s = along4 * square
    inertia4_s = inertia4 * square
    spin_th4 = w4**2
    c8 = along4_s / follower
    push4_y = c8 * (a4 * follower_x - follower_y * spin_th4)
    del follower_x, follower_y, spin_th4
    push4_moment = inertia4_s * a4
    c9 = along3_s / coupler
    return (
        c9 * (area * slip3 * w4 * (2 - slip3) - a3 * facing) - inertia3_s * a3 - frame * push4_y -
        push4_moment
    )


def load_forces(
    theta2, frame, crank, coupler, follower, assembly, fx2, fy2, couple2, fx3, fy3, couple3, fx4,
    fy4, couple4,
):
    """Return what external loads alone call forth.

    Parameters
    ----------
    theta2 : ndarray or float, shape (...)
        Crank angle [rad].
    frame : float
        Length of the fixed link AD [m].
    crank : float
        Length of the crank AB [m].
    coupler : float
        Length of the coupler BC [m].
    follower : float
        Length of the follower DC [m].
    assembly : float
        +1 for the open, -1 for the crossed assembly.
    fx2 : float or ndarray
        Force along x at the first joint of link 2 [N].
    fy2 : float or ndarray
        Force along y at the first joint of link 2 [N].
    couple2 : float or ndarray
        Couple on link 2 [N m].
    fx3 : float or ndarray
        Force along x at the first joint of link 3 [N].
    fy3 : float or ndarray
        Force along y at the first joint of link 3 [N].
    couple3 : float or ndarray
        Couple on link 3 [N m].
    fx4 : float or ndarray
        Force along x at the first joint of link 4 [N].
    fy4 : float or ndarray
        Force along y at the first joint of link 4 [N].
    couple4 : float or ndarray
        Couple on link 4 [N m].

    Returns
    -------
    x12 : ndarray, shape (...)
        Force of link 1 on link 2 along x [N].
    y12 : ndarray, shape (...)
        Force of link 1 on link 2 along y [N].
    x23 : ndarray, shape (...)
        Force of link 2 on link 3 along x [N].
    y23 : ndarray, shape (...)
        Force of link 2 on link 3 along y [N].
    x34 : ndarray, shape (...)
        Force of link 3 on link 4 along x [N].
    y34 : ndarray, shape (...)
        Force of link 3 on link 4 along y [N].
    x41 : ndarray, shape (...)
        Force of link 4 on link 1 along x [N].
    y41 : ndarray, shape (...)
        Force of link 4 on link 1 along y [N].
    torque : ndarray, shape (...)
        Torque of the drive on the crank, anticlockwise [N m].
    shaking_x : ndarray, shape (...)
        Force on the frame along x [N].
    shaking_y : ndarray, shape (...)
        Force on the frame along y [N].
    shaking_moment : ndarray, shape (...)
        Moment on the frame about A, the drive's reaction in it [N m].

    Notes
    -----
    Smith (4.1)-(4.13).
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
        x12,
        y12,
        x23,
        y23,
        x34,
        y34,
        x41,
        y41,
        torque,
        fx2 + fx3 + fx4,
        fy2 + fy3 + fy4,
        fy3 * crank_x - c7 - fx3 * crank_y,
    )
