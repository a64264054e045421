"""A scripted expert that picks an object and places it in a bowl, in all environments of a batch.

The table is at z = 0, the height of the robot's base. The fingers close along y of the
world.
"""

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from robo_genesis.core.experiment import json_value
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Episodes
from robo_genesis.sim.bodies import bowl, table
from robo_genesis.sim.bodies.table import SceneCase, World
from robo_genesis.sim.session import CaseError

from . import kinematics
from .batch import Batch
from .engine_kinematics import IkSettings
from .joint_control import ControlCase
from .joints import JointMap, to_numpy
from .kinematics import ARM
from .lifting import FINGERS, HAND_TO_PAD, ask

# The phases of an episode in their order.
PHASES = (
    "pregrasp",
    "descend",
    "close",
    "lift",
    "move",
    "lower",
    "open",
    "retreat",
    "done",
)

_, DESCEND, CLOSE, LIFT, MOVE, LOWER, OPEN, _, DONE = range(len(PHASES))

# By phase, the number of its goal among `waypoints`.
OF_GOAL = (0, 1, 1, 2, 3, 4, 4, 3, 3)

# A phase of the arm ends when each joint is this near to its goal [rad] and slower than
# this [rad/s]; one of the fingers when both are slower than this [m/s].
ARRIVED, SLOW, STILL = 0.015, 0.05, 0.002

# Least outer steps of a phase of the fingers, and most of any phase.
CLOSING, LIMIT = 5, 120


# Settings that each environment has for itself.
OF_ENVIRONMENTS = ("starts", "beliefs", "yaws", "timed", "stride")


@dataclass(frozen=True, slots=True, kw_only=True)
class PickCase(SceneCase):
    """Episodes of a scripted expert, one in each environment of a scene.

    `starts` and `beliefs` (e, 2) are where the object begins and where the expert
    believes it [m]. A sample of `dt` has `commands` of the expert. `settings` are those
    of the solver. The pads grip `pad` below the object's top; `above`, `rise` and
    `drop` are the heights of the pregrasp and of the lift above the grasp, and of the
    object's lower face above the table when it is released [m]. Objects are turned by
    `yaws` (e,) about z, which the expert ignores [rad]. Where `timed` (e,) is above 0,
    the descent ends after as many outer steps, whatever is measured. `stride` (e,) is
    the largest change of a joint's command in one outer step [rad].
    """

    starts: FloatArray
    beliefs: FloatArray
    settings: IkSettings
    commands: int = 5
    pad: float = 0.025
    above: float = 0.10
    rise: float = 0.12
    drop: float = 0.02
    yaws: FloatArray | float = 0.0
    timed: FloatArray | float = 0.0
    stride: FloatArray | float = 0.012

    def __post_init__(self) -> None:
        """Raise CaseError if an object begins over the bowl: its episode would be solved."""
        solved = (
            np.hypot(*(self.starts - self.bowl_at).T)
            < bowl.RIM + max(self.size[:2]) / 2
        )
        if solved.any():
            raise CaseError(
                f"The object of environment {int(solved.argmax())} begins over the bowl at "
                f"{self.bowl_at}. Choose starts beside it: an episode that begins solved shows "
                "nothing."
            )

    @property
    def turns(self) -> FloatArray:
        """Orientations (e, 4) in which the objects begin, (w, x, y, z)."""
        return kinematics.about_z(np.broadcast_to(self.yaws, len(self.starts)))

    @property
    def control(self) -> ControlCase:
        """The settings of the robot in each environment; its steps are those of a command."""
        case, n = self.commanding(self.q_start), self.commands
        return replace(
            case, dt=self.dt / n, substeps=self.substeps // n, steps=self.steps * n
        )

    def episode(self, row: int) -> SceneCase:
        """Return the settings of one episode, at all its outer steps."""
        control = self.control
        return SceneCase(
            shape=self.shape,
            size=self.size,
            place=(*self.starts[row].tolist(), 0.0),
            ball_radius=0.0,
            kp=self.kp,
            kv=self.kv,
            steps=control.steps,
            dt=control.dt,
            substeps=control.substeps,
        )

    @property
    def waypoints(self) -> list[FloatArray]:
        """Positions (e, 3) of the hand [m]: pregrasp, grasp, lifted, above the bowl, at release."""
        grasp = self.size[2] - self.pad + HAND_TO_PAD
        goal = np.broadcast_to(self.bowl_at, np.shape(self.beliefs))
        ends = [
            (self.beliefs, self.above),
            (self.beliefs, 0.0),
            (self.beliefs, self.rise),
            (goal, self.rise),
            (goal, self.drop),
        ]
        return [
            np.column_stack([place, np.full(len(place), grasp + more)])
            for place, more in ends
        ]


