import pytest
from spoilers import part

from robo_genesis.core.comparison import agree, differences
from robo_genesis.evidence.bundle import BundleRefused, evidence_key, read_manifest


def test_differences_name_the_path_and_both_values():
    found = differences({"a": {"b": 1, "c": [2]}}, {"a": {"b": None, "c": [2]}, "d": 3})
    assert list(found) == [("a.b", 1, None), ("d", "absent", 3)]
    found = differences({"a": 0.1, "b": 11}, {"a": 0.1 + 1e-15, "b": 11.0}, agree)
    assert list(found) == [("b", 11, 11.0)]


def test_the_place_of_a_wrong_field_is_named(folder):
    part("engine", version=1)(folder)
    with pytest.raises(BundleRefused, match=r"^bad-schema: .*json\.engine\.version"):
        read_manifest(folder)


def test_the_key_covers_the_question_and_leaves_circumstances_out(pristine):
    facts = read_manifest(pristine).model_dump()
    question = {"schema_version", "lesson", "page", "seed", "parameters", "source"}
    covered = {"version", "quadrants_version", "precision"}
    changes = [
        ({name: "other"}, name in question) for name in facts.keys() - {"engine"}
    ]
    changes += [
        ({"engine": {**facts["engine"], name: "other"}}, name in covered)
        for name in facts["engine"]
    ]
    assert evidence_key(facts) == facts["evidence_key"]
    for change, counts in changes:
        assert (evidence_key(facts | change) != facts["evidence_key"]) == counts, change
