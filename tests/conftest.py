"""Let every test import the exact four-bar linkage and the accuracy table of ``tests/derive``."""

import sys
from pathlib import Path

_HELPERS = str(Path(__file__).resolve().parent / "derive")
if _HELPERS not in sys.path:
    sys.path.insert(0, _HELPERS)
