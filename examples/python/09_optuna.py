# %% [markdown]
# # Optuna drives the evaluator
# Two objectives are minimised at once: impact velocity and closing time. Optuna's NSGA-II proposes pulses, one call of `scene.evaluator` simulates a
# whole generation, and the Pareto front shows how much time a softer landing costs.

# %%
import numpy as np
import numpy.typing as npt
import optuna
import softland

scene = softland.shipped("mem-gold")
hold = scene.waveforms["main"].hold_level
step = scene.simulate(errors=False)
scene.waveforms["main"] = softland.Waveform("pulse", levels=[hold, 0.0, hold], times=["16 us", "28 us"], edge="1 us")
bounds = {
    "waveform.main.levels[1]": (0.9 * hold, 1.19 * hold),
    "waveform.main.levels[2]": (0.0, 0.8 * hold),
    "waveform.main.times[1]": (8e-6, 30e-6),
    "waveform.main.times[2]": (31e-6, 60e-6),
}
evaluate = scene.evaluator(list(bounds), ["initial_contact_time", "impact_velocity"])

# %% [markdown]
# `ask` returns a candidate and `tell` takes its result. A candidate without figures, such as a pulse that never touches, is marked as failed.

# %%
optuna.logging.set_verbosity(optuna.logging.WARNING)
sampler = optuna.samplers.NSGAIISampler(population_size=64, seed=1)
study = optuna.create_study(directions=["minimize", "minimize"], sampler=sampler)
for _ in range(25):
    trials = [study.ask() for _ in range(64)]
    rows = np.array([[trial.suggest_float(key, *bounds[key]) for key in bounds] for trial in trials])
    for trial, (touch, speed) in zip(trials, evaluate(rows)):
        if np.isfinite(touch) and np.isfinite(speed):
            study.tell(trial, (1e6 * touch, 1e3 * speed))
        else:
            study.tell(trial, state=optuna.trial.TrialState.FAIL)

# %%
front: npt.NDArray[np.float64] = np.array(sorted(trial.values for trial in study.best_trials))
for touch, speed in front[:: max(1, len(front) // 8)]:
    print(f"{touch:6.2f} us  {speed:6.2f} mm/s")

# %% [markdown]
# One point of the front is simulated alone, with the errors of its figures.

# %%
slow = step.initial_contact_time * 1.4e6
softest = min((trial for trial in study.best_trials if trial.values[0] < slow), key=lambda trial: float(trial.values[1]))
levels = [softest.params["waveform.main.levels[1]"], softest.params["waveform.main.levels[2]"], hold]
times = [softest.params["waveform.main.times[1]"], softest.params["waveform.main.times[2]"]]
closing = scene.simulate(waveforms={"main": softland.Waveform("pulse", levels=levels, times=times, edge="1 us")})
speeds = f"{closing.impact_velocity * 1e3:.2f} mm/s instead of {step.impact_velocity * 1e3:.1f} mm/s"
print(f"{len(study.trials)} pulses; the softest that is not 40 % later than the step touches at {speeds}")
