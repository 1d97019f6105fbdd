# %% [markdown]
# # A map of dither
# A small sine on top of the step, called dither, changes how the switch bounces (Bognash 2019). One call simulates a map of 60 x 40 closings, which
# shows the frequencies and amplitudes that help.

# %%
import sys

import numpy as np
import softland

scene = softland.shipped("mem-gold")
hold = scene.waveforms["main"].hold_level
scene.waveforms["main"] = softland.Waveform("harmonic", base=hold, amplitude=0.05 * hold, angular_frequency=3e5)
evaluate = scene.evaluator(["waveform.main.angular_frequency", "waveform.main.amplitude"], ["major_bounce_height", "impact_velocity"])
frequencies = np.linspace(0.5e5, 8e5, 60)
amplitudes = np.linspace(0.0, 0.15, 40) * hold
grid = np.stack(np.meshgrid(frequencies, amplitudes), axis=-1)
height, speed = np.moveaxis(evaluate(grid.reshape(-1, 2)).reshape(*grid.shape[:2], 2), -1, 0)

# %%
if "ipykernel" in sys.modules or "--plot" in sys.argv:
    import matplotlib.pyplot as plt

    figure, ax = plt.subplots(layout="constrained")
    mesh = ax.pcolormesh(frequencies / 1e3, 100 * amplitudes / hold, 1e9 * height, cmap="viridis")
    ax.set_xlabel("angular frequency of the dither [krad/s]")
    ax.set_ylabel("amplitude [% of the hold level]")
    figure.colorbar(mesh, label="highest rebound [nm]")
    if "--plot" in sys.argv:
        figure.savefig(sys.argv[sys.argv.index("--plot") + 1], dpi=120)

# %%
best = np.unravel_index(np.nanargmin(height), height.shape)
print(f"without dither the highest rebound is {1e9 * height[0, 0]:.0f} nm")
print(
    f"the least is {1e9 * height[best]:.0f} nm, at {frequencies[best[1]] / 1e3:.0f} krad/s "
    f"and {100 * amplitudes[best[0]] / hold:.1f} % of the hold level"
)
