from dataclasses import fields

import numpy as np
import pytest
from bundles import name_code

from robo_genesis.core import project
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import DT, SUBSTEPS
from robo_genesis.core.trace import Trace
from robo_genesis.evidence.bundle import read_arrays
from robo_genesis.evidence.recorder import Recorder
from robo_genesis.evidence.trace_files import read_trace
from robo_genesis.lessons.l04 import LAB, spec
from robo_genesis.pipeline.bundles.keys import page_code
from robo_genesis.pipeline.bundles.verify import verify_bundle
from robo_genesis.pipeline.pages.sources import running_modules
from robo_genesis.sim import session
from robo_genesis.sim.arm.franka import JOINT_NAMES, LINK_PARENTS
from robo_genesis.sim.arm.joint_control import CaseError, reset, run_case
from robo_genesis.sim.arm.joints import (
    JointError,
    link_parents,
    one_dof_joint,
    resolve_joints,
    to_numpy,
)
from robo_genesis.sim.camera.frames import capture, read_renderer

pytestmark = pytest.mark.engine

BALL = """<mujoco><worldbody><body name="arm" pos="0 0 1">
<joint name="ball" type="ball"/><geom type="sphere" size="0.1"/>
</body></worldbody></mujoco>"""


@pytest.fixture(scope="module")
def measured_run(lab, run):
    """The lab as its page does it: first frame, four cases, last frame of the baseline."""
    reset(lab.scene, lab.franka, lab.joints, spec.BASELINE)
    frames = {"initial": capture(lab.camera)}
    traces = {"baseline": run(spec.BASELINE)}
    frames["final"] = capture(lab.camera)
    traces |= {name: run(spec.CASES[name]) for name in ("G1", "G2", "G3")}
    robot = lab.franka
    counts = (robot.n_links, robot.n_joints, robot.n_dofs, robot.n_qs)
    readings = {"model": dict(zip(spec.EXPECTED_MODEL, counts, strict=True))}
    links = [link.name for link in robot.links]
    return Experiment(LAB, traces, links, readings, frames, rendered=True, joints=lab.joints)


@pytest.fixture(scope="module")
def bundle_folder(lab, measured_run):
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("ROBO_GENESIS_RUN_ID", raising=False)
        name_code(patch, "l04", "lab")
        recorder = Recorder("l04", "lab", lab.contract, lab.engine, running_modules("l04"))
        return recorder.write(measured_run, read_renderer(lab.scene))


@pytest.fixture(scope="module")
def small_scene(lab, tmp_path_factory):
    """A ball joint and a free box."""
    path = tmp_path_factory.mktemp("models") / "ball.xml"
    path.write_text(BALL)
    gs = lab.gs
    scene = gs.Scene(show_viewer=False)
    ball = scene.add_entity(gs.morphs.MJCF(file=str(path)))
    box = scene.add_entity(gs.morphs.Box(size=(0.1, 0.1, 0.1), pos=(1, 0, 0.5)))
    scene.build()
    return {"SPHERICAL": ball, "FREE": box}


def same(one, other):
    return all(
        getattr(one, field.name).tobytes() == getattr(other, field.name).tobytes()
        for field in fields(Trace)
    )


def test_the_map_is_what_each_joint_owns(lab, joints):
    assert lab.joints.lower == pytest.approx(joints.lower, abs=1e-6)
    assert lab.joints.upper == pytest.approx(joints.upper, abs=1e-6)
    assert tuple(link_parents(lab.franka)) == LINK_PARENTS
    for k, name in enumerate(JOINT_NAMES):
        joint = lab.franka.get_joint(name)
        assert list(joint.dofs_idx_local) == [lab.joints.dofs_idx_local[k]]
        assert list(joint.qs_idx_local) == [lab.joints.qs_idx_local[k]]


@pytest.mark.parametrize(("kind", "counts"), [("SPHERICAL", (3, 4)), ("FREE", (6, 7))])
def test_dofs_and_qpos_differ_for_spherical_and_free_joints(small_scene, kind, counts):
    (joint,) = small_scene[kind].joints
    assert joint.type.name == kind
    assert (joint.n_dofs, joint.n_qs) == counts
    with pytest.raises(JointError, match=f"has {counts[0]} DOFs and {counts[1]} qpos"):
        one_dof_joint(small_scene[kind], joint.name)


def test_an_unknown_joint_lists_the_robots_names(lab):
    with pytest.raises(JointError, match=f"'elbw'.*{', '.join(JOINT_NAMES)}"):
        resolve_joints(lab.franka, ("joint1", "elbw"))


