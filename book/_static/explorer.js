/* Recorded results to choose from: cells of a map, or pixels of a picture. A map can have curves, or
   the chosen posture in 3D. The page contains all data as JSON. */
"use strict";

document.addEventListener("DOMContentLoaded", () => { // as in replay.js
  const KEYS = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] };
  const { add, draw, write } = globalThis.timePlot;
  const HEIGHT = 210;

  /* Writes the values beside their names, and those of the last choice if there are any. */
  function writeValues(root, values, last) {
    root.querySelectorAll("dl div").forEach((row, k) => {
      row.replaceChildren(row.firstElementChild);
      add(row, "dd", {}, values[k]);
      if (last) add(row, "dd", { class: "last" }, `last run: ${last[k]}`);
    });
  }

  const cellsOf = (map) => map.rows.flatMap((row) => row.cells);

  /* A table of cells, one stop for the Tab key, each the `place` of its cell. Rows begin at the top,
     columns have labels below. */
  function fill(table, map, choose) {
    table.replaceChildren();
    table.setAttribute("role", "grid");
    table.createCaption();
    map.rows.forEach(({ label, cells }, row) => {
      const line = add(table, "tr");
      add(line, "th", { scope: "row" }, label);
      cells.forEach((cell, column) => {
        cell.place = add(line, "td", { role: "gridcell" });
        cell.place.addEventListener("click", () => choose(cell));
        cell.place.addEventListener("keydown", (event) => {
          const [down, right] = KEYS[event.key] ?? [];
          if (down === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
          event.preventDefault();
          const next = map.rows[row + down]?.cells[column + right];
          if (next) choose(next);
        });
      });
    });
    const foot = add(table, "tr");
    add(foot, "td");
    for (const label of map.columns) add(foot, "th", { scope: "col" }, label);
  }

  /* The curves of a run over those of the last one. */
  function curvesOf(root, { of, dt, until, drawn }) {
    const plots = root.querySelector(".plots");
    const svgs = drawn.map(({ key }) => add(plots, "svg", { role: "img", "data-curve": key }));
    let pair; // the run and the one before

    function drawOne({ key, name, title, unit, zero, first }, svg) {
      const [run, last] = pair;
      const line = (cell, mark) => ({
        times: cell[key].map((_, k) => (k + first) * dt),
        values: cell[key].map((value) => zero + value * unit),
        mark,
      });
      const mark = run.tag ? `case-${run.tag.toLowerCase()}` : "further";
      const now = { ...line(run, mark), chosen: true };
      const axes = pair.filter(Boolean).map((cell) => cell.map.axes[key]);
      draw(svg, {
        ...axes[0], title, width: plots.clientWidth, height: HEIGHT, end: until,
        curves: last ? [{ ...line(last, "ghost"), name: "last run" }, now] : [now],
        low: Math.min(...axes.map(({ low }) => low)), high: Math.max(...axes.map(({ high }) => high)),
      });
      const grey = last ? ` Grey: the last run, ${last.name}, ${last.map.setting}.` : "";
      svg.setAttribute("aria-label", `${name} of ${of} over time. ${run.sentence}${grey}`);
    }

    const redraw = () => drawn.forEach((curve, k) => drawOne(curve, svgs[k]));
    new ResizeObserver(redraw).observe(plots);
    return (run, last) => {
      pair = [run, last];
      redraw();
    };
  }

  /* The chosen posture in 3D, once a reader asks for it. Where that fails, map and values remain. */
  function modelOf(root, dt) {
    const [button, shown] = [".play", ".shown"].map((name) => root.querySelector(name));
    const scene = new globalThis.Scene(root);
    let chosen;

    function pose(cell) {
      chosen = cell;
      if (!scene.viewer) return;
      scene.pose(cell.map.run, cell.answer * dt);
      shown.textContent = cell.sentence;
    }

    button.addEventListener("click", async () => {
      button.hidden = true;
      await scene.open("robot", "The map and its values do not need it.");
      button.hidden = Boolean(scene.viewer); // else a press tries again
      pose(chosen);
    });
    return pose;
  }

  function startMap(root, data) {
    const find = (name) => root.querySelector(name);
    const [which, measure, output] = ["[name=map]", "[name=measure]", "output"].map(find);
    const table = add(find(".cells"), "table", { class: "map" });
    const view = data.curves ? curvesOf(root, data.curves) : modelOf(root, data.dt);
    for (const map of data.maps) for (const cell of cellsOf(map)) cell.map = map;
    const all = data.maps.flatMap(cellsOf);
    let open; // the map that the table shows
    let chosen = all.find((cell) => cell.opens) ?? all[0];
    let last = null; // the run before, drawn as a ghost

    function writeMap() {
      if (open !== chosen.map) {
        open = chosen.map;
        which.value = data.maps.indexOf(open);
        fill(table, open, choose);
      }
      const k = Number(measure.value);
      const { label } = data.measures[k];
      const seen = all.map(({ numbers }) => numbers[k]).filter((value) => value !== null);
      const [low, high] = [Math.min(...seen), Math.max(...seen)];
      const inside = table.contains(document.activeElement);
      for (const cell of cellsOf(open)) {
        const { place, name, tag, state, texts, numbers } = cell;
        place.textContent = texts[k];
        if (tag) place.prepend(add(place, "b", {}, tag), " ");
        const observed = numbers[k] === null ? " not observed" : "";
        const spoken = `${place.textContent} ${label}${observed}: ${name}`;
        place.setAttribute("aria-label", cell === last ? `${spoken}, the last run` : spoken);
        place.classList.toggle("refused", state === "refused");
        place.classList.toggle("last", cell === last);
        place.style.setProperty("--share", ((numbers[k] ?? low) - low) / (high - low || 1));
        place.setAttribute("aria-selected", cell === chosen);
        place.tabIndex = cell === chosen ? 0 : -1;
      }
      const shows = (sign) => cellsOf(open).some(({ place }) => place.textContent.includes(sign));
      const notes = Object.entries(data.notes).flatMap(([sign, note]) => (shows(sign) ? note : []));
      table.caption.textContent = [open.caption, `Numbers: ${label}.`, ...notes].join(" ");
      if (inside) chosen.place.focus();
    }

    function choose(cell) {
      if (data.curves && cell !== chosen) last = chosen;
      chosen = cell;
      show();
    }

    function show() {
      writeMap();
      output.textContent = chosen.sentence;
      writeValues(root, chosen.values, last?.values);
      view(chosen, last);
    }

    which.addEventListener("change", () => {
      const cells = cellsOf(data.maps[which.value]); // the same place, if it has one
      choose(cells[cellsOf(open).indexOf(chosen)] ?? cells[0]);
    });
    measure.addEventListener("change", writeMap);
    show();
  }

  /* Bytes of a PNG, four for each pixel. */
  async function decode(text) {
    const image = Object.assign(new Image(), { src: `data:image/png;base64,${text}` });
    await image.decode();
    const brush = new OffscreenCanvas(image.width, image.height).getContext("2d");
    brush.drawImage(image, 0, 0);
    return brush.getImageData(0, 0, image.width, image.height).data;
  }

  const dot = (a, b) => a.reduce((sum, value, k) => sum + value * b[k], 0);

  /* Reads depth, point and closed form of a pixel from the arrays of a recorded view. */
  async function startPicture(root, { size, K, pose, unit, names, planes, spheres, frames }) {
    const [depths, numbers] = await Promise.all([frames.depth, frames.segmentation].map(decode));
    const [width, height] = size;
    const [column, row, stage, cross] = ["[name=column]", "[name=row]", ".stage", ".cross"]
      .map((selector) => root.querySelector(selector));
    const centre = pose.map((line) => line[3]);

    /* The depth in closed form, NaN where the ray misses, undefined for other shapes. */
    function closedForm(number, direction) {
      if (number in planes) return (planes[number] - centre[2]) / direction[2];
      if (!(number in spheres)) return undefined;
      const [middle, radius] = [spheres[number].slice(0, 3), spheres[number][3]];
      const away = centre.map((value, k) => value - middle[k]);
      const [a, b] = [dot(direction, direction), dot(direction, away)];
      return (-b - Math.sqrt(b * b - a * (dot(away, away) - radius * radius))) / a;
    }

    function valuesAt(u, v) {
      const at = 4 * (v * width + u);
      const number = numbers[at];
      const depth = (65536 * depths[at] + 256 * depths[at + 1] + depths[at + 2]) * unit;
      if (number === 0) return [names[0], `${write(depth, 3)} m: no surface`, "–", "–", "–"];
      // From the camera through the middle of a pixel, with 1 along the optical axis.
      const ray = [(u + 0.5 - K[0][2]) / K[0][0], (v + 0.5 - K[1][2]) / K[1][1], 1];
      const direction = pose.map((line) => dot(line.slice(0, 3), ray));
      const point = centre.map((value, k) => write(value + depth * direction[k], 4)).join(", ");
      const expected = closedForm(number, direction);
      const found = [names[number], `${write(depth, 4)} m`, `${point} m`];
      if (expected === undefined) return [...found, "none for this shape", "–"];
      if (Number.isNaN(expected)) return [...found, "this ray misses the ideal sphere", "–"];
      return [...found, `${write(expected, 4)} m`, `${write(1000 * (depth - expected), 2)} mm`];
    }

    function show() {
      const [u, v] = [Number(column.value), Number(row.value)];
      const texts = [`column ${u}, row ${v}`, ...valuesAt(u, v)];
      writeValues(root, texts);
      for (const input of [column, row]) {
        input.setAttribute("aria-valuetext", `${texts[0]}: ${texts[1]}, depth ${texts[2]}`);
      }
      cross.style.left = `${(100 * (u + 0.5)) / width}%`;
      cross.style.top = `${(100 * (v + 0.5)) / height}%`;
    }

    function point(event) {
      if (event.buttons !== 1) return;
      const { left, top, width: across, height: down } = stage.getBoundingClientRect();
      column.value = Math.floor((width * (event.clientX - left)) / across);
      row.value = Math.floor((height * (event.clientY - top)) / down);
      show();
    }

    stage.onpointerdown = stage.onpointermove = point;
    stage.ondragstart = () => false;
    for (const input of [column, row]) input.addEventListener("input", show);
    show();
  }

  async function start(root) {
    const data = JSON.parse(root.dataset.explorer);
    await (data.maps ? startMap : startPicture)(root, data);
    root.classList.add("ready");
  }

  document.querySelectorAll(".explorer").forEach(start);
});
