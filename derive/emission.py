"""From the intermediate representation to text, through Jinja2."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import jinja2
import jinja2.meta
import sympy

from .ir import UNBROKEN, Kernel, ModuleSpec

_TEMPLATES = Path(__file__).parent.parent / "templates"
_WIDTH = 99


class TemplateKeys(KeyError):  # noqa: N818 - reads as what it is
    """The keys that a template uses and the keys that it is given are not the same."""


def _environment() -> jinja2.Environment:
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(_TEMPLATES),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
    )
    environment.filters["pyrepr"] = _literal
    environment.filters["sentence"] = _sentence
    return environment


def _literal(text: str | None) -> str:
    """Return a string as a Python literal in double quotes."""
    return "None" if text is None else json.dumps(text, ensure_ascii=False)


def emit(module: ModuleSpec, content: str) -> str:
    """Return the text of an emitted module.

    Parameters
    ----------
    module : ModuleSpec
        What the module consists of.
    content : str
        Content hash, shown in the header.

    Raises
    ------
    TemplateKeys
        If the template of the family uses a key that is not supplied, or the reverse.
    """
    keys = _keys(module, content)
    name = f"{module.family}.py.j2"
    environment = _environment()
    used = _used_keys(environment, name)
    if used != set(keys):
        missing, idle = sorted(used - set(keys)), sorted(set(keys) - used)
        raise TemplateKeys(f"{name}: not supplied {missing}, not used {idle}")
    return environment.get_template(name).render(keys)


def _used_keys(environment: jinja2.Environment, name: str) -> set[str]:
    used: set[str] = set()
    pending = [name]
    while pending:
        source = (_TEMPLATES / pending.pop()).read_text()
        tree = environment.parse(source)
        used |= jinja2.meta.find_undeclared_variables(tree)
        pending += [str(parent) for parent in jinja2.meta.find_referenced_templates(tree)]
    return used


def _keys(module: ModuleSpec, content: str) -> Mapping[str, Any]:
    spec = module.spec
    keys: dict[str, Any] = {
        "title": module.title,
        "notes": [_paragraph(note) for note in module.notes],
        "references": _paragraph("Equations: " + "; ".join(module.references) + "."),
        "model": _paragraph("Model: " + _described(module) + "."),
        "counts": [f"{k.name}: {k.operations} operations" for k in module.kernels],
        "content": content,
        "sympy": sympy.__version__,
        "spec": _wrapped_text(spec.canonical()),
        "names": sorted(k.name for k in module.kernels),
        "kernels": [_kernel(k) for k in module.kernels],
        "tables": [(name, _wrapped(name, value, "")) for name, value in module.tables],
        "parameters": [(p.name, p.unit, p.meaning) for p in module.parameters],
    }
    if module.family == "linear_periodic":
        keys["terms"] = [
            _row(_literal(t.array), str(t.power), *map(_literal, (t.scale, t.angle, t.modal)))
            for t in module.terms
        ]
        keys["basis"] = [
            _row(_literal(b.name), *map(repr, (b.weight, b.row, b.column, b.at)))
            for b in module.basis
        ]
    if module.family == "recursion":
        keys["words"] = module.words
    return keys


def _row(*values: str) -> str:
    """Return a tuple as an element of a tuple, on one line where it fits."""
    line = f"    ({', '.join(values)}),"
    if len(line) <= _WIDTH:
        return line
    return "    (\n" + "".join(f"        {value},\n" for value in values) + "    ),"


def _wrapped_text(text: str) -> str:
    """Return a long text as literals side by side."""
    pieces = textwrap.wrap(text, _WIDTH - 6, break_on_hyphens=False, drop_whitespace=False)
    return "(\n" + "".join(f"    {piece!r}\n" for piece in pieces) + ")"


def _sentence(text: str, unit: str) -> str:
    """Return the meaning of a quantity and its unit as a paragraph of a docstring."""
    line = f"{text} [{unit}]." if unit else f"{text}."
    margin = " " * 8
    lines = textwrap.wrap(
        line,
        _WIDTH,
        initial_indent=margin,
        subsequent_indent=margin,
        break_long_words=False,
        break_on_hyphens=False,
    )
    return "\n".join(lines)


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


def _paragraph(text: str) -> str:
    return "\n".join(textwrap.wrap(text, _WIDTH, break_long_words=False, break_on_hyphens=False))


def _kernel(kernel: Kernel) -> Mapping[str, Any]:
    lines = []
    for s in kernel.statements:
        lines.append(_wrapped(s.target, s.expression, "    "))
        if s.release:
            lines += _releases(s.release)
    if len(kernel.returns) == 1:
        closing = _wrapped("return", kernel.returns[0], "    ", joint=" ")
    else:
        body = "".join(_item(value, "        ") for value in kernel.returns)
        closing = f"    return (\n{body}    )"
    uses = any("xp." in text for text in [*lines, closing])
    return {
        "name": kernel.name,
        "signature": _signature(kernel),
        "summary": kernel.summary,
        "arguments": [(a.name, a.shape, a.unit, a.meaning) for a in kernel.arguments],
        "results": [(r.name, r.shape, r.unit, r.meaning) for r in kernel.results],
        "references": "; ".join(kernel.references),
        "namespace": kernel.arguments[0].name if uses else "",
        "lines": lines,
        "closing": closing,
    }


def _releases(names: Sequence[str]) -> list[str]:
    """Return the lines that let go of intermediate arrays."""
    wrapped = textwrap.wrap(", ".join(names), _WIDTH - len("    del "))
    return [f"    del {part.rstrip(',')}" for part in wrapped]


def _signature(kernel: Kernel) -> str:
    names = [argument.name for argument in kernel.arguments]
    line = f"def {kernel.name}({', '.join(names)}):"
    if len(line) <= _WIDTH:
        return line
    wrapped = textwrap.wrap(", ".join(names) + ",", _WIDTH - 4)
    return f"def {kernel.name}(\n" + "".join(f"    {part}\n" for part in wrapped) + "):"


def _item(value: str, indent: str) -> str:
    """Return one element of a tuple on lines of its own."""
    line = f"{indent}{value},"
    if len(line) <= _WIDTH:
        return line + "\n"
    return _wrapped("", value, indent, joint="", after=1).rstrip() + ",\n"


def _wrapped(target: str, expression: str, indent: str, joint: str = " = ", after: int = 0) -> str:
    """Return a statement on as many lines as it takes; ``after`` characters will follow it."""
    line = f"{indent}{target}{joint}{expression}"
    if len(line) + after <= _WIDTH:
        return line.replace(UNBROKEN, " ")
    parts = textwrap.wrap(
        expression, _WIDTH - len(indent) - 4, break_long_words=False, break_on_hyphens=False
    )
    body = "".join(f"{indent}    {part}\n" for part in parts).replace(UNBROKEN, " ")
    return f"{indent}{target}{joint}(\n{body}{indent})"
