"""What tolerances of a scene's numbers do to an answer: worst case, sampled spread, shares."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import BadInput, bad, shown
from ..core.families import MATRICES, Array, LinearPeriodic
from ..core.inputs import numbers_in_a_row, require_kind, require_whole, speed_span
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check, Result, provenance
from ..core.taylor_models import TaylorModel, UndecidedError, features, stacked
from ..core.trigonometric import BETWEEN
from ..frequencies.held import held_frequencies
from ..linkages.linkage import Linkage
from ..linkages.parametric import ANGLE, Parametric
from ..recovery.stress_over_speed import stress_curve
from ..rigid import rigid_forces
from ..rigid.evaluation import COUPLES, ParametricMachine
from ..scenes import Scene, with_numbers
from ..scenes.rigid import rigid_numbers
from ..stability import stability_edges
from ..systems.closed_form import closed_form
from .enclosed_edges import angles_for, enclosed_ends, harmonics_for

# Reserve over the largest remainder measured; corners and points inside that it is measured at;
# what round-off leaves, and no number; standard deviations to the worst case without a bound; the
# part of the range of values that a band is seen at.
_SAFETY, _CORNERS, _INSIDE, _ROUND_OFF, _TINY, _REACH, _SEEN = 2.0, 16, 8, 1e-12, 1e-300, 3.0, 0.02
_PROVED = "second order by Taylor models; remainder proved"
_MEASURED = "second order by differences of a half-width; remainder measured, doubled"
_SPREAD = ("standard_deviation", "likely_lower", "likely_upper")


@dataclass(frozen=True, kw_only=True)
class ToleranceBands(Result):
    """An answer with bands; its arrays are over rows and places, ``(nr, np)``.

    ``lower`` and ``upper`` are bounds, proved, of a model of second order over all tolerances,
    widened by ``reserve`` for what the model leaves out: a proved bound of it where ``proved``,
    else twice the largest remainder measured at corners and inside, an estimate.  ``error`` is how
    far they lie beyond values that were computed: so much too wide the bands may be.

    Attributes
    ----------
    numbers : tuple of str
        Dotted keys of the n numbers.
    half_width, deviation : ndarray, shape (n,)
        Bounds, three standard deviations where none is given, and standard deviations, NaN of
        uniform numbers [SI].
    rows, units : tuple of str
        Names and units of the rows.
    place, across, quantity : ndarray, str, str
        Places, for example crank angles [rad], what they are, and what the answer is.
    value, lower, upper, reserve : ndarray
        Answer of the scene itself, worst cases, and the part of either that is reserve.
    proved : bool
        Whether no machine within the tolerances leaves the bands.
    standard_deviation, likely_lower, likely_upper : ndarray
        Of the samples of the model; 95 of 100 lie between the two.
    slope, share : ndarray, shape (nr, np, n)
        Change by a half-width of each number, and its part in the variance, to first order.
    """

    numbers: tuple[str, ...]
    half_width: Array
    deviation: Array
    rows: tuple[str, ...]
    units: tuple[str, ...]
    place: Array
    across: str
    quantity: str
    value: Array
    lower: Array
    upper: Array
    reserve: Array
    proved: bool
    standard_deviation: Array
    likely_lower: Array
    likely_upper: Array
    slope: Array
    share: Array

    arrays_along: ClassVar = {
        "number": "half_width deviation",
        "place": "place",
        "row place": " ".join(("value lower upper reserve error", *_SPREAD)),
        "row place number": "slope share",
    }

    def plot(self, ax: Axes | None = None, row: str | None = None) -> Axes:
        """Draw one row, or those with its unit: worst case light, 95 of 100 samples darker.

        Bands too narrow to be seen beside the values are drawn as deviations from them.
        """
        ax = axes_or_new(ax)
        name = row or self.rows[0]
        if name not in self.rows:
            raise bad("row", repr(name), f"one of {', '.join(self.rows)}", "choose one")
        unit = self.units[self.rows.index(name)]
        chosen = [k for k, one in enumerate(self.rows) if row == one or not row]
        drawn = [k for k in chosen if self.units[k] == unit]
        hidden = np.max((self.upper - self.lower)[drawn]) < _SEEN * np.ptp(self.value[drawn])
        for k in drawn:
            colour, x = f"C{k % 10}", self.place
            x = np.degrees(x) if self.across.endswith("[rad]") else x
            ends = (self.lower, self.upper, self.likely_lower, self.likely_upper, self.value)
            low, high, likely_low, likely_high, value = (
                np.atleast_1d(end[k] - hidden * self.value[k]) for end in ends
            )
            if len(x) == 1:  # a bar of some width
                x = np.array([k - 0.3, k + 0.3])
            ax.fill_between(x, low, high, color=colour, alpha=0.25, lw=0)
            ax.fill_between(x, likely_low, likely_high, color=colour, alpha=0.5, lw=0)
            ax.plot(x, value + 0.0 * x, color=colour, lw=0.8, label=self.rows[k].replace("_", " "))
        told = f"{'deviation of ' * bool(hidden)}{row or self.quantity} [{unit}]"
        ax.set(xlabel=self.across.replace("[rad]", "[deg]"), ylabel=told)
        if len(self.place) == 1:
            ax.set(xlabel="", xticks=[])
        # Beside the bands, which may fill the axes.
        above: Any = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.0), "fontsize": "small"}
        ax.legend(title="light: worst case; dark: 95 of 100", ncols=4, **above)
        return ax


def tolerance_bands(
    scene: Scene,
    answer: str | Callable[[Scene], ArrayLike],
    at: ArrayLike | None = None,
    *,
    over: Over | None = None,
    trials: int | None = None,
    samples: int = 10_000,
    seed: int = 0,
) -> ToleranceBands:
    """Return worst case and sampled spread of an answer within the tolerances of a scene.

    Motion, forces without loads and springs, and of couplers and Hill's equation frequencies and,
    without damping, ends of principal regions are evaluated once on Taylor models of second order
    in the n numbers, whose remainder is enclosed.  Of all others the scene is computed anew with
    numbers moved, all that follows from them too: ``1 + 2 n + n (n - 1) / 2`` times for a model
    whose steps are the half-widths, some 32 times for the reserve.  ``trials`` machines at random
    check either.

    Parameters
    ----------
    scene : Scene
        With ``tolerances`` or ``deviations``.
    answer : str or callable
        ``"frequencies"`` with the crank held; ``"edges"`` of unstable regions; ``"boundaries"``
        of a chart, which are edges over a second parameter; ``"stress"``, the largest of each beam
        over the speed; ``"motion"`` and ``"forces"`` of a rigid machine; or a function that
        makes numbers ``(places,)`` or ``(rows, places)`` of a scene.
    at : array_like, optional
        Crank angles [rad] or speeds [rad/s], of edges and boundaries the lowest and the highest; by
        default 73 over a turn or what the crank reaches, or 21 over ``operation.speed_range``.
    over : tuple of str and array_like, optional
        The second parameter and its values [SI]; by default five of the chart's y.
    trials : int, optional
        Machines at random that check the reserve; by default 32, or 8 where it is proved.
    samples : int
        Numbers at random for the spread, of which the model of second order makes the answers:
        uniform within the bounds, or normal where a deviation is given, cut off at the bounds.
    seed : int
        Of all that is random.

    Returns
    -------
    ToleranceBands
        Its checks: ``held``, the part of the reserve that the worst trial used; ``narrow``, the
        largest reserve over the largest half band of its row: tolerances are too wide for the
        model, or the answer has kinks, if it is beyond 1/2.

    Raises
    ------
    BadInput
        If an argument is unusable, no number has a tolerance, or a machine within them cannot be.

    Examples
    --------
    >>> import elastolink as el
    >>> scene = el.load_scene("smith_1972_12_6_12_12", {"links.coupler": "12 in +- 0.1 mm"})
    >>> band = el.design.tolerance_bands(scene, "forces", at=[0.0, 1.0], samples=1000)
    >>> torque = band.rows.index("torque")
    >>> print(band.lower[torque].round(3), band.value[torque].round(3), band.upper[torque].round(3))
    [-2.192  0.712] [-2.188  0.713] [-2.184  0.713]
    """
    require_kind("scene", scene, Scene, "use load_scene")
    if trials is not None:
        require_whole("trials", trials, 1, 10_000_000)
    require_whole("samples", samples, 2, 10_000_000)
    random = np.random.default_rng(require_whole("seed", seed, 0, 2**63))
    box, asked = _Box.of(scene), answer_of(scene, answer, at, over)
    shape = len(asked.rows), len(asked.place)
    evaluate = partial(_values, scene, asked, box)
    model = _enclosed(scene, asked, box)
    proved = model is not None
    points = np.zeros((1, box.n)) if proved else box.design()
    first = evaluate(points)
    if model is None:
        model = TaylorModel(np.linalg.solve(features(points), first).T.astype(float), 0.0, box.n)
    corners = box.corners(model.slope, random)
    checked, coefficients = corners, model.coefficients.T
    if not proved:
        # What is cubic in one number is nought at the corners, and largest at 0.577 of the way.
        inside = corners[:_INSIDE] / np.sqrt(3.0), random.uniform(-1.0, 1.0, (_INSIDE, box.n))
        checked = np.concatenate([corners, *inside])
    found = np.concatenate([first, evaluate(checked)])
    if not proved:
        remainder = np.abs(found[len(first) :] - features(checked) @ coefficients)
        model = TaylorModel(model.coefficients, _SAFETY * np.max(remainder, axis=0), box.n)
    size = np.max(np.abs(first[0].reshape(shape)), axis=1)
    spare = np.repeat(_ROUND_OFF * size, shape[1]) + _TINY
    reserve, (low, high) = model.rest + spare, model.bounds()
    low, high = low - spare, high + spare
    drawn = box.draw(trials or (8 if proved else 32), random)
    used = np.abs(evaluate(drawn) - features(drawn) @ coefficients) / reserve
    left_out = np.maximum(model.rest - _ROUND_OFF * np.max(size), 0.0)  # of what is to be zero
    widest = [np.max(row.reshape(shape), axis=1) for row in (left_out, (high - low) / 2.0)]
    points = box.draw(samples, random)
    share = np.square(model.slope * np.std(points, axis=0))
    share /= np.maximum(np.sum(share, axis=1, keepdims=True), _TINY)
    too_wide = np.maximum(high - np.max(found, axis=0), np.min(found, axis=0) - low)
    names = ("value", "lower", "upper", "reserve", "error", *_SPREAD)
    rows = (first[0], low, high, reserve, too_wide, *_spread(points, coefficients))
    return ToleranceBands(
        method=_PROVED if proved else _MEASURED,
        error_norm="how far too wide a band may be at either side, absolute",
        checks={
            "held": Check(float(np.max(used)), 1.0),
            "narrow": Check(float(np.max(widest[0] / widest[1])), 0.5),
        },
        provenance=provenance({"scene": scene.name, "scene_digest": scene.digest()}),
        numbers=box.names,
        half_width=box.half,
        deviation=box.deviation,
        **{name: part for name, part in vars(asked).items() if name not in ("compute", "modelled")},
        proved=proved,
        slope=model.slope.reshape(*shape, box.n),
        share=share.reshape(*shape, box.n),
        **{name: row.reshape(shape) for name, row in zip(names, rows, strict=True)},
    )


@dataclass(frozen=True)
class _Box:
    """The numbers with tolerances; a point of the box has coordinates from -1 to 1."""

    names: tuple[str, ...]
    middle: Array
    half: Array
    deviation: Array

    @classmethod
    def of(cls, scene: Scene) -> _Box:
        names = tuple(dict.fromkeys([*scene.tolerances, *scene.deviations]))
        if not names:
            fix = "write links.coupler = '381 mm +- 0.1 mm', or --set it"
            raise bad(f"scene {scene.name}", "no tolerance", "a number with one", fix)
        spread = np.array([scene.deviations.get(k, np.nan) for k in names])
        half = np.array([scene.tolerances.get(k, np.nan) for k in names])
        half[np.isnan(half)] = _REACH * spread[np.isnan(half)]
        return cls(names, np.array([scene.get(k) for k in names]), half, spread)

    @property
    def n(self) -> int:
        return len(self.names)

    def design(self) -> Array:
        """Return the points that fix a model of second order: middle, faces, edges."""
        one = np.eye(self.n)
        pairs = [one[i] + one[j] for i, j in itertools.combinations(range(self.n), 2)]
        return np.concatenate([np.zeros((1, self.n)), one, -one, *([pairs] if pairs else [])])

    def corners(self, slope: Array, random: np.random.Generator) -> Array:
        """Return all corners where they are few, else those worst for most, and random ones."""
        if 2**self.n <= _CORNERS:
            return np.array(list(itertools.product((-1.0, 1.0), repeat=self.n)))
        signs = np.where(slope >= 0.0, 1.0, -1.0)
        worst, counts = np.unique(np.concatenate([signs, -signs]), axis=0, return_counts=True)
        most = worst[np.argsort(-counts, kind="stable")[: 2 * _CORNERS]]
        return np.concatenate([most, random.choice([-1.0, 1.0], (_CORNERS, self.n))])

    def draw(self, count: int, random: np.random.Generator) -> Array:
        """Return random points, normal in what has a deviation, uniform in the rest."""
        from scipy.special import ndtr, ndtri

        uniform = random.uniform(-1.0, 1.0, (count, self.n))
        with np.errstate(invalid="ignore"):
            cut = self.half / self.deviation
            normal = ndtri(0.5 + uniform * (ndtr(cut) - 0.5)) / cut
        return np.where(np.isnan(self.deviation), uniform, np.clip(normal, -1.0, 1.0))


def _values(scene: Scene, asked: Answer, box: _Box, points: Array) -> Array:
    """Return the answer at points of the box, ``(points, rows * places)``."""
    rows = []
    for point in points:
        numbers = dict(zip(box.names, (box.middle + box.half * point).tolist(), strict=True))
        told = ", ".join(f"{name} = {number:.6g}" for name, number in numbers.items())
        try:
            found = np.asarray(asked.compute(with_numbers(scene, numbers)), dtype=float).ravel()
        except BadInput as refusal:
            wrong = refusal.problems[0]
            given = f"{wrong.found} with {told}"
            raise bad(wrong.where, given, wrong.expected, "narrow the tolerances") from refusal
        if len(found) != len(asked.rows) * len(asked.place) or not np.all(np.isfinite(found)):
            expected = "the same finite numbers of every machine within the tolerances"
            raise bad("answer", f"others with {told}", expected, "narrow the tolerances")
        rows.append(found)
    return np.array(rows)


def _enclosed(scene: Scene, asked: Answer, box: _Box) -> TaylorModel | None:
    """Return the entries of an answer on Taylor models; None where these cannot be had."""
    if asked.modelled is None:
        return None
    numbers = TaylorModel.numbers(box.middle, box.half)
    try:
        one = with_numbers(scene, dict(zip(box.names, numbers, strict=True)), checked=False)
        rows = asked.modelled(one, numbers[0].lifted)
    except UndecidedError:
        return None
    found = stacked(rows, (len(asked.place),))
    entries = found.coefficients.reshape(-1, found.coefficients.shape[-1])
    finite = np.all(np.isfinite(entries)) and np.all(np.isfinite(found.rest))
    return TaylorModel(entries, found.rest.ravel(), box.n) if finite else None


def _spread(points: Array, model: Array) -> list[Array]:
    """Return standard deviation and the ends of the middle 95 of 100 of the model at points."""
    known, parts = features(points), []
    # Numbers in one array at a time.
    for columns in np.array_split(model, 1 + len(points) * model.shape[1] // 2_000_000, axis=1):
        values = known @ columns
        parts.append([np.std(values, axis=0), *np.quantile(values, [0.025, 0.975], axis=0)])
    return list(np.concatenate(parts, axis=1))


KINDS = ("frequencies", "edges", "boundaries", "stress", "motion", "forces")
Over = tuple[str, ArrayLike]
Lift = Callable[[Any], TaylorModel]
_ANGLE = "crank angle [rad]"
# By default; and the part of a range of angles left out at its ends, where the linkage folds.
_MODES, _ANGLES, _SPEEDS, _VALUES, _INSET = 6, 73, 21, 5, 0.05


@dataclass(frozen=True)
class Answer:
    """Numbers ``(rows, places)`` of a scene, with their names."""

    compute: Callable[[Scene], ArrayLike]
    rows: tuple[str, ...]
    units: tuple[str, ...]
    place: Array
    across: str
    quantity: str
    # Rows of a scene whose numbers are Taylor models, which lifts others to models.
    modelled: Callable[[Scene, Lift], Sequence[TaylorModel]] | None = None


def answer_of(
    scene: Scene, kind: str | Callable[[Scene], ArrayLike], at: ArrayLike | None, over: Over | None
) -> Answer:
    """Return what is asked, by its kind, or a function of one's own."""
    if over is not None and kind != "boundaries":
        raise bad("over", shown(over), "nothing with this answer", "ask for boundaries")
    if kind in ("edges", "boundaries"):
        return _ends(scene, at, over, with_second=kind == "boundaries")
    if kind == "stress":
        return _stress(scene, _range(scene) if at is None else at, at is None)
    if isinstance(kind, str) and kind in _OVER_ANGLES:
        theta = numbers_in_a_row("at", _angles(scene, kind) if at is None else at)
        return _OVER_ANGLES[kind](scene, theta)
    if not callable(kind) or at is not None:
        expected = f"one of {', '.join(KINDS)}, or a function of a scene without 'at'"
        raise bad("answer", shown(kind), expected, "choose one")
    values = np.atleast_2d(np.asarray(kind(scene), dtype=float))
    rows = tuple(f"row {k + 1}" for k in range(len(values)))
    return Answer(
        kind, rows, ("-",) * len(rows), np.arange(float(values[0].size)), "entry", "answer"
    )


