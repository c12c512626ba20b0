"""Base planes of Barker's solution space: regions against the exact map."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages.base_planes import base_plane
from elastolink.runtime.linkages.classification import SYMBOLS, classify, classify_many


@pytest.mark.parametrize("lam", [0.7, 1.2, 3.0**0.5, 2.5, 20.0])
def test_regions_fill_the_plane_and_hold_their_class(lam):
    plane = base_plane(lam, 61)
    assert sum(plane.shares.values()) == pytest.approx(1.0, abs=1e-12)
    random = np.random.default_rng(3)
    for symbol, corners in plane.regions.items():
        weights = random.dirichlet(np.ones(len(corners)), 50)
        coupler, output, frame = (weights @ corners).T
        lengths = np.stack([frame, np.ones_like(frame), coupler, output], -1)
        assert {SYMBOLS[number] for number in classify_many(lengths)} == {symbol}
    assert {SYMBOLS[n] for n in np.unique(plane.numbers)} >= {"GCCC", "GRCR", "GRRC"}
    assert ("RRR2" in plane.regions) == (lam < 1.7)
    assert ("GCRR" in plane.regions) == (lam > 1.8)


def test_borders_are_change_points():
    for ends in base_plane(1.2).borders.values():
        coupler, output, frame = ends.mean(axis=0)
        sums = (frame + 1 - coupler - output, frame + coupler - 1 - output)
        assert min(map(abs, (*sums, frame + output - 1 - coupler))) < 1e-14


def test_picture_marks_the_linkage():
    axes = base_plane(1.2, 5).plot(mark=(0.7, 0.7, 0.6))
    assert {text.get_text() for text in axes.texts} == {*base_plane(1.2, 5).regions}


@pytest.mark.parametrize("bad", [(0.5,), (float("nan"),), (1.0, 1)])
def test_planes_without_linkages_are_refused(bad):
    with pytest.raises(BadInput):
        base_plane(*bad)


def test_the_mark_leaves_its_symbol_free():
    # Coupler, follower and frame of one length: the middle of the region, where its symbol stood.
    ax = classify((12.0, 6.0, 12.0, 12.0)).plot()
    symbol = next(text for text in ax.texts if text.get_text() == "GCRR")
    ax.figure.canvas.draw()
    mark = ax.transData.transform(ax.lines[-1].get_xydata()[0])
    assert not symbol.get_window_extent().padded(4.0).contains(*mark)
