async () => {
  const early = [...document.querySelectorAll("article img")]
    .filter((image) => !(+image.getAttribute("width") && +image.getAttribute("height"))
      || image.getAttribute("loading") !== (image.fetchPriority === "high" ? "eager" : "lazy"))
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
}
