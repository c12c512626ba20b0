"""The rod as an Exudyn user would build it: a geometrically exact cable in a sliding joint."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from rod_reference import flexible, kinematics
from rod_tip_deflections import TIPS

AREA_STIFFNESS = 0.7e11 * 0.05**2


def _cable(item, system, rod, elements):
    """Add a cable along x that turns with the line to the block; return its nodes and bodies."""
    turning = kinematics(rod, 0.0)[2] * rod.speed
    step = rod.length / elements
    nodes = [
        system.AddNode(
            item.NodePoint2DSlope1(
                referenceCoordinates=[k * step, 0, 1, 0],
                initialVelocities=[0, k * step * turning, 0, turning],
            )
        )
        for k in range(elements + 1)
    ]
    bodies = [
        system.AddObject(
            item.ObjectANCFCable2D(
                physicsLength=step,
                physicsMassPerLength=rod.mass_per_length,
                physicsBendingStiffness=rod.bending_stiffness,
                physicsAxialStiffness=AREA_STIFFNESS,
                nodeNumbers=nodes[k : k + 2],
                useReducedOrderIntegration=0,
            )
        )
        for k in range(elements)
    ]
    return nodes, bodies


def _block(item, system, rod, ground):
    """Add the block, driven round the crank's circle; return its marker."""
    reach, speed = rod.crank, rod.speed
    node = system.AddNode(
        item.NodePoint2D(
            referenceCoordinates=[rod.frame + reach, 0], initialVelocities=[0, reach * speed]
        )
    )
    body = system.AddObject(item.ObjectMassPoint2D(physicsMass=1e-3, nodeNumber=node))
    motions = (
        (
            lambda _, t, *__: reach * (np.cos(speed * t) - 1),
            lambda _, t, *__: -reach * speed * np.sin(speed * t),
        ),
        (
            lambda _, t, *__: reach * np.sin(speed * t),
            lambda _, t, *__: reach * speed * np.cos(speed * t),
        ),
    )
    for axis, (place, rate) in enumerate(motions):
        held = system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=node, coordinate=axis))
        system.AddObject(
            item.ObjectConnectorCoordinate(
                markerNumbers=[ground, held], offsetUserFunction=place, offsetUserFunction_t=rate
            )
        )
    return system.AddMarker(item.MarkerBodyPosition(bodyNumber=body))


def _tips(exudyn, item, rod, elements, steps):
    """Return v(L)/L at eight crank angles of the first revolution, by the trapezoidal rule."""
    system = exudyn.SystemContainer().AddSystem()
    nodes, bodies = _cable(item, system, rod, elements)
    ground = system.AddMarker(
        item.MarkerNodeCoordinate(nodeNumber=system.AddNode(item.NodePointGround()), coordinate=0)
    )
    for axis in (0, 1):
        pin = system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=nodes[0], coordinate=axis))
        system.AddObject(item.CoordinateConstraint(markerNumbers=[ground, pin]))
    block = _block(item, system, rod, ground)
    markers = [system.AddMarker(item.MarkerBodyCable2DCoordinates(bodyNumber=b)) for b in bodies]
    place = kinematics(rod, 0.0)[0] * rod.length
    first = int(place / rod.length * elements)
    data = system.AddNode(
        item.NodeGenericData(initialCoordinates=[first, place], numberOfDataCoordinates=2)
    )
    system.AddObject(
        item.ObjectJointSliding2D(
            markerNumbers=[block, markers[first]],
            slidingMarkerNumbers=markers,
            slidingMarkerOffsets=[k * rod.length / elements for k in range(elements)],
            nodeNumber=data,
            classicalFormulation=False,
        )
    )
    sensor = system.AddSensor(
        item.SensorNode(
            nodeNumber=nodes[-1],
            storeInternal=True,
            outputVariableType=exudyn.OutputVariableType.Position,
        )
    )
    system.Assemble()
    settings = exudyn.SimulationSettings()
    period = 2 * np.pi / rod.speed
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = period
    settings.timeIntegration.verboseMode = 0
    # Tighter ones are not reached: its Newton iteration stalls near 1e-7.
    settings.timeIntegration.newton.relativeTolerance = 2e-6
    settings.timeIntegration.newton.absoluteTolerance = 1e-8
    settings.solutionSettings.sensorsWritePeriod = period / 8
    settings.solutionSettings.writeSolutionToFile = False
    # The default generalized-alpha rule rings from its start.
    system.SolveDynamic(settings, solverType=exudyn.DynamicSolverType.TrapezoidalIndex2)
    found = np.asarray(system.GetSensorStoredData(sensor))[-8:]
    line = np.arctan2(
        rod.crank * np.sin(rod.speed * found[:, 0]),
        rod.frame + rod.crank * np.cos(rod.speed * found[:, 0]),
    )
    return (np.cos(line) * found[:, 2] - np.sin(line) * found[:, 1]) / rod.length


def test_a_cable_through_a_sliding_joint_moves_alike():
    exudyn = pytest.importorskip("exudyn")
    item = pytest.importorskip("exudyn.itemInterface")

    exact = TIPS["flexible, ratio 0.01, 100 rad/s", True][1][:8]
    with warnings.catch_warnings():
        # Names of its settings change between versions, with a warning first.
        warnings.simplefilter("ignore", DeprecationWarning)
        errors = [
            np.max(np.abs(_tips(exudyn, item, flexible(0.01, 100.0), 8, steps) - exact))
            for steps in (200, 400, 800)
        ]
    errors = np.array(errors) / np.max(np.abs(exact))
    # Second order in the steps, until eight elements and the axial waves of the cable show.
    assert errors[1] < errors[0] / 2 and errors[2] < errors[1] / 1.5, errors
    assert errors[2] < 5e-3
