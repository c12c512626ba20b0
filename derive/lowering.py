"""From SymPy to the intermediate representation: pruning, CSE, operation counts, finished lines."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import sympy as sp
from sympy.core.function import AppliedUndef

from .describe import Description
from .ir import Argument, Kernel, ModuleSpec, Result, Statement
from .spec import ModelSpec
from .staged import ClosedForm, Steps

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
}


class CannotPrint(TypeError):  # noqa: N818 - reads as what it is
    """An expression has no form in the emitted language."""


def to_line(expression: sp.Expr) -> str:
    """Return one expression as Python source, with functions taken from the namespace ``xp``."""
    return _print(sp.sympify(expression))[0]


_ATOM, _POWER, _PRODUCT, _SUM = 3, 2, 1, 0


def _print(e: sp.Basic) -> tuple[str, int]:
    if isinstance(e, sp.Symbol):
        return e.name, _ATOM
    if isinstance(e, sp.Integer):
        return (str(int(e)), _ATOM) if e >= 0 else (f"-{abs(int(e))}", _SUM)
    if isinstance(e, sp.Rational):
        return f"{int(e.p)} / {int(e.q)}", _SUM if e < 0 else _PRODUCT
    if isinstance(e, sp.Expr) and e.is_number:
        return _print_number(e)
    if isinstance(e, sp.Add):
        return _print_sum(e), _SUM
    if isinstance(e, sp.Mul):
        return _print_product(e)
    if isinstance(e, sp.Pow):
        return _print_power(e)
    if isinstance(e, sp.Piecewise):
        return _print_choice(e), _ATOM
    if isinstance(e, sp.Equality | sp.StrictGreaterThan):
        sign = "==" if isinstance(e, sp.Equality) else ">"
        return f"({_print(e.args[0])[0]} {sign} {_print(e.args[1])[0]})", _ATOM
    if isinstance(e, sp.Mod):
        return f"({_wrap(e.args[0], _PRODUCT)} % {_wrap(e.args[1], _POWER)})", _ATOM
    for kind, name in _FUNCTIONS.items():
        if isinstance(e, kind):
            return f"xp.{name}({', '.join(_print(a)[0] for a in e.args)})", _ATOM
    if isinstance(e, AppliedUndef):
        raise CannotPrint(f"{e} is a function that no step defines")
    raise CannotPrint(f"{type(e).__name__} {e} has no form in an emitted module")


def _print_number(e: sp.Expr) -> tuple[str, int]:
    """Print a number that is no fraction as the nearest double, rounded once."""
    value = sp.N(e, 40)
    if not value.is_Float:
        raise CannotPrint(f"{e} is not a real number")
    return repr(float(value)), _SUM if value < 0 else _ATOM


def _wrap(e: sp.Basic, least: int) -> str:
    text, level = _print(e)
    return text if level >= least else f"({text})"


def _print_sum(e: sp.Add) -> str:
    parts: list[str] = []
    for term in e.as_ordered_terms():
        negative = term.could_extract_minus_sign()
        text = _wrap(-term if negative else term, _PRODUCT)
        parts.append(
            ("- " if negative else "+ ") + text if parts else ("-" if negative else "") + text
        )
    return " ".join(parts)


def _print_product(e: sp.Mul) -> tuple[str, int]:
    negative = e.could_extract_minus_sign() and e.args[0].is_number
    # Exact: exp(-x) stays as it is, for 1 / exp(x) would overflow.
    numerator, denominator = sp.fraction(_one_number(-e if negative else e), exact=True)
    upper = [f for f in sp.Mul.make_args(numerator) if f != 1]
    lower = [f for f in sp.Mul.make_args(denominator) if f != 1]
    text = " * ".join(_wrap(f, _POWER if i else _PRODUCT) for i, f in enumerate(upper)) or "1"
    if lower:
        divisor = " * ".join(_wrap(f, _POWER) for f in lower)
        text = f"{text} / ({divisor})" if len(lower) > 1 else f"{text} / {divisor}"
    return (f"-{text}", _SUM) if negative else (text, _PRODUCT)


def _one_number(e: sp.Expr) -> sp.Expr:
    """Return a product with its numeric factors as one: a fraction, or one rounded number."""
    numbers = [f for f in sp.Mul.make_args(e) if f.is_number]
    if all(f.is_Rational for f in numbers):
        return e
    others = [f for f in sp.Mul.make_args(e) if not f.is_number]
    return sp.Mul(sp.N(sp.Mul(*numbers), 40), *others)


def _print_power(e: sp.Pow) -> tuple[str, int]:
    base, exponent = e.as_base_exp()
    if base == -1:
        return f"(1 - 2 * (({_print(exponent)[0]}) % 2))", _ATOM
    if exponent == sp.Rational(1, 2):
        return f"xp.sqrt({_print(base)[0]})", _ATOM
    if exponent.is_number and exponent.could_extract_minus_sign():
        return f"1 / {_wrap(base**-exponent, _POWER)}", _PRODUCT
    if isinstance(exponent, sp.Integer):
        return f"{_wrap(base, _ATOM)}**{int(exponent)}", _POWER
    if exponent == sp.Rational(3, 2):
        return f"{_wrap(base, _ATOM)} * xp.sqrt({_print(base)[0]})", _PRODUCT
    if isinstance(exponent, sp.Rational):
        return f"{_wrap(base, _ATOM)}**({int(exponent.p)} / {int(exponent.q)})", _POWER
    raise CannotPrint(f"power {e} has no form in an emitted module")


def _print_choice(e: sp.Piecewise) -> str:
    if len(e.args) != 2 or e.args[1][1] is not sp.true:
        raise CannotPrint(f"{e} is not a choice between two cases")
    (first, condition), (second, _) = e.args
    if first.is_number and second.is_number:
        # The standard's ``where`` wants an array among its choices.
        switch = f"xp.asarray({_print(condition)[0]}, dtype=xp.float64)"
        scaled = switch if first - second == 1 else f"{_wrap(first - second, _POWER)} * {switch}"
        return scaled if scaled == switch and second == 0 else f"({_print(second)[0]} + {scaled})"
    return f"xp.where({', '.join(_print(part)[0] for part in (condition, first, second))})"


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
    references: Sequence[str] = (),
) -> Kernel:
    """Turn named steps and outputs into straight-line code.

    Steps that no output needs are pruned; one canonical common-subexpression elimination runs
    over all that is left; each statement stands as late as its first use allows.

    Parameters
    ----------
    name, summary : str
        Name of the emitted function and first line of its docstring.
    arguments : sequence of Argument
        Inputs, in order.
    steps : Steps
        Intermediate quantities.
    outputs : sequence of (Result, Expr)
        Returned quantities.
    references : sequence of str
        Equations of the documents that the function stands for.

    Raises
    ------
    CannotPrint
        If a symbol is neither an argument nor a step, or an expression has no emitted form.
    """
    finals = [sp.sympify(expression) for _, expression in outputs]
    kept = steps.needed(finals)
    _require_parity([*finals, *(expression for _, expression in kept.steps)])
    named = [symbol for symbol, _ in kept.steps]
    replacements, reduced = sp.cse(
        [expression for _, expression in kept.steps] + finals,
        symbols=sp.numbered_symbols("x", cls=sp.Symbol),
        order="canonical",
    )
    values = dict(replacements) | dict(zip(named, reduced, strict=False))
    returned = reduced[len(named) :]
    inputs = {argument.name for argument in arguments}
    ordered = _in_order_of_need(values, named, returned, inputs, name)
    statements = tuple(Statement(symbol.name, to_line(values[symbol])) for symbol in ordered)
    return Kernel(
        name=name,
        summary=summary,
        arguments=tuple(arguments),
        results=tuple(result for result, _ in outputs),
        statements=statements,
        returns=tuple(to_line(expression) for expression in returned),
        references=tuple(references),
        operations=count_operations([values[s] for s in ordered] + list(returned)),
    )


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
        description.references,
    )
    return ModuleSpec(
        spec=spec,
        family="closed_form",
        title=description.title,
        notes=description.notes,
        references=description.references,
        kernels=(kernel,),
        parameters=description.parameters,
    )
