"""
A mechanism that is not built in
================================

A slider-crank whose connecting rod bends is not among the built-in mechanisms. A file of 90 lines
says what its energies are; the equations are derived from it, and the machine then has all that
built-in ones have. The file is explained in :doc:`/own_model`.
"""

import os
from pathlib import Path

import elastolink as el
import matplotlib.pyplot as plt
import numpy as np
from elastolink.derive.regenerate import main

examples = Path("../examples")  # docs/examples of the project

# %%
# Derive the equations and emit them as a module; on the command line
# ``regenerate-equations --model slider_crank_rod.py --out modules``.

modules = os.environ.setdefault("ELASTOLINK_GENERATED", "modules")
main(["--model", str(examples / "slider_crank_rod.py"), "--out", modules])

# %%
# The scene holds the numbers.

rpm = np.pi / 30.0
system = el.load_scene(examples / "slider_crank_rod.toml").system()
multipliers = el.floquet_multipliers(system, speed=900.0 * rpm)
print("stable at 900 rpm:", multipliers.stable, np.abs(multipliers.multipliers).max())

# %%
# Where it is unstable, by the mass of the slider:

x = ("speed", np.linspace(1000.0, 2400.0, 141) * rpm)
y = ("slider_mass", np.linspace(0.05, 0.3, 61))
fig, ax = plt.subplots(layout="constrained")
el.stability_chart(system, x=x, y=y).plot(ax)
