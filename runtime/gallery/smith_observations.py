"""Crank speeds that chapter 9 of Smith quotes, as data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .smith_linkages import LBF_IN_S2, RIG, Rig

Kind = Literal["resonance", "onset", "end", "range", "stable"]


@dataclass(frozen=True)
class Observation:
    """One crank speed quoted in the text.

    Attributes
    ----------
    chart : str
        Number of the rig's stability chart.
    inertia : float
        Follower inertia [lbf in s^2].
    region : int
        Number n of the unstable region 2 Omega/n that it belongs to; 0 where it belongs to none.
    speed : float
        As quoted [rpm]; the middle of a range.
    kind : str
        ``resonance`` (or a rise of amplitude): set against the middle of the region; ``onset``:
        unstable above it, against the lower end; ``end``: stable again above it, against the
        upper end; ``range``: unstable between two speeds, against the middle; ``stable``.
    figure : str
        The response that it is read from.
    meaning : str
        What the text says of it.
    half_width : float
        Half of a range [rpm].
    inertia_note : str
        How the inertia was found, where the text leaves it open.
    """

    chart: str
    inertia: float
    region: int
    speed: float
    kind: Kind
    figure: str
    meaning: str
    half_width: float = 0.0
    inertia_note: str = ""

    @property
    def rig(self) -> Rig:
        """The linkage and coupler."""
        return RIG[self.chart]

    @property
    def si_inertia(self) -> float:
        """Follower inertia [kg m^2]."""
        return self.inertia * LBF_IN_S2


_LEAST, _GREATEST = 0.0058, 0.0190
# The list of figures gives 0.0069 for Fig. 56, the text the least inertia.
_TEXT_READING = "section 9.5.3 says the least, the list of figures 0.0069"

OBSERVATIONS = (
    Observation(
        "82",
        _LEAST,
        6,
        250.0,
        "resonance",
        "56",
        "third subharmonic, low inertia",
        inertia_note=_TEXT_READING,
    ),
    Observation(
        "82", _GREATEST, 6, 220.0, "resonance", "61", "third subharmonic, greatest inertia"
    ),
    Observation(
        "82",
        _LEAST,
        5,
        300.0,
        "resonance",
        "56",
        "small rise in amplitude",
        inertia_note=_TEXT_READING,
    ),
    Observation(
        "82",
        0.0149,
        5,
        270.0,
        "range",
        "58-61",
        "no period, from 260 to 280 rpm",
        10.0,
        "'higher values': 0.0109 to 0.0190; 0.0149 taken",
    ),
    Observation("82", _GREATEST, 0, 230.0, "stable", "55", "stable at every inertia shown"),
    Observation("83", _LEAST, 8, 300.0, "resonance", "75", "resonance"),
    Observation("83", _LEAST, 6, 400.0, "resonance", "75", "resonance"),
    Observation("83", _LEAST, 5, 500.0, "resonance", "75", "apparent resonance, softening"),
    Observation("83", _LEAST, 4, 600.0, "resonance", "74", "unsymmetric resonance"),
    Observation("84", _LEAST, 3, 900.0, "onset", "80", "unstable above"),
    Observation("85", 0.0079, 4, 350.0, "resonance", "53", "resonance, printed inertia 0.00783"),
    Observation("85", _LEAST, 4, 360.0, "resonance", "62", "resonance"),
    Observation("85", 0.0079, 4, 360.0, "resonance", "65", "resonance"),
    Observation("85", _LEAST, 3, 460.0, "resonance", "63", "vibration of period 4 pi"),
    Observation("85", _LEAST, 3, 480.0, "end", "63", "stable again from here"),
    Observation("85", 0.0079, 3, 450.0, "onset", "65", "unstable above"),
)
