# %% [markdown]
# # Sobol' indices by OpenTURNS and by softland
# Sobol' indices tell which varying quantity causes how much of the variance of the impact velocity. OpenTURNS computes them from samples of
# `scene.evaluator`; `scene.robustness` computes them by itself.

# %%
import openturns as ot
import softland

scene = softland.shipped("mem-gold")
scene["spread"] = {
    "structure.thickness": {"distribution": "normal", "cov": "2 %"},
    "structure.youngs_modulus": {"distribution": "normal", "cov": "3 %"},
    "gap.electrode": {"distribution": "normal", "cov": "2 %"},
}
keys = ["gap.electrode", "structure.thickness", "structure.youngs_modulus"]
evaluate = scene.evaluator(keys, ["initial_contact_time"])
deviations = [0.02, 0.02, 0.03]
distribution = ot.ComposedDistribution([ot.Normal(float(x), float(x * s)) for x, s in zip(evaluate.nominal, deviations)])
model = ot.PythonFunction(len(keys), 1, func_sample=lambda rows: evaluate(rows))
ot.RandomGenerator.SetSeed(1)
rows = ot.SobolIndicesExperiment(distribution, 2048).generate()
theirs = ot.SaltelliSensitivityAlgorithm(rows, model(rows), 2048).getFirstOrderIndices()

# %%
found = scene.robustness(samples=2000)
ours = found.sensitivity.figures["initial_contact_time_s"]["variables"]
for key, index in zip(keys, theirs):
    print(f"{key:26s} {index:.2f} by OpenTURNS, {ours[key].first_order.value:.2f} by softland")
largest = max(range(len(keys)), key=lambda k: float(theirs[k]))
print(f"{keys[largest]} has {theirs[largest]:.2f} of the variance by OpenTURNS, {ours[keys[largest]].first_order.value:.2f} by softland")
