"""Let every test import the exact references of its neighbours."""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

for _folder in ("derive", "convergence", "seed_equations"):
    _helpers = str(Path(__file__).resolve().parent / _folder)
    if _helpers not in sys.path:
        sys.path.insert(0, _helpers)


@pytest.fixture(scope="module")
def loop_cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Give compiled loops a cache of the tests' own; what others compiled here is made again."""
    from elastolink.runtime.compiled import functions, modules

    made = (functions._made, modules._made)
    folder = tmp_path_factory.mktemp("cache")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(folder))
        for known in made:
            known.cache_clear()
        yield folder
        for known in made:
            known.cache_clear()
