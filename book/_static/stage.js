/* The robot or body of recorded runs in 3D, for the replay and the maps of postures. The viewer and the
   model load when a reader asks for them. */
"use strict";

/* The 3D model, in step with the replay. A classic script and a data: address work from disk. */
globalThis.Scene = class Scene {
  static requested = {};
  viewer = null;

  constructor(root) {
    this.root = root;
  }

  /* Adds a script once for all replays of the page. */
  static script(src) {
    Scene.requested[src] ??= new Promise((onload, onerror) => {
      const element = document.createElement("script");
      document.head.append(Object.assign(element, { src, onload, onerror }));
    });
    Scene.requested[src].catch(() => delete Scene.requested[src]); // another Play tries again
    return Scene.requested[src];
  }

  /* Light from above, white to #888: without a graphics card, the viewer's own would take seconds. */
  static light = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAIAAAABACAAAAAD3vSCjAAAARklEQVR42u3TwQkAAAgDMQX3"
    + "H1kdw4fpBIFy2XG7AjgHjAsAAGQIACBDFwAAyBAAQIYuAACQIQCADF0AACBDAAAZuuA7YAGfN0CHUmo0SAAAAABJRU5ErkJggg==";

  /* Loads the model, and tells the reader how that went: without it there are `others`. */
  async open(what, others) {
    const status = this.root.querySelector("[role=status]");
    // The viewer needs WebGL 2: without it, it would report success and show nothing.
    if (!document.createElement("canvas").getContext("webgl2")) {
      status.textContent = `This browser draws no 3D: its WebGL 2 is missing or turned off. ${others}`;
      return;
    }
    status.textContent = "Loading …";
    try {
      await this.load();
      status.textContent = "Turn the view by dragging or with the arrow keys. Press a point to centre it, the background to reset.";
    } catch {
      this.root.querySelector("model-viewer")?.remove();
      status.textContent = `The ${what} cannot be shown: a file is missing or cannot be read. ${others}`;
    }
  }

  async load() {
    const { viewer, model, name, alt, orbit, target, closeUp } = this.root.dataset;
    await Promise.all([viewer, model].map(Scene.script));
    const stage = this.root.querySelector(".stage");
    const element = document.createElement("model-viewer");
    const distance = `auto auto ${orbit.split(" ").at(-1)}`; // the viewer's own limits are farther
    const settings = {
      alt, loading: "eager", "camera-controls": "", "interaction-prompt": "none",
      "touch-action": "pan-y", "min-field-of-view": "2deg",
      "camera-orbit": orbit, "camera-target": target,
      "min-camera-orbit": distance, "max-camera-orbit": distance,
      "environment-image": Scene.light, exposure: "1.25", "animation-crossfade-duration": "0",
      src: `data:model/gltf-binary;base64,${globalThis.replayModels[name]}`,
    };
    for (const [key, value] of Object.entries(settings)) element.setAttribute(key, value);
    await new Promise((resolve, reject) => {
      element.addEventListener("load", resolve);
      element.addEventListener("error", reject);
      stage.append(element);
    });
    // The wheel alone scrolls the page.
    stage.addEventListener("wheel", (event) => event.ctrlKey || event.stopPropagation(), true);
    stage.classList.add("loaded");
    this.viewer = element;
    this.addButtons(closeUp);
  }

  /* Buttons that zoom, and where the page declares a close-up, one that shows it. */
  addButtons(closeUp) {
    const { add } = globalThis.timePlot;
    const place = add(this.viewer.parentElement, "p", { class: "zoom" });
    const button = (text, press, name) => {
      const made = add(place, "button", { type: "button", ...name }, text);
      made.addEventListener("click", press);
      return made;
    };
    if (closeUp) {
      const near = button("Close-up", () => {
        this.near = !this.near;
        near.setAttribute("aria-pressed", this.near);
        this.viewer.cameraTarget = this.near ? "0m 0m 0m" : this.root.dataset.target;
        this.viewer.fieldOfView = this.near ? closeUp : "auto";
        this.viewer.jumpCameraToGoal();
        this.pose(...this.posed);
      }, { "aria-pressed": false });
    }
    button("−", () => this.viewer.zoom(-10), { "aria-label": "Zoom out" });
    button("+", () => this.viewer.zoom(10), { "aria-label": "Zoom in" });
  }

  /* Shows a share of the copies at the target, whose material alone is translucent. */
  fade(share) {
    const copies = this.viewer?.model?.materials
      .find((one) => one.isLoaded && one.getAlphaMode() === "BLEND");
    const look = copies?.pbrMetallicRoughness;
    this.opacity ??= look?.baseColorFactor[3];
    look?.setBaseColorFactor([...look.baseColorFactor.slice(0, 3), this.opacity * share]);
  }

  /* The case first: a new animation begins at its own start. In the one of a close-up, the world
     moves, and what the close-up follows stays at the origin. */
  async pose(name, time) {
    this.posed = [name, time];
    const { viewer } = this;
    if (!viewer) return;
    viewer.animationName = this.near ? `${name}, close-up` : name;
    await viewer.updateComplete;
    // The time may have moved on, and at its end the animation would start again.
    viewer.currentTime = Math.min(this.posed[1], viewer.duration - 1e-7);
  }
};
