"""Episodes without the engine: objects that are carried into the bowl, hang over it, or stay."""

import numpy as np

from robo_genesis.core.trace import Episodes
from robo_genesis.sim.arm import picking
from robo_genesis.sim.bodies import bowl


def episodes(case, good, hanging=False, early=False, length=6, creep=0.0):
    """Return a batch; the hand touches some objects `early`.

    Each phase takes `length` (e,) samples. Held objects `creep` down [m/s].
    """
    shape = case.steps + 1, len(case.starts)
    begin = np.column_stack([case.starts, np.full(shape[1], case.size[2] / 2)])
    ends = np.multiply.outer(length * np.ones(shape[1]), np.arange(1, 9))
    phase = (np.arange(shape[0])[:, None, None] >= ends).sum(axis=2).astype(np.int8)
    place = np.tile(begin, (shape[0], 1, 1))
    held = (phase >= picking.LIFT) & (phase < picking.OPEN) & good
    place[held, 2] += 0.1
    place[..., 2] -= creep * case.dt * np.cumsum(held, axis=0) * held
    hangs = (phase >= picking.MOVE) & hanging
    place[hangs, 2] += 2 * bowl.HEIGHT
    place[hangs | (phase >= picking.MOVE) & good, :2] = case.bowl_at
    q = np.tile(np.float32(case.q_start), (*shape, 1))
    return Episodes(
        t=np.arange(shape[0]) * case.dt,
        phase=phase,
        q=q,
        object_pos=np.float32(place),
        object_quat=np.float32(np.tile(case.turns, (shape[0], 1, 1))),
        force=np.float32(12 * np.stack([held, held], axis=-1)),
        touches=(held | hangs | ((phase == picking.DESCEND) & early)).astype(np.int8),
    )
