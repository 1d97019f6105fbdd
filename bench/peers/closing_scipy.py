#!/usr/bin/python3
"""One closing of a cantilever switch with NumPy and SciPy.

A yardstick for speed and an independent referee for waveforms found.

The same equations as softland, written independently as a textbook would:
exact modes of a uniform cantilever (of a stepped one, with --pzt, by cubic
Hermite elements), Galerkin projection on Gauss panels, Meijs-Fokkema fringing,
strip squeeze film over the whole length, asperities of uniform height under
the centre of the pad. Nothing is restarted at contact: the force law has two
continuous derivatives there, and LSODA finds its own way, as most users would
let it.

    closing_scipy.py                                  the reference closing
    closing_scipy.py --pzt --breakpoints best.csv     confirm a waveform
    closing_scipy.py --device gap=3.6e-6 thickness=2.1e-6

Prints JSON in SI units. A device given with --device is described by the
fields of Device below. Everything is deterministic but the wall times.
"""
import argparse
import csv
import dataclasses
import json
import statistics
import sys
import time

import numpy as np
from scipy.integrate import odeint, solve_ivp
from scipy.linalg import eigh
from scipy.optimize import brentq

EPS0 = 8.8541878128e-12  # [F/m]


@dataclasses.dataclass
class Device:
    """Gold cantilever of scenes/mem-gold.toml; SI units."""

    length: float = 250e-6
    width: float = 20e-6
    thickness: float = 2e-6
    youngs_modulus: float = 78e9
    density: float = 19300.0
    gap: float = 3.5e-6            # beam to electrode
    contact_gap: float = 2e-6      # tip to contact
    electrode_begin: float = 60e-6
    electrode_end: float = 240e-6
    viscosity: float = 1.86e-5
    pad_length: float = 5e-6
    asperity_radius: float = 100e-9
    asperity_density: float = 1e11
    asperity_height: float = 100e-9
    effective_modulus: float = 48e9
    # The layer of scenes/mem-gold-pzt.toml; present with --pzt only.
    piezo_begin: float = 5e-6
    piezo_end: float = 240e-6
    piezo_thickness: float = 1e-6
    piezo_modulus: float = 61e9
    piezo_density: float = 7750.0
    piezo_d31: float = -171e-12

    @property
    def contact_position(self):
        return self.length - self.pad_length / 2


class UniformModes:
    """Mass-normalised modes of a uniform cantilever in closed form."""

    def __init__(self, device, count):
        area = device.width * device.thickness
        mu = device.density * area
        rigidity = device.youngs_modulus * area * device.thickness**2 / 12
        self.length = device.length
        # Roots of 1 + cos(b) cosh(b) = 0, divided by cosh to stay O(1).
        self.beta = np.array([
            brentq(lambda b: np.cos(b) + 1 / np.cosh(b),
                   (k + 0.1) * np.pi, (k + 0.9) * np.pi, xtol=1e-14)
            for k in range(count)])
        self.omega = (self.beta / self.length)**2 * np.sqrt(rigidity / mu)
        self.scale = 1 / np.sqrt(mu * self.length)

    def shape(self, x):
        """phi_i(x) [kg^(-1/2)], one row per position, positive at the tip."""
        b = self.beta
        ratio = (np.cos(b) + np.cosh(b)) / (np.sin(b) + np.sinh(b))
        z = np.multiply.outer(np.atleast_1d(x) / self.length, b)
        phi = np.cosh(z) - np.cos(z) - ratio * (np.sinh(z) - np.sin(z))
        return self.scale * phi * np.where(np.arange(b.size) % 2, -1.0, 1.0)


