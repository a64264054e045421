"""What Torch finds on this machine, in a process that `accelerator` starts: facts as JSON lines.

Each line is written at once, so a crash or a hang leaves the facts before it. Nothing
of the course and the engine is imported.
"""

import ctypes
import json

# The name by which the engine's compiler opens the HIP runtime; its wheel names no
# folder.
RUNTIME = "libamdhip64.so"

NUMBERS, SUM = 8, 140  # The card adds the squares of so many numbers from 0; the sum


def say(**facts: object) -> None:
    """Write facts as one line."""
    print(json.dumps(facts), flush=True)


def main() -> None:
    """Write the facts."""
    import torch

    say(torch=torch.__version__, hip=torch.version.hip, cuda=torch.version.cuda)
    count = torch.cuda.device_count()
    say(count=count)
    if count:
        card = torch.cuda.get_device_properties(0)
        gfx = card.gcnArchName.partition(":")[0] if torch.version.hip else ""
        say(device=card.name, gfx=gfx)
    if torch.version.hip:
        unopened = ""
        try:
            ctypes.CDLL(RUNTIME)
        except OSError as error:
            unopened = str(error)
        say(unopened=unopened)
    if count:
        numbers = torch.arange(NUMBERS, device="cuda")
        say(kernel=int((numbers * numbers).sum()))


if __name__ == "__main__":
    main()
