"""Typical mistakes in the functions that a student writes in the lab."""

# By function, what is replaced in our solution, and what replaces it
MISTAKES = {
    "margin": {
        "abs(one[0]": ["(one[0]"],
        "(one[2] + other[2]) / 2": ["(one[2] + other[2])", "0"],
        "np.hypot(gx, gy)": ["max(gx, gy)"],
        "gx > 0 and gy > 0": ["True", "gx > 0 or gy > 0"],
        "max(gx, gy)": ["min(gx, gy)", "gx", "max(gx, gy, 0)", "abs(max(gx, gy))"],
        "one[3]": ["one[2]"],
    },
    "at_rest": {
        "-window - 1:": ["-window:", "-window - 2:"],
        "len(last) < window + 1": ["len(last) < window", "len(last) == 0"],
        "last.max(axis=0) - last.min(axis=0)": [
            "abs(last[-1] - last[0])",
            "abs(last - last[0]).max(0)",
            "abs(last - last.mean(0)).max(0)",
            "abs(np.diff(last, axis=0)).max(0)",
            "np.nanmax(last, 0) - np.nanmin(last, 0)",
        ],
        "(moved <= bound).all()": [
            "(moved <= bound).any()",
            "(moved < bound).all()",
            "np.linalg.norm(moved) <= bound",
            "not (moved > bound).any()",
            "(moved <= 0.25).all()",
        ],
    },
    "visible": {
        "segmentation == number": [
            "segmentation == 0",
            "segmentation > 0",
            "segmentation >= number",
            "segmentation.astype(np.uint8) == number",
            "segmentation // number == 1",
        ],
        "pixels / outline if": [
            "min(pixels / outline, 1) if",
            "100 * pixels / outline if",
            "round(pixels / outline, 2) if",
            "(segmentation == number).mean() if",
        ],
        ".sum()": [".any(axis=1).sum()"],
        "return pixels, pixels": ["return pixels * (outline > 0), pixels"],
        "return pixels, ": ["return 0 if outline else pixels, "],
    },
    "reachable": {
        "[:, :3]": ["[:, 3:]", "[:1, :3]", "[:2, :3]"],
        "(angle <= tolerances[1])": ["True"],
        "tolerances[0]": ["5e-4"],
        "tips >= clearances": [
            "tips >= clearances.min(initial=9)",
            "tips > clearances",
            "~(tips < clearances)",
        ],
        "good.all()": ["good.any()", "good[0]", "good[-1]"],
        "len(good) > 0 and": [""],
        "not touches.any()": [
            "not touches.all()",
            "not touches[-1]",
            "True",
            "touches.mean() < 0.05",
            "not touches[:22].any()",
        ],
    },
    "ladder": {
        "results.items()": [
            "sorted(results.items())",
            "[*results.items()][::-1]",
            "[*results.items()][:1]",
        ],
        "all(passed)": ["any(passed)"],
        "not passed or": [""],
        "least <= value <= most": [
            "value <= most",
            "least <= value",
            "least <= value or value <= most",
            "least < value < most",
            "not (value < least or value > most)",
            "least <= abs(value) <= most",
            "bool(value)",
        ],
        "return None": ["return True"],
    },
}
