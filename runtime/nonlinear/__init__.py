"""Nonlinear systems under a periodic drive: periodic motions over a parameter, sweeps, jumps."""
