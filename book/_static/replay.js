/* Replays recorded runs: curves, readout and, on request, the robot in 3D. The samples are those of
   the table in the same block; this script reads them there and holds no number of its own. */
"use strict";

/* plot.js is there by then, in whichever order the page names the scripts. */
document.addEventListener("DOMContentLoaded", () => {
  const { add, write } = globalThis.timePlot;
  const HEIGHT = 150;
  const STRIDE = 5; // samples that one press advances where motion is not wanted
  const calm = matchMedia("(prefers-reduced-motion: reduce)");

  const number = (text) => Number(text.trim().replace("−", "-"));

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

  const markOf = (name) => `case-${name.toLowerCase()}`;

  /* One plot of all cases; returns what moves its cursor. */
  function draw(svg, { curves, chosen, levels, title }) {
    const all = [...Object.values(curves).flatMap((c) => c.values), ...levels.map((l) => l.value)];
    const [least, most] = [Math.min(...all), Math.max(...all)];
    const margin = 0.08 * (most - least);
    const { times, values } = curves[chosen];
    const { x, y, floor, top, share } = globalThis.timePlot.draw(svg, {
      title, levels, height: HEIGHT, low: least - margin, high: most + margin, end: times.at(-1),
      curves: Object.entries(curves).map(([name, curve]) => ({
        ...curve, mark: markOf(name), chosen: name === chosen,
      })),
      ticks: (least < 0 && most > 0 ? [least, 0, most] : [least, most]).map((value) => ({
        value, label: value ? value.toPrecision(3).replace("-", "−") : "0",
      })),
    });
    const line = add(svg, "line", { y1: top, y2: floor, class: "cursor" });
    const dot = add(svg, "circle", { r: 4.5, class: `dot ${markOf(chosen)}` });
    svg.onpointerdown = svg.onpointermove = (event) => {
      if (event.buttons !== 1) return;
      const detail = share(event.clientX - svg.getBoundingClientRect().left);
      svg.dispatchEvent(new CustomEvent("pick", { detail, bubbles: true }));
    };
    return (time, sample) => {
      line.setAttribute("x1", x(time));
      line.setAttribute("x2", x(time));
      dot.setAttribute("cx", x(times[sample]));
      dot.setAttribute("cy", y(values[sample]));
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
      const said = (value, unit, digits = 4) => `${write(value, digits)} ${unit}`;
      return [
        ["time", said(time[k], "s", 2) + (k ? "" : ", before the first step")],
        ["position", said(values[0][k], units[0])],
        ["velocity", said(values[1][k], units[1])],
        ["control force", said(values[2][k], units[2], 2)],
        ["target", said(target, units[0])],
        ["force limit", `±${said(limit, units[2], 0)}`],
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
      shown.className = `shown case-mark ${markOf(chosen())}`;
    }

    function drawPlots() {
      nameCase();
      const { target, limit, units } = run();
      const names = ["Position", "Velocity", "Control force"];
      const levels = [
        [{ value: target, mark: "target" }], [],
        [-limit, limit].map((value) => ({ value, mark: "limit" })),
      ];
      cursors = svgs.map((svg, k) => {
        const curves = Object.fromEntries(Object.entries(runs).map(([name, one]) => [
          name, { times: one.time, values: one.values[k] },
        ]));
        const title = `${names[k]} [${units[k]}]`;
        svg.setAttribute("aria-label", `${title} of ${joint} over time; ${chosen()} is drawn bold.`);
        return draw(svg, { curves, chosen: chosen(), levels: levels[k], title });
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
});
