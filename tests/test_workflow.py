"""The workflows for GitHub: what their steps use exists, and what they may do is limited."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import yaml

from robo_genesis.core.project import BOOK, ROOT, engine_cache_folder
from robo_genesis.pipeline.html.archive import SUMS
from robo_genesis.pipeline.pages.book import find_pages

FOLDER = ROOT / ".github"
SETUP = FOLDER / "actions" / "setup" / "action.yml"
MAKE = re.compile(r"\bmake ([a-z.][\w./-]*)")
INTERPOLATED = re.compile(r"\$\{\{")
PINNED = re.compile(
    r"uses: (?:[\w-]+/[\w./-]+@[0-9a-f]{40} # v\d+\.\d+\.\d+|docker://\S+:\S+@sha256:[0-9a-f]{64})$"
)
LOCAL = re.compile(r"uses: (\./\S+)$")


def read(path: Path) -> dict[str, Any]:
    """Return a file of YAML. YAML 1.1 reads `on` as true; the base loader leaves all as text."""
    return yaml.load(path.read_text(), Loader=yaml.BaseLoader)


FLOWS = {path.stem: read(path) for path in sorted((FOLDER / "workflows").glob("*.yml"))}
PLAN, RECORD = FLOWS["book"], FLOWS["record"]
JOBS = PLAN["jobs"]
EVERY_JOB = {
    f"{flow}.{name}": job for flow in FLOWS for name, job in FLOWS[flow]["jobs"].items()
}
STEPS = [step for job in EVERY_JOB.values() for step in job["steps"]]
STEPS += read(SETUP)["runs"]["steps"]


def step(job: dict[str, Any], uses: str, number: int = -1) -> dict[str, Any]:
    """Return the inputs of the step that uses an action, by default the last such step."""
    return [one for one in job["steps"] if one.get("uses", "").startswith(uses)][
        number
    ]["with"]


def making(job: dict[str, Any], target: str) -> dict[str, Any]:
    (found,) = [
        step for step in job["steps"] if target in MAKE.findall(step.get("run", ""))
    ]
    return found


def test_every_target_that_a_step_makes_or_a_document_names_is_one():
    targets = set(re.findall(r"^([\w./-]+):", (ROOT / "Makefile").read_text(), re.M))
    made = {name for one in STEPS for name in MAKE.findall(one.get("run", ""))}
    assert made >= {
        "lint",
        "test",
        "execute",
        "book",
        "pages",
        "repin",
        "evidence-rocm",
    }
    assert made <= targets
    documents = [*ROOT.glob("*.md"), *FOLDER.rglob("*.md"), *FOLDER.rglob("*.yml")]
    documents += [ROOT / ".devcontainer/devcontainer.json", ROOT / ".rocm/Dockerfile"]
    for document in documents:
        if document.name != "CHANGELOG.md":  # it names targets of the past as well
            # A word of prose after "make" is not in a span or block of code.
            code = re.findall(
                r"`make ([^`\n]*)`|^    make (.*)$", document.read_text(), re.M
            )
            words = {
                word for found in code for word in " ".join(found).split("#")[0].split()
            }
            named = {
                word.strip(".,")
                for word in words
                if re.fullmatch(r"[a-z-]+[.,]?", word)
            }
            assert named <= targets, document.name


def run_plan(folder: Path, python: str) -> tuple[int, dict[str, str]]:
    """Run the step that says what to execute, as the workflow's shell does.

    Return its status and what it put out.
    """
    (plan,) = [one["run"] for one in JOBS["lint"]["steps"] if one.get("id") == "plan"]
    (folder / "output").touch()
    # A make of this test's own would say where it is; the workflow's is the outermost.
    given = {name: value for name, value in os.environ.items() if name != "MAKELEVEL"}
    script = plan.replace(".venv/bin/python", python)
    given |= {"GITHUB_OUTPUT": str(folder / "output"), "MAKEFLAGS": f"PYTHON={python}"}
    command = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", script]
    done = subprocess.run(command, cwd=ROOT, env=given)
    lines = (folder / "output").read_text().splitlines()
    return done.returncode, dict(line.split("=", 1) for line in lines)


def test_the_matrix_is_the_pages_of_the_book_and_a_plan_that_fails_stops_the_workflow(
    tmp_path,
):
    assert run_plan(tmp_path, "false") == (2, {})
    status, output = run_plan(tmp_path, sys.executable)
    assert status == 0
    assert json.loads(output["pages"]) == [page.docname for page in find_pages(BOOK)]
    assert output["kernels"] == engine_cache_folder().name
    assert JOBS["lint"]["outputs"] == {
        n: f"${{{{ steps.plan.outputs.{n} }}}}" for n in output
    }
    matrix = JOBS["execute"]["strategy"]["matrix"]
    assert matrix["page"] == "${{ fromJSON(needs.lint.outputs.pages) }}"
    assert (matrix["machine"], len(matrix)) == (["first", "second"], 2)
    assert JOBS["execute"]["strategy"]["fail-fast"] == "false"


def test_the_book_is_built_from_pages_that_two_machines_executed():
    execute, book = (making(JOBS[job], job) for job in ("execute", "book"))
    sent = step(JOBS["execute"], "actions/upload-artifact", 0)
    assert execute["env"] == {"PAGE": "${{ matrix.page }}", "TO": sent["path"]}
    assert sent["name"] == "executed-${{ matrix.machine }}-${{ strategy.job-index }}"
    for number, (machine, name) in enumerate(
        {"first": "EXECUTED", "second": "SECOND"}.items()
    ):
        taken = step(JOBS["book"], "actions/download-artifact", number)
        assert taken["pattern"] == f"executed-{machine}-*"
        assert taken["path"] == book["env"][name]
    assert "execute" in JOBS["book"]["needs"]


def test_what_is_deployed_has_passed_the_gate_of_releases():
    builds = [
        one for job in JOBS.values() for one in job["steps"] if "make book" in str(one)
    ]
    assert builds == [book := making(JOBS["book"], "book")]
    assert "if" not in JOBS["book"]
    assert book["env"]["RELEASE"] == "1"
    released = making(FLOWS["release"]["jobs"]["book"], "book")
    assert released["env"]["RELEASE"] == "1"
    assert {one["env"]["SOLUTIONS"] for one in (book, released)} == {
        "${{ vars.SOLUTIONS }}"
    }
    assert (
        book["env"]["SITE_URL"] == "${{ vars.SITE_URL || needs.address.outputs.url }}"
    )
    events = 'contains(fromJSON(\'["push", "workflow_dispatch"]\'), github.event_name)'
    assert events in JOBS["address"]["steps"][0]["if"]
    deploy = JOBS["deploy"]
    assert events in deploy["if"]
    assert set(deploy["needs"]) == {"workflows", "test", "book"}
    taken = step(deploy, "actions/download-artifact")
    sent = [step(JOBS["book"], "actions/upload-artifact", n) for n in (0, 1)]
    assert [one["path"] for one in sent if one["name"] == taken["name"]] == [
        "book/_build/html"
    ]
    assert step(deploy, "actions/upload-pages-artifact")["path"] == taken["path"]
    assert (
        step(deploy, "actions/attest@")["subject-checksums"]
        == f"{taken['path']}/{SUMS}"
    )


def test_the_parts_of_the_tests_are_all_of_them():
    parts = JOBS["test"]["strategy"]["matrix"]
    marks = {one["part"]: one["marks"] for one in parts["include"]}
    assert list(marks) == parts["part"]
    assert JOBS["test"]["env"] == {"PYTEST_ADDOPTS": '-m "${{ matrix.marks }}"'}
    for engine in (False, True):
        for browser in (False, True):
            names = {"engine": engine, "browser": browser}
            chosen = [part for part, mark in marks.items() if eval(mark, {}, names)]
            assert len(chosen) == 1, names


def test_every_environment_gets_torch_for_the_cpu_from_the_address_of_the_book():
    command = ["make", "--always-make", "--dry-run", ".venv/.installed"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    (line,) = [
        one for one in done.stdout.splitlines() if one.startswith("TORCH_INDEX=")
    ]
    value = line.removesuffix(" \\")
    address = yaml.safe_load((BOOK / "_config.yml").read_text())["sphinx"]["config"][
        "torch_index"
    ]
    for given, read in (("", address), ("https://example.org", "https://example.org")):
        script = f'{value}; echo "$TORCH_INDEX"'
        environment = os.environ | {"TORCH_INDEX": given}
        said = subprocess.check_output(
            ["bash", "-c", script], cwd=ROOT, env=environment, text=True
        )
        assert said.strip() == read
    for name, flow in FLOWS.items():
        assert flow["env"]["TORCH_INDEX"] == "${{ vars.TORCH_INDEX }}", name


def test_a_scheduled_run_and_one_of_a_tag_restore_nothing():
    cached = [
        one
        for one in STEPS
        if re.match("actions/cache(/restore)?@", one.get("uses", ""))
    ]
    assert len(cached) == 3
    assert all("github.event_name != 'schedule'" in one["if"] for one in cached)
    of_setup = [one for one in cached if one in read(SETUP)["runs"]["steps"]]
    assert of_setup
    assert all("github.ref_type != 'tag'" in one["if"] for one in of_setup)
    release = [one for job in FLOWS["release"]["jobs"].values() for one in job["steps"]]
    assert not any("cache" in one.get("uses", "") for one in release)


def test_jobs_can_write_only_what_they_must():
    assert {str(flow["permissions"]) for flow in FLOWS.values()} == {
        "{'contents': 'read'}"
    }
    more = {
        name: job["permissions"]
        for name, job in EVERY_JOB.items()
        if "permissions" in job
    }
    pull_request = {"contents": "write", "pull-requests": "write"}
    signed = {"id-token": "write", "attestations": "write"}
    assert more == {
        "book.address": {"pages": "read"},
        "book.deploy": {"pages": "write"} | signed,
        "book.propose": pull_request,
        "record.propose": pull_request,
        "release.release": {"contents": "write"} | signed,
    }
    assert JOBS["deploy"]["if"].startswith("github.ref == 'refs/heads/main'")
    for name in (
        more
    ):  # what can write runs no code of the course, of its packages or its pages
        for one in EVERY_JOB[name]["steps"]:
            assert not re.search(rf"{MAKE.pattern}|python", one.get("run", "")), name
            assert not one.get("uses", "").startswith("./"), name
    for name, job in EVERY_JOB.items():  # no checkout leaves its token
        for one in job["steps"]:
            if one.get("uses", "").startswith("actions/checkout"):
                assert one["with"]["persist-credentials"] == "false", name


def test_only_a_person_starts_a_recording():
    """A runner of one's own must never run the code of a pull request."""
    assert list(RECORD["on"]) == ["workflow_dispatch"]
    own = {
        n: job["runs-on"]
        for n, job in EVERY_JOB.items()
        if "self-hosted" in job["runs-on"]
    }
    assert own == {"record.record": ["self-hosted", "rocm"]}


