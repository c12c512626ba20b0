"""Regions of instability along the speed, a parameter or a geometry, each with its ends."""
