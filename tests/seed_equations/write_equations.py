"""Write docs/equations.md from the ledger: run it by hand after a change of rows."""

import sys
from pathlib import Path

# As the conftest of the tests does, for the helpers that some rows import.
sys.path += [str(Path(__file__).resolve().parents[1] / name) for name in ("derive", "convergence")]

from seed_ledger import TARGET, page

if __name__ == "__main__":
    TARGET.write_text(page() + "\n", encoding="utf-8")
    sys.stdout.write(f"{TARGET}: written\n")
