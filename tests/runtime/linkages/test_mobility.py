"""Mobility: Kutzbach's count, Gruebler's condition, and the rank that decides."""

from __future__ import annotations

import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages.degrees_of_freedom import kutzbach, mobility

FOUR_BAR = [
    ("frame", "crank"),
    ("crank", "coupler"),
    ("coupler", "follower"),
    ("frame", "follower"),
]


@pytest.mark.parametrize(
    ("counts", "expected"), [((4, 4), 1), ((5, 5), 2), ((3, 3), 0), ((3, 2, 1), 1), ((6, 7), 1)]
)
def test_kutzbach(counts, expected):
    assert kutzbach(*counts) == expected


def test_four_bar_by_count_and_by_rank():
    found = mobility(FOUR_BAR, coordinates=[(0, 0), (1, 2), (5, 3), (4, 0)])
    assert (found.kutzbach, found.instantaneous, found.redundant) == (1, 1, 0)
    assert found.gruebler and found.passed


def test_a_pin_that_joins_three_links_counts_two():
    # Six-bar linkage: a triple pin at the end of a crank stands for two joints.
    pins = [("f", "a"), ("a", "b", "d"), ("b", "c"), ("f", "c"), ("d", "e"), ("f", "e")]
    found = mobility(pins)
    assert (found.links, found.lower_pairs, found.kutzbach) == (6, 7, 1)
    assert found.instantaneous is None


def test_parallelogram_with_a_third_crank_moves_though_the_count_says_it_does_not():
    pins = [*FOUR_BAR, ("frame", "third"), ("third", "coupler")]
    square = [(0, 0), (1, 2), (5, 2), (4, 0)]
    moving = mobility(pins, coordinates=[*square, (2, 0), (3, 2)])
    assert (moving.kutzbach, moving.instantaneous, moving.redundant) == (0, 1, 1)
    # The third crank in another direction locks it.
    locked = mobility(pins, coordinates=[*square, (2, 0), (3.5, 2)])
    assert (locked.instantaneous, locked.redundant) == (0, 0)


def test_a_flat_linkage_has_one_more_velocity():
    assert mobility(FOUR_BAR, coordinates=[(0, 0), (1, 0), (5, 0), (3, 0)]).instantaneous == 2


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_units_and_place_change_nothing(scale):
    at = [(scale * (x + 3), scale * (y - 7)) for x, y in [(0, 0), (1, 2), (5, 3), (4, 0)]]
    assert mobility(FOUR_BAR, coordinates=at).instantaneous == 1


@pytest.mark.parametrize(
    "call",
    [
        lambda: mobility([]),
        lambda: mobility([("a",)]),
        lambda: mobility([("a", "a")]),
        lambda: mobility(FOUR_BAR, frame="nobody"),
        lambda: mobility(FOUR_BAR, coordinates=[(0, 0)]),
        lambda: mobility(FOUR_BAR, coordinates=[(0, 0), (1, 2), (5, 3), (4, float("nan"))]),
        lambda: kutzbach(0, 1),
        lambda: kutzbach(4, 1.5),
    ],
)
def test_bad_chains_are_refused(call):
    with pytest.raises(BadInput):
        call()
