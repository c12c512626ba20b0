"""Coupler curves: path of a point of a moving link, cusps, double points, length, cognates."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, partial
from math import pi
from typing import Any, ClassVar, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import BadInput, bad
from ..core.inputs import numbers, require_one_of, require_whole
from ..core.maxima import bracketed_roots
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check, DeferredChecks, Result, provenance
from .circuits import Circuit, Complex, Taylor, planar
from .four_bar import FourBar
from .linkage import EPS, TURN, Array, Linkage, over, require_linkage

# Panels to begin with, and how often they are halved.
_PANELS, _HALVINGS = 24, 60


@dataclass(frozen=True, kw_only=True)
class CouplerCurve(Result):
    """Path of a point of a moving link over one whole circuit of the linkage.

    ``error``, shape (n,), is the distance of each position [m] from the exact one at the same
    ``parameter``.

    Attributes
    ----------
    linkage : Linkage
        What moves.
    circuit : int
        Which of its closed motions (see :func:`coupler_curve`).
    link : str
        The moving link.
    along, across : float
        Place of the point in the link's axes [m].
    parameter : ndarray, shape (n,)
        Regular parameter of the circuit, period 2 pi: the crank angle itself where the crank turns
        (for a slider-crank from the downward normal of the guide), else an angle in which the
        motion runs out on the open assembly (cosine positive) and back on the crossed one.
    theta2 : ndarray, shape (n,)
        Crank angle [rad].
    branch : ndarray, shape (n,)
        +1 open, -1 crossed.
    position, velocity, acceleration : ndarray, shape (n, 2)
        Place [m] and its derivatives by the crank angle [m/rad, m/rad^2]; these grow without bound
        towards a dead centre of the crank, on which no sample lies.
    curvature : ndarray, shape (n,)
        Curvature [1/m], positive to the left of increasing parameter; infinite on a cusp.
    centre : ndarray, shape (n, 2)
        Centre of curvature [m]; on a cusp the cusp itself, infinite where the path is straight.
    length, area : float
        Length run in one circuit [m], and area enclosed [m^2], positive when run anticlockwise.
    length_error, area_error : float
        Their errors.
    slowest : float
        Least speed over the largest, both by the parameter: how near the path is to a cusp.
    cusp_parameter, cusp_theta2, cusp_branch : ndarray, shape (k,)
        Where the point stops; also the ends of an arc that is run out and back.
    cusp_position : ndarray, shape (k, 2)
        The cusps [m].
    double_parameter, double_theta2, double_branch : ndarray, shape (m, 2)
        The two passages through each double point.
    double_position : ndarray, shape (m, 2)
        The double points [m].
    crossing_angle : ndarray, shape (m,)
        Angle between the two branches [rad], 0 to pi/2; near a tacnode two double points lie close
        together and both angles are small.
    """

    linkage: Linkage
    circuit: int
    link: str
    along: float
    across: float
    parameter: Array
    theta2: Array
    branch: Array
    position: Array
    velocity: Array
    acceleration: Array
    curvature: Array
    centre: Array
    length: float
    length_error: float
    area: float
    area_error: float
    slowest: float
    cusp_parameter: Array
    cusp_theta2: Array
    cusp_branch: Array
    cusp_position: Array
    double_parameter: Array
    double_theta2: Array
    double_branch: Array
    double_position: Array
    crossing_angle: Array

    arrays_along: ClassVar = {
        "point": "parameter theta2 branch curvature error",
        "point axis": "position velocity acceleration centre",
        "cusp": "cusp_parameter cusp_theta2 cusp_branch",
        "cusp axis": "cusp_position",
        "double_point passage": "double_parameter double_theta2 double_branch",
        "double_point axis": "double_position",
        "double_point": "crossing_angle",
    }
    column_units: ClassVar = {
        "m": "position centre length length_error along across cusp_position double_position error",
        "m/rad": "velocity",
        "m/rad^2": "acceleration",
        "1/m": "curvature",
        "m^2": "area area_error",
        "rad": "parameter cusp_parameter cusp_theta2 double_parameter double_theta2 crossing_angle",
    }

    def cognates(self) -> tuple[Cognate, Cognate]:
        """Return the two other four-bars that trace the path (Roberts and Chebyshev).

        Returns
        -------
        tuple of Cognate
            The first has its frame between A and the third focus, its crank parallel to the line
            from B to the tracing point; the second between D and the third focus.

        Raises
        ------
        BadInput
            If this is no path of a four-bar's coupler, or the point is a joint of it.

        Notes
        -----
        With u the direction of the coupler, g the point in it, k = g/l3: A + g u is one corner of a
        parallelogram A-B-P, and A + g u + k l2 exp(i theta2) keeps the distance |k| l4 from the
        third focus k l1.
        """
        if not isinstance(self.linkage, FourBar) or self.link != "coupler":
            kind = f"the {self.link} of a {type(self.linkage).__name__}"
            raise bad("cognates", kind, "the coupler of a FourBar", "others have no cognates")
        place = complex(self.along, self.across)
        f, c, m, n = (float(size) for size in self.linkage.lengths.values())
        if min(abs(place), abs(m - place)) <= 1e-12 * m:
            joint = f"{place.real:g}, {place.imag:g}"
            raise bad("along, across", joint, "no joint of the coupler", "choose another")
        at = Circuit(self.linkage, self.circuit).links(np.array([0.3]), 0)
        crank, u, follower = (complex(at[link].direction.c[0, 0]) for link in self.linkage.links)
        k, rest = place / m, m - place
        return (
            _cognate(0j, k * f, place * u, k * c * crank, c * crank),
            _cognate(complex(f), k * f, -rest * u, rest / m * n * follower, n * follower),
        )

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw path and linkage at some positions, cusps and double points marked."""
        from .pictures import draw_curve

        ax = axes_or_new(ax)
        draw_curve(ax, self)
        return ax