def test_a_recording_is_verified_and_compared_before_it_is_proposed():
    jobs = RECORD["jobs"]
    assert making(jobs["cpu"], "evidence")["env"] == {
        "BACKEND": "cpu",
        "TO": "executed",
    }
    compare = [MAKE.findall(one.get("run", "")) for one in jobs["compare"]["steps"]]
    assert [name for names in compare for name in names] == ["verify", "compare"]
    needs = [
        jobs[name].get("needs") for name in ("cpu", "record", "compare", "propose")
    ]
    assert needs == [None, "cpu", ["cpu", "record"], "compare"]


def test_every_action_is_pinned_by_its_commit_or_digest():
    files = [SETUP, *(FOLDER / "workflows").glob("*.yml")]
    used = [
        line.strip().removeprefix("- ")
        for f in files
        for line in f.read_text().splitlines()
    ]
    used = [line for line in used if line.startswith("uses:")]
    assert len(used) > 30
    for line in used:
        local = LOCAL.match(line)
        assert local or PINNED.match(line), line
        assert local is None or (ROOT / local[1] / "action.yml").is_file(), line
    versions = {line.partition("@")[0]: line for line in used}
    assert set(versions.values()) == set(used)  # one version of each


def test_input_never_becomes_shell_and_every_job_ends():
    for one in STEPS:
        assert not INTERPOLATED.search(one.get("run", "")), one["run"]
    for name, job in EVERY_JOB.items():
        assert not job.get("container", "").endswith("latest"), name
        assert re.search(r"\b\d{1,3}\b", job["timeout-minutes"]), name


