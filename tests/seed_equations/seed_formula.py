"""Printed formulas: one text that the page typesets, a test evaluates and a machine falsifies.

A text holds relations, separated by ``;``.  Their sides are Python expressions of names, numbers,
``+ - * / ** @``, calls, subscripts, attributes ``.T`` and lists (matrices); ``=``, ``~`` (nearly),
``<``, ``<=``, ``>``, ``>=`` and ``->`` stand between blanks.  ``pm`` is a sign, ``where(c, a, b)``
a case, ``sym`` takes the rows of an upper triangle; ``Sum(body, i, low, high)``, ``Prod`` (which
may count down), ``Int(body, x, low, high)`` and ``D(body, x, order)`` bind their index; in
``Sum(body, i)`` the sum over all ``i`` is understood; ``dots`` and ``O(...)`` stand for what is
left out.  Everything else is refused.
"""

from __future__ import annotations

import ast
import copy
import operator
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache, reduce
from numbers import Number

import numpy as np
import sympy as sp
from scipy import linalg

_RELATIONS = {"=": "=", "<": "<", ">": ">", "<=": r"\le", ">=": r"\ge"}
_RELATIONS |= {"~": r"\approx", "->": r"\to"}
_OPERATIONS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.MatMult: operator.matmul,
}
_COMPARISONS = {ast.Lt: (np.less, "<"), ast.Gt: (np.greater, ">"), ast.Eq: (np.equal, "=")}


def _function(name: str):
    """Return an elementary function for numbers of any kind."""
    plain = {"asin": "arcsin", "atan": "arctan"}.get(name, name)

    def apply(value):
        if isinstance(value, sp.Basic):
            return getattr(sp, name)(value)
        return getattr(np, plain)(value)

    return apply


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(40)


def _integral(body, low, high, symbolic):
    """Integrate by SymPy where the names are symbols, else by 40 Gauss points at once."""
    if symbolic:
        x = sp.Symbol("_x", real=True)
        return sp.integrate(sp.expand(body(x)), (x, low, high))
    half = (high - low) / 2
    return half * np.sum(_WEIGHTS * body(low + half * (1 + _NODES)))


_ELEMENTARY = ("sin", "cos", "tan", "exp", "log", "sqrt", "sinh", "cosh", "asin", "atan")
_FUNCTIONS = {name: _function(name) for name in _ELEMENTARY} | {
    "abs": abs,
    "cot": lambda value: 1 / _FUNCTIONS["tan"](value),
    "inv": lambda m: m.inv() if isinstance(m, sp.MatrixBase) else np.linalg.inv(m),
    "diag": linalg.block_diag,
    "det": lambda m: m.det() if isinstance(m, sp.MatrixBase) else np.linalg.det(m),
    "max": np.max,
    "odd": lambda k: k % 2 == 1,
}
_CONSTANTS = {"dots": 0, "pi": np.pi, "deg": np.pi / 180.0, "I": 1j}


def _symmetric(rows):
    """Return a symmetric matrix from the rows of its upper triangle."""
    n = len(rows)
    return _matrix([[rows[min(i, j)][abs(i - j)] for j in range(n)] for i in range(n)])


def _matrix(rows):
    """Return a list as a vector, a list of lists as a matrix, of SymPy where an entry is."""
    flat = [v for row in rows for v in (row if isinstance(row, list) else [row])]
    if any(isinstance(v, sp.Basic) for v in flat):
        return sp.Matrix(rows)
    return np.block(rows) if any(np.ndim(v) for v in flat) else np.array(rows)


