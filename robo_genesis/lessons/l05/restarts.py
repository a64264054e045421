"""Answers that need random starts, asked in new processes and after a new start of the engine."""

import json
import os
from typing import Any

from robo_genesis.core.experiment import counts
from robo_genesis.lessons.l05 import spec
from robo_genesis.lessons.l05.run import ask
from robo_genesis.sim import diagnosis, session
from robo_genesis.sim.fresh_process import last_value, run_python

GROUP = "ik_restarts"
COMPARED = ("between_processes", "after_a_new_init", "at_the_second_question")
READINGS = {GROUP: counts(COMPARED)}
"""How many answers differ: of four pairs, of two, and of one."""


def print_answers() -> None:
    """Start the engine twice with the course's seed, and ask the question twice after each start.

    The four answers are the last line that is printed.
    """
    found = []
    for _ in range(2):
        bench = diagnosis.Bench(os.environ)
        for step in (diagnosis.backend, diagnosis.build, diagnosis.names):
            step(bench)
        found += [ask(bench.robot, bench.joints, spec.RESTARTED).q.tolist() for _ in range(2)]
        session.import_engine().destroy()
    print(json.dumps(found))


def read(page: Any) -> None:
    """Give a page the counts, from two new processes that print their answers."""
    call = ["-c", f"from {__name__} import print_answers; print_answers()"]
    first, other = (last_value(run_python(call, {})) for _ in range(2))
    pairs = (first, other), (first[:2], first[2:]), (first[:1], first[1:2])
    counted = [sum(a != b for a, b in zip(*pair, strict=True)) for pair in pairs]
    page.readings[GROUP] = dict(zip(COMPARED, counted, strict=True))
