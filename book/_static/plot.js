/* Curves over time in an SVG, and what else adds elements, for the replay and the explorer. */
"use strict";

globalThis.timePlot = (() => {
  const SVG = "http://www.w3.org/2000/svg";
  const EDGE = { left: 52, right: 18, top: 24, bottom: 22 };
  const APART = 12; // from a name to the nearest other curve, at least [px]
  const TRIED = 60; // places for a name along a curve

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

  /* How far a curve is from a height, where it is below or above a name: 0 if it crosses the height. */
  const distance = (points, [from, to], height) => Math.min(...points.map(([x, y], k) => {
    const [before, beside] = points[k - 1] ?? [x, y];
    if (x < from || before > to) return Infinity;
    return Math.max(Math.min(y, beside) - height, height - Math.max(y, beside), 0);
  }));

  /* Writes the name of a curve beside it, where other curves and names are farthest, and if there is
     room not on a level; returns the text and its sample. All these are lines of points, and the name's
     is added to `names`. Where all curves lie close together, no name would say which is which. */
  function writeName(svg, { name, mark, points }, others, names, levels, [left, right, top, bottom]) {
    const half = 3.8 * name.length; // half of its width
    let best = { weight: 0 };
    for (let at = 0; at < points.length; at += Math.ceil(points.length / TRIED)) {
      const [x, y] = points[at];
      if (y < top || others.some((other) => Math.abs(other[at][1] - y) < 6)) continue;
      for (const [dx, dy] of [[0, -9], [0, 11], [half + 6, 0], [-half - 6, 0]]) {
        const [middle, height] = [x + dx, y + dy];
        const span = [middle - half, middle + half];
        if (span[0] < left || span[1] > right || height < top + 5 || height > bottom - 5) continue;
        const room = (lines, most) => Math.min(most, ...lines.map((one) => distance(one, span, height)));
        const gap = room([...others, ...names], 30);
        const own = Math.min(9, distance(points, dx ? [span[0] + 3, span[1] - 3] : span, height));
        if (gap < APART || own < 7) continue;
        const weight = gap + own + room(levels, 9);
        if (weight > best.weight) best = { weight, middle, height, span, at };
      }
    }
    if (!best.weight) return [];
    names.push(best.span.map((end) => [end, best.height]));
    const place = { x: best.middle, y: best.height + 4, "text-anchor": "middle", class: `name ${mark}` };
    return [{ text: add(svg, "text", place, name), at: best.at }];
  }

  /* Draws a plot from the start; all lengths are CSS pixels.
     curves: [{name, times, values, mark, chosen}], `mark` a class of palette.css, `name` written where the
     curve is farthest from all others, or not written; levels: [{value, mark}];
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
    const names = [];
    const heights = levels.map(({ value }) => [[x(0), y(value)], [x(end), y(value)]]);
    const texts = placed.filter(({ name }) => name).flatMap((curve) => {
      const others = placed.filter((one) => one !== curve).map(({ points }) => points);
      return writeName(svg, curve, others, names, heights, [x(0), x(end), EDGE.top, floor]);
    });
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
