# %% [markdown]
# # A waveform for one device on the bench
# `scene.tune` sees a device as a function: the function takes a shot, which holds the commanded voltages, and returns the times at which the contact
# closed and opened. The device here is simulated. It deviates from the nominal design by process variation, has a mode that the scene does not
# have, and shows only a noisy voltage of its contact.

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
# Each printed line tells what the closing showed and what is expected of the next one.

# %%
found = scene.tune(fire, callback=print)

# %%
for quantity in found.belief.quantities:
    unit = quantity.unit or "of the nominal value"
    before, now = f"{quantity.prior_mean:.3g} ± {quantity.prior_deviation:.2g}", f"{quantity['mean']:.3g} ± {quantity.deviation:.2g}"
    print(f"{quantity.name:24s} {before} before, {now} now, {unit}")
step = scene.simulate(errors=False)
print(f"the last {found.bounce_free_in_a_row} of {len(found.closings)} closings are bounce-free; the nominal design bounces {step.bounce_count:.0f} times under the plain step")
