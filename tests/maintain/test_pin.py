"""Which version may take the pin's place, and the one line that is written."""

import pytest

from robo_genesis.core import project
from robo_genesis.core.project import ProjectError
from robo_genesis.maintain.repin import set_pin, wanted_version


@pytest.mark.parametrize(
    ("given", "found"), [("v1.4.0", "1.4.0"), ("2.0.0rc1", "2.0.0rc1")]
)
def test_a_version_is_read_as_pip_reads_it(given, found):
    assert wanted_version(given, "1.3.3") == found


@pytest.mark.parametrize(
    ("given", "says"),
    [
        (
            "",
            r"GENESIS='' is not a version\. Usage: make repin GENESIS=.* \(the pin is 1\.3\.3\)",
        ),
        ("v1.3.3.0", r"is the pin already"),
    ],
)
def test_what_is_no_other_version_is_refused(given, says):
    with pytest.raises(ProjectError, match=says):
        wanted_version(given, "1.3.3")


def project_file(folder, line: str):
    (folder / "pyproject.toml").write_text(
        f"[project]\n# genesis-world==1.3.3 here\n{line}\n"
    )
    return folder


@pytest.mark.parametrize("pinned", ["genesis-world==1.3.3", "genesis-world == 1.3.3"])
def test_only_the_pin_is_rewritten(tmp_path, pinned):
    root = project_file(tmp_path, f'dependencies = ["a>=1", "{pinned}"] # why')
    set_pin(root, "1.3.3", "1.4.5")
    assert project.engine_pin(root) == "1.4.5"
    assert (root / "pyproject.toml").read_text() == (
        "[project]\n# genesis-world==1.3.3 here\n"
        'dependencies = ["a>=1", "genesis-world==1.4.5"] # why\n'
    )


@pytest.mark.parametrize(
    "lines", ['"genesis-world==1.3.30"', '"genesis-world==1.3.3", ' * 2]
)
def test_a_pin_that_does_not_stand_there_once_is_not_touched(tmp_path, lines):
    root = project_file(tmp_path, f"dependencies = [{lines}]")
    text = (root / "pyproject.toml").read_text()
    with pytest.raises(ProjectError, match=r"expected once"):
        set_pin(root, "1.3.3", "1.4.5")
    assert (root / "pyproject.toml").read_text() == text
