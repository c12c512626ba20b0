"""Linear systems with periodic coefficients, from a quadratic Lagrangian."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from operator import methodcaller
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import bad
from ..inputs import as_numpy, require_kind, require_whole
from ..trigonometric import BETWEEN

if TYPE_CHECKING:
    from ...beams.structure import Structure

Array = NDArray[np.float64]
MATRICES = ("M", "A", "B", "S", "C", "D", "K", "Kg")
VECTORS = ("f", "h", "g", "p")
# Those through which forces without a potential act: drag on the rates, and on what a moving
# basis carries along.
DAMPING = ("C", "D")
# Places along a link at which its deflection is watched: a third sine is missed by 0.7 % at most.
PLACES = np.linspace(0.0, 1.0, 41)
# What a limit of a parameter's values allows.
_LIMITS: Mapping[str, Callable[[Array], NDArray[np.bool_]]] = {
    "positive": lambda values: values > 0.0,
    "non-negative": lambda values: values >= 0.0,
}


@dataclass(frozen=True)
class Term:
    """One separated term ``scale * speed**power * function(theta)`` of a linear-periodic system.

    Attributes
    ----------
    array : str
        Which array of the quadratic Lagrangian or of the forcing it belongs to:
        ``M A B S C D K Kg`` (matrices) or ``f h g p`` (vectors).
    power : int
        Extra power of the crank speed, beyond the one that the array itself carries.
    scale : str or None
        Name of the parameter monomial that multiplies it; None means 1.
    function : callable or ndarray
        Array of shape ``(n, n)`` (or ``(n,)``) where the term is constant, else a function of the
        crank angle: theta ``(nt,)`` [rad] to ``(nt, n, n)`` (or ``(nt, n)``).

    Examples
    --------
    >>> import elastolink as el
    >>> import numpy as np
    >>> mass, spring = el.Term("M", None, np.eye(1)), el.Term("K", None, np.array([[4.0]]))
    >>> pulsating = el.Term("K", None, lambda theta: 0.5 * np.cos(theta)[:, None, None])
    >>> system = el.LinearPeriodic(size=1, terms=(mass, spring, pulsating))
    >>> print(system.array("K", [0.0, np.pi]).ravel())
    [4.5 3.5]
    """

    array: str
    scale: str | None
    function: Callable[[Array], Array] | Array
    power: int = 0

    @property
    def constant(self) -> bool:
        """True where the term does not depend on the crank angle."""
        return not callable(self.function)

    def __call__(self, theta: Array) -> Array:
        """Evaluate at crank angles ``(nt,)``; a constant term is broadcast, not copied."""
        if callable(self.function):
            return self.function(theta)
        return np.broadcast_to(self.function, (*theta.shape, *self.function.shape))


def _no_scales(values: Mapping[str, ArrayLike]) -> Mapping[str, Array]:
    return {}


@dataclass(frozen=True)
class LinearPeriodic:
    """A linear system with periodic coefficients, from a quadratic Lagrangian.

    With the prescribed crank angle theta(t), td = d theta/dt and tdd = d2 theta/dt2,

        L2 = 1/2 qd^T M qd + td qd^T A q + 1/2 td^2 q^T B q + 1/2 tdd q^T S q
             - 1/2 q^T (K + Kg) q

    and generalised forces ``-C qd - td D q + td^2 f + td h + tdd g + p``, D where damping acts on
    a motion that the coordinates share with their basis.  The equation of motion is

        M qdd + (C + td G) qd + (K + Kg + td D + td^2 H + tdd E) q = td^2 f + td h + tdd g + p,
        G = M' + A - A^T,  H = A' - B,  E = A - S,  ' = d/d theta.

    At constant speed w, with theta as independent variable and p = M q' + A q,

        q' = M^-1 (p - A q)
        p' = A^T q' + B q - (K + Kg) q / w^2 - C q' / w - D q / w + f + h / w + p_ext / w^2.

    Attributes
    ----------
    size : int
        Number n of degrees of freedom.
    terms : tuple of Term
        The separated terms.
    parameters : mapping
        Values of the named parameters, in SI units.
    scales : callable
        From parameter values (floats or arrays that broadcast) to the values of the monomials
        that the terms name; by default there are none.
    period : float
        Period of the coefficients in theta [rad].
    labels : tuple of str
        One name per degree of freedom.
    reference_length : float
        Length [m] that turns the coordinates into deflections; 1 where they are lengths.
    shape : callable or None
        Mode shapes for plotting: x/length ``(nx,)`` to ``(nx, n)``.
    moving_shape : callable or None
        Where the shapes depend on the crank angle: x/length ``(nx,)`` and theta ``(nt,)`` [rad] to
        ``(nt, nx, n)``.
    provenance : mapping
        Scene, module and options that the system was made from; ``nonlinear``: the formulation in
        which the scene has nonlinear equations.
    geometry : mapping
        Values of the named lengths and ratios that its functions of angle are made for, where the
        system can be made anew for others; else empty.
    rebuild : callable or None
        From a full geometry to the system made for it, parameters and further terms aside.
    limits : mapping
        Of parameters that must be finite and ``positive`` or ``non-negative``, which of the two.
    relative_deflection : callable or None
        Crank angles ``(nt,)`` [rad] to what turns coordinates into deflections over the length of
        their link, ``(nt, k, n)``, at k watched places; None where the shapes tell.
    structure : object or None
        Beams and nodes that the system was made from.
    remesh : callable or None
        From a change of the structure to its system, further terms made anew, parameters aside.

    Examples
    --------
    >>> import elastolink as el
    >>> import numpy as np
    >>> mass, spring = el.Term("M", None, np.eye(1)), el.Term("K", None, np.array([[4.0]]))
    >>> pulsating = el.Term("K", None, lambda theta: 0.5 * np.cos(theta)[:, None, None])
    >>> system = el.LinearPeriodic(size=1, terms=(mass, spring, pulsating))
    >>> print(el.floquet_multipliers(system, speed=[3.0, 4.0]).stable)
    [ True False]
    """

    size: int
    terms: tuple[Term, ...]
    parameters: Mapping[str, float] = field(default_factory=dict)
    scales: Callable[[Mapping[str, ArrayLike]], Mapping[str, Array]] = _no_scales
    period: float = 2.0 * np.pi
    labels: tuple[str, ...] = ()
    reference_length: float = 1.0
    shape: Callable[[Array], Array] | None = None
    moving_shape: Callable[[Array, Array], Array] | None = None
    provenance: Mapping[str, str] = field(default_factory=dict)
    geometry: Mapping[str, float] = field(default_factory=dict)
    rebuild: Callable[[Mapping[str, float]], LinearPeriodic] | None = None
    limits: Mapping[str, str] = field(default_factory=dict)
    relative_deflection: Callable[[Array], Array] | None = None
    structure: Structure | None = None
    remesh: Callable[[Callable[[Structure], Structure]], LinearPeriodic] | None = None

    def __post_init__(self) -> None:
        require_whole("size", self.size, 1, 100_000)
        require_kind("terms", self.terms, (tuple, list), "give terms in a row")
        for term in self.terms:
            require_kind("terms", term, Term, "make each with Term")
            if term.array not in MATRICES + VECTORS:
                known = f"one of {MATRICES + VECTORS}"
                raise bad("Term.array", repr(term.array), known, "rename it")
            require_whole("Term.power", term.power, -10, 10, "leave it out")
            expected = (1, *self._shape_of(term.array))
            _require_shape(term, term(np.zeros(1)), expected, "at one angle")
        unknown = sorted(set(self.limits.values()) - set(_LIMITS))
        if unknown:
            raise bad("limits", unknown, f"some of {sorted(_LIMITS)}", "correct them")
        if not self.labels:
            object.__setattr__(self, "labels", tuple(f"q{i + 1}" for i in range(self.size)))

    def __repr__(self) -> str:
        """Return one line: coordinates, arrays, period and parameters."""
        arrays = ", ".join(name for name in MATRICES + VECTORS if self.has(name))
        labels = self.labels if self.size <= 4 else (*self.labels[:2], "...", self.labels[-1])
        numbers = ", ".join(f"{name}={value:.6g}" for name, value in self.parameters.items())
        return (
            f"{type(self).__name__}({', '.join(labels)}; arrays {arrays}; "
            f"period {self.period:.6g} rad{'; ' * bool(numbers)}{numbers})"
        )

    def shapes(self, x: Array, theta: Array) -> Array | None:
        """Return the mode shapes at places x/length ``(nx,)`` and crank angles ``(nt,)`` [rad].

        Returns
        -------
        ndarray or None
            Shape ``(nt, nx, n)``; None where the system has none.
        """
        if self.moving_shape is not None:
            return np.asarray(self.moving_shape(x, theta), dtype=float)
        if self.shape is None:
            return None
        fixed = np.asarray(self.shape(x), dtype=float)
        return np.broadcast_to(fixed, (len(theta), *fixed.shape))

    def deflection_rows(self, theta: Array, places: Array = PLACES) -> Array | None:
        """Return what turns coordinates into deflections over the length of their link.

        Parameters
        ----------
        theta : ndarray
            Crank angles [rad], shape ``(nt,)``.
        places : ndarray
            Places x/length of a system that is known by its shapes, ``(nx,)``.

        Returns
        -------
        ndarray or None
            Shape ``(nt, k, n)``; None where none is known.
        """
        if self.relative_deflection is not None:
            return np.asarray(self.relative_deflection(theta), dtype=float)
        return self.shapes(places, theta)

    def largest_deflection(self, theta: Array, q: Array) -> float | None:
        """Return the largest deflection over the length of its link; None where none is known.

        Parameters
        ----------
        theta : ndarray
            Crank angles [rad], shape ``(nt,)``.
        q : ndarray
            Motions, shape ``(nb, nt, n)``; one that is not finite counts for nothing.
        """
        # Mode shapes at the angles of the motion before serve for the next one.
        before, rows = self.kept.get("deflections", (None, None))
        if not np.array_equal(before, theta):
            rows = self.deflection_rows(theta)
            if np.ptp(theta) <= self.period:  # those of a long motion would fill the memory
                self.kept["deflections"] = theta.copy(), rows
        if rows is None:
            return None
        sizes = [
            float(np.max(np.abs(np.einsum("txn,tn->tx", rows, one)), initial=0.0))
            for one in q
            if np.all(np.isfinite(one))
        ]
        return max(sizes, default=0.0)

    def has(self, array: str) -> bool:
        """Return True where some term belongs to ``array``."""
        return any(term.array == array for term in self.terms)

    def is_constant(self, array: str) -> bool:
        """Return True where no term of ``array`` depends on the crank angle."""
        return all(term.constant for term in self.terms if term.array == array)

    def spectrum(self, row: int) -> Array:
        """Largest Fourier amplitude of an entry of a term, per harmonic of the period.

        Of length 1 where the term is constant, else as long as it takes; a term that nobody asks
        about is never sampled.

        Parameters
        ----------
        row : int
            Place of the term among :attr:`terms`.

        Raises
        ------
        BadInput
            If the term is not finite at a sample, or returns a wrong shape for many angles.
        """
        if ("spectrum", row) not in self.kept:
            term = self.terms[row]
            found = term_spectrum(term, self._shape_of(term.array), self.period)
            self.kept["spectrum", row] = found
        known: Array = self.kept["spectrum", row]
        return known

    def _shape_of(self, array: str) -> tuple[int, ...]:
        return (self.size,) * (2 if array in MATRICES else 1)

    def __getstate__(self) -> dict[str, object]:
        """Return what is pickled: not the samples, which are made again where they are needed."""
        return {name: value for name, value in vars(self).items() if name != "kept"}

    @cached_property
    def kept(self) -> dict[object, Any]:
        """Samples that one solver leaves for the next, by what they are for."""
        return {}

    def is_damped(self, **axes: ArrayLike) -> bool:
        """Return True where some damping term is not zero at every angle and parameter value.

        Parameters
        ----------
        **axes : float or array_like
            Parameter values that replace the system's own; arrays broadcast.

        Raises
        ------
        BadInput
            If a name is not one of the system's parameters, or a term is not finite.
        """
        scales = self.scale_values(**axes)
        return any(
            term.array in DAMPING
            and (term.scale is None or bool(np.any(scales[term.scale])))
            and bool(np.any(self.spectrum(row)))
            for row, term in enumerate(self.terms)
        )

    def changed_provenance(self, **changes: ArrayLike) -> dict[str, str]:
        """Return the provenance with parameter changes recorded under ``changed``.

        Parameters
        ----------
        **changes : float or array_like
            Parameter values that replace the system's own; of an array its range is told.
        """
        found = dict(self.provenance)
        told = [found["changed"]] if "changed" in found else []
        told += [f"{name}={_told(value)}" for name, value in changes.items()]
        if told:
            found["changed"] = ", ".join(told)
        return found

    def scale_values(self, **changes: ArrayLike) -> Mapping[str, Array]:
        """Return the parameter monomials at the system's parameters, some of them changed.

        Parameters
        ----------
        **changes : float or array_like
            New values by parameter name; arrays broadcast.

        Raises
        ------
        BadInput
            If a name is not one of the system's parameters, or a value is not a number or not
            within the parameter's limits.
        """
        unknown = sorted(set(changes) - set(self.parameters))
        if unknown:
            known = f"some of {sorted(self.parameters)}"
            raise bad("parameters", unknown, known, "correct the name")
        changes = {name: as_numpy(value) for name, value in changes.items()}
        for name, value in changes.items():
            self._within_limits(name, value)
        return self.scales({**self.parameters, **changes})

    def _within_limits(self, name: str, value: ArrayLike) -> None:
        limit = self.limits.get(name)
        expected = f"finite numbers, {limit}" if limit else "numbers"
        try:
            values = np.asarray(value, dtype=float)
        except (TypeError, ValueError, OverflowError):
            raise bad(name, repr(value), expected, "correct it") from None
        if limit:
            usable = np.isfinite(values) & _LIMITS[limit](values)
            if not np.all(usable):
                raise bad(name, values[~usable].flat[0], expected, "correct it")

    def array(
        self, name: str, theta: ArrayLike, speed: float | Array = 1.0, **changes: float
    ) -> Array:
        """Evaluate one array at crank angles.

        Parameters
        ----------
        name : str
            ``M A B S C D K Kg f h g p``.
        theta : array_like
            Crank angles [rad], shape ``(nt,)``.
        speed : float or ndarray
            Crank speed [rad/s], or that at each angle, ``(nt,)``; matters only for terms with an
            extra power of it.
        **changes : float
            Parameter values that replace the system's own.

        Returns
        -------
        ndarray
            Shape ``(nt, n, n)``, or ``(nt, n)`` for a vector; zeros where no term belongs to it.
        """
        angles = np.atleast_1d(np.asarray(theta, dtype=float))
        shape = self._shape_of(name)
        total = np.zeros((*angles.shape, *shape))
        pace = np.reshape(speed, (-1, *(1,) * len(shape)))
        scales = self.scale_values(**changes)
        for term in self.terms:
            if term.array == name:
                factor = 1.0 if term.scale is None else scales[term.scale]
                total = total + factor * pace**term.power * term(angles)
        return total

    def with_parameters(self, **changes: float) -> LinearPeriodic:
        """Return the same system with other parameter values."""
        self.scale_values(**changes)
        changes = {name: as_numpy(value) for name, value in changes.items()}
        told = self.changed_provenance(**changes)
        return replace(self, parameters={**self.parameters, **changes}, provenance=told)

    def with_terms(self, *terms: Term, scales: Mapping[str, float] | None = None) -> LinearPeriodic:
        """Return the system with more terms, for example modal damping.

        Parameters
        ----------
        *terms : Term
            Terms to add.
        scales : mapping, optional
            Values of monomials that the new terms name and the system does not know; they become
            parameters of the new system.

        Notes
        -----
        :meth:`with_geometry` takes the new terms along as they are.
        """
        extra = dict(scales or {})
        merged = partial(_merged, self.scales, tuple(self.parameters), tuple(extra))
        return replace(
            self,
            terms=self.terms + terms,
            parameters={**self.parameters, **extra},
            scales=merged if extra else self.scales,
            **self.remade(methodcaller("with_terms", *terms, scales=extra)),
        )

    def with_changed_terms(self, change: Callable[[Term], Term]) -> LinearPeriodic:
        """Return the system with each term changed, for example scaled.

        Parameters
        ----------
        change : callable
            From each term to the one in its place.

        Notes
        -----
        :meth:`with_geometry` changes the terms of the other geometry alike.
        """
        terms, again = tuple(map(change, self.terms)), methodcaller("with_changed_terms", change)
        return replace(self, terms=terms, **self.remade(again))

    def without(self, *arrays: str) -> LinearPeriodic:
        """Return the system without the terms of some arrays, for example ``*DAMPING``."""
        terms = tuple(term for term in self.terms if term.array not in arrays)
        return replace(self, terms=terms, **self.remade(methodcaller("without", *arrays)))

    def remade(self, change: Callable[[LinearPeriodic], LinearPeriodic]) -> dict[str, Any]:
        """Return ``rebuild`` and ``remesh`` of the system that a change makes of this one.

        Parameters
        ----------
        change : callable
            From this system, or one made anew of another geometry or mesh, to the changed one.
        """
        makers = {"rebuild": self.rebuild, "remesh": self.remesh}
        return {
            name: None if make is None else partial(_made_then, make, change)
            for name, make in makers.items()
        }

    def has_terms_of(self, made: LinearPeriodic) -> bool:
        """Return whether its terms are those of a system made anew, and not replaced ones."""
        theta = self.period * np.array([0.1, 0.45, 0.8])

        def alike(new: Array, old: Array) -> bool:
            # Entries that are round-off beside the largest need not agree.
            rounding = 1e-12 * float(np.max(np.abs(old), initial=0.0))
            return np.allclose(new, old, rtol=1e-6, atol=rounding)

        return len(made.terms) == len(self.terms) and all(
            (new.array, new.scale, new.power) == (term.array, term.scale, term.power)
            and alike(new(theta), term(theta))
            for new, term in zip(made.terms, self.terms, strict=True)
        )

    @cached_property
    def _rebuilds_itself(self) -> bool:
        return self.rebuild is None or self.has_terms_of(self.rebuild(self.geometry))

    def remeshed(self, change: Callable[[Structure], Structure]) -> LinearPeriodic:
        """Return the system of a changed structure, its further terms and parameters kept.

        Parameters
        ----------
        change : callable
            From the structure to the changed one.

        Raises
        ------
        BadInput
            If the system tells no other structure.
        """
        if self.remesh is None:
            found = "one made for its own beams alone"
            raise bad("system", found, "a linkage", "use linkage_system")
        return replace(self.remesh(change), parameters=dict(self.parameters))

    def with_geometry(self, **changes: float) -> LinearPeriodic:
        """Return the same system with other lengths or ratios, its functions of angle made anew.

        Parameters
        ----------
        **changes : float
            New values by geometry name.

        Raises
        ------
        BadInput
            If the system has no geometry to change, a name is not one of it, its terms were
            replaced by other means than its own methods, or the mechanism is impossible.
        """
        if self.rebuild is None:
            found = "a system that is made for one geometry"
            fix = "make it anew from its own numbers"
            raise bad("with_geometry", found, "one with named geometry, as rod_system makes", fix)
        unknown = sorted(set(changes) - set(self.geometry))
        if unknown:
            raise bad("geometry", unknown, f"some of {sorted(self.geometry)}", "correct the name")
        if not self._rebuilds_itself:
            found = "terms that are not those that its geometry gives"
            expected = "a system whose terms only its own methods changed"
            fix = "use with_changed_terms, or set rebuild=None too"
            raise bad("with_geometry", found, expected, fix)
        made = self.rebuild({**self.geometry, **changes})
        return replace(
            made, parameters=dict(self.parameters), provenance=self.changed_provenance(**changes)
        )


def _merged(
    scales: Callable[[Mapping[str, ArrayLike]], Mapping[str, Array]],
    own: tuple[str, ...],
    extra: tuple[str, ...],
    values: Mapping[str, ArrayLike],
) -> Mapping[str, Array]:
    """Return a system's monomials and those that are parameters themselves."""
    new = {name: np.asarray(values[name], dtype=float) for name in extra}
    return {**scales({name: values[name] for name in own}), **new}


