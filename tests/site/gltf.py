"""The validator of 3D models."""

import json
import subprocess
from pathlib import Path
from typing import Any

from robo_genesis.pipeline import npm

VALIDATE = """
const [, , validator, file] = process.argv;
require(validator).validateBytes(new Uint8Array(require("fs").readFileSync(file)))
  .then(report => console.log(JSON.stringify(report)));
"""


def report(glb: bytes, folder: Path) -> dict[str, Any]:
    """Return what the validator finds in a GLB; the folder gets its files."""
    file, program = folder / "model.glb", folder / "validate.js"
    file.write_bytes(glb)
    program.write_text(VALIDATE)
    command = [npm.node(), program, npm.packages() / "gltf-validator", file]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)