class _Names(dict):
    """The values of the names, and what numbers become among them."""

    def __init__(self, values: Mapping[str, object]):
        super().__init__(values)
        kinds = list(values.values())
        symbolic = any(isinstance(v, (sp.Basic, sp.MatrixBase)) for v in kinds)
        self.number = sp.nsimplify if symbolic else lambda v: v
        exact = {"dots": 0, "pi": sp.pi, "deg": sp.pi / 180, "I": sp.I}
        self.constants = exact if symbolic else _CONSTANTS

    def __missing__(self, name):
        if name in self.constants:
            return self.constants[name]
        if name in _FUNCTIONS:
            return _FUNCTIONS[name]
        raise NameError(f"no value for {name}")

    def with_index(self, name, value):
        new = copy.copy(self)
        new[name] = value
        return new


def _evaluate(node: ast.expr, names: _Names):
    match node:
        case ast.Constant(value=value):
            return names.number(value)
        case ast.Name(id=name):
            return names[name]
        case ast.UnaryOp(op=ast.USub(), operand=inside):
            return -_evaluate(inside, names)
        case ast.BinOp(left=left, op=op, right=right):
            return _OPERATIONS[type(op)](_evaluate(left, names), _evaluate(right, names))
        case ast.Call(
            func=ast.Name(id="Sum" | "Prod" as kind), args=[body, ast.Name(id=index), low, high]
        ):
            first, last = (int(_evaluate(end, names)) for end in (low, high))
            down = kind == "Prod" and first > last
            order = range(first, last - 1, -1) if down else range(first, last + 1)
            terms = [_evaluate(body, names.with_index(index, k)) for k in order]
            return reduce(operator.add if kind == "Sum" else _times, terms) if terms else 0
        case ast.Call(func=ast.Name(id="Sum"), args=[body, ast.Name(id=index)]):
            return sum(_evaluate(body, names.with_index(index, k)) for k in names[index])
        case ast.Call(func=ast.Name(id="Int"), args=[body, ast.Name(id=index), low, high]):
            ends = [_evaluate(end, names) for end in (low, high)]
            integral = names.get("Int", _integral)
            inside = lambda x: _evaluate(body, names.with_index(index, x))  # noqa: E731
            return integral(inside, *ends, names.number is sp.nsimplify)
        case ast.Call(func=ast.Name(id="D"), args=[body, ast.Name(id=index), *order]):
            times = int(_evaluate(order[0], names)) if order else 1
            if "D" in names:
                return names["D"](_evaluate(body, names), index, times)
            return sp.diff(_evaluate(body, names), names[index], times)
        case ast.Call(func=ast.Name(id="O")):
            return 0
        case ast.Call(func=ast.Name(id="sym"), args=[ast.List(elts=rows)]):
            return _symmetric([_list(row, names) for row in rows])
        case ast.Call(func=ast.Name(id="where"), args=[condition, one, other]):
            chosen = _evaluate(condition, names)
            if np.ndim(chosen):
                return np.where(chosen, _evaluate(one, names), _evaluate(other, names))
            return _evaluate(one if chosen else other, names)
        case ast.Call(func=function, args=args):
            return _evaluate(function, names)(*(_evaluate(a, names) for a in args))
        case ast.Subscript(value=table, slice=ast.Tuple(elts=parts)):
            return _entry(_evaluate(table, names), tuple(_index(p, names) for p in parts))
        case ast.Subscript(value=table, slice=part):
            return _entry(_evaluate(table, names), _index(part, names))
        case ast.Attribute(value=inside, attr="T"):
            return _evaluate(inside, names).T
        case ast.List(elts=items):
            return _matrix([_list(item, names) for item in items])
        case ast.Compare(left=left, ops=[op], comparators=[right]):
            return _COMPARISONS[type(op)][0](_evaluate(left, names), _evaluate(right, names))
    raise SyntaxError(f"not in the notation: {ast.unparse(node)}")


def _times(one, other):
    """Multiply numbers, or matrices in their order."""
    return one @ other if np.ndim(one) else one * other


