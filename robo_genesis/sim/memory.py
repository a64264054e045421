"""Memory that is in use where the engine computes."""

import gc
import importlib
import os
from pathlib import Path

MIB = 2**20
"""Bytes of one MiB."""


def used_memory() -> float:
    """Return the memory in use [MiB]: of this process, on an accelerator of the whole device."""
    gc.collect()
    torch = importlib.import_module("torch")
    if importlib.import_module("genesis").device.type == "cuda":  # ROCm calls its device so as well
        free, total = torch.cuda.mem_get_info()
        return float((total - free) / MIB)
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGESIZE") / MIB
