"""Forces of the rigid quick-return mechanism in closed form.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism quick_return, formulation forces.
Equations: Newton and Euler's, as Smith (4.4)-(4.6).

Link 1 is the frame, 2 the crank; each moving link has axes of its own from its first joint along
the link.  The forces are linear in masses, moments and inertias: at unit values of one of these
they are the derivatives by it.

Cost per evaluation:
    forces: 161 operations
    pin_forces: 109 operations
    driving_torque: 72 operations
    shaking_force: 86 operations
    shaking_moment: 88 operations
    load_forces: 59 operations
Content hash f2a58a0ca92bfe2a2cafcf7a8860c326; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = [
    "forces", "pin_forces", "driving_torque", "shaking_force", "shaking_moment", "load_forces",
]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"forces","mechanism":"quick_return","mod'
    'es":null,"outputs":[]}'
)
CONTENT = "f2a58a0ca92bfe2a2cafcf7a8860c326"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "theta2": ("rad", "Crank angle from the line DA"),
    "speed": ("rad/s", "Crank speed"),
    "acceleration": ("rad/s^2", "Crank acceleration"),
    "frame": ("m", "Distance DA of the rod's pivot from the crank's"),
    "crank": ("m", "Length of the crank AB"),
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
    "couple34": ("N m", "Couple of link 3 on link 4"),
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
        "x12", "y12", "x23", "y23", "x34", "y34", "x41", "y41", "couple34", "torque", "shaking_x",
        "shaking_y", "shaking_moment",
    ),
    "pin_forces": ("x12", "y12", "x23", "y23", "x34", "y34", "x41", "y41", "couple34"),
    "driving_torque": ("torque",),
    "shaking_force": ("shaking_x", "shaking_y"),
    "shaking_moment": ("shaking_moment",),
    "load_forces": (
        "x12", "y12", "x23", "y23", "x34", "y34", "x41", "y41", "couple34", "torque", "shaking_x",
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
    theta2, speed, acceleration, frame, crank, mass2, along2, across2, inertia2, mass3, along3,
    across3, inertia3, mass4, along4, across4, inertia4,
):
    """Return every joint force, the torque, and the force and moment on the frame.

    theta2 : ndarray or float, shape (...)
    speed, acceleration : float or ndarray, shape (...)
    frame, crank : float
    mass2 to inertia4 : float or ndarray
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    cos2 = (half_cosine + half_sine) * (half_cosine - half_sine)
    c0 = far**2
    c1 = near**2
    x1 = half_cosine**2
    x2 = half_sine**2
    del x0, half_cosine, half_sine
    slide2 = c0 * x1 + c1 * x2
    slide = xp.sqrt(slide2)
    x3 = 1 / slide
    x4 = far * x1
    x5 = near * x2
    del slide, x1, x2
    cos4 = x3 * (x4 + x5)
    x6 = x3 * sin2
    sin4 = crank * x6
    sin24 = frame * x6
    x7 = x4 - x5
    del x6, x4, x5
    cos24 = x3 * x7
    omega4 = crank * x7 / slide2
    c2 = far * near * crank * frame
    alpha4 = -c2 * sin2 / slide2**2
    slip4 = frame * x3 * cos4
    square = speed**2
    spin_th4 = square * omega4**2
    x8 = acceleration * omega4
    turn_th4 = square * alpha4 + x8
    del x7, slide2, alpha4
    x9 = acceleration * cos2 - square * sin2
    x10 = acceleration * sin2 + square * cos2
    push2_x = -across2 * x9 - along2 * x10
    push2_y = along2 * x9 - across2 * x10
    push2_moment = acceleration * inertia2
    c3 = mass3 * crank
    x11 = cos4 * spin_th4 + sin4 * turn_th4
    x13 = cos4 * turn_th4 - sin4 * spin_th4
    push3_x = -across3 * x13 - along3 * x11 - c3 * x10
    push3_y = along3 * x13 - across3 * x11 + c3 * x9
    del spin_th4, x10, x9
    c4 = across3 * crank
    c5 = along3 * crank
    x15 = inertia3 * turn_th4
    x16 = square * cos24
    x17 = square * sin24
    push3_moment = c4 * (acceleration * sin24 + x16) + c5 * (acceleration * cos24 - x17) + x15
    push4_x = -across4 * x13 - along4 * x11
    push4_y = along4 * x13 - across4 * x11
    push4_moment = inertia4 * turn_th4
    normal34 = x3 * (push3_moment + push4_moment)
    del x11, x13, x3
    x18 = normal34 * sin4
    x23 = push3_x - x18
    x12 = push2_x + x23
    x19 = cos4 * normal34
    del sin4, cos4, normal34
    y23 = push3_y + x19
    y12 = push2_y + y23
    x41 = -push4_x - x18
    y41 = x19 - push4_y
    c6 = acceleration * mass3 * crank**2
    x20 = omega4 * slip4
    x21 = turn_th4 + x8
    x22 = c6 * (cos2**2 + sin2**2) + push2_moment
    del x8, cos2, sin2
    x24 = acceleration + turn_th4
    x25 = 2 - slip4
    return (
        x12, y12, x23, y23, -x18, x19, x41, y41, -push3_moment,
        (
            c4 * (x21 * sin24 + x16 * x20) + c5 * (x21 * cos24 - x17 * x20) + omega4 * push4_moment
            + x15 * omega4 + x22
        ),
        -push2_x - push3_x - push4_x, -push2_y - push3_y - push4_y,
        (
            -c4 * (x24 * sin24 + x16 * x25 * slip4) + c5 * (square * x25 * sin24 * slip4 - x24 *
            cos24) + frame * push4_y - push4_moment - x15 - x22
        ),
    )


