"""Files of the replay: a viewer without addresses of other hosts, and models as scripts."""

import base64
import gzip
import re

import pygltflib as gltf

from robo_genesis.pipeline.html.checks import SERVICES
from robo_genesis.site.replay import directive as sphinx_replay
from robo_genesis.site.replay import viewer


def test_the_viewer_is_the_package_s_without_other_hosts():
    script = viewer.viewer().decode()
    assert SERVICES.search(script) is None
    assert "sourceMappingURL" not in script
    assert "Licensed under the Apache License" in script  # the notices are all there
    assert script.startswith("/* See NOTICE.txt. */")


def test_a_model_is_written_twice_and_weighed(tmp_path):
    weight = sphinx_replay.write_model(tmp_path / "replay", "replay-x", b"glTF\0model")
    script = (tmp_path / "replay" / "replay-x.js").read_bytes()
    assert weight == len(gzip.compress(script))
    assert (tmp_path / "replay" / "replay-x.glb").read_bytes() == b"glTF\0model"
    packed = re.search(rb'\["replay-x"\] = "(.*)";', script)
    assert packed is not None
    assert base64.b64decode(packed[1]) == b"glTF\0model"


def test_each_package_in_the_viewer_is_named_with_its_licence_beside_it(tmp_path):
    lines = list(viewer.copy_licences(tmp_path))
    assert len(lines) == len(viewer.PARTS) == len(list(tmp_path.iterdir()))
    said = {line.split()[1]: line for line in lines}
    assert " MIT, LICENSE-three.txt" in said["three"]
    assert " BSD-3-Clause, LICENSE-lit.txt" in said["lit"]
    assert "three.js authors" in (tmp_path / "LICENSE-three.txt").read_text()


def test_the_notice_says_whose_each_model_is(tmp_path):
    for name, credit in (("replay-arm", "© Somebody, Apache-2.0"), ("replay-box", None)):
        asset = gltf.Asset(version="2.0", copyright=credit)
        (tmp_path / f"{name}.glb").write_bytes(b"".join(gltf.GLTF2(asset=asset).save_to_bytes()))
    assert list(viewer.model_credits(tmp_path)) == [
        "The model replay-arm.glb, and the same in replay-arm.js: © Somebody, Apache-2.0.\n"
    ]
