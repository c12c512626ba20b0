"""From the intermediate representation to text, through Jinja2."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

import jinja2
import jinja2.meta
import sympy

from .ir import UNBROKEN, Argument, Kernel, ModuleSpec, Result

_TEMPLATES = Path(__file__).parent.parent / "templates"
_TEMPLATE = "module.py.j2"
_WIDTH = 99
_NAMED = 6  # neighbours of one shape that a docstring names one by one


class TemplateKeys(KeyError):  # noqa: N818 - reads as what it is
    """The keys that a template uses and the keys that it is given are not the same."""


def emit(module: ModuleSpec, content: str) -> str:
    """Return the text of an emitted module.

    ``module``: what the module consists of; ``content``: content hash, shown in the header. Raises
    ``TemplateKeys`` if the template uses a key that is not supplied, or the reverse; ``ValueError``
    if one name stands for two quantities.
    """
    keys = _keys(module, content)
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(_TEMPLATES),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
    )
    tree = environment.parse((_TEMPLATES / _TEMPLATE).read_text())
    used = jinja2.meta.find_undeclared_variables(tree)
    if used != set(keys):
        missing, idle = sorted(used - set(keys)), sorted(set(keys) - used)
        raise TemplateKeys(f"{_TEMPLATE}: not supplied {missing}, not used {idle}")
    return environment.get_template(_TEMPLATE).render(keys)


def _keys(module: ModuleSpec, content: str) -> Mapping[str, Any]:
    kernels = [_kernel(k) for k in module.kernels]
    tables = [(t.name, t.value, t.comment) for t in module.tables]
    returns = {k.name: tuple(r.name for r in k.results) for k in module.kernels}
    return {
        "title": module.title,
        "notes": [_paragraph(note) for note in module.notes],
        "references": _paragraph("Equations: " + "; ".join(module.references) + "."),
        "model": _paragraph("Model: " + _described(module) + "."),
        "counts": [f"{k.name}: {k.operations} operations" for k in module.kernels],
        "content": content,
        "sympy": sympy.__version__,
        "numpy": any(kernel["namespace"] for kernel in kernels),
        "sums": any("_sum(" in line for kernel in kernels for line in kernel["lines"]),
        "kernels": kernels,
        "tables": [
            (_paragraph(comment, "# "), "\n".join(_literal(f"{name} = ", value)))
            for name, value, comment in (
                ("__all__", [kernel.name for kernel in module.kernels], ""),
                ("FAMILY", module.family, ""),
                ("SPEC", module.spec.canonical(), ""),
                ("CONTENT", content, ""),
                ("QUANTITIES", _quantities(module), "Unit and meaning of arguments and results."),
                ("PARAMETERS", tuple(p.name for p in module.parameters), ""),
                ("RETURNS", returns, "Names of what each function returns, in order."),
                *tables,
            )
        ],
    }


def _quantities(module: ModuleSpec) -> dict[str, tuple[str, str]]:
    """Return unit and meaning by name; what has no meaning of its own is left out."""
    known: dict[str, tuple[str, str]] = {}
    every: list[Argument | Result] = [*module.parameters]
    for kernel in module.kernels:
        every += [*kernel.arguments, *kernel.results]
    for item in every:
        words = item.unit, item.meaning
        if item.meaning and known.setdefault(item.name, words) != words:
            raise ValueError(f"{item.name} stands for {known[item.name]} and for {words}")
    return known


def _described(module: ModuleSpec) -> str:
    spec = module.spec
    parts = [f"mechanism {spec.mechanism}", f"formulation {spec.formulation}"]
    if spec.flexible:
        parts.append("flexible " + ", ".join(spec.flexible))
        parts.append("any number of modes" if spec.modes is None else f"{spec.modes} modes")
    for label, values in (
        ("without", spec.drop),
        ("balanced", spec.balanced),
        ("wanted", spec.outputs),
    ):
        if values:
            parts.append(f"{label} " + ", ".join(values))
    return ", ".join(parts)


def _paragraph(text: str, margin: str = "") -> str:
    return "\n".join(
        textwrap.wrap(
            text,
            _WIDTH,
            initial_indent=margin,
            subsequent_indent=margin,
            break_long_words=False,
            break_on_hyphens=False,
        )
    )


def _kernel(kernel: Kernel) -> Mapping[str, Any]:
    lines = []
    for s in kernel.statements:
        lines += _statement(f"    {s.target} = ", s.expression)
        if s.release:
            names = textwrap.wrap(", ".join(s.release), _WIDTH - len("    del "))
            lines += [f"    del {part.rstrip(',')}" for part in names]
    together = "    return " + ", ".join(kernel.returns)
    if len(kernel.returns) == 1:
        lines += _statement("    return ", kernel.returns[0])
    elif len(together) <= _WIDTH:
        lines.append(together.replace(UNBROKEN, " "))
    else:
        lines += ["    return (", *_elements(kernel.returns, "        "), "    )"]
    uses = any("xp." in text for text in lines)
    return {
        "signature": _signature(kernel),
        "docstring": "\n".join(_docstring(kernel)),
        "namespace": kernel.arguments[0].name if uses else "",
        "lines": lines,
    }


def _signature(kernel: Kernel) -> str:
    names = [argument.name for argument in kernel.arguments]
    line = f"def {kernel.name}({', '.join(names)}):"
    if len(line) <= _WIDTH:
        return line
    return "\n".join([f"def {kernel.name}(", *_elements(names, "    "), "):"])


def _docstring(kernel: Kernel) -> Iterator[str]:
    """Yield summary and shapes; units and meanings stand in the module's table."""
    yield f'    """{kernel.summary}.'
    yield ""
    for names, shape in _by_shape(kernel.arguments):
        yield from _shaped(f"    {names} : {shape}")
    shapes = _by_shape(kernel.results)
    if len(shapes) == 1:
        yield f"    Returns {shapes[0][1]}{' each' if len(kernel.results) > 1 else ''}."
    else:
        yield "    Returns"
        for names, shape in shapes:
            yield from _shaped(f"        {names} : {shape}")
    yield '    """'


