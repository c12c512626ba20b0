"""Forces of the rigid slider-crank in closed form.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism slider_crank, formulation forces.
Equations: Newton and Euler's, as Smith (4.4)-(4.6).

Link 1 is the frame, 2 the crank; each moving link has axes of its own from its first joint along
the link.  The forces are linear in masses, moments and inertias: at unit values of one of these
they are the derivatives by it.

Cost per evaluation:
    forces: 200 operations
    pin_forces: 137 operations
    driving_torque: 134 operations
    shaking_force: 115 operations
    shaking_moment: 137 operations
    load_forces: 75 operations
Content hash dc78c6a803b343f35d9712d76a3666f8; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = [
    "forces", "pin_forces", "driving_torque", "shaking_force", "shaking_moment", "load_forces",
]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"forces","mechanism":"slider_crank","mod'
    'es":null,"outputs":[]}'
)
CONTENT = "dc78c6a803b343f35d9712d76a3666f8"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "theta2": ("rad", "Crank angle from the guide"),
    "speed": ("rad/s", "Crank speed"),
    "acceleration": ("rad/s^2", "Crank acceleration"),
    "crank": ("m", "Length of the crank AB"),
    "coupler": ("m", "Length of the coupler BC"),
    "offset": ("m", "Height of the guide over the crank's pivot A"),
    "assembly": ("", "+1 where the slider is right of B (open), -1 left"),
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
    "couple41": ("N m", "Couple of link 4 on link 1"),
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
        "x12", "y12", "x23", "y23", "x34", "y34", "x41", "y41", "couple41", "torque", "shaking_x",
        "shaking_y", "shaking_moment",
    ),
    "pin_forces": ("x12", "y12", "x23", "y23", "x34", "y34", "x41", "y41", "couple41"),
    "driving_torque": ("torque",),
    "shaking_force": ("shaking_x", "shaking_y"),
    "shaking_moment": ("shaking_moment",),
    "load_forces": (
        "x12", "y12", "x23", "y23", "x34", "y34", "x41", "y41", "couple41", "torque", "shaking_x",
        "shaking_y", "shaking_moment",
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
    theta2, speed, acceleration, crank, coupler, offset, assembly, mass2, along2, across2,
    inertia2, mass3, along3, across3, inertia3, mass4, along4, across4, inertia4,
):
    """Return every joint force, the torque, and the force and moment on the frame.

    theta2 : ndarray or float, shape (...)
    speed, acceleration : float or ndarray, shape (...)
    crank, coupler, offset, assembly : float
    mass2 to inertia4 : float or ndarray
    Returns ndarray, shape (...) each.
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
    omega3 = -c6 * x11 * cos2
    c7 = x3 * x5
    c8 = x4 * x6
    c9 = offset * crank
    c10 = crank / coupler**3
    x13 = cos2**2
    alpha3 = c10 * (c9 * x13 + sin2 * (-c7 * lowered - c8 * raised)) / cos3**3
    slider_velocity = -crank * x11 * sin23
    x14 = omega3**2
    slider_acceleration = -coupler * alpha3 * sin3 - crank * cos2 - coupler * x14 * cos3
    square = speed**2
    x15 = square * x14
    del lowered, raised, x14
    spin_th3 = x15
    x16 = acceleration * omega3
    turn_th3 = square * alpha3 + x16
    turn_place = acceleration * slider_velocity + square * slider_acceleration
    x17 = acceleration * cos2 - square * sin2
    x19 = acceleration * sin2 + square * cos2
    push2_x = -across2 * x17 - along2 * x19
    push2_y = along2 * x17 - across2 * x19
    push2_moment = acceleration * inertia2
    c11 = mass3 * crank
    c12 = x10 * across3
    x20 = cos3 * spin_th3 + sin3 * turn_th3
    del alpha3, slider_acceleration, cos3, spin_th3
    push3_x = c12 * x17 - along3 * x20 - c11 * x19
    c13 = x10 * along3
    push3_y = c11 * x17 - across3 * x20 - c13 * x17
    del x19, x17, x20
    c14 = across3 * crank
    c15 = along3 * crank
    x21 = inertia3 * turn_th3
    x22 = square * cos23
    x24 = acceleration * sin23 + x22
    x25 = square * sin23
    x26 = acceleration * cos23 - x25
    push3_moment = c14 * x24 + c15 * x26 + x21
    x27 = mass4 * turn_place
    push4_x = x27
    x28 = across4 * turn_place
    push4_moment = -x28
    x29 = push3_x + push4_x
    x23 = x29
    x12 = push2_x + x23
    y34 = x11 * (push4_x * sin3 - c4 * push3_moment)
    del push3_x, push3_moment, sin3, x11
    y23 = push3_y + y34
    y12 = push2_y + y23
    c16 = x10 * square
    c17 = x10 * acceleration
    c18 = acceleration * mass3 * crank**2
    c19 = mass4 * offset
    x30 = sin2**2
    x31 = c18 * (x13 + x30)
    x32 = cos2 * sin2
    x33 = c16 * x32 - c17 * x13 + x15 * sin23 + x9 * turn_th3 + x15 * x8
    del cos2, sin2, x13
    x34 = c16 * x30 - c17 * x32 - x15 * cos23 - x8 * turn_th3 + x15 * x9
    del turn_th3, x15, x30, x32, x8, x9
    return (
        x12, y12, x23, y23, push4_x, y34, 0, y34, -push4_moment,
        (
            c14 * (x22 * omega3 + x16 * sin23 + x34) + c15 * (x16 * cos23 - x25 * omega3 + x33) +
            x21 * omega3 + push2_moment + x27 * slider_velocity + x31
        ),
        -push2_x - x29, -push2_y - push3_y,
        (
            -c14 * (x24 + x34) + (-c15 * (x26 + x33)) + c19 * turn_place - push2_moment - x21 + x28
            - x31
        ),
    )


