#!/usr/bin/env python3
"""Draws two explorations of the gold cantilever over length and gap: the plain step at many points, and the best pulses at some.

    bench/run_explorations.py PROGRAM MAP BEST results

MAP and BEST are stores (--resume goes on with one that is not complete):

    softland explore scenes/mem-gold.toml --vary "structure.length=242um:290um:200" --vary "gap.contact=1.2um:2.6um:200" --out MAP
    softland explore scenes/mem-gold.toml --vary "structure.length=242um:290um:20" --vary "gap.contact=1.2um:2.6um:20" \\
        --study optimize --waveform pulse --budget 2500 --out BEST
"""

import pathlib
import statistics
import sys

from drawing import drawing, heat_map
from tables import rows_of

LENGTH, GAP = "structure_length_m", "gap_contact_m"
T_I, B_H, N_B, V_I = "initial_contact_time_s", "major_bounce_height_m", "bounce_count", "impact_velocity_m_s"


class Map:
    def __init__(self, rows):
        self.rows = rows
        self.lengths, self.gaps = sorted({r[LENGTH] for r in rows}), sorted({r[GAP] for r in rows})
        self.at = {(r[LENGTH], r[GAP]): r for r in rows}

    def values(self, value):
        return [[value(self.at[l, g]) if (l, g) in self.at else None for l in self.lengths] for g in self.gaps]


def panel(found, value, bounds, unit, title, box, missing):
    """Returns a map of value(row), which is None for a missing value. `bounds` separate the colours."""
    return heat_map(found.values(value), bounds, unit, title, box, (242, 290, (245, 255, 265, 275, 285), "length [µm]"),
                    (1.2, 2.6, (1.2, 1.6, 2.0, 2.4), "contact gap [µm]"), missing)


def number(row, key, unit):
    return row[key] / unit if isinstance(row[key], float) else None


def table(found, value, gaps):
    """Returns a table in Markdown, with a row for each length and a column for each of these gaps [µm]."""
    near = lambda all_of, v: min(all_of, key=lambda x: abs(x - v))
    columns = [near(found.gaps, g * 1e-6) for g in gaps]
    lines = ["| length [µm] | " + " | ".join(f"gap {g * 1e6:.2f} µm" for g in columns) + " |", "|---" * (len(columns) + 1) + "|"]
    step = max(1, len(found.lengths) // 8)
    for length in found.lengths[::step]:
        cells = [value(found.at[length, g]) if (length, g) in found.at else "" for g in columns]
        lines.append(f"| {length * 1e6:.1f} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main():
    program, store, best_store, results = sys.argv[1:5]
    step, best = Map(rows_of(program, store)), Map(rows_of(program, best_store))
    heights = (1, 30, 100, 200, 300, 400, 500, 650, 800)
    boxes = [(80 + (k % 2) * 470, 150 + (k // 2) * 440, 440 + (k % 2) * 470, 440 + (k // 2) * 440) for k in range(4)]
    parts = panel(step, lambda r: number(r, B_H, 1e-9), heights, "nm", "Plain step: highest rebound", boxes[0], "")
    parts += panel(step, lambda r: number(r, V_I, 1e-3), (55, 60, 65, 70, 75, 80, 85, 95, 105), "mm/s", "Plain step: impact velocity", boxes[1], "")
    parts += panel(best, lambda r: number(r, B_H, 1e-9), (0.001, 0.01, 0.1, 1, 3, 10, 30, 100, 300), "nm", "Best pulses: highest rebound", boxes[2], "nothing found" if len(best.rows) < 400 else "")
    parts += panel(best, lambda r: number(r, T_I, 1e-6), (30, 34, 38, 42, 46, 50, 54, 58, 62), "µs", "Best pulses: first touch", boxes[3], "")
    svg = drawing(1000, 1040, ["How a gold cantilever bounces over its length and gap, and how softly a searched pulse lands it"],
                  [f"Plain step of 1.25 V_dp of each design: {len(step.rows)} closings. Pulses of five parameters, 2500 evaluations each: {len(best.rows)} searches."], parts)
    (pathlib.Path(results) / "explorations.svg").write_text(svg)

    settled = [r for r in step.rows if r["settled"] == 1]
    free = [r for r in best.rows if isinstance(r[N_B], float) and r[N_B] == 0]
    ratios = []
    for r in best.rows:
        near = step.at[min(step.lengths, key=lambda x: abs(x - r[LENGTH])), min(step.gaps, key=lambda x: abs(x - r[GAP]))]
        if isinstance(r[B_H], float):
            ratios.append(near[B_H] / max(r[B_H], 1e-9))
    print(f"{len(settled)} of {len(step.rows)} steps settle; {len(free)} of {len(best.rows)} pulses land without a significant rebound; "
          f"the rebound is lower by a factor of {statistics.median(ratios):.0f} in the median, {min(ratios):.0f} at the least")
    plain = lambda r: f"{r[B_H] * 1e9:.0f}" + ("" if r["settled"] == 1 else " *")
    print("\nHighest rebound of the step [nm]\n\n" + table(step, plain, (1.2, 1.48, 1.76, 2.04, 2.32, 2.6)))
    print("\nImpact velocity of the step [mm/s]\n\n" + table(step, lambda r: f"{r[V_I] * 1e3:.1f}", (1.2, 1.48, 1.76, 2.04, 2.32, 2.6)))
    pulse = lambda r: f"{r[B_H] * 1e9:.3g} nm, {r[T_I] * 1e6:.1f} µs" if isinstance(r[B_H], float) else "none"
    print("\nBest pulses: highest rebound, first touch\n\n" + table(best, pulse, (1.2, 1.48, 1.76, 2.04, 2.32, 2.6)))


main()
