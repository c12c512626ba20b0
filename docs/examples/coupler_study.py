"""A study over two link lengths: how far a coupler bends, and whether its motion is stable.

    python coupler_study.py STORE [--count 100] [--speed 35] [--workers 2] [--chunk 16] [--csv FILE]

Begun again with the same arguments after it was stopped, it goes on from the store.  It prints the
best design and how many failed for which reason; the file holds all of them.
"""

import argparse
import warnings

import elastolink as el
import numpy as np
from elastolink.runtime.core.errors import ElastolinkWarning

SCENE = "smith_1972_5152_sixteenth_inch"
STEEL = {"coupler.mass_per_length": 0.0853, "coupler.damping_ratio": 0.01}
LEAST_TRANSMISSION = np.radians(40.0)


def design(scene, speed):
    """Return what is wanted of one design: a scene with lengths of the study."""
    motion = el.steady_state(scene.system(), speed)
    deflection = motion.peak(0.5)
    return {
        "deflection": deflection,  # of midspan [m]
        "relative": deflection / scene["links"]["coupler"],
        "growth": np.log(np.abs(motion.multipliers).max()),  # per period; stable below 0
        "transmission": el.transmission_angle(scene.mechanism()).least,  # [rad]
    }


def study(count=100, speed=35.0, **told):
    """Return the study of ``count`` lengths of the coupler and as many of the follower."""
    scene = el.load_scene(SCENE, STEEL)
    lengths = {
        "links.coupler": np.linspace(0.20, 0.60, count),
        "links.follower": np.linspace(0.08, 0.40, count),
    }
    return el.sweep(design, scene, lengths, options={"speed": speed}, **told)


def best(found):
    """Return the place of the stable design that bends least and transmits well."""
    good = (found["growth"] < 0.0) & (found["transmission"] >= LEAST_TRANSMISSION)
    return int(np.nanargmin(np.where(good, found["relative"], np.nan)))


def main():
    """Read the command line, run the study and print what it says."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("store")
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--speed", type=float, default=35.0)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--chunk", type=int, default=16)
    parser.add_argument("--csv")
    told = parser.parse_args()
    with el.process_pool(told.workers) as pool, warnings.catch_warnings():
        # How many designs failed is printed; which bend too far for the equations, in the table.
        warnings.simplefilter("ignore", ElastolinkWarning)
        given = {"executor": pool, "chunk": told.chunk, "store": told.store, "progress": True}
        found = study(told.count, told.speed, **given)
    if told.csv:
        found.save(told.csv)
    place = best(found)
    print(f"{found.pieces} pieces, {found.resumed} of them from the store")
    print(f"bends {found['relative'].flat[place]:.3g} of its length: {found.point(place)}")
    for reason, places in found.reasons().items():
        print(f"{len(places)} failed, the first: {reason}")


if __name__ == "__main__":
    main()
