"""Dynamics of rigid linkages: masses, loads, forces, flywheels, run-up."""

from __future__ import annotations

from .flywheel import Flywheel, TorqueFluctuation, flywheel_inertia, torque_fluctuation
from .force_result import RigidForces
from .forces import driving_torque, pin_forces, rigid_forces, shaking_force, shaking_moment
from .loads import Load, LoadState, Spring, TorsionSpring
from .machine import Machine
from .masses import MassDistribution
from .motors import TorqueLine
from .run_up import RunUp, run_up

__all__ = [
    "Flywheel",
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
    "driving_torque",
    "flywheel_inertia",
    "pin_forces",
    "rigid_forces",
    "run_up",
    "shaking_force",
    "shaking_moment",
    "torque_fluctuation",
]
