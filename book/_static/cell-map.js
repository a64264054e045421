/* A table of cells to choose from by pointer, touch or arrow keys, for the explorer and the maps of
   postures. It is one stop for the Tab key. */
"use strict";

globalThis.cellMap = (() => {
  const KEYS = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] };

  function make(parent, name, text = "", attributes = {}) {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    element.textContent = text;
    parent.append(element);
    return element;
  }

  /* Fills a table. rows: [{label, cells: [key]}], the first at the top; columns: labels below them.
     `choose` gets the key of a cell. Returns the cells by their key. */
  function fill(table, rows, columns, choose) {
    const found = new Map();
    table.replaceChildren();
    table.setAttribute("role", "grid");
    table.createCaption();
    rows.forEach(({ label, cells }, row) => {
      const line = make(table, "tr");
      make(line, "th", label, { scope: "row" });
      cells.forEach((key, column) => {
        const cell = make(line, "td", "", { role: "gridcell" });
        found.set(key, cell);
        cell.addEventListener("click", () => choose(key));
        cell.addEventListener("keydown", (event) => {
          const [down, right] = KEYS[event.key] ?? [];
          if (down === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
          event.preventDefault();
          const next = rows[row + down]?.cells[column + right];
          if (next !== undefined) choose(next);
        });
      });
    });
    const foot = make(table, "tr");
    make(foot, "td", "");
    for (const label of columns) make(foot, "th", label, { scope: "col" });
    return found;
  }

  /* Marks the chosen cell, and moves the focus to it if the focus is in the table. */
  function mark(table, cells, chosen) {
    const inside = table.contains(document.activeElement);
    cells.forEach((cell, key) => {
      cell.setAttribute("aria-selected", key === chosen);
      cell.tabIndex = key === chosen ? 0 : -1;
    });
    if (inside) cells.get(chosen).focus();
  }

  return { fill, make, mark };
})();
