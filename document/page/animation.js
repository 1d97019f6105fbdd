// Moves the switch of the report in time with the cursor of its charts.
(() => {
  "use strict";
  const {quantity, column, minus, time, noBreak} = softland;
  const figure = document.getElementById("figure-motion");
  if (!figure || !time || !time.range()) return;
  const {runs, contacts, bottom, perMetre, thick, layer, detail, bounce} = JSON.parse(figure.querySelector(".motion-data").textContent);
  const [play, speeds, slider, reads] = ["[data-play]", "select", "input", ".reads"].map((one) => figure.querySelector(one));
  const element = (parent, name, attributes = {}) => {
    const made = document.createElementNS(parent.namespaceURI, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    return parent.appendChild(made);
  };

  for (const run of runs) {
    run.time = column(run.time);
    run.rest = column(run.rest);
    run.amplitudes = run.amplitudes.map(column);
    run.shapes = run.shapes.map(column);
    const group = figure.querySelector(`.moving .${run.role}`);
    run.beam = element(group, "path", {class: "beam"});
    if (layer) run.layer = element(group, "path", {class: "piezo"});
    if (detail) run.tip = element(group, "rect", {class: "beam", x: detail.left, width: detail.wide, height: thick});
    run.read = contacts.map(({name}) => {
      const row = element(reads, "div", {class: run.role});
      element(row, "dt").textContent = [runs.length > 1 && run.label, contacts.length > 1 && name].filter(Boolean).join(", ") || "contact";
      return element(row, "dd");
    });
  }
  const clock = element(element(reads, "div", {class: "clock"}), "dd");
  reads.prepend(clock.parentNode);
  reads.hidden = false;

  // Returns the last index of an ascending list whose value is not above this one.
  const before = (list, value) => {
    let [low, high] = [0, list.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (list[middle] <= value) low = middle + 1;
      else high = middle;
    }
    return Math.max(0, low - 1);
  };
  // Returns the heights of the lower face at all places [m], interpolated linearly between the recorded instants.
  const heights = (run, at) => {
    const row = Math.min(before(run.time, at), run.time.length - 2);
    const whole = run.time[row + 1] - run.time[row];
    const share = whole > 0 ? Math.min(1, Math.max(0, (at - run.time[row]) / whole)) : 0;
    const now = run.amplitudes.map((mode) => mode[row] + share * (mode[row + 1] - mode[row]));
    return run.rest.map((rest, place) => now.reduce((sum, amplitude, mode) => sum - amplitude * run.shapes[mode][place], rest));
  };
  // Returns the outline of a band between two heights above the lower face, from one place to another [px].
  const band = (run, heights, low, high, from = -Infinity, to = Infinity) => {
    const edge = (above) =>
      run.x.flatMap((x, place) => (x >= from && x <= to ? [`${x} ${(bottom - perMetre * heights[place] - above).toFixed(3)}`] : []));
    return "M" + [...edge(low), ...edge(high).reverse()].join("L") + "Z";
  };
  // Returns 1 for a closed contact, 0 for an open one, and 0.5 for a stretch of many short touches.
  const state = (run, name) => {
    const table = time.tables[["closed", run.role, ...(contacts.length > 1 ? [name] : [])].join("/")];
    return table ? table.closed[before(table.time_s, now)] : null;
  };
  const words = {0: "open", 0.5: "closing and opening", 1: "closed"};

  let now = runs[0].time[0];
  let playing = 0;  // time of the last frame [ms]; 0 while the animation is paused
  const range = () => time.range();
  const draw = () => {
    for (const run of runs) {
      const all = heights(run, now);
      run.beam.setAttribute("d", band(run, all, 0, thick));
      if (layer) run.layer.setAttribute("d", band(run, all, thick, thick + layer.thick, layer.from, layer.to));
      contacts.forEach(({name, gap}, k) => {
        const place = run.places[k];
        const away = gap + (contacts[k].far ? -1 : 1) * (all[place] - run.rest[place]);
        const closed = state(run, name);
        run.read[k].textContent = [words[closed], quantity(away, "m", 1e-12, 3)].filter(Boolean).join(", ");
        if (run === runs[0]) figure.querySelector(`[data-contact="${k}"]`).classList.toggle("closed", closed > 0);
        if (k === 0 && detail) run.tip.setAttribute("y", (detail.plane - Math.min(detail.perMetre * away, detail.plane + thick) - thick).toFixed(3));
      });
    }
    clock.textContent = minus((1e6 * now).toFixed(3)) + noBreak + "µs";
    const [low, high] = range();
    slider.value = String((1000 * (now - low)) / (high - low));
    slider.setAttribute("aria-valuetext", clock.textContent + ", " + runs[0].read.map((one) => one.textContent).join(", "));
  };
  const go = (to) => {
    now = to;
    draw();
    time.point(now);
  };

  // The speeds reach from the whole run in ten seconds to its highest rebound in four seconds.
  const whole = Math.max(...runs.map((run) => run.time[run.time.length - 1]));
  const [fastest, slowest] = [whole / 10, Math.min(whole / 40, bounce / 4)];
  const steps = Math.max(1, Math.round(Math.log(fastest / slowest) / Math.log(4)));
  for (let k = 0; k <= steps; ++k) {
    const speed = fastest * (slowest / fastest) ** (k / steps);
    element(speeds, "option", {value: speed}).textContent = `${quantity(speed, "s", 0, 2)} per second`;
  }
  speeds.value = speeds.options[Math.min(1, steps)].value;

  const frame = (stamp) => {
    if (!playing) return;
    const [low, high] = range();
    const next = now + ((stamp - playing) / 1000) * speeds.value;
    playing = stamp;
    go(next > high || next < low ? low : next);
    requestAnimationFrame(frame);
  };
  const setPlaying = (on) => {
    playing = on ? performance.now() : 0;
    play.textContent = on ? "Pause" : "Play";
    if (on) requestAnimationFrame(frame);
  };
  play.addEventListener("click", () => setPlaying(!playing));
  slider.addEventListener("input", () => {
    setPlaying(false);
    const [low, high] = range();
    go(low + ((high - low) * slider.value) / 1000);
  });
  time.viewed = draw;
  time.follow = (at) => {
    if (playing) return;
    now = at;
    draw();
  };
  draw();
})();
