import pytest
from spoilers import part

from robo_genesis.evidence.bundle import (
    BundleRefused,
    Digest,
    Metric,
    canonical_sha256,
    evidence_key,
    read_arrays,
    read_manifest,
    read_metrics,
)
from robo_genesis.evidence.strict_json import differences, parse_strict, read_json


@pytest.fixture
def predicate(pristine):
    return read_manifest(pristine).predicate.model_dump()


def refused(start):
    return pytest.raises(BundleRefused, match=f"^{start}")


AMBIGUOUS = ('{"a": 1, "a": 1}', '{"a": {"b": 1, "b": 2}}', "NaN", "[Infinity]", '{"a": -Infinity}')
BROKEN = ("", "{", "{'a': 1}", '{"a": 1} {}', "[1,]")


@pytest.mark.parametrize("text", AMBIGUOUS + BROKEN)
def test_ambiguous_or_broken_json_is_refused(text):
    with refused("bad-json: metrics.json"):
        parse_strict(text, "metrics.json")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[NaN]", "'NaN' is not a number within"),
        ("[1e999]", "'1e999' is not a number within"),
        ('["\\ud800"]', "surrogates not allowed"),
        ('{"\\udfff": 1}', "surrogates not allowed"),
        ("[" * 33 + "]" * 33, "nested in more than 32 levels"),
        ('{"a": ' * 33 + "{}" + "}" * 33, "nested in more than 32 levels"),
    ],
)
def test_a_value_that_json_cannot_hold_is_named(text, says):
    with refused(f"bad-json: metrics.json: .*{says}"):
        parse_strict(text, "metrics.json")


def test_escapes_of_whole_characters_are_read():
    assert parse_strict(r'["\u00e4", "\ud83e\udd16"]', "metrics.json") == ["ä", "🤖"]


def test_differences_name_the_path_and_both_values():
    found = differences({"a": {"b": 1, "c": [2]}}, {"a": {"b": None, "c": [2]}, "d": 3})
    assert list(found) == [("a.b", 1, None), ("d", "absent", 3)]


def test_a_missing_file_and_text_that_is_not_utf8_are_refused(folder):
    with refused("missing-file"):
        read_json(folder, "nothing.json")
    (folder / "metrics.json").write_bytes(b'{"\xff": 1}')
    with refused("bad-json"):
        read_metrics(folder)


@pytest.mark.parametrize(
    "value", ["0" * 63, "0" * 65, "g" * 64, "A" * 64, "0" * 64 + "\n", 0, None]
)
def test_a_digest_has_64_lower_case_hex_digits(value):
    with pytest.raises(ValueError, match="sha256"):
        Digest(sha256=value)


METRIC = {"value": 0.1, "unit": "s", "class": "value", "from": ["q"]}


WRONG = [("value", "0.1"), ("value", float("nan")), ("value", float("inf")), ("class", "guess"),
         ("unit", None), ("from", "q"), ("note", "fine")]  # fmt: skip


@pytest.mark.parametrize(("field", "value"), WRONG)
def test_a_metric_of_another_form_is_refused(field, value):
    with pytest.raises(ValueError, match=field):
        Metric.model_validate({**METRIC, field: value})


def test_records_are_frozen(pristine):
    with pytest.raises(ValueError, match="frozen"):
        read_manifest(pristine).predicate.seed = 1


READERS = {"arrays.json": read_arrays, "manifest.json": read_manifest, "metrics.json": read_metrics}
FORMS = [(name, text) for name in READERS for text in ("[]", "1", "null")]
FORMS += [("arrays.json", "{}"), ("manifest.json", "{}"), ("metrics.json", '{"G1": []}')]


@pytest.mark.parametrize(("name", "content"), FORMS)
def test_a_file_of_another_form_is_refused(folder, name, content):
    (folder / name).write_text(content)
    with refused(f"bad-schema: {name}"):
        READERS[name](folder)


def test_the_place_of_a_wrong_field_is_named(folder):
    part("engine", version=1)(folder)
    with refused(r"bad-schema: manifest\.json\.predicate\.engine\.version"):
        read_manifest(folder)


def test_canonical_digests_ignore_order_and_spelling_of_numbers():
    assert canonical_sha256({"a": 1, "b": [2.0]}) == canonical_sha256({"b": [2], "a": 1.0})
    assert canonical_sha256({"a": 1}) != canonical_sha256({"a": 2})


def test_the_key_covers_the_question_and_leaves_circumstances_out(predicate):
    assert evidence_key(predicate) == predicate["evidence_key"]
    question = {"schema_version", "lesson", "page", "seed", "parameters", "source"}
    for name in predicate.keys() - {"engine"}:
        changed = evidence_key({**predicate, name: "other"}) != predicate["evidence_key"]
        assert changed == (name in question), name
    for name in predicate["engine"]:
        engine = {**predicate["engine"], name: "other"}
        changed = evidence_key({**predicate, "engine": engine}) != predicate["evidence_key"]
        assert changed == (name in ("version", "quadrants_version", "precision")), name
