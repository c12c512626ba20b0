"""Random lengths: classified or refused, never a wrong class, never NaN."""

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages.classification import LINKS, SYMBOLS, classify
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from random_linkages import grashof_symbol

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


@settings(
    max_examples=300, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow]
)
@given(four_lengths())
def test_classified_as_in_fractions_or_refused(lengths):
    exact = [Fraction(value) for value in lengths]
    many = SYMBOLS[classify(np.array([lengths]))[0]]
    assert many == grashof_symbol(exact)
    if not many:
        with pytest.raises(BadInput, match="cannot"):
            classify(lengths)
        return
    turns = {(i, j): turns_fully(exact, i, j) for i, j in itertools.combinations(range(4), 2)}
    found = classify(lengths)
    assert found.symbol == many
    assert found.relative_turns == {
        f"{LINKS[i]}-{LINKS[j]}": full for (i, j), full in turns.items()
    }
    numbers = [found.distance, *found.change_distances.values(), *found.closing_distances.values()]
    assert all(math.isfinite(number) for number in numbers)
    assert max(found.closing_distances.values()) <= 0.0
