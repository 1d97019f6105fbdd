# %% [markdown]
# # A first closing
# A gold cantilever is closed by a plain voltage step. How fast does it hit its contact, and how often does it bounce?

# %%
import sys

import softland

scene = softland.shipped("mem-gold")
closing = scene.simulate()
closing

# %% [markdown]
# A figure is a float in SI units with the members `unit` and `error`.

# %%
print(f"first contact   {closing.initial_contact_time * 1e6:.3f} us")
print(f"its error       {closing.initial_contact_time.error:.1e} {closing.initial_contact_time.unit}")
print(f"highest rebound {closing.major_bounce_height * 1e9:.1f} nm")

# %% [markdown]
# The trajectory is that of the contact point; `shape` gives the deflection of the whole beam at any time.

# %%
run = closing.trajectory
x, y = closing.shape([10e-6, 20e-6, float(closing.initial_contact_time)])
print(f"{len(run)} points in time; the tip is deflected by {1e6 * y[-1, -1]:.3f} um at first contact")
if "ipykernel" in sys.modules:
    closing.plot()

# %% [markdown]
# Keys of the scene can be changed, and are checked as in a scene file. Here the beam becomes thicker.

# %%
scene["structure.thickness"] = "2.2 um"
thicker = scene.simulate()
print(f"impact velocity {closing.impact_velocity * 1e3:.1f} mm/s, of the thicker beam {thicker.impact_velocity * 1e3:.1f} mm/s")
