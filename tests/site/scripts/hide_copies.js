() => {
  // Hides the copies of links at their target in the running viewer.
  const viewer = document.querySelector("model-viewer");
  const scene = viewer[Object.getOwnPropertySymbols(viewer).find(s => s.description === "scene")];
  scene.traverse(node => { if (node.name === "target") node.visible = false; });
  scene.queueRender();
}