class LayeredModes:
    """Modes of a cantilever with a piezo layer, by cubic Hermite elements.

    About eighty elements: many more, or very short ones at the root, lose the
    low modes to round-off.
    """

    def __init__(self, device, count, elements=80):
        d = device
        corners = [0.0, d.piezo_begin, d.piezo_end, d.length]
        nodes = [0.0]
        for begin, end in zip(corners, corners[1:]):
            pieces = max(1, round((end - begin) / d.length * elements))
            nodes += list(np.linspace(begin, end, pieces + 1)[1:])
        self.nodes = np.array(nodes)
        self.length = d.length

        bare_area = d.width * d.thickness
        ep_bp = d.piezo_modulus * d.piezo_thickness
        eb_b = d.youngs_modulus * d.thickness
        # Neutral axis from the free face of the layer.
        axis = ((ep_bp * d.piezo_thickness / 2
                 + eb_b * (d.piezo_thickness + d.thickness / 2))
                / (ep_bp + eb_b))
        bare = eb_b * d.width * d.thickness**2 / 12
        layered = (bare + ep_bp * d.width * d.piezo_thickness**2 / 12
                   + ep_bp * d.width * (axis - d.piezo_thickness / 2)**2
                   + eb_b * d.width
                   * (d.piezo_thickness + d.thickness / 2 - axis)**2)
        bare_mass = d.density * bare_area
        layered_mass = (bare_mass
                        + d.piezo_density * d.width * d.piezo_thickness)
        self.moment_per_volt = (d.piezo_d31 * d.piezo_modulus * d.width
                                * (axis - d.piezo_thickness / 2))

        # Lengths in units of L, rigidity and mass in those of the bare beam.
        size = 2 * self.nodes.size
        stiffness, mass = np.zeros((size, size)), np.zeros((size, size))
        for k, (x0, x1) in enumerate(zip(self.nodes, self.nodes[1:])):
            h = (x1 - x0) / d.length
            on_layer = d.piezo_begin < (x0 + x1) / 2 < d.piezo_end
            ei = layered / bare if on_layer else 1.0
            mu = layered_mass / bare_mass if on_layer else 1.0
            s = slice(2 * k, 2 * k + 4)
            stiffness[s, s] += ei / h**3 * np.array([
                [12, 6 * h, -12, 6 * h],
                [6 * h, 4 * h * h, -6 * h, 2 * h * h],
                [-12, -6 * h, 12, -6 * h],
                [6 * h, 2 * h * h, -6 * h, 4 * h * h]])
            mass[s, s] += mu * h / 420 * np.array([
                [156, 22 * h, 54, -13 * h],
                [22 * h, 4 * h * h, 13 * h, -3 * h * h],
                [54, 13 * h, 156, -22 * h],
                [-13 * h, -3 * h * h, -22 * h, 4 * h * h]])
        values, vectors = eigh(stiffness[2:, 2:], mass[2:, 2:],
                               subset_by_index=[0, count - 1])
        self.omega = np.sqrt(values * bare / (bare_mass * d.length**4))
        scale = 1 / np.sqrt(bare_mass * d.length)
        unknowns = np.vstack([np.zeros((2, count)), vectors]) * scale
        self.unknowns = unknowns * np.sign(unknowns[-2])

    def shape(self, x):
        return self._hermite(x, lambda s, h: (
            1 - 3 * s**2 + 2 * s**3, h * s * (1 - s)**2,
            s**2 * (3 - 2 * s), h * s**2 * (s - 1)))

    def slope(self, x):
        """phi_i'(x) [kg^(-1/2)/m]"""
        return self._hermite(x, lambda s, h: (
            6 * s * (s - 1) / h, (1 - s) * (1 - 3 * s),
            6 * s * (1 - s) / h, s * (3 * s - 2))) / self.length

    def _hermite(self, x, functions):
        x = np.atleast_1d(x)
        k = np.clip(np.searchsorted(self.nodes, x) - 1, 0,
                    self.nodes.size - 2)
        h = (self.nodes[k + 1] - self.nodes[k]) / self.length
        s = (x - self.nodes[k]) / (self.nodes[k + 1] - self.nodes[k])
        return sum(f[:, None] * self.unknowns[2 * k + j]
                   for j, f in enumerate(functions(s, h)))


