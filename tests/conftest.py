"""Let every test import the exact references of its neighbours."""

import sys
from pathlib import Path

for _folder in (".", "derive", "convergence", "seed_equations", "runtime/cli"):
    _helpers = str(Path(__file__).resolve().parent / _folder)
    if _helpers not in sys.path:
        sys.path.insert(0, _helpers)
