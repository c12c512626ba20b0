"""
A study of two numbers, on two cores
====================================

At which speeds is a coupler unstable, and how much damping closes these regions? A sweep works out
any function at all combinations of values, in pieces that processes, threads or a cluster take in
any order, to the same bytes.
"""

import elastolink as el
import matplotlib.pyplot as plt
import numpy as np

rpm = np.pi / 30.0
system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
damping, speed = np.linspace(0.0, 0.4, 41), np.linspace(600.0, 1000.0, 401)

# %%
# Processes begin by importing the script: what starts them stands below the line that asks for
# ``__main__``. With ``store="study"`` finished pieces are kept in a folder, and the same call goes
# on from there after it was stopped.

if __name__ == "__main__":
    values = {"damping": damping, "speed": speed * rpm}
    with el.process_pool(2) as pool:
        study = el.sweep("floquet_multipliers", system, values, executor=pool)
    largest = np.abs(study.outputs["multipliers"]).max(axis=-1)
    print(largest.size, "points, error at most", study.error)

    fig, ax = plt.subplots(layout="constrained")
    picture = ax.contourf(speed, damping, largest, 20)
    ax.contour(speed, damping, largest, [1.0], colors="w")
    ax.set(xlabel="speed [rpm]", ylabel="damping of the coupler [N s/m$^2$]")
    fig.colorbar(picture, label="largest multiplier; beyond 1 the motion grows")
