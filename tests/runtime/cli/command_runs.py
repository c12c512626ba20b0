"""Running a command within the test's process."""

import json

from elastolink.runtime.cli import main


def run(capsys, *arguments):
    """Return status, standard output and standard error."""
    try:
        status = main([str(argument) for argument in arguments])
    except SystemExit as left:
        status = left.code
    return status, *capsys.readouterr()


def shown(capsys, *arguments):
    """Return what a command prints that ends well and complains of nothing."""
    status, out, err = run(capsys, *arguments)
    assert (status, err) == (0, "")
    return out


def told(capsys, *arguments):
    """Return the JSON of a command that ends well."""
    return json.loads(shown(capsys, *arguments, "--json"))


def refused(capsys, *arguments):
    """Return the complaint, which is one line without a traceback."""
    status, out, err = run(capsys, *arguments)
    assert status == 2 and out == ""
    assert err.startswith("elastolink") and len(err.splitlines()) == 1
    return err
