"""Two engines, one model: what they must share, and where their integrators may part."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from lessons.l04.conftest import LINKS

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import DT
from robo_genesis.lessons.l04 import LECTURE, spec, study, study_spec
from robo_genesis.lessons.l04.metrics import step_metrics
from robo_genesis.lessons.l04.theory import overshoot_share, step_share
from robo_genesis.sim.arm import dynamics
from robo_genesis.sim.arm.franka import FRANKA_MJCF, JOINT_NAMES, Q_START
from robo_genesis.sim.arm.joint_control import run_case
from robo_genesis.sim.arm.joints import resolve_joints
from robo_genesis.sim.mujoco import joints as mujoco_joints

pytestmark = pytest.mark.engine

K = JOINT_NAMES.index(spec.STEPPED_JOINT)
EULER_AGREEMENT = 5e-4
"""What both engines' overshoot may differ by [rad] with one explicit integrator and step."""


def overshoot(trace):
    return step_metrics(trace, K).overshoot


def run_in_new_scene(lab, case, **options):
    scene = lab.gs.Scene(
        sim_options=lab.gs.options.SimOptions(dt=case.dt, substeps=case.substeps),
        show_viewer=False,
        **options,
    )
    scene.add_entity(lab.gs.morphs.Plane())
    robot = scene.add_entity(lab.gs.morphs.MJCF(file=FRANKA_MJCF))
    scene.build()
    return run_case(scene, robot, resolve_joints(robot, JOINT_NAMES), case)


@pytest.mark.parametrize("raised", [0.0, spec.STEP])
def test_both_engines_give_one_inertia_and_one_gravity(lab, raised):
    q = spec.with_entry(Q_START, spec.START_OF_STEP + raised)
    inertia = dynamics.effective_inertia(lab.scene, lab.franka, lab.joints, q)
    gravity = dynamics.gravity_effort(lab.scene, lab.franka, lab.joints, q)
    second_inertia, second_gravity = mujoco_joints.at_rest(spec.BASELINE, q)
    assert inertia[:7] == pytest.approx(second_inertia[:7], rel=1e-3)
    assert gravity[:7] == pytest.approx(second_gravity[:7], rel=2e-3, abs=0.05)


@pytest.mark.parametrize("name", ["G1", "G3"])
def test_the_mass_matrix_holds_the_integrators_term_while_clipped(lab, run, name):
    case = replace(spec.CASES[name], steps=1)
    trace = run(case)
    assert trace.control_force[0, K] == case.effort_limit[K]
    read = dynamics.mass_diagonal(lab.franka, lab.joints.dofs_idx_local.tolist())[K]
    damping = dynamics.passive_damping(lab.franka, lab.joints.dofs_idx_local.tolist())[K]
    bare, _ = mujoco_joints.at_rest(case, Q_START)
    term = dynamics.substep(lab.scene) * (damping + case.kv[K])
    assert read - term == pytest.approx(bare[K], rel=5e-3)
    assert read - bare[K] > 0.4


def mass_matrix(case):
    """MuJoCo's matrix at the case's start: no integrator's term is in it."""
    model = mujoco_joints.load(case, case.dt, "Euler")
    data = mujoco.MjData(model)
    data.qpos[:] = case.q_start
    mujoco.mj_forward(model, data)
    columns = np.zeros((model.nv, model.nv))
    for column, unit in zip(columns, np.eye(model.nv), strict=True):
        mujoco.mj_mulM(model, data, column, unit)
    return columns, data.qfrc_bias.copy()


def speed_after_one_step(case, mass, bias, passive):
    """Substeps of `mass` a = clipped effort - d q̇ - g, by hand, the model as it is at the start."""
    h, q, qd = DT / case.substeps, case.q_start, np.zeros(len(JOINT_NAMES))
    for _ in range(case.substeps):
        demand = case.kp * (case.q_target - q) - case.kv * qd
        effort = np.clip(demand, -case.effort_limit, case.effort_limit)
        qd = qd + h * np.linalg.solve(mass, effort - passive * qd - bias)
        q = q + h * qd
    return qd[K]


@pytest.mark.parametrize("name", study_spec.COMPARED)
def test_the_first_step_is_that_of_the_heavier_joint(run, name):
    case, passive = replace(spec.CASES[name], steps=1), 1.0
    mass, bias = mass_matrix(case)
    heavier = mass + DT / case.substeps * np.diag(passive + case.kv)
    measured = run(case).qd[0, K]
    assert measured == pytest.approx(speed_after_one_step(case, heavier, bias, passive), rel=0.01)
    assert measured < 0.75 * speed_after_one_step(case, mass, bias, passive)


def test_inertia_is_not_read_from_the_posture_before(lab):
    far = spec.with_entry(Q_START, spec.START_OF_STEP + 0.8)
    fresh = dynamics.effective_inertia(lab.scene, lab.franka, lab.joints, Q_START)
    dynamics.effective_inertia(lab.scene, lab.franka, lab.joints, far)
    again = dynamics.effective_inertia(lab.scene, lab.franka, lab.joints, Q_START)
    assert (fresh == again).all()


def test_the_overshoot_converges_with_substeps(lab, run):
    found = [overshoot(run(spec.G2))]
    found += [
        overshoot(run_in_new_scene(lab, study_spec.SUBSTEP_CASES[f"G2_substeps_{n}"]))
        for n in (10, 50)
    ]
    fine = overshoot(mujoco_joints.run_case(spec.G2, LINKS, DT / 100))
    off = np.array(found) - fine
    assert (np.diff(off) < -1e-3).all()
    assert 0 < off[-1] < 0.2 * off[0]


def test_with_one_explicit_integrator_both_engines_agree(lab):
    """At a step fine enough for Euler to hold the stiff wrist without chatter."""
    substeps = 20
    case = replace(spec.G2, substeps=substeps)
    options = lab.gs.options.RigidOptions(integrator=lab.gs.integrator.Euler)
    first = run_in_new_scene(lab, case, rigid_options=options)
    second = mujoco_joints.run_case(case, LINKS, DT / substeps, "Euler")
    assert overshoot(first) == pytest.approx(overshoot(second), abs=EULER_AGREEMENT)
    assert np.abs(first.q - second.q)[:, :7].max() < 2e-3


@pytest.mark.parametrize("name", study_spec.SMALL_STEPPED)
def test_a_small_step_goes_as_theory_says(lab, run, name):
    step, hold = (run(study_spec.STEP_CASES[f"{name}_{kind}"]) for kind in ("small", "hold"))
    inertia = float(dynamics.effective_inertia(lab.scene, lab.franka, lab.joints, Q_START)[K])
    readings = {study.GROUP: {"inertia_Genesis": inertia, "passive_damping": 1.0}}
    found = Experiment(LECTURE, {}, LINKS, readings, {}, rendered=False)
    share = overshoot_share(step_share(step, hold, K))
    assert share == pytest.approx(study.ideal(found, name).overshoot, abs=0.03)
    assert np.abs(step.control_force[:, K]).max() < 0.5 * step.effort_limit[K]