def pin_forces(
    theta2, speed, acceleration, frame, crank, mass2, along2, across2, inertia2, mass3, along3,
    across3, inertia3, mass4, along4, across4, inertia4,
):
    """Return every joint force.

    theta2 : ndarray or float, shape (...)
    speed, acceleration : float or ndarray, shape (...)
    frame, crank : float
    mass2 to inertia4 : float or ndarray
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    cos2 = (half_cosine + half_sine) * (half_cosine - half_sine)
    c0 = far**2
    c1 = near**2
    x1 = half_cosine**2
    x2 = half_sine**2
    del x0, half_cosine, half_sine
    slide2 = c0 * x1 + c1 * x2
    slide = xp.sqrt(slide2)
    x3 = 1 / slide
    x4 = far * x1
    x5 = near * x2
    del slide, x1, x2
    cos4 = x3 * (x4 + x5)
    x6 = x3 * sin2
    sin4 = crank * x6
    sin24 = frame * x6
    x7 = x4 - x5
    del x6, x4, x5
    cos24 = x3 * x7
    omega4 = crank * x7 / slide2
    c2 = far * near * crank * frame
    alpha4 = -c2 * sin2 / slide2**2
    square = speed**2
    spin_th4 = square * omega4**2
    turn_th4 = acceleration * omega4 + square * alpha4
    del x7, slide2, alpha4, omega4
    x8 = acceleration * cos2 - square * sin2
    x9 = acceleration * sin2 + square * cos2
    push2_x = -across2 * x8 - along2 * x9
    push2_y = along2 * x8 - across2 * x9
    c3 = mass3 * crank
    x10 = cos4 * spin_th4 + sin4 * turn_th4
    x11 = cos4 * turn_th4 - sin4 * spin_th4
    del cos2, sin2, spin_th4
    push3_x = -across3 * x11 - along3 * x10 - c3 * x9
    push3_y = along3 * x11 - across3 * x10 + c3 * x8
    c4 = across3 * crank
    c5 = along3 * crank
    push3_moment = (
        c4 * (acceleration * sin24 + square * cos24) + c5 * (acceleration * cos24 - square * sin24)
        + inertia3 * turn_th4
    )
    del x9, x8, cos24, sin24
    push4_x = -across4 * x11 - along4 * x10
    push4_y = along4 * x11 - across4 * x10
    push4_moment = inertia4 * turn_th4
    del x10, x11, turn_th4
    normal34 = x3 * (push3_moment + push4_moment)
    x14 = normal34 * sin4
    del push4_moment, x3, sin4
    x23 = push3_x - x14
    x12 = push2_x + x23
    x15 = cos4 * normal34
    del push3_x, push2_x, cos4, normal34
    y23 = push3_y + x15
    y12 = push2_y + y23
    x41 = -push4_x - x14
    del push3_y, push2_y, push4_x
    y41 = x15 - push4_y
    return x12, y12, x23, y23, -x14, x15, x41, y41, -push3_moment


def driving_torque(
    theta2, speed, acceleration, frame, crank, mass2, along2, across2, inertia2, mass3, along3,
    across3, inertia3, mass4, along4, across4, inertia4,
):
    """Return the torque on the crank, by virtual power.

    theta2 : ndarray or float, shape (...)
    speed, acceleration : float or ndarray, shape (...)
    frame, crank : float
    mass2 to inertia4 : float or ndarray
    Returns ndarray, shape (...).
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    cos2 = (half_cosine + half_sine) * (half_cosine - half_sine)
    c0 = far**2
    c1 = near**2
    x1 = half_cosine**2
    x2 = half_sine**2
    del x0, half_cosine, half_sine
    slide2 = c0 * x1 + c1 * x2
    slide = xp.sqrt(slide2)
    x3 = 1 / slide
    x4 = far * x1
    x5 = near * x2
    del slide, x1, x2
    cos4 = x3 * (x4 + x5)
    x6 = frame * x3
    sin24 = x6 * sin2
    x7 = x4 - x5
    cos24 = x3 * x7
    del x4, x5, x3
    omega4 = crank * x7 / slide2
    c2 = far * near * crank * frame
    alpha4 = -c2 * sin2 / slide2**2
    slip4 = x6 * cos4
    del x7, slide2, cos4, x6
    square = speed**2
    x8 = acceleration * omega4
    turn_th4 = square * alpha4 + x8
    push2_moment = acceleration * inertia2
    push4_moment = inertia4 * turn_th4
    c3 = across3 * crank
    c4 = along3 * crank
    c5 = acceleration * mass3 * crank**2
    x9 = square * omega4 * slip4
    x10 = turn_th4 + x8
    del alpha4, slip4, x8
    return (
        c3 * (x9 * cos24 + x10 * sin24) + c4 * (x10 * cos24 - x9 * sin24) + c5 * (cos2**2 +
        sin2**2) + inertia3 * omega4 * turn_th4 + omega4 * push4_moment + push2_moment
    )


