"""Emitted NumPy modules; rewritten by ``regenerate-equations``, never by hand."""
