"""Tolerances of lengths and masses: what they do to the motion and to the forces."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import Problem, bad, refuse, shown
from ..core.inputs import is_finite, is_one_of, is_whole
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check, DeferredChecks, Result, provenance
from .linkage import EPS, Array, Linkage, drive_of
from .parametric import ANGLE, Parametric

if TYPE_CHECKING:
    from ..rigid.machine import Machine

Masses = Literal["fixed", "bars"]
Distribution = Literal["normal", "uniform"]
Limits: TypeAlias = tuple[float, float]
Box: TypeAlias = Mapping[str, Limits]

_SCALE_FREE = ("theta3", "theta4", "omega3", "omega4", "alpha3", "alpha4")
_SYMBOLS = {"theta3": r"$\theta_3$", "theta4": r"$\theta_4$"}

# Standard deviations over the tolerance.
_SPREADS = {"normal": 1.0 / 3.0, "uniform": 1.0 / math.sqrt(3.0)}


@dataclass(frozen=True, kw_only=True)
class Tolerances(Result):
    """What tolerances do to the motion, and for a machine to the forces, to first order.

    ``error``, shape (outputs, ...), is that of ``worst_case``: a bound of what the first
    order leaves out anywhere within the tolerances, from the exact sensitivities at the corners of
    the box that they span; it rests on the sensitivities being extreme at a corner.  The same
    holds for the deviation of any single linkage within the tolerances from its prediction.

    Attributes
    ----------
    theta2, omega2, alpha2 : ndarray, shape (...)
        Crank angle [rad], speed [rad/s] and acceleration [rad/s^2].
    outputs, parameters : tuple of str
        Names: ``theta3``, ``omega4``, ``x34``, ``torque`` ...; ``frame``, ``crank`` ..., the crank
        angle ``theta2``, and of a machine ``coupler.mass``, ``coupler.along`` ...
    nominal : ndarray, shape (outputs, ...)
        The values without deviations, in the units of :meth:`unit`.
    sensitivity : ndarray, shape (outputs, parameters, ...)
        Derivatives of every output by every parameter, the other parameters being fixed.
    tolerance : ndarray, shape (parameters,)
        Greatest deviation of each parameter from its nominal value, to either side.
    keeps_turning : bool
        True where the crank of every linkage within the tolerances turns fully.
    """

    theta2: Array
    omega2: Array
    alpha2: Array
    outputs: tuple[str, ...]
    parameters: tuple[str, ...]
    nominal: Array
    sensitivity: Array
    tolerance: Array
    keeps_turning: bool
    model: Parametric = field(repr=False)

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        **dict.fromkeys(("theta2", "omega2", "alpha2"), ("angle",)),
        "tolerance": ("parameter",),
        **dict.fromkeys(("nominal", "error", "worst_case", "root_sum_square"), ("output", "angle")),
        "sensitivity": ("output", "parameter", "angle"),
    }
    exported: ClassVar[tuple[str, ...]] = ("worst_case", "root_sum_square")

    @property
    def deviations(self) -> Array:
        """What each tolerance alone does, with its sign, shape (outputs, parameters, ...)."""
        return self.sensitivity * np.reshape(self.tolerance, (1, -1) + (1,) * self.theta2.ndim)

    @property
    def worst_case(self) -> Array:
        """Greatest deviation of each output, all tolerances at their worst, (outputs, ...)."""
        return np.asarray(np.sum(np.abs(self.deviations), axis=1))

    @property
    def root_sum_square(self) -> Array:
        """Root of the sum of the squared deviations, shape (outputs, ...).

        With tolerances that are standard deviations of independent parameters, or a fixed multiple
        of them, the standard deviation of the output, or the same multiple of it.
        """
        # The root of a sum of squares of any size.
        return np.asarray(np.hypot.reduce(self.deviations, axis=1))

    @property
    def contribution(self) -> Array:
        """Share of each parameter in the squared root-sum-square, (outputs, parameters, ...)."""
        total = self.root_sum_square[:, np.newaxis]
        return np.square(self.deviations / np.where(total > 0.0, total, 1.0))

    def place(self, output: str) -> int:
        """Return the place of an output on the first axis.

        Raises
        ------
        BadInput
            If there is no such output.
        """
        if output not in self.outputs:
            known = f"one of {', '.join(self.outputs)}"
            raise bad("output", repr(output), known, "choose one; forces need a machine")
        return self.outputs.index(output)

    def by(self, output: str, parameter: str) -> Array:
        """Return the derivative of an output by a parameter, shape (...).

        Raises
        ------
        BadInput
            If there is no such output or parameter.
        """
        if parameter not in self.parameters:
            known = f"one of {', '.join(self.parameters)}"
            raise bad("parameter", repr(parameter), known, "choose one; masses need a machine")
        return np.asarray(self.sensitivity[self.place(output), self.parameters.index(parameter)])

    def unit(self, output: str) -> str:
        """Return the unit of an output; rates without a crank speed are over the crank's.

        Raises
        ------
        BadInput
            If there is no such output.
        """
        return self.model.unit(self.outputs[self.place(output)])

    def monte_carlo(
        self, samples: int = 2000, seed: int = 0, distribution: Distribution = "normal"
    ) -> ToleranceTrial:
        """Return mean, standard deviation and extremes of every output over random parameters.

        Parameters
        ----------
        samples : int
            How many linkages are drawn.
        seed : int
            Of the generator; the same seed gives the same numbers.
        distribution : {"normal", "uniform"}
            Normal, the tolerance being three standard deviations, or uniform within the tolerance.

        Returns
        -------
        ToleranceTrial
            Its checks compare it with the first order, within the statistical error and
            the error.

        Raises
        ------
        BadInput
            If a number is out of range or the distribution is unknown.
        """
        if distribution not in _SPREADS:
            known = f"one of {sorted(_SPREADS)}"
            raise bad("distribution", repr(distribution), known, "choose one")
        for name, number, fewest in (("samples", samples, 2), ("seed", seed, 0)):
            if not is_whole(number, fewest):
                raise bad(name, repr(number), f"an integer of at least {fewest}", "correct it")
        random = np.random.default_rng(seed)
        # Deviations over the worst case: their squares neither overflow nor vanish.
        unit = np.where(self.worst_case > 0.0, self.worst_case, 1.0)
        total = np.zeros_like(unit)
        squares, kept, done = np.zeros_like(total), 0, 0
        least, greatest = np.full_like(total, np.inf), np.full_like(total, -np.inf)
        # Numbers in one array at a time.
        chunk = max(1, 200_000 // max(1, self.theta2.size))
        while done < samples:
            count = min(chunk, samples - done)
            deviation = _deviations(self, random, count, distribution) / unit
            good = np.all(np.isfinite(deviation), axis=tuple(range(1, deviation.ndim)))
            deviation = deviation[good]
            total += np.sum(deviation, axis=0)
            squares += np.sum(np.square(deviation), axis=0)
            least = np.minimum(least, np.min(deviation, axis=0, initial=np.inf))
            greatest = np.maximum(greatest, np.max(deviation, axis=0, initial=-np.inf))
            kept, done = kept + int(np.count_nonzero(good)), done + count
        if kept < 2:
            given = f"{kept} linkages that reach every angle"
            raise bad("tolerances", given, "at least 2", "narrow the tolerances")
        mean = total / kept
        spread = unit * np.sqrt(np.maximum(squares - kept * np.square(mean), 0.0) / (kept - 1))
        shift = unit * mean
        expected = self.root_sum_square * _SPREADS[distribution]
        error = _quantile(kept - 1) * spread
        return ToleranceTrial(
            outputs=self.outputs,
            mean_shift=shift,
            standard_deviation=spread,
            expected=expected,
            least=unit * least,
            greatest=unit * greatest,
            samples=samples,
            lost=samples - kept,
            distribution=distribution,
            method=f"Monte Carlo, seed {seed}",
            error=error,
            error_norm="standard deviation of each output, absolute, entrywise",
            checks=_trial_checks(self, shift, spread, expected, kept),
            provenance=self.provenance,
        )

    def to_dict(self) -> dict[str, Any]:
        """Return plain lists, numbers and strings, ready for JSON."""
        plain = super().to_dict()
        del plain["model"]
        return {**plain, "units": {name: self.unit(name) for name in self.outputs}}

    def plot(self, ax: Axes | None = None, output: str | None = None) -> Axes:
        """Draw the error band of an output against the crank angle.

        Parameters
        ----------
        ax : Axes, optional
            Where to draw.
        output : str, optional
            By default the angle of the follower or the rod, or the slider's place.

        Raises
        ------
        BadInput
            If there is no such output, or the crank angles are not a one-dimensional array.
        """
        if self.theta2.ndim != 1:
            shape = f"crank angles of shape {self.theta2.shape}"
            raise bad("plot", shape, "a one-dimensional array", "choose one speed, a row of angles")
        drawn = ("theta4", "position", "theta3")
        name = output or next(name for name in drawn if name in self.outputs)
        row, unit = self.place(name), self.unit(name)
        factor, unit = (1e3, f"m{unit}") if unit in ("rad", "m") else (1.0, unit)
        ax = axes_or_new(ax)
        order = np.argsort(self.theta2)
        degrees = np.degrees(self.theta2[order])
        for values, words, shade in (
            (self.worst_case, "worst case", "0.88"),
            (self.root_sum_square, "root of the sum of squares", "0.72"),
        ):
            band = factor * values[row][order]
            ax.fill_between(degrees, -band, band, color=shade, lw=0, label=words)
        for place, parameter in enumerate(self.parameters):
            if self.tolerance[place] > 0.0:
                line = factor * self.deviations[row, place][order]
                moved = "crank angle" if parameter == "theta2" else parameter
                ax.plot(degrees, line, lw=1.2, label=f"{moved} alone")
        ax.axhline(0.0, color="0.4", lw=0.8)
        ax.set_xlabel("crank angle [deg]")
        ax.set_ylabel(f"deviation of {_SYMBOLS.get(name, name)} [{unit}]")
        ax.margins(x=0.0)
        # Beside the band, which fills the axes.
        ax.legend(fontsize="small", ncols=3, loc="lower center", bbox_to_anchor=(0.5, 1.0))
        return ax


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

    The sensitivities are derivatives, not differences, of the emitted closed forms (of forces,
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
        Its check says that a common factor of all lengths leaves the angles (Euler's theorem).

    Raises
    ------
    BadInput
        If a name is unknown or a tolerance is no finite number of zero or more; if a linkage within
        the tolerances could fold at a crank angle or not reach it, with the angle and the length
        that brings it about; if the machine has loads that are functions.

    Examples
    --------
    >>> import elastolink as el
    >>> band = el.tolerances(el.FourBar(0.5, 0.1, 0.5, 0.2), {"crank": 1e-4}, theta=[0.0, 1.0])
    >>> print(band.outputs[:2], band.worst_case[:2].round(6))
    ('theta3', 'theta4') [[8.20e-05 2.06e-04]
     [6.09e-04 3.94e-04]]
    """
    if isinstance(linkage_or_machine, type) or not hasattr(linkage_or_machine, "parametric"):
        given = shown(linkage_or_machine)
        raise bad("tolerances", given, "a linkage or a Machine", "give a FourBar, say")
    if not is_one_of(masses, ("fixed", "bars")):
        raise bad("masses", shown(masses), "'fixed' or 'bars'", "choose one")
    if theta is None:
        theta = np.linspace(0.0, 2.0 * np.pi, 361)
    angles, drive = drive_of(theta, speed, acceleration)
    angles = np.array(np.broadcast_to(angles, drive[0].shape))
    model = linkage_or_machine.parametric(angles, *drive, masses)
    linkage, sizes = model.linkage, _checked(model, tolerance)
    linkage.motion(angles)  # refuses what it does not reach
    _require_reach(linkage, sizes, angles)
    parameters, names = tuple(model.values), model.outputs
    nominal, slopes = model.derivatives(model.values, parameters)
    values = np.stack([nominal[name] for name in names])
    sensitivity = np.stack([slopes[name] for name in names])
    if not (np.all(np.isfinite(values)) and np.all(np.isfinite(sensitivity))):
        fix = "use other units, or keep the angles off the folds"
        raise bad("tolerances", "numbers beyond the largest float", "finite ones", fix)
    widths = {f"tolerance.{name}": repr(width) for name, width in sizes.items()}
    return Tolerances(
        theta2=model.theta,
        omega2=model.speed,
        alpha2=model.acceleration,
        outputs=names,
        parameters=parameters,
        nominal=values,
        sensitivity=sensitivity,
        tolerance=np.array([sizes.get(name, 0.0) for name in parameters]),
        keeps_turning=turns(box_of(linkage.lengths, sizes)),
        model=model,
        method="derivatives of the closed form",
        error=_remainder(model, sizes, slopes),
        error_norm="worst case of each output, absolute, entrywise",
        error_kind="estimate",
        checks=DeferredChecks(partial(_checks, model, sensitivity)),
        provenance=provenance({**linkage.provenance, **widths}),
    )


