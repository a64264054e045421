"""What a refusal means for somebody who recorded a bundle at home, and what to do."""

from robo_genesis.evidence.bundle import Manifest

LOCK = "Install the course's versions: pip install -r requirements.lock. Then run the page again."
OWN = "Your bundle answers your own question and is not evidence for the course's page."

EDITED = (
    "The recorded {} are not those of the recorded {}. If you edited neither file, your copy of "
    "the course {}: use one copy for both."
)

# Advice by the code of a refusal; other codes mean damage, for which the message is
# enough.
BY_CODE = {
    "older-schema": (
        "The bundle was recorded with an older state of this course. "
        "Run the page again with the present one."
    ),
    "failed": (
        "The files are sound, but a check of the run itself failed. If you changed the experiment, "
        "this can be your result; otherwise, restart the kernel and run all cells in order."
    ),
    "metrics": EDITED.format("metrics", "arrays", "computes metrics in another way"),
    "checks": EDITED.format("outcomes of the checks", "runs", "has other checks"),
    "cases": (
        "The bundle does not have exactly the page's runs. If you added or removed runs, that is "
        f"no fault. {OWN}"
    ),
}

RUN_BY_HAND = (
    "A notebook that is run by hand does not name its code cells, so nobody can tell whether they "
    "are the page's. To record them, run: make evidence LESSON={lesson} BACKEND=cpu TO=folder."
)

# Advice by what changed in a stale bundle.
BY_CHANGE = {
    "engine": f"Another version of the engine computed. {LOCK}",
    "page": f"Your code cells differ from the page's. {OWN}",
    "modules": f"Your copy of the course's modules differs from this one. {OWN}",
    "parameters": f"Your run has other settings. {OWN}",
    "seed": f"Your run started from another seed. {OWN}",
}


def advice(code: str, changes: tuple[str, ...], manifest: Manifest | None) -> list[str]:
    """Return sentences that say what a refusal means and what to do; none for a damaged bundle.

    Args:
        code: of the refusal.
        changes: for `stale`, what changed, as in `BY_CHANGE`.
        manifest: of the bundle, None if it cannot be read.
    """
    if code != "stale":
        return [BY_CODE[code]] if code in BY_CODE else []
    texts = BY_CHANGE
    if manifest is not None and manifest.source.page is None:
        texts = BY_CHANGE | {"page": RUN_BY_HAND.format(lesson=manifest.lesson)}
    return [texts[change] for change in changes]
