"""The tables of docs/free_free_stability.md."""

from __future__ import annotations

import numpy as np
from documented_tables import table
from free_free_loads import about, difference, linear, loaded, part_of_inertia, phases, rod

SPEED = 150.0


def _short(value: float) -> str:
    return f"{value:.2e}"


def undeformed() -> str:
    """Multipliers about the undeformed motion, and what the two linear forms make of them."""
    rows = []
    for modes in (1, 2, 3):
        found = about(loaded(rod(modes, 0.2, SPEED), part_of_inertia(0.0)))[1]
        away = [
            np.max(np.abs(difference(found.physical, linear(modes, 0.2, SPEED, drop).multipliers)))
            for drop in ((), ("frame",))
        ]
        assert away[0] < 1e-12
        told = ", ".join(f"{phase:.6f}" for phase in phases(found.physical))
        rows.append([f"{modes}", told, "below 1e-12", _short(away[1])])
    head = ["modes", "phases of the multipliers [rad]", "with frame term", "without"]
    return table(head, rows)


def orbits() -> str:
    """The difference about the true periodic motion against its amplitude."""
    rows = []
    for ratio in (0.04, 0.02, 0.01, 0.005):
        orbit, found = about(rod(1, ratio, SPEED))
        away = np.max(np.abs(difference(found.physical, linear(1, ratio, SPEED).multipliers)))
        bent = orbit.deflection
        rows.append([f"{ratio}", _short(bent), _short(away), f"{away / bent**2:.2f}"])
    return table(["ε", "deflection over L", "difference [rad]", "over its square"], rows)


def loads() -> str:
    """The difference at fixed coefficients, the load that bends the rod scaled down."""
    rows = []
    forms = [linear(1, 0.1, SPEED, drop).multipliers for drop in ((), ("frame",))]
    for part in (1.0, 0.1, 0.01, 0.001):
        found = about(loaded(rod(1, 0.1, SPEED), part_of_inertia(part)))[1]
        away = [np.max(np.abs(difference(found.physical, form))) for form in forms]
        rows.append([f"{part}", *map(_short, away)])
    return table(["part of the inertia load", "with frame term [rad]", "without [rad]"], rows)


def tongue() -> str:
    """Growth per revolution in the principal tongue of the first mode."""
    rows = []
    for ratio in (0.01, 0.005, 0.0025):
        orbit, found = about(rod(2, ratio, 1725.0))
        growth = np.max(np.abs(linear(2, ratio, 1725.0).multipliers))
        rows.append([f"{ratio}", _short(orbit.deflection), f"{found.largest:.5f}", f"{growth:.5f}"])
    head = ["ε", "deflection over L", "largest, constrained", "largest, linear"]
    return table(head, rows)


TABLES = {"undeformed": undeformed, "orbits": orbits, "loads": loads, "tongue": tongue}
