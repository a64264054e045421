"""What the engine reports in a sound run of L02's lecture, beside its runs."""

from robo_genesis.lessons.l02 import trials

COUNTS = {"box": (12, 12, 1), "duck": (3534, 500, 1), "tray": (260, 344, 5), "hammer": (24, 24, 2)}

TRIALS = {
    trials.SHAPES: {
        f"{name}_{what}": n
        for name, values in COUNTS.items()
        for what, n in zip(trials.COUNTED, values, strict=True)
    },
    trials.TRAYS: {trials.PIECES: 0.0308, trials.HULL: 0.1749},
    trials.FURTHER: trials.expected_falls(),
}
