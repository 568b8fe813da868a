// The interactive panels of a scene's page: uPlot on the data in #curves. One time axis for all panels, values under
// the cursor, results and the reference's band on and off. Without this script the page shows its drawing instead.
(() => {
  "use strict";
  const data = JSON.parse(document.getElementById("curves").textContent);
  const root = document.getElementById("panels");
  if (!data.time.length || !root) return;

  const end = data.time[data.time.length - 1];
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  const line = (source) => colour(source.colour);
  const hidden = new Set();
  const plots = [];
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
    for (const plot of plots) plot.setScale("x", { min: range[0], max: range[1] });
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

  // table of the values at the cursor
  function readout(panel) {
    const cells = [];
    const head = make("tr", {}, make("th", { scope: "col", textContent: panel.label }));
    for (const source of data.sources) head.append(make("th", { scope: "col", textContent: source.short }));
    head.append(make("th", { scope: "col", textContent: "95 % band" }));
    const body = make("tbody");
    for (const curve of panel.curves) {
      const row = make("tr", {}, make("th", { scope: "row", textContent: curve.body }));
      for (const source of data.sources) {
        const cell = make("td", { textContent: "–" });
        cell.dataset.curve = curve.name;
        cell.dataset.source = source.id;
        cells.push([cell, curve.values[source.id], ""]);
        row.append(cell);
      }
      const cell = make("td", { textContent: "–" });
      cells.push([cell, curve.band, "± "]);
      row.append(cell);
      body.append(row);
    }
    const table = make("table", { className: "readout" }, make("thead", {}, head), body);
    const show = (index) => {
      for (const [cell, values, sign] of cells) {
        const value = index == null || !values ? null : values[index];
        cell.textContent = value == null ? "–" : sign + minus(value.toFixed(panel.decimals));
      }
    };
    return { table, show };
  }

  // name of each body where its reference curve is farthest from the others
  function drawNames(plot, panel) {
    const [from, to] = [plot.valToIdx(plot.scales.x.min), plot.valToIdx(plot.scales.x.max)];
    const context = plot.ctx;
    const y = (curve, k) => plot.valToPos(curve.values[data.sources[0].id][k], "y", true);
    context.save();
    context.font = `${13 * devicePixelRatio}px system-ui, sans-serif`;
    context.textAlign = "center";
    context.textBaseline = "bottom";
    context.lineWidth = 4 * devicePixelRatio;
    context.lineJoin = "round";
    for (const curve of panel.curves) {
      let best = null;
      for (let s = 0.08; s < 0.93; s += 0.02) {
        const k = Math.round(from + s * (to - from));
        const others = panel.curves.filter((c) => c !== curve).map((c) => Math.abs(y(c, k) - y(curve, k)));
        const room = Math.min(...others);
        if (Number.isFinite(room) && (!best || room > best.room + 1)) best = { room, k };
      }
      if (!best) continue;
      // on the side where the next curve is farther away
      const own = y(curve, best.k), others = panel.curves.filter((c) => c !== curve).map((c) => y(c, best.k) - own);
      const above = Math.min(own - plot.bbox.top, ...others.filter((d) => d < 0).map((d) => -d));
      const below = Math.min(plot.bbox.top + plot.bbox.height - own, ...others.filter((d) => d > 0));
      const shift = (above >= below ? -4 : 20) * devicePixelRatio;
      const place = [curve.body, plot.valToPos(data.time[best.k], "x", true), own + shift];
      context.strokeStyle = colour("bg");
      context.strokeText(...place);
      context.fillStyle = colour("fg");
      context.fillText(...place);
    }
    context.restore();
  }

  function axis(extra) {
    const font = "13px system-ui, sans-serif";
    const strokes = { stroke: () => colour("fg"), grid: { stroke: () => colour("grid"), width: 1 } };
    return { font, labelFont: font, ticks: { stroke: () => colour("soft"), width: 1, size: 5 }, ...strokes, ...extra };
  }

  function panelOf(panel, number) {
    const series = [{}], columns = [data.time], bands = [], roles = [null];
    const add = (role, options, values) => {
      series.push({ points: { show: false }, ...options });
      columns.push(values);
      roles.push(role);
      return series.length - 1;
    };
    for (const curve of panel.curves) {
      const reference = curve.values[data.sources[0].id];
      if (curve.band) {
        const edge = (sign) => reference.map((v, k) => (v == null ? null : v + sign * curve.band[k]));
        const [high, low] = [1, -1].map((sign) => add("band", { stroke: "transparent", width: 0 }, edge(sign)));
        bands.push({ series: [high, low], fill: () => colour("band") });
      }
      for (const source of data.sources) {
        const options = { label: `${curve.body}, ${source.name}`, stroke: () => line(source), dash: source.dash, width: source.width };
        add(source.id, options, curve.values[source.id]);
      }
    }
    const table = readout(panel);
    const place = make("div", { className: "plot" });
    place.setAttribute("role", "img");
    place.setAttribute("aria-label", `${panel.label} over time in µs: ${panel.curves.map((c) => c.body).join(", ")}`);
    const last = number === data.panels.length - 1;
    const options = {
      width: 640,
      height: last ? 262 : 230,
      padding: [8, 12, 0, 0],
      legend: { show: false },
      scales: { x: { time: false, min: 0, max: end } },
      series,
      bands,
      axes: [
        axis({ label: last ? "Time in µs" : undefined, labelSize: 22, size: 30 }),
        axis({ label: panel.label, labelSize: 22, size: 58, values: (_, splits) => splits.map((v) => minus(String(+v.toPrecision(6)))) }),
      ],
      cursor: { sync: { key: "time", setSeries: false }, drag: { x: true, y: false, dist: 4 }, y: false },
      hooks: {
        draw: [(plot) => drawNames(plot, panel)],
        setCursor: [(plot) => {
          table.show(plot.cursor.idx);
          if (number === 0 && plot.cursor.idx != null) moved(plot.cursor.idx);
        }],
        setScale: [(plot, key) => {
          const { min, max } = plot.scales.x;
          if (key === "x" && !busy && plots.length && min != null && (min !== range[0] || max !== range[1])) zoom(min, max);
        }],
      },
    };
    root.append(place, make("div", { className: "scroll", tabIndex: 0 }, table.table));
    root.lastChild.setAttribute("role", "region");
    root.lastChild.setAttribute("aria-label", `Values under the cursor, ${panel.label}`);
    const plot = new uPlot(options, columns, place);
    plot.roles = roles;
    return plot;
  }

  // switches
  const controls = document.getElementById("controls");
  const toggle = (id, name, sample) => {
    const box = make("input", { type: "checkbox", checked: true });
    box.dataset.source = id;
    box.addEventListener("change", () => {
      box.checked ? hidden.delete(id) : hidden.add(id);
      for (const plot of plots) plot.roles.forEach((role, k) => role === id && plot.setSeries(k, { show: box.checked }));
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
  for (const source of data.sources) controls.append(toggle(source.id, source.name, sample(source.dash.join(" ") || "none", `fig-${source.id}`)));
  if (data.panels.some((panel) => panel.curves.some((curve) => curve.band))) controls.append(toggle("band", "95 % band of the reference", sample("none", "band-sample")));

  const button = (name, action) => {
    const element = make("button", { type: "button", textContent: name });
    element.addEventListener("click", action);
    return element;
  };
  const cursor = make("input", { type: "range", min: 0, max: data.time.length - 1, value: 0, step: 1 });
  const instant = make("output", { textContent: "–" });
  const moved = (index) => {
    cursor.value = index;
    instant.textContent = `t = ${data.time[index].toFixed(2)} µs`;
  };
  function show(index) {
    const time = data.time[index];
    if (time < range[0] || time > range[1]) zoom(time - (range[1] - range[0]) / 2, time + (range[1] - range[0]) / 2);
    for (const plot of plots) plot.setCursor({ left: plot.valToPos(time, "x"), top: 0 });
    moved(index);
  }
  cursor.addEventListener("input", () => show(Number(cursor.value)));
  document.getElementById("time").append(
    make("label", { className: "instant" }, "Time ", cursor), instant,
    button("zoom in", () => zoomBy(0.5)), button("zoom out", () => zoomBy(2)),
    button("earlier", () => shift(-0.5)), button("later", () => shift(0.5)), button("all", () => zoom(0, end)),
  );

  document.documentElement.classList.add("interactive");
  data.panels.forEach((panel, number) => plots.push(panelOf(panel, number)));
  const fit = () => {
    const width = Math.max(root.clientWidth, 260);
    for (const plot of plots) if (plot.width !== width) plot.setSize({ width, height: plot.height });
  };
  fit();
  new ResizeObserver(fit).observe(root);
  // the tables begin with the instant of the largest force
  const force = data.panels[data.panels.length - 1].curves[0].values[data.sources[0].id];
  const peak = force.indexOf(Math.max(...force.filter((v) => v != null)));
  // uPlot draws and scales in a microtask
  setTimeout(() => show(peak));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => plots.forEach((plot) => plot.redraw(false)));
  window.impactcheck = { plots, zoom, range: () => range };
})();
