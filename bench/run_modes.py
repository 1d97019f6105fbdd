#!/usr/bin/env python3
"""run_modes.py PROGRAM FOLDER [ROM] prints results/modes.md, and writes intermediate files into FOLDER.

Compares meshes of the beam of scenes/mem-gold.toml, by CalculiX (ccx) and softland modes, with the beam itself, and, if ROM is given,
the public reduced-order model cbeam_full_2el.rom of an ANSYS cantilever.
"""
import itertools
import json
import pathlib
import random
import subprocess
import sys

LENGTH, WIDTH, THICKNESS = 250e-6, 20e-6, 2e-6
ROOT = pathlib.Path(__file__).resolve().parents[1]
FIGURES = ("initial_contact_time_s", "impact_velocity_m_s", "major_bounce_height_m", "peak_contact_force_N")


class Mesh:
    """A mesh: nodes by their positions on a grid, and elements as lists of node numbers."""

    def __init__(self, kind):
        self.kind, self.nodes, self.numbers, self.elements = kind, [], {}, []

    def node(self, key, place):
        if key not in self.numbers:
            self.nodes.append(place() if callable(place) else place)
            self.numbers[key] = len(self.nodes)
        return self.numbers[key]

    def text(self):
        def rows(entries):
            return "\n".join(entries) + "\n"

        def element(number, nodes):
            return f"{number}," + ",".join(map(str, nodes[:15])) + ("," + "\n" + ",".join(map(str, nodes[15:])) if len(nodes) > 15 else "")

        return ("*NODE, NSET=ALL\n" + rows(f"{n},{x:.9e},{y:.9e},{z:.9e}" for n, (x, y, z) in enumerate(self.nodes, 1)) +
                f"*ELEMENT, TYPE={self.kind}, ELSET=E\n" + rows(element(n, e) for n, e in enumerate(self.elements, 1)) +
                "*NSET, NSET=FIX\n" + rows(f"{n}," for n, p in enumerate(self.nodes, 1) if p[0] == 0) +
                "*MATERIAL, NAME=AU\n*ELASTIC\n78e9,0\n*DENSITY\n19300.\n*SOLID SECTION, ELSET=E, MATERIAL=AU\n*BOUNDARY\nFIX,1,3\n"
                "*STEP\n*FREQUENCY\n8\n*NODE FILE\nU\n*END STEP\n")


def bricks():
    """Returns a mesh of bricks with 20 nodes, in layers across the axis."""
    nx, ny, nz = 50, 4, 2
    mesh = Mesh("C3D20R")
    corners = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2), (1, 0, 0), (2, 1, 0),
               (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2), (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]
    for i, j, k in itertools.product(range(nx), range(ny), range(nz)):
        keys = [(2 * i + p, 2 * j + q, 2 * k + r) for p, q, r in corners]
        mesh.elements.append([mesh.node(key, (LENGTH * key[0] / (2 * nx), WIDTH * (key[1] / (2 * ny) - 0.5),
                                              THICKNESS * (key[2] / (2 * nz) - 0.5))) for key in keys])
    return mesh


def tetrahedra():
    """Returns a mesh of tetrahedra with 10 nodes, whose inner corners are moved at random, so that it has no layers."""
    nx, ny, nz = 60, 5, 1
    dice = random.Random(1)
    mesh = Mesh("C3D10")

    def corner(i, j, k):
        x = LENGTH / nx * (i + (dice.uniform(-0.3, 0.3) if 0 < i < nx else 0))
        y = WIDTH * ((j + (dice.uniform(-0.25, 0.25) if 0 < j < ny else 0)) / ny - 0.5)
        return x, y, THICKNESS * (k / nz - 0.5)

    def middle(a, b):
        return mesh.node((min(a, b), max(a, b)), tuple((p + q) / 2 for p, q in zip(mesh.nodes[a - 1], mesh.nodes[b - 1])))

    for i, j, k in itertools.product(range(nx), range(ny), range(nz)):
        for order in itertools.permutations(range(3)):  # Kuhn's six tetrahedra of a brick
            at = [i, j, k]
            nodes = [mesh.node(tuple(at), lambda at=tuple(at): corner(*at))]
            for direction in order:
                at[direction] += 1
                nodes.append(mesh.node(tuple(at), lambda at=tuple(at): corner(*at)))
            if order in ((0, 2, 1), (1, 0, 2), (2, 1, 0)):
                nodes[1], nodes[2] = nodes[2], nodes[1]  # odd permutations have the wrong orientation
            a, b, c, d = nodes
            mesh.elements.append(nodes + [middle(a, b), middle(b, c), middle(a, c), middle(a, d), middle(b, d), middle(c, d)])
    return mesh