def _frequencies(scene: Scene, theta: Array) -> Answer:
    count = min(scene.linear_system().size, _MODES)

    def compute(one: Scene) -> Array:
        return held_frequencies(one.linear_system(), theta, {})[0][:, :count].T

    closed = closed_form(scene)

    def modelled(one: Scene, lift: Lift) -> list[TaylorModel]:
        assert closed is not None
        numbers = {name: lift(number) for name, number in closed.numbers(one).items()}
        held = closed.arrays(numbers, theta, ("M", "K", "Kg"))
        stiffness, mass = held["K", 0] + held.get(("Kg", 0), 0.0), lift(held["M", 0])
        if any(
            np.any(part.coefficients[:, ~np.eye(count, dtype=bool)]) for part in (stiffness, mass)
        ):
            raise UndecidedError("modes that are not those of the equation's coordinates")
        found = [np.sqrt(stiffness[:, k, k] / mass[:, k, k]) for k in range(count)]
        if not all(np.all(above > below) for below, above in itertools.pairwise(found)):
            raise UndecidedError("modes whose order changes")
        return found

    rows = tuple(f"mode {k + 1}" for k in range(count))
    known = None if closed is None or scene.linear_system().size != count else modelled
    return Answer(compute, rows, ("rad/s",) * count, theta, _ANGLE, "natural frequency", known)


