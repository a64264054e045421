"""What kernels cost: which cells belong to which set, and when kept figures are told stale."""

import json
from pathlib import Path

import pytest

from robo_genesis import kernel_costs, project, sphinx_costs
from robo_genesis.kept import KeptError
from robo_genesis.kernel_costs import Cost, Costs, CostsError, Measuring
from robo_genesis.pages import find_pages
from tests.tiny_book import LAB_FRONT, WRITE_BUNDLE, cell, make_book, notebook

SLOW_ONCE = """import os, pathlib, time
flag = pathlib.Path(os.environ["QD_OFFLINE_CACHE_FILE_PATH"], "compiled")
time.sleep(0 if flag.exists() else 2)
flag.touch()"""


def page_text(option="kernels", last="second = 4"):
    """Return a page with one cell before any mark, two of one set and one of another."""
    return notebook(
        cell(WRITE_BUNDLE),
        cell(SLOW_ONCE, f':{option}: "first, of two cells"\n'),
        cell("more = 3"),
        cell(last, f":{option}: second\n"),
        front=LAB_FRONT,
    )


def only_page(book):
    [page] = find_pages(book)
    return page


@pytest.fixture
def book(tmp_path):
    return make_book(tmp_path, page=page_text())


def costs(page, **changes):
    record = {
        "engine": project.engine_pin(),
        "lock": project.lock_digest(),
        "code": kernel_costs.marked_code(page),
        "date": "2026-01-02",
        "cores": 2,
        "sets": (Cost(cold=40.0, warm=4.0), Cost(cold=2.0, warm=2.0)),
    }
    return Costs(**record | changes)


def test_cells_count_for_the_mark_above_them(book):
    page = only_page(book)
    assert kernel_costs.set_names(page) == ["first, of two cells", "second"]
    assert kernel_costs.spans(page, [8.0, 1.0, 2.0, 4.0]) == [3.0, 4.0]


def test_a_page_that_lost_a_cells_time_is_refused(book):
    with pytest.raises(ValueError, match=r"shorter|longer"):
        kernel_costs.spans(only_page(book), [8.0, 1.0, 2.0])


def test_a_measurement_is_cold_first_and_then_warm(book):
    said = []
    how = Measuring(book=book, say=said.append)
    [file] = kernel_costs.measure(find_pages(book), how)
    found = kernel_costs.read_costs(book, only_page(book))
    assert [line.split()[0] for line in said if "started" in line] == ["cold", "warm"]
    assert found.sets[0].cold >= 2 > found.sets[0].warm
    assert kernel_costs.stale(found, only_page(book)) is None
    assert list(file.parent.iterdir()) == [file]


CHANCE = """
import numpy
(folder / "arrays").mkdir()
numpy.savez(folder / "arrays" / "G1.npz", q={value})"""


@pytest.mark.parametrize("value", ["os.getpid()", "1"])
def test_what_is_measured_must_not_depend_on_what_was_compiled(tmp_path, value):
    text = notebook(
        cell(WRITE_BUNDLE + CHANCE.format(value=value), ':kernels: "one"\n'), front=LAB_FRONT
    )
    book = make_book(tmp_path, page=text)
    how = Measuring(book=book, say=lambda line: None)
    if value == "1":
        assert kernel_costs.measure(find_pages(book), how)
    else:
        with pytest.raises(CostsError, match=r"a cold and a warm run: l04/lab/cpu/arrays/G1\.npz"):
            kernel_costs.measure(find_pages(book), how)


def test_a_failing_page_leaves_the_old_figures(book):
    page = only_page(book)
    kept = kernel_costs.record_file(book, page)
    kept.parent.mkdir()
    kept.write_text(json.dumps(costs(page).model_dump()))
    (book / "page.md").write_text(page_text(last="second = 4 / 0"))
    with pytest.raises(CostsError, match="ZeroDivisionError"):
        kernel_costs.measure(find_pages(book), Measuring(book=book, say=lambda line: None))
    assert kernel_costs.read_costs(book, page) == costs(page)


def test_a_book_without_marks_has_nothing_to_measure(tmp_path):
    book = make_book(tmp_path, page=page_text(option="other"))
    with pytest.raises(CostsError, match="option `kernels: why`"):
        kernel_costs.measure(find_pages(book), Measuring(book=book))


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"engine": "0.0.1"}, "measured with Genesis 0.0.1, pinned is"),
        ({"lock": "0" * 64}, "the lock of all packages has changed"),
        ({"code": "0" * 64}, "the cells that build the scenes have changed"),
    ],
)
def test_old_figures_are_shown_as_stale(book, change, reason):
    page = only_page(book)
    text = sphinx_costs.costs_text(page, costs(page, **change))
    for words in ("**Stale**", reason, "`make costs`"):
        assert words in text
    assert "| 40.0" in text


def test_current_figures_say_where_they_are_from(book):
    page = only_page(book)
    text = sphinx_costs.costs_text(page, costs(page))
    assert "| first, of two cells | 40.0 | 4.0 | 10.0 |" in text
    assert f"2026-01-02 with Genesis {project.engine_pin()} on a machine of 2 cores" in text
    assert "Stale" not in text


def test_missing_figures_are_named_with_their_command(book):
    text = sphinx_costs.costs_text(only_page(book), None)
    assert text.count("not measured") == 2
    assert "make costs" in text


def test_a_file_that_is_no_record_is_refused_by_name(book):
    page = only_page(book)
    kept = kernel_costs.record_file(book, page)
    kept.parent.mkdir()
    kept.write_text('{"engine": 3}')
    with pytest.raises(KeptError, match="is no record of costs"):
        kernel_costs.read_costs(book, page)


def test_the_marked_pages_of_the_course_are_found():
    page = sphinx_costs.marked_page(project.BOOK, "l04/lecture")
    assert len(kernel_costs.set_names(page)) > 4
    with pytest.raises(LookupError, match="Pages that do: l02/lecture, l03/lecture, l04/lecture"):
        sphinx_costs.marked_page(Path(project.BOOK), "l04/lab")
