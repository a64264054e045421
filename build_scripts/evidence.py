"""Record a lab's evidence on this machine: `make evidence LESSON=l04`.

Environment: LESSON (which lab), BACKEND=amdgpu|cuda|cpu (the backend that must be found; unset, any
accelerator) and TO (folder for the bundle; unset, `book/evidence`). The camera is always used.
Exit status: 0 recorded, 1 failed, 130 interrupted; unless it is 0, the old bundle is unchanged.
"""

import os
import sys

from robo_genesis.build.command import choice, parser, path, run
from robo_genesis.build.recording import Recording, record
from robo_genesis.core.project import RENDER

if __name__ == "__main__":
    args = parser(__doc__).parse_args()
    for name in ("RENDER", RENDER):
        choice(name, "1", ("1",), " for a recording, which always has camera frames. Unset it")
    recording = Recording(
        lesson=os.environ.get("LESSON") or "",
        expected=os.environ.get("BACKEND") or None,
        to=path("TO"),
        **vars(args),
    )
    sys.exit(run(lambda: record(recording), "recorded"))
