"""The tests of the student's functions: right solutions pass, and typical wrong ones fail."""

from functools import partial

import numpy as np
import pytest
from lessons.exercise_cells import solutions

from robo_genesis.lessons.l07 import exercises

SOLVED = solutions("l07")


def gap(
    one,
    other,
    join=lambda x, y: np.hypot(x, y) if min(x, y) > 0 else max(x, y),
    of=abs,
    n=2,
):
    """Return the margin as the task asks for it; other values make mistakes."""
    return join(
        *(of(one[k] - other[k]) - (one[k + 2] + other[k + 2]) / n for k in (0, 1))
    )


def rest(p, window, bound, spread=np.ptp, first=1, least=1, over=np.max):
    """Judge the end of a record as the task asks for it; other values make mistakes."""
    last = p[-window - first :]
    return bool(len(last) >= window + least and over(spread(last, axis=0)) <= bound)


def share(s, n, outline, count=lambda mask: mask.sum(), of=lambda x: x, mask=np.equal):
    """Return pixels and share as the task asks for it; other values make mistakes."""
    return count(mask(s, n)), of(count(mask(s, n)) / outline) if outline else 0


def reach(
    e, tips, touches, most, least, each=np.all, some=np.any, parts=((0, 3), (3, 6)), n=1
):
    """Judge answers as the task asks for it; other values make mistakes."""
    norms = [np.linalg.norm(e[:, a:b], axis=1) for a, b in parts]
    good = [norm <= limit for norm, limit in zip(norms, most, strict=False)]
    return bool(
        len(e) >= n and each(good) and each(tips >= least) and not some(touches)
    )


def ladder(
    results, order=list, good=lambda v, a, b: a <= v <= b, each=all, empty=False
):
    """Judge results as the task asks for it; other values make mistakes."""
    for rung in order(results):
        found = [good(*value) for value in results[rung].values()]
        if not each(found) or (not found and not empty):
            return rung
    return None


CASES = {
    "footprints": {
        "right": SOLVED["margin"],
        "abs forgotten": partial(gap, of=float),
        "full sizes": partial(gap, n=1),
        "0 at overlap": lambda a, b: max(0, gap(a, b)),
        "overlap > 0": lambda a, b: abs(gap(a, b)),
        "smaller gap": partial(gap, join=min),
        "larger gap": partial(gap, join=max),
        "always a distance": partial(gap, join=np.hypot),
        "x alone": partial(gap, join=lambda x, y: x),
        "of the centres": partial(gap, n=np.inf),
        "sizes exchanged": lambda a, b: gap((*a[:2], *a[:1:-1]), (*b[:2], *b[:1:-1])),
    },
    "rest": {
        "right": SOLVED["at_rest"],
        "states for steps": partial(rest, first=0, least=0),
        "a step more": partial(rest, first=2, least=2),
        "too short": partial(rest, least=-99),
        "speed": partial(
            rest, spread=lambda p, axis: np.abs(np.diff(p, axis=0)).max(0)
        ),
        "end to end": partial(rest, spread=lambda p, axis: abs(p[-1] - p[0])),
        "from the first": partial(rest, spread=lambda p, axis: abs(p - p[0]).max(0)),
        "from the mean": partial(
            rest, spread=lambda p, axis: abs(p - p.mean(0)).max(0)
        ),
        "any axis": partial(rest, over=np.min),
        "distance": partial(rest, over=np.linalg.norm),
        "below the bound": lambda p, n, b: rest(p, n, np.nextafter(b, 0)),
        "NaN passes": lambda p, n, b: (
            len(p) > n and not (np.ptp(p[-n - 1 :], axis=0) > b).any()
        ),
        "NaN left out": partial(
            rest, spread=lambda p, axis: np.nanmax(p, 0) - np.nanmin(p, 0)
        ),
        "window 4": lambda p, n, b: rest(p, 4, b),
        "one bound": lambda p, n, b: rest(p, n, 0.25),
    },
    "pixels": {
        "right": SOLVED["visible"],
        "background": lambda s, n, o: share(s, 0, o),
        "all but background": lambda s, n, o: share(s > 0, True, o),
        "from the number on": partial(share, mask=np.greater_equal),
        "clip": partial(share, of=lambda x: min(x, 1)),
        "%": partial(share, of=lambda x: 9 * x),
        "rows": partial(share, count=lambda mask: mask.any(axis=1).sum()),
        "of the picture": lambda s, n, o: (share(s, n, o)[0], (s == n).mean()),
        "no outline, no pixels": lambda s, n, o: share(s, n, o) if o else (0, 0),
        "exchanged": lambda s, n, o: share(s, n, o)[::-1],
    },
    "reach": {
        "right": SOLVED["reachable"],
        "any for all": partial(reach, each=np.any),
        "first answer": lambda e, tips, t, m, c: reach(e[:1], tips[:1], t, m, c[:1]),
        "last answer": lambda e, tips, t, m, c: reach(e[-1:], tips[-1:], t, m, c[-1:]),
        "no answers": partial(reach, n=0),
        "no rotation": partial(reach, parts=((0, 3),)),
        "swap": partial(reach, parts=((3, 6), (0, 3))),
        "all six": partial(reach, parts=((0, 6),)),
        "least clearance": lambda e, tips, t, m, c: reach(
            e, tips, t, m, c.min(initial=9)
        ),
        "above its clearance": lambda e, tips, t, m, c: reach(
            e, tips, t, m, np.nextafter(c, 9)
        ),
        "touches at the end": lambda e, tips, t, m, c: reach(e, tips, t[-1:], m, c),
        "all touch": partial(reach, some=np.all),
        "none": partial(reach, some=lambda t: False),
        "NaN height": lambda e, tips, *more: reach(
            e, np.nan_to_num(tips, nan=9), *more
        ),
        "NaN residual": lambda e, *more: reach(np.nan_to_num(e), *more),
        "typed tolerances": lambda e, tips, t, m, c: reach(e, tips, t, (5e-4, 5e-3), c),
    },
    "first_failure": {
        "right": SOLVED["ladder"],
        "order of names": partial(ladder, order=sorted),
        "backwards": partial(ladder, order=reversed),
        "any for all": partial(ladder, each=any),
        "first rung alone": partial(ladder, order=lambda results: list(results)[:1]),
        "empty rung passes": partial(ladder, empty=True),
        "no least value": partial(ladder, good=lambda v, a, b: v <= b),
        "no largest value": partial(ladder, good=lambda v, a, b: a <= v),
        "or": partial(ladder, good=lambda v, a, b: a <= v or v <= b),
        "limits fail": partial(ladder, good=lambda v, a, b: a < v < b),
        "NaN passes": partial(ladder, good=lambda v, a, b: not (v < a or v > b)),
        "absolute": partial(ladder, good=lambda v, a, b: a <= abs(v) <= b),
        "truth alone": partial(ladder, good=lambda v, a, b: bool(v)),
        "all of them": lambda r: (
            [name for name in r if ladder({name: r[name]})] or None
        ),
        "True for none": lambda r: ladder(r) or True,
    },
}


@pytest.mark.parametrize(
    ("name", "how"), [(n, how) for n, of in CASES.items() for how in of]
)
def test_only_the_right_solution_passes(name, how):
    check = getattr(exercises, name)(CASES[name][how])
    assert check.passed == (how == "right"), check.detail
