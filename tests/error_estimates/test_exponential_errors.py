"""Error figures of monodromy matrices by exponentials, and in other array namespaces.

Springs seen in wavy coordinates, as in the tests of the other figures of Floquet analysis, driven
so slowly that many oscillations pass in a period: there, products of exponentials take less work
than collocation.
"""

from __future__ import annotations

import array_api_strict as xp
import numpy as np
import pytest
from elastolink.runtime.floquet import monodromy, monodromy_matrices
from elastolink.runtime.floquet.first_order import canonical_form
from elastolink.runtime.floquet.refined_products import segment_groups, worth_exponentials
from wavy_springs import Wavy, tame, verdict

SCENES = 200


def wavy(seed: int, count: int, waves: float, speeds: tuple[float, float]):
    """Yield random scenes, their waves smaller by a factor, and a speed."""
    rng = np.random.default_rng(seed)
    while count:
        scene = Wavy(rng, rng.uniform(1.0, 60.0, 2))
        scene._waves *= waves
        if tame(scene):
            count -= 1
            yield scene, float(rng.uniform(*speeds))


@pytest.mark.slow
@pytest.mark.parametrize(("waves", "rtol"), [(0.5, 1e-6), (0.0003, 1e-11)])
def test_figures_of_exponentials(waves, rtol):
    """Where they are chosen: in more than half of these scenes."""
    actual, figure, chosen = [], [], 0
    for scene, speed in wavy(11, SCENES, waves, (0.03, 0.1)):
        form = canonical_form(scene.system, speed)
        ((_, first),) = segment_groups(form)
        chosen += worth_exponentials(form, first, rtol) > 0
        found = monodromy(scene.system, speed, rtol=rtol)
        exact = scene.exact(speed) / found.scale[:, None] * found.scale
        top = np.max(np.abs(exact))
        actual.append(np.max(np.abs(found.scaled - exact)) / top)
        figure.append(float(found.error))
        assert found.passed, found.checks
        unit = np.kron([[0.0, 1.0], [-1.0, 0.0]], np.eye(2))
        defect = np.max(np.abs(found.scaled.T @ unit @ found.scaled - unit))
        assert defect <= 1e-12 * top**2
    covered, idle = verdict(actual, figure)
    assert chosen > SCENES / 2
    assert covered >= 0.99
    assert idle <= 1e3
    assert np.max(figure) <= rtol


@pytest.mark.slow
@pytest.mark.parametrize("method", ["gauss_legendre16", "magnus6", "cf4", "rk4"])
def test_figures_in_another_namespace(method):
    """Of the worst member of a batch; by doubled steps, and by steps that are given."""
    actual, figure = [], []
    rtol = 1e-9 if method == "gauss_legendre16" else 1e-6
    for place, (scene, speed) in enumerate(wavy(12, SCENES, 0.5, (1.0, 4.0))):
        speeds = speed * np.array([1.0, 1.3])
        given = {"rtol": rtol} if place % 2 else {"steps": 96}
        strict = monodromy_matrices(scene.system, xp.asarray(speeds), method=method, **given)
        found = strict.to_numpy()
        gaps = []
        for k, own in enumerate(speeds):
            ratio = found.scale[k] / found.scale[k][:, None]
            exact = scene.exact(own) * ratio
            gaps.append(np.max(np.abs(found.matrix[k] * ratio - exact)) / np.max(np.abs(exact)))
        actual.append(np.max(gaps))
        figure.append(found.error)
    covered, idle = verdict(actual, figure)
    assert covered >= 0.99
    assert idle <= 1e3