def _entry(table, index):
    """Return an entry of a table; one that is not there, as of a changed index, is a number too."""
    try:
        return table[index]
    except LookupError:
        others = list(table.values() if isinstance(table, dict) else table)
        if any(callable(v) for v in others):
            raise ValueError(f"no entry {index}") from None
        return 0.7317 * next((v for v in others if np.ndim(v) or v != 0), 1.0)


def _index(node, names):
    """Return an index: a whole number where it is one."""
    value = _evaluate(node, names)
    return int(value) if isinstance(value, (Number, sp.Integer)) and value == int(value) else value


def _list(item, names):
    if isinstance(item, ast.List):
        return [_evaluate(entry, names) for entry in item.elts]
    return _evaluate(item, names)


_GREEK = "alpha beta gamma delta epsilon zeta eta theta mu nu xi rho sigma tau phi psi omega"
_GREEK += " lambda Gamma Delta Lambda Sigma Phi Omega"
_WORDS = {"lam": r"\lambda", "eps": r"\epsilon", "pi": r"\pi", "pm": r"\pm"}
_WORDS |= {"dots": r"\cdots", "deg": r"{}^\circ", "oo": r"\infty", "l": r"\ell"}
_WORDS |= {name: "\\" + name for name in _GREEK.split()}
_ACCENTS = {"dot": r"\dot{%s}", "ddot": r"\ddot{%s}", "bar": r"\bar{%s}", "hat": r"\hat{%s}"}
_ACCENTS["vec"] = r"\vec{%s}"
_PRIMES = {"p": "'", "pp": "''", "ppp": "'''", "p4": "''''"}
_NAMED = {"asin": r"\arcsin", "atan": r"\arctan"}
_NAMED |= {name: "\\" + name for name in ("sin", "cos", "tan", "cot", "sinh", "cosh")}
_NAMED |= {name: "\\" + name for name in ("exp", "log", "max", "det")}


@cache
def _letter(name: str) -> str:
    """Typeset a name: ``theta2_p``, ``I_2A``, ``r_dot``, ``omega3``; ``I`` is the unit i."""
    if name == "I":
        return "i"
    first, *more = name.split("_")
    base, digits = re.fullmatch(r"([A-Za-z]+)(\d*)", first).groups()
    text = _WORDS.get(base, base)
    below, primes = [digits] if digits else [], ""
    for part in more:
        if part in _ACCENTS:
            text = _ACCENTS[part] % text
        elif part in _PRIMES:
            primes += _PRIMES[part]
        else:
            letters, count = re.fullmatch(r"([A-Za-z]*)(\w*)", part).groups()
            below.append(_WORDS.get(letters, letters) + count)
    text += primes
    joined = (" " if any("\\" in part for part in below) else "").join(below)
    return f"{text}_{{{joined}}}" if len(joined) > 1 else f"{text}_{joined}" if joined else text


_SUM, _PRODUCT, _FACTOR, _ATOM = range(4)
_BINDERS = ("Sum", "Prod", "Int")
_BELOW = (ast.Mult, ast.MatMult, ast.Div)


