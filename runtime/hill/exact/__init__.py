"""Exact boundaries: eigenvalues of Hill's matrix, certified enclosures, exponents, derivatives."""
