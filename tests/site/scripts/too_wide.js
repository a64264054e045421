() => [...document.querySelectorAll(".replay")].flatMap(root => {
  // What of the replays is cut off, or reaches into the place beside it, also in narrower panels.
  const widths = ["", ...Array.from({ length: 12 }, (_, k) => `${300 + 15 * k}px`)];
  const edge = root.getBoundingClientRect().right, slider = root.querySelector("input[type=range]");
  const parts = "input, button, select, svg, svg text, dl div, .shown, figcaption, .legend";
  const cut = [...root.querySelectorAll(parts)]
    .filter(e => e.getBoundingClientRect().right > edge).map(e => e.outerHTML);
  for (const run of root.querySelectorAll("input[type=radio]")) {
    run.click();
    for (slider.value = 0; ; slider.stepUp(7)) {
      slider.dispatchEvent(new Event("input"));
      for (root.style.width of widths) {
        for (const line of root.querySelectorAll("dl div")) {
          const text = document.createRange();
          text.selectNodeContents(line);
          const beyond = text.getBoundingClientRect().right - line.getBoundingClientRect().right;
          if (beyond > 0) cut.push(`${run.value} ${slider.value} ${line.innerText} ${beyond}`);
        }
      }
      root.style.width = "";
      if (slider.value === slider.max) break;
    }
  }
  return cut;
})
