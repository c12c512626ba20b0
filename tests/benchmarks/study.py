"""The study of ten thousand designs in docs/clusters.md: time, memory, disk, killed and resumed.

    python tests/benchmarks/study.py [COUNT]

COUNT (100) is the number of lengths of each of two links.  Prints the table of the page.
"""

from __future__ import annotations

import filecmp
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SCRIPT = Path(__file__).parents[2] / "docs" / "examples" / "coupler_study.py"


def begun(store: Path, count: str, workers: int) -> subprocess.Popen[bytes]:
    """Return the study, begun or taken up again."""
    words = [str(store), "--count", count, "--workers", str(workers)]
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    return subprocess.Popen([sys.executable, str(SCRIPT), *words], env=environment, **quiet)


def seconds(store: Path, count: str, workers: int) -> str:
    """Do it to its end and return wall and processor seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    start = time.perf_counter()
    if begun(store, count, workers).wait():
        raise RuntimeError(f"{SCRIPT.name} failed")
    wall = time.perf_counter() - start
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return f"{wall:.1f} s, {used:.1f} s"


def size(store: Path) -> str:
    """Return how much a store takes on the disk."""
    return f"{sum(p.stat().st_size for p in store.rglob('*') if p.is_file()) / 1e6:.2f} MB"


def same(one: Path, other: Path) -> bool:
    """Return whether two complete stores have the same files, byte for byte."""
    names = [sorted(path.name for path in store.iterdir()) for store in (one, other)]
    return names[0] == names[1] and not filecmp.cmpfiles(one, other, names[0], shallow=False)[1]


def main() -> None:
    """Measure and print."""
    count = sys.argv[1] if len(sys.argv) > 1 else "100"
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        one, two, killed = (Path(folder) / name for name in ("one", "two", "killed"))
        for store, workers in ((one, 1), (two, 2)):
            plural = "es" * (workers > 1)
            rows.append((f"{workers} process{plural}", seconds(store, count, workers)))
        # As Linux counts, in KiB.
        most = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
        rows.append(("most memory of any process", f"{most:.0f} MiB"))
        rows.append(("the complete store", size(two)))
        running = begun(killed, count, 2)
        pieces = killed / "pieces"
        while running.poll() is None and len(list(pieces.glob("0*.npz"))) < 3 * int(count):
            time.sleep(0.01)
        running.kill()
        running.wait()
        kept = len(list(pieces.glob("0*.npz")))
        rows.append((f"killed with {kept} pieces done", size(killed)))
        rows.append(("the rest, 2 processes", seconds(killed, count, 2)))
        rows.append(("asked for again", seconds(killed, count, 2)))
        rows.append(("all three stores alike", str(same(one, two) and same(two, killed))))
    print("| | wall, processor |\n| --- | --- |")
    print("\n".join(f"| {name} | {value} |" for name, value in rows))


if __name__ == "__main__":
    main()
