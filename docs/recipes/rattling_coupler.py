"""
My coupler rattles: what to change?
===================================

A rig with a thin coupler runs at 765 rpm, and its coupler whips. What does it do there, which
unstable region is in the way, and what is the least change with which the range around this speed
is stable?
"""

import elastolink as el
import matplotlib.pyplot as plt
import numpy as np

rpm = np.pi / 30.0
scene = el.load_scene("smith_1972_5152_sixteenth_inch")

# %%
# What happens at this speed, in words, and what feeds it:

found = el.design.diagnose(scene, 765.0 * rpm)
print("\n".join(found.lines))

# %%
# The least changes of the coupler with which all speeds from 740 to 780 rpm are stable. Each is
# verified: regions, multipliers and marched motions of the changed machine.

numbers = ["coupler.thickness", "coupler.damping"]
changes = el.design.stabilise(scene, (740.0 * rpm, 780.0 * rpm), numbers)
for change in changes.changes:
    print(change.settings)

# %%
# The region, by the inertia of the follower, and the range that is wanted:

system = scene.system()
x = ("speed", np.linspace(600.0, 900.0, 121) * rpm)
y = ("follower_inertia", np.linspace(4e-4, 1.2e-3, 61))
fig, ax = plt.subplots(layout="constrained")
el.stability_chart(system, x=x, y=y).plot(ax)
ax.axvspan(740.0, 780.0, color="tab:green", alpha=0.2)
