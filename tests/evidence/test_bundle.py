import pytest
from spoilers import part

from robo_genesis.evidence.bundle import BundleRefused, evidence_key, read_manifest


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