def coupler_curve(
    linkage: Linkage,
    along: float,
    across: float = 0.0,
    *,
    link: str = "coupler",
    points: int = 720,
    circuit: int = 0,
) -> CouplerCurve:
    """Return the path of a point of a moving link over the linkage's whole motion.

    Parameters
    ----------
    linkage : FourBar, SliderCrank or QuickReturn
        The linkage.
    along, across : float
        Place of the point in the link's own axes [m]: origin at the link's first joint, x along
        the link.
    link : str
        One of ``linkage.links``.
    points : int
        Positions along the path, 16 to 1000000; everything else is found apart from them.
    circuit : int
        Which closed motion.  A crank that turns: 0 the linkage's own assembly, 1 the other one.  A
        crank that swings in one range has circuit 0 alone, out on the open assembly and back on
        the crossed one.  A crank with two ranges: 0 the upper one (for a slider-crank the right
        one), 1 the other, each through both assemblies.

    Returns
    -------
    CouplerCurve
        Checks: for a coupler point of a four-bar, its places satisfy the implicit equation of
        sixth degree, and there are at most three double points; for a crank that turns, places
        and velocities agree with :meth:`Linkage.motion`.

    Raises
    ------
    BadInput
        If this is no linkage, the link, the circuit or a number is impossible, the linkage is at a
        change point (its circuits meet there), or the point stands still.

    Notes
    -----
    Aannaque 3.6.  A path run out and back (a point of the slider, or of a link that swings about a
    pivot) has its ends among the cusps, and no double points are listed: it consists of them.

    Examples
    --------
    >>> import elastolink as el
    >>> linkage = el.FourBar(frame=12.0, crank=6.0, coupler=12.0, follower=12.0)
    >>> curve = el.coupler_curve(linkage, along=6.0, across=4.0)
    >>> print(curve.position.shape, round(float(curve.length), 2))
    (720, 2) 35.58
    """
    require_linkage(linkage)
    motion = Circuit(linkage, circuit)
    place = _place(linkage, link, along, across)
    require_whole("points", points, 16, 10**6)
    motion.check()
    trace = _Trace(motion, link, place / motion.scale)
    if np.max(trace.speed(np.linspace(0.1, 6.2, 64))) <= 8 * EPS * trace.size:
        raise bad("along, across", "the pivot of the link", "a point that moves", "choose another")
    # Dead centres lie at +-pi/2; with this part of a step none is met for any number of points.
    shift = 0.0 if motion.turns else 0.375
    s: Array = (np.arange(float(points)) + shift) * (TURN / points)
    return CouplerCurve(
        linkage=linkage,
        circuit=circuit,
        link=link,
        along=float(along),
        across=float(across),
        parameter=s,
        theta2=motion.crank_angle(s),
        branch=motion.branch(s),
        **trace.local(s),
        **trace.sizes(),
        slowest=float(np.min(trace.slowest[1], initial=1.0)),
        **trace.marked(),
        method="Taylor series of the closed form; cusps and double points by Newton",
        error=trace.error(s),
        error_norm="distance of each position [m] from that at the same parameter",
        checks=DeferredChecks(partial(trace.checks, s)),
        provenance=provenance(linkage.provenance),
    )


