"""A result is made once for the same inputs, and again for any other."""

import os
import time
from functools import partial

import pytest

from robo_genesis.core import files as module
from robo_genesis.core.files import KEPT, derived


@pytest.fixture
def made(tmp_path):
    """Ask for what follows from inputs; `made.calls` lists what was made."""

    def ask(*inputs: bytes, kind: str = "a") -> bytes:
        def make() -> bytes:
            ask.calls.append(inputs)
            return b"+".join(inputs)

        return derived(kind, inputs, make, tmp_path)

    ask.calls = []
    return ask


@pytest.mark.parametrize("other", [(b"one",), (b"onetwo",), (b"two", b"one")])
def test_the_same_inputs_are_made_once_and_others_anew(made, other):
    assert made(b"one", b"two") == made(b"one", b"two") == b"one+two"
    assert made(*other) == b"+".join(other)
    assert len(made.calls) == 2


def test_another_kind_another_lock_and_another_environment_are_made_anew(
    made, monkeypatch
):
    made(b"one")
    made(b"one", kind="b")
    monkeypatch.setattr(module, "lock_digest", lambda: "another")
    made(b"one")
    monkeypatch.setattr(module, "_installed", lambda: "other packages")
    made(b"one")
    assert len(made.calls) == 4


def test_a_value_is_made_again_when_the_module_that_makes_it_changes(
    tmp_path, monkeypatch
):
    calls: list[int] = []
    monkeypatch.setattr(module, "derived", partial(derived, cache=tmp_path))
    for source in (b"one", b"one", b"other"):
        monkeypatch.setattr(module, "_source", lambda file, source=source: source)
        assert module.derived_value(
            "a", ["x", 1], lambda: calls.append(1) or [1.5]
        ) == [1.5]
    assert len(calls) == 2


def test_a_cache_that_cannot_be_written_costs_time_alone(no_file):
    assert derived("a", [b"one"], lambda: b"made", no_file) == b"made"


def test_what_nobody_asked_for_in_a_month_goes_and_the_rest_stays(tmp_path, made):
    for number in range(20):
        made(str(number).encode())
    long_ago = time.time() - KEPT - 60
    for file in (tmp_path / "derived" / "a").iterdir():
        os.utime(file, (long_ago, long_ago))
    made(b"0")  # in use again
    made(b"one more")
    assert len(list((tmp_path / "derived" / "a").iterdir())) == 2
    made.calls.clear()
    made(b"0")
    assert made.calls == []
