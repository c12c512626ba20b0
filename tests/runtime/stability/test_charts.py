"""Stability charts: interpolated invariants against direct ones, boundaries against both."""

import elastolink as el
import numpy as np
import pytest
from edge_truth import rig
from matplotlib.collections import PolyCollection, QuadMesh

SPEEDS = np.linspace(40.0, 99.0, 61)
INERTIAS = np.linspace(6e-4, 2.2e-3, 31)


@pytest.fixture(scope="module")
def undamped():
    return el.stability_chart(rig(), ("speed", SPEEDS), ("follower_inertia", INERTIAS))


def direct_half_trace(system, speed, inertia):
    result = el.monodromy(system, speed, follower_inertia=inertia)
    return np.trace(result.matrix) / 2


def test_half_traces_agree_with_monodromy_matrices(undamped):
    """The monodromy matrices come from collocation, the chart from transfer polynomials."""
    system = rig()
    rng = np.random.default_rng(7)
    for _ in range(20):
        i, j = rng.integers(len(INERTIAS)), rng.integers(len(SPEEDS))
        found = undamped.invariants[i, j, 0]
        wanted = direct_half_trace(system, SPEEDS[j], INERTIAS[i])
        assert abs(found - wanted) <= undamped.error + 1e-10 * max(1.0, abs(wanted))
    assert undamped.error < 1e-9
    assert undamped.passed


def test_exact_boundaries_lie_where_the_half_trace_is_one(undamped):
    system = rig()
    curves = undamped.exact
    checked = 0
    for j in (0, 15, 30):
        for row in (*curves.lower[:, j], *curves.upper[:, j]):
            if np.isfinite(row) and SPEEDS[0] < row < SPEEDS[-1]:
                half = direct_half_trace(system, row, curves.at[j])
                assert abs(abs(half) - 1.0) < 1e-9
                checked += 1
    assert checked >= 12


def test_shading_agrees_with_exact_boundaries(undamped):
    """A point is unstable if and only if it lies between the ends of some region."""
    curves = undamped.exact
    for i, inertia in enumerate(INERTIAS):
        j = int(np.argmin(np.abs(curves.at - inertia)))
        assert abs(curves.at[j] - inertia) < 1e-12
        # lower in lam2 is the higher speed
        inside = (curves.lower[:, j, None] > SPEEDS) & (curves.upper[:, j, None] < SPEEDS)
        assert np.array_equal(~undamped.stable[i], np.any(inside, axis=0))


def test_picture_shows_what_it_promises(undamped, tmp_path):
    axes = undamped.plot()
    labels = {text.get_text() for text in axes.get_legend().get_texts()}
    assert {"exact boundary (Hill matrix)", "first-order boundary"} <= labels
    assert any("error of the discriminant" in text.get_text() for text in axes.texts)
    assert "rpm" in axes.get_xlabel()


@pytest.mark.parametrize("damping", [0.0, 0.05])
@pytest.mark.parametrize("turned", [False, True])
def test_regions_are_filled_between_their_boundaries(damping, turned):
    """What is shaded by points or filled is what is unstable; few are left to the points."""
    speed, inertia = ("speed", SPEEDS), ("follower_inertia", INERTIAS)
    across = (inertia, speed) if turned else (speed, inertia)
    chart = el.stability_chart(rig().with_parameters(damping=damping), *across)
    axes = chart.plot()
    x, y = np.meshgrid(*((30.0 / np.pi if n == "speed" else 1.0) * v for n, v in across))
    filled = np.zeros(chart.stable.shape, dtype=bool)
    for regions in (c for c in axes.collections if isinstance(c, PolyCollection)):
        for path in regions.get_paths():
            inside = path.contains_points(np.column_stack([x.ravel(), y.ravel()]))
            filled |= inside.reshape(filled.shape)
    shaded = np.zeros(filled.shape, dtype=bool)
    for mesh in (c for c in axes.collections if isinstance(c, QuadMesh)):
        shaded |= np.asarray(mesh.get_array()).reshape(filled.shape) > 0
    assert not np.any(shaded & filled)
    # Points on the rim lie on that of the polygons.
    within = np.s_[1:-1, 1:-1]
    assert np.array_equal((shaded | filled)[within], ~chart.stable[within])
    assert np.count_nonzero(shaded) <= (0.0 if damping == 0.0 else 0.02) * np.count_nonzero(filled)


def test_picture_names_the_frequency_and_the_error_of_several_modes():
    chart = el.stability_chart(
        rig(**{"model.modes": 2}),
        ("speed", SPEEDS[::10]),
        ("follower_inertia", INERTIAS[::15]),
        frequency_name="coupler frequency",
    )
    axes = chart.plot()
    assert any("error of the invariants" in text.get_text() for text in axes.texts)
    assert "coupler frequency" in axes.child_axes[0].get_xlabel()
