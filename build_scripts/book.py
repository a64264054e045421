"""Build the course site: `make book`.

Environment: RENDER=0|1 (default 1: the labs' camera is used), JOBS (pages at once; default one
for each core), RELEASE=0|1 (1: this script runs again in a fresh checkout of HEAD, and all required
evidence must be `verified`), SITE_URL (the address of the published site), SOLUTIONS=0|1 (default
1; 0: the site has no solutions and answers), EXECUTED (a folder with all pages as `make execute`
exports them: then none is executed here) and SECOND (a folder with a second execution of these
pages, which must agree).
Backend is always the CPU; `make evidence` records accelerators.
If nothing changed since the last build, it says so and ends, unless RELEASE=1.
Exit status: 0 published, 1 failed, 130 interrupted; unless it is 0, the old site is
    unchanged.
"""

import os
import sys

from robo_genesis.core.project import BOOK, PUBLISHED, RENDER, ROOT, SOLUTIONS
from robo_genesis.pipeline import command
from robo_genesis.pipeline.html.sphinx_process import LOG, SphinxProcess
from robo_genesis.pipeline.up_to_date import nothing_changed


def main() -> int:
    """Run the build and return its exit status, or end the process with it."""
    arguments = command.parser(__doc__)
    arguments.add_argument(
        "--to", type=command.absolute, help="book that gets a release's site"
    )
    args = arguments.parse_args()
    command.set_contract()
    release = command.choice("RELEASE", "0", ("0", "1")) == "1"
    command.choice(SOLUTIONS, "1", ("0", "1"), ": 0 leaves solutions out")
    jobs = command.positive("JOBS", os.cpu_count() or 1)
    handed = {"executed": command.path("EXECUTED"), "second": command.path("SECOND")}
    if handed["second"] and not handed["executed"]:
        sys.exit(
            "SECOND is valid only with EXECUTED, whose pages it has once more. Set both."
        )
    if release and os.environ[RENDER] == "0":
        sys.exit(
            "RENDER='0' is not valid with RELEASE=1, which needs camera frames. Unset one."
        )
    if release and args.book != BOOK:
        sys.exit(
            f"--book {args.book} is not valid with RELEASE=1, which builds the commit's book."
        )
    if release and args.to is None:
        from robo_genesis.pipeline.fresh_checkout import release as build_fresh

        options = ["--to", str(args.book), "--timeout", str(args.timeout)]
        return command.run(
            lambda: build_fresh(options, args.cache, **handed), "published"
        )
    published = args.book / PUBLISHED
    with SphinxProcess(
        args.book, args.cache / LOG
    ) as sphinx:  # it loads Sphinx from here on
        if not (release or handed["executed"]) and (
            lines := nothing_changed(ROOT, args.book, published)
        ):
            print("\n".join(lines))
            return 0
        command.collect_rarely()
        # Jupyter's packages are loaded only now, beside those of Sphinx.
        from robo_genesis.pipeline.stages import Build, run_build

        build = Build(**vars(args), **handed, jobs=jobs, release=release, sphinx=sphinx)
        status = command.run(lambda: run_build(build), "published")
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(
        status
    )  # freeing all modules and pages takes more than a tenth of a second


if __name__ == "__main__":
    sys.exit(main())
