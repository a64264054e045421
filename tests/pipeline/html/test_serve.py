"""`make serve` sends the site's own files, and browsers do not guess their type."""

import http.client
import threading
from collections.abc import Iterator
from functools import partial
from http.server import ThreadingHTTPServer

import pytest

from robo_genesis.pipeline.html.serve import SiteHandler


class Quiet(SiteHandler):
    def log_message(self, *given) -> None: ...


@pytest.fixture(scope="module")
def port(tmp_path_factory) -> Iterator[int]:
    tmp_path = tmp_path_factory.mktemp("served")
    html = tmp_path / "site"
    (html / "sub").mkdir(parents=True)
    (html / "empty").mkdir()
    (html / "linked").mkdir()
    (html / "index.html").write_text("home")
    (html / "sub/index.html").write_text("page")
    (html / "inside.txt").symlink_to("index.html")
    (tmp_path / "outside").mkdir()
    (tmp_path / "outside/secret.txt").write_text("secret")
    (html / "file.txt").symlink_to(tmp_path / "outside/secret.txt")
    (html / "folder").symlink_to(tmp_path / "outside")
    (html / "linked/index.html").symlink_to(tmp_path / "outside/secret.txt")
    handler = partial(Quiet, directory=str(html))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield server.server_address[1]
        server.shutdown()


def ask(port: int, path: str, method: str = "GET") -> tuple[int, str | None, bytes]:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
    connection.request(method, path)
    answer = connection.getresponse()
    found = answer.status, answer.getheader("X-Content-Type-Options"), answer.read()
    connection.close()
    return found


@pytest.mark.parametrize(
    ("path", "body"), [("/", b"home"), ("/sub/", b"page"), ("/inside.txt", b"home")]
)
def test_files_of_the_site_are_sent_with_their_type_alone(port, path, body):
    assert ask(port, path) == (200, "nosniff", body)


@pytest.mark.parametrize("method", ["GET", "HEAD"])
@pytest.mark.parametrize(
    "path",
    ["/file.txt", "/folder/secret.txt", "/folder/", "/folder", "/linked/", "/linked/index.html",
     "/../outside/secret.txt", "/%2e%2e/outside/secret.txt", "/empty/", "/gone.html"],
)  # fmt: skip
def test_nothing_else_is_sent(port, path, method):
    status, sniff, body = ask(port, path, method)
    assert (status, sniff) == (404, "nosniff")
    assert b"secret" not in body.replace(b"secret.txt", b"")