class _Printer:
    """LaTeX of a side, terms and factors in the order in which they are written."""

    def __init__(self, letters: Mapping[str, str], partial: bool = False):
        self.letters, self.partial = letters, partial

    def text(self, node: ast.expr, least: int = _SUM) -> str:
        latex, strength = self._of(node)
        return latex if strength >= least else rf"\left({latex}\right)"

    def name(self, name: str) -> str:
        return self.letters.get(name) or _letter(name)

    def _of(self, node: ast.expr) -> tuple[str, int]:
        match _without_sign(node):
            case ast.expr() as bare:
                return f"-{self.text(bare, _PRODUCT)}", _SUM
        match node:
            case ast.Constant(value=value):
                return self._number(value), _ATOM
            case ast.Name(id=name):
                return self.name(name), _ATOM
            case ast.BinOp(left=left, op=ast.Add() | ast.Sub() as op, right=right):
                plus = isinstance(op, ast.Add)
                inner = _SUM if plus and _without_sign(right) is None else _PRODUCT
                sign = "" if _leading_sign(right) else "+ " if plus else "- "
                return f"{self.text(left)} {sign}{self.text(right, inner)}", _SUM
            case ast.BinOp(left=left, op=ast.Mult() | ast.MatMult(), right=right):
                far = isinstance(left, ast.Call) and _called(left) in _BINDERS and left.args[2:]
                one, other = self.text(left, _ATOM if far else _PRODUCT), self.text(right, _FACTOR)
                return one + (r" \cdot " if other[0].isdigit() else " ") + other, _PRODUCT
            case ast.BinOp(left=left, op=ast.Div(), right=right):
                return rf"\frac{{{self.text(left)}}}{{{self.text(right)}}}", _FACTOR
            case ast.BinOp(left=left, op=ast.Pow(), right=right):
                return self._power(left, self.text(right)), _FACTOR
            case ast.Call(func=ast.Name(id=name), args=args):
                return self._call(name, args)
            case ast.Call(func=ast.Subscript() as table, args=args):
                return self.text(table) + _brackets(", ".join(map(self.text, args))), _ATOM
            case ast.Subscript(value=ast.Name(id=name), slice=part):
                parts = part.elts if isinstance(part, ast.Tuple) else [part]
                below = ", ".join(self.text(p) for p in parts)
                base = self.name(name)
                return (f"{{{base}}}_{{{below}}}" if "_" in base else f"{base}_{{{below}}}"), _ATOM
            case ast.Attribute(value=inside):
                return f"{self.text(inside, _ATOM)}^T", _FACTOR
            case ast.List(elts=items):
                rows = [i.elts if isinstance(i, ast.List) else [i] for i in items]
                body = r" \\ ".join(" & ".join(self.text(e) for e in row) for row in rows)
                return rf"\begin{{bmatrix}} {body} \end{{bmatrix}}", _ATOM
            case ast.Compare(left=left, ops=[op], comparators=[right]):
                sign = _COMPARISONS[type(op)][1]
                return f"{self.text(left)} {sign} {self.text(right)}", _SUM
        raise SyntaxError(f"not in the notation: {ast.unparse(node)}")

    @staticmethod
    def _number(value) -> str:
        mantissa, _, power = repr(value).partition("e")
        return rf"{mantissa} \cdot 10^{{{int(power)}}}" if power else mantissa

    def _power(self, left, power):
        match left:
            case ast.Call(func=ast.Name(id=name), args=[inside]) if name in _NAMED:
                return rf"{_NAMED[name]}^{{{power}}}{_brackets(self.text(inside))}"
        base = self.text(left, _ATOM)
        return f"{{{base}}}^{{{power}}}" if "^" in base or "'" in base else f"{base}^{{{power}}}"

    def _call(self, name, args):
        texts = [self.text(a) for a in args]
        match name, texts:
            case "Sum", [_, _]:
                return self.text(args[0], _PRODUCT), _FACTOR
            case "Sum" | "Prod" | "Int", [_, index, low, high]:
                body = self.text(args[0], _PRODUCT)
                if name == "Int":
                    return rf"\int_{{{low}}}^{{{high}}} {body}\, d{index}", _FACTOR
                return rf"\{name.lower()}_{{{index}={low}}}^{{{high}}} {body}", _FACTOR
            case "D", [_, index, *order]:
                power = f"^{{{order[0]}}}" if order else ""
                nested = isinstance(args[0], ast.Call) and _called(args[0]) == "D"
                d = r"\partial " if self.partial and not nested else "d"
                if isinstance(args[0], ast.Name):
                    return rf"\frac{{{d}{power}{texts[0]}}}{{{d}{index}{power}}}", _FACTOR
                body = self.text(args[0], _FACTOR if nested else _ATOM)
                return rf"\frac{{{d}{power}}}{{{d}{index}{power}}} {body}", _FACTOR
            case "sqrt", [inside]:
                return rf"\sqrt{{{inside}}}", _ATOM
            case "abs", [inside]:
                return rf"\lvert {inside} \rvert", _ATOM
            case "sym", [_]:
                rows = [[self.text(e) for e in row.elts] for row in args[0].elts]
                lines = r" \\ ".join(" & ".join([""] * k + row) for k, row in enumerate(rows))
                return rf"\begin{{bmatrix}} {lines} \end{{bmatrix}}", _ATOM
            case "diag", [one, other]:
                return rf"\begin{{bmatrix}} {one} & \\ & {other} \end{{bmatrix}}", _ATOM
            case "inv", [_]:
                return f"{self.text(args[0], _ATOM)}^{{-1}}", _FACTOR
            case "where", [condition, one, other]:
                cases = rf"{one} & \text{{if }} {condition} \\ {other} & \text{{otherwise}}"
                return rf"\begin{{cases}} {cases} \end{{cases}}", _ATOM
        return (_NAMED.get(name) or self.name(name)) + _brackets(", ".join(texts)), _ATOM


