"""Rigid machines: masses, loads, pin forces, flywheels, run-up, balancing.

The names load on first use.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .bounds import Bounds
    from .cases import balance_case, case_counterweights, fully_balanced
    from .compromise import TradeOff, trade_off
    from .counterweights import Counterweight, with_counterweights
    from .flywheel import Flywheel, TorqueFluctuation, flywheel_inertia, torque_fluctuation
    from .force_result import RigidForces
    from .forces import driving_torque, pin_forces, rigid_forces, shaking_force, shaking_moment
    from .link_inertia import (
        BalancedLink,
        balanced_link_inertia,
        density_number,
        offset_function,
        optimal_offset,
    )
    from .loads import Load, LoadState, Spring, TorsionSpring
    from .machine import Machine
    from .masses import MassDistribution
    from .motor_run import RunUp, run_up
    from .motors import TorqueLine
    from .optimum import Balancing, balance, compare_case, peaks_of
    from .peaks import ForcePeak, force_peaks
    from .reciprocating import ReciprocatingBalance, reciprocating_balance

_PUBLIC = {
    "BalancedLink": "link_inertia",
    "Balancing": "optimum",
    "Bounds": "bounds",
    "Counterweight": "counterweights",
    "Flywheel": "flywheel",
    "ForcePeak": "peaks",
    "Load": "loads",
    "LoadState": "loads",
    "Machine": "machine",
    "MassDistribution": "masses",
    "ReciprocatingBalance": "reciprocating",
    "RigidForces": "force_result",
    "RunUp": "motor_run",
    "Spring": "loads",
    "TorqueFluctuation": "flywheel",
    "TorqueLine": "motors",
    "TorsionSpring": "loads",
    "TradeOff": "compromise",
    "balance": "optimum",
    "balance_case": "cases",
    "balanced_link_inertia": "link_inertia",
    "case_counterweights": "cases",
    "compare_case": "optimum",
    "density_number": "link_inertia",
    "driving_torque": "forces",
    "flywheel_inertia": "flywheel",
    "force_peaks": "peaks",
    "fully_balanced": "cases",
    "offset_function": "link_inertia",
    "optimal_offset": "link_inertia",
    "peaks_of": "optimum",
    "pin_forces": "forces",
    "reciprocating_balance": "reciprocating",
    "rigid_forces": "forces",
    "run_up": "motor_run",
    "shaking_force": "forces",
    "shaking_moment": "forces",
    "torque_fluctuation": "flywheel",
    "trade_off": "compromise",
    "with_counterweights": "counterweights",
}

__all__ = [
    "BalancedLink",
    "Balancing",
    "Bounds",
    "Counterweight",
    "Flywheel",
    "ForcePeak",
    "Load",
    "LoadState",
    "Machine",
    "MassDistribution",
    "ReciprocatingBalance",
    "RigidForces",
    "RunUp",
    "Spring",
    "TorqueFluctuation",
    "TorqueLine",
    "TorsionSpring",
    "TradeOff",
    "balance",
    "balance_case",
    "balanced_link_inertia",
    "case_counterweights",
    "compare_case",
    "density_number",
    "driving_torque",
    "flywheel_inertia",
    "force_peaks",
    "fully_balanced",
    "offset_function",
    "optimal_offset",
    "peaks_of",
    "pin_forces",
    "reciprocating_balance",
    "rigid_forces",
    "run_up",
    "shaking_force",
    "shaking_moment",
    "torque_fluctuation",
    "trade_off",
    "with_counterweights",
]

__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