def _place(linkage: Linkage, link: str, along: float, across: float) -> complex:
    """Return the place in the link as a complex number [m], or raise BadInput."""
    require_one_of("link", link, linkage.links, "choose a moving link")
    pair = [numbers(name, value) for name, value in (("along", along), ("across", across))]
    if pair[0].size != 1 or pair[1].size != 1:
        raise bad("along, across", f"{along!r}, {across!r}"[:60], "two lengths", "correct it")
    place = complex(*(float(part.item()) for part in pair))
    if not np.isfinite(place) or abs(place) > 1e6 * max(map(abs, linkage.lengths.values())):
        given = f"{place.real:g}, {place.imag:g}"
        raise bad("along, across", given, "lengths up to 1e6 of the linkage's", "correct it")
    return place


class _Doubles(NamedTuple):
    """Double points: both parameters (m, 2), the place, the sine between the two branches."""

    parameter: Array
    place: Complex
    sine: Array


@dataclass(frozen=True, eq=False)
class _Trace:
    """The path of one point: a circuit, a link, and the place in it over the circuit's scale."""

    motion: Circuit
    link: str
    place: complex

    def series(self, s: Array, order: int) -> Taylor:
        return self.motion.path(s, self.link, self.place, order)

    def speed(self, s: Array) -> Array:
        """Return the speed by the parameter."""
        return np.abs(self.series(s, 1).derivative(1))

    @property
    def sharp(self) -> Array:
        """Parameters about which the motion may change quickly: near a change point."""
        quarters = np.array([0.0, pi])
        return quarters if self.motion.turns else quarters + pi / 2

    @property
    def size(self) -> float:
        return float(sum(map(abs, self.motion.sizes.values())) + abs(self.place))

    @cached_property
    def slowest(self) -> tuple[Array, Array]:
        """Parameters of all local minima of the speed, and the speeds there over the largest.

        The derivative of the squared speed has a simple root at a cusp too, where the speed itself
        has a corner; bisection finds it whatever the speed left there.
        """

        def rate(s: Array) -> Array:
            at = self.series(s, 2)
            return np.asarray((at.derivative(1).conj() * at.derivative(2)).real)

        s = _graded(self.sharp)
        rates = rate(s)
        starts = np.flatnonzero((rates < 0) & (np.roll(rates, -1) >= 0))
        low, high = s[starts], np.append(s, s[0] + TURN)[starts + 1]
        rough, width, _ = bracketed_roots(lambda _, at: (rate(at), 0.0), low, high)
        # One step more: brackets stop at the noise of the rate's sign.
        at = self.series(rough, 2)
        first, second = at.derivative(1), at.derivative(2)
        step = over(-(first * second.conj()).real, np.abs(second) ** 2)
        better = self.speed(rough + step) < np.abs(first)
        least = np.where(better & (np.abs(step) <= 1e-6 + width), rough + step, rough)
        return least % TURN, self.speed(least) / np.max(self.speed(s))

    @property
    def stops(self) -> Array:
        """The parameters of cusps."""
        parameter, speed = self.slowest
        return parameter[speed <= _STILL]

    @cached_property
    def doubles(self) -> _Doubles:
        """The double points (crunodes), each once.

        By Newton's method from pairs of parameters near them.  The equation is ``(z(s1) - z(s2)) /
        sin((s1 - s2)/2) = 0``, so that the trivial solution s1 = s2 does not draw it in.  Loops so
        small that it loses digits stay as they are, but for those that a cusp has swallowed.
        """
        joints = (0.0, self.motion.sizes.get("coupler", 0.0))
        at_joint = min(abs(self.place - joint) for joint in joints) <= 64 * EPS * self.size
        # On a line, an arc or a circle about a joint nothing crosses.
        free = self.link in ("coupler", "block") and not at_joint
        pairs = crossings(self.motion, self.place).T if free else np.zeros((2, 0))
        wide = np.abs(np.sin(0.5 * (pairs[1] - pairs[0]))) > 1e-2
        for _ in range(40 if np.any(wide) else 0):
            stepped = self._newton(*pairs[:, wide])
            moved = np.max(np.abs(stepped - pairs[:, wide]))
            pairs[:, wide] = stepped
            if moved < 1e-13:
                break
        beside = np.abs(np.sin(0.5 * (pairs[:, :, None] - self.stops)))
        swallowed = np.any(np.all(beside < 1e-3, axis=0), axis=1)
        apart = np.abs(np.sin(0.5 * (pairs[1] - pairs[0]))) > 1e-6
        first, second = np.sort(pairs[:, apart & ~swallowed] % TURN, axis=0)
        one, two = self.series(first, 1).c, self.series(second, 1).c
        gap, across = np.abs(one[0] - two[0]), np.abs((one[1].conj() * two[1]).imag)
        sine = over(across, np.abs(one[1]) * np.abs(two[1]))
        good = np.flatnonzero((gap <= 64 * EPS * self.size) & (sine > 64 * EPS))
        kept: list[int] = []
        for i in good[np.argsort(gap[good], kind="stable")]:
            # Where the branches nearly touch, the crossing is loose along them.
            slack = 1e-9 + 1e3 * EPS / max(float(sine[i]), EPS)
            a, b = first[kept], second[kept]
            # How far the pairs are apart, either way round.
            ways = [
                np.maximum(_turn(first[i] - x), _turn(second[i] - y)) for x, y in ((a, b), (b, a))
            ]
            if np.all(np.minimum(*ways) > slack):
                kept.append(i)
        kept.sort(key=lambda i: float(first[i]))
        chosen = np.stack([first[kept], second[kept]], axis=1)
        return _Doubles(chosen, 0.5 * (one[0] + two[0])[kept], sine[kept])

    def _newton(self, first: Array, second: Array) -> Array:
        """Return the next parameters of double points, (2, k)."""
        places, rates = self.series(np.concatenate([first, second]), 1).c.reshape(2, 2, -1)
        gap = places[0] - places[1]
        half = 0.5 * (first - second)
        sine = np.sin(half)
        sine = np.where(np.abs(sine) < 1e-12, 1e-12, sine)
        slope = 0.5 * gap * np.cos(half) / sine
        a, b = rates[0] - slope, slope - rates[1]
        determinant = (a.conj() * b).imag
        determinant = np.where(determinant == 0, 1e-300, determinant)
        with np.errstate(over="ignore", invalid="ignore"):
            x = (-gap * b.conj()).imag / -determinant
            y = (a.conj() * -gap).imag / determinant
        # The farther the step, the less it can be trusted.
        x, y = (np.clip(np.nan_to_num(step), -0.2, 0.2) for step in (x, y))
        return np.stack([first + x, second + y])

    def local(self, s: Array) -> dict[str, Any]:
        """Return place, velocity, acceleration, curvature and its centre at samples."""
        at, scale = self.series(s, 2), self.motion.scale
        crank = self.motion.links(s, 2)["crank"].direction
        turn = [(crank.derivative(k) * crank.c[0].conj()).imag for k in (1, 2)]
        first, second = at.derivative(1), at.derivative(2)
        velocity = first / turn[0]
        acceleration = (second - velocity * turn[1]) / turn[0] ** 2
        curvature, centre = self._curvature(s, at)
        return {
            "position": scale * planar(at.c[0]),
            "velocity": scale * planar(velocity),
            "acceleration": scale * planar(acceleration),
            "curvature": curvature / scale,
            "centre": scale * centre,
        }

    def _curvature(self, s: Array, at: Taylor) -> tuple[Array, Array]:
        """Return curvature and its centre, (n, 2), safe on cusps and where the path is straight."""
        z, first, second = (at.derivative(k) for k in range(3))
        speed, bend = np.abs(first), (first.conj() * second).imag
        if self.link in ("crank", "follower", "rod"):
            # A circle about the pivot, even where the point stops to turn back.
            pivot = self.motion.links(s, 0)[self.link].origin.c[0]
            turning = np.where((first * (z - pivot).conj()).imag >= 0, 1.0, -1.0)
            return turning / abs(self.place), planar(pivot)
        stopped = speed <= 16 * EPS * self.size
        straight = np.abs(bend) <= 4 * EPS * speed * np.abs(second)
        straight |= self.link == "slider"
        with np.errstate(divide="ignore", invalid="ignore"):
            curvature = np.where(straight, 0.0, bend / speed**3)
            radius = np.where(straight, np.inf, speed**3 / bend)
            toward = np.where(stopped, 0.0, 1j * first / speed)
            offset_x = np.where(toward.real == 0, 0.0, toward.real * radius)
            offset_y = np.where(toward.imag == 0, 0.0, toward.imag * radius)
        cusp = stopped & ~straight
        offset = np.stack([np.where(cusp, 0.0, part) for part in (offset_x, offset_y)], axis=-1)
        return np.where(cusp, np.inf, curvature), planar(z) + offset

    def sizes(self) -> dict[str, Any]:
        """Return length and area with their errors."""

        def integrands(s: Array) -> Array:
            at = self.series(s, 1)
            z, first = at.c[0] - middle, at.derivative(1)
            return np.stack([np.abs(first), 0.5 * (z.conj() * first).imag])

        middle = complex(np.mean(self.series(np.linspace(0, 2 * pi, 64), 0).c[0]))
        total, error = _integrate_turn(integrands, np.concatenate([self.slowest[0], self.sharp]))
        scale = self.motion.scale
        return {
            "length": float(total[0]) * scale,
            "length_error": float(error[0]) * scale,
            "area": float(total[1]) * scale**2,
            "area_error": float(error[1]) * scale**2,
        }

    def marked(self) -> dict[str, Any]:
        """Return cusps and double points as the fields of the result."""
        cusps, (pairs, places, sine) = np.sort(self.stops), self.doubles
        flat, scale = pairs.ravel(), self.motion.scale
        return {
            "cusp_parameter": cusps,
            "cusp_theta2": self.motion.crank_angle(cusps),
            "cusp_branch": self.motion.branch(cusps),
            "cusp_position": scale * planar(self.series(cusps, 0).c[0]),
            "double_parameter": pairs,
            "double_theta2": self.motion.crank_angle(flat).reshape(pairs.shape),
            "double_branch": self.motion.branch(flat).reshape(pairs.shape),
            "double_position": scale * planar(places),
            "crossing_angle": np.arcsin(np.minimum(sine, 1.0)),
        }

    def error(self, s: Array) -> Array:
        """Return three times what a round-off of parameter and lengths does to the place."""
        moved, turned = np.abs(s) * self.speed(s), abs(self.place) * self._blur(s)
        return np.asarray(1.5 * EPS * (moved + turned + self.size) * self.motion.scale)

    def _blur(self, s: Array) -> Array:
        """Return the error of the direction of the link in units of round-off."""
        size, lim, stops = self.motion.sizes, self.motion.limits, self.motion.swings
        if self.link in ("crank", "slider"):
            return np.ones(s.shape)
        if self.motion.linkage.mechanism == "quick_return":
            reach = np.abs(self.motion.joints(s)["B"] / self.motion.scale + size["frame"])
            return 2.0 + (size["frame"] + size["crank"]) / reach
        psi = self.motion.crank_angle(s) - self.motion.linkage.fold_axis
        q = np.sin(psi / 2) ** 2
        low, high = np.maximum(q - lim.q1, 0.0), np.maximum(lim.q2 - q, 0.0)
        root = np.zeros(s.shape)
        for end, other, limit, stop in (
            (low, high, lim.q1, stops[0]),
            (high, low, lim.q2, stops[1]),
        ):
            # The root passes on the round-off of its factors, but for a cos s in both of them.
            lost = (q + abs(limit)) * np.sqrt(other / np.maximum(end, 1e-300))
            root += np.sqrt(end * other) if stop else lost
        if self.motion.linkage.mechanism == "slider_crank":
            return 3.0 + 2.0 * size["crank"] * root / size["coupler"]
        f, c, m, n = (size[k] for k in ("frame", "crank", "coupler", "follower"))
        reach = np.sqrt((f - c) ** 2 + 4 * f * c * q)
        length = n if self.link == "follower" else m
        base = (f + c) / reach + (reach**2 + m**2 + n**2) / (reach * length)
        return np.asarray(base + 2.0 * f * c * root / (reach * length))

    def checks(self, s: Array) -> dict[str, Check]:
        """Compare with the mechanism's own motion, and with the equation of the curve."""
        motion, at, scale = self.motion, self.series(s, 1), self.motion.scale
        checks: dict[str, Check] = {}
        mechanism = None
        if motion.number == 0 and motion.turns and motion.linkage.crank_turns:
            # A hair from a change point it declines positions that this circuit passes.
            with suppress(BadInput):
                mechanism = motion.linkage.motion(motion.crank_angle(s))
        if mechanism is not None:
            place = self.place * scale
            point = mechanism.point(self.link, place.real, place.imag)
            blur = 2 * (self.error(s) / scale + 4 * EPS * self.size * (1 + mechanism.error / EPS))
            moved = blur * (1 + np.abs(at.derivative(1)) / self.size)
            for name, there, here, slack in (
                ("places", point.position, at.c[0], blur),
                ("velocities", point.velocity, at.derivative(1), moved),
            ):
                worst = float(np.max(np.hypot(*(there / scale - planar(here)).T) / slack))
                label = f"{name} against the mechanism's motion, over their round-off"
                checks[label] = Check(worst, 1)
        if motion.linkage.mechanism == "four_bar" and self.link == "coupler":
            worst = float(np.max(sextic_residual(motion.sizes, self.place, at.c[0])))
            checks["equation of sixth degree, over its terms"] = Check(worst, 1e-12)
            checks["double points"] = Check(float(len(self.doubles.place)), 3.0)
        return checks