class Closing:
    """Right-hand side of y = (q, q') for one drive."""

    def __init__(self, device, modes, points_per_length=24, pzt=False):
        d = self.device = device
        beam = (LayeredModes if pzt else UniformModes)(d, modes)
        self.modes = modes
        self.omega = beam.omega
        self.squares = beam.omega**2
        corners = {0.0, d.electrode_begin, d.electrode_end,
                   d.length - d.pad_length, d.length}
        self.piezo_shape = np.zeros(modes)
        if pzt:
            corners |= {d.piezo_begin, d.piezo_end}
            ends = beam.slope([d.piezo_begin, d.piezo_end])
            self.piezo_shape = beam.moment_per_volt * (ends[1] - ends[0])
        corners = sorted(corners)
        x, weights = [], []
        for begin, end in zip(corners, corners[1:]):
            order = max(3, int(np.ceil(
                (end - begin) / d.length * points_per_length - 1e-9)))
            s, w = np.polynomial.legendre.leggauss(order)
            x.append(begin + (end - begin) * (1 + s) / 2)
            weights.append(w * (end - begin) / 2)
        x, weights = np.concatenate(x), np.concatenate(weights)
        self.points = x.size
        self.shapes = np.ascontiguousarray(beam.shape(x))
        self.projection = np.ascontiguousarray((self.shapes
                                                * weights[:, None]).T)
        self.contact_shape = beam.shape(d.contact_position)[0]
        over = np.flatnonzero((x > d.electrode_begin) & (x < d.electrode_end))
        self.electrode = slice(over[0], over[-1] + 1)
        self.force = EPS0 * d.width / 2
        self.side = 0.265 / d.width**0.75
        self.face = 0.53 * d.thickness**0.5 / d.width
        self.film = d.viscosity * d.width**3
        self.asperities = (8 / 15 * d.asperity_density * d.width * d.pad_length
                           * d.effective_modulus * d.asperity_radius**0.5
                           / d.asperity_height)
        self.evaluations = 0
        self.set_drive(0.0, (0.0, 0.0), (0.0, 0.0))

    def set_drive(self, begin, main, piezo):
        """V(t) = value + slope (t - begin) on both drives from now on."""
        self.begin, self.main, self.piezo = begin, main, piezo

    def __call__(self, t, y):
        n, d = self.modes, self.device
        self.evaluations += 1
        q, v = y[:n], y[n:]
        gap = d.gap - self.shapes @ q
        load = self.shapes @ v
        load *= -self.film
        load /= gap * gap * gap
        elapsed = t - self.begin
        volts = self.main[0] + self.main[1] * elapsed
        if volts != 0.0:
            h = gap[self.electrode]
            root = np.sqrt(h)
            fringing = 1 + root * (self.side * np.sqrt(root) + self.face)
            load[self.electrode] += (self.force * volts * volts) \
                * fringing / (h * h)
        result = np.empty(2 * n)
        result[:n] = v
        acceleration = self.projection @ load
        acceleration -= self.squares * q
        volts = self.piezo[0] + self.piezo[1] * elapsed
        if volts != 0.0:
            acceleration += volts * self.piezo_shape
        depth = float(self.contact_shape @ q) - d.contact_gap
        if depth > 0.0:
            force = depth**2.5
            if depth > d.asperity_height:
                force -= (depth - d.asperity_height)**2.5
            acceleration -= (self.asperities * force) * self.contact_shape
        result[n:] = acceleration
        return result


def step_drive(level):
    """Breakpoints of a step without rise time."""
    return {"time_s": [0.0], "main": [level], "piezo": [0.0]}


def read_drive(path):
    """Breakpoints of a CSV with time_s and a column per drive."""
    with open(path, newline="", encoding="utf-8-sig") as file:
        lines = [line for line in file
                 if line.strip() and not line.lstrip().startswith("#")]
    rows = list(csv.DictReader(lines, skipinitialspace=True))
    if not rows or "time_s" not in rows[0]:
        raise ValueError(f"{path}: needs a column time_s and a row")
    drives = {name.strip() for name in rows[0]} - {"time_s"}
    if not drives or not drives <= {"main", "piezo"}:
        raise ValueError(f"{path}: the drives are main and piezo")
    rows = [{key.strip(): float(value) for key, value in row.items()}
            for row in rows]
    times = [row["time_s"] for row in rows]
    if times[0] != 0 or any(a > b for a, b in zip(times, times[1:])):
        raise ValueError(f"{path}: time_s must start at 0 and not decrease")
    return {"time_s": times,
            "main": [row.get("main", 0.0) for row in rows],
            "piezo": [row.get("piezo", 0.0) for row in rows]}


def stretches(drive, window):
    """(begin, end, main, piezo) of every linear piece inside the window.

    Two rows of one time are a jump; the last value holds for ever.
    """
    times = drive["time_s"]
    pieces = []
    for k, begin in enumerate(times):
        last = k + 1 == len(times)
        end = window if last else min(times[k + 1], window)
        if end <= begin:
            continue
        lines = []
        for name in ("main", "piezo"):
            values = drive[name]
            slope = 0.0 if last else ((values[k + 1] - values[k])
                                      / (times[k + 1] - begin))
            lines.append((values[k], slope))
        pieces.append((begin, end, *lines))
    return pieces


