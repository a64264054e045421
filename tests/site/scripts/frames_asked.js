async () => {
  // How often the replay asks to draw while ten frames pass.
  const request = requestAnimationFrame.bind(window);
  let asked = 0;
  window.requestAnimationFrame = (todo) => {
    asked += todo.name === "advance"; // the viewer also draws
    return request(todo);
  };
  for (let frame = 0; frame < 10; frame += 1) await new Promise(request);
  window.requestAnimationFrame = request;
  return asked;
}
