import pytest

from robo_genesis.pipeline.pages.guards import contradicted

FRONT = "---\nrobo_genesis: {lesson: l04, page: lecture}\n---\n"
PAGE = """# Title

KP grows: the
sag falls by 5 %. {guard}`sag` Another
sentence follows. {guard}`l04/lab order`{guard}`sag`

- one item is lower {guard}`order`
"""
WRITE = " Write again what the runs contradict: "


@pytest.mark.parametrize(
    ("page", "said"),
    [
        ("l04/lecture", f"{WRITE}a/lecture.md, line 10 (order)."),
        ("l04/lab", f"{WRITE}a/lecture.md, line 8 (order)."),
        ("l05/lab", ""),
    ],
)
def test_a_failed_check_names_the_sentences_that_it_guards_on_all_pages(
    tmp_path, page, said
):
    file = tmp_path / "a" / "lecture.md"
    file.parent.mkdir()
    file.write_text(FRONT + PAGE)
    assert (
        contradicted(tmp_path, page, "L04 CHECK: FAILED [order] x is 1, expected 2")
        == said
    )
    assert contradicted(tmp_path, page, "L04 CHECK: FAILED [other] x is 1") == ""
