import pytest
from spoilers import part

from robo_genesis.core.comparison import agree, differences
from robo_genesis.evidence.bundle import (
    BundleRefused,
    Digest,
    evidence_key,
    read_manifest,
)
from robo_genesis.evidence.copies import same_times


@pytest.fixture
def predicate(pristine):
    return read_manifest(pristine).predicate.model_dump()


def test_differences_name_the_path_and_both_values():
    found = differences({"a": {"b": 1, "c": [2]}}, {"a": {"b": None, "c": [2]}, "d": 3})
    assert list(found) == [("a.b", 1, None), ("d", "absent", 3)]
    found = differences({"a": 0.1, "b": 11}, {"a": 0.1 + 1e-15, "b": 11.0}, agree)
    assert list(found) == [("b", 11, 11.0)]


def test_a_time_of_another_run_and_a_multiple_of_several_are_a_copy():
    for a, b, copied in (
        (0.2, 0.3, False),
        (0.1, 0.3, True),
        (0.3, 0.6, True),
        (0.3, 1, False),
    ):
        assert same_times({"a": a, "b": b}, {"a": 0.1, "b": 0.2}) == copied


@pytest.mark.parametrize("value", ["0" * 63, "A" * 64, "0" * 64 + "\n", None])
def test_a_digest_has_64_lower_case_hex_digits(value):
    with pytest.raises(ValueError, match="sha256"):
        Digest(sha256=value)


def test_the_place_of_a_wrong_field_is_named(folder):
    part("engine", version=1)(folder)
    with pytest.raises(
        BundleRefused, match=r"^bad-schema: .*predicate\.engine\.version"
    ):
        read_manifest(folder)


def test_the_key_covers_the_question_and_leaves_circumstances_out(predicate):
    assert evidence_key(predicate) == predicate["evidence_key"]
    question = {"schema_version", "lesson", "page", "seed", "parameters", "source"}
    for name in predicate.keys() - {"engine"}:
        changed = (
            evidence_key({**predicate, name: "other"}) != predicate["evidence_key"]
        )
        assert changed == (name in question), name
    for name in predicate["engine"]:
        engine = {**predicate["engine"], name: "other"}
        changed = (
            evidence_key({**predicate, "engine": engine}) != predicate["evidence_key"]
        )
        assert changed == (name in ("version", "quadrants_version", "precision")), name
