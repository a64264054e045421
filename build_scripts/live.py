"""Show the book on localhost while it is written: `make live`.

Environment: PORT (default 8000; 0: a free one), and EXECUTE=0|1 (default 0; 1: a page whose code
changed, or code that it imports, runs as with `make execute`). The page in the browser
reloads after each change. Nothing is published, and book/_build is not used. Exit
status: 1 failed, 130 ended with Ctrl-C.
"""

import asyncio
import sys

from robo_genesis.pipeline.command import choice, parser, port, run, set_contract
from robo_genesis.pipeline.html.live import Live, serve

if __name__ == "__main__":
    args = parser(__doc__).parse_args()
    set_contract()
    execute = choice("EXECUTE", "0", ("0", "1")) == "1"
    live = Live(args.book, args.cache, execute=execute, timeout=args.timeout)
    sys.exit(run(lambda: asyncio.run(serve(live, port())), "published"))
