/* Judges the number of a question, announces the feedback of every question, and shows what a question
   hides when it has an answer or its own answer is opened. */
"use strict";

document.addEventListener("change", ({ target, detail }) => {
  const question = target.closest("fieldset.choice");
  if (!question) return;
  if (target.value) question.classList.add("answered");
  const texts = [...question.querySelectorAll(".feedback")];
  let shown = target.parentElement.querySelector(".feedback");
  if (target.type === "number") {
    const [value, tolerance] = [question.dataset.value, question.dataset.tolerance].map(Number);
    const near = (factor) => Math.abs(target.valueAsNumber - factor * value) <= factor * tolerance;
    const wrong = texts.map((text) => text.dataset.key).find((k) => near(Number(k.slice(1))));
    const key = near(1) ? "right" : wrong ?? (target.valueAsNumber < value ? "low" : "high");
    shown = target.value ? texts.find((text) => text.dataset.key === key) : null;
    for (const text of texts) text.classList.toggle("shown", text === shown);
  }
  const waits = question.classList.contains("waits"); // for the replay below
  const said = waits ? "Noted. Play the run, or move its time to the end." : shown?.textContent;
  if (detail !== "kept") question.querySelector("output").textContent = said ?? "";
});

document.addEventListener("toggle", ({ target }) => {
  if (target.matches("details")) target.closest("fieldset.choice")?.classList.add("answered");
}, true); // the event does not bubble
