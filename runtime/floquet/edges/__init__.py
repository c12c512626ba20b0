"""Edges of unstable regions along the speed, found from the multipliers and refined."""
