"""How much too wide bands of tolerances are, over random lengths and widths."""

import itertools

import elastolink as el
import numpy as np
from elastolink.runtime.design import tolerance_bands
from elastolink.runtime.design.within_tolerances import answer_of
from elastolink.runtime.scenes import with_numbers
from honesty import over_scenes


@over_scenes(47, few=6, many=60)
def test_how_much_too_wide_bands_are(rng):
    """Worst cases of scenes against all corners and 30 machines; the truth lies between."""
    name, answer = [
        ("smith_1972_12_6_12_12", "forces"),
        ("smith_1972_5152_sixteenth_inch", "forces"),
        ("beale_1992_flexible_rod", "frequencies"),
    ][rng.integers(3)]
    given = el.load_scene(name).given["links"]
    keys = {k: 10.0 ** rng.uniform(-3.0, 0.0) for k, v in given.items() if isinstance(v, float)}
    scene = el.load_scene(name, {f"links.{k}": f"{given[k]!r} +- {p} %" for k, p in keys.items()})
    theta = [float(rng.uniform(0.0, 2.0 * np.pi))]
    bands = tolerance_bands(scene, answer, theta, trials=1)
    names = list(scene.tolerances)
    corners = list(itertools.product((-1.0, 1.0), repeat=len(names)))
    points = np.concatenate([corners, rng.uniform(-1.0, 1.0, (30, len(names)))])
    asked = answer_of(scene, answer, theta, None)
    made = [scene.get(key) for key in names] + points * [scene.tolerances[key] for key in names]
    found = [
        np.asarray(asked.compute(with_numbers(scene, dict(zip(names, row, strict=True)))))[:, 0]
        for row in made.tolist()
    ]
    top, bottom = np.max(found, axis=0), np.min(found, axis=0)
    assert np.all(bands.lower[:, 0] <= bottom) and np.all(top <= bands.upper[:, 0])
    return bands.error[:, 0], np.maximum(bands.upper[:, 0] - top, bottom - bands.lower[:, 0])