def test_a_missing_model_file_is_an_error(lab):
    with pytest.raises(lab.gs.GenesisException, match=r"xml/no_such_robot\.xml"):
        lab.gs.morphs.MJCF(file="xml/no_such_robot.xml")


def test_the_engine_is_started_once(lab):
    with pytest.raises(session.EngineError, match=r"already initialised.*restart the kernel"):
        session.start(lab.contract)


def test_a_scene_before_build_takes_no_case(lab):
    scene = lab.gs.Scene(
        sim_options=lab.gs.options.SimOptions(dt=DT, substeps=SUBSTEPS), show_viewer=False
    )
    with pytest.raises(CaseError, match="not built"):
        run_case(scene, lab.franka, lab.joints, spec.G1)


def test_the_backend_is_the_one_asked_for(lab):
    assert lab.engine.backend.actual == "cpu"
    assert session.probe("cpu") == lab.engine.backend


def test_importer_warnings_are_kept(lab):
    assert any("tendon" in warning for warning in lab.engine.log.warnings)
    assert not any("~<" in text for _, text in lab.engine.log.lines)


@pytest.mark.parametrize("order", [("G1", "G2", "G3"), ("G3", "G1", "G2")])
def test_cases_repeat_bit_for_bit_in_any_order(measured_run, run, order):
    for name in order:
        assert same(run(spec.CASES[name]), measured_run.traces[name]), name


def test_a_case_forgets_whatever_ran_before(lab, measured_run, run):
    dofs = lab.joints.dofs_idx_local.tolist()
    lab.franka.set_dofs_kp(spec.BASELINE.kp * 3, dofs)
    lab.franka.set_dofs_kv(spec.BASELINE.kv / 10, dofs)
    lab.franka.set_dofs_force_range(np.full(9, -50.0), np.full(9, 60.0), dofs)
    lab.franka.control_dofs_position(spec.BASELINE.q_start + 0.02, dofs)
    for _ in range(10):
        lab.scene.step()
    lab.franka.control_dofs_velocity(np.full(7, 0.5), dofs[:7])
    for _ in range(10):
        lab.scene.step()
    assert np.abs(to_numpy(lab.franka.get_dofs_velocity(dofs))).max() > 0.1
    assert same(run(spec.G2), measured_run.traces["G2"])


def test_a_command_moves_nothing_until_a_step(measured_run):
    for trace in measured_run.traces.values():
        assert trace.q[0] == pytest.approx(spec.BASELINE.q_start, abs=1e-6)
        assert (trace.start_qd == 0).all()
        assert (trace.q[0] != trace.q[1]).any()


def pd_effort(case, q, qd):
    demand = case.kp * (case.q_target - q) - case.kv * qd
    return np.clip(demand, -case.effort_limit, case.effort_limit)


@pytest.mark.parametrize("name", spec.CASES)
def test_control_force_belongs_to_the_state_at_its_stamp(measured_run, name):
    case, trace = spec.CASES[name], measured_run.traces[name]
    at_stamp = pd_effort(case, trace.q[1:], trace.qd)
    before = pd_effort(case, trace.q[:-1], np.vstack([trace.start_qd, trace.qd[:-1]]))
    assert np.abs(trace.control_force - at_stamp).max() < 1e-3
    assert np.abs(trace.control_force - before)[:, spec.ENTRY].max() > 10


@pytest.mark.parametrize("name", spec.CASES)
def test_the_demand_before_the_first_step_is_clipped_to_the_limit(measured_run, name):
    trace, k = measured_run.traces[name], spec.ENTRY
    assert trace.start_control_force[k] == trace.effort_limit[k]
    assert np.delete(trace.start_control_force, k) == pytest.approx(np.zeros(8), abs=1e-3)


def test_the_two_force_getters_differ(measured_run):
    trace, k = measured_run.traces["G1"], spec.ENTRY
    assert np.abs(trace.control_force - trace.internal_force)[:, k].max() > 10
    assert abs(trace.internal_force[-1, k]) < 1 < abs(trace.control_force[-1, k])


def test_a_recorded_run_is_accepted(bundle_folder, lab):
    predicate = verify_bundle(bundle_folder).predicate
    assert predicate.source.page == page_code("l04", "lab", project.BOOK)[0]
    assert predicate.engine.files_match_wheel
    assert predicate.render.mode == "camera"
    renderer = read_renderer(lab.scene)
    assert renderer.vendor
    assert renderer.name
    assert predicate.warnings == lab.engine.log.warnings


@pytest.mark.parametrize("name", spec.CASES)
def test_the_bundle_holds_the_arrays_bit_for_bit(bundle_folder, measured_run, name):
    stored = read_trace(bundle_folder, read_arrays(bundle_folder), name)
    assert same(stored, measured_run.traces[name])