def _integrate_turn(f: Callable[[Array], Array], breaks: Array) -> tuple[Array, Array]:
    """Integrate over 0 to 2 pi, halving the panels on which two Gauss rules differ."""
    # Panels end at the breaks, where an integrand has a kink.  The error is the sum of the
    # differences of the panels, generous, and round-off.
    ends = np.unique(np.concatenate([np.linspace(0, 2 * pi, _PANELS + 1), breaks % (2 * pi)]))
    low, high = ends[:-1], ends[1:]
    sums: Any = 0.0
    for level in range(_HALVINGS):
        few, _ = _panels(f, low, high, 10)
        many, size = _panels(f, low, high, 16)
        difference = np.abs(many - few)
        if level == 0:
            scale = np.sum(size, axis=1)
        good = np.all(difference <= 0.5 * EPS * scale[:, None], axis=0)
        # More panels than this at once: what is left is the round-off of the integrands.
        if level == _HALVINGS - 1 or np.count_nonzero(~good) > 2000:
            good[:] = True
        sums = sums + np.stack([many, difference, size])[..., good].sum(axis=-1)
        if np.all(good):
            break
        low, high = low[~good], high[~good]
        middle = 0.5 * (low + high)
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    total, error, whole = sums
    return total, error + 8.0 * EPS * whole


