() => {
  // Notes where the focus is after each key, until it leaves the page or comes back.
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
}