def together(cases: Sequence[PickCase]) -> PickCase:
    """Return one batch of the environments of all cases, which have the same settings.

    Raises:
        CaseError: another setting than those of environments differs.
    """
    first, *others = (json_value(asdict(case)) for case in cases)
    shared = first.keys() - OF_ENVIRONMENTS
    differ = sorted(n for n in shared if any(of[n] != first[n] for of in others))
    if differ:
        raise CaseError(
            f"The cases differ in {', '.join(differ)}, which a scene has once. "
            f"Run them one after the other: only {', '.join(OF_ENVIRONMENTS)} may differ."
        )
    of_rows: dict[str, Any] = {}
    for name in OF_ENVIRONMENTS:
        values = [(getattr(case, name), len(case.starts)) for case in cases]
        of_rows[name] = np.concatenate(
            [np.broadcast_to(of, (n, *np.shape(of)[1:])) for of, n in values]
        )
    return replace(cases[0], **of_rows)


def build(
    gs: Any, case: PickCase, view: dict[str, Any] | None = None, **options: Any
) -> World:
    """Build the scene of episodes, with the outer step of a command; see `table.build`."""
    scene = replace(
        case, dt=case.control.dt, substeps=case.control.substeps, ball_radius=0.0
    )
    return table.build(gs, scene, view, n_envs=len(case.starts), **options)


def plan(
    robot: Any, joints: JointMap, case: PickCase, points: list[FloatArray] | None = None
) -> tuple[FloatArray, np.ndarray]:
    """Ask the solver for all waypoints or other `points`, each from the answer before.

    Returns:
        Joint positions (phases, e, 7) at which the phases end [rad], and whether (e,)
        the solver found all of them.
    """
    q_start, settings = np.tile(case.q_start, (len(case.starts), 1)), case.settings
    answers = ask(robot, joints, q_start, settings, points or case.waypoints)
    good = [kinematics.accepted(of.q, of.error, *settings.tolerances) for of in answers]
    return np.stack([answers[at].q[:, :ARM] for at in OF_GOAL]), np.all(good, axis=0)


class Expert:
    """The phase machine of all environments: a phase ends by what is measured, not by time."""

    def __init__(self, case: PickCase, goals: FloatArray, accepted: np.ndarray) -> None:
        """Begin the first phase; environments without accepted goals are done.

        Args:
            case: the settings.
            goals: as of `plan`.
            accepted: as of `plan`.
        """
        self.goals, self.rows = goals, np.arange(len(accepted))
        self.phase = np.where(accepted, 0, DONE)
        self.since = np.zeros(len(accepted), int)
        self.command = np.tile(case.q_start, (len(accepted), 1))
        self.opened = float(case.q_start[-1])
        self.timed = np.broadcast_to(case.timed, len(accepted))
        self.stride = np.broadcast_to(case.stride, len(accepted))[:, None]

    def act(
        self, q: FloatArray, qd: FloatArray, pose: FloatArray | None = None
    ) -> FloatArray:
        """Return the next command (e, 9) from positions and velocities (e, 9) [rad or m].

        This expert knows where the object began, and ignores its present `pose` (e, 7).
        """
        self.since += 1
        ends = self.ends(q, qd) | (self.since >= LIMIT)
        ends &= self.phase < DONE
        self.phase[ends] += 1
        self.since[ends] = 0
        way = self.goals[self.phase, self.rows] - self.command[:, :ARM]
        longest = np.maximum(np.abs(way).max(axis=1, keepdims=True), self.stride)
        self.command[:, :ARM] += way * self.stride / longest
        shut = (self.phase >= CLOSE) & (self.phase < OPEN)
        self.command[:, ARM:] = np.where(shut, 0.0, self.opened)[:, None]
        return self.command

    def ends(self, q: FloatArray, qd: FloatArray) -> np.ndarray:
        """Return in which environments (e,) the present phase has reached its end."""
        near = (
            np.abs(q[:, :ARM] - self.goals[self.phase, self.rows]).max(axis=1) < ARRIVED
        )
        arrived = near & (np.abs(qd[:, :ARM]).max(axis=1) < SLOW)
        by_time = (self.phase == DESCEND) & (self.timed > 0)
        arrived = np.where(by_time, self.since >= self.timed, arrived)
        still = (np.abs(qd[:, ARM:]).max(axis=1) < STILL) & (self.since >= CLOSING)
        return np.where(np.isin(self.phase, (CLOSE, OPEN)), still, arrived)


