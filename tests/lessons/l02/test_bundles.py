"""Bundles of dropped boxes, which have no joints: accepted, compared, tabulated, refused."""

import pytest
from lessons.lesson_bundles import refused
from spoilers import coords, remove

from robo_genesis.core.trace import BodyTrace, Trace
from robo_genesis.evidence import bundle
from robo_genesis.evidence.bundle import BundleRefused
from robo_genesis.evidence.compare import compare
from robo_genesis.evidence.trace_files import read_run
from robo_genesis.lessons.l02 import spec


def test_the_arrays_have_no_joints_and_compare_with_themselves(sound):
    arrays = bundle.read_arrays(sound["lecture"])
    assert (arrays.joints, arrays.coords) == ([], {"link": [spec.LINK]})
    assert arrays.cases["baseline"].variables["link_vel_m_s"].unit == "m/s"
    assert compare(sound["lecture"], sound["lecture"]).state == "equal"


def test_runs_of_bodies_and_of_joints_are_not_exchanged(sound, folder):
    dropped = sound["lecture"]
    for run in ((dropped, "baseline", Trace), (folder, "G1", BodyTrace)):
        with pytest.raises(BundleRefused, match="bad-array"):
            read_run(*run)


SPOILED = {
    "one more link": ("labels", coords(link=[spec.LINK, "lid"])),
    "no picture of the trays": ("frames", remove("frames/trays.png")),
}


@pytest.mark.parametrize("name", SPOILED)
def test_a_spoiled_one_is_refused_by_its_code(copy, name):
    (code, spoil), dropped = SPOILED[name], copy("lecture")
    spoil(dropped)
    assert refused(dropped).startswith(code), name
