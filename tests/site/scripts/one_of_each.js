() => {
  // Takes out what has neither text nor size of its own: curves, and in code the words of a kind
  // that is there already.
  document.querySelectorAll("article svg :is(path, use)").forEach(curve => curve.remove());
  const seen = new Set();
  for (const token of document.querySelectorAll("article pre span[class]")) {
    const kind = `${token.parentElement.className} > ${token.className}`;
    if (seen.has(kind)) token.replaceWith(...token.childNodes);
    seen.add(kind);
  }
}
