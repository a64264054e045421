"""What the arrays of a free body must have in common, by geometry and by the laws of motion.

Contacts are a function of the state before the last solver step, which follows from the
state after it. Each state follows from the state before it: MuJoCo, which has the same
contact model, computes it anew from every sample, so that no difference can grow.

| tolerance | residual of the CPU runs | value |
|---|---|---|
| `PLACE`, start | 5e-8 m | 1e-6 m |
| `SETTLED`, start after settling | 6e-5 m | 1e-3 m |
| `DEPTH`, penetration | 1e-7 m | 5e-7 m |
| `GRAZE`, depth of a lowest corner that some versions miss | 1.3e-5 m | 4e-5 m |
| angular velocity before the first contact | 0 rad/s | 0 rad/s |
| `FALL`, velocity before the first contact | 8e-5 m/s | 8e-4 m/s |
| `ROLL`, angular velocity of a ball, which nothing pushes sideways | 0 rad/s | 5e-4 rad/s |
| `NO_TURN`, rotation that is left out in a solver step | 1.2e-7 rad | 2.5e-7 rad |
| `TURN`, share of a rotation | 8e-7 | 1e-4 |
| `RESOLVED`, what float32 resolves of a rotation since the start, as a share | — | 4e-7 |
| `NEXT`, position after one outer step | 4e-7 m | 5e-6 m |
| `NEXT`, orientation | 2e-5 | 2e-4 |
| `NEXT`, velocity | 3e-5 m/s | 3e-4 m/s |
| `NEXT`, angular velocity | 2e-3 rad/s | 2e-2 rad/s |
| `FLIGHT`, position after one outer step without contacts | 1.1e-6 m | 5e-6 m |
| `FLIGHT`, orientation | 1e-7 | 1e-6 |
| `FLIGHT`, velocity | 2.7e-6 m/s | 3e-5 m/s |
| `FLIGHT`, angular velocity | 2.4e-7 rad/s | 3e-6 rad/s |
| mean velocity of an outer step beyond those at both ends, as a share of g dt | 0.46 | 2 |
| `SLIDING`, speed along x of a cube that slides on four corners | 4e-3 m/s | 1.2e-2 m/s |
| `PATH`, its path in one outer step | 2e-4 m | 2e-3 m |
| `UPRIGHT`, its orientation | 3e-4 | 3e-3 |
| `IMPULSE`, of a cube on an edge, outside the friction cone | 9e-6 m/s | 5e-5 m/s |

The engine's search for a contact ends where it gains less than 1e-5 m, in some versions
plus 1e-5 of a sum of coordinates, which is up to 3 m here; both together are `GRAZE`.

Residuals of `FLIGHT` are the larger ones of two engine versions. `SLIDING` has a factor
of 3, because the residual is that of the single step in which a cube stops, and a wider
one would let a sample change by a hundredth of the speed.
"""

from collections.abc import Iterator

import numpy as np

from robo_genesis.core.checks import Finding
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import BodyTrace, ContactTrace
from robo_genesis.sim.arm.kinematics import quat_multiply
from robo_genesis.sim.bodies.contacts import TOP, ContactCase
from robo_genesis.sim.laws import (
    UNTURNED,
    ZERO,
    apart,
    broken,
    mean_speed,
    times,
    unit_quaternions,
)
from robo_genesis.sim.mujoco import contacts as mujoco_contacts

MEASURES = False

PLACE, SETTLED, DEPTH = 1e-6, 1e-3, 5e-7

# Difference of depth between the lowest corners [m] from which Genesis may report fewer
# of those that touch.
TILTED = 1e-4

# Angle by which Genesis turns a body to find further contact points [rad]: twice its
# `mc_perturbation`, which is 3e-3 or 5e-3, depending on the version.
TWIST = 1e-2

GRAZE, NO_TURN, TURN, RESOLVED = 4e-5, 2.5e-7, 1e-4, 4e-7

# Share of the steps of a run that may end otherwise, because a cube that lands on an
# edge has other contact points in the two engines. The versions tried have at most 0.15
# and 0.39. Of such a step, the impulse is judged.
ON_EDGE = 0.5

# Number of states with contacts in which the rounding of a cube's angular velocity must
# show.
TOUCHED = 5

