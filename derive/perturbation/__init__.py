"""Stability boundaries of Hill's equation by perturbation, derived by machine to any order."""
