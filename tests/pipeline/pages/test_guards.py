from functools import partial

import pytest

from robo_genesis.pipeline.pages.guards import contradicted

PAGE = """---
robo_genesis: {lesson: l04, page: lecture}
---
# Title

KP grows: the
sag falls by 5 %. {guard}`sag` Another
sentence follows. {guard}`l04/lab order`{guard}`sag`

- one item is lower {guard}`order`
"""
WRITE = " Write again what the runs contradict: "


@pytest.mark.parametrize(
    ("page", "own", "said"),
    [
        ("l04/lecture", "lecture.md", f"{WRITE}a/lecture.md, line 10 (order)."),
        ("l04/lab", "lab.md", f"{WRITE}a/lecture.md, line 8 (order)."),
        ("l05/lab", "lab.md", ""),
    ],
)
def test_a_failed_check_names_the_sentences_that_it_guards_on_all_pages(
    tmp_path, page, own, said
):
    file = tmp_path / "a" / "lecture.md"
    file.parent.mkdir()
    file.write_text(PAGE)
    failed = partial(contradicted, tmp_path, file.with_name(own), page)
    assert failed("L04 CHECK: FAILED [order] x is 1, expected 2") == said
    assert failed("L04 CHECK: FAILED [other] x is 1") == ""
