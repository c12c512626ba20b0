"""A linkage of beams in Exudyn, as one of its users would build it: geometrically exact cables.

Its ``ObjectANCFCable2D`` has the exact strain of the axis, ``|r'| - 1``, and the exact curvature,
``(r' x r'') / |r'|^2``; it takes places and slopes of its ends, has no shear, and damps the rates
of both strains.  Pins are equal displacements of two nodes, the clamp on the shaft a prescribed
slope, joint masses points of their own.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Start:
    """Motion at crank angle 0 along each beam: places, slopes and their rates, ``(n + 1, 4)``."""

    places: dict[str, np.ndarray]
    rates: dict[str, np.ndarray]


def start_of(structure, q, qd, speed, elements):
    """Return the state at crank angle 0 of displacements q and rates qd of a finer mesh.

    The places of ``elements`` equal parts must be nodes of the structure.
    """
    motion = structure.configuration(np.zeros(1))
    places, rates = {}, {}
    for beam in structure.beams:
        link = motion[beam.name]
        turn, spin = link.angle[0], speed * link.speed[0]
        c, s = np.cos(turn), np.sin(turn)
        rows, moved = [], []
        for k in range(elements + 1):
            along = beam.length * k / elements
            point = link.point(along)
            fine = int(np.argmin(np.abs(beam.places - along)))
            assert abs(beam.places[fine] - along) < 1e-12
            # Stretch is left to the solver: it is of the order 1e-7 here.
            d, e = (_at(structure, beam, fine, values) for values in (q, qd))
            rows.append([*(point.position[0] + d[:2]), c - s * d[2], s + c * d[2]])
            rate = speed * point.velocity[0] + e[:2]
            turning = [-(s + c * d[2]) * spin - s * e[2], (c - s * d[2]) * spin + c * e[2]]
            moved.append([*rate, *turning])
        places[beam.name], rates[beam.name] = np.array(rows), np.array(moved)
    return Start(places, rates)


def _at(structure, beam, k, values):
    """Return x, y and rotation of a node of the mesh."""
    node = {0: beam.start, len(beam.places) - 1: beam.end}.get(k)
    names = [f"{beam.name}.{k}.{part}" for part in ("x", "y", "rotation")]
    if node:
        names = [f"{node}.x", f"{node}.y", f"{node}.{beam.name}"]
    labels = structure.labels
    return np.array([values[labels.index(n)] if n in labels else 0.0 for n in names])


def displacements(structure, q, elements):
    """Return displacements of q ``(nt, n)`` at equal parts: by beam ``(nt, elements + 1, 2)``."""
    found = {}
    for beam in structure.beams:
        step = (len(beam.places) - 1) // elements
        rows = [
            [_at(structure, beam, k * step, values)[:2] for k in range(elements + 1)]
            for values in q
        ]
        found[beam.name] = np.array(rows)
    return found


def simulate(structure, start, speed, revolutions, steps):
    """Return crank angles and places of all nodes: ``(nt,)``, by beam ``(nt, n + 1, 2)``.

    The crank is the beam clamped at A.  By the trapezoidal rule, ``steps`` a revolution.
    """
    exudyn = import_module("exudyn")
    with warnings.catch_warnings():
        # Names of its settings change between versions, with a warning first.
        warnings.simplefilter("ignore", DeprecationWarning)
        system, sensors = _model(exudyn, structure, start, speed)
        period = 2.0 * np.pi / speed
        settings = exudyn.SimulationSettings()
        settings.timeIntegration.numberOfSteps = steps * revolutions
        settings.timeIntegration.endTime = period * revolutions
        settings.timeIntegration.verboseMode = 0
        settings.timeIntegration.newton.useModifiedNewton = False
        settings.timeIntegration.newton.relativeTolerance = 1e-10
        settings.timeIntegration.newton.absoluteTolerance = 1e-10
        settings.solutionSettings.sensorsWritePeriod = period / 64
        settings.solutionSettings.writeSolutionToFile = False
        done = system.SolveDynamic(settings, solverType=exudyn.DynamicSolverType.TrapezoidalIndex2)
        assert done
    stored = {
        name: np.stack([np.asarray(system.GetSensorStoredData(s)) for s in found], axis=1)
        for name, found in sensors.items()
    }
    times = next(iter(stored.values()))[:, 0, 0]
    return speed * times, {name: data[:, :, 1:3] for name, data in stored.items()}


def _model(exudyn: Any, structure, start, speed):
    item = import_module("exudyn.itemInterface")
    system = exudyn.SystemContainer().AddSystem()
    nodes = {b.name: _beam(item, system, b, start, structure) for b in structure.beams}
    still = system.AddNode(item.NodePointGround())
    ground = system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=still, coordinate=0))

    def coordinate(node, i):
        return system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=node, coordinate=i))

    for node in structure.nodes:
        ends = [
            nodes[b.name][0 if b.start == node.name else -1]
            for b in structure.beams
            if node.name in (b.start, b.end)
        ]
        if node.mass:
            place, rate = _end(structure, node.name, start)
            free = system.AddNode(
                item.NodePoint2D(
                    referenceCoordinates=_rigid(structure, node.name),
                    initialCoordinates=place - _rigid(structure, node.name),
                    initialVelocities=rate,
                )
            )
            system.AddObject(item.ObjectMassPoint2D(physicsMass=node.mass, nodeNumber=free))
            ends.append(free)
        for i, part in enumerate(("x", "y")):
            if part in node.held:
                pairs = [(ground, coordinate(end, i)) for end in ends]
            else:
                pairs = [(coordinate(ends[0], i), coordinate(end, i)) for end in ends[1:]]
            for pair in pairs:
                system.AddObject(item.CoordinateConstraint(markerNumbers=list(pair)))
        if "rotation" in node.held:
            _drive(item, system, ground, [coordinate(ends[0], i) for i in (2, 3)], speed)
    sensors = {
        name: [
            system.AddSensor(
                item.SensorNode(
                    nodeNumber=node,
                    storeInternal=True,
                    outputVariableType=exudyn.OutputVariableType.Position,
                )
            )
            for node in found
        ]
        for name, found in nodes.items()
    }
    system.Assemble()
    return system, sensors


def _beam(item, system, beam, start, structure):
    link = structure.configuration(np.zeros(1))[beam.name]
    axis = [np.cos(link.angle[0]), np.sin(link.angle[0])]
    moved, rates = start.places[beam.name], start.rates[beam.name]
    count, section = len(moved) - 1, beam.section
    found = []
    for k in range(count + 1):
        place = [*link.point(beam.length * k / count).position[0], *axis]
        found.append(
            system.AddNode(
                item.NodePoint2DSlope1(
                    referenceCoordinates=place,
                    initialCoordinates=list(moved[k] - place),
                    initialVelocities=list(rates[k]),
                )
            )
        )
    for k in range(count):
        system.AddObject(
            item.ObjectANCFCable2D(
                physicsLength=beam.length / count,
                physicsMassPerLength=section.mass_per_length,
                physicsBendingStiffness=section.bending_stiffness,
                physicsAxialStiffness=section.axial_stiffness,
                physicsBendingDamping=section.retardation * section.bending_stiffness,
                physicsAxialDamping=section.retardation * section.axial_stiffness,
                nodeNumbers=found[k : k + 2],
                useReducedOrderIntegration=0,
            )
        )
    return found


def _rigid(structure, node):
    return structure.places(np.zeros(1))[node][0]


def _end(structure, node, start):
    beam = next(b for b in structure.beams if node in (b.start, b.end))
    k = 0 if beam.start == node else -1
    return start.places[beam.name][k, :2], start.rates[beam.name][k, :2]


def _drive(item, system, ground, slopes, speed):
    """Turn a slope with the shaft."""
    turns = (
        (lambda t: np.cos(speed * t) - 1.0, lambda t: -speed * np.sin(speed * t)),
        (lambda t: np.sin(speed * t), lambda t: speed * np.cos(speed * t)),
    )
    for marker, (value, rate) in zip(slopes, turns, strict=True):
        system.AddObject(
            item.ObjectConnectorCoordinate(
                markerNumbers=[ground, marker],
                offsetUserFunction=partial(_timed, value),
                offsetUserFunction_t=partial(_timed, rate),
            )
        )


def _timed(function, _system, t, *_):
    return function(t)
