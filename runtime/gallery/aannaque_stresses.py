"""Aannaque's Figs. 7.7 to 7.11: largest stress over the speed, elements and damping."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache, partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..core.families import Array, LinearPeriodic, Term
from .aannaque_lengths import bending_at_midpoint
from .aannaque_models import (
    FORM_NOTE,
    FULL,
    LINKS,
    RANGE_NOTE,
    THESIS,
    beams,
    maxima,
    nearest,
    periodic,
    stresses,
)
from .records import Drawn, Quoted
from .style import COLOURS, crank_axis, legend_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .aannaque_hybrid import HybridMatrices

_SPEEDS = np.linspace(5.0, 70.0, 326)
_FEWER = np.linspace(10.0, 70.0, 121)
_RATIOS = (0.02, 0.03, 0.06)
_ANGLES = 128


# ---------------------------------------------------------------- the "exact" model


@lru_cache(maxsize=2)
def _hybrid(rtol: float) -> HybridMatrices:
    from .aannaque_hybrid import hybrid_matrices

    structure = beams(1).structure
    assert structure is not None
    return hybrid_matrices(structure, 2.0 * np.pi * np.arange(_ANGLES) / _ANGLES, rtol=rtol)


def _series(coefficients: NDArray[np.complex128], order: int, theta: Array) -> Array:
    """Return a Fourier series, or its derivative of an order, ``(nt, ...)``."""
    harmonics = np.arange(len(coefficients))
    factors = (1j * harmonics) ** order * np.where(harmonics, 2.0, 1.0)
    waves = np.exp(1j * np.outer(theta, harmonics)) * factors
    return np.asarray(np.tensordot(waves, coefficients, axes=1).real)


@lru_cache(maxsize=1)
def hybrid_model() -> LinearPeriodic:
    """Return the thesis' "exact" model: one element for each link, M and K at the first frequency.

    Damping 2 %, the form of the thesis; the inertia of the rigid motion by the same masses.
    """
    from ..systems import with_modal_damping

    base, found = beams(1), _hybrid(1e-10)
    order = [found.labels.index(label) for label in base.labels]
    places = np.ix_(range(_ANGLES), order, order)
    mass, stiffness = found.mass[places], found.stiffness[places]
    cubic, force = base.array("M", found.theta), base.array("f", found.theta)
    push = mass @ np.linalg.solve(cubic, force[..., None])
    kept = _ANGLES // 2
    m, k, f = (np.fft.rfft(a, axis=0)[:kept] / _ANGLES for a in (mass, stiffness, push[..., 0]))
    terms = (
        Term("M", None, partial(_series, m, 0)),
        # The family's own M' is taken out, as of any instantaneous form.
        Term("C", None, partial(_series, -m, 1), power=1),
        Term("K", None, partial(_series, k, 0)),
        Term("f", None, partial(_series, f, 0)),
    )
    bare = LinearPeriodic(
        base.size,
        terms,
        {},
        lambda values: {},
        labels=base.labels,
        relative_deflection=base.relative_deflection,
        structure=base.structure,
    )
    return with_modal_damping(bare, 0.02)


# ---------------------------------------------------------------- Figs. 7.7, 7.10, 7.11


@lru_cache(maxsize=8)
def _curve(elements: int, ratio: float = 0.02, drop: tuple[str, ...] = THESIS) -> Array:
    """Return the largest stress of crank, coupler and follower [Pa], (ns, 3)."""
    found = stresses(beams(elements, drop, ratio=ratio), _SPEEDS)
    return np.stack([found.of(link) for link in LINKS], axis=1)


def _speed_axes(ax: Axes) -> None:
    ax.set_xlim(_SPEEDS[0], _SPEEDS[-1])
    ax.set_ylim(bottom=0.3)
    ax.set_xlabel("crank speed [rad/s]")


def damping_figure(ratio: float) -> Callable[[Sequence[Axes]], Drawn]:
    """Return the drawing of the largest stress of each link over the speed, one damping ratio."""

    def draw(axes: Sequence[Axes]) -> Drawn:
        ax = axes[0]
        for drop, style, lead in ((THESIS, "-", ""), (FULL, ":", "full form, ")):
            for link, colour, values in zip(LINKS, COLOURS, _curve(3, ratio, drop).T, strict=False):
                label = f"{lead}{link}"
                ax.semilogy(_SPEEDS, 1e-6 * values, style, color=colour, label=label)
        _speed_axes(ax)
        ax.set_ylabel("largest stress [MPa]")
        legend_below([ax], columns=3)
        note = (
            f"Three elements for each link, damping {100 * ratio:g} %; axial and bending stress by "
            f"the shape functions at 7 places. {FORM_NOTE} {RANGE_NOTE}"
        )
        return Drawn(_damping_rows(ratio), (note,))

    return draw


def _damping_rows(ratio: float) -> tuple[Quoted, ...]:
    if ratio == _RATIOS[0]:
        return (_stiffening_row(),)
    base, own = _curve(3), _curve(3, ratio)
    rows = []
    for place, link in enumerate(LINKS):
        at = [
            int(np.argmin(np.abs(_SPEEDS - top)))
            for top in maxima(_SPEEDS, base[:, place], 0.1)
            if top > 20.0
        ]
        rows.append(
            Quoted(
                f"stress of the {link} at its critical speeds over that with 2 %, largest",
                1.0,
                float(np.max(own[at, place] / base[at, place])),
                0.0,
                "'invariably reduces stresses in links at the critical speeds' (7.6); maxima that "
                "stand out by a tenth, above 20 rad/s",
                "7.4.2",
                relation="<",
            )
        )
    slow = _SPEEDS > 20.0
    rows.append(
        Quoted(
            "stress of a link over that with 2 %, largest over the speeds",
            1.0,
            float(np.max((own / base)[slow])),
            0.0,
            "'for the quiet speeds it is counterproductive for some links'",
            "7.4.2",
            relation=">",
        )
    )
    return tuple(rows)


def _stiffening_row() -> Quoted:
    slow = (_SPEEDS > 20.0) & (_SPEEDS < 30.0)
    gap = np.abs(_curve(3, 0.02, FULL) / _curve(3) - 1.0)
    return Quoted(
        "stress of the full form over the thesis' form less 1, largest, 20 to 30 rad/s",
        0.02,
        float(np.max(gap[slow])),
        0.0,
        "(7.1) leaves stiffening and the moving frame's terms out: read as below 2 %",
        "7.2",
        relation="<",
        differs="they change the stress by a tenth at 20 to 30 rad/s, by more at higher speeds",
    )


# ---------------------------------------------------------------- Figs. 7.8 and 7.9


@lru_cache(maxsize=1)
def _hybrid_curve() -> Array:
    """Return the largest stress of all links [Pa] of the "exact" model, by cubic shapes."""
    from ..recovery import stress_operator

    motion = periodic(hybrid_model(), _FEWER, rtol=1e-3)
    form = stress_operator(beams(1), motion.theta, 7, method="shape")[0]
    largest = [
        float(np.max(np.abs(form.values(float(speed), q, qd / speed))))
        for speed, q, qd in zip(_FEWER, motion.q, motion.qd, strict=True)
    ]
    return np.array(largest)


def figure_7_8(axes: Sequence[Axes]) -> Drawn:
    """Draw the largest stress over the speed for one, two and three elements, and "exact"."""
    ax = axes[0]
    for count, colour in zip((1, 2, 3), COLOURS, strict=False):
        label = f"{count} element{'s' if count > 1 else ''}"
        ax.semilogy(_SPEEDS, 1e-6 * np.max(_curve(count), axis=1), color=colour, label=label)
    ax.semilogy(_FEWER, 1e-6 * _hybrid_curve(), "--", color="0.2", label='"exact"')
    _speed_axes(ax)
    ax.set_ylabel("largest stress of all links [MPa]")
    legend_below([ax])
    note = (
        '"Exact": one element for each link, M and K of the dynamic stiffness at the first natural '
        "frequency of each angle; its stresses, too, come from cubic shapes. Damping 2 %. "
        f"{FORM_NOTE} {RANGE_NOTE}"
    )
    return Drawn(tuple(_element_rows()), (note,))


def _first_mode_speeds() -> list[float]:
    """Return the speeds mean/3 of the first frequency: one, two, three elements and exact."""
    from ..frequencies import natural_frequencies

    means = [float(natural_frequencies(beams(count), 0.0, 1).mean[0]) / 3.0 for count in (1, 2, 3)]
    return [*means, float(np.mean(_hybrid(1e-10).first)) / 3.0]


def _element_rows() -> list[Quoted]:
    tops = [
        nearest(maxima(_SPEEDS, np.max(own, axis=1)), guess)
        for own, guess in zip((_curve(1), _curve(2), _curve(3)), (26.2, 23.5, 23.5), strict=True)
    ]
    speeds = _first_mode_speeds()
    return [
        Quoted(
            "mean first frequency over 3, one element against three",
            1.02,
            speeds[0] / speeds[2],
            0.0,
            "'overestimates the critical speeds noticeably', read as 2 %",
            "7.4.1",
            relation=">",
        ),
        Quoted(
            "the same, two elements against three",
            1.0,
            speeds[1] / speeds[2],
            0.005,
            "'converges quite rapidly', read as half a per cent",
            "7.4.1",
        ),
        Quoted(
            'the same, three elements against "exact"',
            1.0,
            speeds[2] / speeds[3],
            0.005,
            "half a per cent",
            "7.4.1",
        ),
        Quoted(
            "maximum of the stress near 24 rad/s, two elements against three",
            1.0,
            tops[1] / tops[2],
            0.02,
            "the response's own critical speed, 2 %",
            "7.4.1",
        ),
        Quoted(
            "iterations of the frequency to 1e-3, most over the cycle",
            5.0,
            float(np.max(_hybrid(1e-3).iterations)),
            0.0,
            "'a maximum of 5 iterations'; 128 angles",
            "7.4.1",
            relation="<",
        ),
    ]


@lru_cache(maxsize=4)
def _at_midpoint(model: int) -> tuple[Array, Array]:
    """Return angles and stress at the follower's midpoint; 0 stands for the "exact" model."""
    return (
        bending_at_midpoint(beams(model))
        if model
        else bending_at_midpoint(beams(1), hybrid_model())
    )


