"""What an error estimate has to be over many cases: nearly always enough, and not idle."""

import functools
import inspect
import os

import numpy as np
import pytest

extended = pytest.mark.skipif(
    np.finfo(np.longdouble).eps > 1e-18, reason="the reference needs a long double of 80 bits"
)


def covers(estimates, actual, least=1, floor=1e-300, median=100.0):
    """Estimate over actual error: at least 1 in 99 %, median no larger than 100.

    Below ``floor`` the reference is not known.
    """
    actual = np.maximum(np.abs(np.hstack(actual).astype(float)), floor)
    ratios = np.hstack(estimates).astype(float) / actual
    assert ratios.size >= least
    assert np.mean(ratios >= 1.0) >= 0.99
    assert np.median(ratios) <= median


def over_scenes(seed, few=20, many=200, *, floor=1e-300, median=100.0):
    """Make a test of one random scene a test of many.

    ``scene(rng, ...)`` returns estimates and actual errors that broadcast, or by name several such
    pairs; None where the scene does not do and another is to be drawn.  ``few`` scenes stand in the
    first stage of the tests, ``many`` in the second (times ``ELASTOLINK_SCENES``, where that is in
    the environment); None for neither.  The median of few scatters: it may be thrice the limit,
    and that of less than three scenes, which a digit that happens to be right moves, is not judged.
    """
    counts = [few] if few else []
    more = max(int(os.environ.get("ELASTOLINK_SCENES", "1")), 1)
    counts += [pytest.param(more * many, marks=pytest.mark.slow)] if many else []

    def made(scene):
        @functools.wraps(scene)
        def test(scenes, **given):
            rng, found, drawn = np.random.default_rng(seed), {}, 0
            while drawn < scenes:
                pairs = scene(rng, **given)
                drawn += pairs is not None
                named = pairs if isinstance(pairs, dict) else {"": pairs}
                for name, pair in named.items() if pairs is not None else ():
                    both = np.broadcast_arrays(*(np.asarray(part, dtype=float) for part in pair))
                    found.setdefault(name, []).append([part.ravel() for part in both])
            most = median * (3 if scenes == few else 1) if scenes >= 3 else np.inf
            for rows in found.values():
                covers(*zip(*rows, strict=True), scenes, floor, most)

        own = inspect.signature(scene)
        test.__signature__ = own.replace(
            parameters=[
                inspect.Parameter("scenes", inspect.Parameter.POSITIONAL_OR_KEYWORD),
                *(part for name, part in own.parameters.items() if name != "rng"),
            ]
        )
        return pytest.mark.parametrize("scenes", counts)(test)

    return made
