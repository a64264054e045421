/* Curves over time in an SVG, and what else adds elements, for the replay and the explorer. */
"use strict";

globalThis.timePlot = (() => {
  const SVG = "http://www.w3.org/2000/svg";
  const EDGE = { left: 52, right: 18, top: 24, bottom: 22 };
  const APART = 12; // from a name to the nearest other line, at least [px]
  const TRIED = 60; // points of a curve that are looked at for a name's place, at most

  /* Adds an element with attributes and a text; in an SVG it is one of its own. */
  function add(parent, name, attributes = {}, text = "") {
    const element = document.createElementNS(name === "svg" ? SVG : parent.namespaceURI, name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    element.textContent = text;
    parent.append(element);
    return element;
  }

  /* A number as text, with a typographic minus sign, which a zero has not. */
  const write = (value, digits) => (Number(value.toFixed(digits)) + 0).toFixed(digits).replace("-", "−");

  /* Round numbers from `low` to `high`, about five, with their labels. */
  function ticksOf(low, high) {
    const rough = (high - low) / 4;
    const power = Math.floor(Math.log10(rough));
    const factor = [1, 2, 5, 10].find((one) => one * 10 ** power >= rough * 0.999);
    const step = factor * 10 ** power;
    const first = Math.ceil(low / step - 1e-6);
    return Array.from({ length: Math.floor(high / step + 1e-6) - first + 1 }, (_, k) => {
      const value = (first + k) * step;
      return { value, label: write(value, Math.max(0, -power - (factor === 10))) };
    });
  }

  /* How far a line is from a height, where it is below or above a name: 0 if it crosses the height. */
  const distance = (points, [from, to], height) => Math.min(...points.map(([x, y], k) => {
    const [before, beside] = points[k - 1] ?? [x, y];
    if (x < from || before > to) return Infinity;
    return Math.max(Math.min(y, beside) - height, height - Math.max(y, beside), 0);
  }));

  /* Writes the name of a curve beside it, where the other lines are farthest, and adds it to them;
     returns the text and its sample. Where all are close, no name would say which is which. */
  function writeName(svg, { name, mark, points }, lines, [left, right, top, bottom]) {
    const half = 3.8 * name.length; // half of its width
    const curves = lines.filter((line) => line.length > 2);
    const others = lines.filter((line) => line !== points);
    let best = { gap: APART };
    for (let at = 0; at < points.length; at += Math.ceil(points.length / TRIED)) {
      const [x, y] = points[at];
      if (curves.some((one) => one !== points && Math.abs((one[at]?.[1] ?? Infinity) - y) < 6)) continue;
      for (const [dx, dy] of [[0, -9], [0, 11], [half + 6, 0], [-half - 6, 0]]) {
        const [middle, height] = [x + dx, y + dy];
        const span = [middle - half, middle + half];
        if (span[0] < left || span[1] > right || height < top + 5 || height > bottom - 5) continue;
        if (distance(points, span, height) < 6) continue;
        const gap = Math.min(...others.map((line) => distance(line, span, height)));
        if (gap > best.gap) best = { gap, x: middle, height, span, at };
      }
    }
    if (!best.span) return [];
    lines.push(best.span.map((end) => [end, best.height]));
    const place = { x: best.x, y: best.height + 4, "text-anchor": "middle", class: `name ${mark}` };
    return [{ text: add(svg, "text", place, name), at: best.at }];
  }

  /* Draws a plot from the start; all lengths are CSS pixels.
     curves: [{name, times, values, mark, chosen}], `mark` a class of palette.css, `name` not always written;
     levels: [{value, mark}]; ticks: [{value, label}]; low, high: ends of the value axis; end: of time [s].
     Returns x and y, from time and value to pixels, share, from pixels to a share of the time, and grow,
     which leaves of the curves what lies before a sample and at it. */
  function draw(svg, { title, width, height, curves, levels, ticks, low, high, end }) {
    const across = width - EDGE.left - EDGE.right;
    const floor = height - EDGE.bottom;
    const x = (time) => EDGE.left + (time / end) * across;
    const y = (value) => floor - ((value - low) / (high - low)) * (floor - EDGE.top);
    svg.replaceChildren();
    svg.classList.add("time-plot");
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    svg.setAttribute("height", height);
    add(svg, "text", { x: 0, y: 14, class: "title" }, title);
    for (const { value, label } of ticksOf(0, end)) {
      add(svg, "line", { x1: x(value), x2: x(value), y1: EDGE.top, y2: floor, class: "grid" });
      const text = value ? label : `${label} s`;
      add(svg, "text", { x: x(value), y: height - 6, "text-anchor": "middle" }, text);
    }
    for (const { value, label } of ticks) {
      if (!value) add(svg, "line", { x1: x(0), x2: x(end), y1: y(0), y2: y(0), class: "grid" });
      add(svg, "text", { x: EDGE.left - 6, y: y(value) + 4, "text-anchor": "end" }, label);
    }
    for (const { value, mark } of levels) {
      add(svg, "line", { x1: x(0), x2: x(end), y1: y(value), y2: y(value), class: `level ${mark}` });
    }
    const placed = curves.map(({ times, values, ...curve }) => (
      { ...curve, points: values.map((v, k) => [x(times[k]), y(v)]) }
    ));
    const lines = placed.map(({ mark, chosen, points }) => {
      const pairs = points.map((pair) => pair.map((pixels) => pixels.toFixed(1)).join());
      const line = { class: `curve ${mark}${chosen ? " chosen" : ""}`, points: pairs.join(" ") };
      return { line: add(svg, "polyline", line), points: pairs };
    });
    const taken = placed.map(({ points }) => points);
    const texts = placed.flatMap(({ name, mark }, k) => (
      name ? writeName(svg, { name, mark, points: taken[k] }, taken, [x(0), x(end), EDGE.top, floor]) : []
    ));
    function grow(sample) {
      for (const { line, points } of lines) {
        line.setAttribute("points", points.slice(0, sample + 1).join(" "));
      }
      for (const { text, at } of texts) text.style.display = at > sample ? "none" : "";
    }
    return { x, y, floor, top: EDGE.top, share: (pixels) => (pixels - EDGE.left) / across, grow };
  }

  return { add, draw, ticksOf, write };
})();
