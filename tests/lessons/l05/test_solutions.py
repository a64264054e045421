"""Tables and maps of many answers name, count and choose what the arrays hold."""

import numpy as np

from robo_genesis.lessons.l05 import explorer, spec, study, text


def test_each_target_of_a_plane_is_one_cell_and_upwards_is_up(reaches):
    data = explorer.explored(reaches, "reach")
    for found, axis in zip(data["maps"], (2, 1), strict=True):
        name, targets = found["run"], data["postures"][found["run"]]
        cells = {cell["answer"]: cell for row in found["rows"] for cell in row["cells"]}
        rows = data["tables"][found["caption"]]
        assert sorted(cells) == [int(row["answer"]) for row in rows] == [*range(1, 64)]
        top = targets[found["rows"][0]["cells"][0]["answer"] - 1]
        assert top[axis] == targets[:, axis].max()
        assert top[0] == float(found["columns"][0])
        answers = study.answers(reaches.traces[name], spec.QUESTIONS[name])
        accepted = [cells[k]["state"] == "accepted" for k in sorted(cells)]
        assert accepted == answers["accepted"].tolist()


def test_the_map_of_solutions_has_the_accepted_answers_along_their_curves(reaches):
    (found,) = explorer.explored(reaches, "solutions")["maps"]
    assert {cell["state"] for row in found["rows"] for cell in row["cells"]} == {
        "accepted"
    }
    q = reaches.traces["many_starts"].q
    for row in found["rows"]:
        assert (np.diff(q[[cell["answer"] for cell in row["cells"]], 0]) >= 0).all()
    accepted = study.answers_of(reaches, "many_starts")["accepted"]
    assert sum(len(row["cells"]) for row in found["rows"]) == accepted.sum() > 20


def test_each_criterion_chooses_the_best_accepted_answer(reaches):
    found, chosen = study.answers_of(reaches, "many_starts"), text.chosen(reaches)
    assert len(set(chosen.values())) > 1
    for name, (key, best) in text.CRITERIA.items():
        assert found[key][chosen[name]] == best(found[key][found["accepted"]])