def _panels(
    f: Callable[[Array], Array], low: Array, high: Array, nodes: int
) -> tuple[Array, Array]:
    """Return the integrals of f and of its size over each panel, shape (k, panels)."""
    places, weights = np.polynomial.legendre.leggauss(nodes)
    half = 0.5 * (high - low)
    s = 0.5 * (high + low)[:, None] + half[:, None] * places
    values = f(s.ravel())
    values = values.reshape(len(values), *s.shape)
    return np.sum(values * weights, axis=2) * half, np.sum(np.abs(values) * weights, axis=2) * half


def sextic_residual(lengths: Mapping[str, float], place: complex, points: Complex) -> Array:
    """Return how far points miss the implicit equation of a coupler curve, over its terms.

    With p the tracing point as a complex number, p = B + g u, and w = p - f seen from D, where u is
    the direction of the coupler, g the place of the point in it and d = l3 - g, the two bars demand

        conj(p) g u + p conj(g) conj(u) = M,     M = |p|^2 + |g|^2 - l2^2
        conj(w) d u + w conj(d) conj(u) = -N,    N = |w|^2 + |d|^2 - l4^2

    Eliminating u by |u| = 1 leaves |M w conj(d) + N p conj(g)|^2 = 4 Im(conj(p) g w conj(d))^2, of
    degree six in the coordinates of p.
    """
    f, crank, coupler, follower = (lengths[name] for name in FourBar.names)
    rest = coupler - place
    w = points - f
    m = np.abs(points) ** 2 + abs(place) ** 2 - crank**2
    n = np.abs(w) ** 2 + abs(rest) ** 2 - follower**2
    left = m * w * np.conj(rest) + n * points * np.conj(place)
    right = 2.0 * (np.conj(points) * place * w * np.conj(rest)).imag
    size_m = np.abs(points) ** 2 + abs(place) ** 2 + crank**2
    size_n = np.abs(w) ** 2 + abs(rest) ** 2 + follower**2
    size = size_m * np.abs(w * rest) + size_n * np.abs(points * place)
    size = size + 2.0 * np.abs(points * place * w * rest)
    # Both sides are squares; their difference in the linear measure of a distance.
    return np.asarray(np.abs(np.abs(left) - np.abs(right)) / np.maximum(size, 1e-300))