def pressing(world: World) -> tuple[FloatArray, np.ndarray]:
    """Return normal forces (e, 2) of both fingers on the object [N], and which are touched.

    The engine pads the contacts of a batch to the longest list; its mask says which are
    valid.
    """
    contacts = world.body.get_contacts(with_entity=world.robot)
    a, b, valid, force, normal = (
        to_numpy(contacts[of])
        for of in ("geom_a", "geom_b", "valid_mask", "force_a", "normal")
    )
    along = np.abs((force * normal).sum(axis=-1))
    forces = []
    for name in FINGERS.values():
        link = world.robot.get_link(name)
        of_link = np.isin([a, b], range(link.geom_start, link.geom_end)).any(axis=0)
        forces.append((along * valid * of_link).sum(axis=1))
    # NumPy declares that `any` may also return a single value.
    return np.stack(forces, axis=1), valid.any(axis=1)  # type: ignore[return-value]


def pose(
    world: World, joints: JointMap, q: FloatArray, place: FloatArray, quat: FloatArray
) -> None:
    """Put robot and object of the first environment where they were: q (9,), (3,) and (4,)."""
    # Copies, because the engine's tensors cannot share arrays that are read-only.
    q, place, quat = (np.array(of)[None] for of in (q, place, quat))
    world.robot.set_dofs_position(q, joints.dofs, envs_idx=[0])
    world.body.set_pos(place, envs_idx=[0])
    world.body.set_quat(quat, envs_idx=[0])


def run(
    world: World,
    joints: JointMap,
    case: PickCase,
    of: Callable[..., Expert] = Expert,
    points: list[FloatArray] | None = None,
) -> tuple[Episodes, Batch]:
    """Let the expert work in all environments; return the samples, and the batch of all states.

    `of` makes another expert, and `points` are its waypoints.
    """
    n = len(case.starts)

    def place() -> None:
        world.body.set_pos(np.column_stack([case.starts, np.full(n, case.size[2] / 2)]))
        world.body.set_quat(case.turns)

    batch = Batch(
        world.scene, world.robot, joints, [case.control] * n, (world.body,), place
    )
    expert = of(case, *plan(world.robot, joints, case, points))
    samples = []
    for k in range(case.steps * case.commands + 1):
        q, pos, quat, qd = batch.readings[-1][:4]
        if k % case.commands == 0:
            samples.append(
                (expert.phase.copy(), q, pos[:, -1], quat[:, -1], *pressing(world))
            )
        if k < case.steps * case.commands:
            pose = np.concatenate([pos[:, -1], quat[:, -1]], axis=1)
            batch.command(expert.act(q, qd, pose))
            batch.step(1)
    phase, q, pos, quat, force, touches = map(np.stack, zip(*samples, strict=True))
    return (
        Episodes(
            t=np.arange(case.steps + 1) * case.dt,
            phase=phase.astype(np.int8),
            q=q,
            object_pos=pos,
            object_quat=quat,
            force=force.astype(np.float32),
            touches=touches.astype(np.int8),
        ),
        batch,
    )