def pin_forces(
    theta2, speed, acceleration, crank, coupler, offset, assembly, mass2, along2, across2,
    inertia2, mass3, along3, across3, inertia3, mass4, along4, across4, inertia4,
):
    """Return every joint force.

    theta2 : ndarray or float, shape (...)
    speed, acceleration : float or ndarray, shape (...)
    crank, coupler, offset, assembly : float
    mass2 to inertia4 : float or ndarray
    Returns ndarray, shape (...) each.
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
    slider_velocity = -crank * x9 * sin23
    x10 = omega3**2
    slider_acceleration = -coupler * alpha3 * sin3 - crank * cos2 - coupler * x10 * cos3
    square = speed**2
    spin_th3 = square * x10
    del lowered, raised, x10
    turn_th3 = acceleration * omega3 + square * alpha3
    turn_place = acceleration * slider_velocity + square * slider_acceleration
    del alpha3, omega3, slider_acceleration, slider_velocity
    x11 = acceleration * cos2 - square * sin2
    x14 = acceleration * sin2 + square * cos2
    push2_x = -across2 * x11 - along2 * x14
    push2_y = along2 * x11 - across2 * x14
    c11 = mass3 * crank
    c12 = x8 * across3
    x15 = cos3 * spin_th3 + sin3 * turn_th3
    del cos2, sin2, cos3, spin_th3
    push3_x = c12 * x11 - along3 * x15 - c11 * x14
    c13 = x8 * along3
    push3_y = c11 * x11 - across3 * x15 - c13 * x11
    del x14, x11, x15
    c14 = across3 * crank
    c15 = along3 * crank
    push3_moment = (
        c14 * (acceleration * sin23 + square * cos23) + c15 * (acceleration * cos23 - square *
        sin23) + inertia3 * turn_th3
    )
    del cos23, sin23, turn_th3
    push4_x = mass4 * turn_place
    push4_moment = -across4 * turn_place
    x23 = push3_x + push4_x
    x12 = push2_x + x23
    del turn_place, push3_x, push2_x
    y34 = x9 * (push4_x * sin3 - c4 * push3_moment)
    del push3_moment, sin3, x9
    y23 = push3_y + y34
    y12 = push2_y + y23
    return x12, y12, x23, y23, push4_x, y34, 0, y34, -push4_moment


def driving_torque(
    theta2, speed, acceleration, crank, coupler, offset, assembly, mass2, along2, across2,
    inertia2, mass3, along3, across3, inertia3, mass4, along4, across4, inertia4,
):
    """Return the torque on the crank, by virtual power.

    theta2 : ndarray or float, shape (...)
    speed, acceleration : float or ndarray, shape (...)
    crank, coupler, offset, assembly : float
    mass2 to inertia4 : float or ndarray
    Returns ndarray, shape (...).
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
    omega3 = -c6 * x11 * cos2
    c7 = x3 * x5
    c8 = x4 * x6
    c9 = offset * crank
    c10 = crank / coupler**3
    x12 = cos2**2
    alpha3 = c10 * (c9 * x12 + sin2 * (-c7 * lowered - c8 * raised)) / cos3**3
    slider_velocity = -crank * x11 * sin23
    del lowered, raised, x11
    x13 = omega3**2
    slider_acceleration = -coupler * alpha3 * sin3 - crank * cos2 - coupler * x13 * cos3
    square = speed**2
    x14 = acceleration * omega3
    turn_th3 = square * alpha3 + x14
    del cos3, sin3, alpha3
    turn_place = acceleration * slider_velocity + square * slider_acceleration
    push2_moment = acceleration * inertia2
    c11 = x10 * square
    c12 = x10 * acceleration
    c13 = across3 * crank
    c14 = along3 * crank
    c15 = acceleration * mass3 * crank**2
    x15 = sin2**2
    x16 = cos2 * sin2
    del slider_acceleration, cos2, sin2
    x17 = square * sin23
    x18 = square * x13
    x19 = square * cos23
    return (
        c13 * (c11 * x15 - c12 * x16 + x19 * omega3 + x14 * sin23 - x8 * turn_th3 - x13 * x19 + x18
        * x9) + c14 * (c11 * x16 - c12 * x12 + x14 * cos23 - x17 * omega3 + x9 * turn_th3 + x13 *
        x17 + x18 * x8) + c15 * (x12 + x15) + inertia3 * omega3 * turn_th3 + mass4 *
        slider_velocity * turn_place + push2_moment
    )