def shaking_force(
    theta2, speed, acceleration, frame, crank, mass2, along2, across2, inertia2, mass3, along3,
    across3, inertia3, mass4, along4, across4, inertia4,
):
    """Return the force on the frame, the change of momentum.

    theta2 : ndarray or float, shape (...)
    speed, acceleration : float or ndarray, shape (...)
    frame, crank : float
    mass2 to inertia4 : float or ndarray
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    cos2 = (half_cosine + half_sine) * (half_cosine - half_sine)
    c0 = far**2
    c1 = near**2
    x1 = half_cosine**2
    x2 = half_sine**2
    del x0, half_cosine, half_sine
    slide2 = c0 * x1 + c1 * x2
    slide = xp.sqrt(slide2)
    x3 = 1 / slide
    x4 = far * x1
    x5 = near * x2
    del slide, x1, x2
    cos4 = x3 * (x4 + x5)
    sin4 = crank * x3 * sin2
    omega4 = crank * (x4 - x5) / slide2
    del x3, x4, x5
    c2 = far * near * crank * frame
    alpha4 = -c2 * sin2 / slide2**2
    square = speed**2
    spin_th4 = square * omega4**2
    turn_th4 = acceleration * omega4 + square * alpha4
    del slide2, alpha4, omega4
    x6 = acceleration * cos2 - square * sin2
    x7 = acceleration * sin2 + square * cos2
    push2_x = -across2 * x6 - along2 * x7
    push2_y = along2 * x6 - across2 * x7
    c3 = mass3 * crank
    x8 = cos4 * spin_th4 + sin4 * turn_th4
    x9 = cos4 * turn_th4 - sin4 * spin_th4
    del cos2, sin2, cos4, sin4, spin_th4, turn_th4
    push3_x = -across3 * x9 - along3 * x8 - c3 * x7
    push3_y = along3 * x9 - across3 * x8 + c3 * x6
    push4_x = -across4 * x9 - along4 * x8
    push4_y = along4 * x9 - across4 * x8
    del x7, x6, x8, x9
    return -push2_x - push3_x - push4_x, -push2_y - push3_y - push4_y


def shaking_moment(
    theta2, speed, acceleration, frame, crank, mass2, along2, across2, inertia2, mass3, along3,
    across3, inertia3, mass4, along4, across4, inertia4,
):
    """Return the moment on the frame about A, the change of moment of momentum.

    theta2 : ndarray or float, shape (...)
    speed, acceleration : float or ndarray, shape (...)
    frame, crank : float
    mass2 to inertia4 : float or ndarray
    Returns ndarray, shape (...).
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    cos2 = (half_cosine + half_sine) * (half_cosine - half_sine)
    c0 = far**2
    c1 = near**2
    x1 = half_cosine**2
    x2 = half_sine**2
    del x0, half_cosine, half_sine
    slide2 = c0 * x1 + c1 * x2
    slide = xp.sqrt(slide2)
    x3 = 1 / slide
    x4 = far * x1
    x5 = near * x2
    del slide, x1, x2
    cos4 = x3 * (x4 + x5)
    x6 = x3 * sin2
    sin4 = crank * x6
    sin24 = frame * x6
    x7 = x4 - x5
    del x6, x4, x5
    cos24 = x3 * x7
    omega4 = crank * x7 / slide2
    c2 = far * near * crank * frame
    alpha4 = -c2 * sin2 / slide2**2
    slip4 = frame * x3 * cos4
    del x7, slide2, x3
    square = speed**2
    spin_th4 = square * omega4**2
    turn_th4 = acceleration * omega4 + square * alpha4
    push2_moment = acceleration * inertia2
    push4_y = (
        -across4 * (cos4 * spin_th4 + sin4 * turn_th4) + along4 * (cos4 * turn_th4 - sin4 *
        spin_th4)
    )
    del alpha4, omega4, cos4, sin4, spin_th4
    push4_moment = inertia4 * turn_th4
    c3 = along3 * crank
    c4 = across3 * crank
    c5 = acceleration * mass3 * crank**2
    x8 = acceleration + turn_th4
    x9 = 2 - slip4
    return (
        c3 * (square * x9 * sin24 * slip4 - x8 * cos24) - c4 * (square * x9 * cos24 * slip4 + x8 *
        sin24) - c5 * (cos2**2 + sin2**2) + frame * push4_y - inertia3 * turn_th4 - push2_moment -
        push4_moment
    )