def _checked(model: Parametric, tolerance: object) -> dict[str, float]:
    if not isinstance(tolerance, Mapping):
        given = type(tolerance).__name__
        raise bad("tolerance", given, "a mapping from name to number", "write {'crank': 1e-4}")
    known, problems = model.values, []
    limits = {name: size for name, size in model.linkage.lengths.items() if name != "offset"}
    limits[ANGLE] = math.pi / 2.0
    for name, width in tolerance.items():
        where = f"tolerance[{name!r}]"
        if name not in known:
            fix = "correct the name; masses need a Machine"
            problems.append(Problem(where, repr(name), f"one of {', '.join(known)}", fix))
        elif not (is_finite(width) and width >= 0.0):
            problems.append(Problem(where, shown(width), "zero or more", "correct it"))
        elif width >= limits.get(name, math.inf):
            what = "a quarter turn" if name == ANGLE else "the length"
            expected = f"less than {what}, {limits[name]:g}"
            problems.append(Problem(where, f"{width:g}", expected, "narrow it"))
    refuse(problems)
    return {str(name): float(width) for name, width in tolerance.items()}


def _require_reach(linkage: Linkage, sizes: Mapping[str, float], theta: Array) -> None:

    def left(widths: Mapping[str, float], angles: Array) -> Array:
        return margin(box_of(linkage.lengths, widths), angles, widths.get(ANGLE, 0.0))

    named = [name for name, width in sizes.items() if width > 0.0]
    margins = np.ravel(left(sizes, theta))
    # Without a tolerance the linkage reaches its angles, whatever round-off says here.
    if not named or margins.size == 0 or np.all(margins > 0.0):
        return
    worst = int(np.argmin(margins))
    angle = np.ravel(theta)[worst : worst + 1]
    blamed = max(named, key=lambda name: float(left({**sizes, name: 0.0}, angle)[0]))
    found = f"a linkage within the tolerances that cannot reach {angle[0]:.6g} rad, or folds"
    expected = f"tolerances that leave {-margins[worst]:.3g} m more to the fold"
    fix = f"narrow them, that of the {blamed} first, or keep theta farther from the fold"
    raise bad(f"tolerance[{blamed!r}]", found, expected, fix)


