"""Equations of motion of the rigid quick-return mechanism with a constraint for each joint.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism quick_return, formulation multibody.
Equations: Smith (4.4)-(4.6), by Lagrange's equations.

Multipliers xij, yij, couple are the force and couple of link i on link j; that of the drive is the
torque, as couple2 is.

Cost per evaluation:
    constraints: 27 operations
    dynamics: 92 operations
Content hash 844a5dac975a501f8ed75513416edef9; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = ["constraints", "dynamics"]
FAMILY = "constrained"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"multibody","mechanism":"quick_return","'
    'modes":null,"outputs":[]}'
)
CONTENT = "844a5dac975a501f8ed75513416edef9"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "frame": ("m", "Distance DA of the rod's pivot from the crank's"),
    "crank": ("m", "Length of the crank AB"),
    "mass2": ("kg", "Mass of link 2"),
    "along2": ("kg m", "First moment along link 2"),
    "across2": ("kg m", "First moment across link 2"),
    "inertia2": ("kg m^2", "Inertia, about its first joint, of link 2"),
    "fx2": ("N", "Force along x at the first joint of link 2"),
    "fy2": ("N", "Force along y at the first joint of link 2"),
    "couple2": ("N m", "Couple on link 2"),
    "mass3": ("kg", "Mass of link 3"),
    "along3": ("kg m", "First moment along link 3"),
    "across3": ("kg m", "First moment across link 3"),
    "inertia3": ("kg m^2", "Inertia, about its first joint, of link 3"),
    "fx3": ("N", "Force along x at the first joint of link 3"),
    "fy3": ("N", "Force along y at the first joint of link 3"),
    "couple3": ("N m", "Couple on link 3"),
    "mass4": ("kg", "Mass of link 4"),
    "along4": ("kg m", "First moment along link 4"),
    "across4": ("kg m", "First moment across link 4"),
    "inertia4": ("kg m^2", "Inertia, about its first joint, of link 4"),
    "fx4": ("N", "Force along x at the first joint of link 4"),
    "fy4": ("N", "Force along y at the first joint of link 4"),
    "couple4": ("N m", "Couple on link 4"),
    "x2": ("m", "Place of the first joint along x, of the crank"),
    "y2": ("m", "Place of the first joint along y, of the crank"),
    "angle2": ("rad", "Angle of the crank"),
    "x3": ("m", "Place of the first joint along x, of the block"),
    "y3": ("m", "Place of the first joint along y, of the block"),
    "angle3": ("rad", "Angle of the block"),
    "x4": ("m", "Place of the first joint along x, of the rod"),
    "y4": ("m", "Place of the first joint along y, of the rod"),
    "angle4": ("rad", "Angle of the rod"),
    "t": ("", "Time"),
    "drive": ("", "Passed in"),
    "drive_d1": ("", "Passed in"),
    "drive_d2": ("", "Passed in"),
}
PARAMETERS = (
    "frame", "crank", "mass2", "along2", "across2", "inertia2", "fx2", "fy2", "couple2", "mass3",
    "along3", "across3", "inertia3", "fx3", "fy3", "couple3", "mass4", "along4", "across4",
    "inertia4", "fx4", "fy4", "couple4",
)

# Names of what each function returns, in order.
RETURNS = {
    "constraints": (
        "constraints_1_1", "constraints_2_1", "constraints_3_1", "constraints_4_1",
        "constraints_5_1", "constraints_6_1", "constraints_7_1", "constraints_8_1",
        "constraints_9_1", "jacobian_1_1", "jacobian_3_1", "jacobian_3_3", "jacobian_4_3",
        "jacobian_5_4", "jacobian_5_5", "jacobian_5_7", "jacobian_5_8", "jacobian_5_9",
    ),
    "dynamics": (
        "mass_1_1", "mass_1_3", "mass_2_3", "mass_3_3", "mass_4_4", "mass_4_6", "mass_5_6",
        "mass_6_6", "mass_7_7", "mass_7_9", "mass_8_9", "mass_9_9", "rest_1_1", "rest_2_1",
        "rest_4_1", "rest_5_1", "rest_7_1", "rest_8_1", "forces_1_1", "forces_2_1", "forces_3_1",
        "forces_4_1", "forces_5_1", "forces_6_1", "forces_7_1", "forces_8_1", "forces_9_1",
        "jacobian_1_1", "jacobian_3_1", "jacobian_3_3", "jacobian_4_3", "jacobian_5_4",
        "jacobian_5_5", "jacobian_5_7", "jacobian_5_8", "jacobian_5_9", "velocity_rhs_9_1",
        "gamma_3_1", "gamma_4_1", "gamma_5_1", "gamma_9_1",
    ),
}
COORDINATES = ("x2", "y2", "angle2", "x3", "y3", "angle3", "x4", "y4", "angle4")
MULTIPLIERS = ("x12", "y12", "x23", "y23", "normal34", "couple34", "x41", "y41", "torque")
EXTERNAL = ("drive", "drive_d1", "drive_d2")

# Terms of the energies that may be left out, to the names of what then vanishes, or to the
# separated terms that go and those that come.
DROPS = {
    ("across",): ("across2", "across3", "across4"),
    ("drive",): ("torque",),
    ("across", "drive"): ("across2", "across3", "across4", "torque"),
}

# Of each function its arrays: shape, and row, column and place among what it returns.
ARRAYS = {
    "constraints": {
        "constraints": (
            (9, 1),
            (
                (0, 0, 0), (1, 0, 1), (2, 0, 2), (3, 0, 3), (4, 0, 4), (5, 0, 5), (6, 0, 6),
                (7, 0, 7), (8, 0, 8),
            ),
        ),
        "jacobian": (
            (9, 9),
            (
                (0, 0, 9), (1, 1, 9), (2, 0, 10), (2, 2, 11), (2, 3, 9), (3, 1, 10), (3, 2, 12),
                (3, 4, 9), (4, 3, 13), (4, 4, 14), (4, 6, 15), (4, 7, 16), (4, 8, 17), (5, 5, 10),
                (5, 8, 9), (6, 6, 10), (7, 7, 10), (8, 2, 9),
            ),
        ),
    },
    "dynamics": {
        "mass": (
            (9, 9),
            (
                (0, 0, 0), (0, 2, 1), (1, 1, 0), (1, 2, 2), (2, 0, 1), (2, 1, 2), (2, 2, 3),
                (3, 3, 4), (3, 5, 5), (4, 4, 4), (4, 5, 6), (5, 3, 5), (5, 4, 6), (5, 5, 7),
                (6, 6, 8), (6, 8, 9), (7, 7, 8), (7, 8, 10), (8, 6, 9), (8, 7, 10), (8, 8, 11),
            ),
        ),
        "rest": ((9, 1), ((0, 0, 12), (1, 0, 13), (3, 0, 14), (4, 0, 15), (6, 0, 16), (7, 0, 17))),
        "forces": (
            (9, 1),
            (
                (0, 0, 18), (1, 0, 19), (2, 0, 20), (3, 0, 21), (4, 0, 22), (5, 0, 23), (6, 0, 24),
                (7, 0, 25), (8, 0, 26),
            ),
        ),
        "jacobian": (
            (9, 9),
            (
                (0, 0, 27), (1, 1, 27), (2, 0, 28), (2, 2, 29), (2, 3, 27), (3, 1, 28), (3, 2, 30),
                (3, 4, 27), (4, 3, 31), (4, 4, 32), (4, 6, 33), (4, 7, 34), (4, 8, 35), (5, 5, 28),
                (5, 8, 27), (6, 6, 28), (7, 7, 28), (8, 2, 27),
            ),
        ),
        "velocity_rhs": ((9, 1), ((8, 0, 36),)),
        "gamma": ((9, 1), ((2, 0, 37), (3, 0, 38), (4, 0, 39), (8, 0, 40))),
    },
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def constraints(
    x2, y2, angle2, x3, y3, angle3, x4, y4, angle4, t, drive, drive_d1, drive_d2, frame, crank,
    mass2, along2, across2, inertia2, fx2, fy2, couple2, mass3, along3, across3, inertia3, fx3,
    fy3, couple3, mass4, along4, across4, inertia4, fx4, fy4, couple4,
):
    """Return the constraints and their Jacobian.

    x2 to drive_d2 : float or ndarray, shape (...)
    frame, crank : float
    mass2 to couple4 : float or ndarray
    Returns float or ndarray each.
    """
    xp = _namespace(x2)
    x0 = crank * xp.cos(angle2)
    x1 = crank * xp.sin(angle2)
    x5 = xp.sin(angle4)
    x6 = x3 - x4
    x7 = xp.cos(angle4)
    x9 = y3 - y4
    return (
        x2, y2, x3 - x0 - x2, y3 - x1 - y2, x5 * x6 - x7 * x9, angle4 - angle3, -x4 - frame, -y4,
        angle2 - drive, 1, -1, x1, -x0, x5, -x7, -x5, x7, x5 * x9 + x6 * x7,
    )


def dynamics(
    x2, y2, angle2, x3, y3, angle3, x4, y4, angle4, x2_dot, y2_dot, angle2_dot, x3_dot, y3_dot,
    angle3_dot, x4_dot, y4_dot, angle4_dot, t, drive, drive_d1, drive_d2, frame, crank, mass2,
    along2, across2, inertia2, fx2, fy2, couple2, mass3, along3, across3, inertia3, fx3, fy3,
    couple3, mass4, along4, across4, inertia4, fx4, fy4, couple4,
):
    """Return everything in the equations of motion at acceleration level.

    x2 to drive_d2 : float or ndarray, shape (...)
    frame, crank : float
    mass2 to couple4 : float or ndarray
    Returns float or ndarray each.
    """
    xp = _namespace(x2)
    x0 = xp.cos(angle2)
    x1 = x0 * across2
    x2 = xp.sin(angle2)
    x5 = x2 * along2
    x6 = x2 * across2
    x7 = xp.cos(angle3)
    x8 = x7 * across3
    x9 = xp.sin(angle3)
    x10 = x9 * along3
    x11 = x9 * across3
    x12 = xp.cos(angle4)
    x13 = x12 * across4
    x14 = xp.sin(angle4)
    x15 = x14 * along4
    x16 = x14 * across4
    x17 = angle2_dot**2
    x18 = angle3_dot**2
    x19 = angle4_dot**2
    x20 = x2 * crank
    x21 = x0 * crank
    x22 = x3 - x4
    x23 = y3 - y4
    x24 = x12 * x3_dot
    x25 = x14 * y3_dot
    return (
        mass2, -x1 - x5, x0 * along2 - x6, inertia2, mass3, -x10 - x8, x7 * along3 - x11, inertia3,
        mass4, -x13 - x15, x12 * along4 - x16, inertia4, x17 * x6 - x0 * x17 * along2,
        -x1 * x17 - x17 * x5, x11 * x18 - x18 * x7 * along3, -x10 * x18 - x18 * x8,
        x16 * x19 - x12 * x19 * along4, -x13 * x19 - x15 * x19, fx2, fy2, couple2, fx3, fy3,
        couple3, fx4, fy4, couple4, 1, -1, x20, -x21, x14, -x12, -x14, x12, x12 * x22 + x14 * x23,
        drive_d1, -x17 * x21, -x17 * x20,
        (
            angle4_dot * x12 * x4_dot + angle4_dot * x14 * y4_dot - angle4_dot * x24 - angle4_dot *
            x25 - angle4_dot * (angle4_dot * (x12 * x23 - x14 * x22) - x12 * x4_dot - x14 * y4_dot
            + x24 + x25)
        ),
        drive_d2,
    )
