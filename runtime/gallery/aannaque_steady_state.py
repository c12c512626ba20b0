"""Aannaque's chapter 6: Newmark's scheme, modes, convergence to the steady state, operations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.trigonometric import even_angles
from ..frequencies.held import HeldCrank
from ..periodic import SteadyState, cycles_to_settle, steady_state
from .aannaque_beams import CRITICAL, FULL, THESIS, beams, midpoint, moved, rms
from .algorithms import modal_motion, newmark_limit, newmark_maps, operation_count, printed_count
from .drawing import COLOURS, Array, Looks, Panels, panel_title, turn
from .records import Drawn, contents

_SPEED = 35.0
_FORMS = ((THESIS, "the thesis' form"), (FULL, "full form with stiffening"))
# Tables 6.2 and 6.3 as printed.
_TABLES = contents("aannaque")["table_6"]
_NAMES: Mapping[str, str] = _TABLES["algorithms"]


def figure_6_1(axes: Panels, said: Sequence[tuple[float, float, str]], looks: Looks) -> Drawn:
    """Draw the regions of stability of Newmark's scheme over gamma and beta."""
    ax, right = axes[0], np.linspace(0.5, 1.2, 71)
    pairs, real = 0.25 * (right + 0.5) ** 2, 0.5 * right
    ax.axvspan(0.0, 0.5, color="#c9ced3", lw=0.0)
    ax.fill_between(right, 0.0, real, color="#f1dcc6", lw=0.0)
    ax.fill_between(right, real, pairs, color="#dfeadf", lw=0.0)
    ax.fill_between(right, pairs, 0.8, color="#c2dcc4", lw=0.0)
    ax.axvline(0.5, color="0.3", lw=0.8)
    curves: tuple[Any, ...] = ((right, pairs), (right, real), (0.5, 0.25), (0.5, 1.0 / 6.0))
    for curve, look in zip(curves, looks, strict=True):
        ax.plot(*curve, **look)
    for x, y, words in said:
        ax.text(x, y, words, ha="center", va="center")
    # The least beta that is stable at every step: beside round values, on which round-off decides.
    fine = 1e-12 + np.linspace(0.0, 1.0, 1000001)
    return Drawn([fine[np.isinf(newmark_limit(0.5, fine))][0]])


@lru_cache(maxsize=1)
def _whole() -> SteadyState:
    return steady_state(beams(1), _SPEED, rtol=1e-5)


@lru_cache(maxsize=8)
def _uncoupled(modes: int) -> Array:
    """Return the motion by uncoupled modes, constant in each of 256 intervals, ``(256, n)``."""
    return modal_motion(beams(1), _SPEED, 256, modes)


def _across(link: str, q: Array) -> Array:
    """Return the displacement across a link's midpoint of a motion at even angles [m]."""
    return moved(beams(1), link, even_angles(2.0 * np.pi, len(q)), q)


def deflections(axes: Panels, link: str, looks: Looks) -> Drawn:
    """Draw a link's midpoint over the cycle, with and without uncoupled modes (Fig. 6.3)."""
    full = steady_state(beams(1, FULL), _SPEED, rtol=1e-5)
    for q, look in zip((_whole().q, _uncoupled(9), _uncoupled(4), full.q), looks, strict=True):
        turn(axes[0], even_angles(2.0 * np.pi, len(q)), 1e3 * _across(link, q), **look)
    coupler, follower = _gap("coupler", 9), _gap("follower", 9)
    if link == "follower":
        return Drawn([follower])
    return Drawn([coupler, coupler / follower, _gap("coupler", 4)])


def _gap(link: str, modes: int) -> float:
    """Return the rms of what uncoupled modes are off by over the rms of the displacement."""
    exact = _across(link, _whole().q)
    return float(rms(_across(link, _uncoupled(modes)) - exact) / rms(exact))


@lru_cache(maxsize=2)
def _contributions(link: str) -> tuple[Array, Array]:
    """Return the displacement at a midpoint and the part of each mode, (nt,) and (nt, 9) [m]."""
    system, motion = beams(1), _whole()
    row, held = midpoint(system, link, motion.theta), HeldCrank(system, {}).modes(motion.theta)
    amplitudes = np.einsum("tnk,tnm,tm->tk", held.shape, held.mass, motion.q)
    return np.einsum("tn,tn->t", row, motion.q), np.einsum(
        "tn,tnk->tk", row, held.shape
    ) * amplitudes


