"""Running a command within the test's process."""

import json

from elastolink.runtime.cli import main


def run(capsys, *arguments):
    """Return status, standard output and standard error."""
    try:
        status = main([str(argument) for argument in arguments])
    except SystemExit as left:
        status = left.code
    out, err = capsys.readouterr()
    return status, out, err


def told(capsys, *arguments):
    """Return the JSON that a command prints."""
    status, out, _ = run(capsys, *arguments, "--json")
    assert status == 0
    return json.loads(out)


def refused(capsys, *arguments):
    """Check that a command line is refused in one line, and return the complaint."""
    status, out, err = run(capsys, *arguments)
    assert status == 2 and out == ""
    assert err.startswith("elastolink") and len(err.splitlines()) == 1
    return err