def _remainder(model: Parametric, sizes: Mapping[str, float], slopes: dict[str, Array]) -> Array:
    """Return what the first order may leave out within the tolerances, shape (outputs, ...).

    With f the output, s its gradient and d a deviation, f(d) - f(0) - s(0) d is the mean of
    (s(u d) - s(0)) d over u from 0 to 1.  Masses enter linearly, so that corners of the lengths
    and the crank angle suffice for their sensitivities too.
    """
    names = tuple(name for name, width in sizes.items() if width > 0.0)
    moved = [name for name in names if name in (*model.linkage.names, ANGLE)]
    parameters = list(model.values)
    rows = [parameters.index(name) for name in names]
    here = {output: slopes[output][rows] for output in model.outputs}
    widths = np.reshape([sizes[name] for name in names], (-1,) + (1,) * model.theta.ndim)
    worst = np.zeros((len(model.outputs), *model.theta.shape))
    for signs in itertools.product((-1.0, 1.0), repeat=len(moved)) if moved else ():
        there = dict(model.values)
        for name, sign in zip(moved, signs, strict=True):
            there[name] += sign * sizes[name]
        _, other = model.derivatives(there, names)
        changes = [np.sum(widths * np.abs(other[o] - here[o]), axis=0) for o in model.outputs]
        worst = np.maximum(worst, np.stack(changes))
    first = np.stack([np.sum(widths * np.abs(here[o]), axis=0) for o in model.outputs])
    # What round-off does to a worst case, in units of the last place, away from the folds.
    return np.asarray(worst + 64.0 * EPS * first)


