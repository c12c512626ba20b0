"""Planar linkages of rigid bodies: description, Newton and Euler, virtual power, multipliers."""
