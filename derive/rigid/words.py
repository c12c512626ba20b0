"""The words of the modules of forces: arguments, returned quantities, notes."""

from __future__ import annotations

from collections.abc import Sequence

from ..describe import Description, array_results
from ..ir import Argument, Result
from ..spec import ModelSpec

_DRIVE = (
    Argument("speed", "float or ndarray, shape (...)", "rad/s", "Crank speed"),
    Argument("acceleration", "float or ndarray, shape (...)", "rad/s^2", "Crank acceleration"),
)
MOMENT_WORDS = (
    ("mass", "kg", "Mass of link"),
    ("along", "kg m", "First moment along link"),
    ("across", "kg m", "First moment across link"),
    ("inertia", "kg m^2", "Inertia, about its first joint, of link"),
)
LOAD_WORDS = (
    ("fx", "N", "Force along x at the first joint of link"),
    ("fy", "N", "Force along y at the first joint of link"),
    ("couple", "N m", "Couple on link"),
)


def description(
    spec: ModelSpec,
    mechanism: str,
    theta2: Argument,
    geometry: Sequence[Argument],
    references: tuple[str, ...],
    sliding: str = "",
) -> Description:
    """Return the words of a module of forces.

    Parameters
    ----------
    spec : ModelSpec
        What the module is.
    mechanism : str
        Its linkage, in words.
    theta2 : Argument
        Crank angle.
    geometry : sequence of Argument
        Lengths and assembly.
    references : tuple of str
        Equations of the documents.
    sliding : str
        The pair of links of a sliding joint, if there is one.
    """
    arguments = [theta2, *_DRIVE, *geometry]
    for words in (MOMENT_WORDS, LOAD_WORDS):
        arguments += [
            Argument(f"{name}{n}", "float or ndarray", unit, f"{meaning} {n}")
            for n in (2, 3, 4)
            for name, unit, meaning in words
        ]
    restrictions = [words for key, words in _RESTRICTIONS if key in spec.drop]
    return Description(
        title=f"Forces of {mechanism} in closed form",
        references=references,
        arguments=tuple(arguments),
        results=_results(sliding),
        notes=(
            "Link 1 is the frame, 2 the crank; each moving link has axes of its own from its first "
            "joint along the link.  The forces are linear in masses, moments and inertias: at unit "
            "values of one of these they are the derivatives by it.",
            *restrictions,
        ),
    )


def _results(sliding: str) -> dict[str, Result]:
    """Return the words of everything that the functions return."""
    found: dict[str, tuple[str, str]] = {}
    for pair in ("12", "23", "34", "41"):
        for axis in ("x", "y"):
            found[axis + pair] = "N", f"Force of link {pair[0]} on link {pair[1]} along {axis}"
    if sliding:
        found[f"couple{sliding}"] = "N m", f"Couple of link {sliding[0]} on link {sliding[1]}"
    found |= {
        "torque": ("N m", "Torque of the drive on the crank, anticlockwise"),
        "shaking_x": ("N", "Force on the frame along x"),
        "shaking_y": ("N", "Force on the frame along y"),
        "shaking_moment": ("N m", "Moment on the frame about A, the drive's reaction in it"),
    }
    return array_results(found)


_RESTRICTIONS = (
    ("crank_acceleration", "For a crank of constant speed."),
    ("across", "For links whose masses lie along their lines."),
)