@dataclass(frozen=True, eq=False)
class Cognate:
    """A four-bar that traces the coupler curve of another one.

    Attributes
    ----------
    linkage : FourBar
        In axes of its own.
    along, across : float
        The tracing point in its coupler's axes [m].
    pivot : ndarray, shape (2,)
        Where its crank's pivot lies in the axes of the first linkage [m].
    turn : float
        Angle of its frame there [rad].
    circuit : int
        On which of its circuits it traces the circuit of the first linkage.
    """

    linkage: FourBar
    along: float
    across: float
    pivot: Array
    turn: float
    circuit: int

    def curve(self, points: int = 720) -> CouplerCurve:
        """Return its coupler curve, in its own axes."""
        return coupler_curve(
            self.linkage, self.along, self.across, points=points, circuit=self.circuit
        )

    def placed(self, position: Array) -> Array:
        """Return places in the axes of the first linkage, shape (..., 2)."""
        place = np.asarray(position)[..., 0] + 1j * np.asarray(position)[..., 1]
        return np.asarray(self.pivot + planar(place * np.exp(1j * self.turn)))


def _cognate(
    pivot: complex, focus: complex, crank: complex, coupler: complex, point: complex
) -> Cognate:
    """Build a four-bar from its vectors at one position; ``point`` from the crank's pin."""
    frame = focus - pivot
    to_pivot = frame - crank
    side = (to_pivot.conjugate() * coupler).imag
    lengths = (abs(frame), abs(crank), abs(coupler), abs(frame - crank - coupler))
    linkage = FourBar(*lengths, assembly="open" if side > 0 else "crossed")
    motion = Circuit(linkage)
    upper = (crank / frame).imag > 0
    # Of two ranges of the crank the upper one comes first; a crank that turns has its assembly.
    circuit = int(not upper) if all(motion.swings) else 0
    place = point * abs(coupler) / coupler
    turn = float(np.angle(frame))
    return Cognate(linkage, place.real, place.imag, planar(pivot), turn, circuit)


