"""Elements whose length goes to zero beside ordinary ones: answered, or refused for what is so.

The stiffness of a beam goes with 1/h^3, so that adding a long one's to a short one's rounds it off:
by eps (L/h)^3 of itself, all of it from L/h = 1e5 on.  A structure that is held must not be called
loose for that.
"""

import numpy as np
import pytest
from elastolink.runtime.beams import Section, frame, linear_system, linkage_system
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.frequencies import natural_frequencies
from elastolink.runtime.linkages import FourBar

BAR = Section.rectangle(0.02, 0.005, modulus=2e11, density=7850.0, poisson=0.3)
CLAMPED, PINNED = ("x", "y", "rotation"), ("x", "y")
KINDS = ("cubic", "internal_node", "curvature", "timoshenko")
EXPONENTS = (1, 3, 5, 6, 8, 11)


def bar(exponent, kind="cubic", held=CLAMPED, slope=0.3):
    """Return a straight bar of three elements, the middle one short."""
    short = 10.0**-exponent
    c, s = np.cos(slope), np.sin(slope)
    along = {"A": 0.0, "B": 0.5, "C": 0.5 + short, "D": 1.0}
    places = {name: (x * c, x * s) for name, x in along.items()}
    members = {"one": ("A", "B"), "tiny": ("B", "C"), "two": ("C", "D")}
    return frame(places, members, BAR, supports={"A": held}, elements=1, kind=kind)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("exponent", EXPONENTS)
def test_a_held_bar_is_never_called_loose(kind, exponent):
    """Danger: eps (L/h)^3.  Estimate: that of the first frequency, or the refusal that says why."""
    try:
        found = natural_frequencies(linear_system(bar(exponent, kind)), 0.0, 1)
    except BadInput as refusal:
        text = str(refusal)
        assert exponent >= 4 and "\n" not in text
        assert text.startswith("beam tiny: found an element of ") and "nothing" not in text
        assert "rounding of their sum" in text
        return
    # The first mode of a clamped bar of 1 m; two cubics and a short one are above by 6e-4.
    own = 1.8751040687119611**2 * np.sqrt(BAR.bending_stiffness / BAR.mass_per_length)
    gap = abs(found.frequency[0, 0] - own)
    mesh = {"cubic": 6e-4, "timoshenko": 6e-4}.get(kind, 2e-5)
    assert gap <= found.error[0, 0] + mesh * own
    assert found.error[0, 0] < own


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_a_loose_bar_is_called_loose_whatever_its_elements(exponent):
    """Danger: round-off that resists.  Estimate: the motion that is named, a turn about the pin."""
    with pytest.raises(BadInput, match="that nothing resists") as refusal:
        linear_system(bar(exponent, held=PINNED))
    # Six names are told; the end that is held is not among them.
    named = set(str(refusal.value).replace(",", "").split())
    assert {"A.one", "B.x", "B.y"} <= named and not {"A.x", "A.y"} & named


@pytest.mark.parametrize("exponent", (2, 4, 5, 7))
def test_a_linkage_with_a_short_element(exponent):
    """Danger: a node next to a pin of an ordinary linkage.  Estimate: the refusal's own words."""
    short, long = 10.0**-exponent, 0.328
    sections = dict.fromkeys(("crank", "coupler", "follower"), BAR)
    linkage = FourBar(crank=0.17, coupler=long, follower=0.525, frame=0.547)
    division = {"crank": 1, "coupler": [short / long, 1.0 - short / long], "follower": 1}
    try:
        system = linkage_system(linkage, sections, elements=division)
        found = natural_frequencies(system, 0.7, 3)
    except BadInput as refusal:
        text = str(refusal)
        assert exponent >= 5 and "\n" not in text and text.startswith("beam coupler: found")
        return
    whole = natural_frequencies(linkage_system(linkage, sections, elements=1), 0.7, 3)
    gap = np.abs(found.frequency - whole.frequency)
    # One more node makes the mesh better, by its share of the coupler alone.
    assert np.all(gap <= found.error + whole.error + 10.0 * short * whole.frequency)