def _checks(model: Parametric, sensitivity: Array) -> dict[str, Check]:
    """Compare the sensitivities of the angles to a common factor of all lengths with zero."""
    lengths = model.linkage.lengths
    sizes = np.reshape(list(lengths.values()), (-1,) + (1,) * model.theta.ndim)
    angles = [row for row, name in enumerate(model.outputs) if name in _SCALE_FREE]
    terms = sensitivity[angles, : len(lengths)] * sizes
    rows = tuple(range(1, terms.ndim - 1))
    most = np.max(np.abs(np.sum(terms, axis=1)), axis=rows, initial=0.0)
    size = np.max(np.sum(np.abs(terms), axis=1), axis=rows, initial=0.0)
    worst = float(np.max(most / np.maximum(size, np.finfo(float).tiny), initial=0.0))
    # A common factor of all lengths may turn the links by so much of what each length alone does.
    return {"a common factor of all lengths leaves the angles": Check(worst, 1e-9)}


def box_of(lengths: Mapping[str, float], tolerances: Mapping[str, float]) -> dict[str, Limits]:
    """Return the limits of each length."""
    return {
        name: (size - tolerances.get(name, 0.0), size + tolerances.get(name, 0.0))
        for name, size in lengths.items()
    }


def margin(box: Box, theta: Array, width: float = 0.0) -> Array:
    """Return how far the worst linkage of a box of lengths is from folding, in lengths.

    The names of the lengths tell the mechanism; ``width`` is the tolerance of the crank angles.
    """
    if width > 0.0:
        start = np.pi / 2 if "offset" in box else 0.0
        extreme = start + np.pi * np.round((theta - start) / np.pi)
        low, high = theta - width, theta + width
        angles = low, high, np.clip(extreme, low, high)
        return np.asarray(np.min([margin(box, angle) for angle in angles], axis=0))
    if "offset" in box:
        heights = [
            np.abs(offset - crank * np.sin(theta))
            for crank, offset in itertools.product(box["crank"], box["offset"])
        ]
        return np.asarray(box["coupler"][0] - np.max(heights, axis=0))
    if "rod" in box:
        near, far = _distances(box["frame"], box["crank"], theta + np.pi)
        return np.minimum(near, box["rod"][0] - far)
    near, far = _distances(box["frame"], box["crank"], theta)
    coupler, follower = box["coupler"], box["follower"]
    folded = max(coupler[1] - follower[0], follower[1] - coupler[0])
    return np.minimum(near - folded, coupler[0] + follower[0] - far)


