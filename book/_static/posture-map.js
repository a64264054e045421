/* Maps of recorded postures: choose a cell to read its values and to see the posture in 3D. The values
   are those of the tables in the same block, whose first column is the number of the answer. */
"use strict";

/* cell-map.js and stage.js have loaded by then, in whatever order the page lists the scripts. */
document.addEventListener("DOMContentLoaded", () => {
  const { fill, make, mark } = globalThis.cellMap;
  const { Scene, draws3D } = globalThis.stage;
  const ACCEPTED = "accepted";

  /* Answer → {column: text} of a table. */
  function read(table) {
    const head = [...table.querySelectorAll("thead th")].map((cell) => cell.textContent.trim());
    return new Map([...table.querySelectorAll("tbody tr")].map((row) => {
      const texts = [...row.cells].map((cell) => cell.textContent.trim());
      return [Number(texts[0]), Object.fromEntries(head.map((name, k) => [name, texts[k]]))];
    }));
  }

  /* At most four characters: a cell on a phone has no room for more. */
  function short(value) {
    if (value >= 10) return value.toFixed(0);
    return String(Number(value.toFixed(value < 1 ? 3 : 2))).replace(/^0\./, ".");
  }

  function start(root) {
    const dt = Number(root.dataset.dt);
    const maps = JSON.parse(root.dataset.maps);
    const tables = [...root.parentElement.querySelectorAll("details table")].map(read);
    const find = (name) => root.querySelector(name);
    const [which, measure] = ["map", "measure"].map((name) => find(`[name=${name}]`));
    const [button, status, shown] = [".play", "[role=status]", ".shown"].map(find);
    const table = make(find(".map-of-postures"), "table", "", { class: "map" });
    const scene = new Scene(root);
    let cells = new Map();
    let chosen = 0; // the number of an answer

    const map = () => maps[which.value];
    const records = () => tables[which.value];
    const word = (record) => (record[ACCEPTED] === "yes" ? "accepted" : "refused");

    function openMap() {
      const { rows, columns } = map();
      cells = fill(table, rows, columns, choose);
      const keys = [...cells.keys()];
      choose(keys.find((key) => word(records().get(key)) === "accepted") ?? keys[0]);
    }

    function writeMap() {
      const { caption, axes, rows, columns } = map();
      const name = measure.value;
      table.caption.textContent = `${caption} Numbers: ${name}. ×: refused.`;
      const values = [...cells.keys()].map((key) => Number(records().get(key)[name]));
      const [low, high] = [Math.min(...values), Math.max(...values)];
      rows.forEach(({ label, cells: keys }) => keys.forEach((key, column) => {
        const [cell, record] = [cells.get(key), records().get(key)];
        const [number, refused] = [Number(record[name]), word(record) === "refused"];
        cell.textContent = short(number);
        if (refused) cell.prepend(make(cell, "b", "×"), " ");
        const place = `${axes[0]} ${label}, ${axes[1]} ${columns[column]}`;
        const said = `${refused ? "× " : ""}${short(number)} ${name}: ${place}, ${word(record)}`;
        cell.setAttribute("aria-label", said); // it begins with the text of the cell
        cell.classList.toggle("refused", refused);
        cell.style.setProperty("--share", (number - low) / (high - low || 1));
      }));
      mark(table, cells, chosen);
    }

    function choose(key) {
      chosen = key;
      writeMap();
      const record = records().get(key);
      const [number, ...columns] = Object.keys(record);
      find("output").textContent = `Answer ${record[number]}, ${word(record)}.`;
      find("dl").replaceChildren(...columns.map((name) => {
        const row = document.createElement("div");
        make(row, "dt", name);
        make(row, "dd", record[name]);
        return row;
      }));
      pose();
    }

    function pose() {
      if (!scene.viewer) return;
      scene.pose(map().run, chosen * dt);
      const record = records().get(chosen);
      shown.textContent = `answer ${chosen}, ${word(record)}`;
    }

    /* Loads the model. Where that fails, map and values remain. */
    async function load() {
      if (!draws3D()) {
        status.textContent = "This browser draws no 3D: its WebGL 2 is missing or turned off. The map and its values do not need it.";
        return;
      }
      button.disabled = true;
      button.textContent = status.textContent = "Loading …";
      try {
        await scene.load();
        button.hidden = true;
        status.textContent = "Turn the view with the mouse, a finger or the arrow keys. The yellow cross is at the target.";
        pose();
      } catch {
        button.textContent = "Show in 3D";
        status.textContent = "The robot cannot be shown: a file is missing or cannot be read. The map and its values do not need it.";
      }
      button.disabled = false;
    }

    for (const part of [button, find(".panel")]) part.hidden = false;
    button.addEventListener("click", load);
    which.addEventListener("change", openMap);
    measure.addEventListener("change", writeMap);
    openMap();
  }

  document.querySelectorAll(".posture-map").forEach(start);
});
