/* Reads depth, point and closed form of a pixel from the arrays of a recorded view. They are pictures
   in attributes, because a page from disk cannot read the pixels of a file. */
"use strict";

document.addEventListener("DOMContentLoaded", () => {
  /* Bytes of a PNG, four for each pixel. */
  async function decode(text) {
    const image = new Image();
    image.src = `data:image/png;base64,${text}`;
    await image.decode();
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [image.naturalWidth, image.naturalHeight];
    const brush = canvas.getContext("2d", { willReadFrequently: true });
    brush.drawImage(image, 0, 0);
    return brush.getImageData(0, 0, canvas.width, canvas.height).data;
  }

  const dot = (a, b) => a.reduce((sum, value, k) => sum + value * b[k], 0);
  const write = (value, digits) => {
    const rounded = Number(value.toFixed(digits)) + 0; // without the sign of a negative zero
    return rounded.toFixed(digits).replace("-", "−");
  };

  async function start(root) {
    const { size, K, pose, unit, names, planes, spheres } = JSON.parse(root.dataset.view);
    const [depths, numbers] = await Promise.all(
      [root.dataset.depth, root.dataset.segmentation].map(decode),
    );
    const [width, height] = size;
    const find = (name) => root.querySelector(name);
    const [column, row] = ["column", "row"].map((name) => find(`[name=${name}]`));
    const [stage, cross] = [".stage", ".cross"].map(find);
    const centre = pose.map((line) => line[3]);

    /* From the camera through the middle of a pixel, with 1 along the optical axis. */
    function ray(u, v) {
      const seen = [(u + 0.5 - K[0][2]) / K[0][0], (v + 0.5 - K[1][2]) / K[1][1], 1];
      return pose.map((line) => dot(line.slice(0, 3), seen));
    }

    /* The depth in closed form, NaN where the ray misses, undefined for other shapes. */
    function closedForm(number, direction) {
      if (number in planes) return (planes[number] - centre[2]) / direction[2];
      if (!(number in spheres)) return undefined;
      const [middle, radius] = [spheres[number].slice(0, 3), spheres[number][3]];
      const away = centre.map((value, k) => value - middle[k]);
      const [a, b] = [dot(direction, direction), dot(direction, away)];
      return (-b - Math.sqrt(b * b - a * (dot(away, away) - radius * radius))) / a;
    }

    function values(u, v) {
      const at = 4 * (v * width + u);
      const number = numbers[at];
      const depth = (65536 * depths[at] + 256 * depths[at + 1] + depths[at + 2]) * unit;
      if (number === 0) return [names[0], `${write(depth, 3)} m: no surface`, "–", "–", "–"];
      const direction = ray(u, v);
      const point = centre.map((value, k) => write(value + depth * direction[k], 4)).join(", ");
      const expected = closedForm(number, direction);
      const found = [names[number], `${write(depth, 4)} m`, `${point} m`];
      if (expected === undefined) return [...found, "none for this shape", "–"];
      if (Number.isNaN(expected)) return [...found, "this ray misses the ideal sphere", "–"];
      return [...found, `${write(expected, 4)} m`, `${write(1000 * (depth - expected), 2)} mm`];
    }

    function show() {
      const [u, v] = [Number(column.value), Number(row.value)];
      const texts = [`column ${u}, row ${v}`, ...values(u, v)];
      root.querySelectorAll("dd").forEach((line, k) => { line.textContent = texts[k]; });
      for (const input of [column, row]) {
        input.setAttribute("aria-valuetext", `${texts[0]}: ${texts[1]}, depth ${texts[2]}`);
      }
      cross.style.left = `${(100 * (u + 0.5)) / width}%`;
      cross.style.top = `${(100 * (v + 0.5)) / height}%`;
    }

    function point(event) {
      if (event.buttons !== 1) return;
      const { left, top, width: across, height: down } = stage.getBoundingClientRect();
      column.value = Math.floor((width * (event.clientX - left)) / across);
      row.value = Math.floor((height * (event.clientY - top)) / down);
      show();
    }

    for (const part of [cross, find(".panel")]) part.hidden = false;
    stage.onpointerdown = stage.onpointermove = point;
    stage.ondragstart = () => false;
    for (const input of [column, row]) input.addEventListener("input", show);
    show();
  }

  document.querySelectorAll(".picture-reader").forEach(start);
});
