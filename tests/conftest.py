"""Let every test import the exact references of ``tests/derive`` and ``tests/convergence``."""

import sys
from pathlib import Path

for _folder in ("derive", "convergence"):
    _helpers = str(Path(__file__).resolve().parent / _folder)
    if _helpers not in sys.path:
        sys.path.insert(0, _helpers)