def absolute_tolerances(closing, rtol):
    """Per unknown, as the deflection (velocity) it causes at the contact.

    The beam travels micrometres and penetrates nanometres, so an atol of
    rtol times the travel would leave nothing of the contact force: rtol times
    10 nm, the depth of a hard first touch, is the absolute scale. Velocities
    count with the frequency of their mode. A mode that hardly moves the
    contact point counts as if it moved it by a tenth of the others.
    """
    amplitude = np.abs(closing.contact_shape)
    amplitude = np.maximum(amplitude, amplitude.max() / 10)
    coordinate = rtol * 10e-9 / amplitude
    return np.concatenate([coordinate, coordinate * closing.omega])


def integrate(closing, drive, window, method, rtol, grid):
    """Times and states on a grid that holds every breakpoint."""
    atol = absolute_tolerances(closing, rtol)
    y = np.zeros(2 * closing.modes)
    times, states = [], []
    for begin, end, main, piezo in stretches(drive, window):
        closing.set_drive(begin, main, piezo)
        t = np.linspace(begin, end, max(2, int(np.ceil((end - begin) / grid))
                                        + 1))
        if method == "odeint":
            out, info = odeint(closing, y, t, tfirst=True, rtol=rtol,
                               atol=atol, tcrit=[end], mxstep=1000000,
                               full_output=True)
            if info["message"] != "Integration successful.":
                raise RuntimeError(info["message"])
        else:
            solution = solve_ivp(closing, (begin, end), y, method=method,
                                 t_eval=t, rtol=rtol, atol=atol)
            if not solution.success:
                raise RuntimeError(solution.message)
            out = solution.y.T
        times.append(t)
        states.append(out)
        y = out[-1]
    return np.concatenate(times), np.vstack(states)


def extremum(t0, t1, p0, p1, v0, v1):
    """Smallest value of the cubic Hermite interpolant on [t0, t1].

    Position p and velocity v are both part of the state, so the record is
    read with fourth-order interpolation at no further evaluation.
    """
    h = t1 - t0
    a = np.array([2 * (p0 - p1) + h * (v0 + v1),
                  3 * (p1 - p0) - h * (2 * v0 + v1), h * v0, p0])
    inside = [s.real for s in np.roots(np.polyder(a))
              if abs(s.imag) < 1e-12 and 0 < s.real < 1]
    return min(p0, p1, *(np.polyval(a, s) for s in inside))


def crossing(t0, t1, p0, p1, v0, v1):
    """(time, velocity) at the zero of the cubic Hermite interpolant."""
    h = t1 - t0
    a = np.array([2 * (p0 - p1) + h * (v0 + v1),
                  3 * (p1 - p0) - h * (2 * v0 + v1), h * v0, p0])
    s = brentq(lambda z: np.polyval(a, z), 0.0, 1.0, xtol=1e-13)
    return t0 + s * h, float(np.polyval(np.polyder(a), s) / h)


def figures(closing, times, states, significant):
    """t_i, v_i, rebounds, N_B, t_p and B_H from a dense record."""
    n = closing.modes
    height = closing.device.contact_gap - states[:, :n] @ closing.contact_shape
    speed = -(states[:, n:] @ closing.contact_shape)
    if not np.all(np.isfinite(height)):
        raise RuntimeError("the motion is no longer finite")
    changes = np.flatnonzero((height[:-1] > 0) != (height[1:] > 0))
    result = {"status": "no_contact", "initial_contact_time_s": None,
              "impact_velocity_m_s": None, "major_bounce_height_m": None,
              "bounce_count": None, "permanent_contact_time_s": None,
              "smallest_gap_m": closing.device.gap - float(
                  np.max(states[:, :n] @ closing.shapes.T)),
              "rebounds": []}
    if changes.size == 0:
        return result

    def at(k):
        return crossing(times[k], times[k + 1], height[k], height[k + 1],
                        speed[k], speed[k + 1])

    t_i, velocity = at(changes[0])
    rebounds = []
    for out in range(1, changes.size, 2):
        first = changes[out]
        open_end = out + 1 == changes.size
        last = times.size - 2 if open_end else changes[out + 1]
        # The extreme lies next to the highest grid point. Grid points come
        # in pairs of equal time where two stretches meet.
        top = first + int(np.argmax(height[first:last + 2]))
        highest = max(
            -extremum(times[k], times[k + 1], -height[k], -height[k + 1],
                      -speed[k], -speed[k + 1])
            for k in (top - 1, top)
            if 0 <= k < times.size - 1 and times[k + 1] > times[k])
        rebounds.append({"begin_s": at(first)[0],
                         "end_s": None if open_end else at(last)[0],
                         "height_m": float(highest)})
    counted = [r for r in rebounds if r["height_m"] > significant]
    t_p = counted[-1]["end_s"] if counted else t_i
    result.update(
        status="done" if t_p is not None else "not_settled",
        initial_contact_time_s=t_i, impact_velocity_m_s=abs(velocity),
        major_bounce_height_m=max((r["height_m"] for r in rebounds),
                                  default=0.0),
        bounce_count=len(counted), permanent_contact_time_s=t_p,
        rebounds=counted[:20])
    return result


