"""Mobility: Kutzbach's count, Gruebler's condition, and the rank that decides."""

import pytest
from elastolink.runtime.linkages.degrees_of_freedom import mobility
from refusals import refused

FOUR_BAR = [
    *(("frame", "crank"), ("crank", "coupler")),
    *(("coupler", "follower"), ("frame", "follower")),
]


@pytest.mark.parametrize(
    ("pins", "higher_pairs", "expected"),
    [
        (("ab", "bc", "cd", "da"), 0, 1),
        (("ab", "bc", "cd", "de", "ea"), 0, 2),
        (("ab", "bc", "ca"), 0, 0),
        (("ab", "ac"), 1, 1),
        # Six-bar linkage: a triple pin at the end of a crank stands for two joints.
        (("fa", "abd", "bc", "fc", "de", "fe"), 0, 1),
    ],
)
def test_kutzbach(pins, higher_pairs, expected):
    result = mobility(pins, higher_pairs=higher_pairs)
    assert result.kutzbach == expected
    assert result.gruebler == (expected == 1)
    assert result.instantaneous is None


def test_a_flat_linkage_has_one_more_velocity():
    found = mobility(FOUR_BAR, coordinates=[(0, 0), (1, 0), (5, 0), (3, 0)])
    assert (found.kutzbach, found.instantaneous, found.redundant) == (1, 2, 1)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_four_bar_by_count_and_by_rank_in_any_unit_and_place(scale):
    at = [(scale * (x + 3), scale * (y - 7)) for x, y in [(0, 0), (1, 2), (5, 3), (4, 0)]]
    found = mobility(FOUR_BAR, coordinates=at)
    assert (found.kutzbach, found.instantaneous, found.redundant) == (1, 1, 0)
    assert found.gruebler and found.passed


SQUARE = [(0, 0), (1, 2), (5, 3), (4, 0)]
test_bad_chains_are_refused = refused(
    lambda pins, options: mobility(pins, **options),
    [
        ([], {}, "pins: found none"),
        ([("a",)], {}, "two or more different links"),
        ([("a", "a")], {}, "two or more different links"),
        (FOUR_BAR, {"frame": "nobody"}, "frame: found 'nobody'"),
        (FOUR_BAR, {"coordinates": [(0, 0)]}, "4 pairs"),
        (FOUR_BAR, {"coordinates": [*SQUARE[:3], (4, float("nan"))]}, "not finite"),
        (FOUR_BAR, {"higher_pairs": 1.5}, "higher_pairs: found 1.5"),
        (FOUR_BAR, {"higher_pairs": 1, "coordinates": SQUARE}, "pins alone"),
    ],
)