ROLL, FALL, SLIDING, PATH, UPRIGHT, IMPULSE = 5e-4, 8e-4, 1.2e-2, 2e-3, 3e-3, 5e-5

NEXT = {"link_pos": 5e-6, "link_quat": 2e-4, "link_vel": 3e-4, "link_ang": 2e-2}

# Tolerances of the state after one outer step, in `UNITS`, and without contacts in
# MuJoCo.
FLIGHT = {"link_pos": 5e-6, "link_quat": 1e-6, "link_vel": 3e-5, "link_ang": 3e-6}

UNITS = {"link_pos": "m", "link_quat": "1", "link_vel": "m/s", "link_ang": "rad/s"}

CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / 2


def body_on_surface(trace: ContactTrace, case: ContactCase) -> Iterator[Finding]:
    """Yield what no run of `contacts.run_world` has."""
    yield from times(trace, case.steps, case.dt)
    yield from unit_quaternions(trace.link_quat)
    yield from start(trace, case)
    yield from bounded(trace, case)
    yield from reported_contacts(trace, case)
    yield from never_still(trace, case)
    yield from turned(trace, case)
    if (
        case.cone == "elliptic" and case.resolution is None
    ):  # MuJoCo does not have this scheme
        yield from sliding(trace, case)
    else:
        yield from next_states(trace, case)


def bounded(trace: ContactTrace, case: ContactCase) -> Iterator[Finding]:
    """Yield a speed that gravity and push cannot give, or a place that it does not lead to."""
    fastest = case.speed + case.gravity * (case.duration + 1)
    about = np.array(case.start)
    yield from apart("motion", "link_vel [m/s]", trace.link_vel[:, 0], ZERO, fastest)
    yield from apart(
        "motion", "link_ang [rad/s]", trace.link_ang[:, 0], ZERO, fastest / case.size
    )
    if not case.settle:
        untouched = np.cumsum(trace.contacts[:, 0:1], axis=0) == 0
        room = np.where(untouched, 0.0, ROLL if case.shape == "ball" else np.inf)
        what = "link_ang without torque [rad/s]"
        yield from apart("motion", what, trace.link_ang[:, 0], ZERO, room)
        fall = np.outer(trace.t, case.fall) + np.array([case.speed, 0, 0])
        room = np.where(untouched, FALL, np.inf)
        what = "link_vel before any contact [m/s]"
        yield from apart("motion", what, trace.link_vel[:, 0], fall, room)
    far = fastest * (case.duration + 1)
    yield from apart("motion", "link_pos [m]", trace.link_pos[:, 0], about, far)


def sliding(trace: ContactTrace, case: ContactCase) -> Iterator[Finding]:
    """Yield a state of a cube that does not slide along x by Coulomb's law on its four corners.

    On a tilted surface it slides down, or it rests.
    """
    velocity, position = (
        a[:, 0].astype(np.float64) for a in (trace.link_vel, trace.link_pos)
    )
    slope, _, normal = case.dt * case.fall
    lost = -max(case.friction, case.surface_friction) * normal - slope
    along = np.maximum(velocity[:-1, 0] - lost, 0)
    yield from apart(
        "motion", "link_vel along x [m/s]", velocity[1:, 0], along, SLIDING
    )
    across = velocity[:, 1:]
    yield from apart(
        "motion", "link_vel along y and z [m/s]", across, ZERO, NEXT["link_vel"]
    )
    path = case.dt * (velocity[1:] + velocity[:-1]) / 2
    yield from apart(
        "motion", "path in one step [m]", np.diff(position, axis=0), path, PATH
    )
    yield from apart("motion", "link_quat", trace.link_quat[:, 0], UNTURNED, UPRIGHT)


def start(trace: ContactTrace, case: ContactCase) -> Iterator[Finding]:
    """Yield a start that is not the case's."""
    room = SETTLED if case.settle else PLACE
    place, speed = np.array(case.start), np.array([case.speed, 0, 0])
    yield from apart(
        "start", "start of link_pos [m]", trace.link_pos[0, 0], place, room
    )
    yield from apart(
        "start", "start of link_vel [m/s]", trace.link_vel[0, 0], speed, room
    )
    yield from apart(
        "start", "start of link_quat", trace.link_quat[0, 0], UNTURNED, room
    )
    yield from apart(
        "start", "start of link_ang [rad/s]", trace.link_ang[0, 0], ZERO, room
    )


