"""Random lengths: classified or refused, never a wrong class, never NaN."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction

import numpy as np
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages.classification import LINKS, SYMBOLS, classify
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

LENGTHS = st.one_of(
    st.integers(1, 6).map(float),
    st.floats(0.01, 100.0),
    st.floats(min_value=5e-324, max_value=1.7e308),
    st.sampled_from([0.1, 0.2, 0.3, 0.1 + 0.2, 1.0, 1.0 + 2.0**-52, 1.0 - 2.0**-53]),
)


@st.composite
def four_lengths(draw):
    """Draw any four; often the last closes a change condition but for a few last places."""
    lengths = [draw(LENGTHS) for _ in range(4)]
    if draw(st.booleans()):
        near = lengths[0] + lengths[1] - lengths[2]
        for _ in range(draw(st.integers(0, 3))):
            near = math.nextafter(near, math.inf)
        if 0 < near < math.inf:
            lengths[3] = near
    return draw(st.permutations(lengths))


def turns_fully(exact, i, j):
    """The squared diagonal of links i and j, from end to end, within that of the other two."""
    k, m = (x for x in range(4) if x not in (i, j))
    one, two, three, four = (exact[x] for x in (i, j, k, m))
    least, most = (three - four) ** 2, (three + four) ** 2
    return least <= (one - two) ** 2 and (one + two) ** 2 <= most


def symbol_of(turns, exact):
    """Return the class from which links turn against which, and how many change conditions hold."""
    flat = sum(
        exact[0] + exact[i] == sum(exact[j] for j in range(1, 4) if j != i) for i in range(1, 4)
    )
    if flat >= 2:
        return f"CP{flat}X"
    # The link that turns against all three others is the shortest of a Grashof linkage.
    for i, letters in enumerate(("CCC", "CRR", "RCR", "RRC")):
        if all(turns[tuple(sorted((i, j)))] for j in range(4) if j != i):
            return ("CP" if flat else "G") + letters
    return f"RRR{exact.index(max(exact)) + 1}"


def judge(lengths):
    """Compare the class with brute force in fractions."""
    exact = [Fraction(value) for value in lengths]
    many = SYMBOLS[classify(np.array([lengths]))[0]]
    if 2 * max(exact) >= sum(exact):
        assert many == ""
        try:
            classify(lengths)
        except BadInput as refusal:
            assert "cannot" in str(refusal)
            return
        raise AssertionError("an impossible linkage was classified")
    turns = {(i, j): turns_fully(exact, i, j) for i, j in itertools.combinations(range(4), 2)}
    found = classify(lengths)
    assert found.symbol == many == symbol_of(turns, exact)
    assert found.relative_turns == {
        f"{LINKS[i]}-{LINKS[j]}": full for (i, j), full in turns.items()
    }
    numbers = [found.distance, *found.change_distances.values(), *found.closing_distances.values()]
    assert all(math.isfinite(number) for number in numbers)
    assert max(found.closing_distances.values()) <= 0.0


QUIET = {"deadline": None, "derandomize": True, "suppress_health_check": [HealthCheck.too_slow]}


@settings(max_examples=300, **QUIET)
@given(four_lengths())
def test_classified_or_refused(lengths):
    judge(lengths)