def _brackets(inside: str) -> str:
    return rf"\left({inside}\right)" if r"\frac" in inside else f"({inside})"


def _called(call: ast.Call) -> str:
    """Return the name of the function or of the table of functions that is called."""
    return call.func.id if isinstance(call.func, ast.Name) else call.func.value.id


def _without_sign(node: ast.expr) -> ast.expr | None:
    """Return a product or quotient without the minus that it begins with, None if it has none."""
    match node:
        case ast.UnaryOp(operand=inside):
            return inside
        case ast.BinOp(left=left, op=ast.Mult() | ast.MatMult() | ast.Div() as op, right=right):
            bare = _without_sign(left)
            return bare and ast.BinOp(bare, op, right)
    return None


def _leading_sign(node):
    """Return whether a term begins with a sign that is a name."""
    while isinstance(node, ast.BinOp) and isinstance(node.op, _BELOW):
        node = node.left
    return isinstance(node, ast.Name) and node.id == "pm"


@dataclass(frozen=True)
class Relation:
    """A chain of sides with the signs between them."""

    sides: tuple[ast.expr, ...]
    signs: tuple[str, ...]

    def defines(self) -> str | None:
        """Return the name that stands alone on the left of a single equation."""
        first = self.sides[0]
        single = isinstance(first, ast.Name) and self.signs in (("=",), ("~",))
        return first.id if single else None


def _split(text: str) -> Relation:
    """Cut a relation at its signs outside of all brackets."""
    depth, parts, signs = 0, [""], []
    for token in re.split(r"(\s(?:=|~|<=|>=|<|>|->)\s|[()\[\]])", text):
        depth += (token in "([") - (token in ")]") if len(token) == 1 else 0
        if depth == 0 and token.strip() in _RELATIONS:
            signs.append(token.strip())
            parts.append("")
        else:
            parts[-1] += token
    return Relation(tuple(ast.parse(p.strip(), mode="eval").body for p in parts), tuple(signs))


