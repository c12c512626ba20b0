"""Boundaries of Hill's equation as chapter 8 of Smith expands them, in exact numbers."""