def arguments():
    parser = argparse.ArgumentParser(
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--method", default="odeint",
                        choices=["odeint", "LSODA", "BDF", "Radau", "DOP853",
                                 "RK45"],
                        help="odeint is LSODA without the Python steps of "
                             "solve_ivp, which runs the others")
    parser.add_argument("--rtol", type=float, default=1e-6)
    parser.add_argument("--window", type=float, default=100e-6, help="[s]")
    parser.add_argument("--level", type=float,
                        help="step [V]; 17.771 or, with --pzt, 28.087")
    parser.add_argument("--breakpoints", metavar="FILE.csv",
                        help="drive: time_s, main and, with --pzt, piezo")
    parser.add_argument("--pzt", action="store_true",
                        help="the switch with the piezo layer")
    parser.add_argument("--modes", type=int, default=4)
    parser.add_argument("--device", nargs="+", default=[],
                        metavar="key=value", help="changes, in SI units")
    parser.add_argument("--grid", type=float, default=10e-9,
                        help="spacing of the record the figures are read "
                             "from [s]")
    parser.add_argument("--significant", type=float, default=1e-9,
                        help="rebounds up to this height do not count [m]")
    parser.add_argument("--runs", type=int, default=1,
                        help="closings to time; the median is given")
    options = parser.parse_args()
    if options.level is None:
        options.level = 28.087 if options.pzt else 17.771
    changes = {}
    known = {field.name for field in dataclasses.fields(Device)}
    for assignment in options.device:
        key, _, value = assignment.partition("=")
        if key not in known:
            parser.error(f"--device {key}: one of {', '.join(sorted(known))}")
        changes[key] = float(value)
    return options, Device(**changes)


def main():
    options, device = arguments()
    closing = Closing(device, options.modes, pzt=options.pzt)
    try:
        drive = (read_drive(options.breakpoints) if options.breakpoints
                 else step_drive(options.level))
        if any(drive["piezo"]) and not options.pzt:
            raise ValueError("a piezo drive needs --pzt")
    except (OSError, TypeError, ValueError) as error:
        print(f"closing_scipy.py: {error}", file=sys.stderr)
        return 2
    wall = []
    try:
        for _ in range(max(1, options.runs)):
            closing.evaluations = 0
            start = time.perf_counter()
            times, states = integrate(closing, drive, options.window,
                                      options.method, options.rtol,
                                      options.grid)
            wall.append(time.perf_counter() - start)
        result = figures(closing, times, states, options.significant)
    except RuntimeError as error:
        print(json.dumps({"status": "numerical_failure",
                          "message": str(error)}, indent=2))
        return 3

    evaluations = closing.evaluations
    # Evenly spaced states of the run itself, away from LSODA's overhead.
    sample = states[::max(1, len(states) // 2000)]
    start = time.perf_counter()
    for y in sample:
        closing(times[-1], y)
    per_rhs = (time.perf_counter() - start) / len(sample)
    result.update(
        natural_frequencies_rad_s=[float(w) for w in closing.omega],
        rhs_evaluations=evaluations,
        wall_s=statistics.median(wall),
        wall_per_rhs_s=per_rhs,
        runs=len(wall), method=options.method, rtol=options.rtol,
        window_s=options.window, quadrature_points=closing.points,
        modes=options.modes, device=dataclasses.asdict(device))
    print(json.dumps(result, indent=2))
    return 0


if __name__ == "__main__":
    sys.exit(main())
