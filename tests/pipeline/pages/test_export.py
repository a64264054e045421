"""`make execute` and `make pages`: one page at a time, and the list of pages."""

import pytest
from tiny_book import (
    accept,
    cell,
    contents,
    fails,
    lab,
    make_book,
    notebook,
    refuse,
    start,
)

from robo_genesis.core.project import ProjectError
from robo_genesis.pipeline.stages import Build, BuildError, export_one, run_build

NAMES = ("ROBO_GENESIS_RENDER", "ROBO_GENESIS_BACKEND", "ROBO_GENESIS_COMMAND")
CONTRACT = f"import os\nprint(*(os.environ[name] for name in {NAMES}))"
PAGES = {"contract": notebook(cell(CONTRACT)), "lab": lab("cpu")}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pages")
    make_book(folder, text="# Text\n", broken=notebook(cell("1 / 0")), **PAGES)
    return folder


def export(folder, name, to, verify=accept):
    """Export a page; return the last lines, and the lines of progress."""
    said: list[str] = []
    build = Build(
        book=folder / "book", cache=folder / "cache", say=said.append, verify=verify
    )
    return export_one(name, to, build), [line.split("] ")[1] for line in said]


def test_one_page_is_executed_once_and_exported_under_both_of_its_names(folder):
    last, said = export(folder, "lab", folder / "to")
    assert last[0] == f"Executed page: {folder / 'to' / 'lab'}"
    assert (folder / "to/lab/outputs/cpu/manifest.json").is_file()
    assert said[-1] == "export   lab  executed"
    assert not any("broken" in line for line in said)
    _, said = export(folder, "l04/lab", folder / "again")
    assert said[-1] == "export   lab  reused"
    assert (folder / "again/lab/executed.ipynb").is_file()
    with pytest.raises(
        BuildError, match=r"refused: metrics: .* The next build executes"
    ):
        export(folder, "lab", folder / "refused", refuse)
    assert not (folder / "refused").exists()
    _, said = export(folder, "lab", folder / "again")
    assert "lab  its stored run is not used; executed again (files: " in said[1]
    assert said[-1] == "export   lab  executed"


@pytest.mark.parametrize("name", ["", "None/None", "l04/lecture", "text"])
def test_another_page_is_refused_and_the_valid_ones_are_listed(folder, name):
    valid = rf"PAGE='{name}' is not valid\. Executed pages of this book: broken, contract, lab\."
    with pytest.raises(BuildError, match=valid):
        export(folder, name, folder / "to")


def test_a_place_that_cannot_be_used_is_refused_before_the_run(folder, no_file):
    (folder / "mine" / "broken").mkdir(parents=True)
    for to, said in (
        (no_file, "is not a folder that you may write"),
        (None, "TO is not set"),
        (folder / "mine", r"mine/broken is not replaced: it has no page\.json"),
    ):
        with pytest.raises(ProjectError, match=said):
            export(folder, "broken", to)


def test_a_failed_page_is_status_1_its_report_and_no_export(folder, tmp_path):
    report = fails("execute.py", folder, PAGE="broken", TO=str(tmp_path / "to"))
    assert "broken, code cell 1, line 10: 1 / 0" in report
    assert "FAILED: nothing was exported." in report
    assert not (tmp_path / "to").exists()


def test_a_page_has_the_contract_of_a_build_and_names_its_own_command(folder, tmp_path):
    log = folder / "cache/logs/contract.log"
    log.parent.mkdir(parents=True, exist_ok=True)
    log.write_text("of an older run")
    process = start("execute.py", folder, PAGE="contract", TO=str(tmp_path), RENDER="0")
    said, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    assert f"contract  started: 1 cells; its log: {log}" in said
    assert log.read_text() == "0 cpu make execute\n"
    assert r"0 cpu make execute\n" in (tmp_path / "contract/executed.ipynb").read_text()


@pytest.fixture(scope="module")
def executed(folder):
    """Both pages as another machine exports them."""
    for name in PAGES:
        export(folder, name, folder / "executed")
    return folder / "executed"


@pytest.mark.parametrize("release", [False, True])
def test_pages_from_elsewhere_are_published_without_a_run(
    executed, tmp_path, monkeypatch, release
):
    stages = "robo_genesis.pipeline.stages"
    monkeypatch.setattr(f"{stages}.execute_pages", None)  # whoever calls it fails
    monkeypatch.setattr(f"{stages}.unclean", lambda root: [])
    monkeypatch.setattr(f"{stages}.missing_for_release", lambda *given: [])
    monkeypatch.setattr(
        f"{stages}.agree", lambda *of: [f"Executed in {of[0].name}, {of[1].name}."]
    )
    book, store = (
        make_book(tmp_path, **PAGES, page="# A\n\n[lost](nowhere.html)\n"),
        "cache/pages",
    )

    def build(verify=accept) -> list[str]:
        given = {"verify": verify, "say": [].append, "release": release}
        given |= {"executed": executed, "second": tmp_path / "again"}
        return run_build(Build(book=book, cache=tmp_path / "cache", **given))

    for verify, said in ((refuse, "refused: metrics: "), (accept, "nowhere")):
        with pytest.raises(ProjectError, match=said):
            build(verify)
        assert not (
            tmp_path / store
        ).exists()  # later builds would find the pages there
    (book / "page.md").write_text("# A\n\n```{course-processors}\n```\n")
    assert {"Pages: 0 executed, 2 reused.", "Executed in executed, again."} <= {
        *build()
    }
    assert (
        "Executed in executed, again." in (book / "_build/html/page.html").read_text()
    )
    assert contents(book / "_build/evidence/l04/cpu") == contents(
        executed / "lab/outputs/cpu"
    )
    assert "cpu make book" in (book / "_build/html/contract.html").read_text()
    for name in PAGES:
        [stored] = (tmp_path / store / name).iterdir()
        assert contents(stored) == contents(executed / name)