_UNIFORM = 720
# Samples draw near a sharp turn by this ratio, down to this distance.
_GRADING, _NEAREST = 1.6, 1e-9
# A point whose speed falls below this part of its largest is said to stop: a cusp.
_STILL = 1e-11


def _graded(sharp: Array) -> Array:
    """Return uniform parameters, and closer ones about sharp turns; increasing, in one turn."""
    uniform = (np.arange(_UNIFORM) + 0.5) * TURN / _UNIFORM
    levels = int(np.log(TURN / _UNIFORM / _NEAREST) / np.log(_GRADING)) + 1
    steps = TURN / _UNIFORM * _GRADING ** -np.arange(levels)
    near = np.concatenate([steps, [0.0], -steps])
    places = np.concatenate([uniform, (sharp[:, None] + near).ravel()]) % TURN
    return np.unique(places)


def crossings(motion: Circuit, place: complex) -> Array:
    """Return pairs of parameters (k, 2) at which a point of coupler or block is in one place.

    Of the direction u of the link the crank demands ``2 Re(a u) = M``, the other joint ``2 Re(b u)
    = N``.  Two directions satisfy both where the one is a multiple of the other, ``a = r b`` and
    ``M = r N``: at the real roots r of a polynomial, and at the fixed pivot where r is infinite.
    """
    g, kind = place, motion.linkage.mechanism
    locus = {"four_bar": _four_bar, "slider_crank": _slider_crank, "quick_return": _quick_return}
    places, other = locus[kind](motion.sizes, g)

    def parameter(p: complex, u: complex) -> float | None:
        """Return where on the circuit the link has the direction u with its point at p."""
        pin = p - g * u
        if kind == "four_bar":
            branch = np.sign(((motion.sizes["frame"] - pin).conjugate() * u).imag)
        elif kind == "slider_crank":
            branch = np.sign(u.real)
        else:
            branch = np.sign((u.conjugate() * (pin + motion.sizes["frame"])).real)
        return motion.parameter(pin / motion.sizes["crank"], float(branch))

    pairs = []
    for p in places:
        crank = p.conjugate() * g, abs(p) ** 2 + abs(g) ** 2 - motion.sizes["crank"] ** 2
        factor, level = max(crank, other(p), key=lambda equation: abs(equation[0]))
        cosine = level / (2.0 * abs(factor))
        if not abs(cosine) < 1.0:
            continue
        turns = [complex(cosine, sign * np.sqrt(1.0 - cosine**2)) for sign in (1.0, -1.0)]
        both = [parameter(p, u * factor.conjugate() / abs(factor)) for u in turns]
        if None not in both:
            pairs.append(both)
    return np.array(pairs, dtype=float).reshape(-1, 2)