def reported_contacts(trace: ContactTrace, case: ContactCase) -> Iterator[Finding]:
    """Yield contacts that are not those of the body's shape before the last solver step.

    A cube on an edge has up to three: one processor reports a third one in 1 of 401
        samples of a
    run in which another processor reports two.
    """
    depths = depths_before_last_step(trace, case)
    first = (
        0 if case.settle else 1
    )  # no step was taken before the first sample of the others
    expected = np.maximum(depths[:, 0], 0)
    expected[:first] = 0
    reported = trace.penetration[:, 0]
    tilted = depths[:, 0] - depths[:, -1] > TILTED
    missed = on_edge(depths, case.size) & (reported == 0) & (expected < GRAZE)
    expected[missed], depths[missed] = 0, np.minimum(depths[missed], 0)
    yield from apart("contact", "penetration [m]", reported, expected, DEPTH)
    depths[:first] = -1
    surely = (depths > DEPTH).sum(axis=1)
    fewest = np.where(tilted, np.minimum(surely, 2), surely)
    reach = np.where((depths > -DEPTH).any(axis=1), TWIST * case.size, DEPTH)
    perhaps = (depths > -reach[:, None]).sum(axis=1)
    on_one_edge = (perhaps == 2) & (depths[:, 1:2] > -DEPTH).any(axis=1)
    perhaps += on_one_edge  # Genesis may report a further point there
    count = trace.contacts[:, 0]
    for k in np.flatnonzero((count < fewest) | (count > perhaps))[:1]:
        what = f"number of contacts at index {k}"
        yield broken(
            "contact", what, int(count[k]), sorted({int(fewest[k]), int(perhaps[k])})
        )


def depths_before_last_step(trace: BodyTrace, case: ContactCase) -> FloatArray:
    """Return how deep the lowest points are below the surface (n+1, 1 or 4) [m], deepest first."""
    position, orientation = before_last_step(trace, case.h)
    if case.shape == "ball":
        return TOP - (position[:, 2, None] - case.size / 2)
    w, x, y, z = orientation.T  # below: the world's z axis in the body's axes
    up = np.stack([x * z - w * y, y * z + w * x, 0.5 - x**2 - y**2], axis=1) * 2
    heights = position[:, 2, None] + up @ (case.size * CORNERS).T
    return TOP - np.sort(heights, axis=1)[:, :4]


def on_edge(depths: FloatArray, size: float) -> np.ndarray:
    """Return in which states a cube near the surface may have other contacts in another engine.

    It is not level. If all four corners touch, it is tilted enough for fewer contacts.

    Args:
        depths: its lowest corners, as of `depths_before_last_step`.
        size: its edge [m].
    """
    deepest, highest = depths[:, 0], depths[:, -1]
    tilt = np.where(highest > DEPTH, TILTED, DEPTH)
    return (deepest > -TWIST * size) & (deepest - highest > tilt)


def never_still(trace: ContactTrace, case: ContactCase) -> Iterator[Finding]:
    """Yield a cube whose angular velocity stays zero to the last bit while it touches the surface.

    The forces at its corners cancel only up to rounding. In the runs, no component is
    zero in any state with contacts.
    """
    touched = trace.link_ang[trace.contacts[:, 0] > 0, 0]
    if case.shape == "cube" and len(touched) >= TOUCHED and not touched.any():
        what = "largest link_ang of a cube in contact [rad/s]"
        yield broken("motion", what, 0.0, "the rounding of the forces at its corners")


def turned(trace: BodyTrace, case: ContactCase) -> Iterator[Finding]:
    """Yield an orientation that does not integrate the angular velocity, with one solver step."""
    if case.substeps > 1:
        return
    _, before = before_last_step(trace, case.h)
    quat = trace.link_quat[:, 0].astype(np.float64)
    old, new = quat[:-1, 1:], quat[1:, 1:]
    angle = 2 * np.linalg.norm(new - before[1:, 1:], axis=1)
    moved = (new != old).any(axis=1)
    error = 2 * np.linalg.norm(before[1:, 1:] - old, axis=1)
    room = np.where(
        moved, TURN * angle + RESOLVED * np.abs(old).max(axis=1) + 1e-12, NO_TURN
    )
    for k in np.flatnonzero(error > room)[:1]:
        what = f"rotation to index {k + 1} against link_ang [rad]"
        yield broken("motion", what, float(error[k]), f"0 ± {room[k]:g}")


