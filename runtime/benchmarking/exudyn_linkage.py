"""The four-bar linkage in Exudyn, as one of its users would build it: three bodies, four joints."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..rigid import Machine

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ExudynRun:
    """What one run gives at the crank angles of its steps.

    Attributes
    ----------
    theta : ndarray, shape (n,)
        Crank angles [rad].
    joints : ndarray, shape (4, n, 2)
        Force of the first link upon the second one in the joints 12, 23, 34, 14 [N].
    torque : ndarray, shape (n,)
        Torque that holds the crank to its speed [N m].
    """

    theta: Array
    joints: Array
    torque: Array


def simulate_revolution(machine: Machine, speed: float, steps: int) -> ExudynRun:
    """Turn the crank once at constant speed by the trapezoidal rule at velocity level.

    The default generalized-alpha rule rings from its start and misses the pin forces by up to
    22 %; the index-2 trapezoidal rule converges in second order.

    Parameters
    ----------
    machine : Machine
        A four-bar linkage with straight links and no loads.
    speed : float
        Crank speed [rad/s].
    steps : int
        Steps per revolution.

    Raises
    ------
    ImportError
        Where Exudyn is not installed.
    """
    exudyn = import_module("exudyn")
    with warnings.catch_warnings():
        # Names of its settings change between versions, with a warning first.
        warnings.simplefilter("ignore", DeprecationWarning)
        system, sensors = _model(exudyn, machine, speed)
        period = 2.0 * np.pi / speed
        settings = exudyn.SimulationSettings()
        settings.timeIntegration.numberOfSteps = steps
        settings.timeIntegration.endTime = period
        settings.timeIntegration.verboseMode = 0
        settings.timeIntegration.newton.useModifiedNewton = False
        settings.solutionSettings.sensorsWritePeriod = period / steps
        settings.solutionSettings.writeSolutionToFile = False
        system.SolveDynamic(settings, solverType=exudyn.DynamicSolverType.TrapezoidalIndex2)
    data = [np.asarray(system.GetSensorStoredData(sensor)) for sensor in sensors]
    # The first rows belong to the initial values, where no force is known yet.
    rows = [found[found[:, 0] > 0.5 * period / steps] for found in data]
    # Exudyn counts the force upon the first of the two markers.
    joints = -np.stack([found[:, 1:3] for found in rows[:4]])
    return ExudynRun(speed * rows[0][:, 0], joints, -rows[4][:, 1])


def _model(exudyn: Any, machine: Machine, speed: float) -> tuple[Any, list[Any]]:
    """Return the assembled system and the sensors of its joints and drive."""
    item = import_module("exudyn.itemInterface")
    linkage = machine.linkage
    motion = linkage.motion(0.0, speed)
    system = exudyn.SystemContainer().AddSystem()
    ground = system.AddObject(item.ObjectGround())
    bodies, nodes = {}, {}
    for link in linkage.links:
        mass = machine.masses[link]
        centre = mass.along / mass.mass
        frame, place = motion.link(link), motion.point(link, centre)
        nodes[link] = system.AddNode(
            item.NodeRigidBody2D(
                referenceCoordinates=[*place.position, float(frame.angle)],
                initialVelocities=[*place.velocity, float(frame.speed)],
            )
        )
        body = item.ObjectRigidBody2D(
            mass=mass.mass,
            inertia=mass.inertia - mass.along * centre,
            nodeNumber=nodes[link],
        )
        bodies[link] = system.AddObject(body), centre

    def on(link: str, along: float) -> Any:
        number, centre = bodies[link]
        place = [along - centre, 0.0, 0.0]
        return system.AddMarker(item.MarkerBodyPosition(bodyNumber=number, localPosition=place))

    def fixed(x: float) -> Any:
        return system.AddMarker(
            item.MarkerBodyPosition(bodyNumber=ground, localPosition=[x, 0.0, 0.0])
        )

    crank, coupler, follower = linkage.links
    lengths = linkage.lengths
    pairs = (
        (fixed(0.0), on(crank, 0.0)),
        (on(crank, lengths[crank]), on(coupler, 0.0)),
        (on(coupler, lengths[coupler]), on(follower, lengths[follower])),
        (fixed(lengths["frame"]), on(follower, 0.0)),
    )
    joints = [
        system.AddObject(item.ObjectJointRevolute2D(markerNumbers=list(pair))) for pair in pairs
    ]
    joints.append(_drive(system, nodes[crank], speed))
    sensors = [
        system.AddSensor(
            item.SensorObject(
                objectNumber=joint,
                storeInternal=True,
                outputVariableType=exudyn.OutputVariableType.Force,
            )
        )
        for joint in joints
    ]
    system.Assemble()
    return system, sensors


def _drive(system: Any, node: Any, speed: float) -> Any:
    """Add the constraint that turns the crank at constant speed."""
    item = import_module("exudyn.itemInterface")
    ground = system.AddNode(item.NodePointGround())
    ends = [
        system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0)),
        system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=node, coordinate=2)),
    ]
    return system.AddObject(
        item.ObjectConnectorCoordinate(
            markerNumbers=ends,
            offsetUserFunction=lambda _, t, *__: speed * t,
            offsetUserFunction_t=lambda *_: speed,
        )
    )