def _shaped(line: str) -> list[str]:
    margin = " " * (len(line) - len(line.lstrip()) + 4)
    return textwrap.wrap(line, _WIDTH, subsequent_indent=margin, break_long_words=False)


def _by_shape(items: Iterable[Argument | Result]) -> list[tuple[str, str]]:
    """Return the names of neighbours of one shape, many of them as first and last, and it."""
    groups = []
    for shape, group in groupby(items, lambda item: item.shape):
        names = [item.name for item in group]
        many = len(names) > _NAMED
        groups.append((f"{names[0]} to {names[-1]}" if many else ", ".join(names), shape))
    return groups


def _elements(values: Sequence[str], margin: str) -> list[str]:
    """Return the elements of a tuple, as many to a line as fit; a long one has its own lines."""
    lines: list[str] = []
    line = margin
    for value in values:
        if len(line) + len(value) + 2 <= _WIDTH:
            line += f" {value}," if line.strip() else f"{value},"
            continue
        if line.strip():
            lines.append(line)
        line = margin
        if len(margin) + len(value) + 1 <= _WIDTH:
            line += f"{value},"
        else:
            lines += _statement(margin, value, ",")
    return [*lines, line] if line.strip() else lines


def _statement(start: str, expression: str, end: str = "") -> list[str]:
    """Return a statement on as many lines as it takes."""
    line = f"{start}{expression}{end}"
    if len(line) > _WIDTH:
        margin = " " * (len(start) - len(start.lstrip()))
        parts = textwrap.wrap(
            expression, _WIDTH - len(margin) - 4, break_long_words=False, break_on_hyphens=False
        )
        line = (
            f"{start}(\n" + "".join(f"{margin}    {part}\n" for part in parts) + f"{margin}){end}"
        )
    return line.replace(UNBROKEN, " ").split("\n")


def _literal(start: str, value: Any, end: str = "", margin: str = "") -> Iterator[str]:
    """Yield a constant: on one line, or a row of a table to a line, or numbers that fill lines."""
    line = f"{margin}{start}{_inline(value)}{end}"
    if len(line) <= _WIDTH:
        yield line
        return
    inner = margin + "    "
    if isinstance(value, str):
        yield f"{margin}{start}("
        width = _WIDTH - len(inner) - 2
        for part in textwrap.wrap(value, width, break_on_hyphens=False, drop_whitespace=False):
            yield f"{inner}{_inline(part)}"
        yield f"{margin}){end}"
        return
    brackets = _inline(type(value)())
    yield f"{margin}{start}{brackets[0]}"
    if isinstance(value, dict):
        for key, item in value.items():
            yield from _literal(f"{_inline(key)}: ", item, ",", inner)
    elif any(_is_row(item, _WIDTH - len(inner) - 1) for item in value):
        for item in value:
            yield from _literal("", item, ",", inner)
    else:
        yield from _elements([_inline(item) for item in value], inner)
    yield f"{margin}{brackets[1]}{end}"


def _is_row(item: object, width: int) -> bool:
    """Return True for what has a line of its own: a tuple with text in it, or what is long."""
    texts = isinstance(item, tuple) and any(isinstance(part, str) for part in item)
    return texts or len(_inline(item)) > width


def _inline(value: object) -> str:
    """Return a constant as Python source on one line, text in double quotes if it has none."""
    if isinstance(value, str):
        return repr(value) if '"' in value else json.dumps(value, ensure_ascii=False)
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_inline(k)}: {_inline(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_inline, value)) + "]"
    if isinstance(value, tuple):
        return "(" + ", ".join(map(_inline, value)) + ("," if len(value) == 1 else "") + ")"
    return repr(value)
