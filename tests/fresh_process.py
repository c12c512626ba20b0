"""Running code in an interpreter of its own."""

import os
import subprocess
import sys


def python(code: str, *arguments: str, **changed: str) -> str:
    """Return what code prints that succeeds in silence, some of its environment changed."""
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code, *arguments],
        env={**os.environ, **changed},
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert (done.returncode, done.stderr) == (0, ""), done.stderr
    return done.stdout
