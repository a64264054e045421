"""Time the step loop of L04 with and without its reads, in turn: `make bench` reads the result.

Usage: steps.py RUNS FILE. The file gets [[seconds with records, seconds without], ...].
"""

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path

from scene import build

from robo_genesis import l04
from robo_genesis.joint_control import reset, run_case

CASE = l04.G1


def seconds(task: Callable[[], object]) -> float:
    """Return how long a task takes."""
    begin = time.perf_counter()
    task()
    return time.perf_counter() - begin


def main(runs: str, file: str) -> int:
    """Measure; the first pair, in which something may still compile, is left out."""
    scene, robot, joints, _ = build(camera=False)

    def bare() -> None:
        reset(scene, robot, joints, CASE)
        q_target, dofs = CASE.q_target.copy(), joints.dofs_idx_local.tolist()
        for _ in range(CASE.steps):
            robot.control_dofs_position(q_target, dofs)
            scene.step()

    def recorded() -> None:
        run_case(scene, robot, joints, CASE)

    pairs = [(seconds(recorded), seconds(bare)) for _ in range(int(runs) + 1)]
    Path(file).write_text(json.dumps(pairs[1:]), "utf8")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
