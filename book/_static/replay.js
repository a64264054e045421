/* Replays recorded runs: a 3D model, which loads with the first Play, curves and a readout. The
   samples are those of the table in the same block, and attributes of the markup describe them:
   this script handles channels, neither joints nor bodies. */
"use strict";

/* plot.js and stage.js have loaded by then, in whatever order the page lists the scripts. */
document.addEventListener("DOMContentLoaded", () => {
  const { add, ticksOf, write } = globalThis.timePlot;
  const { kept, keep } = globalThis.memory;
  const HEIGHT = 150;
  const STRIDE = 5; // samples that one press advances where reduced motion is preferred
  const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;

  /* Case → {time, values: [one array a channel], mark, levels}. The table's columns: time, then the
     channels of each case in turn. It is in the page as text; see scroll-boxes.js. */
  function read(root, radios, channels) {
    const { textContent } = root.parentElement.querySelector("details > noscript");
    const [, , ...lines] = textContent.split("<tr"); // a parser would take four times as long
    const number = (cell) => Number(/>([^<>]+)</.exec(cell)[1].replace("−", "-"));
    const rows = lines.map((line) => line.split("<td").slice(1).map(number));
    const time = rows.map((row) => row[0]);
    return Object.fromEntries(radios.map((radio, k) => {
      const first = 1 + k * channels.length;
      const values = channels.map((_, c) => rows.map((row) => row[first + c]));
      const { mark, levels } = radio.dataset;
      return [radio.value, { time, values, mark, levels: JSON.parse(levels) }];
    }));
  }

  /* Draws one plot of all cases; returns the function that moves its cursor, and shows the part of
     the curves that was seen. */
  function draw(svg, { width, curves, levels, title, top: highest, pick }) {
    const drawn = levels.flatMap(({ mark, values }) => values.map((value) => ({ value, mark })));
    const all = [...curves.flatMap((c) => c.values), ...drawn.map((l) => l.value)]
      .filter((value) => value <= (highest ?? Infinity));
    const [least, most] = [Math.min(...all), Math.max(...all)];
    const margin = 0.08 * (most - least || 1); // a constant value also needs a range
    const { times, values, mark } = curves.find(({ chosen }) => chosen);
    const { x, y, floor, top, share, grow } = globalThis.timePlot.draw(svg, {
      width, title, curves, levels: drawn, height: HEIGHT, low: least - margin, high: most + margin,
      end: times.at(-1), ticks: ticksOf(least - margin, most + margin),
    });
    const line = add(svg, "line", { y1: top, y2: floor, class: "cursor" });
    const dot = add(svg, "circle", { r: 4.5, class: `dot ${mark}` });
    svg.onpointerdown = svg.onpointermove = (event) => {
      if (event.buttons === 1) pick(share(event.clientX - svg.getBoundingClientRect().left));
    };
    return (time, sample, seen) => {
      grow(seen);
      line.setAttribute("x1", x(time));
      line.setAttribute("x2", x(time));
      dot.setAttribute("cx", x(times[sample]));
      dot.setAttribute("cy", Math.max(y(values[sample]), top)); // at the edge, if it is not drawn
    };
  }

  function start(root) {
    const { subject, thing } = root.dataset;
    const channels = JSON.parse(root.dataset.channels);
    const timeDigits = Number(root.dataset.timeDigits);
    const radios = [...root.querySelectorAll("input[type=radio]")];
    const runs = read(root, radios, channels);
    const [slider, speed, play, shown, rest] = ["input[type=range]", "select", ".play", ".shown", ".rest"]
      .map((name) => root.querySelector(name));
    const scene = new globalThis.Scene(root);
    const [terms, texts, places] = ["dt", "dd", ".plot"].map((name) => root.querySelectorAll(name));
    const svgs = [...places].map((place) => add(place, "svg", { role: "img" }));
    const all = Number(slider.max);
    let last = rest ? Number(rest.dataset.until) : all; // the motion first, the rest on request
    const block = root.parentElement;
    /* Of a blind replay, nothing shows before the question above has an answer, and its feedback waits
       for the curves. They appear with the time: `seen` is the last sample so far. */
    const blind = block.classList.contains("growing") && !kept(root.dataset.name);
    const question = blind && [...document.querySelectorAll("fieldset.choice")]
      .findLast((one) => one.compareDocumentPosition(root) & Node.DOCUMENT_POSITION_FOLLOWING);
    let seen = blind ? 0 : last;
    let cursors = [];
    let playing = null; // {clock, time, next}: of the last frame [ms], of the run [s], the next frame
    let loading; // undefined before the model was asked for

    const chosen = () => radios.find((radio) => radio.checked).value;
    const run = () => runs[chosen()];
    const sample = () => Number(slider.value);

    /* The texts of the readout, in the order of its terms: time, channels, levels. */
    function readout() {
      const { time, values, levels } = run();
      const k = sample();
      const withUnit = (value, unit, digits) => `${write(value, digits)} ${unit}`;
      return [
        withUnit(time[k], "s", timeDigits) + (k ? "" : ", before the first step"),
        ...channels.map(({ unit, digits }, c) => withUnit(values[c][k], unit, digits)),
        ...levels.map((level) => level.text),
      ];
    }

    /* How far the first channel is from its target: 0 near it, 1 from a third of the way back. */
    function distance() {
      const { values: [of], levels } = run();
      const [target] = levels.find(({ mark }) => mark.endsWith("target"))?.values ?? [NaN];
      const share = Math.abs((of[sample()] - target) / (of[0] - target));
      return Math.min(Math.max(4 * share - 0.4, 0), 1) || 0;
    }

    /* A screen reader reads time and channels at the slider. */
    function showSample(time = run().time[sample()]) {
      const lines = readout();
      const spoken = lines.slice(0, 1 + channels.length)
        .map((text, k) => `${terms[k].textContent} ${text}`).join("; ");
      slider.setAttribute("aria-valuetext", `${chosen()}: ${spoken}`);
      lines.forEach((text, k) => { texts[k].textContent = text; });
      seen = Math.max(seen, sample());
      for (const cursor of cursors) cursor(time, sample(), seen);
      if (seen === last && block.classList.contains("growing")) reveal();
      // The picker may be out of sight. The picture before the model is of the start.
      if (scene.viewer) Object.assign(shown, { textContent: chosen(), className: `shown case-mark ${run().mark}` });
      scene.pose(chosen(), time);
      scene.fade(distance());
    }

    function drawPlots() {
      const width = places[0].clientWidth;
      if (!width) return showSample(); // they are hidden, and drawn when they show
      cursors = channels.map(({ name, unit, top }, k) => {
        const curves = Object.entries(runs).map(([one, { time, values, mark }]) => ({
          times: time.slice(0, last + 1), values: values[k].slice(0, last + 1), mark,
          name: radios.length > 1 ? one : "", chosen: one === chosen(),
        }));
        const title = `${name[0].toUpperCase()}${name.slice(1)} [${unit}]`;
        const about = `${title} of ${subject} over time; ${chosen()} is drawn bold.`;
        svgs[k].setAttribute("aria-label", about);
        const drawn = run().levels.filter(({ channel }) => channel === name);
        return draw(svgs[k], { width, curves, levels: drawn, title, top, pick });
      });
      showSample();
    }

    /* Shows everything, and announces whether the answer was right. */
    function reveal() {
      seen = last;
      keep(root.dataset.name, true);
      block.classList.remove("veiled", "growing");
      question?.classList.remove("waits");
      question?.querySelector("input:checked, input[type=number]")
        ?.dispatchEvent(new Event("change", { bubbles: true }));
      drawPlots();
    }

    function stop() {
      cancelAnimationFrame(playing.next);
      playing = null;
      label();
      showSample(); // back onto a sample of the record
    }

    function label() {
      const step = `Next ${(STRIDE * run().time[1]).toFixed(timeDigits)} s`;
      play.textContent = calm ? step : playing ? "Pause" : "Play";
    }

    function advance(clock) {
      const { time } = run();
      playing.time += ((clock - (playing.clock ?? clock)) / 1000) * Number(speed.value);
      playing.clock = clock;
      slider.value = Math.min(Math.floor(playing.time / time[1] + 1e-6), last);
      if (playing.time >= time[last]) return stop();
      showSample(playing.time);
      playing.next = requestAnimationFrame(advance);
    }

    /* Loads the model. Where that fails, the plots play alone. */
    async function load() {
      loading = true;
      play.textContent = "Loading …";
      await scene.open(thing, "The plots show the same runs.");
      loading = false;
      showSample(); // the time may be another one than that of the picture
      label();
    }

    play.addEventListener("click", async () => {
      if (loading) return;
      if (!scene.viewer && !playing) await load();
      if (sample() === last) slider.value = 0;
      else if (calm) slider.value = sample() + STRIDE;
      if (calm) return showSample();
      if (playing) return stop();
      playing = { time: run().time[sample()] };
      label();
      playing.next = requestAnimationFrame(advance);
    });

    function jump() {
      if (playing) stop();
      showSample();
      if (loading === undefined) load(); // the picture shows the start
    }

    function pick(share) {
      slider.value = Math.round(share * last);
      jump();
    }

    slider.addEventListener("input", jump);
    rest?.addEventListener("click", () => {
      slider.max = last = all;
      seen = all;
      rest.parentElement.remove();
      slider.focus({ preventScroll: true });
      drawPlots();
    });
    for (const radio of radios) radio.addEventListener("change", drawPlots);

    slider.max = last;
    if (calm) speed.closest("p").style.visibility = "hidden";
    root.classList.add("ready");
    if (!blind) block.classList.remove("veiled", "growing"); // it was shown before
    if (question) {
      question.classList.add("waits");
      question.addEventListener("change", ({ target }) => {
        if (target.value) block.classList.remove("veiled");
      });
      root.querySelector(".veil button").addEventListener("click", () => {
        reveal();
        play.focus({ preventScroll: true });
      });
    }
    label();
    showSample();
    new ResizeObserver(drawPlots).observe(root.querySelector(".plots")); // and before the first frame
  }

  document.querySelectorAll(".replay").forEach(start);
});
