"""Rigid machines: masses, loads, pin forces, flywheels, run-up, balancing.

The names load on first use.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .balancing import Balancing, TradeOff, balance, trade_off
    from .cases import case_counterweights
    from .counterweights import Bounds, Counterweight, with_counterweights
    from .flywheel import Flywheel, TorqueFluctuation, flywheel_inertia, torque_fluctuation
    from .forces import (
        RigidForces,
        driving_torque,
        pin_forces,
        rigid_forces,
        shaking_force,
        shaking_moment,
    )
    from .loads import Load, LoadState, Spring, TorsionSpring
    from .machine import Machine
    from .masses import MassDistribution
    from .motor_run import RunUp, run_up
    from .motors import TorqueLine
    from .peaks import ForcePeak, force_peaks

_PUBLIC = {
    "Balancing": "balancing",
    "Bounds": "counterweights",
    "Counterweight": "counterweights",
    "Flywheel": "flywheel",
    "ForcePeak": "peaks",
    "Load": "loads",
    "LoadState": "loads",
    "Machine": "machine",
    "MassDistribution": "masses",
    "RigidForces": "forces",
    "RunUp": "motor_run",
    "Spring": "loads",
    "TorqueFluctuation": "flywheel",
    "TorqueLine": "motors",
    "TorsionSpring": "loads",
    "TradeOff": "balancing",
    "balance": "balancing",
    "case_counterweights": "cases",
    "driving_torque": "forces",
    "flywheel_inertia": "flywheel",
    "force_peaks": "peaks",
    "pin_forces": "forces",
    "rigid_forces": "forces",
    "run_up": "motor_run",
    "shaking_force": "forces",
    "shaking_moment": "forces",
    "torque_fluctuation": "flywheel",
    "trade_off": "balancing",
    "with_counterweights": "counterweights",
}

__all__ = [
    "Balancing",
    "Bounds",
    "Counterweight",
    "Flywheel",
    "ForcePeak",
    "Load",
    "LoadState",
    "Machine",
    "MassDistribution",
    "RigidForces",
    "RunUp",
    "Spring",
    "TorqueFluctuation",
    "TorqueLine",
    "TorsionSpring",
    "TradeOff",
    "balance",
    "case_counterweights",
    "driving_torque",
    "flywheel_inertia",
    "force_peaks",
    "pin_forces",
    "rigid_forces",
    "run_up",
    "shaking_force",
    "shaking_moment",
    "torque_fluctuation",
    "trade_off",
    "with_counterweights",
]

__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
