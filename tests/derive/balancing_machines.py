"""Machines that the rigid tests share: Smith's of Figs. 12-16, one of each linkage, random ones."""

from __future__ import annotations

import balancing_truth as truth
import numpy as np
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar
from elastolink.runtime.rigid import Bounds, MassDistribution, balance
from elastolink.runtime.rigid.machine import Machine


def smith():
    """Return the machine of Smith Figs. 12-16 and 20-23."""
    lengths, bars = truth.smith_bars()
    links = FourBar.links
    masses = {name: MassDistribution(*bar) for name, bar in zip(links, bars, strict=True)}
    return Machine(FourBar(*lengths), masses)


def crooked_bodies(linkage):
    """Return a body for each link of any linkage, its centre beside the link."""
    bodies = ((0.4, 0.03, 0.01, 0.002), (0.7, 0.15, -0.04, 0.006), (0.6, 0.1, 0.02, 0.004))
    return {
        link: MassDistribution.about_centre(*body)
        for link, body in zip(linkage.links, bodies, strict=True)
    }


def random_machine(rng):
    """Return a crank-rocker or double crank with links of any shape."""
    while True:
        lengths = rng.uniform(0.2, 1.0, 4)
        lengths[1] = 0.1
        try:
            linkage = FourBar(*lengths, assembly=str(rng.choice(["open", "crossed"])))
        except BadInput:
            continue
        if linkage.crank_turns:
            break
    bodies = {}
    for link in linkage.links:
        mass, along, across = rng.uniform([0.1, -0.5, -0.5], [2.0, 0.5, 0.5])
        bodies[link] = MassDistribution.about_centre(mass, along, across, rng.uniform(0.0, 0.2))
    return Machine(linkage, bodies)


def with_crank_counterweight(machine, speed):
    """Return the optimum of a counterweight on the crank, by the root mean square of the force."""
    return balance(
        machine,
        speed,
        weights={"shaking_force": 1.0},
        links=("crank",),
        bounds=Bounds(mass=50.0, offset=1.0),
        measure="rms",
    )


def nine_equations(machine, theta, speed, acceleration=0.0):
    """Return the forces of a machine by name from the 9 x 9 system."""
    linkage = machine.linkage
    masses = [
        (own.mass, own.along, own.across, own.inertia)
        for own in (machine.mass(link) for link in linkage.links)
    ]
    lengths = tuple(linkage.lengths.values())
    return truth.forces(lengths, masses, theta, speed, acceleration, linkage.branch)


def sampled_peaks(machine, theta, speed, acceleration=0.0):
    """Return the greatest magnitude of each force over the samples."""
    return {
        name: float(np.max(np.linalg.norm(v, axis=1) if v.ndim == 2 else np.abs(v)))
        for name, v in nine_equations(machine, theta, speed, acceleration).items()
    }
