// The interactive panels of a scene's page: uPlot on the data in #curves. One time axis for all panels; below each one what
// the models are off the reference by, on a symmetric logarithmic axis; beside it the values under the cursor. Results, bodies
// and the reference's band can be switched off. Without this script the page shows its drawing instead.
(() => {
  "use strict";
  const data = JSON.parse(document.getElementById("curves").textContent);
  const root = document.getElementById("panels");
  if (!data.time.length || !root) return;

  const end = data.time[data.time.length - 1];
  const [reference, ...models] = data.sources;
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  const hidden = new Set();
  const plots = [], residuals = [], readouts = [];
  const make = (tag, properties = {}, ...children) => {
    const element = Object.assign(document.createElement(tag), properties);
    element.append(...children);
    return element;
  };
  const minus = (text) => text.replace("-", "−");

  // time axis, the same for all panels; uPlot itself keeps the cursors together
  let range = [0, end];
  let busy = false;
  function zoom(from, to) {
    const span = Math.min(Math.max(to - from, end / 500), end);
    const start = Math.min(Math.max(from, 0), end - span);
    range = [start, start + span];
    busy = true;
    for (const plot of [...plots, ...residuals]) plot.setScale("x", { min: range[0], max: range[1] });
    busy = false;
  }
  const zoomBy = (factor) => {
    const middle = (range[0] + range[1]) / 2, half = ((range[1] - range[0]) / 2) * factor;
    zoom(middle - half, middle + half);
  };
  const shift = (share) => {
    const step = share * (range[1] - range[0]);
    zoom(range[0] + step, range[1] + step);
  };

  const difference = (curve, { id }) => curve.values[id]?.map((v, k) => (v == null || curve.values[reference.id][k] == null ? null : v - curve.values[reference.id][k]));

  // tables of the values at the cursor, and of what they are off the reference by
  function readout(panel) {
    const cells = [];
    const body = make("tbody");
    const row = (curve, name, columns) => {
      const line = make("tr", {}, make("th", { scope: "row", textContent: name }));
      for (const { values, sign = "", digits, role } of columns) {
        const cell = make("td");
        if (role) Object.assign(cell.dataset, { curve: curve.name, ...role });
        cells.push([cell, values, sign, digits]);
        line.append(cell);
      }
      body.append(line);
    };
    for (const curve of panel.curves) {
      const values = data.sources.map(({ id }) => ({ values: curve.values[id], digits: panel.decimals, role: { source: id } }));
      row(curve, curve.body, [...values, { values: curve.band, sign: "± ", digits: panel.decimals }]);
      const off = models.map((model) => ({ values: difference(curve, model), digits: panel.decimals + 1, role: { residual: model.id } }));
      row(curve, "model − FE", [{}, ...off, {}]);
      body.lastChild.className = "off-by";
    }
    const head = make("tr", {}, make("th", { scope: "col", textContent: panel.label }));
    for (const name of [...data.sources.map((source) => source.short), "uncertainty (95 %)"]) head.append(make("th", { scope: "col", textContent: name }));
    const table = make("table", { className: "readout" }, make("thead", {}, head), body);
    const show = (index) => {
      for (const [cell, values, sign, digits] of cells) {
        const value = values?.[index];
        cell.textContent = value == null ? (digits == null ? "" : "–") : sign + minus(value.toFixed(digits));
      }
    };
    readouts.push(show);
    return table;
  }

  // name of each body beside its reference's curve, where no curve runs through it
  function drawNames(plot, panel) {
    const [from, to] = [plot.valToIdx(plot.scales.x.min), plot.valToIdx(plot.scales.x.max)];
    const context = plot.ctx, ratio = devicePixelRatio;
    const shown = panel.curves.filter((curve) => !hidden.has(curve.body));
    const y = (curve, source, k) => plot.valToPos(curve.values[source.id][k], "y", true);
    const x = (k) => plot.valToPos(data.time[k], "x", true);
    const lines = shown.flatMap((curve) => data.sources.filter(({ id }) => !hidden.has(id) && curve.values[id]).map((source) => [curve, source]));
    const taken = [];
    context.save();
    context.font = `${13 * ratio}px system-ui, sans-serif`;
    context.textAlign = "center";
    context.textBaseline = "middle";
    const step = Math.max(Math.round((to - from) / 150), 1);
    for (const curve of shown) {
      const half = context.measureText(curve.body).width / 2, height = 14 * ratio;
      let best = { score: -Infinity };
      for (let k = from; k <= to; k += step) {
        const middle = x(k), own = y(curve, reference, k);
        if (middle - half < plot.bbox.left + 4 || middle + half > plot.bbox.left + plot.bbox.width - 4 || !Number.isFinite(own)) continue;
        for (const away of [-12, 12, -18, 18, -26, 26]) {
          const place = own + away * ratio;
          if (place - height / 2 < plot.bbox.top || place + height / 2 > plot.bbox.top + plot.bbox.height) continue;
          if (taken.some(([a, b, c]) => Math.abs(a - middle) < half + c && Math.abs(b - place) < height)) continue;
          // free space to the curves of other bodies, and to its own, in the label's width
          let others = 30 * ratio, free = 3 * ratio;
          for (let j = k; x(j) < middle + half && j <= to; j += step) edges(j);
          for (let j = k; x(j) > middle - half && j >= from; j -= step) edges(j);
          function edges(j) {
            for (const [line, source] of lines) {
              const gap = Math.abs(y(line, source, j) - place) - height / 2;
              if (line === curve) free = Math.min(free, gap);
              else others = Math.min(others, gap);
            }
          }
          const score = 3 * Math.min(others, 12 * ratio) + 2 * free + 0.2 * others - 0.3 * Math.abs(away);
          if (score > best.score) best = { score, place, middle, half };
        }
      }
      if (best.place == null) continue;
      taken.push([best.middle, best.place, best.half]);
      context.fillStyle = colour("fg");
      context.fillText(curve.body, best.middle, best.place);
    }
    context.restore();
    plot.names = taken;
  }

  function axis(extra) {
    const font = "13px system-ui, sans-serif";
    const strokes = { stroke: () => colour("fg"), grid: { stroke: () => colour("grid"), width: 1 } };
    return { font, labelFont: font, labelSize: 20, labelGap: 0, ticks: { stroke: () => colour("soft"), width: 1, size: 4 }, ...strokes, ...extra };
  }

  // curves, or with `off` the models' residuals
  function plotOf(place, panel, off, extra) {
    const series = [{}], columns = [data.time], bands = [], roles = [[]];
    const add = (role, options, values) => {
      series.push({ points: { show: false }, ...options });
      columns.push(values);
      roles.push(role);
      return series.length - 1;
    };
    for (const curve of panel.curves) {
      const middle = curve.values[reference.id];
      if (curve.band) {
        const edge = (sign) => middle.map((v, k) => (v == null ? null : (off ? 0 : v) + sign * curve.band[k]));
        const [high, low] = [1, -1].map((sign) => add(["band", curve.body], { stroke: "transparent", width: 0 }, edge(sign)));
        bands.push({ series: [high, low], fill: () => colour("band") });
      }
      for (const source of off ? models : data.sources) {
        const options = { label: `${curve.body}, ${source.name}`, stroke: () => colour(source.colour), dash: source.dash, width: off ? 1.2 : source.width };
        add([source.id, curve.body], options, off ? difference(curve, source) : curve.values[source.id]);
      }
    }
    const options = {
      width: 640,
      padding: [6, 10, 0, 0],
      legend: { show: false },
      series,
      bands,
      cursor: { sync: { key: "time", setSeries: false }, drag: { x: true, y: false, dist: 4 }, y: false, points: { show: !off } },
      ...extra,
      scales: { x: { time: false, min: 0, max: end }, ...extra.scales },
      hooks: {
        ...extra.hooks,
        setScale: [(plot, key) => {
          const { min, max } = plot.scales.x;
          if (key === "x" && !busy && plots.length && min != null && (min !== range[0] || max !== range[1])) zoom(min, max);
        }],
      },
    };
    const plot = new uPlot(options, columns, place);
    plot.roles = roles;
    return plot;
  }

  // the largest residual, with the axis linear below a thousandth of it
  function residualAxis(panel) {
    const all = panel.curves.flatMap((curve) => [...models.map((model) => difference(curve, model) ?? []), curve.band ?? []]);
    const largest = Math.max(1e-300, ...all.map((values) => values.reduce((most, v) => Math.max(most, Math.abs(v ?? 0)), 0)));
    const decade = 10 ** Math.floor(Math.log10(largest));
    return { linear: 1e-3 * largest, limit: 1.15 * largest, marks: [-decade, 0, decade] };
  }

  function panelOf(panel, number) {
    const last = number === data.panels.length - 1;
    const place = make("div", { className: "plot" });
    place.setAttribute("role", "img");
    place.setAttribute("aria-label", `${panel.label} over time in µs, and below it the models less the reference: ${panel.curves.map((c) => c.body).join(", ")}`);
    const table = make("div", { className: "scroll", tabIndex: 0 }, readout(panel));
    table.setAttribute("role", "region");
    table.setAttribute("aria-label", `Values under the cursor, ${panel.label}`);
    root.append(make("div", { className: "panel" }, place, table));
    const size = 56, blank = () => [];
    plots.push(plotOf(place, panel, false, {
      height: 150,
      axes: [
        axis({ size: 6, values: blank }),
        axis({ label: panel.label, size, values: (_, splits) => splits.map((v) => minus(String(+v.toPrecision(6)))) }),
      ],
      hooks: {
        draw: [(plot) => drawNames(plot, panel)],
        setCursor: [(plot) => { if (number === 0) moved(plot.cursor.idx); }],
      },
    }));
    if (!models.length) return;
    const { linear, limit, marks } = residualAxis(panel);
    residuals.push(plotOf(place, panel, true, {
      height: last ? 118 : 84,
      scales: { y: { distr: 4, asinh: linear, range: [-limit, limit] } },
      axes: [
        axis(last ? { label: "Time in µs", size: 26 } : { size: 6, values: blank }),
        axis({ label: "model − FE", size, splits: () => marks, filter: (_, splits) => splits, values: (_, splits) => splits.map((v) => minus(String(+v.toPrecision(3)))) }),
      ],
      hooks: {},
    }));
  }

  // switches
  const controls = document.getElementById("controls");
  const apply = () => {
    for (const plot of [...plots, ...residuals]) plot.roles.forEach((role, k) => {
      const show = !role.some((name) => hidden.has(name));
      if (k && plot.series[k].show !== show) plot.setSeries(k, { show });
    });
    // markers go with their curves
    show(Number(cursor.value));
  };
  const toggle = (id, name, sample = "") => {
    const box = make("input", { type: "checkbox", checked: true });
    box.dataset.source = id;
    box.addEventListener("change", () => {
      box.checked ? hidden.delete(id) : hidden.add(id);
      apply();
    });
    return make("label", {}, box, sample, ` ${name}`);
  };
  const sample = (dash, className) => {
    const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    svg.setAttribute("viewBox", "0 0 30 10");
    svg.setAttribute("aria-hidden", "true");
    const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
    path.setAttribute("d", "M0 5H30");
    path.setAttribute("class", className);
    path.setAttribute("stroke-dasharray", dash);
    svg.append(path);
    return svg;
  };
  for (const source of data.sources) controls.append(toggle(source.id, source.name, sample(source.dash.join(" ") || "none", source.class)));
  if (data.panels.some((panel) => panel.curves.some((curve) => curve.band))) controls.append(toggle("band", "uncertainty (95 %)", sample("none", "band-sample")));
  for (const body of new Set(data.panels.flatMap((panel) => panel.curves.map((curve) => curve.body)))) controls.append(toggle(body, body));

  const button = (name, action) => {
    const element = make("button", { type: "button", textContent: name });
    element.addEventListener("click", action);
    return element;
  };
  const cursor = make("input", { type: "range", min: 0, max: data.time.length - 1, value: 0, step: 1 });
  const instant = make("output", { textContent: "–" });
  // where the pointer leaves, the last instant stays
  function moved(index) {
    if (index == null) return;
    cursor.value = index;
    instant.textContent = `t = ${data.time[index].toFixed(2)} µs`;
    for (const show of readouts) show(index);
  }
  function show(index) {
    const time = data.time[index];
    if (time < range[0] || time > range[1]) zoom(time - (range[1] - range[0]) / 2, time + (range[1] - range[0]) / 2);
    for (const plot of [...plots, ...residuals]) plot.setCursor({ left: plot.valToPos(time, "x"), top: 0 });
    moved(index);
  }
  cursor.addEventListener("input", () => show(Number(cursor.value)));
  document.getElementById("time").append(
    make("label", { className: "instant" }, "Time ", cursor), instant,
    button("zoom in", () => zoomBy(0.5)), button("zoom out", () => zoomBy(2)),
    button("earlier", () => shift(-0.5)), button("later", () => shift(0.5)), button("all", () => zoom(0, end)),
  );

  document.documentElement.classList.add("interactive");
  data.panels.forEach(panelOf);
  const fit = () => {
    const width = Math.max(root.querySelector(".plot").clientWidth, 260);
    for (const plot of [...plots, ...residuals]) if (plot.width !== width) plot.setSize({ width, height: plot.height });
  };
  fit();
  // the tables beside the plots grow with their numbers, and the plots give way
  const watch = new ResizeObserver(fit);
  for (const part of [root, root.querySelector(".plot")]) watch.observe(part);
  // the tables begin with the instant of the largest force
  const force = data.panels[data.panels.length - 1].curves[0].values[reference.id];
  const peak = force.indexOf(Math.max(...force.filter((v) => v != null)));
  // uPlot draws and scales in a microtask
  setTimeout(() => show(peak));
  root.addEventListener("mouseleave", () => setTimeout(() => show(Number(cursor.value))));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => [...plots, ...residuals].forEach((plot) => plot.redraw(false)));
  window.impactcheck = { plots, residuals, zoom, range: () => range };
})();
