"""The workflows for GitHub: what their steps use exists, and what they may do is limited."""

import json
import re
from pathlib import Path
from typing import Any

import pytest
import yaml

from robo_genesis.core.project import BOOK, ROOT
from robo_genesis.pipeline.html.archive import ARCHIVE
from robo_genesis.pipeline.pages.book import find_pages

FOLDER = ROOT / ".github"
SETUP = FOLDER / "actions" / "setup" / "action.yml"
MAKE = re.compile(r"\bmake ([a-z.][\w./-]*)")
PINNED = re.compile(
    r"uses: (?:[\w-]+/[\w./-]+@[0-9a-f]{40} # v\d+\.\d+\.\d+|docker://\S+:\S+@sha256:[0-9a-f]{64})$"
)


def read(path: Path) -> dict[str, Any]:
    """Return a file of YAML. YAML 1.1 reads `on` as true; the base loader leaves all as text."""
    return yaml.load(path.read_text(), Loader=yaml.BaseLoader)


FLOWS = {path.stem: read(path) for path in sorted((FOLDER / "workflows").glob("*.yml"))}
JOBS = {
    f"{flow}.{name}": job for flow in FLOWS for name, job in FLOWS[flow]["jobs"].items()
}
STEPS = [step for job in JOBS.values() for step in job["steps"]]
STEPS += read(SETUP)["runs"]["steps"]
TARGETS = {*re.findall(r"^([\w./-]+):", (ROOT / "Makefile").read_text(), re.M)}


def made(job: str) -> list[str]:
    """Return the targets that the steps of a job make."""
    return [t for one in JOBS[job]["steps"] for t in MAKE.findall(one.get("run", ""))]


def test_every_target_that_a_step_makes_or_a_document_names_is_one():
    assert {
        name for one in STEPS for name in MAKE.findall(one.get("run", ""))
    } <= TARGETS
    documents = [*ROOT.glob("*.md"), *FOLDER.rglob("*.md"), *FOLDER.rglob("*.yml")]
    for document in documents:
        if document.name != "CHANGELOG.md":  # it names targets of the past as well
            spans = re.findall(
                r"`make ([a-z-]+)|^    make ([a-z-]+)", document.read_text(), re.M
            )
            assert {word for pair in spans for word in pair if word} <= TARGETS, (
                document.name
            )


def test_the_file_that_is_attested_is_part_of_the_site():
    attested = [
        one["with"]["subject-path"]
        for one in JOBS["book.deploy"]["steps"]
        if "attest" in one["uses"]
    ]
    assert attested == [f"site/{ARCHIVE}"]


def test_what_is_published_was_linted_and_tested_and_is_a_release():
    assert made("book.build") == ["lint", "test", "test-all", "book"]
    assert JOBS["book.deploy"]["needs"] == "build"
    for job in ("book.build", "release.book"):
        (given,) = [one["env"] for one in JOBS[job]["steps"] if "make book" in str(one)]
        assert (given["RELEASE"], given["SOLUTIONS"]) == ("1", "${{ vars.SOLUTIONS }}")


def test_jobs_can_write_only_what_they_must():
    assert all(flow["permissions"] == {"contents": "read"} for flow in FLOWS.values())
    assert JOBS["book.deploy"]["if"].startswith("github.ref == 'refs/heads/main'")
    writing = [n for n, job in JOBS.items() if "write" in str(job.get("permissions"))]
    for name in writing:  # what can write runs no code of the course
        for one in JOBS[name]["steps"]:
            assert not re.search(rf"{MAKE.pattern}|python", one.get("run", "")), name
            assert not one.get("uses", "").startswith("./"), name
    for job in JOBS.values():  # no checkout leaves its token
        for one in job["steps"]:
            if one.get("uses", "").startswith("actions/checkout"):
                assert one["with"]["persist-credentials"] == "false"


@pytest.mark.parametrize("path", [SETUP, *(FOLDER / "workflows").glob("*.yml")])
def test_every_action_is_pinned_by_its_commit_or_digest(path):
    lines = [line.strip().removeprefix("- ") for line in path.read_text().splitlines()]
    for line in lines:
        if line.startswith("uses:"):
            local = re.fullmatch(r"uses: (\./\S+)", line)
            assert (ROOT / local[1]).is_dir() if local else PINNED.match(line), line


def test_input_never_becomes_shell_and_every_job_ends():
    assert not [one["run"] for one in STEPS if "${{" in one.get("run", "")]
    for name, job in JOBS.items():
        assert re.search(r"\b\d{1,3}\b", job["timeout-minutes"]), name


def test_jobs_run_in_the_container_of_the_labs():
    """Dependabot updates the digest in the Dockerfile; this test requires it in the workflows."""
    dockerfile = (ROOT / ".devcontainer/Dockerfile").read_text()
    (image,) = re.findall(r"^FROM (\S+@sha256:[0-9a-f]{64})$", dockerfile, re.M)
    images = {job["container"] for job in JOBS.values() if "container" in job}
    assert images == {image, "python:${{ matrix.python }}-bookworm"}


def test_the_dev_container_sets_up_the_course_and_runs_a_lab():
    settings = json.loads((ROOT / ".devcontainer/devcontainer.json").read_text())
    command = settings["postCreateCommand"]
    assert MAKE.findall(command) == [".venv/.installed", "execute"]
    (lab,) = re.findall(r"PAGE=(\S+)", command)
    assert lab in {f"{page.lesson}/{page.page}" for page in find_pages(BOOK)}
