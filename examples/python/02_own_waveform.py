# %% [markdown]
# # A waveform of your own
# This waveform rises to a level, falls to another and rises to the hold voltage, each by half a cosine. First it is simulated with the given
# parameters, then its five parameters are searched, and the result is written for a generator. `examples/05_own_waveform.cc` does the same in C++.

# %%
import numpy as np
import numpy.typing as npt
import softland

Array = npt.NDArray[np.float64]
scene = softland.shipped("mem-gold")
hold = scene.waveforms["main"].hold_level
limit = float(scene.resolved()["driver.main.max_voltage"])


# %% [markdown]
# softland calls `voltage` with arrays of times. The voltage must be smooth between the breakpoints, and constant after the last one.


# %%
def half_cosine(start: float, end: float, part: Array) -> Array:
    return np.asarray(start + (end - start) / 2 * (1 - np.cos(np.pi * np.clip(part, 0, 1))))


def voltage(t: Array, x: Array) -> Array:
    high, low, up, down, back = x
    falling = np.where(t < up + down, half_cosine(high, low, (t - up) / down), half_cosine(low, hold, (t - up - down) / back))
    return np.asarray(np.where(t < up, half_cosine(0, high, t / up), falling))


swell = softland.OwnWaveform(
    "swell",
    voltage,
    breakpoints=lambda x: np.asarray(np.cumsum(x[2:])),
    parameters={
        "high_V": (0, limit, 1.1 * hold),
        "low_V": (0, limit, 0.6 * hold),
        "up_s": ("1 us", "50 us", "10 us"),
        "down_s": ("1 us", "50 us", "25 us"),
        "back_s": ("1 us", "50 us", "10 us"),
    },
)
given = scene.simulate(errors=False, waveforms={"main": swell})
print(f"as given {given.initial_contact_time * 1e6:.2f} us, {given.impact_velocity * 1e3:.2f} mm/s")

# %%
found = scene.optimize(robust="none", own_waveforms=[swell], waveform="swell", budget=1500)
best = swell.at([found.best.parameters[f"main.{name}"] for name in ("high_V", "low_V", "up_s", "down_s", "back_s")])
table = best.csv("150 us").splitlines()
print(f"{len(table) - 1} rows for a generator:", *table[:4], sep="\n")
print(f"searched {found.metrics.initial_contact_time * 1e6:.2f} us, {found.metrics.impact_velocity * 1e3:.2f} mm/s")
