"""The still picture that a reader sees before a replay starts: its model, drawn without a browser.

The picture has the camera and the first poses of the replay, so the model takes its
place. VTK, which the engine brings, draws it with EGL, which the engine needs.
"""

from io import BytesIO
from tempfile import NamedTemporaryFile

from PIL import Image
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkIOImport import vtkGLTFImporter
from vtkmodules.vtkRenderingCore import vtkLightKit
from vtkmodules.vtkRenderingOpenGL2 import vtkEGLRenderWindow

from .scenery import ASPECT, Camera

SIZE = WIDTH, HEIGHT = 960, round(960 / ASPECT)
SAMPLES = 8  # of each pixel

KEY_LIGHT = 3.0  # Intensity of the light from above; others have a share of it


def picture(model: bytes, camera: Camera) -> bytes:
    """Return the start of a model's replay as WebP; behind the model it is transparent."""
    window, importer = vtkEGLRenderWindow(), vtkGLTFImporter()
    window.SetSize(*SIZE)
    window.SetAlphaBitPlanes(1)
    window.SetMultiSamples(SAMPLES)
    importer.SetRenderWindow(window)
    with NamedTemporaryFile(suffix=".glb") as file:
        file.write(model)
        file.flush()
        importer.SetFileName(file.name)
        importer.Update()
    scene = importer.GetRenderer()
    scene.SetBackgroundAlpha(0.0)
    lights = vtkLightKit()
    lights.SetKeyLightIntensity(KEY_LIGHT)
    lights.SetKeyLightWarmth(0.5)  # white
    lights.AddLightsToRenderer(scene)
    view = scene.GetActiveCamera()
    view.SetFocalPoint(*camera.centre)
    view.SetPosition(*camera.centre + camera.distance * camera.axes[2])
    view.SetViewUp(0, 1, 0)
    scene.ResetCameraClippingRange()
    pixels = vtkUnsignedCharArray()
    window.Render()
    window.GetRGBACharPixelData(0, 0, WIDTH - 1, HEIGHT - 1, 0, pixels)
    # A translucent surface is stored multiplied by its opacity; rows begin at the bottom.
    data = bytes(pixels)  # type: ignore[call-overload] # a buffer, which its stubs omit
    image = Image.frombytes("RGBa", SIZE, data, "raw", "RGBa", 0, -1)
    content = BytesIO()
    image.convert("RGBA").save(content, "WEBP", quality=70)
    return content.getvalue()