def turns(box: Box) -> bool:
    """Return True where the crank of every linkage of the box turns fully."""
    extremes = np.array([np.pi / 2, -np.pi / 2] if "offset" in box else [0.0, np.pi])
    return bool(np.all(margin(box, extremes) > 0.0))


def _distances(first: Limits, second: Limits, angle: Array) -> tuple[Array, Array]:
    """Return least and greatest distance of the ends of two arms that enclose an angle."""

    def distance(a: Array | float, b: Array | float) -> Array:
        return np.asarray(np.hypot(a - b * np.cos(angle), b * np.sin(angle)))

    far = np.max([distance(a, b) for a, b in itertools.product(first, second)], axis=0)
    # For one arm given, the distance is least at the foot of the perpendicular.
    near = [distance(np.clip(b * np.cos(angle), *first), b) for b in second]
    near += [distance(a, np.clip(a * np.cos(angle), *second)) for a in first]
    return np.min(near, axis=0), far


@dataclass(frozen=True, kw_only=True)
class ToleranceTrial(Result):
    """Mean and standard deviation of every output over random linkages.

    ``error`` holds the statistical error of ``standard_deviation`` in 99 of 100 trials; its shape.

    Attributes
    ----------
    outputs : tuple of str
        Names of the outputs.
    mean_shift : ndarray, shape (outputs, ...)
        Mean of each output less its nominal value: second-order, and statistical error.
    standard_deviation : ndarray, shape (outputs, ...)
        Of each output.
    expected : ndarray, shape (outputs, ...)
        Standard deviation to first order.
    least, greatest : ndarray, shape (outputs, ...)
        Extremes of the deviations.
    samples, lost : int
        How many linkages were drawn, and how many could not reach an angle and were left out.
    distribution : str
        Of the parameters.
    """

    outputs: tuple[str, ...]
    mean_shift: Array
    standard_deviation: Array
    expected: Array
    least: Array
    greatest: Array
    samples: int
    lost: int
    distribution: str

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = dict.fromkeys(
        ("mean_shift", "standard_deviation", "expected", "least", "greatest", "error"),
        ("output", "angle"),
    )