def test_jobs_run_in_the_container_of_the_labs():
    """Dependabot updates the digest in the Dockerfile; this test requires it in the workflows."""
    (image,) = re.findall(
        r"^FROM (\S+)$", (ROOT / ".devcontainer/Dockerfile").read_text(), re.M
    )
    assert re.search(r"@sha256:[0-9a-f]{64}$", image)
    found = {job["container"] for job in EVERY_JOB.values() if "container" in job}
    assert found == {image, "python:${{ matrix.python }}-bookworm"}


def test_the_dev_container_sets_up_the_course_and_runs_a_lab():
    settings = json.loads((ROOT / ".devcontainer/devcontainer.json").read_text())
    command = settings["postCreateCommand"]
    assert MAKE.findall(command) == [".venv/.installed", "execute"]
    (lab,) = re.findall(r"PAGE=(\S+)", command)
    assert lab in {f"{page.lesson}/{page.page}" for page in find_pages(BOOK)}
    assert "TO=executed" in command
    assert "/executed/" in (ROOT / ".gitignore").read_text().splitlines()


def test_dependabot_watches_each_kind_of_dependency():
    updates = read(FOLDER / "dependabot.yml")["updates"]
    kinds = {one["package-ecosystem"] for one in updates}
    assert kinds >= {"github-actions", "pip", "npm", "docker"}
    for folder in (name for one in updates for name in one.get("directories", [])):
        assert (ROOT / folder.strip("/")).is_dir(), folder
