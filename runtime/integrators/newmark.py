"""Newmark's scheme and generalized-alpha for ``M q'' + G q' + H q = F``, as matrices of steps.

Displacement and velocity at the end of a step come from accelerations at both ends,

    q+ = q + h v + h^2 ((1/2 - beta) a + beta a+),   v+ = v + h ((1 - gamma) a + gamma a+)

(Aannaque 6.5).  Newmark's a is the acceleration that the equation gives.  Generalized-alpha (Chung
and Hulbert) carries one of its own,

    (1 - alpha_m) a+ + alpha_m a = (1 - alpha_f) q''+ + alpha_f q'',

q'' being that of the equation at the ends, so that the order stays 2 where the coefficients move.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from .protocol import Generator, OneStep

Array = NDArray[np.float64]


@dataclass(frozen=True)
class StepRule:
    """Parameters of a scheme in Newmark's family.

    Attributes
    ----------
    name : str
        ``newmark`` or ``generalized_alpha``.
    gamma, beta : float
        Weights of the new acceleration in velocity and displacement.
    alpha_m, alpha_f : float
        Weights of the old one; 0 of Newmark's scheme.
    """

    name: str
    gamma: float
    beta: float
    alpha_m: float = 0.0
    alpha_f: float = 0.0

    @property
    def carries_acceleration(self) -> bool:
        """Whether the state holds the acceleration as well."""
        return self.alpha_m != 0.0 or self.alpha_f != 0.0

    @property
    def words(self) -> str:
        """Name and parameters as text."""
        own = f"gamma = {self.gamma:.4g}, beta = {self.beta:.4g}"
        if not self.carries_acceleration:
            return f"Newmark, {own}"
        return f"generalized-alpha, alpha_m = {self.alpha_m:.4g}, alpha_f = {self.alpha_f:.4g}"


def newmark_rule(gamma: float = 0.5, beta: float = 0.25) -> StepRule:
    """Return Newmark's scheme.

    Raises
    ------
    BadInput
        If ``gamma`` is not from 0 to 2, or ``beta`` not from 0 to 1.
    """
    for name, value, top in (("gamma", gamma, 2.0), ("beta", beta, 1.0)):
        if not 0.0 <= value <= top:
            raise bad(name, value, f"a number from 0 to {top:g}", "choose 1/2 and 1/4")
    return StepRule("newmark", float(gamma), float(beta))


def generalized_alpha_rule(rho_inf: float = 0.9) -> StepRule:
    """Return generalized-alpha of order 2 with a given damping of the highest frequencies.

    Parameters
    ----------
    rho_inf : float
        Factor per step of a mode that steps do not resolve, 0 to 1; 1 damps nothing.

    Raises
    ------
    BadInput
        If ``rho_inf`` is not from 0 to 1.
    """
    if not 0.0 <= rho_inf <= 1.0:
        raise bad("rho_inf", rho_inf, "a number from 0 to 1", "choose 0.9")
    alpha_m = (2.0 * rho_inf - 1.0) / (rho_inf + 1.0)
    alpha_f = rho_inf / (rho_inf + 1.0)
    gamma = 0.5 - alpha_m + alpha_f
    beta = 0.25 * (1.0 - alpha_m + alpha_f) ** 2
    return StepRule("generalized_alpha", gamma, beta, alpha_m, alpha_f)


def acceleration(mass: Array, rate: Array, stiffness: Array, force: Array) -> Array:
    """Return q'' as matrices on (q, q', 1), ``(..., n, 2n + 1)``."""
    columns = np.concatenate([-stiffness, -rate, force[..., None]], axis=-1)
    value: Array = np.linalg.solve(mass, columns)
    return value


def step_maps(
    rule: StepRule, mass: Array, rate: Array, stiffness: Array, force: Array, step: float
) -> Array:
    """Return the matrices of steps between neighbouring angles.

    Parameters
    ----------
    rule : StepRule
        The scheme.
    mass, rate, stiffness : ndarray
        M, G, H at the ends of the steps, shape ``(N + 1, n, n)``.
    force : ndarray
        F there, shape ``(N + 1, n)``.
    step : float
        Length of a step.

    Returns
    -------
    ndarray
        On the state (q, q', 1), or (q, q', a, 1) where the scheme carries its acceleration;
        shape ``(N, m, m)``.
    """
    n = mass.shape[-1]
    own = acceleration(mass, rate, stiffness, force)
    count = len(own) - 1
    blocks = 3 if rule.carries_acceleration else 2
    m = blocks * n + 1
    q, v, a, now = (np.zeros((count, n, m)) for _ in range(4))
    place = np.arange(n)
    q[:, place, place] = 1.0
    v[:, place, n + place] = 1.0
    now[..., : 2 * n], now[..., -1] = own[:-1, :, :-1], own[:-1, :, -1]
    if blocks == 3:
        a[:, place, 2 * n + place] = 1.0
    else:
        a = now
    q = q + step * v + (0.5 - rule.beta) * step**2 * a
    v = v + (1.0 - rule.gamma) * step * a
    mass1, rate1, stiffness1 = mass[1:], rate[1:], stiffness[1:]
    free = 1.0 - rule.alpha_f
    right = -free * (rate1 @ v + stiffness1 @ q)
    right[..., -1] += free * force[1:]
    if blocks == 3:
        right += mass1 @ (rule.alpha_f * now - rule.alpha_m * a)
    system = (1.0 - rule.alpha_m) * mass1 + free * (
        rule.gamma * step * rate1 + rule.beta * step**2 * stiffness1
    )
    new = np.linalg.solve(system, right)
    out: Array = np.zeros((count, m, m))
    out[:, :n] = q + rule.beta * step**2 * new
    out[:, n : 2 * n] = v + rule.gamma * step * new
    if blocks == 3:
        out[:, 2 * n : 3 * n] = new
    out[:, -1, -1] = 1.0
    return out


def _one_step(rule: StepRule) -> OneStep:
    def maps(generator: Generator, theta: Array, step: float) -> Array:
        raise bad(rule.name, "a first-order form", "M q'' + G q' + H q = F", "use step_maps")

    return OneStep(rule.name, order=2, maps=maps, explicit=False, symplectic=False)


# Schemes that take the second-order form itself, by name, and their parameters unless told others.
RULES: Mapping[str, StepRule] = MappingProxyType(
    {rule.name: rule for rule in (newmark_rule(), generalized_alpha_rule())}
)
SECOND_ORDER: Mapping[str, OneStep] = MappingProxyType(
    {name: _one_step(rule) for name, rule in RULES.items()}
)
