"""
At which speeds are the stresses low?
=====================================

All links of a four-bar are slender beams. Between which speeds do the stresses stay below
250 MPa, and which critical speeds lie between these bands?
"""

import elastolink as el
import matplotlib.pyplot as plt

system = el.load_scene("aannaque_1996_table_4_1").system()
found = el.quiet_speeds(system, (5.0, 45.0), 250e6)
for band in found.bands:
    after = f", beyond the critical speed {band.above:.2f}" if band.above else ""
    print(f"{band.low:.2f} to {band.high:.2f} rad/s{after}")

# %%
# The largest stress of each link over its limit; peaks stand at critical speeds. The bands
# are those in which no link passes 1.

fig, ax = plt.subplots(layout="constrained")
found.plot(ax)
