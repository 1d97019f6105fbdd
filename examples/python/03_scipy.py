# %% [markdown]
# # SciPy drives the search
# `scene.evaluator` takes arrays: one call simulates a whole population of candidates on all cores. Here differential evolution searches the levels
# and times of a pulse.

# %%
import numpy as np
import numpy.typing as npt
import softland
from scipy.optimize import differential_evolution

scene = softland.shipped("mem-gold")
hold = scene.waveforms["main"].hold_level
scene.waveforms["main"] = softland.Waveform("pulse", levels=[hold, 0.0, hold], times=["16 us", "28 us"], edge="1 us")
keys = ["waveform.main.levels[1]", "waveform.main.levels[2]", "waveform.main.times[1]", "waveform.main.times[2]"]
evaluate = scene.evaluator(keys, ["impact_velocity", "major_bounce_height"])
bounds = [(0.9 * hold, 1.19 * hold), (0.0, 0.5 * hold), (10e-6, 30e-6), (32e-6, 60e-6)]

# %% [markdown]
# The figures of an impossible candidate, and of one that never touches, are NaN; the objective then returns a large value. The objective is the
# impact velocity together with the rebound.


# %%
def cost(x: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    speed, height = evaluate(x.T).T
    return np.asarray(np.nan_to_num(speed / 0.1 + height / 1e-6, nan=1e3))


found = differential_evolution(cost, bounds, vectorized=True, updating="deferred", popsize=16, maxiter=60, seed=1, polish=False, tol=0)
print(dict(zip(keys, found.x)))

# %%
step = softland.shipped("mem-gold").simulate(errors=False)
levels = [found.x[0], found.x[1], hold]
scene.waveforms["main"] = softland.Waveform("pulse", levels=levels, times=[found.x[2], found.x[3]], edge="1 us")
closing = scene.simulate()
print(f"impact velocity {closing.impact_velocity * 1e3:.2f} mm/s instead of {step.impact_velocity * 1e3:.1f} mm/s of the plain step")