def _quantile(freedom: int) -> float:
    """Return what holds the error of 99 of 100 standard deviations, relative; chi-square law."""
    from scipy.special import chdtri

    low, high = (float(chdtri(freedom, share)) for share in (0.995, 0.005))
    return max(math.sqrt(freedom / low) - 1.0, 1.0 - math.sqrt(freedom / high))


def _deviations(
    nominal: Tolerances, random: np.random.Generator, count: int, distribution: Distribution
) -> Array:
    """Return deviations of the outputs of random linkages, shape (count, outputs, ...)."""
    model = nominal.model
    shape = (count, len(nominal.parameters))
    drawn = (
        random.normal(0.0, _SPREADS["normal"], shape)
        if distribution == "normal"
        else random.uniform(-1.0, 1.0, shape)
    )
    numbers = {}
    for place, name in enumerate(nominal.parameters):
        column = model.values[name] + nominal.tolerance[place] * drawn[:, place]
        numbers[name] = np.reshape(column, (count,) + (1,) * model.theta.ndim)
    values = model.evaluate(numbers)
    full = (count, *model.theta.shape)
    deviation = np.stack([np.broadcast_to(values[name], full) for name in nominal.outputs], axis=1)
    deviation = deviation - nominal.nominal
    for row, name in enumerate(nominal.outputs):
        if name in ("theta3", "theta4"):
            # A linkage of the other type counts its turns from elsewhere.
            deviation[:, row] = np.remainder(deviation[:, row] + np.pi, 2.0 * np.pi) - np.pi
    return np.asarray(deviation)


def _trial_checks(
    nominal: Tolerances, shift: Array, spread: Array, expected: Array, kept: int
) -> dict[str, Check]:
    """Compare with the first order: within the statistical error and the error."""
    # |Z| exceeds z with a chance below exp(-z^2/2); every output and angle is one comparison, and
    # 1e-6 the chance that one of them all fails where both sides are right.
    quantile = math.sqrt(2.0 * math.log(max(spread.size, 1) / 1e-6))
    axes = tuple(range(1, nominal.nominal.ndim))
    size = np.max(np.abs(nominal.nominal), axis=axes, initial=0.0, keepdims=True)
    allowed = np.asarray(nominal.error) + 64.0 * np.finfo(float).eps * size
    allowed = np.maximum(allowed, np.finfo(float).tiny)
    off_spread = np.abs(spread - expected) / (
        quantile * np.maximum(spread, expected) / math.sqrt(2.0 * (kept - 1)) + allowed
    )
    off_mean = np.abs(shift) / (quantile * spread / math.sqrt(kept) + allowed)
    return {
        f"{what} within its statistical error and the bound": Check(
            float(np.max(off, initial=0.0)), 1.0
        )
        for what, off in (("spread", off_spread), ("mean", off_mean))
    }
