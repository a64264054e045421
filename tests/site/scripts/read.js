async () => {
  // Reads a page to its end, and waits for the images in sight, together no longer than 30 s.
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
}
