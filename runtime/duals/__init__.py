"""Exact derivatives of emitted functions: dual numbers, and what they are taken by."""
