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

  async function toggles() {
    const { plots } = window.impactcheck;
    for (const source of [json("curves").sources.at(-1).id, "reference", "band"]) {
      const box = document.querySelector(`#controls input[data-source="${source}"]`);
      const shown = () => plots.flatMap((plot) => plot.roles.map((role, k) => [role, plot.series[k].show]).slice(1));
      check(shown().every(([, show]) => show), `all curves are shown before ${source} is switched off`);
      box.click();
      await settled();
      check(shown().every(([role, show]) => show === (role !== source)), `${source} switched off`);
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
  }

  function layout() {
    const shown = (selector) => document.querySelector(selector).getClientRects().length > 0;
    check(shown("#panels") && !shown(".drawn"), "with scripts the panels are shown, the drawing is not");
    document.documentElement.classList.remove("interactive");
    check(!shown("#panels") && shown(".drawn"), "without scripts the drawing is shown, the panels are not");
    document.documentElement.classList.add("interactive");
    const wide = document.documentElement.scrollWidth, window = document.documentElement.clientWidth;
    check(wide <= window, `the page is ${wide} px wide in a window of ${window} px`);
    check(document.querySelectorAll("th:not([scope])").length === 0, "headers of tables without scope");
    const named = (element) => element.hasAttribute("aria-label") || element.querySelector(":scope > title");
    for (const element of document.querySelectorAll('[role="img"], [role="region"], [role="group"]')) {
      check(named(element), `without a name: ${element.outerHTML.slice(0, 120)}`);
    }
  }

  async function accessibility() {
    const { violations } = await axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"] });
    for (const { id, impact, nodes } of violations) {
      if (impact === "serious" || impact === "critical") problems.push(`${impact}: ${id}: ${nodes.length} times, first ${nodes[0].html.slice(0, 160)}: ${nodes[0].failureSummary}`);
    }
  }

  try {
    await settled();
    if (document.getElementById("curves")) for (const test of [numbers, curves, toggles, zooming, cursor, layout]) await test();
    await accessibility();
  } catch (error) {
    problems.push(`the test itself: ${error.stack}`);
  }
  const result = document.createElement("pre");
  result.id = "test-result";
  result.textContent = JSON.stringify(problems);
  document.body.append(result);
})();