def load_forces(theta2, frame, crank, fx2, fy2, couple2, fx3, fy3, couple3, fx4, fy4, couple4):
    """Return what external loads alone call forth.

    theta2 : ndarray or float, shape (...)
    frame, crank : float
    fx2 to couple4 : float or ndarray
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    cos2 = (half_cosine + half_sine) * (half_cosine - half_sine)
    c0 = far**2
    c1 = near**2
    x1 = half_cosine**2
    x2 = half_sine**2
    del x0, half_cosine, half_sine
    slide2 = c0 * x1 + c1 * x2
    slide = xp.sqrt(slide2)
    x3 = 1 / slide
    cos4 = x3 * (far * x1 + near * x2)
    del slide2, slide, x1, x2
    x4 = crank * sin2
    sin4 = x3 * x4
    x5 = couple3 + couple4
    c2 = x5
    normal34 = -c2 * x3
    x6 = normal34 * sin4
    x23 = -fx3 - x6
    x12 = x23 - fx2
    x7 = cos4 * normal34
    del x3, sin4, cos4, normal34
    y23 = x7 - fy3
    y12 = y23 - fy2
    torque = crank * cos2 * y23 - couple2 - x4 * x23
    x41 = fx4 - x6
    y41 = fy4 + x7
    c3 = -fx3 * crank
    c4 = -fy3 * crank
    c5 = fy4 * frame - couple2 - x5
    return (
        x12, y12, x23, y23, -x6, x7, x41, y41, couple3, torque, fx2 + fx3 + fx4, fy2 + fy3 + fy4,
        c3 * sin2 - c4 * cos2 - c5,
    )
