"""Boundaries to an order in the parameters, from the emitted recursion."""
