// Drawings of the live page: curves over time, the map over two numbers, the validated scenes.
const liveDrawings = (() => {
  "use strict";
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  const minus = (text) => String(text).replace("-", "−");
  const DASHES = { A: [2, 3], B: [7, 3], C: [], reference: [] };

  // values over ascending times, at others; null outside
  function resampled(times, values, at) {
    let k = 1;
    return at.map((t) => {
      if (t < times[0] || t > times[times.length - 1]) return null;
      while (k < times.length - 1 && times[k] < t) k += 1;
      const share = (t - times[k - 1]) / (times[k] - times[k - 1]);
      return values[k - 1] + share * (values[k] - values[k - 1]);
    });
  }

  // The panels of curves. `hidden` holds the sources that are switched off.
  class Curves {
    constructor(place, scene, models, hidden) {
      Object.assign(this, { place, scene, models, hidden, plots: [] });
      place.replaceChildren();
      scene.panels.forEach((panel, k) => this.add(panel, k === scene.panels.length - 1));
    }

    add(panel, isLast) {
      const series = [{}], bands = [], roles = [];
      const add = (role, options) => {
        series.push({ points: { show: false }, ...options });
        roles.push(role);
      };
      panel.curves.forEach(([body, name], number) => {
        if (this.scene.reference) {
          bands.push({ series: [series.length, series.length + 1], fill: () => colour("band") });
          for (const sign of [1, -1]) add({ source: "reference", name, sign }, { stroke: "transparent", width: 0 });
          add({ source: "reference", name, sign: 0 }, { stroke: () => colour("soft"), width: 2.4, label: `${body}, reference` });
        }
        for (const source of this.models) {
          add({ source, name }, { stroke: () => colour(source.toLowerCase()), dash: DASHES[source], width: number ? 1.3 : 1.8, label: `${body}, model ${source}` });
        }
      });
      const div = this.place.appendChild(document.createElement("div"));
      div.className = "live-plot";
      div.setAttribute("role", "img");
      div.setAttribute("aria-label", `${panel.label} over time in µs: ${panel.curves.map(([body]) => body).join(", ")}`);
      const font = "13px system-ui, sans-serif";
      const axis = { font, labelFont: font, labelSize: 20, labelGap: 0, stroke: () => colour("fg"), grid: { stroke: () => colour("grid"), width: 1 }, ticks: { stroke: () => colour("soft"), width: 1, size: 4 } };
      const plot = new uPlot({
        width: Math.max(this.place.clientWidth, 260), height: isLast ? 210 : 175, padding: [6, 10, 0, 0], legend: { show: false }, series, bands,
        cursor: { sync: { key: "live" }, drag: { x: true, y: false }, y: false },
        scales: { x: { time: false } },
        axes: [
          { ...axis, ...(isLast ? { label: "Time in µs", size: 26 } : { size: 6, values: () => [] }) },
          { ...axis, label: panel.label, size: 58, values: (_, splits) => splits.map((v) => minus(+v.toPrecision(6))) },
        ],
      }, [[0], ...roles.map(() => [null])], div);
      this.plots.push({ plot, panel, roles });
    }

    // Draws the curves of `results` (by model: {curves: {end, values}}) at `times` in s; the reference is sampled once for these.
    draw(times, results) {
      if (this.times !== times) Object.assign(this, { times, none: times.map(() => null), shown: times.map((t) => t * 1e6), sampled: new Map() });
      const of = (role, factor) => {
        if (this.hidden.has(role.source)) return this.none;
        const values = role.source === "reference" ? this.reference(role) : results[role.source]?.curves.values[role.name];
        return values?.map((v) => v == null ? null : v * factor) ?? this.none;
      };
      for (const { plot, panel, roles } of this.plots) plot.setData([this.shown, ...roles.map((role) => of(role, panel.factor))]);
    }

    // the reference's curve at the times that are drawn, or its band's bound above or below; undefined where it has none
    reference({ name, sign }) {
      const key = `${name} ${sign}`;
      if (!this.sampled.has(key)) {
        const { times, curves } = this.scene.reference, { values, band } = curves[name] ?? {};
        const bound = sign ? band && values?.map((v, k) => v + sign * band[k]) : values;
        this.sampled.set(key, bound && resampled(times, bound, this.times));
      }
      return this.sampled.get(key);
    }

    fit() {
      const width = Math.max(this.place.clientWidth, 260);
      for (const { plot } of this.plots) if (plot.width !== width) plot.setSize({ width, height: plot.height });
    }
  }

  // viridis by S. van der Walt and N. Smith, at five points
  const VIRIDIS = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
  function shade(share) {
    const place = Math.min(Math.max(share, 0), 1) * (VIRIDIS.length - 1), k = Math.min(Math.floor(place), VIRIDIS.length - 2);
    return `rgb(${VIRIDIS[k].map((v, c) => Math.round(v + (place - k) * (VIRIDIS[k + 1][c] - v))).join()})`;
  }

  // where `values` (rows of columns) pass through `level`: segments in cells, by linear interpolation
  function contour(values, level) {
    const segments = [];
    for (let row = 0; row + 1 < values.length; row += 1) {
      for (let column = 0; column + 1 < values[row].length; column += 1) {
        const corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(([x, y]) => [column + x, row + y, values[row + y][column + x]]);
        if (corners.some(([, , v]) => v == null)) continue;
        const crossings = [];
        corners.forEach(([x, y, v], k) => {
          const [x2, y2, w] = corners[(k + 1) % 4];
          if ((v < level) !== (w < level)) {
            const share = (level - v) / (w - v);
            crossings.push([x + share * (x2 - x), y + share * (y2 - y)]);
          }
        });
        for (let k = 0; k + 1 < crossings.length; k += 2) segments.push([crossings[k], crossings[k + 1]]);
      }
    }
    return segments;
  }

  // A map: `x`, `y` = {label, at: share -> shown number, here: share}; `values`, `ratios` rows of columns; `best` = [column, row].
  function drawMap(canvas, { x, y, values, ratios, best, whole }) {
    const ratio = devicePixelRatio || 1, width = canvas.parentElement.clientWidth, height = Math.min(380, Math.max(260, 0.55 * width));
    canvas.width = width * ratio;
    canvas.height = height * ratio;
    canvas.style.height = `${height}px`;
    const context = canvas.getContext("2d");
    context.scale(ratio, ratio);
    const box = { left: 76, top: 10, width: width - 76 - 92, height: height - 10 - 46 };
    const count = values.length;
    const known = values.flat().filter((v) => v != null);
    const [low, high] = [Math.min(...known), Math.max(...known)];
    const cell = [box.width / count, box.height / count];
    // the centre of a cell
    const place = ([column, row]) => [box.left + (column + 0.5) * cell[0], box.top + box.height - (row + 0.5) * cell[1]];
    context.fillStyle = colour("card");
    context.fillRect(box.left, box.top, box.width, box.height);
    values.forEach((line, row) => line.forEach((value, column) => {
      if (value == null) return;
      context.fillStyle = shade(high > low ? (value - low) / (high - low) : 0.5);
      context.fillRect(box.left + column * cell[0], box.top + box.height - (row + 1) * cell[1], cell[0] + 0.6, cell[1] + 0.6);
    }));
    const stroke = (points, style, width) => {
      context.strokeStyle = style;
      context.lineWidth = width;
      context.beginPath();
      points.forEach((point, k) => (k ? context.lineTo(...point) : context.moveTo(...point)));
      context.stroke();
    };
    for (const segment of whole ? contour(ratios, 0.5) : []) {
      stroke(segment.map(place), "#000", 3.5);
      stroke(segment.map(place), "#fff", 1.5);
    }
    const mark = (at, draw) => {
      context.beginPath();
      draw(...at);
      context.lineWidth = 4;
      context.strokeStyle = "#000";
      context.stroke();
      context.lineWidth = 2;
      context.strokeStyle = "#fff";
      context.stroke();
    };
    if (best) mark(place(best), (px, py) => { for (const [dx, dy] of [[7, 0], [0, 7]]) { context.moveTo(px - dx, py - dy); context.lineTo(px + dx, py + dy); } });
    const here = [box.left + x.here * box.width, box.top + (1 - y.here) * box.height];
    if ([x.here, y.here].every((share) => share >= 0 && share <= 1)) mark(here, (px, py) => context.arc(px, py, 6, 0, 7));
    context.fillStyle = colour("fg");
    context.font = "13px system-ui, sans-serif";
    context.textAlign = "center";
    for (const share of [0, 0.5, 1]) context.fillText(x.at(share), box.left + share * box.width, box.top + box.height + 17);
    context.fillText(x.label, box.left + box.width / 2, box.top + box.height + 38);
    context.textAlign = "right";
    for (const share of [0, 0.5, 1]) context.fillText(y.at(share), box.left - 6, box.top + (1 - share) * box.height + (share === 1 ? 10 : share ? 4 : 0));
    context.save();
    context.translate(14, box.top + box.height / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText(y.label, 0, 0);
    context.restore();
    // the scale of the colours
    const bar = box.left + box.width + 14;
    for (let k = 0; k < 60; k += 1) {
      context.fillStyle = shade(k / 59);
      context.fillRect(bar, box.top + box.height * (1 - (k + 1) / 60), 14, box.height / 60 + 0.6);
    }
    context.fillStyle = colour("fg");
    context.textAlign = "left";
    if (known.length) for (const [value, py] of [[high, box.top + 10], [low, box.top + box.height]]) context.fillText(minus(+value.toPrecision(3)), bar + 18, py);
    return box;
  }

  // Validated scenes of `model`: the measure `up` over the first one, on logarithmic axes; the ring is at `here`.
  function validated(scenes, model, names, up, here) {
    const own = scenes.filter((scene) => scene.model === model);
    const size = [380, 234], box = [52, 26, 318, 162];
    const places = [...own.map((scene) => scene.place), ...(here ? [here] : [])];
    const range = (k) => {
      const logs = places.map((place) => Math.log10(place[k]));
      return [Math.min(...logs) - 0.23, Math.max(...logs) + 0.23];
    };
    const [rx, ry] = [range(0), range(up)];
    const x = (v) => box[0] + ((Math.log10(v) - rx[0]) / (rx[1] - rx[0])) * box[2];
    const y = (v) => box[1] + (1 - (Math.log10(v) - ry[0]) / (ry[1] - ry[0])) * box[3];
    const parts = [];
    const element = (tag, attributes, text = "") => parts.push(`<${tag} ${Object.entries(attributes).map(([k, v]) => `${k}="${v}"`).join(" ")}>${text}</${tag}>`);
    element("rect", { x: box[0], y: box[1], width: box[2], height: box[3], fill: "none", stroke: "var(--line)" });
    for (const [[low, high], at, isUp] of [[rx, x, false], [ry, y, true]]) {
      for (let decade = Math.ceil(low); decade <= high; decade += 1) {
        const v = 10 ** decade, label = +v.toPrecision(1);
        element("line", isUp ? { x1: box[0], x2: box[0] + box[2], y1: at(v), y2: at(v), stroke: "var(--grid)" } : { x1: at(v), x2: at(v), y1: box[1], y2: box[1] + box[3], stroke: "var(--grid)" });
        element("text", isUp ? { x: box[0] - 5, y: at(v) + 4, "text-anchor": "end" } : { x: at(v), y: box[1] + box[3] + 16, "text-anchor": "middle" }, label);
      }
    }
    element("text", { x: box[0], y: 17 }, `<tspan font-weight="600">${model}</tspan>: ${names[up]}`);
    element("text", { x: box[0] + box[2] / 2, y: size[1] - 8, "text-anchor": "middle" }, names[0]);
    for (const { scene, place, off } of own) {
      const away = Math.abs(off), kind = away <= 0.01 ? "small" : away <= 0.05 ? "medium" : "large";
      element("circle", { cx: x(place[0]), cy: y(place[up]), r: kind === "small" ? 3.5 : kind === "medium" ? 4.5 : 5.5, class: `size-${kind}` }, `<title>${scene}: ${minus((100 * off).toPrecision(2))} %</title>`);
    }
    if (here) {
      const [left, right, top, bottom] = [x(here[0] / 2), x(here[0] * 2), y(here[up] * 2), y(here[up] / 2)];
      const clip = (v, low, high) => Math.min(Math.max(v, low), high);
      const [l, r] = [left, right].map((v) => clip(v, box[0], box[0] + box[2])), [t, b] = [top, bottom].map((v) => clip(v, box[1], box[1] + box[3]));
      element("rect", { x: l, y: t, width: r - l, height: b - t, fill: "none", stroke: "var(--fg)", "stroke-dasharray": "4 3" });
      element("circle", { cx: x(here[0]), cy: y(here[up]), r: 8, fill: "none", stroke: "var(--fg)", "stroke-width": 2, class: "here" });
    }
    const near = here ? own.filter(({ place }) => place.every((v, k) => Math.abs(Math.log(v / here[k])) <= Math.LN2)).length : 0;
    const label = `Model ${model}: ${names[up]} over ${names[0]}, ${own.length} scenes${here ? `; ${near} within a factor of 2 of the present numbers` : ""}`;
    return `<svg viewBox="0 0 ${size.join(" ")}" font-size="13" role="img" aria-label="${label}" fill="currentColor">${parts.join("")}</svg>`;
  }

  // The chamber in section with the paths of `flights`: [model, {corners, seats, path, radius}] in m.
  function flightPaths(flights) {
    const [, { corners, seats, radius }] = flights[0];
    const xs = corners.map(([x]) => x), left = Math.min(...xs), bottom = Math.min(...corners.map(([, z]) => z));
    const highest = Math.max(...flights.flatMap(([, { path }]) => path.map(([, z]) => z)), seats[0][1]);
    const top = Math.min(highest + 1.2 * radius, Math.max(...corners.map(([, z]) => z)));
    const margin = 8, width = 380, scale = (width - 2 * margin) / (Math.max(...xs) - left);
    const place = ([x, z]) => [margin + (x - left) * scale, margin + (top - z) * scale].map((v) => v.toFixed(1));
    // walls end where the picture does
    const line = (points) => points.map(([x, z]) => place([x, Math.min(z, top)]).join()).join(" ");
    const circle = ([x, z]) => {
      const [cx, cy] = place([x, z]);
      return `<circle cx="${cx}" cy="${cy}" r="${(radius * scale).toFixed(1)}" fill="none" stroke="var(--soft)" stroke-dasharray="4 3"/>`;
    };
    const paths = flights.map(([model, { path }]) => `<polyline points="${line(path)}" fill="none" stroke="var(--${model.toLowerCase()})" stroke-width="2" stroke-dasharray="${DASHES[model].join(" ")}" data-model="${model}"/>`);
    const height = 2 * margin + (top - bottom) * scale;
    const label = `Paths of the sphere in the chamber: ${flights.map(([model]) => `model ${model}`).join(", ")}`;
    return `<svg viewBox="0 0 ${width} ${height.toFixed(1)}" role="img" aria-label="${label}"><polygon points="${line(corners)}" fill="none" stroke="var(--fg)" stroke-width="1.5"/>${seats.map(circle).join("")}${paths.join("")}</svg>`;
  }

  return { Curves, drawMap, flightPaths, validated, minus };
})();
