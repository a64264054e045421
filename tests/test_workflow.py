"""The workflow for GitHub: what its steps use exists, and what they may do is limited."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import yaml

from robo_genesis.core.project import BOOK, ROOT, engine_cache_folder
from robo_genesis.lessons.book_pages import find_pages

WORKFLOW = ROOT / ".github" / "workflows" / "book.yml"
SETUP = ROOT / ".github" / "actions" / "setup" / "action.yml"
MAKE = re.compile(r"\bmake ([a-z.][\w./-]*)")
INTERPOLATED = re.compile(r"\$\{\{")


# YAML 1.1 reads `on` as true; the base loader leaves every scalar as text.
PLAN, OWN = (yaml.load(path.read_text(), Loader=yaml.BaseLoader) for path in (WORKFLOW, SETUP))
JOBS = PLAN["jobs"]
STEPS = [step for job in JOBS.values() for step in job["steps"]] + OWN["runs"]["steps"]


def step(job: dict[str, Any], uses: str) -> dict[str, Any]:
    (found,) = [step for step in job["steps"] if step.get("uses", "").startswith(uses)]
    return found


def test_every_target_that_a_step_makes_is_one():
    targets = set(re.findall(r"^([\w./-]+):", (ROOT / "Makefile").read_text(), re.M))
    made = {name for one in STEPS for name in MAKE.findall(one.get("run", ""))}
    assert made >= {"lint", "test", "execute", "book", "pages", "repin"}
    assert made <= targets


def run_plan(folder: Path, python: str) -> tuple[int, dict[str, str]]:
    """Run the step that says what to execute, as the workflow's shell does.

    Return its status and what it put out.
    """
    (plan,) = [one["run"] for one in JOBS["lint"]["steps"] if one.get("id") == "plan"]
    (folder / "output").touch()
    # A make of this test's own would say where it is; the workflow's is the outermost.
    given = {name: value for name, value in os.environ.items() if name != "MAKELEVEL"}
    script = plan.replace(".venv/bin/python", python)
    done = subprocess.run(
        ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", script],
        cwd=ROOT,
        env=given | {"GITHUB_OUTPUT": str(folder / "output"), "MAKEFLAGS": f"PYTHON={python}"},
        check=False,
    )
    lines = (folder / "output").read_text().splitlines()
    return done.returncode, dict(line.split("=", 1) for line in lines)


def test_the_matrix_is_the_pages_of_the_book(tmp_path):
    status, output = run_plan(tmp_path, sys.executable)
    assert status == 0
    assert json.loads(output["pages"]) == [page.docname for page in find_pages(BOOK)]
    assert output["kernels"] == engine_cache_folder().name
    assert JOBS["lint"]["outputs"] == {n: f"${{{{ steps.plan.outputs.{n} }}}}" for n in output}
    assert JOBS["execute"]["strategy"]["matrix"] == {
        "page": "${{ fromJSON(needs.lint.outputs.pages) }}"
    }
    assert JOBS["execute"]["strategy"]["fail-fast"] == "false"


def test_a_plan_that_fails_stops_the_workflow(tmp_path):
    assert run_plan(tmp_path, "false") == (2, {})


def test_the_book_is_built_from_what_the_pages_jobs_export():
    (execute,) = [one for one in JOBS["execute"]["steps"] if "make execute" in one.get("run", "")]
    (book,) = [one for one in JOBS["book"]["steps"] if "make book" in one.get("run", "")]
    (sent, *_) = [
        one["with"] for one in JOBS["execute"]["steps"] if "upload-" in one.get("uses", "")
    ]
    taken = step(JOBS["book"], "actions/download-artifact")["with"]
    assert execute["env"] == {"PAGE": "${{ matrix.page }}", "TO": sent["path"]}
    assert sent["name"] == "executed-${{ strategy.job-index }}"
    assert taken["pattern"] == "executed-*"
    assert book["env"]["EXECUTED"] == taken["path"]
    assert "execute" in JOBS["book"]["needs"]


def test_what_is_deployed_has_passed_the_gate_of_releases():
    builds = [
        one for job in JOBS.values() for one in job["steps"] if "make book" in one.get("run", "")
    ]
    (book,) = builds
    assert book in JOBS["book"]["steps"]
    assert book["env"]["RELEASE"] == "1"
    assert "book" in JOBS["deploy"]["needs"]
    sites = [
        name
        for name, job in JOBS.items()
        for one in job["steps"]
        if "upload-pages-" in one.get("uses", "")
    ]
    assert sites == ["book"]
    assert "if" not in JOBS["book"]


def test_compiled_kernels_are_saved_when_a_page_fails_and_restored_by_the_same_name():
    for name in ("test", "execute"):
        save = step(JOBS[name], "actions/cache/save")
        assert save["if"] == "always()"
        assert save["with"]["path"] == ".cache/engine"
        restored = step(JOBS[name], "./.github/actions/setup")["with"]["kernels"]
        assert save["with"]["key"].startswith(f"{restored}-${{{{ github.run_id }}}}")


def test_a_scheduled_run_restores_nothing():
    cached = [one for one in STEPS if re.match("actions/cache(/restore)?@", one.get("uses", ""))]
    assert len(cached) == 2
    assert all("github.event_name != 'schedule'" in one["if"] for one in cached)


def test_a_job_that_can_fail_leaves_its_reports():
    for name in ("test", "execute", "book", "refresh"):
        kept = [one for one in JOBS[name]["steps"] if one.get("if") == "failure()"]
        assert [one["with"]["include-hidden-files"] for one in kept] == ["true"], name


def test_jobs_can_write_only_what_they_must():
    assert PLAN["permissions"] == {"contents": "read"}
    more = {name: job["permissions"] for name, job in JOBS.items() if "permissions" in job}
    assert more == {
        "deploy": {"pages": "write", "id-token": "write"},
        "propose": {"contents": "write", "pull-requests": "write"},
    }
    assert JOBS["deploy"]["if"].startswith("github.ref == 'refs/heads/main'")
    for name in more:  # what can write runs no code of the course, of its packages or its pages
        assert not any(MAKE.search(one.get("run", "")) for one in JOBS[name]["steps"])


def test_no_checkout_leaves_its_token_where_the_course_s_code_runs():
    kept = [
        name
        for name, job in JOBS.items()
        for one in job["steps"]
        if one.get("uses", "").startswith("actions/checkout")
        and one.get("with", {}).get("persist-credentials") != "false"
    ]
    assert kept == ["propose"]


def test_versions_are_pinned_and_input_never_becomes_shell():
    for one in STEPS:
        used = one.get("uses", "")
        assert not used.startswith("./") or (ROOT / used / "action.yml").is_file()
        assert used.startswith("./") or not used or re.search(r"[@:]v?\d[\w.]*$", used), used
        assert not INTERPOLATED.search(one.get("run", "")), one["run"]
    for job in JOBS.values():
        assert not job.get("container", "").endswith("latest")
        assert re.search(r"\b\d{2,3}\b", job["timeout-minutes"])
