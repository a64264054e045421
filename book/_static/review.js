/* The page with all questions: those that were missed, then those without an answer. */
"use strict";

document.addEventListener("DOMContentLoaded", () => {
  const { read, nameOf } = globalThis.memory;
  const list = document.querySelector(".all-questions");
  const { pages = {} } = read();
  const [missed, open, right] = [[], [], []];
  for (const item of list.children) {
    const { value, tolerance, right: answer } = item.dataset;
    const link = item.querySelector("a");
    const given = pages[nameOf(link.href)]?.[link.hash.slice(1)];
    const isRight = value ? Math.abs(given - value) <= tolerance : String(given) === answer;
    (given === undefined ? open : isRight ? right : missed).push(item);
  }
  if (missed.length + right.length === 0) return;
  document.querySelector(".review").textContent = `Missed: ${missed.length}. Right: ${right.length}. Without an answer: ${open.length}.`;
  for (const item of missed) item.prepend(Object.assign(document.createElement("strong"), { textContent: "Missed: " }));
  list.replaceChildren(...missed, ...open);
});