def shaking_force(
    theta2, speed, acceleration, crank, coupler, offset, assembly, mass2, along2, across2,
    inertia2, mass3, along3, across3, inertia3, mass4, along4, across4, inertia4,
):
    """Return the force on the frame, the change of momentum.

    theta2 : ndarray or float, shape (...)
    speed, acceleration : float or ndarray, shape (...)
    crank, coupler, offset, assembly : float
    mass2 to inertia4 : float or ndarray
    Returns ndarray, shape (...) each.
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
    x8 = x7 * crank
    c6 = x8
    x9 = 1 / cos3
    omega3 = -c6 * x9 * cos2
    c7 = x3 * x5
    c8 = x4 * x6
    c9 = offset * crank
    c10 = crank / coupler**3
    alpha3 = c10 * (c9 * cos2**2 + sin2 * (-c7 * lowered - c8 * raised)) / cos3**3
    slider_velocity = -crank * x9 * sin23
    del lowered, raised, sin23, x9
    x10 = omega3**2
    slider_acceleration = -coupler * alpha3 * sin3 - crank * cos2 - coupler * x10 * cos3
    square = speed**2
    spin_th3 = square * x10
    turn_th3 = acceleration * omega3 + square * alpha3
    del x10, alpha3, omega3
    turn_place = acceleration * slider_velocity + square * slider_acceleration
    x11 = acceleration * cos2 - square * sin2
    x13 = acceleration * sin2 + square * cos2
    del slider_acceleration, slider_velocity, cos2, sin2
    push2_x = -across2 * x11 - along2 * x13
    push2_y = along2 * x11 - across2 * x13
    c11 = mass3 * crank
    c12 = x8 * across3
    x14 = cos3 * spin_th3 + sin3 * turn_th3
    del cos3, sin3, spin_th3, turn_th3
    push3_x = c12 * x11 - along3 * x14 - c11 * x13
    c13 = x8 * along3
    push3_y = c11 * x11 - across3 * x14 - c13 * x11
    del x13, x11, x14
    push4_x = mass4 * turn_place
    return -push2_x - push3_x - push4_x, -push2_y - push3_y


def shaking_moment(
    theta2, speed, acceleration, crank, coupler, offset, assembly, mass2, along2, across2,
    inertia2, mass3, along3, across3, inertia3, mass4, along4, across4, inertia4,
):
    """Return the moment on the frame about A, the change of moment of momentum.

    theta2 : ndarray or float, shape (...)
    speed, acceleration : float or ndarray, shape (...)
    crank, coupler, offset, assembly : float
    mass2 to inertia4 : float or ndarray
    Returns ndarray, shape (...).
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
    omega3 = -c6 * x11 * cos2
    c7 = x3 * x5
    c8 = x4 * x6
    c9 = offset * crank
    c10 = crank / coupler**3
    x12 = cos2**2
    alpha3 = c10 * (c9 * x12 + sin2 * (-c7 * lowered - c8 * raised)) / cos3**3
    slider_velocity = -crank * x11 * sin23
    del lowered, raised, x11
    x13 = omega3**2
    slider_acceleration = -coupler * alpha3 * sin3 - crank * cos2 - coupler * x13 * cos3
    square = speed**2
    turn_th3 = acceleration * omega3 + square * alpha3
    del cos3, alpha3, omega3
    turn_place = acceleration * slider_velocity + square * slider_acceleration
    push2_moment = acceleration * inertia2
    c11 = x10 * square
    c12 = x10 * acceleration
    c13 = across3 * crank
    c14 = along3 * crank
    c15 = mass4 * offset
    c16 = acceleration * mass3 * crank**2
    x14 = sin2**2
    x15 = square * x13
    return (
        across4 * turn_place + c13 * (c12 * cos2 * sin2 - acceleration * sin23 - c11 * x14 + cos2 *
        sin3 * turn_th3 + square * x13 * cos23 - square * cos23 - x15 * x9) + c14 * (c12 * x12 -
        acceleration * cos23 - c11 * cos2 * sin2 - square * x13 * sin23 + square * sin23 - x9 *
        turn_th3 - x15 * x8) + c15 * turn_place - c16 * (x12 + x14) - inertia3 * turn_th3 -
        push2_moment
    )


def load_forces(
    theta2, crank, coupler, offset, assembly, fx2, fy2, couple2, fx3, fy3, couple3, fx4, fy4,
    couple4,
):
    """Return what external loads alone call forth.

    theta2 : ndarray or float, shape (...)
    crank, coupler, offset, assembly : float
    fx2 to couple4 : float or ndarray
    Returns ndarray, shape (...) each.
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
        x12, y12, x23, y23, -fx4, y34, 0, normal41, couple4, torque, fx2 + x4, fy2 + fy3 + fy4,
        c8 * sin2 - c10 - c9 * cos2 + fy4 * position,
    )
