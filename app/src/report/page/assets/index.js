// The index sorts by a click on a heading (up, down, by folder again) and shows what a search finds.
(() => {
  "use strict";
  const table = document.querySelector("table.verdicts");
  const original = [...table.tBodies].map((body) => [body, [...body.rows]]);
  const rows = original.flatMap(([, all]) => all).filter((row) => !row.matches(".folder, .conclusion"));
  const value = (row, column) => {
    const { sort, si } = row.cells[column].dataset;
    const number = sort ?? si;
    return number == null ? row.cells[column].textContent : number === "" ? -Infinity : Number(number);
  };
  const headings = [...table.tHead.rows[0].cells];
  headings.forEach((heading, column) => {
    if (!heading.classList.contains("sorts")) return;
    const button = document.createElement("button");
    button.type = "button";
    button.append(...heading.childNodes);
    heading.append(button);
    button.addEventListener("click", () => {
      const next = { none: "ascending", ascending: "descending", descending: "none" }[heading.ariaSort ?? "none"];
      headings.forEach((other) => other.removeAttribute("aria-sort"));
      original.forEach(([body, all]) => body.replaceChildren(...all));
      if (next === "none") return;
      heading.setAttribute("aria-sort", next);
      const sign = next === "ascending" ? 1 : -1;
      const compare = (a, b) => (typeof a === "string" ? String(a).localeCompare(String(b), "en", { numeric: true }) : a - b || 0);
      const sorted = [...rows].sort((a, b) => sign * compare(value(a, column), value(b, column)));
      original.forEach(([body], k) => body.replaceChildren(...(k ? [] : sorted)));
    });
  });
  const search = document.getElementById("search");
  search.hidden = false;
  search.querySelector("input").addEventListener("input", ({ target }) => {
    const words = target.value.toLowerCase().split(/\s+/);
    const found = rows.filter((row) => (row.hidden = !words.every((word) => row.textContent.toLowerCase().includes(word))) === false);
    table.querySelectorAll(".conclusion").forEach((row) => (row.hidden = target.value !== ""));
    search.querySelector("output").textContent = target.value ? `${found.length} of ${rows.length} rows` : "";
  });
})();
