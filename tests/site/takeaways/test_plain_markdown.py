import pytest

from robo_genesis.site.takeaways.plain_markdown import Writer, plain


@pytest.fixture
def writer(tmp_path):
    return Writer(tmp_path, lambda name: f"<{name}>")


@pytest.mark.parametrize(
    ("myst", "markdown"),
    [
        ("Plain *text* with $x_1$.", "Plain *text* with $x_1$."),
        ("(anchor)=\n## Title", "## Title"),
        ("% a comment\n\nText.", "Text."),
        (
            "[page](lecture.md), [Genesis](https://x.org/a)",
            "page, [Genesis](https://x.org/a)",
        ),
        (
            "It went to {measured}`l04/lab G2.overshoot`.",
            "It went to <l04/lab G2.overshoot>.",
        ),
        (
            "{term}`DOF`, {ref}`this part <there>`, {numref}`fig-a`",
            "DOF, this part, the figure",
        ),
        ("{engine-source}`engine/scene.py`", "`genesis/engine/scene.py`"),
        ("```{lesson-status} l04\n```\n\nText.", "Text."),
        ("| a | b |\n| - | - |\n| {term}`x` | 1 |", "| a | b |\n| - | - |\n| x | 1 |"),
        ("```python\n{measured}`kept`\n```", "```python\n{measured}`kept`\n```"),
        ("```{code-block} python\nx = 1\n```", "```python\nx = 1\n```"),
        ("```{math}\n:label: law\nx = 1\n```", "$$\nx = 1\n$$"),
        ("$$\n[a](b) = 1\n$$", "$$\n[a](b) = 1\n$$"),
        ("```{choice} l04/lab rise_time G1 G2\nWhen?\n```", "**Question.** When?"),
        (
            "```{number} l04/lab G1.overshoot\n:tolerance: 9\nHow\nmuch?\n\n- low: Aha.\n```",
            "**Question.** How\nmuch?",
        ),
        (
            ":::{admonition} First\n:class: tip\nDo *it*.\n:::",
            "> **First**\n> \n> Do *it*.",
        ),
        (
            "It holds. {guard}`l04/lab law`\nNext {guard}`law` one.",
            "It holds.\nNext one.",
        ),
        (":::{note}\nMind.\n:::", "> **Note**\n> \n> Mind."),
        (":::{dropdown} A hint\ninside\n:::", "> **A hint**\n> \n> inside"),
        ("- item\n\n  ```{term-list}\n  gone\n  ```\n- next", "- item\n\n- next"),
    ],
)
def test_prose_becomes_plain(writer, myst, markdown):
    assert plain(myst, writer) == markdown


@pytest.mark.parametrize(
    "fold",
    [
        ":::{dropdown} Why?\n:class-container: solution\nSECRET\n:::",
        "```{dropdown} Why?\n---\nclass-container: wide solution\n---\nSECRET\n```",
        ":::{admonition} Why?\n:class: solution\nSECRET\n:::",
        ":::{solution} exercise-1\nSECRET\n:::",
        "::::{note}\nMind.\n\n:::{dropdown} A\n:class-container: solution\nSECRET\n:::\n::::",
        ":::{tab-set}\nSECRET\n:::",
    ],
)
def test_no_solution_travels(writer, fold):
    written = plain(f"Before.\n\n{fold}\n\nAfter.", writer)
    assert "SECRET" not in written
    assert (written[:7], written[-6:]) == ("Before.", "After.")


def test_an_excerpt_is_cut_as_on_the_site(writer, tmp_path):
    (tmp_path / "code.py").write_text("a = 1\n\n\ndef f():\n    return 2\n\n\nb = 3\n")
    text = "```{literalinclude} code.py\n:language: python\n:pyobject: f\n```"
    assert plain(text, writer) == "```python\ndef f():\n    return 2\n```"


def test_links_lead_to_a_site_whose_address_is_known(tmp_path):
    writer = Writer(tmp_path, str, "https://x.org/a/lessons/l01/lab.html")
    text = "[lecture](lecture.md#act), [words](../../glossary.md), ![](a.svg), [x](https://x.org)"
    assert plain(text, writer) == (
        "[lecture](https://x.org/a/lessons/l01/lecture.html#act), "
        "[words](https://x.org/a/glossary.html), , [x](https://x.org)"
    )