def _made_then(
    make: Callable[[Any], LinearPeriodic],
    change: Callable[[LinearPeriodic], LinearPeriodic],
    given: object,
) -> LinearPeriodic:
    return change(make(given))


def _told(value: ArrayLike) -> str:
    """Return a parameter value as text: a number, or how many from where to where."""
    values = np.asarray(as_numpy(value), dtype=float)
    if values.size == 1:
        return repr(float(values.flat[0]))
    if values.size == 0:
        return "none"
    return f"{values.size} values from {float(values.min())!r} to {float(values.max())!r}"


def require_system(system: object) -> None:
    """Refuse what is no linear periodic system."""
    require_kind("system", system, LinearPeriodic, "take the .system() of a linear scene")


# Even angles: first and most of them.
_FIRST, _MOST = 256, 4096
# Amplitudes of the upper half, over the largest, that are round-off.
_NOISE = 1e-13
# What the series may differ by from the term, over its size, at angles between.
_ALIKE = 1e-10


def term_spectrum(term: Term, expected: tuple[int, ...], period: float) -> Array:
    """Return the largest Fourier amplitude of an entry of a term, per harmonic.

    ``expected`` is the shape of its value at an angle.  Of a constant term there is one; else one
    more than half the angles it took: they are doubled until the upper half is round-off and the
    series meets the term between them.  Values that are not finite, or of a wrong shape for many
    angles, are refused.
    """
    if term.constant:
        value = _checked(term, expected, np.zeros(1))
        largest: Array = np.max(np.abs(value), axis=1)
        return largest
    count = _FIRST
    while True:
        theta = np.linspace(0.0, period, count, endpoint=False, dtype=np.float64)
        table = np.fft.rfft(_checked(term, expected, theta), axis=0) / count
        amplitude: Array = np.max(np.abs(table), axis=1)
        faded = np.max(amplitude[len(amplitude) // 2 :]) <= _NOISE * np.max(amplitude)
        if count == _MOST or (faded and _meets(term, expected, period, table)):
            return amplitude
        count *= 2


def _meets(
    term: Term, expected: tuple[int, ...], period: float, table: NDArray[np.complex128]
) -> bool:
    """Return whether the series gives the term between the samples: no wave was mistaken."""
    values = _checked(term, expected, period * BETWEEN)
    waves = np.exp(2j * np.pi * BETWEEN[:, None] * np.arange(len(table)))
    series = 2.0 * (waves @ table).real - table[0].real
    return bool(np.max(np.abs(series - values)) <= _ALIKE * np.max(np.abs(values)))


def _checked(term: Term, expected: tuple[int, ...], theta: Array) -> Array:
    """Return the values as rows; refuse what is not finite, or of a wrong shape."""
    values = np.asarray(term(theta), dtype=float)
    _require_shape(term, values, (len(theta), *expected), f"for {len(theta)} angles")
    flat = values.reshape(len(values), -1)
    finite = np.all(np.isfinite(flat), axis=1)
    if not np.all(finite):
        angle = theta[int(np.argmin(finite))]
        found = f"a value that is not finite at crank angle {angle:.6g}"
        fix = "check the function, its domain and the geometry"
        where = f"term {term.array} ({term.scale})"
        raise bad(where, found, "finite numbers at every angle", fix)
    return flat


def _require_shape(term: Term, values: Array, expected: tuple[int, ...], at: str) -> None:
    if values.shape != expected:
        where = f"term {term.array} ({term.scale})"
        fix = "make the function return one array per angle"
        raise bad(where, f"shape {values.shape} {at}", f"{expected}", fix)
