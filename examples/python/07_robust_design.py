# %% [markdown]
# # From the nominal design to a waveform for devices
# A waveform that closes the nominal design softly is of little use under process variation. Here one is searched for devices, by the mean of the worst tenth of
# them, and judged on fresh ones beside the plain step.

# %%
import softland

scene = softland.shipped("mem-gold")
print([key for key in scene if key.startswith("spread.")])

# %% [markdown]
# The search counts closings of devices. A real one takes 60 000 of them (`budget`), this one a tenth.

# %%
found = scene.optimize(robust="cvar:0.9", samples=64, budget=6000)
best = softland.load(found.file("best.toml"))
print(found.robust)

# %% [markdown]
# The scene of the winner holds its waveform: it can be simulated, judged, exported.

# %%
judged = best.robustness(samples=500, seed=7)
step, own = (drive.figures["largest_impact_velocity_m_s"].quantiles[2].value for drive in judged.drives)
print(best.waveforms["main"].csv("150 us").splitlines()[0])
print(f"95 % of 500 fresh devices touch at no more than {own * 1e3:.1f} mm/s instead of {step * 1e3:.1f} mm/s")
