"""Tolerances of lengths and masses: what they do to the motion and to the forces."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import BadInput, Problem, bad
from ..core.results import Check, DeferredChecks, provenance
from . import FourBar, Linkage
from ._box import box_of, margin, turns
from .inputs import drive_of
from .subject import ANGLE, Subject
from .tolerance_result import Tolerances

if TYPE_CHECKING:
    from ..rigid import Machine

Array = NDArray[np.float64]
Masses = Literal["fixed", "bars"]
_EPS = float(np.finfo(float).eps)
# The two routes to the sensitivities may differ by so much of their largest value.
_ROUTES = 1e-9
# What round-off does to a worst case, in units of the last place, away from the folds.
_ROUNDING = 64.0
_SCALE_FREE = ("theta3", "theta4", "omega3", "omega4", "alpha3", "alpha4")


def tolerances(
    linkage_or_machine: Linkage | Machine,
    tolerance: Mapping[str, float],
    theta: ArrayLike | None = None,
    speed: ArrayLike = 1.0,
    acceleration: ArrayLike = 0.0,
    *,
    masses: Masses = "fixed",
) -> Tolerances:
    """Return what tolerances of lengths and masses do to motion and forces.

    The sensitivities are derivatives, not differences: of a four-bar's angles, speeds and
    accelerations in closed form, from the loop closure (Smith 2.1) differentiated by each length;
    of everything else by the rules of differentiation applied to the emitted functions (of forces,
    Smith 4.7-4.13).

    Parameters
    ----------
    linkage_or_machine : FourBar, SliderCrank, QuickReturn or Machine
        A linkage for the motion alone, a machine for motion and forces.
    tolerance : mapping of str to float
        Greatest deviation of each length [m] from its nominal value, by name; ``"theta2"`` for the
        crank angle [rad]; of a machine also ``"coupler.mass"`` [kg], ``"coupler.along"``,
        ``"coupler.across"`` [kg m], ``"coupler.inertia"`` [kg m^2] and so on.  What is not named is
        exact.
    theta : array_like, optional
        Crank angles [rad]; by default 361 over a turn.
    speed, acceleration : array_like
        Crank speed [rad/s] and acceleration [rad/s^2]; they broadcast with ``theta``.  By default
        rates are over the crank speed and its square.
    masses : {"fixed", "bars"}
        Whether the masses stay as they are when a length changes, or grow with it as those of a
        bar stretched along the link: mass with the length, first moment along the link with its
        square, inertia with its cube.  Loads and springs stay at their places in the links.

    Returns
    -------
    Tolerances
        Check "both routes": for a four-bar, the closed form against the rules of differentiation.

    Raises
    ------
    BadInput
        If a name is unknown or a tolerance is no finite number of zero or more; if a linkage within
        the tolerances could fold at a crank angle or not reach it, with the angle and the length
        that brings it about; if the machine has loads that are functions.

    Examples
    --------
    >>> from elastolink import FourBar
    >>> found = tolerances(FourBar(0.5, 0.1, 0.5, 0.2), {"crank": 1e-4}, theta=[0.0, 1.0])
    >>> found.worst_case.shape
    (7, 2)
    """
    linkage, machine = _parts(linkage_or_machine)
    if masses not in ("fixed", "bars"):
        raise bad("masses", repr(masses)[:60], "'fixed' or 'bars'", "choose one")
    if theta is None:
        theta = np.linspace(0.0, 2.0 * np.pi, 361)
    angles, drive = drive_of(theta, speed, acceleration)
    angles = np.array(np.broadcast_to(angles, drive[0].shape))
    subject = Subject(linkage, machine, angles, *drive, masses == "bars")
    subject.require_loads()
    sizes = _checked(subject, tolerance)
    linkage.motion(angles)  # refuses what it does not reach
    _require_reach(linkage, sizes, angles)
    return _found(subject, sizes)


def _found(subject: Subject, sizes: Mapping[str, float]) -> Tolerances:
    """Return the result for tolerances within which every linkage moves.

    Raises
    ------
    BadInput
        If a number is not finite.
    """
    parameters, names = tuple(subject.values), subject.outputs
    nominal, slopes = subject.derivatives(subject.values, parameters)
    by_rules = np.stack([slopes[name] for name in names])
    if isinstance(subject.linkage, FourBar):
        _in_closed_form(subject, slopes)
    values = np.stack([nominal[name] for name in names])
    sensitivity = np.stack([slopes[name] for name in names])
    if not (np.all(np.isfinite(values)) and np.all(np.isfinite(sensitivity))):
        fix = "use other units, or keep the angles off the folds"
        raise bad("tolerances", "numbers beyond the largest float", "finite ones", fix)
    return Tolerances(
        theta2=subject.theta,
        omega2=subject.speed,
        alpha2=subject.acceleration,
        outputs=names,
        parameters=parameters,
        nominal=values,
        sensitivity=sensitivity,
        tolerance=np.array([sizes.get(name, 0.0) for name in parameters]),
        keeps_turning=turns(box_of(subject.linkage.lengths, sizes)),
        subject=subject,
        method="derivatives of the closed form",
        error=_remainder(subject, sizes, slopes),
        error_norm="worst case of each output, absolute, entrywise",
        error_kind="estimate",
        checks=DeferredChecks(partial(_checks, subject, sensitivity, by_rules)),
        provenance=provenance(_told(subject, sizes)),
    )


def _parts(given: Any) -> tuple[Linkage, Machine | None]:
    if isinstance(given, Linkage):
        return given, None
    from ..rigid import Machine

    if isinstance(given, Machine):
        return given.linkage, given
    raise bad("tolerances", repr(given)[:60], "a linkage or a Machine", "give a FourBar, say")


def _checked(subject: Subject, tolerance: object) -> dict[str, float]:
    """Return the tolerances as floats.

    Raises
    ------
    BadInput
        If a name is unknown, or a number is not finite, negative, or as large as its length.
    """
    if not isinstance(tolerance, Mapping):
        found = type(tolerance).__name__
        raise bad("tolerance", found, "a mapping from name to number", "write {'crank': 1e-4}")
    known, problems = subject.values, []
    limits = {name: size for name, size in subject.linkage.lengths.items() if name != "offset"}
    limits[ANGLE] = math.pi / 2.0
    for name, width in tolerance.items():
        where = f"tolerance[{name!r}]"
        if name not in known:
            fix = "correct the name; masses need a Machine"
            problems.append(Problem(where, repr(name), f"one of {', '.join(known)}", fix))
        elif not _is_width(width):
            problems.append(Problem(where, repr(width)[:60], "zero or more", "correct it"))
        elif width >= limits.get(name, math.inf):
            what = "a quarter turn" if name == ANGLE else "the length"
            expected = f"less than {what}, {limits[name]:g}"
            problems.append(Problem(where, f"{width:g}", expected, "narrow it"))
    if problems:
        raise BadInput(*problems)
    return {str(name): float(width) for name, width in tolerance.items()}


def _is_width(width: Any) -> bool:
    number = isinstance(width, (int, float, np.integer, np.floating))
    return number and not isinstance(width, bool) and bool(0 <= width < math.inf)


def _require_reach(linkage: Linkage, sizes: Mapping[str, float], theta: Array) -> None:
    """Raise BadInput where a linkage within the tolerances cannot reach an angle."""

    def left(widths: Mapping[str, float], angles: Array) -> Array:
        return margin(box_of(linkage.lengths, widths), angles, widths.get(ANGLE, 0.0))

    named = [name for name, width in sizes.items() if width > 0.0]
    found = np.ravel(left(sizes, theta))
    # Without a tolerance the linkage reaches its angles, whatever round-off says here.
    if not named or found.size == 0 or np.all(found > 0.0):
        return
    worst = int(np.argmin(found))
    angle = np.ravel(theta)[worst : worst + 1]
    blamed = max(named, key=lambda name: float(left({**sizes, name: 0.0}, angle)[0]))
    raise bad(
        f"tolerance[{blamed!r}]",
        f"a linkage within the tolerances that cannot reach {angle[0]:.6g} rad, or folds",
        f"tolerances that leave {-found[worst]:.3g} m more to the fold",
        f"narrow them, that of the {blamed} first, or keep theta farther from the fold",
    )


def _in_closed_form(subject: Subject, slopes: dict[str, Array]) -> None:
    """Put the emitted derivatives in the place of those by the rules."""
    from ...derive.spec import ModelSpec
    from ..core.modules import find_module

    module = find_module(ModelSpec(subject.mechanism, "sensitivities")).module
    linkage = subject.linkage
    given = {name: size * subject.scale for name, size in linkage.lengths.items()}
    with np.errstate(all="ignore"):
        values = module.sensitivities(subject.theta, **given, assembly=linkage.branch)
    found = dict(zip(module.RETURNS["sensitivities"], values, strict=True))
    for link, (place, name) in itertools.product("34", enumerate((*subject.lengths, ANGLE))):
        scale = 1.0 if name == ANGLE else subject.scale
        turn, w, a = (found[f"{q}{link}_by_{name}"] * scale for q in ("theta", "omega", "alpha"))
        slopes["theta" + link][place] = turn
        slopes["omega" + link][place] = w * subject.speed
        slopes["alpha" + link][place] = a * subject.speed**2 + w * subject.acceleration


def _remainder(subject: Subject, sizes: Mapping[str, float], slopes: dict[str, Array]) -> Array:
    """Return what the first order may leave out within the tolerances, shape (outputs, ...).

    With f the output, s its gradient and d a deviation, f(d) - f(0) - s(0) d is the mean of
    (s(u d) - s(0)) d over u from 0 to 1.  Masses enter linearly, so that corners of the lengths
    and the crank angle suffice for their sensitivities too.
    """
    names = tuple(name for name, width in sizes.items() if width > 0.0)
    moved = [name for name in names if name in (*subject.lengths, ANGLE)]
    parameters = list(subject.values)
    rows = [parameters.index(name) for name in names]
    here = {output: slopes[output][rows] for output in subject.outputs}
    widths = np.reshape([sizes[name] for name in names], (-1,) + (1,) * subject.theta.ndim)
    worst = np.zeros((len(subject.outputs), *subject.theta.shape))
    for signs in itertools.product((-1.0, 1.0), repeat=len(moved)) if moved else ():
        there = dict(subject.values)
        for name, sign in zip(moved, signs, strict=True):
            there[name] += sign * sizes[name]
        _, other = subject.derivatives(there, names)
        changes = [np.sum(widths * np.abs(other[o] - here[o]), axis=0) for o in subject.outputs]
        worst = np.maximum(worst, np.stack(changes))
    first = np.stack([np.sum(widths * np.abs(here[o]), axis=0) for o in subject.outputs])
    return np.asarray(worst + _ROUNDING * _EPS * first)


def _checks(subject: Subject, chosen: Array, other: Array) -> dict[str, Check]:
    """Compare the two routes; and the sensitivities to a common scale of all lengths (Euler)."""
    count = len(subject.lengths)
    sizes = np.reshape(list(subject.linkage.lengths.values()), (-1,) + (1,) * subject.theta.ndim)
    terms = chosen[:, :count] * sizes
    size = np.sum(np.abs(terms), axis=1)
    angles = [row for row, name in enumerate(subject.outputs) if name in _SCALE_FREE]
    gap = np.abs(np.sum(terms, axis=1))[angles]
    found = _largest_ratio(gap, size[angles])
    checks = {"a common factor of all lengths leaves the angles": Check(found, _ROUTES)}
    if isinstance(subject.linkage, FourBar):
        gap = np.sum(np.abs((chosen - other)[:, :count] * sizes), axis=1)
        checks["both routes to the sensitivities"] = Check(_largest_ratio(gap, size), _ROUTES)
    return checks


def _largest_ratio(gap: Array, scale: Array) -> float:
    """Return the largest quotient along the crank angles, each output over its own largest size."""
    rows = tuple(range(1, gap.ndim))
    most = np.max(gap, axis=rows, initial=0.0)
    size = np.maximum(np.max(scale, axis=rows, initial=0.0), np.finfo(float).tiny)
    return float(np.max(most / size, initial=0.0))


def _told(subject: Subject, sizes: Mapping[str, float]) -> dict[str, str]:
    lengths = subject.linkage.lengths.items()
    told = {f"links.{name}": repr(float(size)) for name, size in lengths}
    told["links.assembly"] = str(getattr(subject.linkage, "assembly", ""))
    return told | {f"tolerance.{name}": repr(width) for name, width in sizes.items()}
