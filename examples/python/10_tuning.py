# %% [markdown]
# # A waveform for one device on the bench
# A device is a function: it gets a shot, the voltages to be played, and returns when its contact was closed. This one is simulated. It differs from
# the nominal design as devices do, has a mode that the scene does not know, and tells nothing but the voltage of its contact, noise and all.

# %%
from typing import Any

import numpy as np
import softland

scene = softland.shipped("mem-gold")
simulated = scene.device(seed=7, more_modes=1)
noise = np.random.default_rng(1)


def fire(shot: softland.Shot) -> dict[str, Any]:
    edges = simulated(shot)["edges_s"]
    times = np.arange(0, shot.duration, 20e-9)  # what an oscilloscope would record of a contact that switches 5 V
    closed = np.searchsorted([time for time, _ in edges], times, side="right") % 2
    volts = 5.0 * closed + 0.2 * noise.standard_normal(len(times))
    return {"edges_s": softland.contact_edges(times, volts, "2.5 V", hysteresis="2.5 V")}


# %% [markdown]
# Each line says what was seen and what is expected of the next closing.

# %%
found = scene.tune(fire, callback=print)

# %%
for quantity in found.belief.quantities:
    print(f"{quantity.name:24s} {quantity.prior_mean:5.3g} ± {quantity.prior_deviation:.2g} before, {quantity['mean']:8.3g} ± {quantity.deviation:.2g} now")
step = scene.simulate(errors=False)
print(f"the last {found.bounce_free_in_a_row} of {len(found.closings)} closings are without a bounce; the plain step on the drawing has {step.bounce_count:.0f}")
