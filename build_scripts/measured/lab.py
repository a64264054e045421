"""The engine calls of the L04 lab without its page: what `make bench` holds the lab against."""

import sys

from scene import build

from robo_genesis import l04, runtime
from robo_genesis.joint_control import reset, run_case


def main() -> int:
    """Make the lab's calls in the lab's order: build, reset, frame, four runs, frame."""
    scene, robot, joints, camera = build(camera=True)
    reset(scene, robot, joints, l04.BASELINE)
    runtime.capture(camera)
    run_case(scene, robot, joints, l04.BASELINE)
    runtime.capture(camera)
    for name in ("G1", "G2", "G3"):
        run_case(scene, robot, joints, l04.CASES[name])
    return 0


if __name__ == "__main__":
    sys.exit(main())