def contributions(axes: Panels, link: str) -> Drawn:
    """Draw the parts of four modes in the displacement of a midpoint (Fig. 6.4)."""
    ax, turned = axes[0], np.degrees(_whole().theta)
    whole, parts = _contributions(link)
    ax.plot(turned, 1e3 * whole, color="0.15", lw=1.6, label="displacement")
    for mode in range(4):
        ax.plot(turned, 1e3 * parts[:, mode], color=COLOURS[mode], label=f"mode {mode + 1}")
    shares = {}
    for name in ("coupler", "follower"):
        whole, parts = _contributions(name)
        shares[name] = rms(parts.T) / rms(whole)
    coupler, follower = shares["coupler"], shares["follower"]
    value = follower[0] / np.max(follower[1:])
    if link == "coupler":
        value = np.sum(coupler[1:4]) / coupler[0] / (np.sum(follower[1:4]) / follower[0])
    return Drawn([value], tables=[[(name, *sizes[:6]) for name, sizes in shares.items()]])


@lru_cache(maxsize=4)
def march(
    drop: tuple[str, ...] = THESIS, ratio: float = 0.02
) -> tuple[Array, NDArray[np.complex128]]:
    """Return the follower's midpoint [m] from rest, (cycles, N), and the multipliers.

    Newmark's steps, 720 in a revolution, 62 rad/s, one element for each link.
    """
    system, steps = beams(1, drop, ratio=ratio), 720
    maps, loads = newmark_maps(system, CRITICAL, steps)
    state, whole = np.zeros(maps.shape[-1]), np.eye(maps.shape[-1])
    states = np.empty((40, *loads.shape))
    for cycle in states:
        for k in range(len(maps)):
            cycle[k] = state
            state = maps[k] @ state + loads[k]
    for step in maps:
        whole = step @ whole
    values = np.linalg.eigvals(whole).astype(complex)
    theta = even_angles(2.0 * np.pi, steps)
    return moved(system, "follower", theta, states[..., : system.size]), values


def changes(values: Array) -> Array:
    """Return the largest change of each cycle to the one before, over the last cycle's peak."""
    return np.asarray(np.max(np.abs(np.diff(values, axis=0)), axis=1) / np.max(np.abs(values[-1])))


def _settled(values: Array, tolerance: float) -> float:
    """Return the number of the cycle that differs from the one before by less."""
    return float(np.argmax(changes(values) < tolerance) + 2)


def figure_6_5(axes: Panels) -> Drawn:
    """Draw the follower's midpoint from rest at 62 rad/s, and its change in a cycle."""
    values = march()[0]
    cycles = np.arange(values.size) / values.shape[1]
    axes[0].plot(cycles, 1e3 * values.ravel(), color=COLOURS[0], lw=0.6)
    rows = []
    for drop, name in _FORMS:
        marched, multipliers = march(drop)
        change = changes(marched)
        axes[1].semilogy(np.arange(2, len(change) + 2), change, "o-", ms=3, label=name)
        top = multipliers[np.argmax(np.abs(multipliers))]
        for tolerance in (1e-4, 1e-5):
            by = [cycles_to_settle(top, tolerance, norm=norm) for norm in ("change", "remaining")]
            rows.append((name, tolerance, abs(top), *by, _settled(marched, tolerance)))
    axes[1].axhline(1e-4, color="0.4", lw=0.8, ls="--", label=r"$10^{-4}$")
    axes[1].axvline(31, color="0.4", lw=0.8, ls=":", label="31 cycles")
    return Drawn([_settled(values, 1e-4)], tables=[rows])


def figure_6_6(axes: Panels) -> Drawn:
    """Draw the operations over the intervals: algorithms 1 and 2, and marching at two dampings."""
    intervals = (90, 180, 360, 540, 720)
    lines = [("transition_matrix", 1, "algorithm 1"), ("closed_form", 1, "algorithm 2")]
    for ratio in (0.02, 0.06):
        # To a change of 1e-4 over the peak at 62 rad/s.
        multipliers = march(ratio=ratio)[1]
        cycles = int(cycles_to_settle(multipliers[np.argmax(np.abs(multipliers))], 1e-4))
        label = rf"time marching, $\zeta$ = {ratio:g}, {cycles} cycles"
        lines.append(("time_marching", cycles, label))
    for ax, storage in zip(axes, (True, False), strict=True):
        for (name, cycles, label), colour in zip(lines, COLOURS, strict=False):
            printed, counted = (
                [1e-6 * count(name, n, 9, cycles, storage=storage) for n in intervals]
                for count in (printed_count, operation_count)
            )
            ax.plot(intervals, printed, "o-", ms=3, color=colour, label=label)
            ax.plot(intervals, counted, "--", lw=0.9, color=colour)
        ax.plot([], [], "--", lw=0.9, color="0.4", label="counted here")
        panel_title(ax, "matrices stored" if storage else "no storage")
    one, two = "transition_matrix", "closed_form"
    cases = [(big, n) for n in (1, 2, 9, 27, 100) for big in (90, 720)]
    values = [
        max(count(one, *case) / count(two, *case) for case in cases)
        for count in (printed_count, operation_count)
    ]
    values.append(operation_count(one, 1440, 9) / operation_count(one, 720, 9))
    return Drawn([*values, _break_even(10), _break_even(50) / _break_even(10)])


