# %% [markdown]
# # Many devices on a cluster
# The evaluator can be pickled, so Dask can send it to its workers. When a worker is killed, another one takes over its rows, and the table stays
# the same.

# %%
import sys

import numpy as np
import numpy.typing as npt
import softland
from dask.distributed import Client, LocalCluster

Array = npt.NDArray[np.float64]
DEVICES = int(sys.argv[1]) if len(sys.argv) > 1 and sys.argv[1].isdigit() else 100_000
PARTS = 40


def closed(evaluate: softland.Evaluator, rows: Array) -> Array:
    return evaluate(rows)


def main() -> None:
    scene = softland.shipped("mem-gold")
    scene["simulate.duration"] = "60 us"
    evaluate = scene.evaluator(["structure.thickness", "gap.electrode"], ["initial_contact_time", "impact_velocity"], jobs=1)
    rows = evaluate.nominal * (1 + 0.02 * np.random.default_rng(1).standard_normal((DEVICES, 2)))
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster, Client(cluster) as client:  # type: ignore[no-untyped-call]
        futures = client.map(lambda part: closed(evaluate, part), np.array_split(rows, PARTS))
        futures[2].result()
        worker = next(iter(cluster.workers.values()))
        worker.process.process._process.kill()  # as if the machine had gone
        table = np.concatenate(client.gather(futures))
    alone = scene.evaluator(evaluate.keys, evaluate.figures)(rows)
    same = np.array_equal(table, alone)
    words = "the same" if same else "another"
    print(f"{DEVICES} devices, one worker killed: the table is {words}; 95 % touch below {1e3 * np.quantile(table[:, 1], 0.95):.1f} mm/s")


# %%
if __name__ == "__main__":
    main()
