/* Shows one run of the lecture's grid at a time: everything it shows stands in the page as JSON. */
"use strict";

(() => {
  const SVG = "http://www.w3.org/2000/svg";
  const EDGE = { left: 52, right: 10, top: 26, bottom: 34 };
  const HEIGHT = 210;

  function add(parent, name, attributes, text = "") {
    const element = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    element.textContent = text;
    parent.append(element);
    return element;
  }

  /* Draws `curve` {times, values} between `low` and `high`, with horizontal `marks` and a title. */
  function draw(svg, { curve, low, high, ticks, marks, title, window }) {
    const width = svg.parentElement.clientWidth;
    const x = (time) => EDGE.left + (time / window) * (width - EDGE.left - EDGE.right);
    const y = (value) =>
      HEIGHT - EDGE.bottom - ((value - low) / (high - low)) * (HEIGHT - EDGE.top - EDGE.bottom);
    svg.replaceChildren();
    svg.setAttribute("viewBox", `0 0 ${width} ${HEIGHT}`);
    svg.setAttribute("height", HEIGHT);
    add(svg, "text", { x: 0, y: 14, class: "title" }, title);
    for (const share of [0, 0.25, 0.5, 0.75, 1]) {
      const at = x(share * window);
      add(svg, "line", { x1: at, x2: at, y1: EDGE.top, y2: HEIGHT - EDGE.bottom, class: "grid" });
      const label = (share * window).toFixed(1);
      add(svg, "text", { x: at, y: HEIGHT - EDGE.bottom + 15, class: "middle" }, label);
    }
    add(svg, "text", { x: x(window / 2), y: HEIGHT - 4, class: "middle" }, "time [s]");
    for (const { value, label } of ticks) {
      add(svg, "text", { x: EDGE.left - 6, y: y(value) + 4, class: "end" }, label);
    }
    for (const { value, kind } of marks) {
      add(svg, "line", { x1: x(0), x2: x(window), y1: y(value), y2: y(value), class: kind });
    }
    const points = curve.times.map((t, k) => `${x(t).toFixed(1)},${y(curve.values[k]).toFixed(1)}`);
    add(svg, "polyline", { points: points.join(" "), class: "measured-run" });
  }

  function start(root) {
    const data = JSON.parse(root.querySelector("script").textContent);
    const inputs = data.axes.map((axis) => root.querySelector(`#explorer-${axis.name}`));
    const plots = root.querySelector(".plots");
    const svgs = Object.fromEntries(
      plots.dataset.curves.split(" ").map((curve) => [
        curve, add(plots, "svg", { role: "img", "data-curve": curve }),
      ]),
    );
    const positions = (point) => point.q.map((q) => data.start + q * data.resolution.q);

    /* The run that the inputs name; the last axis changes fastest. */
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
      const window = (point.q.length - 1) * data.dt;
      plots.dataset.case = point.case;
      const [low, high] = range(step);
      draw(svgs.q, {
        curve: { times: point.q.map((_, k) => k * data.dt), values: positions(point) },
        low, high, window,
        title: "Position [rad], target dotted",
        ticks: [data.start, data.start + step / 2, target].map((value) => ({
          value, label: value.toFixed(3).replace("-", "−"),
        })),
        marks: [{ value: target, kind: "target" }],
      });
      draw(svgs.force, {
        curve: {
          times: point.force.map((_, k) => (k + 1) * data.dt),
          values: point.force.map((force) => force * data.resolution.force),
        },
        low: -1.15 * data.limit, high: 1.15 * data.limit, window,
        title: "Control force [N·m], limits dashed",
        ticks: [-data.limit, 0, data.limit].map((value) => ({
          value, label: value.toFixed(0).replace("-", "−"),
        })),
        marks: [-data.limit, data.limit].map((value) => ({ value, kind: "limit" })),
      });
      svgs.q.setAttribute("aria-label", `Position of joint4 over time. ${point.said}`);
      svgs.force.setAttribute("aria-label", `Control force of joint4 over time. ${point.said}`);
    }

    function show() {
      inputs.forEach((input, k) => {
        const text = `${data.axes[k].values[input.value]} ${data.axes[k].unit}`;
        input.setAttribute("aria-valuetext", text);
        input.labels[0].querySelector(".value").textContent = text;
      });
      const point = chosen();
      root.querySelector("output").textContent = point.said;
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
    root.nextElementSibling.remove(); // it says that a script is needed
    for (const input of inputs) input.addEventListener("input", show);
    new ResizeObserver(drawRun).observe(plots);
    show();
  }

  document.querySelectorAll(".explorer").forEach(start);
})();
