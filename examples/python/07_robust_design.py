# %% [markdown]
# # From the nominal design to a waveform for devices
# A waveform that closes the nominal design softly is of little use under process variation. This search minimises the mean cost of the worst tenth of
# the simulated devices. The waveform is then judged on other devices, beside the plain step.

# %%
import softland

scene = softland.shipped("mem-gold")
print([key for key in scene if key.startswith("spread.")])

# %% [markdown]
# `budget` is a number of simulated closings. By default a search takes 60 000; this one takes a tenth of them.

# %%
found = scene.optimize(robust="cvar:0.9", samples=64, budget=6000)
best = softland.load(found.file("best.toml"))
print(found.robust)

# %% [markdown]
# The scene `best.toml` holds the waveform that was found. It can be simulated, judged and exported.

# %%
judged = best.robustness(samples=500, seed=7)
step, own = (drive.figures["largest_impact_velocity_m_s"].quantiles[2].value for drive in judged.drives)
table = best.waveforms["main"].csv("150 us").splitlines()
print(f"{len(table) - 1} rows for a generator:", *table[:4], sep="\n")
print(f"95 % of 500 fresh devices touch at no more than {own * 1e3:.1f} mm/s instead of {step * 1e3:.1f} mm/s")
