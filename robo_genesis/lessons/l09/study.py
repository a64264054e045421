"""What the pages of L09 do: demonstrate, train, act, ask, and record."""

from collections.abc import Callable
from dataclasses import fields, replace
from functools import partial
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Demonstrations, Episodes
from robo_genesis.sim.arm import ladder, picking
from robo_genesis.sim.arm.batch import Batch
from robo_genesis.sim.arm.joints import describe
from robo_genesis.sim.arm.kinematics import hand_pose
from robo_genesis.sim.arm.picking import PickCase

from . import spec
from .cloning import EVERY, Acting, Clones, Rows, Showing, joined
from .experts import KINDS, RETREAT
from .metrics import RUNGS, Copies
from .remedies import Asking
from .settings import Training


class Study:
    """The scene of a page, and what its experts showed.

    Args:
        page: an open page.
        gs: the engine after `gs.init`.
        view: arguments of the camera, None without one.
    """

    def __init__(self, page: Any, gs: Any, view: dict[str, Any] | None = None) -> None:
        self.page = page
        self.world = picking.build(gs, spec.DEMONSTRATED, view)
        self.joints = describe(page, self.world.robot)
        page.links = [*page.links, "object"]
        self.shown: dict[tuple[str, float], Rows] = {}
        self.demonstrations: Demonstrations
        self.last: Batch

    def run(self, case: PickCase, of: Callable[..., Any]) -> tuple[Any, Episodes]:
        """Let an expert or clones act in all environments; return them and the samples."""
        made: list[Any] = []

        def begin(*given: Any) -> Any:
            made.append(of(*given))
            return made[0]

        trace, self.last = picking.run(self.world, self.joints, case, begin)
        return made[0], trace

    def expert(self, name: str) -> int:
        """Let an expert act at the starts of the tests; return how often it succeeds."""
        trace = self.run(spec.TRIED, KINDS[name])[1]
        return int((rungs(trace, spec.TRIED) == len(RUNGS)).sum())

    def demonstrate(self, training: Training) -> Rows:
        """Return the rows of all 128 demonstrations of a kind; the first call records them."""
        key = training.expert, training.noise
        if key not in self.shown:
            case = spec.DEMONSTRATED
            shown, trace = self.run(case, partial(Showing, training))
            self.shown[key] = shown.rows()
            parts = {of.name: getattr(trace, of.name) for of in fields(Episodes)}
            target = np.stack(self.last.sent, dtype=np.float32)
            self.demonstrations = Demonstrations(**parts, target=target)
            name = training.expert + "_noisy" * (training.noise > 0)
            good = int((rungs(trace, case) == len(RUNGS)).sum())
            known = self.page.readings.get("experts", {})
            self.page.readings["experts"] = {**known, name: good}
        return self.shown[key]

    def train(self, training: Training, answers: Rows | None = None) -> Clones:
        """Train a kind of clones on its demonstrations, and on answers besides."""
        rows = self.demonstrate(training).of(slice(training.demonstrations))
        return Clones(training, joined(rows, answers) if answers else rows)

    def keep(self, name: str, clones: Clones, trace: Episodes) -> None:
        """Record a kind of clones and their episodes by name."""
        shown = self.demonstrate(replace(clones.training, noise=0.0))
        other = shown.of(slice(-spec.HELD_OUT, None))
        self.page.traces[name] = Copies(
            t=np.arange(len(clones.losses) + 1.0) * EVERY,
            loss=clones.losses,
            error=clones.errors(other).astype(float),
            weights=clones.digests(),
            rungs=rungs(trace, spec.TRIED).astype(np.int8),
        )

    def test(self, name: str, clones: Clones) -> None:
        """Let clones act at the starts of the tests, and record them."""
        self.keep(name, clones, self.run(spec.TRIED, partial(Acting, clones))[1])

    def successes(self, clones: Clones) -> np.ndarray:
        """Return in how many of its episodes each network succeeds, without a record."""
        trace = self.run(spec.TRIED, partial(Acting, clones))[1]
        good = rungs(trace, spec.TRIED) == len(RUNGS)
        return np.asarray(good.reshape(spec.NETWORKS, -1).sum(axis=1))

    def record(self, *names: str) -> None:
        """Train, test and record kinds of a page, those without answers."""
        for name in names:
            training = self.page.experiment.cases[name]
            self.test(name, self.train(training))

    def show(self, name: str) -> None:
        """Keep the shown episode of the batch that ran last, at all its steps."""
        self.page.traces[name] = self.last.trace(spec.ROW)

    def ask(self, clones: Clones, always: bool = False) -> Rows:
        """Let clones act while an expert answers; return the answers of 16 episodes."""
        of = partial(Asking, clones, self.solve, always)
        rows = self.run(spec.QUESTIONED, of)[0].rows()
        chosen = np.arange(len(spec.ASKED)) % spec.EACH < spec.ANSWERED
        seen = {name: of[:, chosen] for name, of in rows.seen.items()}
        return Rows(seen, rows.command[:, chosen], rows.used[:, chosen])

    def solve(self, places: FloatArray) -> tuple[FloatArray, np.ndarray]:
        """Return goals for objects at places (e, 2) and whether the solver accepts them."""
        case = replace(spec.QUESTIONED, beliefs=places)
        return picking.plan(self.world.robot, self.joints, case)

    def postures(self) -> dict[str, float]:
        """Return how far two answers about one place of the hand are apart.

        Both put the hand above the bowl: solved for the start of the object, and for an
        object in the bowl.
        """
        starts = spec.TRIED.starts
        ends = [
            self.solve(of)[0][RETREAT]
            for of in (starts, 0 * starts + spec.TRIED.bowl_at)
        ]
        hands = [hand_pose(np.pad(q, [(0, 0), (0, 2)])).position for q in ends]
        return {
            "joints": float(np.median(np.abs(ends[1] - ends[0]).max(axis=1))),
            "hand": float(np.median(np.linalg.norm(hands[1] - hands[0], axis=1))),
        }


def rungs(trace: Episodes, case: PickCase) -> np.ndarray:
    """Return how many rungs each episode passes."""
    return ladder.count(ladder.of_object(trace, case))
