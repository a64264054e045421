from robo_genesis.pipeline.pages.guards import contradicted, guarded_sentences

PAGE = """# Title

KP grows: the
sag falls by 5 %. {guard}`sag` Another
sentence follows. {guard}`l04/lab order`{guard}`sag`

- one item is lower {guard}`order`
"""


def test_a_guard_belongs_to_the_sentence_in_front_of_it():
    assert [(found.line, found.sentence, found.check) for found in guarded_sentences(PAGE)] == [
        (4, "KP grows: the sag falls by 5 %.", "sag"),
        (5, "Another sentence follows.", "l04/lab order"),
        (5, "Another sentence follows.", "sag"),
        (7, "one item is lower", "order"),
    ]


def test_a_failed_check_names_the_sentences_that_it_guards(tmp_path):
    page = tmp_path / "lecture.md"
    page.write_text(PAGE)
    assert contradicted(page, "L04 CHECK: FAILED [order] x is 1, expected 2") == (
        " Write again what the runs contradict: lecture.md, line 5, says “Another sentence "
        "follows.” (l04/lab order); lecture.md, line 7, says “one item is lower” (order)."
    )
    assert contradicted(page, "L04 CHECK: FAILED [other] x is 1") == ""
