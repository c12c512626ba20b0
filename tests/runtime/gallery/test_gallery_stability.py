"""The gallery's stability charts: Smith's Fig. 38, Aannaque's Fig. 7.2 and appendix E."""

from dataclasses import replace

import numpy as np
import pytest
from elastolink.runtime.core.plotting import new_figure
from elastolink.runtime.gallery import aannaque_stability, figures, smith_space
from elastolink.runtime.gallery.rendering import render
from elastolink.runtime.hill import hill_boundaries
from gallery_rows import require_rows

FIGURES = (
    ("smith", "38", 1),
    ("aannaque", "7.2", 0),
    ("aannaque", "E.1", 0),
    ("aannaque", "E.2", 0),
    ("aannaque", "E.3", 1),
)


@pytest.mark.parametrize(("document", "label", "differing"), FIGURES)
def test_every_quoted_number_agrees_or_differs_for_a_known_reason(document, label, differing):
    gallery = require_rows(document, label, differing)
    assert len(gallery.rows) >= 3


def test_letters_choose_figures_of_an_appendix():
    assert [entry.label for entry in figures("aannaque", "e.3")] == ["E.3"]
    assert [entry.stem for entry in figures("aannaque", "E.1")] == ["aannaque_E_01"]


def test_a_picture_in_space_has_axes_in_space():
    (entry,) = figures("smith", "38")
    seen = []

    def draw(axes):
        seen.extend(axes)
        return entry.draw(axes)

    drawn, picture = render(replace(entry, draw=draw), picture=False)
    assert picture is None and drawn.quoted
    assert seen[0].name == "3d"


def test_the_surfaces_of_the_space_are_those_of_the_sum_of_both_functions():
    pair = smith_space._functions()
    lower, upper = pair.along(0.3, 0.4, np.array([0.0, 1.0]))
    exact = hill_boundaries(pair.first * 0.3 + pair.second * 0.4, 1.0, (2,))
    assert lower[1] == exact.lower[0] and upper[1] == exact.upper[0]
    assert lower[0] == pytest.approx(1.0, abs=1e-13)
    near = pair.to_order(np.array([3e-3]), np.array([4e-3]), 2)
    true = pair.along(3e-3, 4e-3, np.ones(1))
    # What is left out is of the third order.
    for one, other in zip(near, true, strict=True):
        assert abs(one[0] - other[0]) < 1e-6


def test_curves_of_both_signs_are_drawn():
    ax = new_figure().add_subplot()
    aannaque_stability.figure_7_2([ax])
    lines = [text.get_text() for text in ax.figure.legends[0].get_texts()]
    assert lines[:2] == ["$J_2 = 1$", "$J_2 = -1$"]
