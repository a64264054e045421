/* Judges the number of a question, and announces the feedback of every question. */
"use strict";

document.addEventListener("change", ({ target }) => {
  const question = target.closest("fieldset.choice");
  if (!question) return;
  const texts = [...question.querySelectorAll(".feedback")];
  let shown = target.parentElement.querySelector(".feedback");
  if (target.type === "number") {
    const { value, tolerance } = question.dataset;
    const difference = target.valueAsNumber - Number(value);
    const side = difference < 0 ? "low" : "high";
    const key = Math.abs(difference) <= Number(tolerance) ? "right" : side;
    shown = target.value ? texts.find((text) => text.dataset.key === key) : null;
    for (const text of texts) text.classList.toggle("shown", text === shown);
  }
  question.querySelector("output").textContent = shown?.textContent ?? "";
});
