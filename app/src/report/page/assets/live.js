// The live page: fields of a scene, and what the models give for them. Models run in three workers, so that dragging never
// waits: one for models A and B, one for C, one for the map and the sensitivities. Quick results first; estimates of errors,
// warnings and the prediction follow when the numbers rest.
(async () => {
  "use strict";
  const { Curves, drawMap, flightPaths, validated, minus } = liveDrawings;
  const byId = (id) => document.getElementById(id);
  const page = JSON.parse(byId("live").textContent);
  const SAMPLES = 400, REST = 200, CELLS = 24;
  const make = (tag, properties = {}, ...children) => {
    const element = Object.assign(document.createElement(tag), properties);
    element.append(...children);
    return element;
  };
  const failed = (text) => {
    byId("failure").textContent = text;
    byId("failure").hidden = !text;
  };

  async function unpacked(text) {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
  }
  let module;
  try {
    module = await WebAssembly.compile(await unpacked(byId("models").textContent.trim()));
  } catch (error) {
    failed(`This browser can't run the models (it needs WebAssembly with SIMD and DecompressionStream, as browsers of 2023 have): ${error.message}`);
    return;
  }
  const source = URL.createObjectURL(new Blob([byId("worker").textContent], { type: "text/javascript" }));

  // A worker that answers one request after the other. Of waiting requests with the same key only the last one is answered.
  class Models {
    constructor() {
      Object.assign(this, { waiting: new Map(), opening: null, running: null });
      this.start();
    }

    start() {
      this.worker = new Worker(source);
      const { worker } = this;
      worker.onmessage = ({ data }) => { if (worker === this.worker) this.answered(data); };
      this.worker.postMessage({ module });
    }

    // Takes a scene; what waits or runs is of no use any more.
    open(request) {
      this.opening = request;
      this.waiting.clear();
      if (this.running) {
        this.worker.terminate();
        Object.assign(this, { running: null, skip: false });
        this.start();
      }
      return new Promise((done) => this.ask("open", request, done));
    }

    ask(key, request, done) {
      this.waiting.set(key, { request, done });
      if (!this.running) this.next();
    }

    // Forgets waiting requests whose key begins so.
    cancel(...begins) {
      for (const key of this.waiting.keys()) if (begins.some((begin) => key.startsWith(begin))) this.waiting.delete(key);
    }

    next() {
      const [entry] = this.waiting;
      this.running = entry?.[1] ?? null;
      if (!entry) return;
      this.waiting.delete(entry[0]);
      this.worker.postMessage({ request: this.running.request });
    }

    answered(answer) {
      const { done, request } = this.running;
      if (answer.broken) {
        this.worker.terminate();
        this.start();
        if (request !== this.opening) this.worker.postMessage({ request: this.opening }), this.skip = true;
      } else if (this.skip) {
        this.skip = false;
        this.next();
        return;
      }
      done(answer);
      if (!this.skip) this.next();
    }
  }
  const [quick, slow, aside] = [new Models(), new Models(), new Models()];
  const workerOf = (model) => (model === "C" ? slow : quick);

  // numbers as people read them: [unit of the scene language, shown unit, factor from SI]
  const PREFIXES = {
    m: [["um", "µm", 1e6, 1e-3], ["mm", "mm", 1e3, 1], ["m", "m", 1, Infinity]],
    "m/s": [["mm/s", "mm/s", 1e3, 0.1], ["m/s", "m/s", 1, Infinity]],
    s: [["us", "µs", 1e6, 1e-3], ["ms", "ms", 1e3, 1], ["s", "s", 1, Infinity]],
    Pa: [["Pa", "Pa", 1, 1e6], ["MPa", "MPa", 1e-6, 1e9], ["GPa", "GPa", 1e-9, Infinity]],
    N: [["mN", "mN", 1e3, 0.1], ["N", "N", 1, Infinity]],
    J: [["uJ", "µJ", 1e6, 1e-3], ["mJ", "mJ", 1e3, 1], ["J", "J", 1, Infinity]],
    Hz: [["Hz", "Hz", 1, 1e3], ["kHz", "kHz", 1e-3, Infinity]],
    "N*s": [["mN*s", "mN s", 1e3, 1], ["N*s", "N s", 1, Infinity]],
    kg: [["mg", "mg", 1e6, 1e-3], ["g", "g", 1e3, 1], ["kg", "kg", 1, Infinity]],
    rad: [["deg", "°", 180 / Math.PI, Infinity]],
    F: [["uF", "µF", 1e6, 1e-3], ["F", "F", 1, Infinity]],
    "m^2": [["mm^2", "mm²", 1e6, 1], ["m^2", "m²", 1, Infinity]],
    "Pa*s": [["mPa*s", "mPa s", 1e3, 0.1], ["Pa*s", "Pa s", 1, Infinity]],
    "1": [["", "", 1, Infinity]],
  };
  const prefix = (unit, size) => {
    const [written, shown, factor] = (PREFIXES[unit] ?? [[unit, unit, 1, Infinity]]).find(([, , , below]) => Math.abs(size) < below) ?? [unit, unit, 1];
    return { written, shown, factor };
  };
  const digits = (value, count) => {
    if (value == null || !Number.isFinite(value)) return "–";
    const size = Math.abs(value);
    return minus(size !== 0 && (size < 1e-4 || size >= 1e7) ? value.toExponential(count - 1) : String(+value.toPrecision(count)));
  };
  const withUnit = (value, unit, count, size = value) => {
    if (value == null || !Number.isFinite(value)) return "–";
    const { shown, factor } = prefix(unit, size);
    return `${digits(value * factor, count)}${shown && shown !== "°" ? " " : ""}${shown}`;
  };

  const state = { scene: null, fields: [], models: [], numbers: {}, locks: new Set(), hidden: new Set(), results: {}, estimated: {}, end: 0, measures: [] };
  const answered = [];
  let curves, rows, mapRun = 0, rest, isPlaced = false;
  // milliseconds from an input to its drawn curves, of the last answers that were drawn, by model
  const latest = {};
  const value = (field) => state.numbers[field.path] ?? field.value;
  const changed = () => Object.fromEntries(state.fields.filter((field) => value(field) !== field.value).map((field) => [field.path, value(field)]));
  // the axis of the curves: the same array until its end moves
  let axis = [];
  const times = () => {
    if (axis[SAMPLES - 1] !== state.end) axis = Array.from({ length: SAMPLES }, (_, k) => (k === SAMPLES - 1 ? state.end : (state.end * k) / (SAMPLES - 1)));
    return axis;
  };

  // fields: a slider over the range around the scene's value, and a box for any number with a unit
  function range(field) {
    const now = value(field), start = field.value || now;
    const clipped = (low, high) => [Math.max(low, field.low), Math.min(high, field.high)];
    if (field.count) return { low: Math.max(field.low, 1), high: Math.min(field.high, Math.max(4 * now, 4 * start, 10)), log: false };
    if (start > 0 && field.low >= 0 && field.high <= 1) return { low: field.low, high: field.high, log: false };
    if (start > 0) {
      const [low, high] = clipped(Math.min(start, now) / 4, Math.max(start, now) * 4);
      return { low, high, log: low > 0 };
    }
    const reach = 4 * Math.max(Math.abs(start), Math.abs(now)) || { m: 1e-4, "m/s": 1, rad: 0.5 }[field.unit] || 1;
    const [low, high] = clipped(-reach, reach);
    return { low, high, log: false };
  }
  const share = (field, v) => {
    const { low, high, log } = field.range;
    return log ? Math.log(v / low) / Math.log(high / low) : (v - low) / (high - low);
  };
  const at = (field, part) => {
    const { low, high, log } = field.range;
    const v = log ? low * (high / low) ** part : low + part * (high - low);
    return field.count ? Math.round(v) : +v.toPrecision(4);
  };
  const text = (field) => {
    const v = value(field), { written, factor } = prefix(field.unit, v || field.value);
    return `${+(v * factor).toPrecision(12)}${written ? " " : ""}${written}`;
  };

  function build() {
    const groups = new Map();
    for (const field of state.fields) {
      const cut = field.path.lastIndexOf(".");
      const group = field.path.slice(0, cut).replace("materials.", "material ").replace(".", " ") || "scene";
      if (!groups.has(group)) groups.set(group, make("fieldset", {}, make("legend", { textContent: group })));
      groups.get(group).append(row(field, field.path.slice(cut + 1).replaceAll("_", " ")));
    }
    // bodies first, what they are made of last
    const ordered = [...groups].sort(([a], [b]) => a.startsWith("material ") - b.startsWith("material "));
    byId("fields").replaceChildren(...ordered.map(([, group]) => group));
  }

  function row(field, name) {
    const id = `field-${field.path}`;
    const box = make("input", { type: "text", id, autocomplete: "off", spellcheck: false });
    const slider = make("input", { type: "range", min: 0, max: 1000, step: 1 });
    slider.setAttribute("aria-label", `${field.path}, slider`);
    const lock = make("button", { type: "button", className: "lock", title: "Locked numbers change by the same factor" });
    lock.innerHTML = '<svg viewBox="0 0 16 16" aria-hidden="true"><rect x="3" y="7" width="10" height="7" rx="1.5"/><path d="M5 7V5a3 3 0 0 1 6 0v2"/></svg>';
    lock.setAttribute("aria-label", `lock ${field.path}`);
    lock.setAttribute("aria-pressed", state.locks.has(field.path));
    const why = make("p", { className: "why", id: `${id}-why`, hidden: true });
    box.setAttribute("aria-describedby", why.id);
    const depends = make("span", { className: "depends" });
    Object.assign(field, { box, slider, why, depends });
    const refuse = (reason) => {
      why.textContent = reason;
      why.hidden = !reason;
      box.setAttribute("aria-invalid", Boolean(reason));
    };
    box.addEventListener("change", () => {
      const written = box.value.trim();
      const unit = prefix(field.unit, value(field) || field.value).written;
      const withItsUnit = /^[-+]?[\d.]+(e[-+]?\d+)?$/i.test(written) ? `${written}${unit ? ` ${unit}` : ""}` : written;
      quick.ask(`parse ${field.path}`, { do: "parse", field: field.path, text: withItsUnit }, (answer) => {
        refuse(answer.error ?? "");
        if (answer.ok != null) set(field, answer.ok);
      });
    });
    slider.addEventListener("input", () => {
      refuse("");
      set(field, at(field, slider.value / 1000), true);
    });
    slider.addEventListener("change", () => show(field));
    lock.addEventListener("click", () => {
      const locked = !state.locks.has(field.path);
      locked ? state.locks.add(field.path) : state.locks.delete(field.path);
      lock.setAttribute("aria-pressed", locked);
    });
    show(field);
    return make("div", { className: "field" }, make("label", { htmlFor: id, textContent: name, title: field.about }), box, lock, slider, depends, why);
  }

  function show(field, dragged = false) {
    field.box.value = text(field);
    // it stays while the slider moves
    if (!dragged) field.range = range(field);
    if (!dragged) field.slider.value = Math.round(1000 * share(field, value(field)));
    field.slider.setAttribute("aria-valuetext", text(field));
  }

  function set(field, number, dragged = false) {
    const before = value(field), factor = number / before;
    state.numbers[field.path] = number;
    show(field, dragged);
    if (state.locks.has(field.path) && Number.isFinite(factor) && factor > 0) {
      const others = state.fields.filter((other) => other !== field && state.locks.has(other.path) && !other.count);
      const moved = others.map((other) => +(value(other) * factor).toPrecision(14));
      // the ratios stay: at a bound none of them goes on
      if (others.some((other, k) => moved[k] < other.low || moved[k] > other.high)) {
        state.numbers[field.path] = before;
        show(field);
        return;
      }
      others.forEach((other, k) => {
        state.numbers[other.path] = moved[k];
        show(other);
      });
    }
    update();
  }

  // The latest numbers to all models: quickly now, with all estimates when they rest.
  function update() {
    clearTimeout(rest);
    const since = performance.now();
    mapRun += 1;
    failed("");
    aside.cancel("map", "sensitivity");
    for (const models of [quick, slow]) models.cancel("run");
    byId("status").textContent = "Computing …";
    for (const model of state.models) request(model, "course", since);
    rest = setTimeout(settle, REST);
  }

  function settle() {
    for (const model of state.models) request(model, "run");
    sensitivities();
    map();
    address();
  }

  function request(model, how, since) {
    const numbers = changed(), of = JSON.stringify(numbers), end = state.end || null;
    workerOf(model).ask(`${how} ${model}`, { do: how, model, numbers, end, samples: SAMPLES }, (answer) => {
      if (answer.error) {
        delete state.results[model];
        state.estimated[model] = { error: answer.error, of };
      } else {
        state.results[model] = answer.ok;
        Object.assign(answer.ok, { of, sampled: end });
        if (how === "run") state.estimated[model] = answer.ok;
        else if (state.estimated[model]?.error) delete state.estimated[model];
        follow();
      }
      isPlaced &&= how === "course" && !answer.error;
      answered.push({ model, since, isWhole: how === "run" || Boolean(answer.error) });
      if (answered.length === 1) requestAnimationFrame(drawAnswers);
    });
  }

  // All that was answered since the last frame, at once.
  function drawAnswers() {
    const drawn = answered.splice(0);
    draw(drawn.some(({ isWhole }) => isWhole));
    for (const { model, since } of drawn) if (since) latest[model] = [...(latest[model] ?? []).slice(-199), performance.now() - since];
  }

  // The time axis follows the longest impact of all models, once all have answered for the same numbers; curves of another axis
  // are requested again.
  function follow() {
    const now = JSON.stringify(changed());
    const current = state.models.filter((model) => [state.results[model], state.estimated[model]].some((one) => one?.of === now));
    if (current.length < state.models.length && state.end) return;
    const end = Math.max(...state.models.map((model) => state.results[model]?.curves.end ?? 0));
    if (end > 0 && !(state.end && end <= 1.05 * state.end && end >= 0.4 * state.end)) state.end = 1.02 * end;
    for (const model of state.models) {
      const one = state.results[model];
      if (one && one.sampled !== state.end && one.requested !== state.end) {
        one.requested = state.end;
        request(model, one.summary ? "run" : "course");
      }
    }
  }

  // While numbers move, curves and numbers alone are drawn.
  function draw(isWhole) {
    const drawn = Object.fromEntries(Object.entries(state.results).filter(([, { sampled }]) => sampled === state.end));
    if (state.end) curves.draw(times(), drawn);
    const now = JSON.stringify(changed());
    table(now);
    const isOld = state.models.some((model) => state.estimated[model]?.of !== now);
    for (const id of ["warnings", "validated", "flight-section"]) byId(id).classList.toggle("old", isOld);
    if (!isWhole) return;
    notes(isOld);
    flights();
    // their place follows from whole runs alone
    if (!isPlaced) places();
    isPlaced = true;
  }

  function table(now) {
    const isCurrent = state.estimated.C?.of === now;
    const intervals = state.estimated.C?.prediction;
    const predicted = isCurrent && typeof intervals === "object" ? intervals : null;
    if (!rows || rows.scene !== state.scene || rows.isPredicted !== Boolean(predicted)) rows = emptyTable(Boolean(predicted));
    const reference = state.scene.reference?.values;
    for (const { quantity, cells } of rows.lines) {
      const values = state.models.map((model) => state.results[model]?.values[quantity.name]);
      const size = Math.max(...[...values, reference?.[quantity.name]?.[0]].map((v) => Math.abs(v ?? 0)));
      state.models.forEach((model, k) => {
        const v = values[k];
        cells[model].textContent = quantity.count && v != null ? String(v) : withUnit(v, quantity.unit, 5, size);
        cells[model].className = state.results[model]?.of === now ? "" : "old";
        cells[model].dataset.si = v ?? "";
      });
      if (reference) {
        const [v, band] = reference[quantity.name] ?? [];
        cells.reference.textContent = v == null ? "–" : `${withUnit(v, quantity.unit, 5, size)}${band == null ? "" : ` ± ${withUnit(band, quantity.unit, 2, size)}`}`;
      }
      if (predicted) {
        const one = predicted[quantity.name];
        cells.predicted.textContent = one ? `${withUnit(one.low, quantity.unit, 4, size)} to ${withUnit(one.high, quantity.unit, 4, size)}` : "–";
      }
    }
    const any = predicted && Object.values(predicted)[0];
    byId("prediction").textContent = !state.models.includes("C") || !state.estimated.C || !isCurrent ? "" : any
      ? `The intervals come from the errors of model C in ${any.scenes} solved scenes of the group “${any.stratum}”.`
      : typeof intervals === "string" ? `There is no interval of what a converged reference would find: ${intervals}.` : "";
  }

  // The table without numbers: its lines, and their cells by model, "reference" and "predicted".
  function emptyTable(isPredicted) {
    const columns = state.models.map((model) => [model, model, ""]);
    if (state.scene.reference) columns.push(["reference", "Reference of the original scene", "Value and 95 % band of the stored finite-element reference of the original scene"]);
    if (isPredicted) columns.push(["predicted", "A converged reference would find (95 %)", "Interval in which a finite-element reference of the present scene lies with 95 % probability"]);
    const heading = (textContent, title = "") => make("th", { scope: "col", textContent, title });
    const head = make("tr", {}, heading("Quantity"), ...columns.map(([, text, title]) => heading(text, title)));
    const lines = state.scene.quantities.map((quantity) => {
      const cells = Object.fromEntries(columns.map(([id]) => [id, make("td")]));
      for (const model of state.models) Object.assign(cells[model].dataset, { model, quantity: quantity.name });
      return { quantity, cells, row: make("tr", {}, make("th", { scope: "row", textContent: quantity.label, title: quantity.about }), ...Object.values(cells)) };
    });
    byId("results").replaceChildren(make("thead", {}, head), make("tbody", {}, ...lines.map(({ row }) => row)));
    return { scene: state.scene, isPredicted, lines };
  }

  // the quantity that stands for a result: the efficiency, if it exists
  const leading = () => {
    const has = ({ name }) => state.models.some((model) => state.results[model]?.values[name] != null);
    const { quantities } = state.scene;
    return quantities.find((quantity) => quantity.name === "efficiency" && has(quantity)) ?? quantities.find(has) ?? quantities[0];
  };

  function notes(isOld) {
    const warned = new Map();
    for (const model of state.models) {
      const { summary, error } = state.estimated[model] ?? {};
      for (const warning of error ? [error] : summary?.warnings ?? []) warned.set(warning, [...(warned.get(warning) ?? []), model]);
    }
    const lines = [...warned].map(([warning, models]) => make("li", { textContent: `${models.join(", ")}: ${warning}` }));
    const estimated = state.models.map((model) => [model, state.estimated[model]?.summary?.truncation_error]).filter(([, error]) => error != null);
    if (!lines.length) lines.push(make("li", { textContent: "No assumption is violated as far as it is checked." }));
    if (estimated.length) lines.push(make("li", { textContent: `Estimated error by truncated modes: ${estimated.map(([model, error]) => `${model} ${digits(100 * error, 2)} %`).join(", ")}.` }));
    byId("warnings").replaceChildren(...lines);
    if (!isOld) {
      const first = leading();
      const of = (model) => (state.estimated[model].error ? `${model} no result` : `${model} ${withUnit(state.results[model]?.values[first.name], first.unit, 4)}`);
      byId("status").textContent = `${first.label}: ${state.models.map(of).join(", ")}${warned.size ? `; ${warned.size} warning${warned.size > 1 ? "s" : ""}` : ""}`;
    }
  }

  // where the sphere goes after the impact, in scenes that ask for it
  function flights() {
    const flown = state.models.map((model) => [model, state.estimated[model]]).filter(([, one]) => one?.flight);
    byId("flight-section").hidden = !flown.length;
    if (!flown.length) return;
    byId("flight").innerHTML = flightPaths(flown.map(([model, { flight }]) => [model, flight]));
    byId("flights").replaceChildren(...flown.map(([model, { summary: { flight } }]) => {
      const rests = { other: "in the other seat", same: "in its own seat" }[flight.seat];
      const ends = rests ? `the sphere comes to rest ${rests}, which is certain after ${withUnit(flight.time, "s", 3)}` : minus(flight.reason ?? "the sphere rests in neither seat");
      return make("li", { textContent: `${model}: launched at ${withUnit(flight.launch.speed, "m/s", 3)}, ${ends}. No launch slower than ${withUnit(flight.least_speed, "m/s", 3)} can shift it.` });
    }));
  }

  function places() {
    const section = byId("validated-section");
    const results = state.estimated.C?.similarity?.results ?? {};
    const place = state.measures.map((name) => results[name]);
    const here = place.length && place.every((v) => v > 0) ? place : null;
    section.hidden = !page.validated.length || !here;
    if (section.hidden) return;
    const views = ["B", "C"].flatMap((model) => [1, 2].map((up) => validated(page.validated, model, state.measures, up, here)));
    byId("validated").innerHTML = views.join("");
  }

  // sensitivities at the sliders, one field after the other
  function sensitivities() {
    const model = state.models.includes("B") ? "B" : state.models[0];
    const quantity = leading();
    // a launch of a seat takes too long for two runs per number
    if (state.scene.mesh) return;
    for (const field of state.fields) {
      aside.ask(`sensitivity ${field.path}`, { do: "sensitivity", model, quantity: quantity.name, field: field.path, numbers: changed() }, ({ ok: change }) => {
        const bar = make("span", { className: change < 0 ? "bar less" : "bar" });
        bar.style.width = `${Math.min(3 * Math.abs(change ?? 0), 3)}rem`;
        field.depends.replaceChildren(...(change == null ? [] : [bar, `${change > 0 ? "+" : ""}${digits(change, 2)}`]));
        field.depends.title = change == null ? "" : `${quantity.label} changes by ${digits(change, 2)} % for one percent of ${field.path}`;
      });
    }
  }

  // the map, coarse cells first
  function map() {
    const run = mapRun += 1;
    const [fx, fy] = ["map-x", "map-y"].map((id) => state.fields.find(({ path }) => path === byId(id).value));
    byId("map-section").hidden = !fx || !fy || Boolean(state.scene.mesh);
    if (byId("map-section").hidden) return;
    const quantity = state.scene.quantities.find(({ name }) => name === byId("map-quantity").value);
    const model = byId("map-model").value, numbers = changed();
    const axis = (field) => ({ label: field.path, here: share(field, value(field)), at: (part) => withUnit(at(field, part), field.unit, 3) });
    const grid = (from) => Array.from({ length: CELLS }, () => new Array(CELLS).fill(from));
    const found = { x: axis(fx), y: axis(fy), values: grid(null), ratios: grid(null), best: null };
    const order = [];
    for (let step = 8; step >= 1; step /= 2) {
      for (let row = 0; row < CELLS; row += step) for (let column = 0; column < CELLS; column += step) {
        if (step === 8 || row % (2 * step) || column % (2 * step)) order.push({ row, column, step });
      }
    }
    const centre = (field, k) => at(field, (k + 0.5) / CELLS);
    const known = grid(false);
    let done = 0;
    const batch = () => {
      if (run !== mapRun) return;
      const cells = order.slice(done, done + (model === "C" ? 2 : 24));
      if (!cells.length) return;
      const points = cells.map(({ row, column }) => ({ ...numbers, [fx.path]: centre(fx, column), [fy.path]: centre(fy, row) }));
      aside.ask("map", { do: "values", model, quantity: quantity.name, points }, (answer) => {
        if (run !== mapRun) return;
        cells.forEach(({ row, column, step }, k) => {
          const [v, ratio] = answer.ok?.[k] ?? [null, null];
          known[row][column] = true;
          // a coarse cell stands for those that are not known yet
          for (let r = row; r < Math.min(row + step, CELLS); r += 1) for (let c = column; c < Math.min(column + step, CELLS); c += 1) {
            if ((r === row && c === column) || !known[r][c]) [found.values[r][c], found.ratios[r][c]] = [v, ratio];
          }
        });
        done += cells.length;
        let best = -Infinity;
        found.values.forEach((line, row) => line.forEach((v, column) => {
          if (known[row][column] && v != null && v > best) [best, found.best] = [v, [column, row]];
        }));
        const where = !found.best ? "" : `${withUnit(centre(fx, found.best[0]), fx.unit, 3)} and ${withUnit(centre(fy, found.best[1]), fy.unit, 3)}`;
        const label = quantity.label[0].toUpperCase() + quantity.label.slice(1);
        const summary = `${label} of model ${model} over ${fx.path} and ${fy.path}: ${done} of ${order.length} impacts. ${where ? `Cross: the largest value, ${withUnit(best, quantity.unit, 3)} at ${where}.` : "No impact has a result."} Ring: the present numbers.`;
        found.whole = done === order.length;
        const line = found.whole && found.ratios.flat().some((v) => v != null) ? " Line: the contact lasts half a period of the plate's first mode, near which the paper finds the optimum." : "";
        drawMap(byId("map"), found);
        byId("map-text").textContent = summary + line;
        byId("map").setAttribute("aria-label", summary);
        state.map = found;
        batch();
      });
    };
    batch();
  }

  // the address holds what is shown
  function address() {
    const parts = new URLSearchParams({ scene: state.scene.name });
    for (const [path, number] of Object.entries(changed())) parts.set(path, number);
    if (state.locks.size) parts.set("locks", [...state.locks].join());
    if (state.hidden.size) parts.set("hide", [...state.hidden].join());
    parts.set("map", ["map-x", "map-y", "map-quantity", "map-model"].map((id) => byId(id).value).join());
    history.replaceState(null, "", `#${parts}`);
  }

  let opening = 0;
  async function open(name, wanted = new URLSearchParams()) {
    const turn = opening += 1;
    clearTimeout(rest);
    mapRun += 1;
    const scene = page.scenes.find((one) => one.name === name) ?? page.scenes[0];
    byId("fields").replaceChildren();
    const problems = name && scene.name !== name ? [`There is no scene ${name} in this page.`] : [];
    failed(problems.join(" "));
    byId("title").textContent = scene.name;
    byId("description").textContent = scene.description;
    byId("scene").value = scene.name;
    byId("original").hidden = !scene.reference;
    byId("status").textContent = scene.mesh ? "Computing the modes of the seat: some 10 s, once …" : "Opening the scene …";
    const mesh = scene.mesh ? new TextDecoder().decode(await unpacked(scene.mesh)) : null;
    const request = { do: "open", scene: scene.scene, mesh, tolerance: scene.tolerance };
    if (turn !== opening) return;
    const [answer] = await Promise.all([quick, slow, aside].map((models) => models.open(request)));
    if (turn !== opening) return;
    if (answer.error) {
      failed(answer.error);
      return;
    }
    Object.assign(state, { scene, map: null, ...answer.ok, numbers: {}, results: {}, estimated: {}, end: 0, locks: new Set(), hidden: new Set((wanted.get("hide") ?? "").split(",").filter(Boolean)) });
    const reference = scene.reference;
    if (reference) state.end = reference.times[reference.times.length - 1];
    for (const field of state.fields) {
      const number = wanted.get(field.path);
      if (!number) continue;
      const checked = await new Promise((done) => quick.ask("check", { do: "check", field: field.path, value: Number(number) }, done));
      if (turn !== opening) return;
      if (checked.error) problems.push(checked.error);
      else state.numbers[field.path] = Number(number);
    }
    state.locks = new Set((wanted.get("locks") ?? "").split(",").filter((path) => state.fields.some((field) => field.path === path)));
    build();
    curves = new Curves(byId("plots"), scene, state.models, state.hidden);
    sources();
    const options = (id, entries, chosen) => byId(id).replaceChildren(...entries.map(([v, textContent]) => make("option", { value: v, textContent, selected: v === chosen })));
    const [mx, my, mq, mm] = (wanted.get("map") ?? "").split(",");
    const numeric = state.fields.map(({ path }) => [path, path]);
    const like = (wish, ...parts) => numeric.find(([path]) => path === wish)?.[0] ?? parts.map((part) => numeric.find(([path]) => path.endsWith(part))?.[0]).find(Boolean) ?? numeric[0]?.[0];
    options("map-x", numeric, like(mx, "plate.radius", "outer.speed", "speed"));
    options("map-y", numeric, like(my, "plate.thickness", "outer.radius", "radius"));
    options("map-quantity", scene.quantities.filter((quantity) => !quantity.count).map(({ name: n, label }) => [n, label]), mq ?? "efficiency");
    options("map-model", state.models.map((model) => [model, model]), mm ?? (state.models.includes("B") ? "B" : state.models[0]));
    address();
    byId("downloads").replaceChildren("Download curves (CSV, SI): ", ...state.models.map(download));
    update();
    failed(problems.join(" "));
  }

  function sources() {
    const ids = [...(state.scene.reference ? [["reference", "reference (original scene)"]] : []), ...state.models.map((model) => [model, `model ${model}`])];
    byId("controls").replaceChildren(...ids.map(([id, name]) => {
      const box = make("input", { type: "checkbox", checked: !state.hidden.has(id) });
      box.addEventListener("change", () => {
        box.checked ? state.hidden.delete(id) : state.hidden.add(id);
        draw(true);
        address();
      });
      const sample = make("span", { className: `sample sample-${id}` });
      return make("label", {}, box, sample, ` ${name}`);
    }));
  }

  function save(name, content) {
    const link = make("a", { href: URL.createObjectURL(new Blob([content], { type: "text/csv" })), download: name });
    link.click();
    URL.revokeObjectURL(link.href);
  }
  function download(model) {
    const button = make("button", { type: "button", textContent: model });
    button.setAttribute("aria-label", `Download the curves of model ${model}`);
    button.addEventListener("click", () => workerOf(model).ask(`csv ${model}`, { do: "csv", model, numbers: changed() }, (answer) => {
      answer.error ? failed(answer.error) : save(`${state.scene.name}-${model}.csv`, answer.ok);
    }));
    return button;
  }

  const names = new Map(["share", "toml"].map((id) => [byId(id), byId(id).textContent]));
  async function copy(button, content) {
    try {
      await navigator.clipboard.writeText(content);
      button.textContent = "Copied";
    } catch {
      // where a page may not write to the clipboard
      const area = make("textarea", { value: content });
      document.body.append(area);
      area.select();
      button.textContent = document.execCommand("copy") ? "Copied" : "Not copied";
      area.remove();
    }
    setTimeout(() => { button.textContent = names.get(button); }, 1500);
  }

  byId("scene").replaceChildren(...page.scenes.map(({ name }) => make("option", { value: name, textContent: name })));
  byId("scene").addEventListener("change", () => open(byId("scene").value));
  byId("reset").addEventListener("click", () => {
    state.numbers = {};
    state.fields.forEach((field) => show(field));
    update();
  });
  byId("share").addEventListener("click", () => {
    address();
    copy(byId("share"), location.href);
  });
  byId("toml").addEventListener("click", () => quick.ask("text", { do: "text", numbers: changed() }, (answer) => (answer.error ? failed(answer.error) : copy(byId("toml"), answer.ok))));
  for (const id of ["map-x", "map-y", "map-quantity", "map-model"]) byId(id).addEventListener("change", () => { map(); address(); });
  new ResizeObserver(() => redrawn()).observe(byId("plots"));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    curves?.plots.forEach(({ plot }) => plot.redraw(false));
    if (state.map) drawMap(byId("map"), state.map);
  });
  const fromAddress = () => new URLSearchParams(location.hash.slice(1));
  const redrawn = () => {
    curves?.fit();
    if (state.map) drawMap(byId("map"), state.map);
  };
  for (const moment of ["beforeprint", "afterprint"]) window.addEventListener(moment, redrawn);
  window.addEventListener("hashchange", () => open(fromAddress().get("scene"), fromAddress()));
  document.documentElement.classList.add("interactive");
  window.impactcheck = { state, latest, changed };
  await open(fromAddress().get("scene"), fromAddress());
})();