def _angles(scene: Scene, kind: str) -> Array:
    """Return angles over a turn, or over what a crank that rocks reaches but for its ends."""
    low, high = 0.0, 2.0 * np.pi
    if kind != "frequencies" and not (linkage := scene.mechanism()).crank_turns:
        ends = linkage.crank_ranges()[0]
        low, high = ends[0] + _INSET * np.ptp(ends), ends[1] - _INSET * np.ptp(ends)
    return np.linspace(low, high, _ANGLES)


def _motion(scene: Scene, theta: Array) -> Answer:
    driven = "operation" in scene and scene.get("operation.speed", None) is not None
    linkage = scene.mechanism()
    moves = linkage.moves
    rows = (*moves.places, *moves.rates)

    def compute(one: Scene) -> Array:
        found = one.mechanism().motion(theta, *(_drive(one) if driven else ()))
        return np.array([np.broadcast_to(getattr(found, name), theta.shape) for name in rows])

    def modelled(one: Scene, lift: Lift) -> list[TaylorModel]:
        drive: Any = map(lift, _drive(one) if driven else (1.0, 0.0))
        found = Parametric(linkage, theta, *drive).evaluate(_numbers(one, linkage, lift))
        return [lift(found[name]) for name in rows]

    units = tuple(moves.unit_of(name, relative=not driven) for name in rows)
    return Answer(compute, rows, units, theta, _ANGLE, "motion", modelled)


