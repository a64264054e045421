() => {
  // How the links stand in the running viewer, in the frame of the record: [m] and (x, y, z, w).
  const viewer = document.querySelector("model-viewer");
  const scene = viewer[Object.getOwnPropertySymbols(viewer).find(s => s.description === "scene")];
  scene.updateMatrixWorld(true);
  let world;
  scene.traverse(node => { if (node.name === "world") world = node; });
  const back = world.matrixWorld.clone().invert();
  const ghost = world.children.find(node => node.name === "target");
  return Object.fromEntries([...world.children, ...ghost?.children ?? []].map(link => {
    const inRecord = back.clone().multiply(link.matrixWorld);
    return [link.name, {
      position: [...link.position.clone().setFromMatrixPosition(inRecord)],
      rotation: [...link.quaternion.clone().setFromRotationMatrix(inRecord)],
    }];
  }));
}
