"""Processor seconds of every command of ``docs/commands.md``, each in a process of its own.

    python tests/benchmarks/commands.py [--store] [WORD]

``WORD`` picks the commands that contain it.  Beside each time stands the stored one of
``commands.json`` and their ratio; ``--store`` replaces the stored times.
"""

import json
import os
import re
import resource
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
PAGE = HERE.parents[1] / "docs" / "commands.md"
STORED = HERE / "commands.json"
SKIPPED = ("reproduce",)


def commands() -> list[str]:
    """Return what follows ``elastolink`` in the list of commands."""
    lines = re.findall(r"^    elastolink (.*?)(?:\s+#.*)?$", PAGE.read_text(), re.MULTILINE)
    return [line.strip() for line in lines if not line.startswith(SKIPPED)]


def measured(command: str, folder: str) -> float:
    """Return the processor seconds of one command; RuntimeError where it is refused, status 2."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    environment = {**os.environ, "MPLBACKEND": "Agg", "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(
        [sys.executable, "-m", "elastolink", *shlex.split(command)],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode > 1:
        raise RuntimeError(f"elastolink {command}: {done.stderr.strip()}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> None:
    """Measure, print and maybe store."""
    words = [word for word in sys.argv[1:] if not word.startswith("--")]
    stored = json.loads(STORED.read_text()) if STORED.exists() else {}
    times = {}
    with tempfile.TemporaryDirectory() as folder:
        for command in commands():
            if words and not any(word in command for word in words):
                continue
            times[command] = round(measured(command, folder), 2)
            known = stored.get(command)
            ratio = f"{times[command] / known:8.2f}" if known else ""
            print(f"{times[command]:8.2f} {known or '':>8} {ratio:>8}  {command}", flush=True)
    if "--store" in sys.argv:
        whole = json.dumps({**stored, **times}, indent=1) + "\n"
        STORED.write_text(whole, encoding="utf-8")


if __name__ == "__main__":
    main()
