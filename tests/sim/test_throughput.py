"""Times of steps on a clock that the test moves."""

import numpy as np
import pytest

from robo_genesis.sim import throughput


def test_a_step_is_timed_from_finish_to_finish():
    now, waiting = [100.0], [7.0]

    def finish():
        now[0] += sum(waiting)
        waiting.clear()

    calls = lambda: waiting.append(0.5), finish
    assert throughput.seconds_per_step(calls, 4, lambda: now[0]) == 0.5
    assert now[0] == 109


def test_scenes_are_timed_in_turn_after_their_warm_up():
    made = []
    calls = {name: (lambda n=name: made.append(n), lambda: None) for name in "ab"}
    used = [0, 2, 2, 8, 8, 18, 18, 20, 20, 24, 24, 26]
    unused = 2 * [0]  # begin and end of a warm-up
    ticks = iter(
        [
            t
            for pair in zip(used[::2], used[1::2], strict=True)
            for t in (*unused, *pair)
        ]
    )
    found = throughput.in_turn(calls, 1, 2, 3, ticks.__next__)
    assert "".join(made) == 3 * "aaabbb"
    assert found == {
        "step_a": 2,
        "fastest_a": 1,
        "slowest_a": 5,
        "step_b": 1,
        "fastest_b": 1,
        "slowest_b": 3,
    }


def test_memory_grows_by_what_is_kept():
    throughput.used_memory()  # frees what earlier tests left
    before = throughput.used_memory()
    kept = np.ones(400 * throughput.MIB // 8)
    assert throughput.used_memory() - before == pytest.approx(400, rel=0.2)
    assert kept.all()


def test_a_fit_finds_the_model_that_made_the_times():
    sizes, model = np.array([1, 16, 256]), throughput.Model(0.002, 3e-5)
    found = throughput.fit(sizes, model.step_time(sizes))
    assert (found.fixed, found.each) == pytest.approx((model.fixed, model.each))
