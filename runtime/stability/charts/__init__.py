"""Stability charts over two parameters."""