def _numbers(scene: Scene, linkage: Linkage, lift: Lift) -> dict[str, TaylorModel]:
    return {name: lift(number) for name, number in rigid_numbers(scene, linkage).items()} | {
        ANGLE: lift(0.0)
    }


def _drive(scene: Scene) -> tuple[float, float]:
    return scene.get("operation.speed"), scene.get("operation.acceleration", 0.0)


def _forces(scene: Scene, theta: Array) -> Answer:
    machine = scene.machine()
    first = rigid_forces(machine, theta, *_drive(scene))
    rows = tuple(sorted(first.values))

    def compute(one: Scene) -> Array:
        found = rigid_forces(one.machine(), theta, *_drive(one)).values
        return np.array([np.broadcast_to(found[name], theta.shape) for name in rows])

    def modelled(one: Scene, lift: Lift) -> list[TaylorModel]:
        linkage = machine.linkage
        drive: Any = [lift(number) for number in _drive(one)]
        made = ParametricMachine(linkage, theta, drive[0], drive[1], machine)
        found = made.evaluate(_numbers(one, linkage, lift))
        return [lift(found[name]) for name in rows]

    units = tuple("N m" if name.startswith(COUPLES) else "N" for name in rows)
    known = None if machine.loaded else modelled
    return Answer(compute, rows, units, theta, _ANGLE, "force or moment", known)


