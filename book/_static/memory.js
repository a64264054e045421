/* What this browser remembers of a reader: answers, what was shown, finished pages, and the last page.
   Each of several sites on one server has its own. Nothing leaves the browser. Some browsers keep nothing for pages that were opened from disk. */
"use strict";

globalThis.memory = (() => {
  const root = new URL(document.documentElement.dataset.content_root ?? ".", location.href);
  const STORE = `robo-genesis ${root.pathname}`;
  const nameOf = (address) => new URL(address).pathname.slice(root.pathname.length);
  const page = nameOf(location.href);
  let store; // undefined where the browser keeps nothing
  try {
    store = localStorage;
  } catch {
    // it is turned off
  }

  const read = () => JSON.parse(store?.getItem(STORE) ?? "{}");
  const write = (all) => store?.setItem(STORE, JSON.stringify(all));
  const ofPage = (all) => ((all.pages ??= {})[page] ??= {});

  /* A value of this page by its name. */
  const kept = (name) => ofPage(read())[name];

  function keep(name, value) {
    const all = read();
    ofPage(all)[name] = value;
    write(all);
  }

  return { read, write, kept, keep, keeps: Boolean(store), root, nameOf, page };
})();

document.addEventListener("DOMContentLoaded", () => {
  const { read, write, kept, keep, keeps, root, nameOf, page } = globalThis.memory;
  const article = document.querySelector("article");
  const make = (name, properties) => Object.assign(document.createElement(name), properties);

  /* Answers by the name of their question, which stays when it moves on its page: the number of the option,
     or what was typed. The scripts of questions and replays treat them as given, without a word. */
  const inputsOf = (question) => [...question.querySelectorAll("[type=radio], [type=number]")];
  for (const question of document.querySelectorAll("fieldset.choice")) {
    const answer = kept(question.id);
    const inputs = inputsOf(question);
    const input = inputs[0].type === "number" ? inputs[0] : inputs[answer];
    if (answer === undefined || !input) continue;
    if (input.type === "radio") input.checked = true;
    else input.value = answer;
    const given = new CustomEvent("change", { bubbles: true, detail: "kept" });
    setTimeout(() => input.dispatchEvent(given));
  }
  document.addEventListener("change", ({ target, detail }) => {
    const question = target.closest("fieldset.choice");
    if (!question || detail === "kept") return;
    const answer = target.type === "radio" ? inputsOf(question).indexOf(target) : target.value;
    keep(question.id, answer === "" ? undefined : answer);
  });

  /* Marks of finished pages in the menu and in the map. */
  function mark() {
    for (const old of document.querySelectorAll(".progress-mark")) old.remove();
    const { pages = {} } = read();
    for (const link of document.querySelectorAll(".bd-links a, .lesson-list a, .course-map .time a")) {
      if (!pages[nameOf(link.href)]?.finished) continue;
      const names = { role: "img", ariaLabel: "finished", title: "finished" };
      link.append(make("span", { className: "progress-mark", textContent: " ✓", ...names }));
    }
  }
  mark();

  /* The home page: where to go on, and how to forget it. */
  const place = document.querySelector(".memory");
  const { last } = read();
  if (place && last) {
    const address = new URL(`${last.page}${last.hash ?? ""}`, root).href;
    const words = last.heading ? `${last.title}, “${last.heading}”` : last.title;
    const go = make("a", { href: address, textContent: words });
    const away = make("button", { type: "button", textContent: "Forget all" });
    away.addEventListener("click", () => {
      write({});
      mark();
      place.replaceChildren("Forgotten.");
      place.focus();
    });
    place.append("Continue where you left off: ", go, ". Answers and finished pages are kept in this browser alone. ", away);
  }

  /* A page of a lesson: it is the last one, at the heading where it was left, and its end offers to mark it. */
  if (!article || !keeps || !page.startsWith("lessons/")) return;
  const title = article.querySelector("h1").firstChild.textContent;
  if (last?.page !== page) write({ ...read(), last: { page, title } });
  document.addEventListener("visibilitychange", () => {
    if (document.visibilityState === "visible" || !read().last) return; // or all was forgotten
    const heading = [...article.querySelectorAll("h2, h3")].filter((one) => one.checkVisibility())
      .findLast((one) => one.getBoundingClientRect().top < 200); // the one at the top of the window
    const hash = heading?.querySelector(".headerlink")?.hash;
    write({ ...read(), last: { page, title, hash, heading: heading?.firstChild.textContent } });
  });
  const box = make("input", { type: "checkbox", checked: kept("finished") });
  box.addEventListener("change", () => {
    keep("finished", box.checked || undefined);
    mark();
  });
  const label = make("label");
  label.append(box, " I have finished this page");
  article.querySelector(".finish-page").append(label);
});
