"""Grashof's and Barker's classes, and the base planes of Barker's solution space."""

import itertools

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import QuickReturn, SliderCrank
from elastolink.runtime.linkages.classification import CLASSES, SYMBOLS, classify
from random_linkages import grashof_symbol
from refusals import refused

GRID = [*itertools.product(range(1, 7), repeat=4)]


@pytest.mark.smoke
def test_all_small_integers_have_the_class_of_the_table():
    expected = [grashof_symbol(lengths) for lengths in GRID]
    assert set(expected) == set(SYMBOLS)
    assert [SYMBOLS[number] for number in classify(np.array(GRID))] == expected
    for lengths, symbol in zip(GRID, expected, strict=True):
        if symbol:
            assert classify(lengths).symbol == symbol
        else:
            with pytest.raises(BadInput, match="cannot"):
                classify(lengths)


def test_inversions_are_the_classes_of_the_lengths_taken_in_turn():
    for lengths in GRID[::14]:
        if not grashof_symbol(lengths):
            continue
        found = classify(lengths)
        turned = [lengths[i:] + lengths[:i] for i in range(4)]
        assert [*found.inversions.values()] == [grashof_symbol(each) for each in turned]
        mirrored = (lengths[0], *lengths[:0:-1])
        assert classify(lengths, input="follower").symbol == grashof_symbol(mirrored)


def test_names_follow_the_symbols():
    """Where Table 3.1 prints crank-rocker-crank for GCRR: letters and words agree here."""
    for row in CLASSES[:4] + CLASSES[8:12]:
        letters = "".join(word[0].upper() for word in row.name.split()[-1].split("-"))
        assert row.symbol.endswith(letters)
    assert CLASSES[1].name == "Grashof crank-rocker-rocker"
    assert [row.number for row in CLASSES] == list(range(1, 15))


def test_a_class_is_described_once():
    assert classify((5.0, 1.0, 5.0, 2.0)).described == (
        "crank rocker, in Barker's table Grashof crank-rocker-rocker (GCRR)"
    )
    slider = classify(SliderCrank(crank=1.0, coupler=3.0))
    assert slider.described == "in-line slider-crank, crank turning (Grashof)"


def test_distance_is_the_tolerance_that_just_reaches_the_change_point():
    lengths = (5.0, 1.0, 5.0, 2.0)
    found = classify(lengths)
    assert found.distance == -1.0 / 13.0
    assert classify(lengths, tolerance=1.0 / 13.0 * (1 - 1e-12)).symbol == "GCRR"
    assert classify(lengths, tolerance=1.0 / 13.0 * (1 + 1e-12)).symbol == "CPCRR"


def test_a_tolerance_finds_pairs_and_equal_links():
    assert classify((1.0, 2.0, 1.0 + 1e-9, 2.0), tolerance=1e-8).symbol == "CP2X"
    assert classify((1.0, 2.0, 1.0 + 1e-9, 2.0)).symbol != "CP2X"
    assert classify((1.0, 1.0, 1.0 + 1e-9, 1.0), tolerance=1e-8).symbol == "CP3X"
    assert classify((2.0, 1.0, 2.0, 1.0)).also == "parallelogram linkage"
    assert classify((2.0, 1.0, 1.0, 2.0)).also == "kite linkage"
    assert classify((1.0, 1.0, 3.0, 3.1), tolerance=0.015).symbol == "CPCCC"


test_what_is_no_linkage_is_refused_with_the_reason = refused(
    lambda lengths, options: classify(lengths, **options),
    [
        ((10, 1, 2, 3), {}, "cannot close"),
        ((6, 1, 2, 3), {}, "cannot move"),
        ((1, 2, 3), {}, "3 of them"),
        *(((1, 2, 3, last), {}, "positive finite") for last in (np.nan, -1, 10**400, "x")),
        (3.0, {}, "four lengths"),
        *(((5, 1, 5, 2), {"tolerance": wrong}, "tolerance: found") for wrong in (-1, np.nan)),
        ((5, 1, 5, 2), {"input": "frame"}, "input: found"),
    ],
)


@pytest.mark.parametrize(
    ("sizes", "category", "turning"),
    [
        ((1.0, 3.0, 0.5), "Grashof", {"crank"}),
        ((3.0, 1.0, -0.5), "Grashof", {"coupler"}),
        ((1.0, 1.25, 0.5), "non-Grashof", set()),
        ((1.0, 1.5, -0.5), "change point", {"crank"}),
        ((1.0, 1.0, 0.0), "change point", {"crank", "coupler"}),
    ],
)
def test_slider_crank(sizes, category, turning):
    found = classify(SliderCrank(*sizes))
    assert found.category == category
    assert {link for link, full in found.turns.items() if full} == turning
    assert np.sign(found.distance) == {"Grashof": -1, "non-Grashof": 1, "change point": 0}[category]
    # Endless frame and follower that differ by the offset: the same class.
    far = 2.0**40
    crank, coupler, offset = sizes
    limit = classify((far + abs(offset), crank, coupler, far))
    assert limit.category == category


@pytest.mark.parametrize(("crank", "turns"), [(0.5, False), (2.0, True)])
def test_quick_return(crank, turns):
    found = classify(QuickReturn(1.0, crank, 4.0))
    assert found.turns["rod"] == turns
    assert found.category == "Grashof"
    assert np.sign(found.distance) == (1 if turns else -1)


def test_the_mark_leaves_its_symbol_free():
    # Coupler, follower and frame of one length: the middle of the region, where its symbol stood.
    ax = classify((12.0, 6.0, 12.0, 12.0)).plot()
    assert {text.get_text() for text in ax.texts} >= {"GCCC", "GCRR", "GRCR", "GRRC"}
    symbol = next(text for text in ax.texts if text.get_text() == "GCRR")
    ax.figure.canvas.draw()
    mark = ax.transData.transform(ax.lines[-1].get_xydata()[0])
    assert not symbol.get_window_extent().padded(4.0).contains(*mark)
