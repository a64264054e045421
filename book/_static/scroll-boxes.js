/* A box that scrolls sideways can be reached and scrolled by keyboard, and has a name. */
"use strict";

(() => {
  const NAMES = {
    "div.math": "Formula",
    "div.cell_output pre": "Output",
    pre: "Code",
    ".explorer .cells": "Map",
    ".pst-scrollable-table-container": "Table",
    ".cell_output > .output": "Output",
  };
  const BOXES = Object.keys(NAMES).map((kind) => `main :is(${kind})`).join(", ");

  function mark(box) {
    const name = NAMES[Object.keys(NAMES).find((kind) => box.matches(kind))];
    const { overflowX, overflowY } = getComputedStyle(box);
    const across = box.scrollWidth > box.clientWidth && /auto|scroll/.test(overflowX);
    const down = box.scrollHeight > box.clientHeight && /auto|scroll/.test(overflowY);
    for (const [key, value] of [["tabindex", 0], ["role", "group"], ["aria-label", name]]) {
      if (across || down) box.setAttribute(key, value);
      else box.removeAttribute(key);
    }
  }

  /* Sizes change with the window, with larger text, and when a fold around the box opens. */
  const observer = new ResizeObserver((changes) => {
    const boxes = changes.map(({ target }) => target.closest(BOXES)); // null where it was removed
    new Set(boxes.filter(Boolean)).forEach(mark);
  });
  function watch(place) {
    for (const box of place.querySelectorAll(BOXES)) {
      for (const element of [box, ...box.children]) observer.observe(element);
    }
  }
  watch(document);

  /* A fold that opens: a long table in it is only text until then, which loads faster. The observer can
     miss a box whose size is the one that it last told. */
  function insert(fold) {
    const text = fold.querySelector(":scope > noscript");
    if (!text) return;
    text.outerHTML = text.textContent;
    watch(fold);
  }
  document.addEventListener("toggle", ({ target }) => {
    insert(target);
    target.querySelectorAll(BOXES).forEach(mark);
  }, true); // the event does not bubble
  addEventListener("beforeprint", () => document.querySelectorAll(".explorer-block details").forEach(insert));
})();
