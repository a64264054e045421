/* The robot or body of recorded runs in 3D, for the replay and the maps of postures. The viewer and the
   model load when a reader asks for them. */
"use strict";

globalThis.Scene = (() => {
  /* Adds a script once for all replays of the page; a script that failed is added again. */
  const requested = {};
  function script(src) {
    requested[src] ??= new Promise((onload, onerror) => {
      const element = document.createElement("script");
      document.head.append(Object.assign(element, { src, onload, onerror }));
    });
    requested[src].catch(() => delete requested[src]);
    return requested[src];
  }

  /* The viewer needs WebGL 2: without it, the viewer would report success and show nothing. */
  const draws3D = () => document.createElement("canvas").getContext("webgl2") !== null;

  /* Light from above, as a small picture. Without a graphics card, the viewer's own surroundings
     would take seconds before the first frame. */
  function light() {
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [128, 64];
    const brush = canvas.getContext("2d");
    brush.fillStyle = brush.createLinearGradient(0, 0, 0, canvas.height);
    brush.fillStyle.addColorStop(0, "#fff");
    brush.fillStyle.addColorStop(1, "#888");
    brush.fillRect(0, 0, canvas.width, canvas.height);
    return canvas.toDataURL();
  }

  /* The 3D model, in step with the replay. A classic script and a data: address work from disk. */
  return class {
    viewer = null;

    constructor(root) {
      this.root = root;
    }

    /* Loads the model, and tells the reader how that went: without it there are `others`. */
    async open(what, others) {
      const status = this.root.querySelector("[role=status]");
      if (!draws3D()) {
        status.textContent = `This browser draws no 3D: its WebGL 2 is missing or turned off. ${others}`;
        return;
      }
      status.textContent = "Loading …";
      try {
        await this.load();
        status.textContent = "Turn the view with the mouse, a finger or the arrow keys.";
      } catch {
        status.textContent = `The ${what} cannot be shown: a file is missing or cannot be read. ${others}`;
      }
    }

    async load() {
      const { viewer, model, name, alt, orbit, target } = this.root.dataset;
      await Promise.all([script(viewer), script(model)]);
      const stage = this.root.querySelector(".stage");
      const element = document.createElement("model-viewer");
      const distance = `auto auto ${orbit.split(" ").at(-1)}`; // the viewer's own limits are farther
      const settings = {
        alt, loading: "eager", "camera-controls": "", "disable-zoom": "", "disable-tap": "",
        "disable-pan": "", "interaction-prompt": "none", "touch-action": "pan-y",
        "camera-orbit": orbit, "camera-target": target,
        "min-camera-orbit": distance, "max-camera-orbit": distance,
        "environment-image": light(), exposure: "1.25", "animation-crossfade-duration": "0",
        src: `data:model/gltf-binary;base64,${globalThis.replayModels[name]}`,
      };
      for (const [key, value] of Object.entries(settings)) element.setAttribute(key, value);
      await new Promise((resolve, reject) => {
        element.addEventListener("load", resolve);
        element.addEventListener("error", (event) => {
          element.remove();
          reject(event.detail);
        });
        stage.append(element);
      });
      stage.classList.add("loaded");
      this.viewer = element;
    }

    /* Shows a share of the copies at the target, whose material alone is translucent. */
    fade(share) {
      const copies = this.viewer?.model?.materials
        .find((one) => one.isLoaded && one.getAlphaMode() === "BLEND");
      const look = copies?.pbrMetallicRoughness;
      this.opacity ??= look?.baseColorFactor[3];
      look?.setBaseColorFactor([...look.baseColorFactor.slice(0, 3), this.opacity * share]);
    }

    /* The case first: a new animation begins at its own start. */
    async pose(name, time) {
      const { viewer } = this;
      if (!viewer) return;
      if (viewer.animationName !== name) {
        viewer.animationName = name;
        await viewer.updateComplete;
      }
      viewer.currentTime = Math.min(time, viewer.duration - 1e-7); // at its end it would start again
    }
  };
})();
