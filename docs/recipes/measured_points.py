"""
What do measured speeds say of the machine?
===========================================

Three ends of unstable regions were measured on a rig. Which bending stiffness and which inertia
of the follower fit them, and how well do they decide?
"""

import elastolink as el
import matplotlib.pyplot as plt
import numpy as np

rpm = np.pi / 30.0
system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
measured = (("unstable from", 745.2), ("unstable to", 761.5), ("unstable to", 617.1))
points = [el.design.Point(kind, speed * rpm, deviation=1.5 * rpm) for kind, speed in measured]

# %%
# ``elastolink identify`` and ``read_points`` read the same from a CSV file:
# :doc:`/measured_points`.

unknown = ["bending_stiffness", "follower_inertia"]
fit = el.design.identify(system, points, unknown)
for name, value, deviation in zip(unknown, fit.value, fit.deviation, strict=True):
    print(f"{name}: {system.parameters[name]:.4g} -> {value:.4g} +- {deviation:.2g}")
print("not decided by the points:", fit.undecided)

# %%
# What is left between measured and computed speeds, in standard deviations:

fig, ax = plt.subplots(layout="constrained")
fit.plot(ax)
