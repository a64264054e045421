import hashlib
import json

import pytest

from robo_genesis.evidence.bundle import (
    BundleRefused,
    Digest,
    Metric,
    canonical_sha256,
    evidence_key,
    parse_strict,
    read_arrays,
    read_json,
    read_manifest,
    read_metrics,
    sha256,
)


@pytest.fixture
def predicate(pristine):
    return read_manifest(pristine).predicate.model_dump()


def refused(code):
    return pytest.raises(BundleRefused, match=f"^{code}: ")


def test_plain_json_is_parsed():
    assert parse_strict('{"a": [1, 2.5, null, "é"]}', "x") == {"a": [1, 2.5, None, "é"]}


@pytest.mark.parametrize(
    "text",
    [
        *('{"a": 1, "a": 1}', '{"a": {"b": 1, "b": 2}}', "NaN", "[Infinity]", '{"a": -Infinity}'),
        *("", "{", "{'a': 1}", '{"a": 1} {}', "[1,]"),
    ],
)
def test_json_that_is_ambiguous_or_broken_is_refused(text):
    with refused("bad-json") as caught:
        parse_strict(text, "metrics.json")
    assert "metrics.json" in str(caught.value)


def test_a_refusal_has_a_code_and_a_message():
    refusal = BundleRefused("digest", "sha256 of x.")
    assert (refusal.code, str(refusal)) == ("digest", "digest: sha256 of x.")


def test_a_missing_file_is_refused(folder):
    with refused("missing-file"):
        read_json(folder, "nothing.json")


def test_text_that_is_not_utf8_is_refused(folder):
    (folder / "metrics.json").write_bytes(b'{"\xff": 1}')
    with refused("bad-json"):
        read_metrics(folder)


@pytest.mark.parametrize(
    "value",
    ["0" * 63, "0" * 65, "g" * 64, "A" * 64, "0" * 64 + "\n", 0, None],
)
def test_a_digest_is_64_lower_case_hex_digits(value):
    with pytest.raises(ValueError, match="sha256"):
        Digest(sha256=value)


METRIC = {"value": 0.1, "unit": "s", "class": "value", "from": ["q"]}


@pytest.mark.parametrize("value", [1, 0.5, None])
def test_a_metric_is_a_number_or_null(value):
    assert Metric.model_validate({**METRIC, "value": value}).value == value


@pytest.mark.parametrize(
    "change",
    [
        {"value": "0.1"},
        {"value": float("nan")},
        {"value": float("inf")},
        {"class": "guess"},
        {"unit": None},
        {"from": "q"},
        {"note": "fine"},
    ],
    ids=str,
)
def test_a_metric_of_another_form_is_refused(change):
    with pytest.raises(ValueError, match=next(iter(change))):
        Metric.model_validate({**METRIC, **change})


def test_records_are_frozen(pristine):
    with pytest.raises(ValueError, match="frozen"):
        read_manifest(pristine).predicate.seed = 1


def test_metrics_are_read_by_group_and_name(pristine, measured):
    found = read_metrics(pristine)
    assert list(found) == list(measured.metrics)
    assert found["G1"]["rise_time"].model_dump(by_alias=True) == measured.metrics["G1"]["rise_time"]


@pytest.mark.parametrize("content", ["[]", "1", "null", '{"G1": []}', '{"G1": 3}'])
def test_metrics_of_another_form_are_refused(folder, content):
    (folder / "metrics.json").write_text(content)
    with pytest.raises(BundleRefused):
        read_metrics(folder)


@pytest.mark.parametrize("content", ["[]", "1", "null", "{}"])
@pytest.mark.parametrize(("name", "read"), [
    ("arrays.json", read_arrays), ("manifest.json", read_manifest)])  # fmt: skip
def test_records_of_another_form_are_refused(folder, name, read, content):
    (folder / name).write_text(content)
    with refused("bad-schema"):
        read(folder)


def test_the_place_of_a_wrong_field_is_named(folder):
    manifest = json.loads((folder / "manifest.json").read_text())
    manifest["predicate"]["engine"]["version"] = 1
    (folder / "manifest.json").write_text(json.dumps(manifest))
    with pytest.raises(BundleRefused, match=r"predicate.engine.version"):
        read_manifest(folder)


def test_file_digests_are_those_of_the_bytes(tmp_path):
    (tmp_path / "x").write_bytes(b"abc\x00")
    assert sha256(tmp_path / "x") == hashlib.sha256(b"abc\x00").hexdigest()


def test_canonical_digests_ignore_order_and_spelling_of_numbers():
    assert canonical_sha256({"a": 1, "b": [2.0]}) == canonical_sha256({"b": [2], "a": 1.0})
    assert canonical_sha256({"a": 1}) != canonical_sha256({"a": 2})


def test_the_key_is_the_recorded_one(predicate):
    assert evidence_key(predicate) == predicate["evidence_key"]


@pytest.mark.parametrize(
    "name", ["lesson", "page", "seed", "parameters", "source", "schema_version"]
)
def test_the_key_covers_the_question(predicate, name):
    assert evidence_key({**predicate, name: "other"}) != evidence_key(predicate)


@pytest.mark.parametrize("name", ["version", "quadrants_version", "precision"])
def test_the_key_covers_the_engine(predicate, name):
    other = {**predicate, "engine": {**predicate["engine"], name: "other"}}
    assert evidence_key(other) != evidence_key(predicate)


@pytest.mark.parametrize(
    "name",
    [
        "run_id",
        "started",
        "ended",
        "command",
        "host",
        "git",
        "backend",
        "environment",
        "render",
        "checks",
        "warnings",
    ],
)
def test_the_key_leaves_circumstances_out(predicate, name):
    assert evidence_key({**predicate, name: "other"}) == evidence_key(predicate)