_OVER_ANGLES: Mapping[str, Callable[[Scene, Array], Answer]] = {
    "frequencies": _frequencies,
    "motion": _motion,
    "forces": _forces,
}


def _stress(scene: Scene, at: ArrayLike, spaced: bool) -> Answer:
    speeds = numbers_in_a_row("at", at)
    speeds = np.linspace(speeds[0], speeds[-1], _SPEEDS) if spaced else speeds

    def compute(one: Scene) -> Array:
        system = one.linear_system()
        return stress_curve(system, speeds, rtol=1e-5, stability=False, whole=False).maximum.T

    links = stress_curve(scene.linear_system(), speeds[:1], stability=False, whole=False).links
    return Answer(
        compute, links, ("Pa",) * len(links), speeds, "crank speed [rad/s]", "largest stress"
    )


def _ends(scene: Scene, at: ArrayLike | None, over: Over | None, *, with_second: bool) -> Answer:
    """Return ends of the unstable regions that every machine has, by name, also over a parameter.

    Regions whose label is a matter of words are left out, and ends far beyond the range.
    """
    low, high = speed_span(_range(scene) if at is None else at)  # type: ignore[arg-type]
    if with_second and over is None:
        if scene.get("chart.y", None) not in scene.linear_system().parameters:
            raise bad("over", "nothing", "a parameter and its values", "give both")
        least, most = scene.get("chart.y_range")
        over = scene.get("chart.y"), np.linspace(least, most, _VALUES)
    name, values = over or ("", np.zeros(1))
    places = numbers_in_a_row("over", values)

    def regions(system: LinearPeriodic, place: float, factor: float) -> Mapping[str, float]:
        moved = system.with_parameters(**{name: place}) if name else system
        edges = stability_edges(moved, (low / factor, high * factor))
        ends = {"from": edges.lower, "to": edges.upper}
        sure = np.flatnonzero(~edges.doubtful).tolist()
        found = {f"{e} {edges.labels[k]}": float(ends[e][k]) for k in sure for e in ends}
        return {label: speed for label, speed in found.items() if np.isfinite(speed)}

    first = [regions(scene.linear_system(), place, 1.0) for place in places.tolist()]
    rows = tuple(label for label in first[0] if all(label in others for others in first))
    if not rows:
        raise bad("at", f"{low:g} to {high:g} rad/s", "unstable regions with ends", "widen it")

    def compute(one: Scene) -> Array:
        # Beyond the range, too: the same regions may have moved.
        found = [regions(one.linear_system(), place, 1.2) for place in places.tolist()]
        return np.array([[ends.get(label, np.nan) for ends in found] for label in rows])

    closed = closed_form(scene)

    def modelled(one: Scene, lift: Lift) -> list[TaylorModel]:
        assert closed is not None
        numbers = {key: lift(number) for key, number in closed.numbers(one).items()}
        columns = []
        for place, ends in zip(places.tolist(), first, strict=True):
            system = scene.linear_system().with_parameters(**({name: place} if name else {}))
            speeds, period = np.array([ends[label] for label in rows]), system.period
            fastest = np.max(held_frequencies(system, period * BETWEEN, {})[0])
            harmonics = harmonics_for(speeds, float(fastest), period)
            held = {**numbers, name: lift(place)} if name else numbers
            parts = closed.arrays(held, angles_for(harmonics, period), MATRICES)
            if any(power for _, power in parts):
                raise UndecidedError("powers of the speed")
            models = {array: lift(value) for (array, _), value in parts.items()}
            columns.append(enclosed_ends(models, speeds, harmonics, period))
        return [stacked(row) for row in zip(*columns, strict=True)]

    across, units = f"{name or 'edges'} [SI]", ("rad/s",) * len(rows)
    known = None if closed is None else modelled
    return Answer(compute, rows, units, places, across, "crank speed", known)


def _range(scene: Scene) -> tuple[float, float]:
    found = scene.get("operation.speed_range", None) if "operation" in scene else None
    if found is None:
        raise bad("at", "nothing", "speeds, for the scene names no range", "give at")
    return float(found[0]), float(found[1])
