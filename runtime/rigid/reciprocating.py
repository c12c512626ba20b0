"""Partial balance of a slider-crank by a counterweight on its crank alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from ..core.errors import bad
from ..core.results import Check, Result, provenance
from .barrier import Array
from .cases import moment
from .counterweights import Counterweight, finite_number, require_machine, with_counterweights

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from . import Machine

_ANGLES = 1024
_ORDERS = 9
_AGREES = 1e-9


@dataclass(frozen=True, kw_only=True)
class ReciprocatingBalance(Result):
    """What a crank counterweight leaves of a slider-crank's shaking force, harmonic by harmonic.

    Attributes
    ----------
    counterweights : mapping of str to Counterweight
        That of the crank.
    machine : Machine
        With it.
    fraction : float
        Share of the reciprocating mass that is balanced.
    reciprocating_mass, rotating_moment : float
        The slider and the coupler's share at C [kg]; first moment of the crank and the coupler's
        share at B [kg m].
    order : ndarray
        Orders of the harmonics of the crank angle, from 0.
    along, across : ndarray
        Their amplitudes [N] in the shaking force, along the guide and across it.
    theta2 : ndarray
        Crank angles [rad] of the two forces below.
    unbalanced_force, balanced_force : ndarray, shape (n, 2)
        Shaking force [N] without and with the counterweight.
    """

    counterweights: dict[str, Counterweight]
    machine: Machine
    fraction: float
    reciprocating_mass: float
    rotating_moment: float
    order: Array
    along: Array
    across: Array
    theta2: Array
    unbalanced_force: Array
    balanced_force: Array

    dimensions: ClassVar[dict[str, tuple[str, ...]]] = {
        **dict.fromkeys(("order", "along", "across"), ("order",)),
        "theta2": ("angle",),
        "unbalanced_force": ("angle", "component"),
        "balanced_force": ("angle", "component"),
    }

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw both shaking forces as polar diagrams, as Smith's Fig. 21."""
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        for force, label in (
            (self.unbalanced_force, "unbalanced"),
            (self.balanced_force, f"fraction {self.fraction:g}"),
        ):
            ax.plot(force[:, 0], force[:, 1], label=label)
        ax.set_aspect("equal", adjustable="datalim")
        ax.set_xlabel("force on the frame along the guide [N]")
        ax.set_ylabel("across [N]")
        ax.legend()
        return ax


def reciprocating_balance(
    machine: Machine, speed: float, fraction: float = 0.5, offset: float | None = None
) -> ReciprocatingBalance:
    """Return a slider-crank whose crank counterweight balances a share of the reciprocating mass.

    The coupler counts as two masses, at B and C, with its mass and its centre (exact for the
    shaking force).  What rotates is balanced wholly; of the primary force ``m r omega^2 cos
    theta`` of what reciprocates, the share is turned from the guide's direction across it.  Higher
    orders stay: a crank counterweight cannot reach them.  The fraction with the least peak is
    ``balance(machine, speed, weights={"shaking_force": 1}, links=["crank"])``.

    Parameters
    ----------
    machine : Machine
        A slider-crank.
    speed : float
        Crank speed [rad/s].
    fraction : float
        From 0 to 1, or beyond.
    offset : float, optional
        Distance [m] of the counterweight from the crank's pivot; by default the crank length.

    Returns
    -------
    ReciprocatingBalance
        With the check that the change is of first order alone.

    Raises
    ------
    BadInput
        If the linkage is no slider-crank or its crank cannot turn, or a number is impossible.
    """
    require_machine(machine)
    linkage = machine.linkage
    if tuple(linkage.links)[-1] != "slider":
        raise bad("machine", type(linkage).__name__, "a SliderCrank", "use balance_case")
    linkage.require_full_turn()
    radius = float(linkage.lengths["crank"])
    offset = radius if offset is None else offset
    speed, fraction = finite_number(speed, "speed"), finite_number(fraction, "fraction")
    offset = finite_number(offset, "offset")
    if not offset > 0.0:
        raise bad("offset", f"{offset:g}", "a distance above zero", "correct it")
    coupler = machine.mass("coupler")
    at_c = moment(machine, "coupler") / linkage.lengths["coupler"]
    rotating = moment(machine, "crank") + (coupler.mass - at_c) * radius
    reciprocating = machine.mass("slider").mass + at_c.real
    # An uneven share at C (a centre beside the line BC) is no mass: it stays out of the fraction.
    wanted = -(rotating + fraction * reciprocating * radius)
    added = {}
    if wanted:
        place = offset * wanted / abs(wanted)
        added["crank"] = Counterweight("crank", abs(wanted) / offset, place.real, place.imag)
    balanced = with_counterweights(machine, added.values())
    theta = 2.0 * np.pi * np.arange(_ANGLES) / _ANGLES
    before, after = (_shaking_force(item, theta, speed) for item in (machine, balanced))
    spectrum = np.fft.rfft(after, axis=0)
    amplitude = np.abs(spectrum) / _ANGLES
    amplitude[1:] *= 2.0
    tail = float(amplitude[-_ANGLES // 8 :].max(initial=0.0))
    changed = np.abs(np.fft.rfft(after - before, axis=0))
    rest = np.delete(changed, 1, axis=0).max() / max(changed.max(), np.finfo(float).tiny)
    scale = max(float(np.abs(before).max()), np.finfo(float).tiny)
    return ReciprocatingBalance(
        counterweights=added,
        machine=balanced,
        fraction=fraction,
        reciprocating_mass=float(reciprocating),
        rotating_moment=float(abs(rotating)),
        order=np.arange(_ORDERS, dtype=float),
        along=amplitude[:_ORDERS, 0],
        across=amplitude[:_ORDERS, 1],
        theta2=theta,
        unbalanced_force=before,
        balanced_force=after,
        method="closed form; harmonics by FFT",
        error=tail + 16.0 * np.finfo(float).eps * scale,
        error_norm="amplitude of a harmonic [N], absolute",
        checks={"change beside the first order, relative": Check(float(rest), _AGREES)},
        provenance=provenance({"speed": repr(speed)}),
    )


def _shaking_force(machine: Machine, theta: Array, speed: float) -> Array:
    from .forces import rigid_forces

    return np.asarray(rigid_forces(machine, theta, speed, outputs=("shaking_force",)).shaking_force)
