/* Curves over time in an SVG, for the replay and the explorer. */
"use strict";

globalThis.timePlot = (() => {
  const SVG = "http://www.w3.org/2000/svg";
  const EDGE = { left: 52, right: 18, top: 24, bottom: 22 };

  function add(parent, name, attributes, text = "") {
    const element = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    element.textContent = text;
    parent.append(element);
    return element;
  }

  /* A number as text, with a typographic minus sign. */
  const write = (value, digits) => value.toFixed(digits).replace("-", "−");

  /* Draws a plot from the start; all lengths are CSS pixels.
     curves: [{times, values, mark, chosen}], `mark` a class of palette.css; levels: [{value, mark}];
     ticks: [{value, label}]; low, high: ends of the value axis; end: of time [s], which begins at 0.
     Returns x and y, from time and value to pixels, share, from pixels to a share of the time, and grow,
     which leaves of the curves what lies before a sample and at it. */
  function draw(svg, { title, height, curves, levels, ticks, low, high, end }) {
    const width = svg.parentElement.clientWidth;
    const across = width - EDGE.left - EDGE.right;
    const floor = height - EDGE.bottom;
    const x = (time) => EDGE.left + (time / end) * across;
    const y = (value) => floor - ((value - low) / (high - low)) * (floor - EDGE.top);
    svg.replaceChildren();
    svg.classList.add("time-plot");
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    svg.setAttribute("height", height);
    add(svg, "text", { x: 0, y: 14, class: "title" }, title);
    const exact = (n) => Math.abs(Number((end / 4).toFixed(n)) - end / 4) < 1e-9;
    const digits = [1, 2, 3].find(exact) ?? 4;
    for (const share of [0, 0.25, 0.5, 0.75, 1]) {
      const at = x(share * end);
      add(svg, "line", { x1: at, x2: at, y1: EDGE.top, y2: floor, class: "grid" });
      const label = write(share * end, digits) + (share === 0 ? " s" : "");
      add(svg, "text", { x: at, y: height - 6, class: "middle" }, label);
    }
    for (const { value, label } of ticks) {
      if (!value) add(svg, "line", { x1: x(0), x2: x(end), y1: y(0), y2: y(0), class: "grid" });
      add(svg, "text", { x: EDGE.left - 6, y: y(value) + 4, class: "end" }, label);
    }
    for (const { value, mark } of levels) {
      add(svg, "line", { x1: x(0), x2: x(end), y1: y(value), y2: y(value), class: `level ${mark}` });
    }
    const lines = curves.map(({ times, values, mark, chosen }) => {
      const points = values.map((v, k) => `${x(times[k]).toFixed(1)},${y(v).toFixed(1)}`);
      const line = { class: `curve ${mark}${chosen ? " chosen" : ""}`, points: points.join(" ") };
      return { line: add(svg, "polyline", line), points };
    });
    function grow(sample) {
      for (const { line, points } of lines) {
        line.setAttribute("points", points.slice(0, sample + 1).join(" "));
      }
    }
    return { x, y, floor, top: EDGE.top, share: (pixels) => (pixels - EDGE.left) / across, grow };
  }

  return { add, draw, write };
})();
