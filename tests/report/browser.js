// Runs inside a scene's page of the report in a browser; what fails is written into #test-result as JSON.
(async () => {
  "use strict";
  const problems = window.problems;
  const check = (holds, what) => holds || problems.push(what);
  const same = (a, b, what) => check(a === b, `${what}: ${a}, expected ${b}`);
  const settled = () => new Promise((resolve) => setTimeout(resolve, 30));
  const json = (id) => JSON.parse(document.getElementById(id).textContent);
  const mouse = (target, type, x, y) =>
    target.dispatchEvent(new MouseEvent(type, { bubbles: true, clientX: x, clientY: y, movementX: 1, button: 0, buttons: 1 }));

  async function numbers() {
    const expected = json("test-comparison");
    const sorted = (_, v) => (v && typeof v === "object" && !Array.isArray(v) ? Object.fromEntries(Object.entries(v).sort()) : v);
    const [found, wanted] = [json("comparison"), expected].map((document) => JSON.stringify(document, sorted));
    check(found === wanted, "the comparison in the page is not that of comparison.json");
    let compared = 0;
    for (const model of expected.models) {
      const table = document.querySelector(`table.discrepancies[data-model="${model.model}"]`);
      for (const row of model.discrepancies) {
        const cells = table.querySelectorAll(`tr[data-quantity="${row.quantity}"] td[data-si]`);
        for (const cell of cells) {
          const value = row[cell.dataset.field];
          same(cell.dataset.si === "" ? null : Number(cell.dataset.si), value ?? null, `${model.model} ${row.quantity} ${cell.dataset.field}`);
          check(value == null ? cell.textContent === "–" : /\d/.test(cell.textContent), `${row.quantity}: \`${cell.textContent}\``);
          compared++;
        }
      }
    }
    check(compared > 100, `only ${compared} numbers compared`);
  }

  async function curves() {
    const { plots } = window.impactcheck;
    const data = json("curves");
    same(plots.length, 3, "panels");
    for (const [name, samples] of Object.entries(json("test-curves"))) {
      const [source, ...curve] = name.split("_");
      const panel = data.panels.findIndex((p) => p.curves.some((c) => c.name === curve.join("_")));
      const body = data.panels[panel].curves.find((c) => c.name === curve.join("_"));
      const drawn = plots[panel].data.find((column) => column === body.values[source] || column.every((v, k) => v === body.values[source][k]));
      check(drawn, `${name} is not drawn`);
      const peak = Math.max(...body.values[source].map(Math.abs));
      for (const [k, value] of samples) {
        const distance = Math.abs(drawn[k] - value * data.panels[panel].factor);
        check(distance <= 1e-4 * peak, `${name}[${k}]: ${drawn[k]}, in the CSV file ${value}`);
      }
    }
    // the band's edges lie on both sides of the reference
    plots.forEach((plot, p) => plot.bands.forEach((band, b) => {
      const [high, low] = band.series.map((k) => plot.data[k]);
      const curve = data.panels[p].curves[b];
      const reference = curve.values.reference;
      check(reference.every((v, k) => Math.abs(high[k] - v - curve.band[k]) < 1e-9 && Math.abs(v - low[k] - curve.band[k]) < 1e-9), `band of ${curve.name}`);
      check(curve.band.some((v) => v > 0), `the band of ${curve.name} has no width`);
    }));
    same(plots.map((plot) => plot.bands.length).join(), "3,3,2", "bands");
  }

  // below each panel, model minus reference
  function residuals() {
    const data = json("curves"), { residuals } = window.impactcheck;
    same(residuals.length, 3, "panels of residuals");
    const [reference, ...models] = data.sources.map(({ id }) => id);
    residuals.forEach((plot, p) => data.panels[p].curves.forEach((curve) => models.forEach((model) => {
      const k = plot.roles.findIndex((roles) => roles.includes(model) && roles.includes(curve.body));
      const off = curve.values[model].map((v, i) => v - curve.values[reference][i]);
      check(off.every((v, i) => Math.abs(v - plot.data[k][i]) < 1e-9), `residual of ${model}, ${curve.name}`);
      const [low, high] = [Math.min(...off), Math.max(...off)].map((v) => plot.valToPos(v, "y"));
      check(high >= 0 && low <= plot.over.clientHeight, `residual of ${model}, ${curve.name} leaves its panel: ${high} to ${low}`);
    })));
  }

  // the name of a body stands on no curve of another one
  function names() {
    const data = json("curves"), { plots } = window.impactcheck;
    plots.forEach((plot, p) => {
      const { curves } = data.panels[p];
      same(plot.names.length, curves.length, `names in panel ${p}`);
      plot.names.forEach(([x, y, half], n) => curves.filter((_, k) => k !== n).forEach((curve) => data.sources.forEach(({ id }) => {
        const crossed = curve.values[id].some((v, k) => Math.abs(plot.valToPos(data.time[k], "x", true) - x) < half && Math.abs(plot.valToPos(v, "y", true) - y) < 4 * devicePixelRatio);
        check(!crossed, `the name of ${curves[n].body} stands on ${id} ${curve.name}`);
      })));
    });
  }

  async function toggles() {
    const { plots, residuals } = window.impactcheck;
    const body = json("curves").panels[0].curves[0].body;
    for (const source of [json("curves").sources.at(-1).id, "reference", "band", body]) {
      const box = document.querySelector(`#controls input[data-source="${source}"]`);
      const all = [...plots, ...residuals];
      const shown = () => all.flatMap((plot) => plot.roles.map((roles, k) => [roles.includes(source), plot.series[k].show]).slice(1));
      check(shown().every(([, show]) => show), `all curves are shown before ${source} is switched off`);
      box.click();
      await settled();
      check(shown().every(([own, show]) => show !== own), `${source} switched off`);
      // no marker stays where its curve is gone
      for (const plot of plots) for (const [k, point] of [...plot.over.querySelectorAll(".u-cursor-pt")].entries()) {
        const gone = !plot.series[k + 1].show, at = new DOMMatrix(getComputedStyle(point).transform);
        if (gone) check(at.e < 0 || at.f < 0, `${source} is off, the marker of ${plot.series[k + 1].label} is not: ${at.e}, ${at.f}`);
      }
      box.click();
      await settled();
      check(shown().every(([, show]) => show), `${source} switched on again`);
    }
  }

  async function zooming() {
    const { plots } = window.impactcheck;
    const end = plots[0].data[0].at(-1);
    const ranges = () => plots.map((plot) => [plot.scales.x.min, plot.scales.x.max]);
    const all = (from, to, what) =>
      ranges().forEach(([min, max], k) => check(Math.abs(min - from) < 0.01 * end && Math.abs(max - to) < 0.01 * end, `${what}: panel ${k} shows ${min} to ${max}, expected ${from} to ${to}`));
    all(0, end, "before");
    for (const plot of plots) {
      const box = plot.over.getBoundingClientRect();
      const [x, y] = [box.left + 0.25 * box.width, box.top + 0.5 * box.height];
      mouse(plot.over, "mousemove", x, y);
      mouse(plot.over, "mousedown", x, y);
      mouse(plot.over, "mousemove", x + 0.25 * box.width, y);
      mouse(document, "mouseup", x + 0.25 * box.width, y);
      await settled();
      all(0.25 * end, 0.5 * end, "dragged");
      mouse(plot.over, "dblclick", x, y);
      await settled();
      all(0, end, "double-clicked");
    }
    const press = async (name) => {
      [...document.querySelectorAll("#time button")].find((b) => b.textContent === name).click();
      await settled();
    };
    await press("zoom in");
    all(0.25 * end, 0.75 * end, "zoomed in");
    await press("later");
    all(0.5 * end, end, "later");
    await press("earlier");
    all(0.25 * end, 0.75 * end, "earlier");
    await press("zoom out");
    all(0, end, "zoomed out");
    await press("zoom in");
    await press("all");
    all(0, end, "all");
  }

  async function cursor() {
    const data = json("curves");
    const { plots } = window.impactcheck;
    const slider = document.querySelector("#time input");
    const told = (index, how) => data.panels.forEach((panel) => panel.curves.forEach((curve) => data.sources.forEach(({ id }) => {
      const cell = document.querySelector(`td[data-curve="${curve.name}"][data-source="${id}"]`);
      const value = curve.values[id][index];
      same(cell.textContent, value == null ? "–" : value.toFixed(panel.decimals).replace("-", "−"), `${how}: ${id} ${curve.name} at ${index}`);
    })));
    for (const index of [0, 700, data.time.length - 1]) {
      slider.value = index;
      slider.dispatchEvent(new Event("input"));
      await settled();
      told(index, "slider");
    }
    const box = plots[2].over.getBoundingClientRect();
    mouse(plots[2].over, "mousemove", box.left + 0.3 * box.width, box.top + 20);
    await settled();
    const index = Number(slider.value);
    check(Math.abs(index / (data.time.length - 1) - 0.3) < 0.02, `the slider follows the mouse: ${index}`);
    told(index, "mouse");
    mouse(plots[2].over, "mouseleave", 0, 0);
    mouse(document.getElementById("panels"), "mouseleave", 0, 0);
    await settled();
    same(Number(slider.value), index, "the slider when the pointer has left");
    told(index, "left");
  }

  function layout() {
    const shown = (selector) => document.querySelector(selector).getClientRects().length > 0;
    check(shown("#panels") && !shown(".drawn"), "with scripts the panels are shown, the drawing is not");
    document.documentElement.classList.remove("interactive");
    check(!shown("#panels") && shown(".drawn"), "without scripts the drawing is shown, the panels are not");
    document.documentElement.classList.add("interactive");
    const wide = document.documentElement.scrollWidth, window = document.documentElement.clientWidth;
    const [first, last] = ["#controls", "#time"].map((selector) => document.querySelector(selector).getBoundingClientRect());
    check(window < 960 || last.bottom - first.top <= 900, `panels and residuals are ${last.bottom - first.top} px high`);
    check(wide <= window, `the page is ${wide} px wide in a window of ${window} px`);
    check(document.querySelectorAll("th:not([scope])").length === 0, "headers of tables without scope");
    const named = (element) => element.hasAttribute("aria-label") || element.querySelector(":scope > title");
    for (const element of document.querySelectorAll('[role="img"], [role="region"], [role="group"]')) {
      check(named(element), `without a name: ${element.outerHTML.slice(0, 120)}`);
    }
  }

  // text made for terminals does not stand on a page as it is
  function prose() {
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    for (let node; (node = walker.nextNode()); ) {
      if (node.parentElement.closest("script, style, pre, code, .run-time")) continue;
      check(!/`|(^|[\s(±])-\d|\de-\d/.test(node.data), `not prose: ${node.data}`);
    }
  }

  // the index sorts, returns to its order, and finds
  async function index() {
    const rows = () => [...document.querySelectorAll("table.verdicts tbody tr:not(.folder):not(.conclusion)")];
    const before = rows().map((row) => row.textContent);
    const column = 4, button = document.querySelectorAll("table.verdicts thead th")[column].querySelector("button");
    const sizes = () => rows().map((row) => Number(row.cells[column].dataset.sort));
    const isSorted = (sign) => sizes().every((v, k, all) => !k || sign * (v - all[k - 1]) >= 0);
    check(!isSorted(1), "the index is sorted before anyone asks");
    button.click();
    check(isSorted(1), `ascending: ${sizes()}`);
    button.click();
    check(isSorted(-1), `descending: ${sizes()}`);
    button.click();
    same(rows().map((row) => row.textContent).join(), before.join(), "the first order");
    const field = document.querySelector("#search input");
    const search = (text) => {
      field.value = text;
      field.dispatchEvent(new Event("input"));
      return rows().filter((row) => row.getClientRects().length).length;
    };
    same(search("seal-seat"), rows().filter((row) => row.dataset.scene.startsWith("seal-seat")).length, "rows found");
    same(search(""), before.length, "rows without a search");
  }

  async function accessibility() {
    const { violations } = await axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"] });
    for (const { id, impact, nodes } of violations) {
      if (impact === "serious" || impact === "critical") problems.push(`${impact}: ${id}: ${nodes.length} times, first ${nodes[0].html.slice(0, 160)}: ${nodes[0].failureSummary}`);
    }
  }

  try {
    await settled();
    if (document.getElementById("curves")) for (const test of [numbers, curves, residuals, names, toggles, zooming, cursor, layout]) await test();
    else if (!document.querySelector("table.moves")) await index();
    prose();
    const root = document.documentElement;
    check(root.scrollWidth <= root.clientWidth, `the page is ${root.scrollWidth} px wide in a window of ${root.clientWidth} px`);
    await accessibility();
  } catch (error) {
    problems.push(`the test itself: ${error.stack}`);
  }
  const result = document.createElement("pre");
  result.id = "test-result";
  result.textContent = JSON.stringify(problems);
  document.body.append(result);
  parent.postMessage(result.textContent, "*");
})();
