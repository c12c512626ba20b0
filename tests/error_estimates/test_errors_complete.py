"""Every public solver has its error estimate tested in this folder, or hands on another one's."""

import re
from importlib import import_module
from pathlib import Path

import elastolink
from elastolink.runtime.core.results import Result

# Whose error estimate is that of another solver, which is called: the second name.
DELEGATED = {
    "driving_torque": "rigid_forces",
    "link_frequencies": "natural_frequencies",
    "pin_forces": "rigid_forces",
    "shaking_force": "rigid_forces",
    "shaking_moment": "rigid_forces",
    "sweep": "stability_chart",
    "response_curve": "curve_of",  # of random_systems.py, which calls it
    "balance": "with_crank_counterweight",  # a helper of its test, which calls it
}
# Whole numbers, classes, or an approximation whose error is another function's.
WITHOUT = {
    "classify": "exact arithmetic decides the class",
    "explain": "counts of terms, operations and bytes",
    "mobility": "a whole number",
}
ROOMS = ("linkages", "rigid", "beams", "hill", "periodic", "recovery", "constrained")
ROOMS += ("frequencies", "stability", "design", "sweeps")
SOURCES = [path.read_text() for path in Path(__file__).parent.glob("test_*_errors.py")]


def _descendants(kind):
    for child in kind.__subclasses__():
        yield child
        yield from _descendants(child)


def _solvers():
    """Return the public functions, of the package and of its rooms, that return a result."""
    public = {name: getattr(elastolink, name) for name in elastolink.__all__}
    for room in ROOMS:
        module = import_module(f"elastolink.runtime.{room}")
        public |= {name: getattr(module, name) for name in module.__all__}
    names = {kind.__name__ for kind in _descendants(Result)} | {"Prepared", "ReducedSystem"}
    return {
        name
        for name, value in public.items()
        if not isinstance(value, type)
        and callable(value)
        and names
        & set(re.findall(r"\w+", str(getattr(value, "__annotations__", {}).get("return", ""))))
    }


def test_every_solver_is_called_where_errors_are_tested():
    solvers = _solvers()
    assert len(solvers) > 50 and {*WITHOUT, *DELEGATED} <= solvers
    untested = [
        name
        for name in sorted(solvers - set(WITHOUT))
        if not any(re.search(rf"\b{DELEGATED.get(name, name)}\(", text) for text in SOURCES)
    ]
    assert untested == []
