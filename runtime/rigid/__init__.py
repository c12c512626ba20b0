"""Rigid machines: masses, loads, pin forces, flywheels, run-up, balancing.

The names load on first use.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .balancing import Balancing as Balancing
    from .balancing import balance as balance
    from .balancing import trade_off as trade_off
    from .counterweights import Bounds as Bounds
    from .counterweights import Counterweight as Counterweight
    from .counterweights import case_counterweights as case_counterweights
    from .counterweights import with_counterweights as with_counterweights
    from .flywheel import flywheel_inertia as flywheel_inertia
    from .flywheel import torque_fluctuation as torque_fluctuation
    from .forces import RigidForces as RigidForces
    from .forces import driving_torque as driving_torque
    from .forces import pin_forces as pin_forces
    from .forces import rigid_forces as rigid_forces
    from .forces import shaking_force as shaking_force
    from .forces import shaking_moment as shaking_moment
    from .loads import Load as Load
    from .loads import Spring as Spring
    from .loads import TorsionSpring as TorsionSpring
    from .machine import Machine as Machine
    from .masses import MassDistribution as MassDistribution
    from .motor_run import RunUp as RunUp
    from .motor_run import TorqueLine as TorqueLine
    from .motor_run import run_up as run_up
    from .peaks import ForcePeak as ForcePeak
    from .peaks import force_peaks as force_peaks

__all__ = on_first_use(globals())
