"""Camera frames and the OpenGL renderer that draws them."""

import importlib
from typing import Any, NamedTuple

import numpy as np

from robo_genesis.core.scene import FRAME_SHAPE


class FrameError(ValueError):
    """A camera returned something else than a usable RGB frame."""


class Renderer(NamedTuple):
    """The OpenGL implementation that renders."""

    vendor: str
    name: str

    @property
    def software(self) -> bool:
        """Whether it is Mesa's software rasteriser."""
        return any(
            word in self.name.lower() for word in ("llvmpipe", "softpipe", "swrast")
        )


def read_renderer(scene: Any) -> Renderer:
    """Read GL_VENDOR and GL_RENDERER from the scene's OpenGL context."""
    gl = importlib.import_module("OpenGL.GL")
    # Genesis has no public access to it
    context = scene.visualizer._rasterizer._renderer
    context.make_current()
    try:
        vendor, name = (
            gl.glGetString(item).decode() for item in (gl.GL_VENDOR, gl.GL_RENDERER)
        )
    finally:
        context.make_uncurrent()
    return Renderer(vendor, name)


def capture(camera: Any, shape: tuple[int, ...] = FRAME_SHAPE) -> np.ndarray:
    """Render one frame (rows, columns, 3) of the camera's shape, uint8.

    Raises:
        FrameError: the frame is not usable.
    """
    # also where no step has changed the scene
    rgb = camera.render(force_render=True)[0]
    require_frame(rgb, shape)
    return np.array(rgb)


def require_frame(rgb: Any, expected: tuple[int, ...] = FRAME_SHAPE) -> None:
    """Raise FrameError unless `rgb` is a non-empty RGB picture of the expected shape."""
    shape = np.shape(rgb)
    if shape != expected:
        raise FrameError(f"The camera returned shape {shape}, expected {expected}.")
    picture = np.asarray(rgb)
    if picture.tobytes() == picture[0, 0].tobytes() * (shape[0] * shape[1]):
        raise FrameError(
            f"The camera returned an empty picture: every pixel is {picture[0, 0].tolist()}. "
            "It shows only the background. Check the camera's `pos` and `lookat`."
        )