def run(*words, cwd=None):
    done = subprocess.run([*map(str, words)], cwd=cwd, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{words}: {done.stderr}")
    return done.stdout


def closing(program, scene, *options):
    metrics = json.loads(run(program, "simulate", scene, *options, "--quiet", "--json", "-"))["metrics"]
    return [metrics[figure] for figure in FIGURES]


def mesh_rows(program, folder, name, mesh):
    (folder / f"{name}.inp").write_text(mesh.text(), encoding="utf-8")
    run("ccx", name, cwd=folder)
    table = folder / f"{name}.csv"
    said = json.loads(run(program, "modes", "--from", folder / f"{name}.frd", "--axis", "x", "--direction", "-z", "--out", table, "--plot",
                          folder / f"{name}.svg", "--json", "-"))
    scene = (ROOT / "scenes/mem-gold-modes.toml").read_text(encoding="utf-8").replace("mem-gold-modes.csv", table.name)
    (folder / f"{name}.toml").write_text(scene, encoding="utf-8")
    left_out = [m["kind"] for m in said["modes"] if m["taken_as"] is None]
    print(f"\n## {said['nodes']} nodes of {mesh.kind}\n")
    print(f"{len(said['natural_frequencies_rad_s'])} modes are taken, {len(left_out)} left out ({', '.join(left_out)}).\n")
    print("| modes | t_i | v_i | B_H | peak force |\n|---|---|---|---|---|")
    compare(program, folder / f"{name}.toml", len(said["natural_frequencies_rad_s"]))


def compare(program, scene, most):
    for modes in range(1, most + 1):
        chosen = ("--set", f"structure.modes={modes}")
        pairs = zip(closing(program, scene, *chosen), closing(program, ROOT / "scenes/mem-gold.toml", *chosen))
        print(f"| {modes} | " + " | ".join(f"{abs(a / b - 1):.1e}" for a, b in pairs) + " |")


ROM_SCENE = """[structure]
kind = "modes"
file = "rom.csv"
width = "20 um"
thickness = "2 um"
[gap]
electrode = "4 um"
contact = "2 um"
[electrode.main]
span = ["0 um", "100 um"]
[waveform.main]
family = "step"
level = "300 V"
"""
BEAM = """kind = "cantilever"
length = "100 um"
youngs_modulus = "169 GPa"
density = "2329 kg/m^3"
modes = 2
"""


def rom_rows(program, folder, rom):
    run(program, "modes", "--from", rom, "--axis", "x", "--direction", "-z", "--length-unit", "um", "--clamp", "0 um", "--mass", "9.316 ng",
        "--out", folder / "rom.csv")
    (folder / "rom.toml").write_text(ROM_SCENE, encoding="utf-8")
    (folder / "beam.toml").write_text(ROM_SCENE.replace('kind = "modes"\nfile = "rom.csv"\n', BEAM), encoding="utf-8")
    print("\n## The cantilever of the ANSYS ROM tool\n")
    print("| | f_1 | static pull-in |\n|---|---|---|\n| ANSYS, as published with the model (linear) | 275.44 kHz | 157 V |")
    for what, scene in (("its modes at two nodes and the clamp", "rom.toml"), ("a cantilever of its sizes", "beam.toml")):
        frequency = json.loads(run(program, "modes", folder / scene, "--json", "-"))["natural_frequencies_rad_s"][0] / 6.283185307179586
        voltage = json.loads(run(program, "pull-in", folder / scene, "--quiet", "--json", "-"))["pull_in"]
        voltage = voltage.get("main", voltage)["static_V"]
        print(f"| {what} | {frequency / 1e3:.2f} kHz ({frequency / 275444.7 - 1:+.2%}) | {voltage:.2f} V ({voltage / 157 - 1:+.2%}) |")


def main():
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    print("## The table of scenes/mem-gold-modes.toml\n\nClosed-form modes at 101 places.\n")
    print("| modes | t_i | v_i | B_H | peak force |\n|---|---|---|---|---|")
    compare(program, ROOT / "scenes/mem-gold-modes.toml", 6)
    mesh_rows(program, folder, "bricks", bricks())
    mesh_rows(program, folder, "tetrahedra", tetrahedra())
    if len(sys.argv) > 3:
        rom_rows(program, folder, pathlib.Path(sys.argv[3]).resolve())


main()
