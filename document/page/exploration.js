// Draws an exploration: maps over two variables, the Pareto front, parallel coordinates, a scatter matrix and the effect of each variable.
(() => {
  "use strict";
  const {noBreak, prefix, minus, quantity, tickText, colour, font, makeCards} = softland;
  const data = JSON.parse(document.getElementById("data").textContent);
  const rows = data.rows;
  const letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const digit = new Uint8Array(128);
  [...letters].forEach((letter, i) => (digit[letter.charCodeAt(0)] = i));
  const pair = (text, i) => 64 * digit[text.charCodeAt(2 * i)] + digit[text.charCodeAt(2 * i + 1)];

  // Each value of a column is two letters: a number of steps from `low`, on a logarithmic scale if `log` is set.
  const columns = data.columns.map((about, index) => {
    const value = (steps) => (about.log ? Math.exp(about.low + steps * about.step) : about.low + steps * about.step);
    const values = new Float64Array(rows).fill(about.known && !about.data ? value(0) : NaN);
    if (about.data) {
      for (let i = 0; i < rows; ++i) {
        const steps = pair(about.data, i);
        values[i] = steps === 4095 ? NaN : value(steps);
      }
    }
    delete about.data;
    const known = values.filter((v) => !Number.isNaN(v));
    const [low, high] = known.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [Infinity, -Infinity]);
    return {...about, index, values, low, high, varies: high > low};
  });
  const deltas = (list) => {
    let sum = 0;
    return list.map((step) => (sum += step));
  };
  const numbers = data.numbers ? deltas(data.numbers) : null;
  const number = (row) => (numbers ? numbers[row] : row);
  const status = (row) => data.statuses[digit[data.status.charCodeAt(row)]].replaceAll("_", " ");
  const reason = (row) => (data.reasons ? data.reasons[pair(data.reason, row)] : "");

  const factorOf = (column, largest) => (column.unit && column.prefix ? prefix(largest) : [1, ""]);
  const words = (column, value, digits = 4) => {
    if (Number.isNaN(value)) return "—";
    if (column.unit && column.prefix) return quantity(value, column.unit, 0, digits);
    return minus(+value.toPrecision(digits)) + (column.unit ? noBreak + column.unit : "");
  };
  const named = (column, largest) => column.name + (column.unit ? ` (${factorOf(column, largest)[1]}${column.unit})` : "");
  const element = (name, properties = {}, ...children) => {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children);
    return made;
  };

  // An axis maps data to pixels and has round numbers as ticks.
  const scale = (log, low, high, from, to) => {
    const t = log ? Math.log : (v) => v;
    if (!(high > low)) [low, high] = log ? [low / 1.5, high * 1.5] : [low - Math.abs(low || 1) / 10, high + Math.abs(high || 1) / 10];
    const a = t(low);
    const b = t(high);
    const at = (v) => from + ((t(v) - a) / (b - a)) * (to - from);
    at.back = (pixel) => {
      const part = a + ((pixel - from) / (to - from)) * (b - a);
      return log ? Math.exp(part) : part;
    };
    Object.assign(at, {log, low, high});
    return at;
  };
  const ticks = ({log, low, high}, wanted) => {
    const out = [];
    if (log && high / low > 30) {
      const last = Math.floor(Math.log10(high) + 1e-9);
      const every = Math.max(1, Math.ceil((Math.log10(high) - Math.log10(low)) / wanted));
      for (let e = Math.ceil(Math.log10(low) - 1e-9); e <= last; e += every) out.push(10 ** e);
      return out;
    }
    const raw = Number.isFinite(high - low) ? (high - low) / wanted : high / wanted - low / wanted;
    const decade = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].find((f) => f * decade >= raw * (1 - 1e-9)) * decade;
    const first = Math.ceil(low / step - 1e-9);
    if (!(step > 0 && Math.abs(first) < 2 ** 52)) return [low, high];  // no round number lies between the ends
    for (let k = 0; k <= 10 * wanted && (first + k) * step <= high + 1e-9 * step; ++k) out.push((first + k) * step);
    return out;
  };

  const viridis = [[68, 1, 84], [71, 45, 123], [59, 82, 139], [44, 114, 142], [33, 145, 140], [40, 174, 128], [94, 201, 98], [173, 220, 48], [253, 231, 37]];
  const shade = (part) => {
    const at = Math.min(1, Math.max(0, part)) * (viridis.length - 1);
    const k = Math.min(Math.floor(at), viridis.length - 2);
    return "rgb(" + viridis[k].map((c, i) => Math.round(c + (at - k) * (viridis[k + 1][i] - c))).join() + ")";
  };
  const shades = Array.from({length: 256}, (none, i) => shade(i / 255));
  // Returns the range of values that the colours cover. It omits the outer 2 % at each end if they make it more than three times as wide.
  const colourRange = (column, values) => {
    const known = values.filter((v) => !Number.isNaN(v)).sort();
    if (!known.length) return {low: 0, high: 1, log: false};
    const cut = Math.floor(known.length / 50);
    const [first, last, inner, outer] = [known[0], known[known.length - 1], known[cut], known[known.length - 1 - cut]];
    if (column.log && last > 30 * first) return {low: first, high: last, log: true};
    if (last - first > 3 * (outer - inner) && outer > inner) return {low: inner, high: outer, log: false, above: outer < last, below: inner > first};
    if (last > first) return {low: first, high: last, log: false};
    const half = first === 0 ? 1 : 0.05 * Math.abs(first);
    return {low: first - half, high: first + half, log: false};
  };
  const shadeOf = ({low, high, log}, value) => shades[Math.min(255, Math.max(0, Math.round((255 * (log ? Math.log(value / low) : value - low)) / (log ? Math.log(high / low) : high - low))))];

  // Makes a canvas with the resolution of the screen, which is drawn again when its size or the colours change.
  const canvases = [];
  const canvas = (holder, label, height, draw) => {
    const made = element("canvas", {tabIndex: 0});
    made.setAttribute("role", "img");
    made.setAttribute("aria-label", label);
    holder.append(made);
    const layer = document.createElement("canvas");
    const ctx = made.getContext("2d");
    const one = {
      canvas: made,
      width: 0,
      height: 0,
      redraw() {
        const ratio = devicePixelRatio || 1;
        one.width = holder.clientWidth;
        one.height = typeof height === "function" ? height(one.width) : height;
        made.style.height = one.height + "px";
        for (const c of [made, layer]) {
          c.width = Math.round(one.width * ratio);
          c.height = Math.round(one.height * ratio);
        }
        const base = layer.getContext("2d");
        base.setTransform(ratio, 0, 0, ratio, 0, 0);
        base.lineJoin = "round";
        draw(base, one);
        one.show();
      },
      // Shows the picture, and on top of it what `extra` draws: the parts that follow the pointer.
      show(extra) {
        const ratio = devicePixelRatio || 1;
        ctx.setTransform(1, 0, 0, 1, 0, 0);
        ctx.clearRect(0, 0, made.width, made.height);
        ctx.drawImage(layer, 0, 0);
        ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
        if (extra) extra(ctx);
      },
    };
    canvases.push(one);
    return one;
  };
  const at = (event, {canvas: c}) => {
    const box = c.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const write = (ctx, text, x, y, {align = "left", base = "alphabetic", fill = "muted", size = 12, halo = false} = {}) => {
    ctx.font = font(size);
    ctx.textAlign = align;
    ctx.textBaseline = base;
    if (halo) {
      ctx.strokeStyle = colour("paper");
      ctx.lineWidth = 3.5;
      ctx.strokeText(text, x, y);
    }
    ctx.fillStyle = colour(fill);
    ctx.fillText(text, x, y);
  };
  // Cuts a text to the room that there is.
  const fitted = (ctx, text, room, size = 12) => {
    ctx.font = font(size);
    if (ctx.measureText(text).width <= room) return text;
    let n = text.length;
    while (n > 1 && ctx.measureText(text.slice(0, n) + "…").width > room) --n;
    return text.slice(0, n) + "…";
  };
  const upright = (ctx, text, x, y, room) => {
    ctx.save();
    ctx.translate(x, y);
    ctx.rotate(-Math.PI / 2);
    write(ctx, fitted(ctx, text, room, 12.5), 0, 0, {align: "center", size: 12.5});
    ctx.restore();
  };
  const keys = (target, bound) => target.canvas.addEventListener("keydown", (event) => {
    const action = bound[event.key];
    if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
    action();
    event.preventDefault();
  });

  // The limits of columns select points; points outside are pale in every picture.
  const limits = new Map();  // index of a column -> [low, high]
  const inside = new Uint8Array(rows).fill(1);
  let insideCount = rows;
  const select = () => {
    inside.fill(1);
    for (const [index, [low, high]] of limits) {
      const {values} = columns[index];
      for (let i = 0; i < rows; ++i) if (!(values[i] >= low && values[i] <= high)) inside[i] = 0;
    }
    insideCount = inside.reduce((sum, one) => sum + one, 0);
  };
  // Returns at most about `most` of the rows that pass the test, each with the same probability; the choice is the same at every call.
  const chance = (row) => {
    let bits = Math.imul(row + 1, 0x9e3779b1);
    bits = Math.imul(bits ^ (bits >>> 15), 0x85ebca6b);
    return ((bits ^ (bits >>> 13)) >>> 0) / 2 ** 32;
  };
  const sample = (test, most) => {
    const all = [];
    for (let i = 0; i < rows; ++i) if (test(i)) all.push(i);
    return all.length <= most ? all : all.filter((row) => chance(row) < most / all.length);
  };

  const variables = columns.filter((c) => c.variable && c.varies);
  const figures = columns.filter((c) => !c.variable && c.varies);
  const describe = (row, list) => {
    const out = element("span");
    list.forEach((c, i) => out.append(element("span", {className: "word"}, c.name + " ", element("b", {}, words(c, c.values[row]))), i + 1 < list.length ? ", " : ""));
    return out;
  };
  const leading = columns[data.figure];
  const option = (c) => element("option", {value: c.index}, c.name);
  const chooser = (label, list, chosen, change) => {
    const select = element("select", {}, ...list.map(option));
    select.value = chosen.index;
    select.addEventListener("change", () => change(columns[select.value]));
    return element("label", {}, label, select);
  };
  const part = (id) => document.querySelector(`#${id} .part`);

  // --- Map -------------------------------------------------------------------------------------------------------------------
  const drawMaps = () => {
    const holder = part("map");
    if (!holder || !data.grid) return;
    const grid = data.grid;
    const dims = grid.variables.map((index, d) => ({column: columns[index], values: grid.values[d]}));
    const strides = dims.map((none, d) => dims.slice(d + 1).reduce((product, {values}) => product * values.length, 1));
    const rowAt = new Int32Array(dims.reduce((product, {values}) => product * values.length, 1)).fill(-1);
    if (grid.cells) deltas(grid.cells).forEach((cell, row) => cell >= 0 && (rowAt[cell] = row));
    else for (let row = 0; row < rows; ++row) rowAt[row] = row;

    let figure = leading.varies ? leading : figures[0] || leading;
    const order = dims.map((none, d) => d).sort((a, b) => dims[b].values.length - dims[a].values.length || a - b);
    let [xd, yd] = [Math.min(order[0], order[1]), Math.max(order[0], order[1])];
    const fixed = dims.map(({values}) => Math.floor(values.length / 2));
    let lines = true;
    let cursor = null;  // [i, j]

    const controls = element("div", {className: "controls"});
    const readout = element("p", {className: "readout"});
    readout.setAttribute("aria-live", "polite");
    const build = () => {
      controls.replaceChildren(chooser("Figure", figures.length ? figures : [figure], figure, (c) => { figure = c; refresh(); }));
      if (dims.length > 2) {
        const axis = (label, now, set) => chooser(label, dims.map(({column}) => column), dims[now].column, (c) => { set(dims.findIndex(({column}) => column === c)); build(); refresh(); });
        controls.append(axis("across", xd, (d) => { if (d === yd) yd = xd; xd = d; }), axis("up", yd, (d) => { if (d === xd) xd = yd; yd = d; }));
        dims.forEach(({column, values}, d) => {
          if (d === xd || d === yd) return;
          const value = element("output", {}, words(column, values[fixed[d]]));
          const slider = element("input", {type: "range", min: 0, max: values.length - 1, step: 1, value: fixed[d]});
          slider.addEventListener("input", () => {
            fixed[d] = +slider.value;
            value.textContent = words(column, values[fixed[d]]);
            refresh();
          });
          controls.append(element("label", {}, column.name, slider, value));
        });
      }
      const box = element("input", {type: "checkbox", checked: lines});
      box.addEventListener("change", () => { lines = box.checked; refresh(); });
      controls.append(element("label", {}, box, "contour lines"));
    };
    build();
    holder.append(controls);

    const rowOf = (i, j) => {
      let cell = 0;
      dims.forEach((none, d) => (cell += strides[d] * (d === xd ? i : d === yd ? j : fixed[d])));
      return rowAt[cell];
    };
    // Each value has a cell that reaches half-way to its neighbours. Values in equal ratios make the axis logarithmic.
    const cellsOf = (values, from, to) => {
      const n = values.length;
      const equalRatios = n > 2 && values[0] > 0 && values[n - 1] > 3 * values[0] && Math.abs(Math.log(values[1] / values[0]) - Math.log(values[n - 1] / values[0]) / (n - 1)) < (0.01 * Math.log(values[n - 1] / values[0])) / (n - 1);
      const between = (a, b) => (equalRatios ? Math.sqrt(a * b) : (a + b) / 2);
      const beyond = (inner, end) => (equalRatios ? end * Math.sqrt(end / inner) : end + (end - inner) / 2);
      const edges = [beyond(values[1], values[0]), ...values.slice(1).map((v, k) => between(values[k], v)), beyond(values[n - 2], values[n - 1])];
      const axis = scale(equalRatios, edges[0], edges[n], from, to);
      return {axis, edges: edges.map(axis), centre: (k) => {
        const low = Math.min(Math.floor(k), n - 1);
        const high = Math.min(low + 1, n - 1);
        return axis(values[low]) + (k - low) * (axis(values[high]) - axis(values[low]));
      }};
    };
    let shape = null;
    const compute = ({width, height}) => {
      const narrow = width < 560;
      const margin = {left: narrow ? 52 : 74, right: narrow ? 14 : 104, top: narrow ? 54 : 16, bottom: 66};
      const [x, y] = [dims[xd], dims[yd]];
      const [nx, ny] = [x.values.length, y.values.length];
      const values = new Float64Array(nx * ny);
      const at = new Int32Array(nx * ny);
      for (let j = 0; j < ny; ++j) {
        for (let i = 0; i < nx; ++i) {
          const row = rowOf(i, j);
          at[j * nx + i] = row;
          values[j * nx + i] = row < 0 ? NaN : figure.values[row];
        }
      }
      const box = {left: margin.left, right: width - margin.right, top: margin.top, bottom: height - margin.bottom};
      shape = {narrow, margin, x, y, nx, ny, values, at, box, across: cellsOf(x.values, box.left, box.right), up: cellsOf(y.values, box.bottom, box.top), range: colourRange(figure, values)};
    };
    const patterns = (ctx) => [[[0, 6, 6, 0]], [[0, 0, 6, 6]], [[0, 3, 6, 3]], [[3, 0, 3, 6]]].map((strokes) => {
      const tile = element("canvas", {width: 6, height: 6});
      const t = tile.getContext("2d");
      t.fillStyle = colour("panel");
      t.fillRect(0, 0, 6, 6);
      t.strokeStyle = colour("evaluations");
      for (const [a, b, c, d] of strokes) {
        t.beginPath();
        t.moveTo(a, b);
        t.lineTo(c, d);
        t.stroke();
      }
      return ctx.createPattern(tile, "repeat");
    });
    const ragged = () => {
      const {values, nx, ny, range} = shape;
      let sum = 0;
      let pairs = 0;
      const compare = (a, b) => {
        if (Number.isNaN(a) || Number.isNaN(b)) return;
        sum += Math.min(1, Math.abs(a - b) / (range.high - range.low));
        ++pairs;
      };
      for (let j = 0; j < ny; ++j) {
        for (let i = 0; i < nx; ++i) {
          const k = j * nx + i;
          if (i > 0 && i + 1 < nx) compare(values[k], (values[k - 1] + values[k + 1]) / 2);
          if (j > 0 && j + 1 < ny) compare(values[k], (values[k - nx] + values[k + nx]) / 2);
        }
      }
      return pairs > 0 && sum > 0.1 * pairs;
    };
    const contours = (ctx) => {
      const {values, nx, ny, range, across, up} = shape;
      const placed = [];
      for (const level of ticks(range, 9)) {
        if (level <= range.low || level >= range.high) continue;
        const pieces = [];
        for (let j = 0; j + 1 < ny; ++j) {
          for (let i = 0; i + 1 < nx; ++i) {
            const corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
            const v = corners.map(([a, b]) => values[b * nx + a]);
            if (v.some(Number.isNaN)) continue;
            const crossed = [];
            for (let k = 0; k < 4; ++k) {
              const n = (k + 1) % 4;
              if (v[k] > level === v[n] > level) continue;
              const share = (level - v[k]) / (v[n] - v[k]);
              crossed.push([across.centre(corners[k][0] + share * (corners[n][0] - corners[k][0])), up.centre(corners[k][1] + share * (corners[n][1] - corners[k][1]))]);
            }
            if (crossed.length === 2) pieces.push(crossed);
            if (crossed.length === 4) {
              const turned = (v[0] + v[1] + v[2] + v[3]) / 4 > level === v[0] > level;
              pieces.push([crossed[0], crossed[turned ? 1 : 3]], [crossed[2], crossed[turned ? 3 : 1]]);
            }
          }
        }
        ctx.beginPath();
        for (const [[a, b], [c, d]] of pieces) {
          ctx.moveTo(a, b);
          ctx.lineTo(c, d);
        }
        ctx.strokeStyle = "rgba(255,255,255,0.5)";
        ctx.lineWidth = 2.2;
        ctx.stroke();
        ctx.strokeStyle = "#1b1f24";
        ctx.lineWidth = 0.9;
        ctx.stroke();
        const free = pieces.filter(([[a, b]]) => a > shape.box.left + 26 && a < shape.box.right - 26 && b > shape.box.top + 12 && b < shape.box.bottom - 12 && placed.every(([c, d]) => Math.abs(a - c) > 60 || Math.abs(b - d) > 22));
        if (pieces.length > 8 && free.length) placed.push([...free[Math.floor(free.length / 2)][0], level]);
      }
      const [factor] = factorOf(figure, Math.max(Math.abs(range.low), Math.abs(range.high)));
      ctx.font = font(12);
      ctx.textAlign = "center";
      ctx.textBaseline = "middle";
      for (const [a, b, level] of placed) {
        ctx.strokeStyle = "rgba(255,255,255,0.85)";
        ctx.lineWidth = 3.5;
        ctx.strokeText(tickText(level / factor), a, b);
        ctx.fillStyle = "#1b1f24";
        ctx.fillText(tickText(level / factor), a, b);
      }
    };
    const drawLegend = (ctx, marks, view) => {
      const {box, range, narrow, margin} = shape;
      const largest = Math.max(Math.abs(range.low), Math.abs(range.high));
      const [factor] = factorOf(figure, largest);
      const [from, to] = narrow ? [box.left, box.right] : [box.bottom, box.top + 22];
      const axis = scale(range.log, range.low, range.high, from, to);
      for (let k = 0; k < 128; ++k) {
        ctx.fillStyle = shades[2 * k];
        const a = from + ((to - from) * k) / 128;
        const size = Math.abs(to - from) / 128 + 0.5;
        if (narrow) ctx.fillRect(a, 18, size, 12);
        else ctx.fillRect(box.right + 20, a - size, 14, size);
      }
      for (const tick of ticks(axis, narrow ? 4 : 8)) {
        if (narrow) write(ctx, tickText(tick / factor), axis(tick), 43, {align: "center"});
        else write(ctx, tickText(tick / factor), box.right + 40, axis(tick), {base: "middle"});
      }
      const label = named(figure, largest) + (range.above || range.below ? ", ends open" : "");
      if (narrow) write(ctx, fitted(ctx, label, box.right - box.left), box.left, 12, {fill: "ink"});
      else if (figure.unit) write(ctx, fitted(ctx, factorOf(figure, largest)[1] + figure.unit, margin.right - 20), box.right + 20, box.top + 6, {fill: "ink"});
      let a = box.left;
      const b = box.bottom + 52;
      for (const [name, pattern] of marks) {
        ctx.fillStyle = pattern;
        ctx.fillRect(a, b - 5, 20, 12);
        ctx.strokeStyle = colour("rule");
        ctx.lineWidth = 1;
        ctx.strokeRect(a, b - 5, 20, 12);
        write(ctx, name, a + 26, b + 1, {base: "middle"});
        a += 40 + ctx.measureText(name).width;
      }
    };
    const draw = (ctx, view) => {
      compute(view);
      const {x, y, nx, ny, values, at, box, across, up, range, narrow} = shape;
      const hatch = patterns(ctx);
      const marks = new Map();
      const ratio = devicePixelRatio || 1;
      const whole = (pixel) => Math.round(pixel * ratio) / ratio;
      for (let j = 0; j < ny; ++j) {
        for (let i = 0; i < nx; ++i) {
          const k = j * nx + i;
          const [left, right, top, bottom] = [across.edges[i], across.edges[i + 1], up.edges[j + 1], up.edges[j]].map(whole);
          if (Number.isNaN(values[k])) {
            const name = at[k] < 0 ? "not computed" : status(at[k]);
            if (!marks.has(name)) marks.set(name, hatch[marks.size % 4]);
            ctx.fillStyle = marks.get(name);
          } else {
            ctx.fillStyle = shadeOf(range, values[k]);
          }
          ctx.globalAlpha = at[k] >= 0 && !inside[at[k]] ? 0.2 : 1;
          ctx.fillRect(left, top, right - left, bottom - top);
        }
      }
      ctx.globalAlpha = 1;
      const noisy = ragged();
      if (lines && !noisy && !range.log) contours(ctx);
      ctx.strokeStyle = colour("muted");
      ctx.lineWidth = 1;
      ctx.strokeRect(box.left, box.top, box.right - box.left, box.bottom - box.top);
      const [fx] = factorOf(x.column, x.values[nx - 1]);
      const [fy] = factorOf(y.column, y.values[ny - 1]);
      for (const tick of ticks(across.axis, narrow ? 4 : 8)) write(ctx, tickText(tick / fx), across.axis(tick), box.bottom + 17, {align: "center"});
      for (const tick of ticks(up.axis, 7)) write(ctx, tickText(tick / fy), box.left - 8, up.axis(tick), {align: "right", base: "middle"});
      write(ctx, fitted(ctx, named(x.column, x.values[nx - 1]), box.right - box.left, 12.5), (box.left + box.right) / 2, box.bottom + 36, {align: "center", size: 12.5});
      upright(ctx, named(y.column, y.values[ny - 1]), 14, (box.top + box.bottom) / 2, box.bottom - box.top);
      drawLegend(ctx, marks, view);
      say(noisy);
    };
    const say = (noisy) => {
      if (cursor) {
        const row = rowOf(...cursor);
        if (row < 0) {
          readout.textContent = `${dims[xd].column.name} ${words(dims[xd].column, dims[xd].values[cursor[0]])}, ${dims[yd].column.name} ${words(dims[yd].column, dims[yd].values[cursor[1]])}: not computed`;
          return;
        }
        readout.replaceChildren(`Point ${number(row)}: `, describe(row, [...variables, figure]), ` – ${status(row)}${reason(row) ? ": " + reason(row) : ""}`);
        return;
      }
      readout.textContent = noisy && lines ? "No contour lines: the figure jumps from cell to cell." : "";
    };
    const view = canvas(holder, "Map of a figure over two variables", (width) => Math.round(Math.min(640, Math.max(360, 0.62 * width))), draw);
    holder.append(readout);
    const point = () => {
      view.show(cursor && ((ctx) => {
        const {across, up} = shape;
        const [i, j] = cursor;
        ctx.strokeStyle = "#fff";
        ctx.lineWidth = 4;
        const box = [across.edges[i] - 2, up.edges[j + 1] - 2, across.edges[i + 1] - across.edges[i] + 4, up.edges[j] - up.edges[j + 1] + 4];
        ctx.strokeRect(...box);
        ctx.strokeStyle = "#1b1f24";
        ctx.lineWidth = 1.6;
        ctx.strokeRect(...box);
      }));
      say(false);
    };
    const refresh = () => {
      if (cursor) cursor = [Math.min(cursor[0], dims[xd].values.length - 1), Math.min(cursor[1], dims[yd].values.length - 1)];
      view.redraw();
      point();
    };
    view.canvas.addEventListener("pointermove", (event) => {
      const [a, b] = at(event, view);
      const i = shape.across.edges.findIndex((edge) => edge > a) - 1;
      const j = shape.up.edges.findIndex((edge) => edge < b) - 1;
      cursor = i >= 0 && j >= 0 ? [i, j] : cursor;
      point();
    });
    const move = (di, dj) => () => {
      const [i, j] = cursor || [Math.floor(shape.nx / 2), Math.floor(shape.ny / 2)];
      cursor = [Math.min(shape.nx - 1, Math.max(0, i + di)), Math.min(shape.ny - 1, Math.max(0, j + dj))];
      point();
    };
    keys(view, {ArrowLeft: move(-1, 0), ArrowRight: move(1, 0), ArrowUp: move(0, 1), ArrowDown: move(0, -1), PageUp: move(0, 10), PageDown: move(0, -10), Home: move(-1e6, 0), End: move(1e6, 0), Escape: () => { cursor = null; point(); }});
  };

  // --- Front -----------------------------------------------------------------------------------------------------------------
  const drawFront = () => {
    const holder = part("front");
    if (!holder || !data.front) return;
    const aims = data.aims.map(({column}) => columns[column]);
    const pale = sample(() => true, 6000);
    let [x, y] = aims;
    let order = [];
    let chosen = data.knee ?? data.front[0];
    const controls = element("div", {className: "controls"});
    const build = () => {
      controls.replaceChildren(
        chooser("across", aims, x, (c) => { if (c === y) y = x; x = c; build(); view.redraw(); choose(chosen); }),
        chooser("up", aims, y, (c) => { if (c === x) x = y; y = c; build(); view.redraw(); choose(chosen); }));
    };
    if (aims.length > 2) holder.append(controls);
    const beside = element("div", {className: "beside"});
    const left = element("div");
    const right = element("div");
    beside.append(left, right);
    holder.append(beside);
    let across = null;
    let up = null;
    const view = canvas(left, "Pareto front: points that no other point improves in all figures", (width) => Math.round(Math.min(460, Math.max(300, 0.66 * width))), (ctx, {width, height}) => {
      order = [...data.front].sort((a, b) => x.values[a] - x.values[b]);
      const box = {left: 66, right: width - 14, top: 12, bottom: height - 48};
      const ends = (column) => {
        const range = colourRange(column, Float64Array.from(pale, (row) => column.values[row]));
        const onFront = data.front.map((row) => column.values[row]);
        const [low, high] = [Math.min(...onFront), Math.max(...onFront, range.high)];
        if (range.log) return [low / 1.1, high * 1.1];
        return [low - 0.05 * (high - low), high + 0.05 * (high - low)];
      };
      across = scale(x.log, ...ends(x), box.left, box.right);
      up = scale(y.log, ...ends(y), box.bottom, box.top);
      const [fx] = factorOf(x, across.high);
      const [fy] = factorOf(y, up.high);
      ctx.lineWidth = 1;
      ctx.strokeStyle = colour("grid");
      for (const tick of ticks(across, width < 420 ? 4 : 6)) {
        ctx.beginPath();
        ctx.moveTo(across(tick), box.top);
        ctx.lineTo(across(tick), box.bottom);
        ctx.stroke();
        write(ctx, tickText(tick / fx), across(tick), box.bottom + 17, {align: "center"});
      }
      for (const tick of ticks(up, 6)) {
        ctx.beginPath();
        ctx.moveTo(box.left, up(tick));
        ctx.lineTo(box.right, up(tick));
        ctx.stroke();
        write(ctx, tickText(tick / fy), box.left - 8, up(tick), {align: "right", base: "middle"});
      }
      write(ctx, fitted(ctx, named(x, across.high), box.right - box.left, 12.5), (box.left + box.right) / 2, height - 10, {align: "center", size: 12.5});
      upright(ctx, named(y, up.high), 13, (box.top + box.bottom) / 2, box.bottom - box.top);
      ctx.save();
      ctx.beginPath();
      ctx.rect(box.left, box.top, box.right - box.left, box.bottom - box.top);
      ctx.clip();
      ctx.fillStyle = colour("evaluations");
      for (const row of pale) {
        ctx.globalAlpha = inside[row] ? 0.5 : 0.1;
        ctx.fillRect(across(x.values[row]) - 1.2, up(y.values[row]) - 1.2, 2.4, 2.4);
      }
      ctx.restore();
      ctx.globalAlpha = 1;
      ctx.fillStyle = ctx.strokeStyle = colour("best");
      if (aims.length === 2) {
        ctx.lineWidth = 1.2;
        ctx.beginPath();
        order.forEach((row, k) => {
          if (k > 0) ctx.lineTo(across(x.values[row]), up(y.values[order[k - 1]]));
          ctx.lineTo(across(x.values[row]), up(y.values[row]));
        });
        ctx.stroke();
      }
      for (const row of order) {
        ctx.globalAlpha = inside[row] ? 1 : 0.25;
        ctx.beginPath();
        ctx.arc(across(x.values[row]), up(y.values[row]), 3.2, 0, 7);
        ctx.fill();
      }
      ctx.globalAlpha = 1;
      if (data.knee !== undefined) {
        const [a, b] = [across(x.values[data.knee]), up(y.values[data.knee])];
        ctx.strokeStyle = colour("baseline");
        ctx.lineWidth = 2;
        ctx.beginPath();
        ctx.arc(a, b, 7, 0, 7);
        ctx.stroke();
        write(ctx, "knee", a + 11, b - 9, {fill: "ink", halo: true});
      }
    });
    const readout = element("p", {className: "readout"});
    readout.setAttribute("aria-live", "polite");
    right.append(readout);
    const signals = element("div");
    right.append(signals);
    let lines = null;
    let drives = null;
    if (data.waveforms) {
      drives = canvas(signals, "Drives of the point", 190, (ctx, {width, height}) => {
        if (!lines) return;
        const box = {left: 46, right: width - 16, top: 24, bottom: height - 40};
        const all = Object.values(lines).flat();
        const lastTime = Math.max(...all.map(([t]) => t));
        const levels = all.map(([, v]) => v);
        const [low, high] = [Math.min(0, ...levels), Math.max(...levels)];
        const a = scale(false, 0, lastTime, box.left, box.right);
        const b = scale(false, low - 0.05 * (high - low), high + 0.05 * (high - low), box.bottom, box.top);
        const [ft, symbol] = prefix(lastTime);
        ctx.strokeStyle = colour("grid");
        ctx.lineWidth = 1;
        for (const tick of ticks(b, 4)) {
          ctx.beginPath();
          ctx.moveTo(box.left, b(tick));
          ctx.lineTo(box.right, b(tick));
          ctx.stroke();
          write(ctx, tickText(tick), box.left - 7, b(tick), {align: "right", base: "middle"});
        }
        for (const tick of ticks(a, 4)) write(ctx, tickText(tick / ft), a(tick), box.bottom + 16, {align: "center"});
        write(ctx, `Time (${symbol}s)`, (box.left + box.right) / 2, height - 6, {align: "center"});
        const pens = ["best", "baseline", "third", "fourth"];
        let from = box.left;
        Object.entries(lines).forEach(([name, line], k) => {
          ctx.strokeStyle = colour(pens[k % 4]);
          ctx.lineWidth = 2;
          ctx.setLineDash(k ? [6, 3] : []);
          ctx.beginPath();
          for (const [t, v] of line) ctx.lineTo(a(t), b(v));
          ctx.stroke();
          ctx.beginPath();
          ctx.moveTo(from, 10);
          ctx.lineTo(from + 20, 10);
          ctx.stroke();
          ctx.setLineDash([]);
          write(ctx, name + " (V)", from + 26, 10, {base: "middle"});
          from += 44 + ctx.measureText(name + " (V)").width;
        });
      });
    }
    const choose = (row) => {
      chosen = row;
      view.show((ctx) => {
        ctx.strokeStyle = colour("ink");
        ctx.lineWidth = 2;
        ctx.beginPath();
        ctx.arc(across(x.values[row]), up(y.values[row]), 5.5, 0, 7);
        ctx.stroke();
      });
      readout.replaceChildren(`Point ${number(row)}${row === data.knee ? ", the knee" : ""}: `, describe(row, [...aims, ...variables.filter((c) => !aims.includes(c))]));
      lines = data.waveforms?.[row] ?? null;
      drives?.redraw();
    };
    build();
    view.canvas.addEventListener("pointermove", (event) => {
      const [a, b] = at(event, view);
      const away = (row) => (across(x.values[row]) - a) ** 2 + (up(y.values[row]) - b) ** 2;
      choose(order.reduce((best, row) => (away(row) < away(best) ? row : best), order[0]));
    });
    const step = (by) => () => choose(order[Math.min(order.length - 1, Math.max(0, order.indexOf(chosen) + by))]);
    keys(view, {ArrowLeft: step(-1), ArrowRight: step(1), Home: step(-1e6), End: step(1e6)});
    view.after = () => choose(chosen);
  };

  // --- Parallel coordinates and scatter matrix ---------------------------------------------------------------------------------
  const preferred = ["initial_contact_time_s", "impact_velocity_m_s", "major_bounce_height_m", "bounce_count", "peak_voltage_V"];
  const chosenFigures = () => {
    const aims = (data.aims || []).map(({column}) => columns[column]);
    const ranked = [...aims, ...preferred.map((key) => figures.find((c) => c.key === key)).filter(Boolean), ...figures];
    return [...new Set(ranked)].slice(0, 4);
  };
  const shown = new Set([...variables.slice(0, 5), ...chosenFigures()].map((c) => c.index));
  const shownColumns = () => columns.filter((c) => shown.has(c.index));
  let tint = leading;
  let tintRange = null;
  const everything = () => {
    for (const one of canvases) {
      one.redraw();
      one.after?.();
    }
  };

  const drawParallel = () => {
    const holder = part("parallel");
    if (!holder) return;
    const told = element("output");
    const clear = element("button", {type: "button"}, "Clear limits");
    clear.addEventListener("click", () => { limits.clear(); changed(); });
    holder.append(element("div", {className: "controls"}, chooser("Colour by", [...variables, ...figures], tint, (c) => { tint = c; everything(); }), clear, told));
    const list = element("div");
    for (const c of [...variables, ...figures]) {
      const box = element("input", {type: "checkbox", checked: shown.has(c.index)});
      box.addEventListener("change", () => {
        if (box.checked) shown.add(c.index);
        else shown.delete(c.index);
        everything();
      });
      list.append(element("label", {}, box, " " + c.name));
    }
    holder.append(element("details", {className: "columns"}, element("summary", {}, "Columns"), list));
    let axes = [];
    let active = 0;
    const most = 3000;
    const place = {};
    const view = canvas(holder, "Parallel coordinates: a line for every point", (width) => (width < 560 ? Math.max(200, 72 * shownColumns().length) : 400), (ctx, {width, height}) => {
      const narrow = width < 560;  // the axes are then horizontal, one below the other, each with a strip for its labels that no line crosses
      const strip = narrow ? 31 : 0;
      const list = shownColumns();
      tintRange = colourRange(tint, tint.values);
      Object.assign(place, narrow ? {from: 12, to: width - 12, first: 14, last: height - 36} : {from: height - 26, to: 52, first: 54, last: width - 54});
      axes = list.map((c, k) => ({column: c, at: list.length > 1 ? place.first + ((place.last - place.first) * k) / (list.length - 1) : place.first, axis: scale(c.log, c.low, c.high, place.from, place.to)}));
      active = Math.min(active, Math.max(0, axes.length - 1));
      const spot = (axis, value) => (narrow ? [axis.axis(value), axis.at] : [axis.at, axis.axis(value)]);
      const drawLines = (list, alpha, plain) => {
        ctx.lineWidth = 1;
        ctx.globalAlpha = alpha;
        for (const row of list) {
          ctx.strokeStyle = plain ? colour("evaluations") : Number.isNaN(tint.values[row]) ? colour("evaluations") : shadeOf(tintRange, tint.values[row]);
          ctx.beginPath();
          let pen = false;
          for (const axis of axes) {
            const value = axis.column.values[row];
            if (Number.isNaN(value)) {
              pen = false;
              continue;
            }
            const [a, b] = spot(axis, value);
            if (pen) ctx.lineTo(a, b);
            if (!pen || narrow) ctx.moveTo(a, b + strip);
            pen = true;
          }
          ctx.stroke();
        }
        ctx.globalAlpha = 1;
      };
      const pale = limits.size ? sample((i) => !inside[i], 1000) : [];
      const vivid = sample((i) => inside[i], most);
      drawLines(pale, 0.07, true);
      drawLines(vivid, Math.min(0.9, Math.max(0.12, 60 / Math.sqrt(vivid.length) / 3)), false);
      axes.forEach((axis, k) => {
        const {column} = axis;
        ctx.strokeStyle = colour(k === active ? "best" : "muted");
        ctx.lineWidth = k === active ? 2 : 1;
        ctx.beginPath();
        ctx.moveTo(...spot(axis, axis.axis.low));
        ctx.lineTo(...spot(axis, axis.axis.high));
        ctx.stroke();
        const room = narrow ? width - 24 : axes.length > 1 ? (place.last - place.first) / (axes.length - 1) - 8 : width;
        if (narrow) {
          write(ctx, fitted(ctx, column.name, room), width / 2, axis.at + 14, {align: "center", fill: "ink"});
          write(ctx, words(column, axis.axis.low, 3), 12, axis.at + 28, {size: 11});
          write(ctx, words(column, axis.axis.high, 3), width - 12, axis.at + 28, {align: "right", size: 11});
        } else {
          // The labels of the outer axes end at the edge of the picture.
          const name = fitted(ctx, column.name, 1.9 * room);
          const half = ctx.measureText(name).width / 2;
          write(ctx, name, Math.min(Math.max(axis.at, half + 2), width - half - 2), k % 2 ? 14 : 30, {align: "center", fill: "ink", halo: true});
          write(ctx, words(column, axis.axis.high, 3), axis.at, 46, {align: "center", halo: true, size: 11.5});
          write(ctx, words(column, axis.axis.low, 3), axis.at, height - 8, {align: "center", halo: true, size: 11.5});
        }
        const limit = limits.get(column.index);
        if (limit) {
          const ends = limit.map((v) => axis.axis(Math.min(column.high, Math.max(column.low, v))));
          const [low, high] = [Math.min(...ends), Math.max(...ends)];
          ctx.fillStyle = colour("best");
          ctx.globalAlpha = 0.3;
          if (narrow) ctx.fillRect(low, axis.at - 9, Math.max(2, high - low), 9);
          else ctx.fillRect(axis.at - 7, low, 14, Math.max(2, high - low));
          ctx.globalAlpha = 1;
        }
      });
      const drawnWords = vivid.length < insideCount ? `, ${vivid.length} of them drawn` : "";
      told.textContent = limits.size ? `${insideCount} of ${rows} points within the limits${drawnWords}` : `${rows} points${drawnWords}`;
    });
    const readout = element("p", {className: "readout"});
    readout.setAttribute("aria-live", "polite");
    holder.append(readout);
    const tellLimits = () => {
      const parts = [...limits].map(([index, [low, high]]) => `${columns[index].name} from ${words(columns[index], low, 3)} to ${words(columns[index], high, 3)}`);
      readout.textContent = parts.length ? "Limits: " + parts.join("; ") : "";
    };
    const changed = () => {
      select();
      tellLimits();
      everything();
    };
    // Dragging along an axis sets its limits, a click removes them.
    let drag = null;
    const along = ([a, b]) => (view.width < 560 ? [b, a] : [a, b]);
    view.canvas.addEventListener("pointerdown", (event) => {
      const [across, value] = along(at(event, view));
      if (!axes.length) return;
      active = axes.reduce((best, {at: place}, k) => (Math.abs(place - across) < Math.abs(axes[best].at - across) ? k : best), 0);
      if (Math.abs(axes[active].at - across) > 24) return;
      drag = {from: value, axis: axes[active]};
      view.canvas.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    view.canvas.addEventListener("pointermove", (event) => {
      if (!drag) return;
      const [, value] = along(at(event, view));
      const {column, axis} = drag.axis;
      const ends = [axis.back(drag.from), axis.back(value)].sort((a, b) => a - b);
      if (Math.abs(value - drag.from) < 4) return;
      limits.set(column.index, [Math.max(column.low, ends[0]), Math.min(column.high, ends[1])]);
      select();
      tellLimits();
      view.redraw();
    });
    const finish = (event) => {
      if (!drag) return;
      const [, value] = along(at(event, view));
      if (Math.abs(value - drag.from) < 4) limits.delete(drag.axis.column.index);
      drag = null;
      changed();
    };
    view.canvas.addEventListener("pointerup", finish);
    view.canvas.addEventListener("pointercancel", finish);
    const shift = (low, high) => () => {
      const {column, axis} = axes[active];
      const back = (part) => axis.back(place.from + part * (place.to - place.from));
      const part = (v) => (axis(v) - place.from) / (place.to - place.from);
      const now = (limits.get(column.index) || [column.low, column.high]).map(part);
      const ends = [Math.min(0.95, Math.max(0, now[0] + low)), Math.max(0.05, Math.min(1, now[1] + high))];
      if (ends[1] <= ends[0]) return;
      limits.set(column.index, [ends[0] <= 0 ? column.low : back(ends[0]), ends[1] >= 1 ? column.high : back(ends[1])]);
      changed();
    };
    const go = (by) => () => {
      active = Math.min(axes.length - 1, Math.max(0, active + by));
      readout.textContent = axes[active].column.name;
      view.redraw();
    };
    keys(view, {ArrowLeft: go(-1), ArrowRight: go(1), ArrowUp: shift(0.05, 0.05), ArrowDown: shift(-0.05, -0.05), "+": shift(-0.05, 0.05), "-": shift(0.05, -0.05), Backspace: () => { limits.delete(axes[active].column.index); changed(); }, Delete: () => { limits.delete(axes[active].column.index); changed(); }});
  };

  const drawMatrix = () => {
    const holder = part("matrix");
    if (!holder) return;
    const list = () => {
      const all = shownColumns().filter((c) => c.varies);
      const own = all.filter((c) => c.variable);
      const most = holder.clientWidth < 560 ? 3 : 5;
      const few = own.slice(0, Math.ceil(most / 2));
      return [...few, ...all.filter((c) => !c.variable)].slice(0, most);
    };
    canvas(holder, "Scatter matrix: every pair of columns", (width) => Math.round(Math.max(240, Math.min(0.86 * width, 820))), (ctx, {width, height}) => {
      const all = list();
      const n = all.length;
      if (!n) return;
      const margin = {left: 56, top: 8, bottom: 40};
      const gap = 8;
      const [w, h] = [(width - margin.left) / n, (height - margin.top - margin.bottom) / n];
      const vivid = sample((i) => inside[i], 2500);
      const pale = limits.size ? sample((i) => !inside[i], 800) : [];
      tintRange = colourRange(tint, tint.values);
      const axisOf = (c, from, to) => scale(c.log, c.low, c.high, from, to);
      const corner = (i, j) => [margin.left + i * w, margin.top + j * h];
      for (let j = 0; j < n; ++j) {
        for (let i = 0; i <= j; ++i) {
          const [left, top] = corner(i, j);
          const box = [left + 3, top + 3, w - gap, h - gap];
          ctx.strokeStyle = colour("rule");
          ctx.lineWidth = 1;
          ctx.strokeRect(...box);
          const x = axisOf(all[i], box[0] + 4, box[0] + box[2] - 4);
          if (i === j) {
            const counts = new Float64Array(24);
            let total = 0;
            for (let row = 0; row < rows; ++row) {
              if (!inside[row] || Number.isNaN(all[i].values[row])) continue;
              const part = (x(all[i].values[row]) - box[0] - 4) / (box[2] - 8);
              ++counts[Math.min(23, Math.max(0, Math.floor(part * 24)))];
              ++total;
            }
            const largest = Math.max(...counts, 1);
            ctx.fillStyle = colour("evaluations");
            counts.forEach((count, k) => ctx.fillRect(box[0] + 4 + ((box[2] - 8) * k) / 24, box[1] + box[3], (box[2] - 8) / 24 - 1, (-count / largest) * (box[3] - 26)));
            write(ctx, fitted(ctx, named(all[i], Math.max(Math.abs(all[i].low), Math.abs(all[i].high))), box[2] - 10), box[0] + 6, box[1] + 15, {fill: "ink", halo: true});
            continue;
          }
          const y = axisOf(all[j], box[1] + box[3] - 4, box[1] + 4);
          const dot = (row, size) => ctx.fillRect(x(all[i].values[row]) - size / 2, y(all[j].values[row]) - size / 2, size, size);
          ctx.globalAlpha = 0.15;
          ctx.fillStyle = colour("evaluations");
          for (const row of pale) dot(row, 2);
          ctx.globalAlpha = 0.75;
          for (const row of vivid) {
            ctx.fillStyle = Number.isNaN(tint.values[row]) ? colour("evaluations") : shadeOf(tintRange, tint.values[row]);
            dot(row, 2.2);
          }
          ctx.globalAlpha = 1;
        }
      }
      all.forEach((c, k) => {
        const [left] = corner(k, n - 1);
        const bottom = margin.top + n * h;
        const x = axisOf(c, left + 7, left + w - 9);
        const [f] = factorOf(c, Math.max(Math.abs(c.low), Math.abs(c.high)));
        for (const tick of ticks(x, w < 130 ? 3 : 4)) write(ctx, tickText(tick / f), Math.min(Math.max(x(tick), left + 12), left + w - 16), bottom + 13, {align: "center", size: 11});
        if (k === 0) return;
        const top = margin.top + k * h;
        const y = axisOf(c, top + h - 9, top + 7);
        for (const tick of ticks(y, 4)) write(ctx, tickText(tick / f), margin.left - 4, y(tick), {align: "right", base: "middle", size: 11});
      });
      write(ctx, fitted(ctx, `Colour: ${named(tint, Math.max(Math.abs(tint.low), Math.abs(tint.high)))}, dark is low`, width - margin.left), margin.left + 3, height - 6, {size: 12});
    });
  };

  // --- Effects ---------------------------------------------------------------------------------------------------------------
  const drawEffects = () => {
    const holder = part("effects");
    if (!holder) return;
    let figure = leading.varies ? leading : figures[0];
    if (!figure) return;
    const panels = element("div", {className: "effects"});
    holder.append(element("div", {className: "controls"}, chooser("Figure", figures, figure, (c) => { figure = c; views.forEach((one) => one.redraw()); })), panels);
    const shared = () => {
      const all = data.effects.flatMap((one) => one.figures[figure.index] || []).flatMap((bin) => bin.slice(2)).filter((v) => v !== null);
      return [Math.min(...all), Math.max(...all)];
    };
    const views = data.effects.filter(({variable}) => columns[variable].varies).map(({variable, figures: found}) => {
      const column = columns[variable];
      const frame = element("figure");
      panels.append(frame);
      const caption = element("figcaption");
      const view = canvas(frame, `Effect of ${column.name}`, 210, (ctx, {width, height}) => {
        const bins = found[figure.index] || [];
        const box = {left: 52, right: width - 10, top: 10, bottom: height - 42};
        const [low, high] = shared();
        const y = scale(figure.log, low, high, box.bottom, box.top);
        const x = scale(column.log, column.low, column.high, box.left + 6, box.right - 6);
        const [fx] = factorOf(column, column.high);
        const [fy] = factorOf(figure, Math.max(Math.abs(low), Math.abs(high)));
        ctx.strokeStyle = colour("grid");
        ctx.lineWidth = 1;
        for (const tick of ticks(y, 4)) {
          ctx.beginPath();
          ctx.moveTo(box.left, y(tick));
          ctx.lineTo(box.right, y(tick));
          ctx.stroke();
          write(ctx, tickText(tick / fy), box.left - 7, y(tick), {align: "right", base: "middle"});
        }
        for (const tick of ticks(x, 5)) write(ctx, tickText(tick / fx), x(tick), box.bottom + 16, {align: "center"});
        write(ctx, fitted(ctx, named(column, column.high), width - 60, 12.5), (box.left + box.right) / 2, height - 7, {align: "center", size: 12.5});
        upright(ctx, named(figure, Math.max(Math.abs(low), Math.abs(high))), 11, (box.top + box.bottom) / 2, box.bottom - box.top);
        for (const [a, b, alpha] of [[2, 6, 0.16], [3, 5, 0.3]]) {
          ctx.globalAlpha = alpha;
          ctx.fillStyle = colour("best");
          ctx.beginPath();
          for (const bin of bins) ctx.lineTo(x(bin[0]), y(bin[a]));
          for (const bin of [...bins].reverse()) ctx.lineTo(x(bin[0]), y(bin[b]));
          ctx.fill();
        }
        ctx.globalAlpha = 1;
        ctx.strokeStyle = colour("best");
        ctx.lineWidth = 2;
        ctx.beginPath();
        for (const bin of bins) ctx.lineTo(x(bin[0]), y(bin[4]));
        ctx.stroke();
        const middles = bins.map((bin) => bin[4]);
        caption.textContent = bins.length ? `Median from ${words(figure, middles[0], 3)} to ${words(figure, middles[middles.length - 1], 3)}` : "No point has this figure.";
      });
      frame.append(caption);
      return view;
    });
  };

  makeCards();
  document.body.classList.add("drawn");
  drawMaps();
  drawFront();
  drawParallel();
  drawMatrix();
  drawEffects();
  everything();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", everything);
  let width = innerWidth;
  addEventListener("resize", () => {
    if (innerWidth === width) return;
    width = innerWidth;
    everything();
  });
  addEventListener("beforeprint", () => document.querySelectorAll("details").forEach((one) => (one.open = true)));
})();
