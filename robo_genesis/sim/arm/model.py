"""A robot: its model file, in a lesson or of the engine, and what the course has to know of it.

A lesson with another robot than the Franka:

1. Put its MJCF or URDF into the lesson's folder of the package, with what it includes
below it:
   `lessons/l09/arm.xml`. The folder is part of evidence key, page fingerprint and
   wheel.
2. `spec.py` has the `RobotModel`, and cases with an entry in each array for each joint;
one without
   a motor has zero `kp`, `kv` and `effort_limit`:

       ARM = RobotModel("lessons/l09/arm.xml", ("shoulder", "slide"), hand="tool")
       BASELINE = ControlCase(model=ARM, q_start=np.array([0.2, 0.1]), kp=…,
       effort_limit=…, …)

3. The page loads it. Without `default_armature=None` the engine adds 0.1 kg·m² to each
joint whose
   file says nothing; a URDF also needs `fixed=True`. `describe` names what differs from
   the file:

       arm = scene.add_entity(gs.morphs.MJCF(
           file=rg.model_file("lessons/l09/arm.xml"), default_armature=None))
       joints = l09.describe(page, arm, l09.spec.ARM)

   In a lecture this visible cell also has `import robo_genesis as rg`.
4. `pages.py` has `joints=spec.ARM.joints`, and the authors of a shape that is not yours
   as `credit`; `structure` has the counts of this robot (links with the base, joints and
   DOFs without fixed ones) and prints what it found. `driven_run` takes the robot from
   the case; `solve_ik`, `hand_pose` and `sim/mujoco/` take it as `of`; the rest of
   `sim/arm/kinematics.py` knows the Franka alone. Tests need a `JointMap` of the robot in
   the lesson's `conftest.py`.
5. A free base, as that of a quadruped, is `free_base=True`: `run_case` drives the legs.
   What needs a fixed base says so.
6. For feedback, a force F on a joint is the target q + F/KP with a small KP (1 N/m) and
   `kv=0`. Derive the case from `Controlled`; the loop is `reset`, then for each step a
   target, `control_dofs_position`, `scene.step()` and `read`, at the end `assemble`. The
   law is `driven_run(trace, case.commanding(trace.target), links)`.
"""

from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from robo_genesis.core import project


class ModelError(ValueError):
    """A robot is not as its `RobotModel` says, or not one that a rule knows; it says what to do."""


@dataclass(frozen=True, slots=True)
class RobotModel:
    """What the course has to know of a robot whose driven joints have one DOF each.

    | field | meaning |
    |---|---|
    | `file` | its MJCF or URDF, as in `model_file` |
    | `joints` | all driven joints, in the order of every array |
    | `hand` | the link that reaches targets and carries loads, if it has one |
    | `fingers` | how many of the last joints are fingers, which reach no target |
    | `tip` | from the hand's origin to the ends of the fingers, along its z axis [m] |
    | `free_base` | whether its base moves freely, as that of a quadruped |
    """

    file: str
    joints: tuple[str, ...]
    hand: str = ""
    fingers: int = 0
    tip: float = 0.0
    free_base: bool = False

    @property
    def arm(self) -> int:
        """The number of joints that move the hand."""
        return len(self.joints) - self.fingers


def model_file(name: str) -> str:
    """Return the path of a robot's model, for the engine and for MuJoCo, on each machine.

    Args:
        name: `lessons/l07/arm.xml` for a file in the package's folder of a lesson; a
            file of the engine by its path below the engine's assets.

    Raises:
        ModelError: there is no such file, or the name leads elsewhere.
    """
    place, owner = Path(__file__).parents[2], "The package robo_genesis"
    advice = (
        "A lesson's models and their meshes lie in "
        f"{place / 'lessons'}/lNN, named lessons/lNN/…"
    )
    if not name.startswith("lessons/"):
        found = find_spec("genesis")
        place = (
            Path(found.origin if found and found.origin else "genesis").parent
            / "assets"
        )
        owner = f"{project.ENGINE}=={project.engine_pin()}"
        again = project.install_command(f"--force-reinstall --no-deps {owner}")
        advice = f"If it is one of the engine, run {again}. {advice}"
    path = place / name
    if ".." in path.parts or not path.is_relative_to(place) or not path.is_file():
        raise ModelError(f"{owner} has no model {name!r}. {advice}.")
    return str(path)
