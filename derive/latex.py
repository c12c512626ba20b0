"""The equations of motion of a model as LaTeX, stage by stage: energies, equations, arrays."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import groupby
from typing import Any

import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.printing.latex import LatexPrinter, greek_letters_set

from .arrays import BasisEntry, DiscreteSystem, IndexedEntry, IndexedVector
from .bloch import Element, Letter, Recursion, Word, effective_words, recursion
from .entries import ConstrainedSystem, MatrixForm, TranscendentalSystem
from .pipeline import Model, equations_of_motion, only_wanted
from .projection.galerkin import tidy
from .records import ActionDensity, EquationsOfMotion, FieldEquations, Lagrangian
from .separation import StagedSystem
from .spec import ModelSpec
from .staged import ClosedForm, KernelForms, Steps

_WIDTH = 110  # characters in a line of an equation
_DIGITS = 8  # of a constant
_SILENT = re.compile(r"\\(mathrm|left|right|frac|dot|ddot|quad)\b|[{}_^ ]")
_PARTS = re.compile(r"(?P<stem>[A-Za-z]+)(?P<digits>\d*)(?:_(?P<word>\w+))?")
_LETTERS = {"th": "theta", "lam": "lambda"}
_HEAD = r"""\documentclass[a4paper,landscape]{article}
\usepackage[margin=2cm]{geometry}
\usepackage{amsmath}
\allowdisplaybreaks
\setlength{\parindent}{0pt}
\title{Equations of motion}
\date{}
\begin{document}
\maketitle
"""
_SPECIAL = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "^": r"\^{}",
    "~": r"\~{}",
    **{sign: f"\\{sign}" for sign in "_&%$#"},
}


class _Printer(LatexPrinter):  # type: ignore[misc]
    """Fields without their arguments, derivatives as subscripts and dots, long names upright."""

    def _print_Symbol(self, expr: sp.Symbol, style: str = "plain") -> str:
        return _name(expr.name)

    def _print_AppliedUndef(self, expr: AppliedUndef, exp: str | None = None) -> str:
        return _powered(_name(expr.func.__name__), exp)

    def _print_Float(self, expr: sp.Float) -> str:
        """Print a constant of many digits with the first ones."""
        text = str(super()._print_Float(sp.Float(expr, _DIGITS)))
        return text if expr == sp.Float(expr, _DIGITS) else text + r"\ldots"

    def _print_Derivative(self, expr: sp.Derivative) -> str:
        inner = self._print(expr.expr)
        if not isinstance(expr.expr, AppliedUndef):
            return str(super()._print_Derivative(expr))
        counts = [(str(variable), int(n)) for variable, n in expr.variable_count]
        if len(expr.expr.args) == 1 and len(counts) == 1 and counts[0][1] <= 2:
            dots = {1: r"\dot", 2: r"\ddot"}[counts[0][1]]
            return f"{dots}{{{inner}}}"
        return f"{{{inner}}}_{{{''.join(name * n for name, n in sorted(counts, reverse=True))}}}"


def _powered(text: str, exponent: str | None) -> str:
    return text if exponent is None else f"{{{text}}}^{{{exponent}}}"


def _name(name: str) -> str:
    """Return a name: Greek letters and single letters with a subscript, words upright."""
    match = _PARTS.fullmatch(name)
    if match:
        stem = _LETTERS.get(match["stem"], match["stem"])
        if len(stem) == 1 or stem.lower() in greek_letters_set:
            letter = stem if len(stem) == 1 else f"\\{stem}"
            word = match["word"] and rf"\mathrm{{{_text(match['word'])}}}"
            subscript = ",".join(part for part in (match["digits"], word) if part)
            return f"{letter}_{{{subscript}}}" if subscript else letter
    return rf"\mathrm{{{_text(name)}}}"


def latex_document(models: Sequence[tuple[ModelSpec, Model]]) -> str:
    """Return the equations of motion of models as one complete LaTeX document.

    ``models``: each model is derived and set as one section: energies, field equations, natural and
    jump conditions, and the projected arrays. Result: needs the packages amsmath and geometry
    alone; the same on every run. Raises ``ValueError`` if a model refuses its spec.
    """
    sections = ["".join(_section(spec, model)) for spec, model in models]
    return _HEAD + "\n".join(sections) + "\\end{document}\n"


def _section(spec: ModelSpec, model: Model) -> Iterator[str]:
    description = model.describe(spec)
    yield f"\\section{{{_text(description.title)}}}\n"
    yield f"Module \\texttt{{{_text(spec.name())}}}.\n"
    if description.references:
        yield f"{_text('; '.join(description.references))}.\n"
    for note in description.notes:
        yield f"\n{_text(note)}\n"
    energies = model.energies(spec)
    equations = equations_of_motion(energies)
    if isinstance(energies, ActionDensity):
        yield from _action(energies)
    elif isinstance(energies, Lagrangian):
        yield from _lagrangian(energies)
    if isinstance(equations, FieldEquations):
        yield from _field_equations(equations)
    elif isinstance(equations, EquationsOfMotion):
        yield from _discrete_equations(equations)
    yield from _system(only_wanted(spec, model.discretise(spec, equations)))


def _action(action: ActionDensity) -> Iterator[str]:
    yield from _heading(f"Lagrangian per length, ${action.x}$ from 0 to ${_tex(action.length)}$")
    yield _equation("L", action.density)
    for term in action.point_terms:
        yield _equation(f"L_{{x = {_tex(term.position)}}}", term.expression)
    if action.dissipation != 0:
        yield _equation("R", action.dissipation)
    for item, force in action.force_density.items():
        yield _equation(rf"\delta W / \delta {_tex(item)}", force)
    for force in action.end_forces:
        varied = _trace(action, item=force.field, order=force.order)
        yield _equation(rf"\delta W_{{x = {_tex(force.position)}}}", force.force, varied)
    held = [
        f"${_trace(action, e.field, e.order)} = 0$ at $x = {_tex(e.position)}$"
        for e in action.essential
    ]
    held += [f"${_tex(s.field)} = 0$ at $x = {_tex(s.position)}$" for s in action.supports]
    if held:
        yield f"Prescribed: {', '.join(held)}.\n"


def _trace(action: ActionDensity, item: sp.Expr, order: int) -> str:
    return _tex(sp.Derivative(item, (action.x, order)) if order else item)


def _field_equations(equations: FieldEquations) -> Iterator[str]:
    yield from _heading("Field equations")
    for item, expression in equations.equations.items():
        yield f"Variation of ${_tex(item)}$:\n"
        yield _equation("0", expression)
    if equations.natural:
        yield from _heading("Natural conditions")
    for condition in equations.natural:
        trace = _trace(equations.action, condition.field, condition.order)
        yield f"At $x = {_tex(condition.position)}$, variation of ${trace}$:\n"
        yield _equation("0", condition.expression)
    if equations.jumps:
        yield from _heading("Jump conditions")
    for jump in equations.jumps:
        trace = _trace(equations.action, jump.field, jump.order)
        yield f"At $x = {_tex(jump.position)}$, variation of ${trace}$:\n"
        yield _equation(rf"\left[{_tex(jump.value)}\right]^+_-", jump.applied + jump.reaction)


def _lagrangian(lagrangian: Lagrangian) -> Iterator[str]:
    yield from _heading("Lagrangian")
    yield _equation("L", lagrangian.expression)
    for item, force in lagrangian.forces.items():
        yield _equation(rf"\delta W / \delta {_tex(item)}", force)


def _discrete_equations(equations: EquationsOfMotion) -> Iterator[str]:
    constrained = equations.constraints.rows > 0
    right = r"\Phi_q^T \lambda + Q,\quad \Phi = 0" if constrained else "Q"
    yield from _heading(rf"Equations of motion: $M \ddot{{q}} + c = {right}$")
    yield _equation("q", sp.ImmutableDenseMatrix(equations.coordinates))
    yield _equation("M", equations.mass)
    yield _equation("c", equations.rest)
    yield _equation("Q", equations.forces)
    if constrained:
        yield _equation(r"\lambda", sp.ImmutableDenseMatrix(equations.multipliers))
        yield _equation(r"\Phi", equations.constraints)
        yield _equation(r"\Phi_q", equations.jacobian)


def _system(system: object) -> Iterator[str]:
    if isinstance(system, StagedSystem):
        yield from _arrays(system.system)
        yield from _steps(system.steps)
    elif isinstance(system, ClosedForm):
        yield from _steps(system.steps)
        yield from _heading("Results")
        for name, expression in system.outputs:
            yield _equation(_name(name), expression)
    elif isinstance(system, KernelForms):
        shown: dict[sp.Symbol, sp.Expr] = {}
        for kernel in system.kernels:
            steps = kernel.form.steps.mapping()
            new = [(name, value) for name, value in steps.items() if shown.get(name) != value]
            shown |= steps
            yield from _steps(Steps(tuple(new)))
            yield from _heading(f"Function {_text(kernel.name)}")
            for name, expression in kernel.form.outputs:
                yield _equation(_name(name), expression)
    elif isinstance(system, MatrixForm):
        yield from _heading("Matrices")
        for name, matrix in system.arrays:
            yield _equation(_name(name), matrix)
        yield from _steps(system.steps)
    elif isinstance(system, TranscendentalSystem):
        yield from _heading("Dynamic stiffness $D$ and its number of poles")
        yield _equation("D", system.matrix)
        yield _equation("J", system.poles)
        yield from _steps(system.steps)
    elif isinstance(system, ConstrainedSystem):
        yield from _steps(system.steps)
    elif isinstance(system, Recursion):
        yield from _heading("Recursion")
        for left, terms in recursion_lines(system):
            yield _sum(left, terms)
        yield from _heading("Effective operator")
        for left, terms in word_lines(system):
            yield _sum(left, terms)


def _arrays(system: DiscreteSystem) -> Iterator[str]:
    yield from _heading("Projected arrays")
    yield (
        "\\begin{gather*}\n"
        r"M \ddot{q} + (C + \dot{\theta} G) \dot{q} + (K + K_g + \dot{\theta} D + "
        r"\dot{\theta}^2 H + \ddot{\theta} E) q = \dot{\theta}^2 f + \dot{\theta} h + "
        r"\ddot{\theta} g + p,\\"
        "\n"
        r"G = M' + A - A^T,\quad H = A' - B,\quad E = A - S,\quad ' = d/d\theta"
        "\n\\end{gather*}\nArrays that are not listed vanish.\n"
    )
    for name, array in system.arrays.items():
        label, entry = "K_g" if name == "Kg" else name, tidy(array)
        if isinstance(entry, IndexedVector):
            yield _equation(f"{label}_{{{entry.m}}}", entry.entry)
        elif isinstance(entry, BasisEntry):
            total = sp.Add(*(value * sp.Symbol(what.name) for value, what in entry.terms))
            yield _equation(label, total)
        elif isinstance(entry, IndexedEntry):
            subscript = label if "_" not in label else f"{{{label}}}"
            yield _equation(f"{subscript}_{{{entry.m}{entry.m}}}", entry.diagonal)
            if entry.off_diagonal != 0:
                yield _equation(f"{subscript}_{{{entry.m}{entry.n}}}", entry.off_diagonal)
        else:
            yield _equation(label, entry)


def _steps(steps: Steps) -> Iterator[str]:
    if steps.steps:
        yield from _heading("Quantities that follow the crank")
    for symbol, value in steps.steps:
        yield _equation(_tex(symbol), value)


def _heading(words: str) -> Iterator[str]:
    yield f"\\subsection*{{{words}}}\n"


def _equation(left: str, right: Any, factor: str = "") -> str:
    """Return ``left = right``, broken between terms where it is long; a wide matrix by entries.

    What has cases is given case by case.
    """
    if isinstance(right, sp.Piecewise) and not factor:
        return "".join(_sum(left, [*_case_terms(value), _case(c)]) for value, c in right.args)
    if isinstance(right, sp.MatrixBase) and _row_width(right) > _WIDTH:
        return _entries(left, right)
    terms = _terms(sp.sympify(right))
    if isinstance(right, sp.Expr) and max(map(_width, terms)) > _WIDTH:
        terms = _terms(sp.expand(right))
    if factor:
        terms = [rf"\left({' '.join(terms)}\right) \delta {factor}"]
    return _sum(left, terms)


def _case_terms(value: sp.Expr) -> list[str]:
    terms = _terms(value)
    return _terms(sp.expand(value)) if max(map(_width, terms)) > _WIDTH else terms


def _case(condition: Any) -> str:
    words = "otherwise" if condition == sp.true else "for"
    shown = "" if condition == sp.true else f" {_tex(condition)}"
    return rf"\quad \text{{{words}}}{shown}"


def _sum(left: str, terms: Sequence[str]) -> str:
    """Return ``left`` = the sum of signed terms, broken between them where it is long."""
    lines, length = [""], _width(left)
    for term in terms:
        if lines[-1] and length + _width(term) > _WIDTH:
            lines.append(r"\quad ")
            length = 0
        lines[-1] += f"{term} "
        length += _width(term)
    body = "\\\\\n&".join(line.rstrip() for line in lines)
    return f"\\begin{{align*}}\n{left} ={{}} &{body}\n\\end{{align*}}\n"


def _row_width(matrix: sp.MatrixBase) -> int:
    """Return about how wide a matrix is set: the sum of its widest entries."""
    columns = (matrix[:, j] for j in range(matrix.cols))
    return sum(max(_width(_tex(entry)) for entry in column) for column in columns)


def _entries(left: str, matrix: sp.MatrixBase) -> str:
    """Return the entries of a matrix that do not vanish, an equation each."""
    found = []
    for i in range(matrix.rows):
        for j in range(matrix.cols):
            if matrix[i, j] != 0:
                place = f"{i + 1}" if matrix.cols == 1 else f"{i + 1},{j + 1}"
                found.append(_equation(f"({left})_{{{place}}}", matrix[i, j]))
    return "".join(found)


def _terms(expression: Any) -> list[str]:
    """Return the terms of a sum, each after the first with its sign."""
    if not isinstance(expression, sp.Add):
        return [_tex(expression)]
    texts = [_tex(term) for term in expression.as_ordered_terms()]
    return [texts[0], *(text if text.startswith("-") else f"+ {text}" for text in texts[1:])]


def _width(text: str) -> int:
    """Return about how many characters are seen."""
    return len(_SILENT.sub("", text))


def _tex(expression: Any) -> str:
    # A row of a matrix or of cases a line.
    return str(_Printer({"mul_symbol": r" \, "}).doprint(expression)).replace(r"\\", "\\\\\n")


def _text(words: str) -> str:
    return "".join(_SPECIAL.get(sign, sign) for sign in words)


Line = tuple[str, list[str]]
_OPERATORS = {"H": "H_{0}", "O": r"\Omega", "h": "h"}


def word_latex(word: Word) -> str:
    """Return a word, repeated letters as powers."""
    parts = []
    for letter, run in groupby(word):
        count = len(list(run))
        text = _letter(letter)
        parts.append(text if count == 1 else f"{text}^{{{count}}}")
    return " ".join(parts) or "1"


def _letter(letter: Letter) -> str:
    if isinstance(letter, tuple):
        return f"{_OPERATORS[letter[0]]}_{{{letter[1]}}}"
    return _OPERATORS.get(letter, letter)


def element_latex(element: Element) -> list[str]:
    """Return the terms of an element, each after the first with its sign; ``0`` for none."""
    terms = []
    for place, (word, value) in enumerate(element.terms.items()):
        sign = "-" if value < 0 else "+" if place else ""
        terms.append(f"{sign} {_size(abs(value))}{word_latex(word)}".lstrip())
    return terms or ["0"]


def _size(value: Fraction) -> str:
    if value == 1:
        return ""
    if value.denominator == 1:
        return f"{value.numerator} "
    return rf"\frac{{{value.numerator}}}{{{value.denominator}}} "


def recursion_lines(system: Recursion) -> Iterator[Line]:
    """Yield ``h_k`` and ``Omega_k`` in terms of the earlier ones: left sides, signed terms."""
    for step in recursion(max(system.orders)):
        yield f"h_{{{step.order}}}", element_latex(step.effective)
        yield rf"\Omega_{{{step.order}}}", element_latex(step.wave)


def word_lines(system: Recursion) -> Iterator[Line]:
    """Yield the ``h_k`` written out in P, V and R."""
    for order in range(1, system.listed + 1):
        yield f"h_{{{order}}}", element_latex(effective_words(order))
