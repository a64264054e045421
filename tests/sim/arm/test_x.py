import sys

sys.path[:0] = ["/work/h/robots/tests/sim/arm"]
from test_other_robots import *
from test_other_robots import folder, robots

pytestmark = pytest.mark.engine
import traceback


def test_x(robots):
    for n in ("arm.xml", "arm.urdf"):
        rob = getattr(robots, n)
        p = page()
        c = CASES[n]
        m = c.model
        print(n, [l.name for l in rob.links], [j.name for j in rob.joints])
        try:
            j = describe(p, rob, m)
            print(p.readings)
            tr = run_case(robots.scene, rob, j, c)
            print(
                [f.problem for f in laws.driven_run(tr, c, p.links)],
                [f.problem for f in laws.model_joints(j, m)],
            )
            names = [m.hand]
            pos, quat = engine.link_poses_at(rob, j, names, c.q_start)
            tw = mujoco_kinematics.link_poses(c.q_start[None], names, m)
            print(pos, tw.position, quat, tw.quat)
            robots.scene.reset()
            rob.set_dofs_position(c.q_start.copy(), j.dofs_idx_local.tolist())
            robots.scene.step()
            J = engine.jacobian(rob, j, m.hand)
            print(
                np.abs(
                    J
                    - mujoco_kinematics.jacobian(
                        rob.get_dofs_position(j.dofs_idx_local.tolist())
                        .cpu()
                        .numpy()
                        .astype(float),
                        m,
                    )
                ).max()
            )
            print(
                dynamics.gravity_effort(robots.scene, rob, j, c.q_start),
                mujoco_kinematics.gravity_effort(c.q_start, of=m),
            )
            print(
                dynamics.effective_inertia(robots.scene, rob, j, c.q_start),
                mujoco_joints.at_rest(c.q_start, m)[0],
            )
            a = engine.solve_ik(
                rob, j, pos[0], quat[0], c.q_start, engine.IkSettings(samples=1), of=m
            )
            print(a)
            print(
                engine.accepted_command(a, engine.IkSettings(), c.q_start, m),
                engine.tip_height(a.q, m),
            )
        except Exception:
            traceback.print_exc()
    rob = robots.dog
    p = page()
    c = CASES["dog"]
    print([l.name for l in rob.links], [(j.name, j.type.name, j.n_dofs) for j in rob.joints])
    for f in (
        lambda: describe(p, rob, DOG),
        lambda: describe(page(), rob, replace(DOG, free_base=False)),
        lambda: describe(page(), rob),
        lambda: run_case(robots.scene, rob, p.joints, c),
        lambda: engine.link_poses_at(rob, p.joints, ["FL_calf", "base"], c.q_start),
        lambda: list(laws.commanded(run_case(robots.scene, rob, p.joints, c), c, p.links)),
        lambda: list(laws.driven_run(run_case(robots.scene, rob, p.joints, c), c, p.links)),
        lambda: engine.solve_ik(
            rob,
            p.joints,
            np.zeros(3),
            np.array([1.0, 0, 0, 0]),
            c.q_start,
            engine.IkSettings(),
            of=DOG,
        ),
        lambda: dynamics.gravity_effort(robots.scene, rob, p.joints, c.q_start),
        lambda: engine.jacobian(rob, p.joints, "FL_calf").shape,
        lambda: engine.jacobian(rob, p.joints),
        lambda: list(laws.model_joints(p.joints, DOG)),
        lambda: list(
            laws.driven_run(
                run_case(robots.scene, rob, p.joints, c), replace(CASES["arm.xml"]), p.links
            )
        ),
    ):
        try:
            print(str(f())[:300])
        except Exception as e:
            print(type(e).__name__, str(e)[:500])
