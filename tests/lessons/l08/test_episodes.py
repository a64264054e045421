"""The ladder, rates and checks of L08: known values, and each check with its own fault."""

from dataclasses import replace

import numpy as np
import pytest
from lessons.changed_runs import copied, failed, metric, put, reading, shift, trace
from lessons.experiments import require_spoilers

from robo_genesis.lessons.l08 import explorer, metrics, plots, spec, text
from robo_genesis.sim.arm import picking
from robo_genesis.sim.session import CaseError

PLACED = spec.SHOWN["placed"]


def test_figures_and_tables_show_the_episodes(episodes):
    for figure in (plots.phases, plots.errors, plots.slide, plots.leaving):
        assert figure(episodes).axes
    assert text.rung_table(episodes).count("\n") == len(metrics.RUNGS) + 2
    assert "of 256" in text.rate_table(episodes, "success means")


LOST = [
    ("planned", {"phase": put((slice(None), PLACED), picking.DONE)}),
    ("held", {"force": put((slice(None), PLACED, 0), 0)}),
    ("lifted", {"object_pos": put((slice(None), PLACED, 2), 0.035)}),
    ("carried", {"force": put((70, PLACED, 1), 0)}),
    ("released", {"touches": put((-1, PLACED), 1)}),
    ("contained", {"object_pos": put((slice(-9, None), PLACED, 0), 0.62)}),
    ("resting", {"object_pos": shift((-1, PLACED, 0), 3e-4)}),
]


@pytest.mark.parametrize(("rung", "arrays"), LOST, ids=[name for name, _ in LOST])
def test_an_episode_is_lost_at_its_rung(episodes, rung, arrays):
    run = trace("askew", **arrays)(episodes)
    level = metrics.reached(run.traces["askew"], spec.ASKEW)[PLACED]
    assert metrics.RUNGS[level] == rung


def test_a_start_over_the_bowl_is_refused():
    starts = np.array([[0.5, 0.0], [0.56, 0.2]])
    with pytest.raises(CaseError, match="environment 1 begins over the bowl"):
        replace(spec.EXACT, starts=starts)


def test_the_machine_waits_for_what_is_measured():
    case = replace(spec.EXACT, starts=np.zeros((2, 2)), beliefs=np.zeros((2, 2)))
    goals = np.zeros((9, 2, 7)) + case.q_start[:7]
    expert = picking.Expert(case, goals, np.array([True, False]))
    q, still = np.tile(case.q_start, (2, 1)), np.zeros((2, 9))
    expert.act(q, still + 1.0)  # near, but fast
    assert expert.phase.tolist() == [0, picking.DONE]
    for phase in (1, 2):
        expert.act(q, still)
        assert expert.phase[0] == phase
    commands = [expert.act(q, still)[0, -1] for _ in range(picking.CLOSING - 1)]
    assert commands == [0.0] * len(commands)
    assert expert.phase[0] == picking.CLOSE
    expert.act(q, still)
    assert expert.phase[0] == picking.LIFT


def test_each_cell_shows_its_own_episode(episodes):
    data = explorer.explored(episodes)
    cells = [cell for row in data["maps"][0]["rows"][::-1] for cell in row["cells"]]
    levels = metrics.reached(episodes.traces["askew"], spec.ASKEW)
    assert [cell["numbers"][0] for cell in cells] == levels.tolist()
    ends = data["traces"]["ends"]
    assert ends.link_pos[1 + PLACED, -1] == pytest.approx(
        episodes.traces["askew"].object_pos[-1, PLACED]
    )


LOST_AT_THE_END = trace("askew", touches=put((-1, PLACED), 1))
JUMPS = [
    {"q": shift((30, 0, 3), 0.25)},
    {"object_pos": shift((slice(3, None), 0, 0), 2e-4)},
    {"q": lambda q: np.repeat(q[:, :1], 64, axis=1)},
]
SPOILED = [
    ("structure", reading("model", "links", 10)),
    ("stamps", trace("exact", t=lambda t: 2 * t)),
    *(("nothing_jumps", trace("exact", **arrays)) for arrays in JUMPS),
    ("place_is_enough", trace("exact", touches=put((-1, 0), 1))),
    ("turned_camera", metric("askew", resting=128.0)),
    ("words_differ", metric("askew", raised_once=180.0)),
    ("pads_are_short", metric("exact", short=0.0)),
    ("held_but_sliding", metric("exact", creep=0.0)),
    ("held_but_sliding", trace("exact", object_pos=shift((45, 0, 2), 1e-3))),
    ("along_the_pads", LOST_AT_THE_END),
    ("edge_of_the_pads", LOST_AT_THE_END),
    ("shown_episodes", LOST_AT_THE_END),
    ("edge_of_the_pads", trace("round", touches=put((-1, 0), 1))),
    ("leaves_as_it_creeps", metric("askew", growth=0.5)),
    ("order_does_not_matter", copied("permuted", "exact")),
]


def test_each_check_fails_for_its_own_fault(episodes):
    require_spoilers(episodes, SPOILED)


@pytest.mark.parametrize("rows", [-1, 1])
def test_commands_that_are_shifted_by_one_row_are_found(lab, rows):
    assert failed(lab) == set()
    shifted = trace("exact", target=lambda values: np.roll(values, rows, axis=0))(lab)
    assert failed(shifted) == {"commands_come_first", "rows_wait_and_follow"}
