"""Exudyn as a peer: its explicit method of order 6 on an equation that Python gives it."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import numpy as np

from .equation import Array, Equation
from .method import TooLongError, patient

Slope = Callable[[float, Array], Array]


def exudyn_rk67(equation: Equation, steps: float) -> Callable[[Array, Array], Array] | None:
    """Return Exudyn's RK67 with fixed steps a revolution; None where it is not installed."""
    if find_spec("exudyn") is None:
        return None

    def solve(start: Array, angles: Array) -> Array:
        inner = max(1, round(steps * (angles[1] - angles[0]) / (2.0 * np.pi)))
        found = integrated(patient(equation.slope(start.shape)), start.ravel(), angles, inner)
        return found.reshape(-1, *start.shape)

    return solve


def integrated(slope: Slope, start: Array, places: Array, inner: int) -> Array:
    """Return the states ``(places, m)`` at even places, with some steps between two of them."""
    exudyn = import_module("exudyn")
    item = import_module("exudyn.itemInterface")
    failed: list[Exception] = []

    def rate(_: Any, t: float, __: int, state: Any) -> Any:
        # Exudyn would print what is raised here, and go on.
        if failed:
            return np.zeros(len(start))
        try:
            return slope(t, np.asarray(state))
        except TooLongError as reason:
            failed.append(reason)
            return np.zeros(len(start))

    system = exudyn.SystemContainer().AddSystem()
    node = system.AddNode(
        item.NodeGenericODE1(
            referenceCoordinates=[0.0] * len(start),
            initialCoordinates=start.tolist(),
            numberOfODE1Coordinates=len(start),
        )
    )
    system.AddObject(item.ObjectGenericODE1(nodeNumbers=[node], rhsUserFunction=rate))
    sensor = system.AddSensor(
        item.SensorNode(
            nodeNumber=node,
            storeInternal=True,
            outputVariableType=exudyn.OutputVariableType.Coordinates,
        )
    )
    system.Assemble()
    with warnings.catch_warnings():
        # Its releases rename the settings, and warn of the names that all of them know.
        warnings.simplefilter("ignore", DeprecationWarning)
        settings = exudyn.SimulationSettings()
        own = settings.timeIntegration
        own.startTime, own.endTime = float(places[0]), float(places[-1])
        own.numberOfSteps = (len(places) - 1) * inner
        own.automaticStepSize = False
        own.verboseMode = 0
        settings.solutionSettings.sensorsWritePeriod = float(places[1] - places[0])
        settings.solutionSettings.writeSolutionToFile = False
        system.SolveDynamic(settings, solverType=exudyn.DynamicSolverType.RK67, showHints=False)
    if failed:
        raise failed[0]
    return np.asarray(system.GetSensorStoredData(sensor))[:, 1:]