class Formula:
    """A formula in the notation of this module.

    ``letters`` is the LaTeX of names that the rules of the notation do not give.
    """

    def __init__(self, text: str, letters: Mapping[str, str] | None = None):
        self.letters = letters or {}
        self.relations = tuple(_split(part) for part in text.split(";"))

    def __getitem__(self, number: int | slice) -> Formula:
        """Return one of the relations, or some."""
        part, found = copy.copy(self), self.relations[number]
        part.relations = (found,) if isinstance(found, Relation) else found
        return part

    @property
    def latex(self) -> str:
        """The formula as the page shows it."""
        out = _Printer(self.letters, self._partial())
        return r",\; ".join(self._chains(out.text, _RELATIONS.__getitem__))

    def __str__(self) -> str:
        return "; ".join(self._chains(ast.unparse, str))

    def _chains(self, text, sign) -> Iterator[str]:
        """Yield each relation, its sides and its signs written by functions."""
        for relation in self.relations:
            pairs = zip(relation.signs, relation.sides[1:], strict=True)
            rest = (f" {sign(s)} {text(side)}" for s, side in pairs)
            yield text(relation.sides[0]) + "".join(rest)

    def _partial(self) -> bool:
        """Return whether the formula differentiates by more than one variable."""
        sides = [side for relation in self.relations for side in relation.sides]
        calls = [n for s in sides for n in ast.walk(s) if isinstance(n, ast.Call)]
        by = {call.args[1].id for call in calls if _called(call) == "D"}
        return len(by) > 1

    def _defined(self, values: Mapping[str, object]) -> tuple[_Names, tuple[Relation, ...]]:
        """Add the names that the formula defines; return what is left to hold."""
        names, left = _Names(values), list(self.relations)
        for _ in range(len(left)):
            for relation in tuple(left):
                name = relation.defines()
                if name and name not in names:
                    try:
                        names[name] = _evaluate(relation.sides[1], names)
                    except NameError:
                        continue
                    left.remove(relation)
        return names, tuple(left)

    def values(self, **values) -> dict[str, object]:
        """Return all names that the formula defines, with their values."""
        names, _ = self._defined(values)
        return {name: names[name] for name in names if name not in values}

    def sides(self, **values) -> list[tuple[object, ...]]:
        """Return the sides of every relation that defines no new name."""
        names, left = self._defined(values)
        return [tuple(_evaluate(side, names) for side in r.sides) for r in left]

    def value(self, side: int = -1, **values):
        """Return one side, the last one, of the first relation."""
        return _evaluate(self.relations[0].sides[side], _Names(values))

    def pairs(self, **values) -> Iterator[tuple[str, object, object, float]]:
        """Yield sign, both neighbours and their size of every relation that is to hold."""
        names, left = self._defined(values)
        for relation in left:
            found = [_evaluate(side, names) for side in relation.sides]
            for k, sign in enumerate(relation.signs):
                size = max(_size(side, names) for side in relation.sides[k : k + 2])
                yield sign, found[k], found[k + 1], size

    def mutants(self) -> Iterator[Formula]:
        """Yield the formula with one sign, number or index changed, in every place.

        Where there is no such place, yield it with one side doubled.
        """
        sides = [side for relation in self.relations for side in relation.sides]
        double = not any(True for side in sides for _ in _mutated(side))
        for number, relation in enumerate(self.relations):
            for place, side in enumerate(relation.sides):
                twice = ast.BinOp(ast.Constant(2), ast.Mult(), side)
                for wrong in [twice] * place if double else _mutated(side):
                    sides = (*relation.sides[:place], wrong, *relation.sides[place + 1 :])
                    changed, mutant = list(self.relations), copy.copy(self)
                    changed[number] = Relation(sides, relation.signs)
                    mutant.relations = tuple(changed)
                    yield mutant


def greatest(value: object) -> float:
    """Return the greatest magnitude of a number or an array."""
    return float(np.abs(np.asarray(value, dtype=complex)).max())


