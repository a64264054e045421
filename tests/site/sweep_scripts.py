"""What a visit of the sweep runs in a page."""

MEASURE = 40
"""Longest line of running text, in letter heights; one holds about two letters."""
WATCH_SHIFTS = """
window.shifts = [];
const note = entries => {
  for (const { value, sources } of entries) {
    shifts.push([value, sources.map(source => source.node?.outerHTML?.slice(0, 80))]);
  }
};
const observer = new PerformanceObserver(list => note(list.getEntries()));
observer.observe({ type: "layout-shift", buffered: true });
window.allShifts = () => {
  note(observer.takeRecords()); // those of which it has not been told yet
  return shifts;
};
"""
LOADED = """() => [
  ...performance.getEntriesByType("navigation"), ...performance.getEntriesByType("resource"),
].map(entry => ({
  name: new URL(entry.name).pathname,
  bytes: entry.encodedBodySize,
  blocking: entry.renderBlockingStatus === "blocking",
}))"""
READ = """async () => {
  const within = (ms) => new Promise(done => setTimeout(done, ms));
  const frame = () => Promise.race([new Promise(requestAnimationFrame), within(1000)]);
  const end = performance.now() + 30000;
  const seen = () => [...document.images].every(image => {
    const { top, bottom } = image.getBoundingClientRect();
    return image.complete || !image.checkVisibility() || bottom < 0 || top > innerHeight;
  });
  await frame();
  for (let top = 0; top < document.body.scrollHeight; top += 0.9 * innerHeight) {
    scrollTo({ top, behavior: "instant" });
    while (!seen() && performance.now() < end) await frame();
    await frame(); // by now the frame before is drawn: this part, and its shifts
  }
  scrollTo({ top: 0, behavior: "instant" });
}"""
"""Reads a page to its end, and waits for the images in sight, together no longer than 30 s."""

IMAGES = """async () => {
  const early = [...document.querySelectorAll("article img")]
    .filter((image) => !(+image.getAttribute("width") && +image.getAttribute("height"))
      || image.getAttribute("loading") !== "lazy")
    .map(image => `without a size, or loaded at once: ${image.src}`);
  const all = [...document.images];
  for (const image of all) image.loading = "eager";
  const end = performance.now() + 30000; // what has not come by then is named as empty
  while (!all.every(image => image.complete) && performance.now() < end) {
    await new Promise(done => setTimeout(done, 20));
  }
  const empty = all.filter(image => !image.naturalWidth).map(image => `empty: ${image.src}`);
  const changed = all.filter(image => {
    const style = getComputedStyle(image);
    const edge = side => parseFloat(style[`padding${side}`]);
    const width = image.clientWidth - edge("Left") - edge("Right");
    const height = image.clientHeight - edge("Top") - edge("Bottom");
    const said = image.getAttribute("width") / image.getAttribute("height");
    const is = image.naturalWidth / image.naturalHeight;
    const squeezed = style.objectFit === "fill" && Math.abs(width / height / is - 1) > 0.02;
    return image.checkVisibility() && (squeezed || Math.abs(said / is - 1) > 0.02);
  }).map(image => `another shape: ${image.src}`);
  return [...early, ...empty, ...changed];
}"""
TAB_ORDER = """() => [...document.querySelectorAll("*")].filter(element => element.tabIndex > 0)
  .map(element => element.outerHTML.slice(0, 100))"""
MIDDLE_ROWS = "tr:nth-child(n+11):nth-last-child(n+11)"
"""Neither gone through by Tab nor looked at by axe-core: a table shows with the ten rows at either
end how it takes the focus, and what its cells are like."""

ONE_OF_EACH = """() => {
  document.querySelectorAll("article svg :is(path, use)").forEach(curve => curve.remove());
  const seen = new Set();
  for (const token of document.querySelectorAll("article pre span[class]")) {
    const kind = `${token.parentElement.className} > ${token.className}`;
    if (seen.has(kind)) token.replaceWith(...token.childNodes);
    seen.add(kind);
  }
}"""
"""Takes out what has neither text nor size of its own: curves, and in code the words of a kind that
is there already."""

NOTE_FOCUS = """() => {
  const visited = new Set();
  window.stops = [];
  document.addEventListener("keyup", () => {
    const element = document.activeElement;
    if (element === document.body || visited.has(element)) stops.ended = true;
    if (stops.ended) return;
    visited.add(element);
    const style = getComputedStyle(element);
    const boxes = [...element.getClientRects()].filter(box => box.width && box.height);
    const seen = boxes.some(box => {
      const [left, top] = [Math.max(box.left, 0), Math.max(box.top, 0)];
      const [right, bottom] = [Math.min(box.right, innerWidth), Math.min(box.bottom, innerHeight)];
      if (right <= left || bottom <= top) return false;
      return [0.1, 0.5, 0.9].some(share => {
        const at = document.elementFromPoint(left + share * (right - left), (top + bottom) / 2);
        return element.contains(at);
      });
    });
    let opaque = 1;
    for (let e = element; e; e = e.parentElement) opaque *= getComputedStyle(e).opacity;
    stops.push({
      what: element.outerHTML.slice(0, 120),
      outlined: style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 2,
      seen: seen && opaque > 0.5,
    });
  });
}"""
"""Notes where the focus is after each key, until it leaves the page or comes back."""

OPEN_FOLDS = "document.querySelectorAll('details').forEach(fold => { fold.open = true; })"
SCROLL_BOXES = """() => [...document.querySelectorAll("article *")].filter(element => {
  const { overflowX, visibility } = getComputedStyle(element);
  return /auto|scroll/.test(overflowX) && element.scrollWidth > element.clientWidth
    && element.clientWidth && visibility === "visible";
}).filter(element => element.tabIndex !== 0
  || !(element.ariaLabel || element.querySelector(":scope > figcaption, :scope > caption")),
).map(element => `not reached, or without a name: ${element.outerHTML.slice(0, 100)}`)"""
LAYOUT = """() => {
  const width = document.documentElement.clientWidth;
  const scrolls = (node) => ["auto", "scroll"].includes(getComputedStyle(node).overflowX);
  const boxed = (node) => {
    for (let up = node.parentElement; up && up.tagName !== "MAIN"; up = up.parentElement) {
      if (scrolls(up) && up.getBoundingClientRect().right <= width + 1) return true;
    }
    return false;
  };
  const out = [...document.querySelectorAll("article *")].filter((node) => {
    const { right, width: own } = node.getBoundingClientRect();
    const hidden = node.ownerSVGElement; // a drawing hides what is outside of it
    return own > 1 && right > width + 1 && !hidden && !boxed(node);
  });
  const long = [...document.querySelectorAll("article p:not(.admonition-title), article li")]
    .filter((node) => !node.closest("table, figure") && node.offsetParent)
    .filter((node) => node.clientWidth / parseFloat(getComputedStyle(node).fontSize) > MEASURE);
  return {
    wide: document.documentElement.scrollWidth > Math.min(width, innerWidth),
    out: out.map((node) => node.outerHTML.slice(0, 120)),
    long: long.map((node) => node.outerHTML.slice(0, 120)),
  };
}""".replace("MEASURE", str(MEASURE))
