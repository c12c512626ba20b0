"""The regression guard: ratios to the best peer, stored and compared; never absolute times."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from ...core.errors import bad
from ...core.results import Check, write_whole
from .result import WorkPrecision, ratios

Ratios = Mapping[str, Mapping[str, float]]

# How much smaller than the stored one a ratio may be: timings of short runs vary.
_NOISE = 1.6


def load_ratios(path: str | Path) -> Ratios:
    """Return stored ratios, by problem and level.

    Raises
    ------
    BadInput
        If the file cannot be read or holds something else.
    """
    try:
        content = json.loads(Path(path).read_text(encoding="utf-8"))
    except (OSError, ValueError) as reason:
        found = f"{path}: {reason}"
        raise bad("--compare", found, "a JSON file of ratios", "make one with --store") from reason
    good = isinstance(content, dict) and all(
        isinstance(own, dict) and all(isinstance(v, (int, float)) for v in own.values())
        for own in content.values()
    )
    if not good:
        raise bad("--compare", path, "ratios by problem and level", "make one with --store")
    stored: Ratios = content
    return stored


def store_ratios(result: WorkPrecision, path: str | Path) -> Path:
    """Write the ratios of a benchmark; problems that it did not measure are kept as they were."""
    target = Path(path)
    known = dict(load_ratios(target)) if target.exists() else {}
    known.update(ratios(result.leads))
    text = json.dumps({k: known[k] for k in sorted(known)}, indent=1) + "\n"
    return write_whole(target, text.encode())


def compared(result: WorkPrecision, stored: Ratios) -> WorkPrecision:
    """Return the result with a check ``regression``: the largest fall of a ratio, stored over now.

    Only problems and levels that both hold count.

    Raises
    ------
    BadInput
        If they share none.
    """
    now = ratios(result.leads)
    falls = [
        stored[problem][level] / value
        for problem, own in now.items()
        for level, value in own.items()
        if level in stored.get(problem, {}) and value > 0.0
    ]
    if not falls:
        found, fix = "no problem and level in common", "store them first, with the same peers"
        raise bad("--compare", found, "some of those measured", fix)
    return replace(result, checks={**result.checks, "regression": Check(max(falls), _NOISE)})