def _break_even(freedoms: int) -> float:
    """Return the cycles from which marching takes more operations than algorithm 1."""
    wanted, cycles = printed_count("transition_matrix", 720, freedoms), 1
    while printed_count("time_marching", 720, freedoms, cycles) < wanted:
        cycles += 1
    return float(cycles)


def table_6_1(axes: Panels) -> Drawn:
    """Draw the counted operations over those of the printed formulas."""
    freedoms = np.unique(np.round(np.geomspace(3, 300, 25)).astype(int))

    def ratio(name: str, n: int, storage: bool = True) -> float:
        counted = operation_count(name, 720, n, 5, storage=storage)
        return counted / printed_count(name, 720, n, 5, storage=storage)

    rows = []
    for ax, storage in zip(axes, (True, False), strict=True):
        words = "stored" if storage else "no storage"
        for name, label in _NAMES.items():
            ratios = [ratio(name, int(n), storage) for n in freedoms]
            ax.semilogx(freedoms, ratios, label=label)
            rows.append((label, words, *(ratio(name, n, storage) for n in (9, 27, 300))))
        ax.axhline(1.0, color="0.5", lw=0.8)
        panel_title(ax, f"matrices {words}" if storage else words)
    return Drawn([ratio(name, 300) for name in _NAMES], tables=[rows])


def table_6_2(axes: Panels) -> Drawn:
    """Draw the entries of Table 6.2 and those of the printed formulas."""
    ax, entries = axes[0], np.array(_TABLES["operations"])
    keys, printed, places = entries[:, :3].astype(int), entries[:, 3:], np.arange(len(entries))
    columns = [(name, storage) for storage in (True, False) for name in _NAMES]
    computed = np.array(
        [[1e-6 * printed_count(name, *k, storage=kept) for name, kept in columns] for k in keys]
    )
    for k, ((name, kept), colour) in enumerate(zip(columns, COLOURS, strict=False)):
        label = f"{_NAMES[name]}, {'stored' if kept else 'no storage'}"
        shift = places + 0.12 * (k - 2.5)
        ax.semilogy(shift, computed[:, k], "_", color=colour, ms=9, mew=2, label=label)
        ax.semilogy(shift, printed[:, k], "o", color=colour, ms=3)
    ax.set_xticks(places, [f"N {big}\nn {n}\n$n_c$ {cycles}" for big, n, cycles in keys])
    return Drawn([np.max(np.abs(printed / computed - 1.0))])


def table_6_3(axes: Panels) -> Drawn:
    """Draw the operations of the Fourier series and of algorithm 1 over the harmonics."""
    harmonics, entries = range(1, 31), _TABLES["series"]

    def series(number: int, big: int, n: int) -> float:
        return 1e-6 * printed_count("harmonic_balance", big, n, harmonics=number)

    for ax, n in zip(axes, (10, 50), strict=True):
        for big, colour in ((90, COLOURS[0]), (720, COLOURS[1])):
            values = [series(h, big, n) for h in harmonics]
            ax.semilogy(harmonics, values, color=colour, label=f"Fourier series, N = {big}")
            one = 1e-6 * printed_count("transition_matrix", big, n)
            ax.axhline(one, color=colour, ls="--", lw=0.9, label=f"algorithm 1, N = {big}")
            points = [(h, value) for b, h, k, value, _ in entries if (b, k) == (big, n)]
            ax.plot(*np.transpose(points), "o", color=colour, ms=4)
    axes[1].plot([], [], "o", color="0.4", ms=4, label="printed, Fourier series")
    numbers: list[float] = []
    for big, number, n, *_ in entries:
        numbers += [series(number, big, n), 1e-6 * printed_count("transition_matrix", big, n)]
    return Drawn(numbers)