def next_states(trace: ContactTrace, case: ContactCase) -> Iterator[Finding]:
    """Yield a state that does not follow from the state before it."""
    position, velocity = (
        a[:, 0].astype(np.float64) for a in (trace.link_pos, trace.link_vel)
    )
    yield from mean_speed(position, velocity, case.dt, 2 * case.gravity * case.dt)
    expected = mujoco_contacts.each_step(trace, case)
    impulse = expected["link_vel"] - velocity[:-1] - case.dt * case.fall
    flight = (np.abs(impulse) < 1e-9).all(axis=1)
    errors = {
        name: np.abs(getattr(trace, name)[1:, 0] - of) for name, of in expected.items()
    }
    rooms = {name: np.where(flight, FLIGHT[name], NEXT[name]) for name in errors}
    beyond = {
        name: (of > rooms[name][:, None]).any(axis=1) for name, of in errors.items()
    }
    wrong = np.any(list(beyond.values()), axis=0)
    edge = on_edge(depths_before_last_step(trace, case), case.size)
    excused = wrong & (edge[1:] | edge[:-1])  # of both substeps
    share = float(excused.mean())
    if share > ON_EDGE:
        yield broken(
            "motion", "share of steps of another motion", share, f"up to {ON_EDGE}"
        )
    yield from impulses(trace, case, excused)
    for k in np.flatnonzero(wrong & ~excused)[:1]:
        name = next(name for name, of in beyond.items() if of[k])
        axis = int(errors[name][k].argmax())
        found, follows = (
            float(getattr(trace, name)[k + 1, 0, axis]),
            float(expected[name][k, axis]),
        )
        what = f"{name} at index {[int(k) + 1, 0, axis]} [{UNITS[name]}]"
        yield broken("motion", what, found, f"{follows!r} ± {rooms[name][k]:g}")


def impulses(
    trace: ContactTrace, case: ContactCase, steps: np.ndarray
) -> Iterator[Finding]:
    """Yield an impulse of some steps that no contacts of the cube with the surface give.

    It is upward and in the friction cone, and it acts at points of the cube.

    Args:
        trace: the run.
        case: its settings.
        steps: (n,) which steps are judged.
    """
    velocity, spin = (
        a[:, 0].astype(np.float64) for a in (trace.link_vel, trace.link_ang)
    )
    gained = (np.diff(velocity, axis=0) - case.dt * case.fall)[steps]
    friction = max(case.friction, case.surface_friction)
    across = np.linalg.norm(gained[:, :2], axis=1)
    beyond = np.maximum(across - friction * gained[:, 2], -gained[:, 2])
    turned = np.linalg.norm(np.diff(spin, axis=0)[steps], axis=1) * case.size / 6
    reach = np.sqrt(3) / 2 * np.linalg.norm(gained, axis=1)
    what = "impulse outside the friction cone, per mass [m/s]"
    yield from apart("motion", what, np.maximum(beyond, 0), ZERO, IMPULSE)
    what = "impulse that the turning needs beyond that of the motion, per mass [m/s]"
    yield from apart("motion", what, np.maximum(turned - reach, 0), ZERO, IMPULSE)


def before_last_step(trace: BodyTrace, h: float) -> tuple[FloatArray, FloatArray]:
    """Return position (n+1, 3) [m] and orientation (n+1, 4) before the last solver step.

    Semi-implicit Euler moves a body by the velocities after the step, for `h` seconds.
    """
    position, velocity = (
        a[:, 0].astype(np.float64) for a in (trace.link_pos, trace.link_vel)
    )
    quat, turn = trace.link_quat[:, 0].astype(np.float64), -h * trace.link_ang[:, 0]
    half = np.linalg.norm(turn, axis=1, keepdims=True) / 2
    back = np.hstack([np.cos(half), turn / 2 * np.sinc(half / np.pi)])
    return position - h * velocity, quat_multiply(back, quat)
