// Draws the charts of the report with uPlot and keeps the time charts in step.
(() => {
  "use strict";
  const {prefix, quantity, tickText, column, colour, font, makeCards} = softland;
  const {tables, charts} = JSON.parse(document.getElementById("data").textContent);

  for (const table of Object.values(tables)) {
    for (const key of Object.keys(table)) table[key] = column(table[key]);
  }

  const largest = (scale) => Math.max(Math.abs(scale.min), Math.abs(scale.max));

  // Puts curves with different knots on one x axis: the union of all knots, with linear interpolation between those of a curve. A jump (two
  // knots at one x) stays a jump. The knots `extra` are added where knots are far apart, so that the read-out follows the cursor. Curves of
  // dots are not interpolated.
  const aligned = (curves, extra, dots) => {
    const count = new Map(extra.map((x) => [x, 1]));
    for (const {xs} of curves) {
      for (let i = 0; i < xs.length; ) {
        let next = i;
        while (next < xs.length && xs[next] === xs[i]) ++next;
        count.set(xs[i], Math.min(2, Math.max(count.get(xs[i]) || 0, next - i)));
        i = next;
      }
    }
    const x = [...count.keys()].sort((a, b) => a - b).flatMap((value) => Array(count.get(value)).fill(value));
    const rows = curves.map(({xs, ys}) => {
      const out = new Array(x.length).fill(null);
      let right = 0;
      for (let row = 0; row < x.length; ++row) {
        const second = row > 0 && x[row] === x[row - 1];
        while (right < xs.length && (second ? xs[right] <= x[row] : xs[right] < x[row])) ++right;
        if (second) {
          out[row] = xs[right - 1] === x[row] ? ys[right - 1] : out[row - 1];
        } else if (right < xs.length && xs[right] === x[row]) {
          out[row] = ys[right];
        } else if (!dots && right > 0 && right < xs.length && ys[right] !== null && ys[right - 1] !== null) {
          const share = (x[row] - xs[right - 1]) / (xs[right] - xs[right - 1]);
          out[row] = ys[right - 1] + share * (ys[right] - ys[right - 1]);
        }
      }
      return out;
    });
    return [x, ...rows];
  };

  const grid = ({whole, home}) => [whole, home].flatMap(([low, high]) => Array.from({length: 1001}, (none, i) => low + ((high - low) * i) / 1000));

  const pens = {
    best: {width: 2, dash: undefined},
    baseline: {width: 1.25, dash: [7, 2.5]},
    evaluations: {width: 0, dash: undefined},
    third: {width: 1.8, dash: [2.5, 2.5]},
    fourth: {width: 1.8, dash: [10, 3, 2, 3]},
    fifth: {width: 1.8, dash: [5, 2, 1.5, 2, 1.5, 2]},
    limit: {width: 1.25, dash: [2, 3]},
  };
  // Returns ticks at decades, as many as there is room for; an axis of fewer than three decades has ticks at 1, 2 and 5 of each.
  const decades = (u, axis, min, max) => {
    const first = Math.ceil(Math.log10(min) - 1e-9);
    const last = Math.floor(Math.log10(max) + 1e-9);
    const room = (u.axes[axis].side % 2 ? u.height - 60 : u.width - 80) / (u.axes[axis].side % 2 ? 24 : 44);
    const every = Math.max(1, Math.ceil((last - first + 1) / Math.max(2, room)));
    const splits = [];
    for (let exponent = first - (first <= last && last - first > 1 ? 0 : 1); exponent <= last; exponent += last - first > 1 ? every : 1) {
      for (const part of last - first > 1 ? [1] : [1, 2, 5]) splits.push(+(part * 10 ** exponent).toPrecision(3));
    }
    return splits.filter((value) => value >= min * (1 - 1e-9) && value <= max * (1 + 1e-9));
  };
  // Returns the width of the longest number [px].
  const roomFor = (u, values) => {
    if (!values) return 54;
    u.ctx.save();
    u.ctx.font = font(12 * uPlot.pxRatio);
    const widest = Math.max(0, ...values.map((value) => (value ? u.ctx.measureText(value).width / uPlot.pxRatio : 0)));
    u.ctx.restore();
    return Math.max(40, Math.ceil(widest) + 14);
  };

  const drawn = new Map();   // chart id -> uPlot
  const wanted = new Map();  // chart id -> the range that this script set last; the reader has set any other range

  const timeCharts = () => charts.filter((chart) => chart.group === "time" && drawn.has(chart.id));
  const press = (view) => {
    for (const button of document.querySelectorAll("[data-view]")) button.setAttribute("aria-pressed", String(button.dataset.view === view));
  };
  const setRange = (chart, [min, max]) => {
    wanted.set(chart.id, [min, max]);
    drawn.get(chart.id).setScale("x", {min, max});
  };
  const spread = (range) => {
    for (const chart of timeCharts()) setRange(chart, range(chart));
    time.viewed();
  };
  const show = (view) => {
    const landing = charts.find(({id}) => id === "landing");
    spread(({x}) => (view === "landing" ? landing.x.home : view === "whole" ? x.whole : x.home));
    press(view);
  };
  const goHome = (chart) => (chart.group === "time" ? show("home") : setRange(chart, chart.x.home));
  const zoom = (chart, factor) => {
    const u = drawn.get(chart.id);
    const [to, back] = chart.x.scale === "log" ? [Math.log10, (value) => 10 ** value] : [(value) => value, (value) => value];
    const [min, max, low, high] = [u.scales.x.min, u.scales.x.max, ...chart.x.whole].map(to);
    const centre = u.cursor.left >= 0 ? to(u.posToVal(u.cursor.left, "x")) : (min + max) / 2;
    const range = [Math.max(low, centre - (centre - min) * factor), Math.min(high, centre + (max - centre) * factor)].map(back);
    if (!(to(range[1]) - to(range[0]) > 1e-6 * (high - low))) return;
    if (chart.group === "time") {
      press(null);
      spread(() => range);
    } else {
      setRange(chart, range);
    }
  };
  // The animation follows the time charts: `follow` gives it the time of their cursor [s], `viewed` a change of the view; `point` sets the cursor.
  const time = {
    tables,
    follow: () => {},
    viewed: () => {},
    range: () => wanted.get(timeCharts()[0]?.id),
    point: (at) => {
      for (const chart of timeCharts()) {
        const u = drawn.get(chart.id);
        const isShown = at >= u.scales.x.min && at <= u.scales.x.max;
        u.setCursor({left: isShown ? u.valToPos(at, "x") : -10, top: isShown ? u.bbox.height / uPlot.pxRatio / 2 : -10}, false, false);
      }
    },
  };
  // Moves the cursor by some pixels to the left or right, to the next sample there.
  const step = (chart, direction) => {
    const u = drawn.get(chart.id);
    const width = u.bbox.width / uPlot.pxRatio;
    const from = u.cursor.left >= 0 ? u.cursor.left : direction > 0 ? 0 : width;
    u.setCursor({left: Math.min(width, Math.max(0, from + 4 * direction)), top: u.bbox.height / uPlot.pxRatio / 2}, true, true);
  };

  // Writes words inside the picture, on a halo of the background colour, so that no curve runs through them.
  const write = (u, words, x, y) => {
    const {ctx, bbox} = u;
    const half = ctx.measureText(words).width / 2;
    const at = Math.min(Math.max(x, bbox.left + half + 4 * uPlot.pxRatio), bbox.left + bbox.width - half - 4 * uPlot.pxRatio);
    const down = Math.max(y, bbox.top + 16 * uPlot.pxRatio);
    ctx.textAlign = "center";
    ctx.lineJoin = "round";
    ctx.lineWidth = 5 * uPlot.pxRatio;
    ctx.strokeStyle = colour("paper");
    ctx.strokeText(words, at, down);
    ctx.fillText(words, at, down);
  };

  // Draws a bar for each series from its own knots; a contact of an instant is one pixel wide.
  const states = {0: "open", 0.5: "closing and opening", 1: "closed"};
  const drawBars = (u, chart) => {
    const {ctx, bbox} = u;
    const row = bbox.height / chart.series.length;
    chart.series.forEach(({table, column: key, role, label}, number) => {
      const [xs, ys] = [tables[table][chart.x.column], tables[table][key]];
      if (!u.series[1 + number].show) return;
      const top = bbox.top + (number + 0.17) * row;
      ctx.fillStyle = colour(role);
      for (let i = 1; i < xs.length; ++i) {
        if (!(ys[i] > 0 && ys[i] === ys[i - 1]) || xs[i] < u.scales.x.min || xs[i - 1] > u.scales.x.max) continue;
        const [begin, end] = [u.valToPos(xs[i - 1], "x", true), u.valToPos(xs[i], "x", true)];
        ctx.globalAlpha = ys[i] < 1 ? 0.45 : 1;
        ctx.fillRect(begin, top, Math.max(uPlot.pxRatio, end - begin), 0.66 * row);
      }
      ctx.globalAlpha = 1;
      if (chart.series.length === 1) return;
      ctx.fillStyle = colour("ink");
      ctx.font = font(12 * uPlot.pxRatio);
      ctx.textBaseline = "middle";
      ctx.textAlign = "right"; // the end of a closing hides less than the first touches
      ctx.lineJoin = "round";
      ctx.lineWidth = 4 * uPlot.pxRatio;
      ctx.strokeStyle = colour("paper");
      for (const act of ["strokeText", "fillText"]) ctx[act](label, bbox.left + bbox.width - 6 * uPlot.pxRatio, top + 0.35 * row);
    });
  };

  const decorate = (chart) => (u) => {
    const {ctx, bbox} = u;
    const ratio = uPlot.pxRatio;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top - 1, bbox.width, bbox.height + 2);
    ctx.clip();
    if (chart.bars) drawBars(u, chart);
    if (chart.zero) {
      const y = Math.round(u.valToPos(0, "y", true));
      ctx.strokeStyle = ctx.fillStyle = colour("ink");
      ctx.lineWidth = ratio;
      ctx.beginPath();
      ctx.moveTo(bbox.left, y);
      ctx.lineTo(bbox.left + bbox.width, y);
      ctx.stroke();
      ctx.fillStyle = colour("muted");
      ctx.font = font(12 * ratio);
      // The words stand below the zero line, or above it where the curves reach visibly below.
      const lowest = u.data.slice(1).reduce((low, row) => row.reduce((least, value) => (value !== null && value < least ? value : least), low), 0);
      const under = chart.zeroLabelLeft || lowest > -0.03 * (u.scales.y.max - u.scales.y.min);
      ctx.textBaseline = under ? "top" : "bottom";
      if (chart.zeroLabel) write(u, chart.zeroLabel, chart.zeroLabelLeft ? bbox.left : bbox.left + bbox.width, y + (under ? 3 : -3) * ratio);
    }
    ctx.textBaseline = "bottom";
    ctx.font = "600 " + font(12.5 * ratio);
    for (const mark of chart.marks) {
      const index = 1 + chart.series.findIndex(({role}) => role === mark.role);
      if (mark.y < u.scales.y.min || mark.y > u.scales.y.max || mark.x < u.scales.x.min || mark.x > u.scales.x.max || (index > 0 && !u.series[index].show)) continue;
      const x = u.valToPos(mark.x, "x", true);
      const y = u.valToPos(mark.y, "y", true);
      ctx.fillStyle = colour(mark.role);
      ctx.beginPath();
      ctx.arc(x, y, 2.6 * ratio, 0, 2 * Math.PI);
      ctx.fill();
      if (mark.text) write(u, mark.text, x, y - 5 * ratio);
    }
    ctx.restore();
  };

  const isJoined = ({x, steps}) => x.scale === "linear" || steps;  // else a curve has a dot at every point

  const options = (chart, width, start) => {
    const {x, y} = chart;
    const narrow = width < 560;
    const axis = (name, unit, more) => ({
      stroke: colour("muted"),
      font: font(12),
      labelFont: font(12.5),
      grid: {stroke: colour("grid"), width: 1},
      ticks: {show: false},
      ...more,
    });
    const distributions = {linear: {distr: 1}, log: {distr: 3, log: 10}};
    const joined = isJoined(chart);
    const yPrefix = (u) => (!y.unit ? [1, ""] : prefix(largest(u.scales.y) / 1.1));
    const ticks = (factor) => (value) => (value === null ? null : tickText(value / factor));
    const padded = (u, min, max) => {
      if (min === null || max === null) return [0, 1];
      const low = Math.min(min, chart.zero || min > 0 && min < 0.6 * max ? 0 : min);
      const high = Math.max(max, 0);
      const margin = high > low ? 0.06 * (high - low) : Math.max(1e-12, Math.abs(high));
      const below = chart.zeroLabel ? Math.max(margin, (0.1 * (high - low) * 240) / chart.height) : margin;  // room for the words at the zero line
      return [low < 0 || chart.zero ? low - below : low, high + margin];
    };
    const range = chart.bars ? [0, 1] : y.home ? y.home : y.scale === "linear" ? padded : (u, min, max) => [min / 1.5, max * 1.5];
    return {
      width,
      height: chart.bars ? chart.height + 66 : narrow ? Math.min(chart.height, 240) : chart.height,
      padding: [10, 24, 0, 4],
      cursor: {
        y: false,
        drag: {x: true, y: false, setScale: true},
        points: {show: !chart.bars, size: 7},
        ...(chart.group ? {sync: {key: chart.group, setSeries: false, scales: ["x", null], filters: {pub: (type) => type === "mousemove" || type === "mouseleave"}}} : {}),
        bind: {dblclick: () => () => goHome(chart)},
      },
      legend: {live: true, markers: {width: 3, dash: (u, index) => (u.series[index].dash ? "dashed" : "solid")}},
      scales: {x: {time: false, ...distributions[x.scale], min: start[0], max: start[1], range: (u, min, max) => [min, max]}, y: {...distributions[y.scale], range}},
      axes: [
        axis("x", x.unit, {
          label: (u) => (x.unit ? `${x.label} (${prefix(largest(u.scales.x))[1]}${x.unit})` : x.label),
          values: (u, splits) => splits.map(ticks(x.unit ? prefix(largest(u.scales.x))[0] : 1)),
          labelSize: 22,
          size: 30,
          space: narrow ? 50 : 80,
          ...(x.scale === "log" ? {splits: decades, filter: (u, splits) => splits} : {}),
        }),
        axis("y", y.unit, {
          label: (u) => (y.unit ? `${y.label} (${yPrefix(u)[1]}${y.unit})` : y.label),
          values: (u, splits) => splits.map(chart.bars ? () => null : ticks(yPrefix(u)[0])),
          grid: {show: !chart.bars, stroke: colour("grid"), width: 1},
          labelSize: 20,
          size: roomFor,
          space: 36,
          ...(y.scale === "log" ? {splits: decades, filter: (u, splits) => splits} : {}),
        }),
      ],
      series: [
        {label: x.label, value: (u, value) => quantity(value, x.unit, x.least)},
        ...chart.series.map(({label, role}) => ({
          label,
          class: role,
          stroke: colour(role),
          ...pens[role],
          spanGaps: !joined,
          pxAlign: 0,
          points: role === "evaluations" ? {show: true, size: narrow ? 2.5 : 3.5, width: 0, fill: colour(role), space: 0}
            : {show: !joined, size: 5, width: 0, fill: colour(role), space: 0},
          ...(role === "evaluations" || chart.bars ? {paths: () => null} : {}),
          value: (u, value) => (chart.bars ? states[value] || "" : !joined && value > 0 ? value.toExponential(1) : quantity(value, y.unit, y.least)),
        })),
      ],
      hooks: {
        draw: [decorate(chart)],
        setCursor: [(u) => chart.group === "time" && u.cursor.left >= 0 && time.follow(u.posToVal(u.cursor.left, "x"))],
        setScale: [
          (u, key) => {
            const {min, max} = u.scales.x;
            const [low, high] = wanted.get(chart.id);
            if (key !== "x" || chart.group !== "time" || (min === low && max === high)) return;
            press(null);
            spread(() => [min, max]);
            for (const other of timeCharts()) drawn.get(other.id).setCursor({left: -10, top: -10}, false);
          },
        ],
      },
    };
  };

  // Charts of a group share one x axis, so that the cursor reads the same sample in each of them.
  const curve = (chart) => ({table, column: key}) => ({xs: tables[table][chart.x.column], ys: tables[table][key]});
  const groups = new Map();
  for (const chart of charts) {
    if (!chart.group) continue;
    if (!groups.has(chart.group)) groups.set(chart.group, {curves: [], extra: []});
    const {curves, extra} = groups.get(chart.group);
    curves.push(...chart.series.map(curve(chart)));
    extra.push(...grid(chart.x));
  }
  for (const group of groups.values()) group.aligned = aligned(group.curves, group.extra);
  const dataOf = (chart) => {
    if (!chart.group) return aligned(chart.series.map(curve(chart)), [], !isJoined(chart));
    const {aligned: all} = groups.get(chart.group);
    const first = charts.filter(({group}) => group === chart.group);
    const before = first.slice(0, first.indexOf(chart)).reduce((sum, {series}) => sum + series.length, 0);
    return [all[0], ...all.slice(1 + before, 1 + before + chart.series.length)];
  };

  const draw = () => {
    for (const u of drawn.values()) u.destroy();
    drawn.clear();
    for (const chart of charts) {
      const place = document.querySelector(`[data-chart="${chart.id}"]`);
      const data = dataOf(chart);
      const range = wanted.get(chart.id) || chart.x.home;
      wanted.set(chart.id, range);
      const u = new uPlot(options(chart, place.clientWidth, range), data, place);
      drawn.set(chart.id, u);
      u.over.tabIndex = 0;
      u.over.setAttribute("role", "application");
      u.over.setAttribute("aria-label", place.closest("figure").querySelector("h3").textContent + ": interactive chart");
      u.over.addEventListener("keydown", (event) => {
        const action = {
          ArrowLeft: () => step(chart, -1),
          ArrowRight: () => step(chart, 1),
          "+": () => zoom(chart, 0.5),
          "=": () => zoom(chart, 0.5),
          "-": () => zoom(chart, 2),
          0: () => goHome(chart),
          Escape: () => goHome(chart),
        }[event.key];
        if (!action) return;
        action();
        event.preventDefault();
      });
    }
  };

  makeCards();
  document.body.classList.add("drawn");
  draw();
  for (const tools of document.querySelectorAll(".tools")) tools.hidden = false;
  if (!drawn.has("landing")) document.querySelector("[data-view=landing]")?.remove();
  for (const button of document.querySelectorAll("[data-view]")) button.addEventListener("click", () => show(button.dataset.view));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  let width = innerWidth;
  addEventListener("resize", () => {
    if (innerWidth === width) return;
    width = innerWidth;
    for (const [id, u] of drawn) u.setSize({width: document.querySelector(`[data-chart="${id}"]`).clientWidth, height: u.height});
  });
  softland.time = time;
  const details = () => document.querySelectorAll("details");
  addEventListener("beforeprint", () => details().forEach((one) => (one.open = true)));
})();
