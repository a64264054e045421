/* Replays recorded runs: curves, readout and, on request, the robot in 3D. The samples are those of
   the table in the same block; this script reads them there and holds no number of its own. */
"use strict";

(() => {
  const SVG = "http://www.w3.org/2000/svg";
  const EDGE = { left: 52, right: 10, top: 24, bottom: 22 };
  const HEIGHT = 150;
  const STRIDE = 5; // samples that one press advances where motion is not wanted
  const calm = matchMedia("(prefers-reduced-motion: reduce)");

  const minus = (text) => text.replace("-", "−");
  const number = (text) => Number(text.trim().replace("−", "-"));

  function add(parent, name, attributes, text = "") {
    const element = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    element.textContent = text;
    parent.append(element);
    return element;
  }

  /* Case → {t, values: [q, q̇, force], target, limit, units}; the table has three columns a case. */
  function read(root, radios) {
    const rows = [...root.parentElement.querySelectorAll("tbody tr")].map((row) =>
      [...row.cells].map((cell) => number(cell.textContent)),
    );
    const time = rows.map((row) => row[0]);
    return Object.fromEntries(radios.map((radio, k) => {
      const { target, limit, position, effort } = radio.dataset;
      const values = [1, 2, 3].map((column) => rows.map((row) => row[3 * k + column]));
      const units = [position, `${position}/s`, effort];
      return [radio.value, { time, values, target: Number(target), limit: Number(limit), units }];
    }));
  }

  /* One plot of all cases; returns what moves its cursor. */
  function draw(svg, { curves, chosen, marks, title }) {
    const width = svg.parentElement.clientWidth;
    const levels = [...Object.values(curves).flatMap((c) => c.values), ...marks.map((m) => m.value)];
    const [least, most] = [Math.min(...levels), Math.max(...levels)];
    const [low, high] = [least - 0.08 * (most - least), most + 0.08 * (most - least)];
    const { time } = curves[chosen];
    const end = time.at(-1);
    const x = (t) => EDGE.left + (t / end) * (width - EDGE.left - EDGE.right);
    const y = (value) =>
      HEIGHT - EDGE.bottom - ((value - low) / (high - low)) * (HEIGHT - EDGE.top - EDGE.bottom);
    svg.replaceChildren();
    svg.setAttribute("viewBox", `0 0 ${width} ${HEIGHT}`);
    svg.setAttribute("height", HEIGHT);
    add(svg, "text", { x: 0, y: 14, class: "title" }, title);
    for (const share of [0, 0.25, 0.5, 0.75, 1]) {
      const at = x(share * end);
      add(svg, "line", { x1: at, x2: at, y1: EDGE.top, y2: HEIGHT - EDGE.bottom, class: "grid" });
      const label = (share * end).toFixed(1) + (share === 0 ? " s" : "");
      add(svg, "text", { x: at, y: HEIGHT - 6, class: "middle" }, label);
    }
    for (const value of least < 0 && most > 0 ? [least, 0, most] : [least, most]) {
      const label = value ? minus(value.toPrecision(3)) : "0";
      if (!value) add(svg, "line", { x1: x(0), x2: x(end), y1: y(0), y2: y(0), class: "grid" });
      add(svg, "text", { x: EDGE.left - 6, y: y(value) + 4, class: "end" }, label);
    }
    for (const { value, kind } of marks) {
      add(svg, "line", { x1: x(0), x2: x(end), y1: y(value), y2: y(value), class: kind });
    }
    for (const [name, curve] of Object.entries(curves)) {
      const points = curve.values.map((v, k) => `${x(time[k]).toFixed(1)},${y(v).toFixed(1)}`);
      const state = name === chosen ? " chosen" : "";
      const style = `curve case-${name.toLowerCase()}${state}`;
      add(svg, "polyline", { points: points.join(" "), class: style, "data-case": name });
    }
    const line = add(svg, "line", { y1: EDGE.top, y2: HEIGHT - EDGE.bottom, class: "cursor" });
    const dot = add(svg, "circle", { r: 4.5, class: `dot case-${chosen.toLowerCase()}` });
    svg.onpointerdown = svg.onpointermove = (event) => {
      if (event.buttons !== 1) return;
      const at = event.clientX - svg.getBoundingClientRect().left;
      const share = (at - EDGE.left) / (width - EDGE.left - EDGE.right);
      svg.dispatchEvent(new CustomEvent("pick", { detail: share, bubbles: true }));
    };
    return (t, sample) => {
      line.setAttribute("x1", x(t));
      line.setAttribute("x2", x(t));
      dot.setAttribute("cx", x(time[sample]));
      dot.setAttribute("cy", y(curves[chosen].values[sample]));
    };
  }

  /* Adds a script once, however many replays of the page ask for it; one that failed, anew. */
  const asked = new Map();
  function script(source) {
    const adding = () => new Promise((resolve, reject) => {
      const element = document.createElement("script");
      element.src = source;
      element.onload = resolve;
      element.onerror = () => {
        asked.delete(source);
        reject(new Error(source));
      };
      document.head.append(element);
    });
    if (!asked.has(source)) asked.set(source, adding());
    return asked.get(source);
  }

  /* What the viewer draws with: without it, it would say that it loaded, and show nothing. */
  const draws3D = () => document.createElement("canvas").getContext("webgl2") !== null;

  /* The robot in 3D, in step with the replay. A classic script and a data: address work from disk. */
  class Robot {
    constructor(root) {
      this.root = root;
      this.viewer = null;
    }

    async load(about) {
      const { viewer, model, name } = this.root.dataset;
      await Promise.all([script(viewer), script(model)]);
      const element = document.createElement("model-viewer");
      const settings = {
        alt: about, loading: "eager", "camera-controls": "", "disable-zoom": "", "disable-tap": "",
        "interaction-prompt": "none", "touch-action": "pan-y", "shadow-intensity": "0.8",
        "camera-orbit": "45deg 72deg 90%", "camera-target": "0.2m 0.52m 0m", exposure: "0.7",
        "animation-crossfade-duration": "0",
        src: `data:model/gltf-binary;base64,${globalThis.replayModels[name]}`,
      };
      for (const [key, value] of Object.entries(settings)) element.setAttribute(key, value);
      const loaded = new Promise((resolve, reject) => {
        element.addEventListener("load", resolve, { once: true });
        element.addEventListener("error", (event) => reject(event.detail), { once: true });
      });
      this.root.querySelector(".stage").append(element);
      await loaded;
      this.viewer = element;
    }

    /* The case first: a new animation begins at its own start. */
    async pose(name, time) {
      const { viewer } = this;
      if (!viewer) return;
      if (viewer.animationName !== name) {
        viewer.animationName = name;
        await viewer.updateComplete;
      }
      viewer.currentTime = Math.min(time, viewer.duration - 1e-7); // at its end it would start anew
    }
  }

  function start(root) {
    const radios = [...root.querySelectorAll("input[type=radio]")];
    const runs = read(root, radios);
    const [slider, speed] = ["input[type=range]", "select"].map((name) => root.querySelector(name));
    const [play, show] = [".play", ".show"].map((name) => root.querySelector(name));
    const { joint } = root.dataset;
    const robot = new Robot(root);
    const svgs = [0, 1, 2].map(() => add(root.querySelector(".plots"), "svg", { role: "img" }));
    const last = Number(slider.max);
    let cursors = [];
    let began = null; // {clock, time}: when playing started [ms], and at which time of the run [s]
    let frame = 0; // the request for the next frame while playing

    const chosen = () => radios.find((radio) => radio.checked).value;
    const run = () => runs[chosen()];
    const sample = () => Number(slider.value);

    /* [term, description]; the first four are said by a screen reader at the slider. */
    function readout() {
      const { time, values, target, limit, units } = run();
      const k = sample();
      const write = (value, unit, digits = 4) => `${minus(value.toFixed(digits))} ${unit}`;
      return [
        ["time", write(time[k], "s", 2) + (k ? "" : ", before the first step")],
        ["position", write(values[0][k], units[0])],
        ["velocity", write(values[1][k], units[1])],
        ["control force", write(values[2][k], units[2], 2)],
        ["target", write(target, units[0])],
        ["force limit", `±${limit.toFixed(0)} ${units[2]}`],
      ];
    }

    function showSample(time = run().time[sample()]) {
      const lines = readout();
      const spoken = lines.slice(0, 4).map(([term, text]) => `${term} ${text}`).join("; ");
      slider.setAttribute("aria-valuetext", `${chosen()}: ${spoken}`);
      root.querySelector("dl").replaceChildren(...lines.map(([term, text]) => {
        const row = document.createElement("div");
        const [dt, dd] = ["dt", "dd"].map((name) => document.createElement(name));
        [dt.textContent, dd.textContent] = [term, text];
        row.append(dt, dd);
        return row;
      }));
      for (const cursor of cursors) cursor(time, sample());
      robot.pose(chosen(), time);
    }

    /* Beside the robot, whose run it is: the picker may be out of sight. */
    function nameCase() {
      const shown = root.querySelector(".shown");
      shown.textContent = chosen();
      shown.className = `shown case-mark case-${chosen().toLowerCase()}`;
    }

    function drawPlots() {
      nameCase();
      const { target, limit, units } = run();
      const names = ["Position", "Velocity", "Control force"];
      const marks = [
        [{ value: target, kind: "target" }], [],
        [-limit, limit].map((value) => ({ value, kind: "limit" })),
      ];
      cursors = svgs.map((svg, k) => {
        const curves = Object.fromEntries(Object.entries(runs).map(([name, one]) => [
          name, { time: one.time, values: one.values[k] },
        ]));
        const title = `${names[k]} [${units[k]}]`;
        svg.setAttribute("aria-label", `${title} of ${joint} over time; ${chosen()} is drawn bold.`);
        return draw(svg, { curves, chosen: chosen(), marks: marks[k], title });
      });
      showSample();
    }

    function stop() {
      began = null;
      cancelAnimationFrame(frame);
      label();
      showSample(); // back onto a sample of the record
    }

    function label() {
      const step = `Next ${(STRIDE * run().time[1]).toFixed(2)} s`;
      play.textContent = calm.matches ? step : began ? "Pause" : "Play";
      speed.closest("p").hidden = calm.matches;
    }

    function advance(clock) {
      const { time } = run();
      began.clock ??= clock;
      const now = began.time + ((clock - began.clock) / 1000) * Number(speed.value);
      slider.value = Math.min(Math.floor(now / time[1] + 1e-6), last);
      if (now >= time[last]) return stop();
      showSample(now);
      frame = requestAnimationFrame(advance);
    }

    play.addEventListener("click", () => {
      if (sample() === last) slider.value = 0;
      else if (calm.matches) slider.value = sample() + STRIDE;
      if (calm.matches) return showSample();
      if (began) return stop();
      began = { clock: null, time: run().time[sample()] };
      label();
      frame = requestAnimationFrame(advance);
    });

    function jump() {
      if (began) stop();
      showSample();
    }
    slider.addEventListener("input", jump);
    speed.addEventListener("change", () => {
      if (began) began = { clock: null, time: run().time[sample()] };
    });
    root.querySelector(".plots").addEventListener("pick", (event) => {
      slider.value = Math.round(event.detail * last);
      jump();
    });
    for (const radio of radios) radio.addEventListener("change", drawPlots);
    calm.addEventListener("change", () => (began ? stop() : label()));

    show.addEventListener("click", async () => {
      const stage = root.querySelector(".stage");
      const status = root.querySelector("[role=status]");
      if (!robot.viewer) {
        if (!draws3D()) {
          status.textContent = "This browser draws no 3D: its WebGL 2 is missing or turned off. The plots show the same runs.";
          return;
        }
        show.disabled = true;
        status.textContent = "Loading …";
        try {
          await robot.load(`The robot in 3D, in the posture of the sample that is shown. ${joint} moves.`);
        } catch (error) {
          status.textContent = "The robot cannot be shown: a file is missing or cannot be read.";
          stage.querySelector("model-viewer")?.remove();
          return;
        } finally {
          show.disabled = false;
        }
        root.querySelector(".weight").remove();
        root.querySelector(".shown").hidden = false;
        status.textContent = "Loaded. Turn it with the mouse, a finger or the arrow keys.";
        showSample();
      } else {
        stage.hidden = !stage.hidden;
      }
      show.setAttribute("aria-expanded", String(!stage.hidden));
      show.textContent = stage.hidden ? "Show the robot in 3D" : "Hide the robot";
    });

    root.hidden = false;
    label();
    new ResizeObserver(drawPlots).observe(root.querySelector(".plots"));
    drawPlots();
  }

  document.querySelectorAll(".replay").forEach(start);
})();
