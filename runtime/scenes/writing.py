"""Tables as the text of a TOML file."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from typing import Any

_BARE = re.compile(r"[A-Za-z0-9_-]+")


def toml_text(document: Mapping[str, Any]) -> str:
    """Return tables as the text of a TOML file; tables inside those inside tables are inline."""
    return "\n".join(toml_lines(document)) + "\n"


def toml_lines(table: Mapping[str, Any], name: str = "") -> Iterator[str]:
    """Yield the lines of a table, its heading first, then those of the tables inside it."""
    inner = {k: v for k, v in table.items() if isinstance(v, Mapping) and "." not in name}
    plain = {k: v for k, v in table.items() if k not in inner}
    if name and (plain or not inner):
        yield ""
        yield f"[{name}]"
    for key, value in plain.items():
        yield toml_line(key, value)
    for key, content in inner.items():
        yield from toml_lines(content, f"{name}.{_key(key)}" if name else _key(key))


def toml_line(key: str, value: Any) -> str:
    """Return one key with its value."""
    return f"{_key(key)} = {_value(value)}"


def _key(name: str) -> str:
    return name if _BARE.fullmatch(name) else _value(name)


def _value(value: Any) -> str:
    if isinstance(value, str):
        # The escapes of JSON are TOML's; what else is not printable may not stand in it.
        text = json.dumps(value, ensure_ascii=False)
        return "".join(c if c.isprintable() else f"\\U{ord(c):08X}" for c in text)
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, Mapping):
        pairs = ", ".join(toml_line(k, v) for k, v in value.items())
        return f"{{ {pairs} }}"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(_value, value))}]"
    return repr(value)
