"""`make serve` sends the site's own files, and browsers do not guess their type."""

import asyncio
import http.client

import pytest

from robo_genesis.pipeline.html.serve import listen


@pytest.fixture
def site(tmp_path):
    site, outside = tmp_path / "site", tmp_path / "outside"
    for folder in (site / "sub", site / "empty", site / "linked", outside):
        folder.mkdir(parents=True)
    (site / "index.html").write_text("home")
    (site / "sub/index.html").write_text("page")
    (outside / "secret.txt").write_text("secret")
    (site / "file.txt").symlink_to(outside / "secret.txt")
    (site / "folder").symlink_to(outside)
    (site / "linked/index.html").symlink_to(outside / "secret.txt")
    return site


def ask(port: int, path: str) -> tuple[int, dict[str, str], str]:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
    connection.request("GET", path)
    answer = connection.getresponse()
    found = answer.status, dict(answer.getheaders()), answer.read().decode()
    connection.close()
    return found


@pytest.mark.parametrize(
    ("path", "body"),
    [("/", "home"), ("/sub/", "page"), ("/index.html?v=1", "home")]
    + [
        (path, None)
        for path in (
            "/file.txt",
            "/folder/secret.txt",
            "/folder/",
            "/linked/",
            "/../outside/secret.txt",
            "/%2e%2e/outside/secret.txt",
            "/empty/",
            "/gone.html",
        )
    ],
)
def test_files_of_the_site_are_sent_and_nothing_else(site, path, body):
    async def answer():
        return await asyncio.to_thread(ask, listen(0, site), path)

    status, headers, sent = asyncio.run(answer())
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert headers["Cache-Control"] == "no-store"
    assert (status == 200) == (sent == body) == (body is not None)
    assert status in (200, 403, 404)
