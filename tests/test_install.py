"""The installation: which folder it empties, and its one line about what failed."""

import os
import sys
from pathlib import Path

import pytest

from robo_genesis import install
from robo_genesis.install import DONE, LOG, MARK, Installation, InstallError

CPU = "https://example.org/whl/cpu"


@pytest.fixture
def here(tmp_path, monkeypatch) -> Installation:
    """An installation in a folder whose interpreter is that of the tests."""
    monkeypatch.chdir(tmp_path)
    Path("lock").write_text("six==1.17\ntorch==2.13.0\n")
    python = Path(".venv/bin/python")
    python.parent.mkdir(parents=True)
    python.write_text(f'#!/bin/sh\nexec {sys.executable} "$@"\n')
    python.chmod(0o755)
    return Installation(Path(".venv"), Path("lock"), ("six",), CPU)


@pytest.mark.parametrize(
    ("file", "folder", "said"),
    [
        (".venv/my.txt", ".venv", "was not made by this command, so it is not emptied"),
        (".venv/bin/python", ".venv", "or use it as it is: .venv/bin/python"),
        (".venv", ".venv", "was not made by"),
        (f"of-mine/{DONE}", "link", "is a link"),
        (f"a:b/{DONE}", "a:b", "has a colon"),
        ("of-mine/file", ".venv", None),
        (f".venv/{MARK}", ".venv", None),  # it was interrupted
        (f".venv/{DONE}", ".venv", None),
    ],
)
def test_only_a_folder_of_its_own_is_emptied(tmp_path, monkeypatch, file, folder, said):
    monkeypatch.chdir(tmp_path)
    Path(file).parent.mkdir(exist_ok=True, parents=True)
    Path(file).touch()
    Path("link").symlink_to("of-mine")
    before = sorted(Path().rglob("*"))
    installation = Installation(Path(folder), Path("lock"), ())
    if said:
        with pytest.raises(InstallError, match=said):
            installation.empty()
        assert sorted(Path().rglob("*")) == before
    else:
        installation.empty()
        assert [path.name for path in Path(folder).iterdir()] == [MARK]


REFUSED = (
    "Retrying (Retry(total={}, connect=None)) after connection broken by '{}': /{}/six/"
)
NEW = "NewConnectionError(<pip.HTTPSConnection at 0x7>: {})"
DNS, PROXY = (
    NEW.format("[Errno -2] Name unknown"),
    f"ProxyError({NEW.format('[Errno 111] No')})",
)
LOOKING = f"Looking in indexes: https://mirror.org/simple, {CPU}"
KILLED = "import os; os.kill(os.getpid(), 9)"
FULL = "ERROR: Could not install: [Errno 28] No space left on device"


@pytest.mark.parametrize(
    ("printed", "said"),
    [
        (
            [REFUSED.format(0, DNS, "simple")],
            "https://pypi.org/simple cannot be reached ([Errno -",
        ),
        (
            [LOOKING, REFUSED.format(0, DNS, "simple")],
            "https://mirror.org/simple cannot be",
        ),
        (
            [LOOKING, REFUSED.format(0, PROXY, "whl/cpu")],
            f"{CPU} cannot be reached (the proxy: [E",
        ),
        ([REFUSED.format(0, "ReadTimeout(read timed out)", "packages")], "(timed out)"),
        (
            [REFUSED.format(1, DNS, "simple"), "Collecting six", "last words"],
            "last words",
        ),
        (
            ["ERROR: No matching distribution found for six", "more"],
            "No matching distribution",
        ),
        (
            ["ERROR: Exception:", "Traceback", "ReadTimeoutError: host='x'"],
            "ReadTimeoutError: ho",
        ),
    ],
)
def test_what_failed_is_one_line(here, monkeypatch, printed, said):
    for name in (
        "PIP_TARGET",
        "PIP_DRY_RUN",
        "PYTHONPATH",
    ):  # they would install elsewhere
        monkeypatch.setenv(name, "other")
    code = "import os; e = os.environ; assert 'other' not in e.values() and e['PIP_USER'] == '0'"
    code += f"; print({chr(10).join(printed)!r}); raise SystemExit(1)"
    with pytest.raises(InstallError) as caught:
        here.call("-c", code)
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)
    assert printed[-1] in (here.folder / LOG).read_text()


def test_an_unreachable_index_of_torch_is_named_and_pips_own_follows(here, monkeypatch):
    lines, given = [], []
    lost = InstallError(f"{CPU} cannot be reached (refused)")

    def pip(self, *arguments):
        given.append("--extra-index-url" in arguments)
        assert "torch==2.13.0" in arguments
        if given[-1]:
            raise lost

    monkeypatch.setattr(Installation, "pip", pip)
    Installation(here.folder, here.lock, (), torch_index=CPU, say=lines.append).torch()
    assert given == [True, False]
    assert [f"{CPU} cannot be reached (refused)" in line for line in lines] == [True]
    lost = InstallError("https://pypi.org/simple cannot be reached")
    with pytest.raises(InstallError):
        here.torch()


def test_an_index_that_refuses_ends_pip_after_its_attempts(here, monkeypatch):
    """This is pip itself: its words decide."""
    monkeypatch.setenv("PIP_CONFIG_FILE", os.devnull)
    for name in ("PIP_FIND_LINKS", "PIP_EXTRA_INDEX_URL"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("PIP_INDEX_URL", "http://127.0.0.1:9/simple")
    with pytest.raises(
        InstallError, match=r"^http://127.0.0.1:9/simple cannot be reached \(\[E"
    ):
        here.pip("six", "no-such-package")


@pytest.mark.parametrize(
    ("code", "status", "said"),
    [
        (f"raise SystemExit({FULL!r})", 1, "Step"),
        (KILLED, 1, "memory"),
        ("pass", 0, ""),
    ],
)
def test_a_failed_step_has_its_number_and_the_advice(
    here, monkeypatch, capsys, code, status, said
):
    for name in ("environment", "torch", "pip"):
        monkeypatch.setattr(Installation, name, lambda self, *arguments: None)
    call = Installation.call
    monkeypatch.setattr(
        Installation, "call", lambda self, *_, **__: call(self, "-c", code)
    )
    assert install.run(here) == status
    out, err = capsys.readouterr()
    assert out.splitlines()[-1].startswith(f"install  step {5 - status} of 5, ")
    assert said.lower() in err
    assert (here.folder / DONE).exists() == (status == 0)
    if status:
        assert len(err.splitlines()) == 1
        assert err.startswith("FAILED: step 4 of 5, a check of all versions: ")
