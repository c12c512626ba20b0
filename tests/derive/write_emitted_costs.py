"""What the emitted modules cost, as stored beside the tests; run it to store the costs of today.

python tests/derive/write_emitted_costs.py
"""

from __future__ import annotations

import json
from pathlib import Path

import elastolink.generated
from elastolink.runtime.cli.skipping import read_cost

STORED = Path(__file__).with_name("emitted_costs.json")
PACKAGED = Path(elastolink.generated.__path__[0])


def costs():
    """Return bytes and operations of each emitted module by name."""
    found = {}
    for path in sorted(PACKAGED.glob("*.py")):
        if path.stem != "__init__":
            cost = read_cost(path)
            found[cost.module] = {"bytes": cost.size, "operations": dict(cost.operations)}
    return found


if __name__ == "__main__":
    STORED.write_text(json.dumps(costs(), indent=1, sort_keys=True) + "\n")
    print(f"{STORED}: {len(costs())} modules")
