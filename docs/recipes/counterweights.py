"""
Which counterweights?
=====================

Two counterweights, on the crank and on the follower, are to lower the force in a pin, the driving
torque and the shaking force of a crank-rocker together. How far can they?
"""

import elastolink as el
import matplotlib.pyplot as plt
import numpy as np
from elastolink.runtime.rigid import with_counterweights

machine = el.load_scene("smith_1972_12_6_12_12").machine()

# %%
# The weights say how much each peak counts, over that of the machine without counterweights. The
# lower bound tells that no other pair does better.

weights = {"f23": 1.0, "torque": 1.0, "shaking_force": 1.0}
best = el.balance(machine, speed=10.0, weights=weights)
for link, weight in best.counterweights.items():
    print(f"{link}: {weight.mass:.3f} kg at {weight.along:.4f}, {weight.across:.4f} m")
for name in weights:
    print(f"{name}: {best.relative[name]:.3f} of what it was")
print(f"sum {best.value:.6f}, bound {best.lower_bound:.6f}")

# %%
# Before and after, over a turn. The shaking force falls, and the torque pays a little for it.

theta = np.linspace(0.0, 2.0 * np.pi, 361)
balanced = with_counterweights(machine, best.counterweights.values())
fig, (above, below) = plt.subplots(2, 1, sharex=True, layout="constrained")
for label, one in (("as it is", machine), ("balanced", balanced)):
    forces = el.rigid_forces(one, theta, speed=10.0)
    shaking = np.linalg.norm(forces.shaking_force, axis=-1)
    above.plot(np.degrees(theta), shaking, label=label)
    below.plot(np.degrees(theta), forces.torque)
above.set_ylabel("shaking force [N]")
below.set(xlabel="crank angle [deg]", ylabel="driving torque [N m]")
above.legend()

# %%
# What one costs the other: the least shaking force for each limit on the torque.

fig, ax = plt.subplots(layout="constrained")
el.trade_off(machine, 10.0, "shaking_force", "torque").plot(ax)
