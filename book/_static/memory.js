/* What this browser remembers of a reader: answers, what was shown, finished pages, and the last page.
   Nothing leaves the browser. Some browsers keep nothing for pages that were opened from disk. */
"use strict";

globalThis.memory = (() => {
  const STORE = "robo-genesis";
  const page = location.pathname.split("/").slice(-3).join("/");

  function read() {
    try {
      return JSON.parse(localStorage.getItem(STORE)) ?? {};
    } catch {
      return {};
    }
  }

  /* Returns whether the browser keeps it. */
  function write(all) {
    try {
      localStorage.setItem(STORE, JSON.stringify(all));
      return true;
    } catch {
      return false;
    }
  }

  const ofPage = (all) => ((all.pages ??= {})[page] ??= {});

  /* A value of this page by its name. */
  const kept = (name) => ofPage(read())[name];

  function keep(name, value) {
    const all = read();
    ofPage(all)[name] = value;
    write(all);
  }

  function forget() {
    try {
      localStorage.removeItem(STORE);
    } catch {
      // nothing was kept
    }
  }

  return { read, write, kept, keep, forget, page };
})();

document.addEventListener("DOMContentLoaded", () => {
  const { read, write, kept, keep, forget, page } = globalThis.memory;
  const article = document.querySelector("article");
  const title = article?.querySelector("h1")?.firstChild?.textContent;

  /* Answers by the text of their question, which stays when questions move: the number of the option,
     or what was typed. The scripts of questions and replays treat them as given, without a word. */
  const inputsOf = (question) => [...question.querySelectorAll("[type=radio], [type=number]")];
  const asked = (question) => question.querySelector("legend").textContent.trim();
  for (const question of document.querySelectorAll("fieldset.choice")) {
    const answer = kept(asked(question));
    if (answer === undefined) continue;
    const inputs = inputsOf(question);
    const input = inputs[0].type === "number" ? inputs[0] : inputs[answer];
    if (!input) continue;
    if (input.type === "radio") input.checked = true;
    else input.value = answer;
    const given = new CustomEvent("change", { bubbles: true, detail: "kept" });
    setTimeout(() => input.dispatchEvent(given));
  }
  document.addEventListener("change", ({ target, detail }) => {
    const question = target.closest("fieldset.choice");
    if (!question || detail === "kept") return;
    const answer = target.type === "radio" ? inputsOf(question).indexOf(target) : target.value;
    keep(asked(question), answer === "" ? undefined : answer);
  });

  /* The home page: where to go on, what is finished, and how to forget it. */
  const place = document.querySelector(".memory");
  const all = read();
  if (place) {
    if (!all.last) return;
    const go = Object.assign(document.createElement("a"), { href: all.last.href, textContent: all.last.title });
    const away = Object.assign(document.createElement("button"), { type: "button", textContent: "Forget all" });
    away.addEventListener("click", () => {
      forget();
      place.replaceChildren("Forgotten.");
      place.focus();
      for (const mark of document.querySelectorAll(".finished")) mark.remove();
    });
    place.append("Continue where you left off: ", go, ". Answers and finished pages are kept in this browser alone. ", away);
    for (const link of document.querySelectorAll(".course-map .time a")) {
      const name = new URL(link.href).pathname.split("/").slice(-3).join("/");
      if (!all.pages?.[name]?.finished) continue;
      link.after(Object.assign(document.createElement("span"), { className: "finished", textContent: " ✓ finished" }));
    }
    return;
  }

  /* The link to the form for feedback names the section at the top of the window. */
  const report = document.querySelector(".report a");
  const address = report && new URL(report.href);
  const reported = address?.searchParams.get("page");
  report?.addEventListener("click", () => {
    const above = [...article.querySelectorAll("h2, h3")].filter((one) => one.getBoundingClientRect().top < 200);
    const section = above.at(-1)?.firstChild.textContent ?? title;
    address.searchParams.set("page", `${reported}, "${section}"`);
    report.href = address;
  });

  /* A page of a lesson: it is the last one, and its end offers to mark it. */
  if (!article || !/\/lessons\//.test(location.pathname)) return;
  if (!write({ ...all, last: { href: location.href.split("#")[0], title } })) return;
  const box = Object.assign(document.createElement("input"), { type: "checkbox", id: "finished" });
  box.checked = Boolean(kept("finished"));
  box.addEventListener("change", () => keep("finished", box.checked || undefined));
  const label = Object.assign(document.createElement("label"), { htmlFor: box.id, textContent: " I have finished this page" });
  const line = Object.assign(document.createElement("p"), { className: "finish-page" });
  line.append(box, label);
  article.append(line);
});
