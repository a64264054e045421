"""`make live` on a tiny book: what the browser gets after good and bad edits."""

import os
import signal
import time
import urllib.error
import urllib.request
from contextlib import suppress
from pathlib import Path

import psutil
import pytest
from tiny_book import make_book, start

TEXT = "# Text\n\nFirst words.\n"


class Running:
    """A running `make live` on a folder's book."""

    def __init__(self, folder: Path):
        self.book, self.folder = make_book(folder, text=TEXT, other="# Other\n"), folder
        self.process = start("live.py", folder, PORT="0")
        os.set_blocking(self.process.stdout.fileno(), False)
        self.said = ""
        self.wait(lambda: "Ctrl-C ends it." in self.output())
        self.address = self.said.split("Ctrl-C")[0].split()[-1]

    def output(self) -> str:
        with suppress(BlockingIOError):
            self.said += os.read(self.process.stdout.fileno(), 2**16).decode()
        return self.said

    def wait(self, condition) -> None:
        end = time.monotonic() + 120
        while not condition():
            assert self.process.poll() is None, self.process.stderr.read()
            assert time.monotonic() < end, self.output()
            time.sleep(0.05)

    def shown(self, page: str = "text.html") -> str:
        with urllib.request.urlopen(self.address + page) as answer:
            return answer.read().decode()

    def article(self) -> str:
        return self.shown().partition("<article")[2]


@pytest.fixture(scope="module")
def live(tmp_path_factory):
    running = Running(tmp_path_factory.mktemp("live"))
    yield running
    running.process.kill()
    running.process.communicate()


def test_a_changed_page_is_shown_and_nothing_is_published(live):
    assert "live-reload" in live.shown()
    (live.book / "text.md").write_text(TEXT + "\nMore words.\n")
    live.wait(lambda: "More words." in live.shown())
    assert not (live.book / "_build").exists()


@pytest.mark.parametrize(
    ("file", "content", "said"),
    [
        ("text.md", TEXT + "\n{doc}`nowhere`\n", "nowhere"),
        ("text.md", TEXT + "\n```{nosuch}\n```\n", "nosuch"),
        ("text.md", "---\na: [\n---\n" + TEXT, "text"),
        ("text.md", None, "there is no"),
        ("_toc.yml", "root: [", "_toc.yml cannot be read"),
        ("_toc.yml", "format: jb-book\nroot: index\nchapters:\n- file: renamed\n", "renamed"),
    ],
    ids=["link", "directive", "front matter", "deleted", "broken contents", "renamed"],
)
def test_a_bad_edit_is_reported_and_the_last_good_state_stays(live, file, content, said):
    path, before = live.book / file, live.article()
    good, begin = path.read_text(), len(live.output())
    if content is None:
        path.unlink()
    else:
        path.write_text(content)
    live.wait(lambda: "keeps the last good state" in live.output()[begin:])
    reported = live.said[begin:].splitlines()
    assert said in live.said[begin:]
    assert len(reported) <= 4
    assert live.article() == before
    path.write_text(good + ("\n" if file == "_toc.yml" else "\nCorrected once more.\n"))
    live.wait(lambda: "Shown: " in live.output()[begin:])
    path.write_text(good)
    live.wait(lambda: live.output()[begin:].count("Shown: ") > 1)
    assert live.article() == before


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
def test_an_end_by_signal_leaves_no_process(tmp_path, sent):
    running = Running(tmp_path)
    below = psutil.Process(running.process.pid).children(recursive=True)
    assert below
    running.process.send_signal(sent)
    _, report = running.process.communicate(timeout=30)
    assert running.process.returncode == 130
    assert "Traceback" not in report
    assert psutil.wait_procs(below, timeout=15)[1] == []


def test_a_page_outside_of_the_site_is_not_sent(live):
    with pytest.raises(urllib.error.HTTPError, match=r"40[34]"):
        live.shown("..%2f..%2f..%2fbook/text.md")


@pytest.mark.parametrize(
    ("settings", "said"),
    [({"PORT": "none"}, "PORT='none' is not valid"), ({"EXECUTE": "yes"}, "Choices: 0, 1")],
)
def test_invalid_settings_are_refused(tmp_path, settings, said):
    process = start("live.py", make_book(tmp_path).parent, **settings)
    _, report = process.communicate(timeout=60)
    assert process.returncode == 1
    assert said in report
