"""Tongues of coupled systems as series in a parameter and the detuning."""