def figure_7_9(axes: Sequence[Axes]) -> Drawn:
    """Draw the stress at the follower's midpoint over the cycle at 30 rad/s, four models."""
    ax = axes[0]
    names = {1: "1 element", 2: "2 elements", 3: "3 elements", 0: '"exact"'}
    for (model, name), colour in zip(names.items(), (*COLOURS[:3], "0.2"), strict=True):
        theta, values = _at_midpoint(model)
        style = "-" if model else "--"
        ax.plot(np.degrees(theta), 1e-6 * values, style, color=colour, label=name)
    crank_axis(ax)
    ax.set_xlabel("input angle $t_1$ [deg]")
    ax.set_ylabel("stress at the follower's midpoint [MPa]")
    legend_below([ax])
    note = f"30 rad/s, damping 2 %, bending stress by the shape functions. {FORM_NOTE}"
    return Drawn(tuple(_model_rows()), (note,))


def _even(model: int) -> Array:
    """Return the stress at 512 even angles."""
    values = _at_midpoint(model)[1]
    half = np.fft.rfft(values) / len(values)
    return np.asarray(_series(half[:200], 0, 2.0 * np.pi * np.arange(512) / 512))


def _likeness(one: Array, two: Array) -> float:
    return float(np.corrcoef(one, two)[0, 1])


def _model_rows() -> list[Quoted]:
    motions = {model: _even(model) for model in (0, 1, 2, 3)}
    peaks = {model: float(np.max(np.abs(values))) for model, values in motions.items()}
    return [
        Quoted(
            "correlation of the stress with two elements and that with three",
            0.95,
            _likeness(motions[2], motions[3]),
            0.0,
            "'a good phase agreement', read as 0.95",
            "7.4.1",
            relation=">",
        ),
        Quoted(
            "correlation of one element with three over that of two with three",
            1.0,
            _likeness(motions[1], motions[3]) / _likeness(motions[2], motions[3]),
            0.0,
            "'apart from the model with one element'",
            "7.4.1",
            relation="<",
        ),
        Quoted(
            "largest stress with two elements over that with one",
            1.0,
            peaks[2] / peaks[1],
            0.0,
            "'the maximum amplitude decreases as the number of elements increases'",
            "7.4.1",
            relation="<",
            differs="one cubic element has a straight bending moment: what inertia does between "
            "its ends is not in it; from two elements on it is so",
        ),
        Quoted(
            "largest stress with three elements over that with two",
            1.0,
            peaks[3] / peaks[2],
            0.0,
            "the same",
            "7.4.1",
            relation="<",
        ),
    ]
