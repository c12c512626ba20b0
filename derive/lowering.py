"""From SymPy to the intermediate representation: pruning, CSE, operation counts, finished lines."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import sympy as sp
from sympy.codegen.cfunctions import expm1
from sympy.core.function import AppliedUndef

from .ir import Argument, Description, Kernel, ModuleSpec, Result, Statement, Table, drops_table
from .modal import COUNTED_MODES, EACH_MODE, ModeProduct, ModeSum
from .spec import ModelSpec
from .staged import ClosedForm, KernelForms, Step, Steps
from .stations import StationProduct, StationSum

_FUNCTIONS: dict[type[sp.Function], str] = {
    sp.sin: "sin",
    sp.cos: "cos",
    sp.tan: "tan",
    sp.exp: "exp",
    sp.atan: "atan",
    sp.atan2: "atan2",
    sp.Abs: "abs",
    sp.sinh: "sinh",
    sp.cosh: "cosh",
    sp.floor: "floor",
    expm1: "expm1",
}


class CannotPrint(TypeError):  # noqa: N818 - reads as what it is
    """An expression has no form in the emitted language."""


def to_line(expression: sp.Expr, scalars: Iterable[sp.Symbol] = ()) -> str:
    """Return one expression as Python source, with functions taken from the namespace ``xp``.

    ``expression``: what to print; ``scalars``: symbols that stand for single numbers. They come
    first in each product, so that they are multiplied with each other before they meet an array.
    Raises ``CannotPrint`` if the expression has no form in an emitted module.
    """
    return _Printer(frozenset(scalars)).line(sp.sympify(expression))[0]


_ATOM, _POWER, _PRODUCT, _SUM = 3, 2, 1, 0


@dataclass(frozen=True)
class _Printer:
    """Source of expressions, each with how tightly it binds."""

    scalars: frozenset[sp.Symbol]
    _known: dict[sp.Basic, tuple[str, int]] = field(default_factory=dict)

    def line(self, e: sp.Basic) -> tuple[str, int]:
        if e not in self._known:
            self._known[e] = self._line(e)
        return self._known[e]

    def _line(self, e: sp.Basic) -> tuple[str, int]:
        if isinstance(e, sp.Symbol):
            return e.name, _ATOM
        if isinstance(e, sp.Integer):
            return (str(int(e)), _ATOM) if e >= 0 else (f"-{abs(int(e))}", _SUM)
        if isinstance(e, sp.Rational):
            return f"{int(e.p)} / {int(e.q)}", _SUM if e < 0 else _PRODUCT
        if isinstance(e, sp.Expr) and e.is_number:
            return self._number(e)
        if isinstance(e, sp.Add):
            return self._sum(e), _SUM
        if isinstance(e, sp.Mul):
            return self._product(e)
        if isinstance(e, sp.Pow):
            return self._power(e)
        if isinstance(e, sp.Piecewise):
            return self._choice(e), _ATOM
        if isinstance(e, sp.Equality | sp.StrictGreaterThan):
            sign = "==" if isinstance(e, sp.Equality) else ">"
            return f"({self.line(e.args[0])[0]} {sign} {self.line(e.args[1])[0]})", _ATOM
        if isinstance(e, sp.Mod):
            return f"({self._wrap(e.args[0], _PRODUCT)} % {self._wrap(e.args[1], _POWER)})", _ATOM
        if isinstance(e, ModeSum):
            return f"_sum({', '.join(self.line(a)[0] for a in e.args)})", _ATOM
        if isinstance(e, ModeProduct):
            return f"_product({', '.join(self.line(a)[0] for a in e.args)})", _ATOM
        if isinstance(e, StationSum):
            return f"xp.sum({self.line(e.args[0])[0]}, axis=0)", _ATOM
        if isinstance(e, StationProduct):  # the kernels are symmetric
            kernel, values = e.args
            return f"{self._wrap(kernel, _ATOM)} @ {self._wrap(values, _ATOM)}", _PRODUCT
        for kind, name in _FUNCTIONS.items():
            if isinstance(e, kind):
                return f"xp.{name}({', '.join(self.line(a)[0] for a in e.args)})", _ATOM
        if isinstance(e, AppliedUndef):
            raise CannotPrint(f"{e} is a function that no step defines")
        raise CannotPrint(f"{type(e).__name__} {e} has no form in an emitted module")

    def _number(self, e: sp.Expr) -> tuple[str, int]:
        """Print a number that is no fraction as the nearest double, rounded once."""
        value = sp.N(e, 40)
        if not value.is_Float:
            raise CannotPrint(f"{e} is not a real number")
        return repr(float(value)), _SUM if value < 0 else _ATOM

    def _wrap(self, e: sp.Basic, least: int) -> str:
        text, level = self.line(e)
        return text if level >= least else f"({text})"

    def _sum(self, e: sp.Add) -> str:
        """Print a sum; where the first term is negative, one that is not changes places with it.

        A sign in front of an array is an operation of its own, before a single number it is none.
        """
        terms = e.as_ordered_terms()
        if _negative(terms[0]):
            leading = sorted(terms, key=self._sign_costs)[0]
            terms = [self._turned(leading), *(term for term in terms if term is not leading)]
        parts: list[str] = []
        for term in terms:
            negative = _negative(term)
            text = self._wrap(-term if negative else term, _PRODUCT)
            if parts:
                parts.append(("- " if negative else "+ ") + text)
            else:
                parts.append(f"-{text}" if negative else self.line(term)[0])
        return " ".join(parts)

    def _sign_costs(self, term: sp.Expr) -> int:
        """Return 0 for a term without a sign, 1 for one at a single number, 2 for an array."""
        if not _negative(self._turned(term)):
            return 0
        return 1 if any(f.free_symbols <= self.scalars for f in sp.Mul.make_args(-term)) else 2

    def _turned(self, e: sp.Expr) -> sp.Expr:
        """Return a negative product with the sign taken into a sum among its factors."""
        if not isinstance(e, sp.Mul) or e.args[0] != -1:
            return e
        sums = [f for f in e.args if isinstance(f, sp.Add)]
        if not sums:
            return e
        rest = [f for f in e.args[1:] if f is not sums[0]]
        return sp.Mul(sp.Add(*(-term for term in sums[0].args)), *rest, evaluate=False)

    def _product(self, e: sp.Mul) -> tuple[str, int]:
        e = self._turned(e)
        negative = _negative(e)
        # Exact: exp(-x) stays as it is, for 1 / exp(x) would overflow.
        numerator, denominator = sp.fraction(_one_number(-e if negative else e), exact=True)
        upper = [f for f in sp.Mul.make_args(numerator) if f != 1]
        lower = [f for f in sp.Mul.make_args(denominator) if f != 1]
        upper.sort(key=lambda f: not f.free_symbols <= self.scalars)
        if upper and upper[0].free_symbols <= self.scalars:
            # The sign of a sum costs nothing where it goes to a scalar factor.
            negative ^= sum(map(_all_negative, upper)) % 2 == 1
            upper = [-f if _all_negative(f) else f for f in upper]
        text = (
            " * ".join(self._wrap(f, _POWER if i else _PRODUCT) for i, f in enumerate(upper)) or "1"
        )
        if len(lower) > 1 and not upper and _power_of_two(lower[0]):
            # Exact, and one operation less where the rest is an array.
            text, lower = repr(1.0 / int(lower[0])), lower[1:]
        if lower:
            divisor = " * ".join(self._wrap(f, _POWER) for f in lower)
            text = f"{text} / ({divisor})" if len(lower) > 1 else f"{text} / {divisor}"
        return (f"-{text}", _SUM) if negative else (text, _PRODUCT)

    def _power(self, e: sp.Pow) -> tuple[str, int]:
        base, exponent = e.as_base_exp()
        if base == -1:
            return f"(1 - 2 * (({self.line(exponent)[0]}) % 2))", _ATOM
        if exponent == sp.Rational(1, 2):
            return f"xp.sqrt({self.line(base)[0]})", _ATOM
        if exponent.is_number and exponent.could_extract_minus_sign():
            return f"1 / {self._wrap(base**-exponent, _POWER)}", _PRODUCT
        if isinstance(exponent, sp.Integer):
            return f"{self._wrap(base, _ATOM)}**{int(exponent)}", _POWER
        if exponent == sp.Rational(3, 2):
            return f"{self._wrap(base, _ATOM)} * xp.sqrt({self.line(base)[0]})", _PRODUCT
        if isinstance(exponent, sp.Rational):
            return f"{self._wrap(base, _ATOM)}**({int(exponent.p)} / {int(exponent.q)})", _POWER
        raise CannotPrint(f"power {e} has no form in an emitted module")

    def _choice(self, e: sp.Piecewise) -> str:
        if len(e.args) != 2 or e.args[1][1] is not sp.true:
            raise CannotPrint(f"{e} is not a choice between two cases")
        (first, condition), (second, _) = e.args
        if first.is_number and second.is_number:
            # The standard's ``where`` wants an array among its choices.
            switch = f"xp.asarray({self.line(condition)[0]}, dtype=xp.float64)"
            scaled = (
                switch
                if first - second == 1
                else f"{self._wrap(first - second, _POWER)} * {switch}"
            )
            return (
                scaled
                if scaled == switch and second == 0
                else f"({self.line(second)[0]} + {scaled})"
            )
        return f"xp.where({', '.join(self.line(part)[0] for part in (condition, first, second))})"


def _negative(e: sp.Expr) -> bool:
    """Return True where an expression begins with a negative number."""
    return bool(e.as_coeff_Mul()[0] < 0)


def _all_negative(e: sp.Expr) -> bool:
    return isinstance(e, sp.Add) and all(term.could_extract_minus_sign() for term in e.args)


def _power_of_two(e: sp.Basic) -> bool:
    return isinstance(e, sp.Integer) and 0 < e < 2**30 and int(e).bit_count() == 1


def _one_number(e: sp.Expr) -> sp.Expr:
    """Return a product with its numeric factors as one: a fraction, or one rounded number."""
    numbers = [f for f in sp.Mul.make_args(e) if f.is_number]
    if all(f.is_Rational for f in numbers):
        return e
    others = [f for f in sp.Mul.make_args(e) if not f.is_number]
    return sp.Mul(sp.N(sp.Mul(*numbers), 40), *others)


def count_operations(expressions: Sequence[sp.Expr]) -> int:
    """Return the number of arithmetic operations, a function call counting as one.

    A number costs nothing, however it is written: it is worked out when the line is printed.
    """
    return int(sum(sp.count_ops(_rounded(expression)) for expression in expressions))


def _rounded(expression: sp.Expr) -> sp.Expr:
    return expression.replace(
        lambda e: e.is_number and not e.is_Atom and not e.is_Rational, lambda e: sp.N(e, 40)
    )


def lower_kernel(
    name: str,
    summary: str,
    arguments: Sequence[Argument],
    steps: Steps,
    outputs: Sequence[tuple[Result, sp.Expr]],
) -> Kernel:
    """Turn named steps and outputs into straight-line code.

    Steps that no output needs are pruned; one canonical common-subexpression elimination runs
    over all that is left; each statement stands as late as its first use allows.

    ``name``, ``summary``: name of the emitted function and first line of its docstring;
    ``arguments``: inputs, in order; ``steps``: intermediate quantities; ``outputs``: returned
    quantities. Raises ``CannotPrint`` if a symbol is neither an argument nor a step, or an
    expression has no emitted form.
    """
    finals = [sp.sympify(expression) for _, expression in outputs]
    kept, finals = _without_trivial(steps.needed(finals), finals)
    _require_parity([*finals, *(expression for _, expression in kept.steps)])
    named = [symbol for symbol, _ in kept.steps]
    replacements, reduced = sp.cse(
        [expression for _, expression in kept.steps] + finals,
        symbols=sp.numbered_symbols("x", cls=sp.Symbol),
        order="canonical",
    )
    replacements, reduced = _without_negations(replacements, reduced)
    values = dict(replacements) | dict(zip(named, reduced, strict=False))
    returned = reduced[len(named) :]
    inputs = {argument.name for argument in arguments}
    ordered = _in_order_of_need(values, named, returned, inputs, name)
    scalars = _scalars(arguments, ordered, values)
    vectors = _vectors(arguments, ordered, values)
    done = _released(ordered, values, returned, scalars | vectors)
    statements = tuple(
        Statement(symbol.name, _line(values[symbol], scalars, vectors), done.get(symbol, ()))
        for symbol in ordered
    )
    return Kernel(
        name=name,
        summary=summary,
        arguments=tuple(arguments),
        results=tuple(result for result, _ in outputs),
        statements=statements,
        returns=tuple(_line(expression, scalars, vectors) for expression in returned),
        operations=_operations([values[s] for s in ordered] + list(returned), vectors),
    )


def _vectors(
    arguments: Sequence[Argument],
    ordered: Sequence[sp.Symbol],
    values: Mapping[sp.Symbol, sp.Expr],
) -> set[sp.Symbol]:
    """Return the symbols that stand for one value of each mode."""
    found = {sp.Symbol(a.name) for a in arguments if a.shape.startswith(EACH_MODE)}
    for symbol in ordered:
        value = values[symbol]
        if isinstance(value, ModeProduct) or (
            not isinstance(value, ModeSum) and value.free_symbols & found
        ):
            found.add(symbol)
    return found


def _line(value: sp.Expr, scalars: set[sp.Symbol], vectors: set[sp.Symbol]) -> str:
    """Return an expression as Python source, over all modes where it has a value of each."""
    used = _by_name(value.free_symbols & vectors)
    if not used or value in vectors or isinstance(value, ModeSum | ModeProduct):
        return to_line(value, scalars)
    names = {symbol: sp.Symbol(f"{symbol.name}_i") for symbol in used}
    loop = ", ".join(names[symbol].name for symbol in used)
    over = ", ".join(symbol.name for symbol in used)
    over = over if len(used) == 1 else f"zip({over})"
    return f"[{to_line(value.xreplace(names), scalars)} for {loop} in {over}]"


def _operations(values: Sequence[sp.Expr], vectors: set[sp.Symbol]) -> int:
    """Return the operations of expressions, for ``COUNTED_MODES`` modes where they have any."""
    total, n = 0, COUNTED_MODES
    for value in values:
        if isinstance(value, ModeSum):
            total += 2 * n - 1
        elif isinstance(value, ModeProduct):
            total += n * (2 * n - 1)
        else:
            total += count_operations([value]) * (n if value.free_symbols & vectors else 1)
    return total


def _without_trivial(steps: Steps, finals: list[sp.Expr]) -> tuple[Steps, list[sp.Expr]]:
    """Put numbers, and symbols with or without a sign, in the place of the steps that name them."""
    known: dict[sp.Symbol, sp.Expr] = {}
    kept = []
    for symbol, expression in steps.steps:
        value = expression.xreplace(known)
        if value.is_number or value.is_Symbol or (-value).is_Symbol:
            known[symbol] = value
        else:
            kept.append((symbol, value))
    outputs = [final.xreplace(known) for final in finals]
    return Steps(tuple(kept)).needed(outputs), outputs


def _is_negation(value: sp.Basic) -> bool:
    return isinstance(value, sp.Mul) and (-value).is_Symbol


_RELEASED_TOGETHER = 3


def _released(
    ordered: Sequence[sp.Symbol],
    values: Mapping[sp.Symbol, sp.Expr],
    returned: Sequence[sp.Expr],
    scalars: set[sp.Symbol],
) -> dict[sp.Symbol, tuple[str, ...]]:
    """Return, after which statement which arrays are no longer needed, a few at a time.

    Their memory then serves the next ones: what stays in the cache decides the speed.
    """
    last: dict[sp.Symbol, sp.Symbol] = {}
    for symbol in ordered:
        for needed in values[symbol].free_symbols & values.keys():
            last[needed] = symbol
    kept = set().union(*(expression.free_symbols for expression in returned), scalars)
    found: dict[sp.Symbol, tuple[str, ...]] = {}
    idle: list[str] = []
    for symbol in ordered:
        ended = [s for s in values[symbol].free_symbols - kept if last.get(s) == symbol]
        idle += sorted(s.name for s in ended)
        if len(idle) >= _RELEASED_TOGETHER:
            found[symbol] = tuple(idle)
            idle = []
    return found


def _without_negations(
    replacements: Sequence[tuple[sp.Symbol, sp.Expr]], reduced: Sequence[sp.Expr]
) -> tuple[list[tuple[sp.Symbol, sp.Expr]], list[sp.Expr]]:
    """Put ``-a`` back where it was named: a sign costs nothing in a sum or before a number."""
    signs = {symbol: value for symbol, value in replacements if _is_negation(value)}
    kept = [(s, value.xreplace(signs)) for s, value in replacements if s not in signs]
    return kept, [value.xreplace(signs) for value in reduced]


def _scalars(
    arguments: Sequence[Argument],
    ordered: Sequence[sp.Symbol],
    values: Mapping[sp.Symbol, sp.Expr],
) -> set[sp.Symbol]:
    """Return the symbols that single numbers determine: what depends on no array argument."""
    plain = {argument.name for argument in arguments if argument.shape.startswith("float")}
    found: set[sp.Symbol] = set()
    for symbol in ordered:
        for needed in values[symbol].free_symbols:
            if needed.name in plain and needed not in values:
                found.add(needed)
        if values[symbol].free_symbols <= found:
            found.add(symbol)
    return found


def _require_parity(expressions: Iterable[sp.Expr]) -> None:
    """Refuse ``(-1)**k`` unless k is an integer: it is printed as a parity."""
    for expression in expressions:
        for power in expression.atoms(sp.Pow):
            if power.base == -1 and not power.exp.is_integer:
                raise CannotPrint(f"power {power} is real for integers alone")


def _in_order_of_need(
    values: dict[sp.Symbol, sp.Expr],
    named: Sequence[sp.Symbol],
    returned: Sequence[sp.Expr],
    inputs: set[str],
    kernel: str,
) -> list[sp.Symbol]:
    placed: list[sp.Symbol] = []
    done: set[sp.Symbol] = set()

    def place(symbol: sp.Symbol) -> None:
        if symbol in done:
            return
        if symbol not in values:
            if symbol.name in inputs:
                return
            raise CannotPrint(f"{kernel}: {symbol} is neither an argument nor a step")
        done.add(symbol)
        for needed in _by_name(values[symbol].free_symbols):
            place(needed)
        placed.append(symbol)

    for symbol in named:
        place(symbol)
    for expression in returned:
        for symbol in _by_name(expression.free_symbols):
            place(symbol)
    return placed


def _by_name(symbols: Iterable[sp.Symbol]) -> list[sp.Symbol]:
    """Return symbols in one order, ``x9`` before ``x10``."""
    return sorted(symbols, key=lambda s: (len(s.name), s.name))


def lower_closed_form(spec: ModelSpec, closed: ClosedForm, description: Description) -> ModuleSpec:
    """Return the module of a closed form: one function that returns all wanted outputs."""
    outputs = [(description.results[name], value) for name, value in closed.outputs]
    kernel = lower_kernel(
        description.kernel,
        description.summary,
        (*description.arguments, *description.parameters),
        closed.steps,
        outputs,
    )
    return _closed_module(spec, (kernel,), description)


def lower_kernel_forms(spec: ModelSpec, forms: KernelForms, description: Description) -> ModuleSpec:
    """Return the module of several closed forms, each a function with arguments of its own."""
    known = {argument.name: argument for argument in description.arguments}
    kernels = []
    for kernel in forms.kernels:
        arguments = [known[symbol.name] for symbol in kernel.form.inputs]
        numbers = [argument.name for argument in arguments if argument.shape.startswith("float")]
        results = [description.results[name] for name, _ in kernel.form.outputs]
        steps, finals = fold_scalars(
            kernel.form.steps, [value for _, value in kernel.form.outputs], numbers
        )
        kernels.append(
            lower_kernel(
                kernel.name,
                kernel.summary,
                arguments,
                steps,
                list(zip(results, finals, strict=True)),
            )
        )
    return _closed_module(spec, tuple(kernels), description, drops_table(forms.dropped))


def _closed_module(
    spec: ModelSpec,
    kernels: tuple[Kernel, ...],
    description: Description,
    tables: tuple[Table, ...] = (),
) -> ModuleSpec:
    return ModuleSpec(
        spec=spec,
        family="closed_form",
        title=description.title,
        notes=description.notes,
        references=description.references,
        kernels=kernels,
        parameters=description.parameters,
        tables=tables,
    )


def fold_scalars(
    steps: Steps, outputs: Sequence[sp.Expr], scalars: Iterable[str]
) -> tuple[Steps, list[sp.Expr]]:
    """Name every product and sum of single numbers that stands beside an array.

    ``steps``: intermediate quantities; ``outputs``: what is returned; ``scalars``: names of the
    arguments that are single numbers. Result: with further steps, in numbers alone.
    """
    folding = _Folding(set(scalars))
    found: list[Step] = []
    for symbol, value in steps.steps:
        folded = folding.plain(value)
        if folding.is_scalar(value):
            folding.scalars.add(symbol.name)
        found += [*folding.take(), (symbol, folded)]
    finals = [folding.plain(sp.sympify(value)) for value in outputs]
    return Steps((*found, *folding.take())), finals


class _Folding:
    """The names given so far."""

    def __init__(self, scalars: set[str]) -> None:
        self.scalars = scalars
        self._names: dict[sp.Expr, sp.Symbol] = {}
        self._new: list[Step] = []

    def take(self) -> list[Step]:
        """Return the definitions made since the last call."""
        new, self._new = self._new, []
        return new

    def is_scalar(self, value: sp.Basic) -> bool:
        return all(symbol.name in self.scalars for symbol in value.free_symbols)

    def plain(self, value: sp.Basic) -> sp.Basic:
        """Return an expression with its scalar parts named."""
        if self.is_scalar(value) or not value.args:
            return value
        if not isinstance(value, sp.Mul | sp.Add):
            return value.func(*(self.plain(part) for part in value.args))
        numbers = [part for part in value.args if self.is_scalar(part)]
        arrays = [self.plain(part) for part in value.args if not self.is_scalar(part)]
        return value.func(self._named(value.func(*numbers)), *arrays)

    def _named(self, value: sp.Expr) -> sp.Expr:
        """Return a name for a product or sum of scalars, its sign apart."""
        if value.is_number or value.is_Symbol:
            return value
        if value.could_extract_minus_sign():
            return -self._named(-value)
        if value not in self._names:
            symbol = sp.Symbol(f"c{len(self._names)}", real=True)
            self._names[value] = symbol
            self.scalars.add(symbol.name)
            self._new.append((symbol, value))
        return self._names[value]
