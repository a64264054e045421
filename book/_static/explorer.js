/* Shows one run of the lecture's grid at a time; the page contains all runs as JSON. */
"use strict";

/* plot.js has loaded by then, in whatever order the page lists the scripts. */
document.addEventListener("DOMContentLoaded", () => {
  const { add, draw, write } = globalThis.timePlot;
  const HEIGHT = 210;

  function start(root) {
    const data = JSON.parse(root.dataset.grid);
    const inputs = data.axes.map((axis) => root.querySelector(`#explorer-${axis.name}`));
    const plots = root.querySelector(".plots");
    const svgs = Object.fromEntries(
      plots.dataset.curves.split(" ").map((curve) => [
        curve, add(plots, "svg", { role: "img", "data-curve": curve }),
      ]),
    );
    const positions = (point) => point.q.map((q) => data.start + q * data.resolution.q);

    /* The run of the chosen inputs; the last axis changes fastest. */
    function chosen() {
      const number = inputs.reduce(
        (sum, input, k) => sum * data.axes[k].values.length + Number(input.value), 0,
      );
      return data.points[number];
    }

    /* Position axis: wide enough for every run of this step, so that gains can be compared. */
    function range(step) {
      const size = data.points.length / data.axes[0].values.length;
      const first = data.axes[0].values.indexOf(step) * size;
      const all = data.points.slice(first, first + size).flatMap(positions);
      return [data.start - 0.08 * step, Math.max(...all, data.start + step) + 0.08 * step];
    }

    function drawRun() {
      const point = chosen();
      const step = data.axes[0].values[inputs[0].value];
      const target = data.start + step;
      const mark = point.case ? `case-${point.case.toLowerCase()}` : "further";
      const shared = { height: HEIGHT, end: (point.q.length - 1) * data.dt };
      const curve = (times, values) => [{ times, values, mark, chosen: true }];
      const [low, high] = range(step);
      draw(svgs.q, {
        ...shared, low, high,
        title: "Position [rad], target dotted",
        curves: curve(point.q.map((_, k) => k * data.dt), positions(point)),
        ticks: [data.start, data.start + step / 2, target].map((value) => ({
          value, label: write(value, 3),
        })),
        levels: [{ value: target, mark: "target" }],
      });
      draw(svgs.force, {
        ...shared, low: -1.15 * data.limit, high: 1.15 * data.limit,
        title: "Control force [N·m], limits dashed",
        curves: curve(
          point.force.map((_, k) => (k + 1) * data.dt),
          point.force.map((force) => force * data.resolution.force),
        ),
        ticks: [-data.limit, 0, data.limit].map((value) => ({ value, label: write(value, 0) })),
        levels: [-data.limit, data.limit].map((value) => ({ value, mark: "limit" })),
      });
      svgs.q.setAttribute("aria-label", `Position of joint4 over time. ${point.sentence}`);
      svgs.force.setAttribute("aria-label", `Control force of joint4 over time. ${point.sentence}`);
    }

    function show() {
      inputs.forEach((input, k) => {
        const text = `${data.axes[k].values[input.value]} ${data.axes[k].unit}`;
        input.setAttribute("aria-valuetext", text);
        input.labels[0].querySelector(".value").textContent = text;
      });
      const point = chosen();
      root.querySelector("output").textContent = point.sentence;
      root.querySelector("dl").replaceChildren(
        ...point.metrics.map((value, k) => {
          const row = document.createElement("div");
          const [term, described] = ["dt", "dd"].map((name) => document.createElement(name));
          [term.textContent, described.textContent] = [data.labels[k], value];
          row.append(term, described);
          return row;
        }),
      );
      drawRun();
    }

    root.hidden = false;
    root.nextElementSibling.remove(); // the sentence that a script is needed
    for (const input of inputs) input.addEventListener("input", show);
    new ResizeObserver(drawRun).observe(plots);
    show();
  }

  document.querySelectorAll(".explorer").forEach(start);
});
