#!/usr/bin/env python3
"""Draws two explorations after published ones: the Casimir switch over size and gap, and the gold cantilever over the length of its
electrode and the height of its dimple.

    bench/run_published_maps.py PROGRAM CASIMIR DIMPLE results

CASIMIR and DIMPLE are stores (--resume goes on with one that is not complete):

    softland explore scenes/nem-casimir.toml --vary "structure.length=4.75um:5.25um:30" --vary "gap.contact=10nm:42nm:25" --out CASIMIR
    softland explore scenes/mem-gold.toml --vary "electrode.main.span[2]=140um:238um:40" --vary "gap.contact=0.9um:3um:40" --out DIMPLE
"""
import datetime
import pathlib
import sys

from drawing import drawing, heat_map
from tables import machine, revision, rows_of

N_B, B_H, V_I, T_I = "bounce_count", "major_bounce_height_m", "impact_velocity_m_s", "initial_contact_time_s"


class Grid:
    def __init__(self, rows, across, up):
        self.rows = rows
        self.across, self.up = sorted({r[across] for r in rows}), sorted({r[up] for r in rows})
        self.at = {(r[across], r[up]): r for r in rows}

    def values(self, key, unit):
        of = lambda row: row[key] / unit if row and isinstance(row[key], float) else None
        return [[of(self.at.get((a, u))) for a in self.across] for u in self.up]

    def counts(self):
        found = {}
        for row in self.rows:
            found[row["status"]] = found.get(row["status"], 0) + 1
        return ", ".join(f"{count} {status}" for status, count in sorted(found.items(), key=lambda item: -item[1]))


def table(grid, columns, rows, cell, across, up):
    """Returns a table of some points in Markdown, with a row for each position `across` and a column for each position `up`."""
    pick = lambda places, count: [places[round(k * (len(places) - 1) / (count - 1))] for k in range(count)]
    heads = pick(grid.up, columns)
    lines = [f"| {across[0]} | " + " | ".join(f"{up[0]} {u / up[1]:.3g}" for u in heads) + " |", "|---" * (columns + 1) + "|"]
    for a in pick(grid.across, rows):
        lines.append(f"| {a / across[1]:.4g} | " + " | ".join(cell(grid.at.get((a, u))) for u in heads) + " |")
    return "\n".join(lines)


def cell(row):
    if row is None:
        return ""
    if row["status"] not in ("done", "not_settled"):
        return {"no_contact": "no contact", "collapsed_at_rest": "not open", "collapsed_onto_electrode": "onto the electrode"}.get(row["status"], row["status"])
    rebounds = f"{row[N_B]:.0f}, {row[B_H] * 1e9:.3g}" if isinstance(row[N_B], float) and isinstance(row[B_H], float) else "-"
    return rebounds + (" *" if row["settled"] != 1 else "")


def main():
    program, casimir_store, dimple_store, results = sys.argv[1], sys.argv[2], sys.argv[3], pathlib.Path(sys.argv[4])
    casimir = Grid(rows_of(program, casimir_store), "structure_length_m", "gap_contact_m")
    dimple = Grid(rows_of(program, dimple_store), "electrode_main_span_2_m", "gap_contact_m")
    boxes = [(84 + (k % 2) * 470, 150 + (k // 2) * 440, 444 + (k % 2) * 470, 440 + (k // 2) * 440) for k in range(4)]
    length = (4.75, 5.25, (4.8, 4.9, 5.0, 5.1, 5.2), "length [µm]")
    contact = (10, 42, (10, 20, 30, 40), "contact gap [nm] of 50 nm")
    end = (140, 238, (150, 175, 200, 225), "end of the electrode [µm]")
    rest = (0.9, 3, (1, 1.5, 2, 2.5, 3), "contact gap [µm]: below the dimple")
    parts = heat_map(casimir.values(N_B, 1), (5, 10, 15, 20, 25, 30, 40, 50, 60), "", "Casimir switch: rebounds above 0.1 nm", boxes[0], length,
                     contact, "does not close, does not stand open, or falls onto the electrode")
    parts += heat_map(casimir.values(B_H, 1e-9), (0.5, 1, 1.5, 2, 2.5, 3, 4, 5, 7), "nm", "Casimir switch: highest rebound", boxes[1], length, contact, "")
    parts += heat_map(dimple.values(B_H, 1e-9), (50, 100, 200, 300, 400, 500, 700, 900, 1200), "nm", "Gold cantilever: highest rebound", boxes[2], end, rest,
                      "no contact")
    parts += heat_map(dimple.values(V_I, 1e-3), (30, 40, 50, 60, 70, 80, 90, 100, 120), "mm/s", "Gold cantilever: impact velocity", boxes[3], end, rest, "")
    (results / "published-maps.svg").write_text(drawing(1000, 1040, ["Bounces over the size of a switch and its gaps"], [
        f"Casimir force grown from 1 to 1.25 at once, gap of 50 nm: {len(casimir.rows)} closings. Step of 1.25 V_dp of each design: {len(dimple.rows)} closings.",
        "A dimple as high as the gap less the contact gap; an electrode that begins at 60 µm and ends up to 12 µm before the tip."], parts),
                                                encoding="utf-8")
    (results / "published-maps.md").write_text(f"""# Maps after published explorations

Two explorations of the kind that the literature shows, with `softland explore`, on reconstructed switches: how the switch that the Casimir force closes bounces over its length and
its contact gap, and what a longer electrode and a higher dimple do to the bounces of an electrostatic cantilever (as Kim studied for contact switches in 2011). The devices of those publications
are not known here, so that these are pictures of the same questions and not of the same answers.

- made by `bench/run_published_maps.py PROGRAM CASIMIR DIMPLE results` from the two stores of `softland explore` whose commands stand in it, {datetime.date.today()}, revision {revision()}
- machine: {machine()}
- Casimir: {len(casimir.rows)} points: {casimir.counts()}. Dimple: {len(dimple.rows)} points: {dimple.counts()}.

![Heat maps](published-maps.svg)

## The Casimir switch

`scenes/nem-casimir.toml`: a gap of 50 nm, the force grown from 1 to 1.25 at t = 0. The beam must be long enough to be lost at 1.25 and short enough to stand at 1: a band of a few per cent of the length, which is all that closes.
Where the contact gap nears the gap, the beam comes within 0.5 nm of the counter electrode before the contact holds it (`collapsed_onto_electrode`), and beams that are too long do not stand open (`collapsed_at_rest`).
Number of rebounds and highest rebound [nm]; an asterisk: not settled in the window.

{table(casimir, 6, 9, cell, ("length [µm]", 1e-6), ("contact gap [nm]", 1e-9))}

## Electrode and dimple of the gold cantilever

`scenes/mem-gold.toml` with its electrode from 60 µm to another end, and another contact gap: a dimple of 3.5 µm less this. A step of 1.25 V_dp of each design's own pull-in voltage.
Number of rebounds and highest rebound [nm]; an asterisk: not settled in the window.

{table(dimple, 6, 8, cell, ("end of the electrode [µm]", 1e-6), ("contact gap [µm]", 1e-6))}
""", encoding="utf-8")


if __name__ == "__main__":
    main()