# Places p at which one equation for u is a multiple of the other, and b, N of the other joint at p.
Locus: TypeAlias = tuple[list[complex], Callable[[complex], tuple[complex, float]]]


def _four_bar(size: Mapping[str, float], g: complex) -> Locus:
    f, n, d = size["frame"], size["follower"], size["coupler"] - g
    square = [abs(d) ** 2, -2.0 * (d * g.conjugate()).real, abs(g) ** 2]
    terms = np.polymul([abs(d) ** 2 - n**2, abs(g) ** 2 - size["crank"] ** 2], square)
    terms = np.polyadd(terms, [f**2 * abs(d) ** 2, f**2 * abs(g) ** 2, 0.0])
    places = [f * r / (r - (g / d).conjugate()) for r in _real_roots(terms)]
    if abs(abs(d) - n) < 1e-6 * n:
        places.append(complex(f))
    return places, lambda p: ((p - f).conjugate() * d, n**2 - abs(p - f) ** 2 - abs(d) ** 2)


def _slider_crank(size: Mapping[str, float], g: complex) -> Locus:
    d, e = size["coupler"] - g, size["offset"]
    ratio = d / g
    least = abs(g) ** 2 - size["crank"] ** 2
    roots = _real_roots([abs(ratio) ** 2 + 2.0 * ratio.real, -2.0 * e, least])
    places = [1j * r * ratio.conjugate() for r in roots]
    return places, lambda p: (-1j * d, 2.0 * (e - p.imag))


def _quick_return(size: Mapping[str, float], g: complex) -> Locus:
    f, least = size["frame"], abs(g) ** 2 - size["crank"] ** 2
    terms = np.polymul([2.0 * g.imag, least], [1.0, 2.0 * g.imag, abs(g) ** 2])
    roots = _real_roots(np.polyadd(terms, [f**2, 0.0, 0.0]))
    places = [1j * r * f / (g.conjugate() - 1j * r) for r in roots]
    if abs(g.imag) < 1e-6 * abs(g):
        places.append(complex(-f))
    return places, lambda p: (-1j * (p + f).conjugate(), -2.0 * g.imag)


def _real_roots(terms: ArrayLike) -> Array:
    """Return the real roots of a polynomial, and those that may be real."""
    roots = np.roots(terms)
    return np.asarray(roots[np.abs(roots.imag) <= 1e-6 * np.abs(roots)].real)


def _turn(x: Array) -> Array:
    return np.asarray(np.abs((x + pi) % TURN - pi))
