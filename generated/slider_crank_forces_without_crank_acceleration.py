"""Forces of the rigid slider-crank in closed form.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism slider_crank, formulation forces, without crank_acceleration.
Equations: Newton and Euler's, as Smith (4.4)-(4.6).

Link 1 is the frame, 2 the crank; each moving link has axes of its own from its first joint along
the link.  The forces are linear in masses, moments and inertias: at unit values of one of these
they are the derivatives by it.

For a crank of constant speed.

Cost per evaluation:
    forces: 167 operations
    pin_forces: 123 operations
    driving_torque: 110 operations
    shaking_force: 101 operations
    shaking_moment: 107 operations
    load_forces: 75 operations
Content hash d1bf706a6b8e5de0d4dbc6b56d2808b1; derived with SymPy 1.14.0.
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
    '{"balanced":[],"drop":["crank_acceleration"],"flexible":[],"formulation":"forces","mechanism"'
    ':"slider_crank","modes":null,"outputs":[]}'
)
CONTENT = "d1bf706a6b8e5de0d4dbc6b56d2808b1"

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
        "couple41",
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
        "couple41",
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
        "couple41",
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
    theta2, speed, crank, coupler, offset, assembly, mass2, along2, across2, inertia2, mass3,
    along3, across3, inertia3, mass4, along4, across4, inertia4,
):
    """Return every joint force, the torque, and the force and moment on the frame.

    Parameters
    ----------
    theta2 : ndarray or float, shape (...)
        Crank angle from the guide [rad].
    speed : float or ndarray, shape (...)
        Crank speed [rad/s].
    crank : float
        Length of the crank AB [m].
    coupler : float
        Length of the coupler BC [m].
    offset : float
        Height of the guide over the crank's pivot A [m].
    assembly : float
        +1 where the slider is right of B (open), -1 left.
    mass2 : float or ndarray
        Mass of link 2 [kg].
    along2 : float or ndarray
        First moment along link 2 [kg m].
    across2 : float or ndarray
        First moment across link 2 [kg m].
    inertia2 : float or ndarray
        Inertia, about its first joint, of link 2 [kg m^2].
    mass3 : float or ndarray
        Mass of link 3 [kg].
    along3 : float or ndarray
        First moment along link 3 [kg m].
    across3 : float or ndarray
        First moment across link 3 [kg m].
    inertia3 : float or ndarray
        Inertia, about its first joint, of link 3 [kg m^2].
    mass4 : float or ndarray
        Mass of link 4 [kg].
    along4 : float or ndarray
        First moment along link 4 [kg m].
    across4 : float or ndarray
        First moment across link 4 [kg m].
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
    couple41 : ndarray, shape (...)
        Couple of link 4 on link 1 [N m].
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
    Newton and Euler's, as Smith (4.4)-(4.6).
    """
    xp = _namespace(theta2)
    reach = coupler - crank
    total = coupler + crank
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    x1 = half_cosine + half_sine
    x2 = half_cosine - half_sine
    del x0, half_cosine, half_sine
    cos2 = x1 * x2
    raised = x1**2 / 2
    lowered = x2**2 / 2
    x3 = offset + total
    c0 = x3
    x4 = offset + reach
    c1 = x4
    above = c0 * lowered + c1 * raised
    x5 = offset - reach
    c2 = x5
    x6 = offset - total
    c3 = x6
    below = -c2 * lowered - c3 * raised
    root = xp.sqrt(above * below)
    x7 = 1 / coupler
    c4 = x7
    sin3 = c4 * (offset - crank * sin2)
    c5 = 2 * assembly
    cos3 = c5 * root / (above + below)
    del x1, x2, above, below, root
    x8 = cos2 * sin3
    sin23 = cos3 * sin2 - x8
    x9 = sin2 * sin3
    cos23 = cos2 * cos3 + x9
    x10 = x7 * crank
    c6 = x10
    x11 = 1 / cos3
    x13 = c6 * cos2
    omega3 = -x11 * x13
    c7 = x3 * x5
    c8 = x4 * x6
    c9 = offset * crank
    c10 = crank / coupler**3
    alpha3 = c10 * (c9 * cos2**2 + sin2 * (-c7 * lowered - c8 * raised)) / cos3**3
    slider_velocity = -crank * x11 * sin23
    x14 = alpha3 * sin3
    x15 = omega3**2
    slider_acceleration = -crank * cos2 - coupler * x15 * cos3 - coupler * x14
    square = speed**2
    along2_s = along2 * square
    across2_s = across2 * square
    mass3_s = mass3 * square
    along3_s = along3 * square
    across3_s = across3 * square
    inertia3_s = inertia3 * square
    mass4_s = mass4 * square
    across4_s = across4 * square
    spin_th3 = x15
    push2_x = across2_s * sin2 - along2_s * cos2
    push2_y = -across2_s * cos2 - along2_s * sin2
    c11 = mass3_s * crank
    c12 = x10 * across3_s
    x16 = cos3 * spin_th3 + x14
    del lowered, raised, cos3, spin_th3, x14
    push3_x = -along3_s * x16 - c11 * cos2 - c12 * sin2
    c13 = x10 * along3_s
    push3_y = c13 * sin2 - across3_s * x16 - c11 * sin2
    c14 = across3_s * crank
    c15 = along3_s * crank
    x17 = inertia3_s * alpha3
    push3_moment = c14 * cos23 - c15 * sin23 + x17
    x18 = mass4_s * slider_acceleration
    push4_x = x18
    x19 = across4_s * slider_acceleration
    push4_moment = -x19
    x20 = push3_x + push4_x
    del cos2, x16, push3_x
    x23 = x20
    x12 = push2_x + x23
    y34 = x11 * (push4_x * sin3 - c4 * push3_moment)
    del push3_moment, sin3, x11
    y23 = push3_y + y34
    y12 = push2_y + y23
    c16 = mass4_s * offset
    x21 = x9 * alpha3 + x13 * sin2 + x15 * sin23 + x15 * x8
    x22 = c6 * sin2**2 - x8 * alpha3 - x15 * cos23 + x15 * x9
    del x13, alpha3, sin2, x15, x8, x9
    return (
        x12,
        y12,
        x23,
        y23,
        push4_x,
        y34,
        0,
        y34,
        -push4_moment,
        (
            c14 * (cos23 * omega3 + x22) + c15 * (x21 - omega3 * sin23) + x17 * omega3 + x18 *
            slider_velocity
        ),
        -push2_x - x20,
        -push2_y - push3_y,
        -c14 * (cos23 + x22) + c15 * (sin23 - x21) + c16 * slider_acceleration - x17 + x19,
    )


def pin_forces(
    theta2, speed, crank, coupler, offset, assembly, mass2, along2, across2, inertia2, mass3,
    along3, across3, inertia3, mass4, along4, across4, inertia4,
):
    """Return every joint force.

    Parameters
    ----------
    theta2 : ndarray or float, shape (...)
        Crank angle from the guide [rad].
    speed : float or ndarray, shape (...)
        Crank speed [rad/s].
    crank : float
        Length of the crank AB [m].
    coupler : float
        Length of the coupler BC [m].
    offset : float
        Height of the guide over the crank's pivot A [m].
    assembly : float
        +1 where the slider is right of B (open), -1 left.
    mass2 : float or ndarray
        Mass of link 2 [kg].
    along2 : float or ndarray
        First moment along link 2 [kg m].
    across2 : float or ndarray
        First moment across link 2 [kg m].
    inertia2 : float or ndarray
        Inertia, about its first joint, of link 2 [kg m^2].
    mass3 : float or ndarray
        Mass of link 3 [kg].
    along3 : float or ndarray
        First moment along link 3 [kg m].
    across3 : float or ndarray
        First moment across link 3 [kg m].
    inertia3 : float or ndarray
        Inertia, about its first joint, of link 3 [kg m^2].
    mass4 : float or ndarray
        Mass of link 4 [kg].
    along4 : float or ndarray
        First moment along link 4 [kg m].
    across4 : float or ndarray
        First moment across link 4 [kg m].
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
    couple41 : ndarray, shape (...)
        Couple of link 4 on link 1 [N m].

    Notes
    -----
    Newton and Euler's, as Smith (4.4)-(4.6).
    """
    xp = _namespace(theta2)
    reach = coupler - crank
    total = coupler + crank
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    x1 = half_cosine + half_sine
    x2 = half_cosine - half_sine
    del x0, half_cosine, half_sine
    cos2 = x1 * x2
    raised = x1**2 / 2
    lowered = x2**2 / 2
    x3 = offset + total
    c0 = x3
    x4 = offset + reach
    c1 = x4
    above = c0 * lowered + c1 * raised
    x5 = offset - reach
    c2 = x5
    x6 = offset - total
    c3 = x6
    below = -c2 * lowered - c3 * raised
    root = xp.sqrt(above * below)
    x7 = 1 / coupler
    c4 = x7
    sin3 = c4 * (offset - crank * sin2)
    c5 = 2 * assembly
    cos3 = c5 * root / (above + below)
    del x1, x2, above, below, root
    sin23 = cos3 * sin2 - cos2 * sin3
    cos23 = cos2 * cos3 + sin2 * sin3
    x8 = x7 * crank
    c6 = x8
    x9 = 1 / cos3
    omega3 = -c6 * x9 * cos2
    c7 = x3 * x5
    c8 = x4 * x6
    c9 = offset * crank
    c10 = crank / coupler**3
    alpha3 = c10 * (c9 * cos2**2 + sin2 * (-c7 * lowered - c8 * raised)) / cos3**3
    x10 = alpha3 * sin3
    x11 = omega3**2
    del lowered, raised, omega3
    slider_acceleration = -crank * cos2 - coupler * x11 * cos3 - coupler * x10
    square = speed**2
    along2_s = along2 * square
    across2_s = across2 * square
    mass3_s = mass3 * square
    along3_s = along3 * square
    across3_s = across3 * square
    inertia3_s = inertia3 * square
    mass4_s = mass4 * square
    across4_s = across4 * square
    spin_th3 = x11
    push2_x = across2_s * sin2 - along2_s * cos2
    push2_y = -across2_s * cos2 - along2_s * sin2
    c11 = mass3_s * crank
    c12 = x8 * across3_s
    x13 = cos3 * spin_th3 + x10
    del x11, cos3, spin_th3, x10
    push3_x = -along3_s * x13 - c11 * cos2 - c12 * sin2
    c13 = x8 * along3_s
    push3_y = c13 * sin2 - across3_s * x13 - c11 * sin2
    del cos2, sin2, x13
    c14 = across3_s * crank
    c15 = along3_s * crank
    push3_moment = inertia3_s * alpha3 + c14 * cos23 - c15 * sin23
    del alpha3, cos23, sin23
    push4_x = mass4_s * slider_acceleration
    push4_moment = -across4_s * slider_acceleration
    x23 = push3_x + push4_x
    x12 = push2_x + x23
    del slider_acceleration, push3_x, push2_x
    y34 = x9 * (push4_x * sin3 - c4 * push3_moment)
    del push3_moment, sin3, x9
    y23 = push3_y + y34
    y12 = push2_y + y23
    return (
        x12,
        y12,
        x23,
        y23,
        push4_x,
        y34,
        0,
        y34,
        -push4_moment,
    )


def driving_torque(
    theta2, speed, crank, coupler, offset, assembly, mass2, along2, across2, inertia2, mass3,
    along3, across3, inertia3, mass4, along4, across4, inertia4,
):
    """Return the torque on the crank, by virtual power.

    Parameters
    ----------
    theta2 : ndarray or float, shape (...)
        Crank angle from the guide [rad].
    speed : float or ndarray, shape (...)
        Crank speed [rad/s].
    crank : float
        Length of the crank AB [m].
    coupler : float
        Length of the coupler BC [m].
    offset : float
        Height of the guide over the crank's pivot A [m].
    assembly : float
        +1 where the slider is right of B (open), -1 left.
    mass2 : float or ndarray
        Mass of link 2 [kg].
    along2 : float or ndarray
        First moment along link 2 [kg m].
    across2 : float or ndarray
        First moment across link 2 [kg m].
    inertia2 : float or ndarray
        Inertia, about its first joint, of link 2 [kg m^2].
    mass3 : float or ndarray
        Mass of link 3 [kg].
    along3 : float or ndarray
        First moment along link 3 [kg m].
    across3 : float or ndarray
        First moment across link 3 [kg m].
    inertia3 : float or ndarray
        Inertia, about its first joint, of link 3 [kg m^2].
    mass4 : float or ndarray
        Mass of link 4 [kg].
    along4 : float or ndarray
        First moment along link 4 [kg m].
    across4 : float or ndarray
        First moment across link 4 [kg m].
    inertia4 : float or ndarray
        Inertia, about its first joint, of link 4 [kg m^2].

    Returns
    -------
    torque : ndarray, shape (...)
        Torque of the drive on the crank, anticlockwise [N m].

    Notes
    -----
    Newton and Euler's, as Smith (4.4)-(4.6).
    """
    xp = _namespace(theta2)
    reach = coupler - crank
    total = coupler + crank
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    x1 = half_cosine + half_sine
    x2 = half_cosine - half_sine
    del x0, half_cosine, half_sine
    cos2 = x1 * x2
    raised = x1**2 / 2
    lowered = x2**2 / 2
    x3 = offset + total
    c0 = x3
    x4 = offset + reach
    c1 = x4
    above = c0 * lowered + c1 * raised
    x5 = offset - reach
    c2 = x5
    x6 = offset - total
    c3 = x6
    below = -c2 * lowered - c3 * raised
    root = xp.sqrt(above * below)
    x7 = 1 / coupler
    c4 = x7
    sin3 = c4 * (offset - crank * sin2)
    c5 = 2 * assembly
    cos3 = c5 * root / (above + below)
    del x1, x2, above, below, root
    x8 = cos2 * sin3
    sin23 = cos3 * sin2 - x8
    x9 = sin2 * sin3
    cos23 = cos2 * cos3 + x9
    c6 = x7 * crank
    x10 = 1 / cos3
    x11 = c6 * cos2
    omega3 = -x10 * x11
    c7 = x3 * x5
    c8 = x4 * x6
    c9 = offset * crank
    c10 = crank / coupler**3
    alpha3 = c10 * (c9 * cos2**2 + sin2 * (-c7 * lowered - c8 * raised)) / cos3**3
    slider_velocity = -crank * x10 * sin23
    del lowered, raised, x10
    x12 = omega3**2
    slider_acceleration = -coupler * alpha3 * sin3 - crank * cos2 - coupler * x12 * cos3
    del cos2, cos3, sin3
    square = speed**2
    along3_s = along3 * square
    across3_s = across3 * square
    inertia3_s = inertia3 * square
    mass4_s = mass4 * square
    c11 = across3_s * crank
    c12 = along3_s * crank
    return (
        inertia3_s * alpha3 * omega3 + c11 * (c6 * sin2**2 - x8 * alpha3 + cos23 * omega3 - x12 *
        cos23 + x12 * x9) + c12 * (x9 * alpha3 - omega3 * sin23 + x11 * sin2 + x12 * sin23 + x12 *
        x8) + mass4_s * slider_acceleration * slider_velocity
    )


def shaking_force(
    theta2, speed, crank, coupler, offset, assembly, mass2, along2, across2, inertia2, mass3,
    along3, across3, inertia3, mass4, along4, across4, inertia4,
):
    """Return the force on the frame, the change of momentum.

    Parameters
    ----------
    theta2 : ndarray or float, shape (...)
        Crank angle from the guide [rad].
    speed : float or ndarray, shape (...)
        Crank speed [rad/s].
    crank : float
        Length of the crank AB [m].
    coupler : float
        Length of the coupler BC [m].
    offset : float
        Height of the guide over the crank's pivot A [m].
    assembly : float
        +1 where the slider is right of B (open), -1 left.
    mass2 : float or ndarray
        Mass of link 2 [kg].
    along2 : float or ndarray
        First moment along link 2 [kg m].
    across2 : float or ndarray
        First moment across link 2 [kg m].
    inertia2 : float or ndarray
        Inertia, about its first joint, of link 2 [kg m^2].
    mass3 : float or ndarray
        Mass of link 3 [kg].
    along3 : float or ndarray
        First moment along link 3 [kg m].
    across3 : float or ndarray
        First moment across link 3 [kg m].
    inertia3 : float or ndarray
        Inertia, about its first joint, of link 3 [kg m^2].
    mass4 : float or ndarray
        Mass of link 4 [kg].
    along4 : float or ndarray
        First moment along link 4 [kg m].
    across4 : float or ndarray
        First moment across link 4 [kg m].
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
    Newton and Euler's, as Smith (4.4)-(4.6).
    """
    xp = _namespace(theta2)
    reach = coupler - crank
    total = coupler + crank
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    x1 = half_cosine + half_sine
    x2 = half_cosine - half_sine
    del x0, half_cosine, half_sine
    cos2 = x1 * x2
    raised = x1**2 / 2
    lowered = x2**2 / 2
    x3 = offset + total
    c0 = x3
    x4 = offset + reach
    c1 = x4
    above = c0 * lowered + c1 * raised
    x5 = offset - reach
    c2 = x5
    x6 = offset - total
    c3 = x6
    below = -c2 * lowered - c3 * raised
    root = xp.sqrt(above * below)
    x7 = 1 / coupler
    c4 = x7
    sin3 = c4 * (offset - crank * sin2)
    c5 = 2 * assembly
    cos3 = c5 * root / (above + below)
    del x1, x2, above, below, root
    x8 = x7 * crank
    c6 = x8
    omega3 = -c6 * cos2 / cos3
    c7 = x3 * x5
    c8 = x4 * x6
    c9 = offset * crank
    c10 = crank / coupler**3
    alpha3 = c10 * (c9 * cos2**2 + sin2 * (-c7 * lowered - c8 * raised)) / cos3**3
    x9 = alpha3 * sin3
    del lowered, raised, alpha3, sin3
    x10 = omega3**2
    slider_acceleration = -crank * cos2 - coupler * x10 * cos3 - coupler * x9
    square = speed**2
    along2_s = along2 * square
    across2_s = across2 * square
    mass3_s = mass3 * square
    along3_s = along3 * square
    across3_s = across3 * square
    mass4_s = mass4 * square
    spin_th3 = x10
    push2_x = across2_s * sin2 - along2_s * cos2
    push2_y = -across2_s * cos2 - along2_s * sin2
    c11 = mass3_s * crank
    c12 = x8 * across3_s
    x11 = cos3 * spin_th3 + x9
    del omega3, x10, cos3, spin_th3, x9
    push3_x = -along3_s * x11 - c11 * cos2 - c12 * sin2
    c13 = x8 * along3_s
    push3_y = c13 * sin2 - across3_s * x11 - c11 * sin2
    del cos2, sin2, x11
    push4_x = mass4_s * slider_acceleration
    return (
        -push2_x - push3_x - push4_x,
        -push2_y - push3_y,
    )


def shaking_moment(
    theta2, speed, crank, coupler, offset, assembly, mass2, along2, across2, inertia2, mass3,
    along3, across3, inertia3, mass4, along4, across4, inertia4,
):
    """Return the moment on the frame about A, the change of moment of momentum.

    Parameters
    ----------
    theta2 : ndarray or float, shape (...)
        Crank angle from the guide [rad].
    speed : float or ndarray, shape (...)
        Crank speed [rad/s].
    crank : float
        Length of the crank AB [m].
    coupler : float
        Length of the coupler BC [m].
    offset : float
        Height of the guide over the crank's pivot A [m].
    assembly : float
        +1 where the slider is right of B (open), -1 left.
    mass2 : float or ndarray
        Mass of link 2 [kg].
    along2 : float or ndarray
        First moment along link 2 [kg m].
    across2 : float or ndarray
        First moment across link 2 [kg m].
    inertia2 : float or ndarray
        Inertia, about its first joint, of link 2 [kg m^2].
    mass3 : float or ndarray
        Mass of link 3 [kg].
    along3 : float or ndarray
        First moment along link 3 [kg m].
    across3 : float or ndarray
        First moment across link 3 [kg m].
    inertia3 : float or ndarray
        Inertia, about its first joint, of link 3 [kg m^2].
    mass4 : float or ndarray
        Mass of link 4 [kg].
    along4 : float or ndarray
        First moment along link 4 [kg m].
    across4 : float or ndarray
        First moment across link 4 [kg m].
    inertia4 : float or ndarray
        Inertia, about its first joint, of link 4 [kg m^2].

    Returns
    -------
    shaking_moment : ndarray, shape (...)
        Moment on the frame about A, the drive's reaction in it [N m].

    Notes
    -----
    Newton and Euler's, as Smith (4.4)-(4.6).
    """
    xp = _namespace(theta2)
    reach = coupler - crank
    total = coupler + crank
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    x1 = half_cosine + half_sine
    x2 = half_cosine - half_sine
    del x0, half_cosine, half_sine
    cos2 = x1 * x2
    raised = x1**2 / 2
    lowered = x2**2 / 2
    x3 = offset + total
    c0 = x3
    x4 = offset + reach
    c1 = x4
    above = c0 * lowered + c1 * raised
    x5 = offset - reach
    c2 = x5
    x6 = offset - total
    c3 = x6
    below = -c2 * lowered - c3 * raised
    root = xp.sqrt(above * below)
    x7 = 1 / coupler
    c4 = x7
    sin3 = c4 * (offset - crank * sin2)
    c5 = 2 * assembly
    cos3 = c5 * root / (above + below)
    del x1, x2, above, below, root
    x8 = cos2 * sin3
    sin23 = cos3 * sin2 - x8
    x9 = sin2 * sin3
    cos23 = cos2 * cos3 + x9
    c6 = x7 * crank
    x10 = c6 * cos2
    omega3 = -x10 / cos3
    c7 = x3 * x5
    c8 = x4 * x6
    c9 = offset * crank
    c10 = crank / coupler**3
    alpha3 = c10 * (c9 * cos2**2 + sin2 * (-c7 * lowered - c8 * raised)) / cos3**3
    x11 = omega3**2
    del lowered, raised, omega3
    slider_acceleration = -coupler * alpha3 * sin3 - crank * cos2 - coupler * x11 * cos3
    square = speed**2
    along3_s = along3 * square
    across3_s = across3 * square
    inertia3_s = inertia3 * square
    mass4_s = mass4 * square
    across4_s = across4 * square
    c11 = across3_s * crank
    c12 = along3_s * crank
    c13 = mass4_s * offset
    return (
        across4_s * slider_acceleration - inertia3_s * alpha3 + c11 * (alpha3 * cos2 * sin3 - c6 *
        sin2**2 + x11 * cos23 - cos23 - x11 * x9) + c12 * (sin23 - x9 * alpha3 - x10 * sin2 - x11 *
        sin23 - x11 * x8) + c13 * slider_acceleration
    )


def load_forces(
    theta2, crank, coupler, offset, assembly, fx2, fy2, couple2, fx3, fy3, couple3, fx4, fy4,
    couple4,
):
    """Return what external loads alone call forth.

    Parameters
    ----------
    theta2 : ndarray or float, shape (...)
        Crank angle from the guide [rad].
    crank : float
        Length of the crank AB [m].
    coupler : float
        Length of the coupler BC [m].
    offset : float
        Height of the guide over the crank's pivot A [m].
    assembly : float
        +1 where the slider is right of B (open), -1 left.
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
    couple41 : ndarray, shape (...)
        Couple of link 4 on link 1 [N m].
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
    Newton and Euler's, as Smith (4.4)-(4.6).
    """
    xp = _namespace(theta2)
    reach = coupler - crank
    total = coupler + crank
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    x1 = half_cosine + half_sine
    x2 = half_cosine - half_sine
    del x0, half_cosine, half_sine
    cos2 = x1 * x2
    raised = x1**2 / 2
    lowered = x2**2 / 2
    c0 = offset + total
    c1 = offset + reach
    above = c0 * lowered + c1 * raised
    c2 = offset - reach
    c3 = offset - total
    below = -c2 * lowered - c3 * raised
    del x1, x2, lowered, raised
    root = xp.sqrt(above * below)
    x3 = 1 / coupler
    c4 = x3
    sin3 = c4 * (offset - crank * sin2)
    c5 = 2 * assembly
    cos3 = c5 * root / (above + below)
    del above, below, root
    position = crank * cos2 + coupler * cos3
    x4 = fx3 + fx4
    x23 = -x4
    x12 = x23 - fx2
    c6 = -x3 * couple3
    y34 = (-c6 - fx4 * sin3) / cos3
    y23 = y34 - fy3
    y12 = y23 - fy2
    c7 = x23 * crank
    torque = crank * cos2 * y23 - c7 * sin2 - couple2
    normal41 = fy4 + y34
    c8 = -fx3 * crank
    c9 = -fy3 * crank
    c10 = fx4 * offset - couple2 - couple3 - couple4
    return (
        x12,
        y12,
        x23,
        y23,
        -fx4,
        y34,
        0,
        normal41,
        couple4,
        torque,
        fx2 + x4,
        fy2 + fy3 + fy4,
        c8 * sin2 - c10 - c9 * cos2 + fy4 * position,
    )
