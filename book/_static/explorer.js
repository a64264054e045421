/* Shows runs of the lecture's grid: a map to choose from, a question before each run, and the run
   itself over the last one. The page contains all runs as JSON. */
"use strict";

/* plot.js and cell-map.js have loaded by then, in whatever order the page lists the scripts. */
document.addEventListener("DOMContentLoaded", () => {
  const { add, draw, write } = globalThis.timePlot;
  const { fill, make, mark } = globalThis.cellMap;
  const HEIGHT = 210;
  const UNKNOWN = "these runs cannot show it";

  function start(root) {
    const data = JSON.parse(root.dataset.grid);
    const [STEPS, KPS, KVS] = data.axes.map((axis) => axis.values);
    const SIZE = KPS.length * KVS.length;
    const find = (name) => root.querySelector(name);
    const [step, measure, predict] = ["step", "measure", "predict"].map((n) => find(`[name=${n}]`));
    const [question, output, plots] = [".question", "output", ".plots"].map(find);
    const map = make(find(".map-of-runs"), "table", "", { class: "map" });
    const svgs = Object.fromEntries(
      plots.dataset.curves.split(" ").map((curve) => [
        curve, add(plots, "svg", { role: "img", "data-curve": curve }),
      ]),
    );
    let shown = data.opens; // the run whose curves are drawn
    let chosen = shown; // the cell of the map; it differs from `shown` while a question is open
    let last = null; // the run before, drawn as a ghost
    let asked = 0; // how many questions were answered or skipped

    /* Numbers of runs: the last axis changes fastest. */
    const stepOf = (n) => STEPS[Math.floor(n / SIZE)];
    const kpOf = (n) => KPS[Math.floor(n / KVS.length) % KPS.length];
    const kvOf = (n) => KVS[n % KVS.length];
    const gains = (n) => `KP ${kpOf(n)}, KV ${kvOf(n)}`;
    const setting = (n) => `${gains(n)}, step ${stepOf(n)} rad`;
    const written = ({ label }, n) => data.points[n].metrics[label];
    const positions = (n) => data.points[n].q.map((q) => data.start + q * data.resolution.q);
    const forces = (n) => data.points[n].force.map((force) => force * data.resolution.force);

    /* The map: KP upwards, KV to the right. A cell's key is the number of its gains. */
    const rows = KPS.map((kp, row) => ({
      label: kp, cells: KVS.map((_, column) => row * KVS.length + column),
    })).reverse();
    const cells = fill(map, rows, KVS, (k) => choose(Number(step.value) * SIZE + k));

    function writeMap() {
      const { label, noun, values, cell: format } = data.measures[measure.value];
      const seen = values.filter((value) => value !== null);
      const [low, high] = [Math.min(...seen), Math.max(...seen)];
      const compared = chosen === shown ? last : shown;
      step.value = Math.floor(chosen / SIZE);
      const here = values.slice(step.value * SIZE, (Number(step.value) + 1) * SIZE);
      map.caption.textContent =
        `Map of the runs: ${data.labels[label]} [${format.unit}]. KP upwards, KV to the right.` +
        (here.includes(null) ? " A dash: not observed." : "");
      cells.forEach((cell, k) => {
        const n = Number(step.value) * SIZE + k;
        const [value, name] = [values[n], data.points[n].case];
        const number = value === null ? "–" : write(value * format.factor, format.digits);
        cell.textContent = number;
        if (name) cell.prepend(make(cell, "b", name), " ");
        const state = n === compared ? ", the last run" : "";
        const said = value === null ? "not observed" : format.unit;
        cell.setAttribute( // it begins with the text of the cell
          "aria-label", `${name ? `${name} ` : ""}${number} ${said}: ${noun}, ${gains(n)}${state}`,
        );
        cell.classList.toggle("last", n === compared);
        cell.style.setProperty("--share", value === null ? 0 : (value - low) / (high - low || 1));
      });
      mark(map, cells, chosen % SIZE);
    }

    function choose(n) {
      chosen = n;
      writeMap();
      question.hidden = true;
      if (n === shown) output.textContent = data.points[n].sentence;
      else if (predict.checked) ask();
      else show("");
    }

    /* The order of the run `n` relative to the run `from`, as the lesson judges it. A time that the
       window did not reach is later than any in it. */
    function order({ values, margin }, from, n) {
      const [a, b] = [values[from] ?? Infinity, values[n] ?? Infinity];
      if (a === b) return a === Infinity ? UNKNOWN : "equal";
      if (Math.abs(b - a) <= margin) return "equal";
      return b > a ? "higher" : "lower";
    }

    /* Questions are about metrics in turn, except the one that the map shows. */
    function ask() {
      const others = data.measures.filter((_, k) => k !== Number(measure.value));
      const about = others[asked % others.length];
      const words = { lower: about.lower, equal: "too close to call", higher: about.higher };
      if (about.values.includes(null)) words[UNKNOWN] = UNKNOWN;
      const text =
        `From ${setting(shown)} to ${setting(chosen)}: what happens to the ${about.noun}?`;
      const [legend] = question.children;
      legend.textContent = text;
      question.replaceChildren(legend);
      for (const [key, word] of [...Object.entries(words), ["", "Skip"]]) {
        make(question, "button", word, { type: "button" }).addEventListener("click", () => {
          answer(about, key, words);
        });
      }
      question.hidden = false;
      output.textContent = text;
    }

    function answer(about, key, words) {
      const right = order(about, shown, chosen);
      const margin = right === "equal" ? ` The margin is ${about.within}.` : "";
      const verdict = key ? (key === right ? "Yes" : "No") : "Skipped";
      const [before, now] = [shown, chosen].map((n) => written(about, n));
      asked += 1;
      show(
        `${verdict}. The ${about.noun}: ${words[right]}, first ${before}, now ${now}.${margin} `,
      );
      cells.get(chosen % SIZE).focus({ preventScroll: true }); // the button has gone
    }

    function show(feedback) {
      [last, shown] = [shown, chosen];
      question.hidden = true;
      writeMap();
      output.textContent = feedback + data.points[shown].sentence;
      writeMetrics();
      drawRuns();
    }

    function writeMetrics() {
      const rows = data.points[shown].metrics.map((value, k) => {
        const row = document.createElement("div");
        make(row, "dt", data.labels[k]);
        make(row, "dd", value);
        if (last !== null) {
          make(row, "dd", `last run: ${data.points[last].metrics[k]}`, { class: "last" });
        }
        return row;
      });
      find("dl").replaceChildren(...rows);
    }

    /* Position axis: wide enough for every run of the steps, so that gains can be compared. */
    function range(steps) {
      const runs = data.points.map((_, n) => n).filter((n) => steps.includes(stepOf(n)));
      const room = 0.08 * Math.max(...steps);
      const highest = Math.max(...runs.flatMap(positions), data.start + Math.max(...steps));
      return [data.start - room, highest + room];
    }

    /* Draws a quantity of the run over that of the last one, whose label is where the two differ
       most. `offset` is the number of the first sample. */
    function drawRun(curve, of, offset, plot) {
      const svg = svgs[curve];
      const own = data.points[shown].case;
      const mark = own ? `case-${own.toLowerCase()}` : "further";
      const time = (_, k) => (k + offset) * data.dt;
      const [now, before] = [of(shown), last === null ? null : of(last)];
      const ghost = before ? [{ times: before.map(time), values: before, mark: "ghost" }] : [];
      const run = { times: now.map(time), values: now, mark, chosen: true };
      const end = data.until;
      const curves = [...ghost, run];
      const { x, y, top, floor } = draw(svg, { ...plot, height: HEIGHT, end, curves });
      const name = `${plot.name} of joint4 over time. ${data.points[shown].sentence}`;
      const grey = before ? ` Grey: the last run, ${setting(last)}.` : "";
      svg.setAttribute("aria-label", name + grey);
      if (!before) return;
      const apart = now.map((value, k) => Math.abs(value - before[k]));
      const at = apart.indexOf(Math.max(...apart));
      const late = time(0, at) > end / 3;
      const beside = y(before[at]) + (before[at] > now[at] ? -6 : 14);
      add(svg, "text", {
        class: late ? "ghost-label end" : "ghost-label",
        x: x(time(0, at)) + (late ? -6 : 6),
        y: Math.min(Math.max(beside, top + 26), floor - 16), // clear of the limits
      }, `last run: ${gains(last)}`);
    }

    function drawRuns() {
      const steps = [shown, last ?? shown].map(stepOf);
      const target = data.start + steps[0];
      const [low, high] = range(steps);
      drawRun("q", positions, 0, {
        name: "Position", low, high,
        title: "Position [rad], target dotted",
        ticks: [data.start, data.start + steps[0] / 2, target].map((value) => ({
          value, label: write(value, 3),
        })),
        levels: [{ value: target, mark: "target" }],
      });
      drawRun("force", forces, 1, {
        name: "Control force", low: -1.15 * data.limit, high: 1.15 * data.limit,
        title: "Control force [N·m], limits dashed",
        ticks: [-data.limit, 0, data.limit].map((value) => ({ value, label: write(value, 0) })),
        levels: [-data.limit, data.limit].map((value) => ({ value, mark: "limit" })),
      });
    }

    root.hidden = false;
    root.nextElementSibling.remove(); // the sentence that a script is needed
    step.addEventListener("change", () => choose(Number(step.value) * SIZE + (chosen % SIZE)));
    measure.addEventListener("change", () => {
      writeMap();
      if (!question.hidden) ask();
    });
    predict.addEventListener("change", () => {
      if (!question.hidden) show("");
    });
    new ResizeObserver(drawRuns).observe(plots);
    writeMap();
    output.textContent = data.points[shown].sentence;
    writeMetrics();
    drawRuns();
  }

  document.querySelectorAll(".explorer").forEach(start);
});
