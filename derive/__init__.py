"""SymPy side: from a model specification to the text of a NumPy module."""
