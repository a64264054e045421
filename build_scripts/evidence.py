"""Record labs as evidence on this machine: `make evidence BACKEND=amdgpu`.

Environment: LESSON (the lab; unset, all labs without an accepted bundle of this
    backend),
BACKEND=amdgpu|cuda|cpu (the backend that must be found; unset, any accelerator) and TO (folder for
the bundles; unset, `book/evidence`). The camera is always used.
Exit status: 0 recorded, 1 failed, 130 interrupted; a lab that is not recorded keeps its
    old bundle.
"""

import os
import sys

from robo_genesis.core.project import RENDER
from robo_genesis.pipeline.command import choice, parser, path, run
from robo_genesis.pipeline.recording.labs import Recording, record

if __name__ == "__main__":
    args = parser(__doc__).parse_args()
    for name in ("RENDER", RENDER):
        choice(
            name,
            "1",
            ("1",),
            " for a recording, which always has camera frames. Unset it",
        )
    lesson, expected = os.environ.get("LESSON") or "", os.environ.get("BACKEND") or None
    recording = Recording(lesson, expected, path("TO"), **vars(args))
    sys.exit(run(lambda: record(recording), "recorded"))
