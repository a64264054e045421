"""Show the book on localhost while it is written: `make live`.

Environment: PORT (default 8000; 0: a free one), and EXECUTE=0|1 (default 0; 1: a page whose code
changed, or code that it imports, runs as with `make execute`). The page in the browser reloads
after each change. Nothing is published, and book/_build is not used. Exit status: 1 failed, 130
ended with Ctrl-C.
"""

import asyncio
import signal
import sys

from robo_genesis.core.project import ProjectError
from robo_genesis.pipeline.command import choice, parser, port, set_contract
from robo_genesis.pipeline.html.live import Live
from robo_genesis.pipeline.html.live_server import serve


async def until_signal(live: Live, wanted: int) -> None:
    """Serve until Ctrl-C or SIGTERM."""
    serving = asyncio.ensure_future(
        serve(live, wanted, lambda at: live.say(f"http://localhost:{at}/ Ctrl-C ends it."))
    )
    for sent in (signal.SIGINT, signal.SIGTERM):
        asyncio.get_running_loop().add_signal_handler(sent, serving.cancel)
    await serving


def main() -> int | str:
    """Serve; return the exit status, or a message if that is impossible."""
    args = parser(__doc__).parse_args()
    set_contract()
    execute = choice("EXECUTE", "0", ("0", "1")) == "1"
    live = Live(args.book, args.cache, execute=execute, timeout=args.timeout)
    try:
        asyncio.run(until_signal(live, port()))
    except asyncio.CancelledError:
        return 130
    except ProjectError as error:
        return str(error)
    return 0


if __name__ == "__main__":
    sys.exit(main())
