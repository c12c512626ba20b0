"""The sliding pendulum by hand: its drive, its places and its energy."""

import numpy as np

ROD = 0.8  # m
NUMBERS = {"block": 1.7, "bob": 0.6, "rod": ROD, "spring": 35.0, "damping": 0.0, "gravity": 9.81}
STROKE = 0.15  # m


def drives(rate):
    """Return the block's place and its derivatives, a sine of the given rate [rad/s]."""
    return {
        "drive": lambda q, t: STROKE * np.sin(rate * t),
        "drive_d1": lambda q, t: STROKE * rate * np.cos(rate * t),
        "drive_d2": lambda q, t: -STROKE * rate**2 * np.sin(rate * t),
    }


def cartesian(place, angle, speed, turning, rod=ROD):
    """Place and speed of block and bob from the minimal coordinates."""
    sin, cos = np.sin(angle), np.cos(angle)
    q = np.stack([place, place + rod * sin, -rod * cos], axis=-1)
    qd = np.stack([speed, speed + rod * turning * cos, rod * turning * sin], axis=-1)
    return q, qd
