(most) => {
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
    .filter((node) => node.clientWidth / parseFloat(getComputedStyle(node).fontSize) > most);
  return {
    wide: document.documentElement.scrollWidth > Math.min(width, innerWidth),
    out: out.map((node) => node.outerHTML.slice(0, 120)),
    long: long.map((node) => node.outerHTML.slice(0, 120)),
  };
}