def _size(node: ast.expr, names: _Names) -> float:
    """Return the magnitude of a side, none of its sums cancelling."""
    match node:
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub(), right=right):
            return max(_size(left, names), _size(right, names))
        case ast.BinOp(left=left, op=ast.Mult(), right=right):
            return _size(left, names) * _size(right, names)
        case ast.BinOp(left=left, op=ast.Div(), right=right):
            return _size(left, names) * greatest(1 / _evaluate(right, names))
        case ast.UnaryOp(operand=inside):
            return _size(inside, names)
        case ast.Call(func=ast.Name(id="where"), args=[condition, one, other]):
            if not np.ndim(chosen := _evaluate(condition, names)):
                return _size(one if chosen else other, names)
        case ast.Call(func=ast.Name(id="det"), args=[matrix]):
            entries = _evaluate(matrix, names)
            return greatest(entries) ** len(entries)
        case ast.Call(func=ast.Name(id="Sum"), args=[body, ast.Name(id=index), low, high]):
            ends = [int(_evaluate(end, names)) for end in (low, high)]
            terms = range(ends[0], ends[1] + 1)
            return max((_size(body, names.with_index(index, k)) for k in terms), default=0.0)
        case ast.Call(func=ast.Name(id="Int"), args=[body, ast.Name(id=index), low, high]) if (
            "Int" not in names
        ):
            ends = [_evaluate(end, names) for end in (low, high)]
            inside = names.with_index(index, ends[0] + (ends[1] - ends[0]) * (1 + _NODES) / 2)
            return _size(body, inside) * abs(ends[1] - ends[0])
    return greatest(_evaluate(node, names))


def _mutated(side: ast.expr) -> Iterator[ast.expr]:
    """Yield a side with one sign, number or index changed."""
    nodes = list(ast.walk(side))
    rest = {inner for node in nodes if _left_out(node) for inner in ast.walk(node)}
    uses = {n.id: "value" for n in nodes if isinstance(n, ast.Name) and n not in rest}
    uses |= {n.value.id: "table" for n in nodes if isinstance(n, ast.Subscript)}
    uses |= {_called(n): "function" for n in nodes if isinstance(n, ast.Call)}
    # (-1)^(j + k) is (-1)^(j - k).
    powers = (n for n in nodes if isinstance(n, ast.BinOp) and isinstance(n.op, ast.Pow))
    exponents = [n.right for n in powers if isinstance(n.left, ast.UnaryOp)]
    parity = {n for part in exponents for n in ast.walk(part) if isinstance(n, ast.BinOp)}
    for position, node in enumerate(nodes):
        for wrong in () if node in rest | parity else _wrong(node, uses):
            new = copy.deepcopy(side)
            target = list(ast.walk(new))[position]
            yield wrong if position == 0 else _Exchange(target, wrong).visit(new)


class _Exchange(ast.NodeTransformer):
    """Put one node in the place of another."""

    def __init__(self, old: ast.AST, new: ast.AST):
        self.old, self.new = old, new

    def visit(self, node):
        return self.new if node is self.old else self.generic_visit(node)


def _left_out(node: ast.AST) -> bool:
    """Return whether a term stands for what is left out."""
    if isinstance(node, ast.Call):
        return isinstance(node.func, ast.Name) and node.func.id == "O"
    return isinstance(node, ast.Name) and node.id == "dots"


def _wrong(node: ast.AST, uses: Mapping[str, str]) -> Iterator[ast.expr]:
    """Yield a node with another sign, number or index; ``uses`` tells what each name stands for."""
    match node:
        case ast.BinOp(left=left, op=ast.Add(), right=right) if not (
            _leading_sign(right) or _left_out(right)
        ):
            yield ast.BinOp(left, ast.Sub(), right)
        case ast.BinOp(left=left, op=ast.Sub(), right=right) if not _leading_sign(right):
            yield ast.BinOp(left, ast.Add(), right)
        case ast.UnaryOp(operand=inside):
            yield inside
        case ast.Constant(value=value):
            yield ast.Constant(value + 1 if isinstance(value, int) else 1.1 * value + 0.05)
        case ast.Subscript(value=table, slice=ast.Name() as index):
            yield ast.Subscript(table, ast.BinOp(index, ast.Add(), ast.Constant(1)))
        case ast.Name(id=name):
            base = re.sub(r"\d", "", name)
            alike = (n for n, use in uses.items() if n != name and use == uses[name])
            others = [n for n in alike if re.sub(r"\d", "", n) == base]
            if others:
                yield ast.Name(min(others, key=lambda n: (n < name, n)))
