"""Write the computed tables of the documents: ``python tests/write_tables.py [DOCUMENT ...]``."""

from __future__ import annotations

import sys
from importlib import import_module

import conftest  # noqa: F401  (lets helpers be imported)
from documented_tables import DOCS, filled

TABLES = {
    "accuracy": "emitted_accuracy",
    "free_free_stability": "free_free_table",
    "rod_convergence": "rod_convergence_tables",
}

if __name__ == "__main__":
    for name in sys.argv[1:] or TABLES:
        document = DOCS / f"{name}.md"
        document.write_text(filled(document.read_text(), import_module(TABLES[name]).TABLES))
