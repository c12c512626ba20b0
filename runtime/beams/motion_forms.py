"""The forms of a structure of beams along one of its motions, piece by piece."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..core.families import LinearPeriodic
from .assembly import Array
from .beam_motion import BeamMotion, chunks
from .element_forms import ElementForms
from .recovery_forms import LinearForm


class MotionValues:
    """Values of forms in a piece of a motion, accelerations by the equation of motion.

    Parameters
    ----------
    forms : ElementForms
        The structure at the angles of the piece.
    motion : BeamMotion
        The motion.
    chunk : slice
        Which of its angles.
    """

    def __init__(self, forms: ElementForms, motion: BeamMotion, chunk: slice) -> None:
        self.speed = motion.speed
        self.q, self.slope = motion.q[chunk], motion.slope[chunk]
        second = forms.acceleration.values(self.speed, self.q, self.slope)
        self.second = second / self.speed**2

    def __call__(self, form: LinearForm) -> Array:
        """Return the rows of a form ``(nt, rows)``."""
        return form.values(self.speed, self.q, self.slope, self.second)


def over_motion(
    system: LinearPeriodic,
    motion: BeamMotion,
    piece: Callable[[ElementForms, MotionValues], dict[str, Array]],
) -> dict[str, Array]:
    """Return arrays over the angles of a motion by name, joined from its pieces.

    Parameters
    ----------
    system : LinearPeriodic
        Of a structure of beams.
    motion : BeamMotion
        The motion.
    piece : callable
        Returns the arrays of one piece from the structure at its angles, and values in it.
    """
    pieces = []
    for chunk in chunks(motion):
        forms = ElementForms(system, motion.theta[chunk])
        forms.require_same()
        pieces.append(piece(forms, MotionValues(forms, motion, chunk)))
    return {name: np.concatenate([found[name] for found in pieces]) for name in pieces[0]}
