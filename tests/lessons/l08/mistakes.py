"""Typical mistakes in the functions that a student writes in the lab."""

# By function, what is replaced in our solution, and what replaces it
MISTAKES = {
    "grasp_pose": {
        "z + height": ["height", "z + height / 2", "z"],
        "- 0.025": ["+ 0.025", ""],
        "+ 0.1034": ["- 0.1034", ""],
        "[0, 0, 0.1]": ["0.1", "[0, 0, -0.1]", "[0, 0.1, 0]"],
        "grasp + [0, 0, 0.1], grasp": [
            "grasp, grasp + [0, 0, 0.1]",
            "grasp",
            "[0, 0, 1], grasp",
        ],
        "x, y, z = place": ["place[2] = 1; x, y, z = place"],
    },
    "ended": {
        "near & slow": [
            "near | slow",
            "near",
            "slow",
            "near & slow & (since >= 5)",
            "near & slow & np.isfinite(qd).all(axis=-1)",
        ],
        "still & (since >= 5)": [
            "still",
            "still & (since > 5)",
            "still & near & (since >= 5)",
            "(still | np.isnan(qd[..., 7:]).any(axis=-1)) & (since >= 5)",
        ],
        "np.abs(q[..., :7] - goal)": [
            "q[..., :7] - goal",
            "np.nan_to_num(q[..., :7] - goal)",
        ],
        "(np.abs(qd[..., :7]) < 0.05)": [
            "(np.abs(qd) < 0.05)",
            "~(np.abs(qd[..., :7]) >= 0.05)",
        ],
        "np.abs(qd[..., 7:])": [
            "qd[..., 7:]",
            "np.abs(qd[..., 7:].sum(-1, keepdims=True))",
        ],
        ".all(axis=-1)": [".any(axis=-1)", ".all()", ".all(axis=1)"],
        "0.002": ["0.05"],
        "np.where(of_fingers, ": ["np.where(np.logical_not(of_fingers), "],
        "<": ["<="],
    },
    "rungs": {
        "np.cumprod(passed).sum()": [
            "sum(passed)",
            "7 * all(passed)",
            "7 - sum(passed)",
        ],
        "all(axis=1)": ["any(axis=1)"],
        "(force >": ["(force >="],
        "phase[0] != of.DONE": ["phase[0] < 9", "(phase == 0).any()"],
        "both[phase == of.LIFT].any()": [
            "both.any()",
            "(force > 0.1)[phase == 3].any(0).all()",
        ],
        "phase >= of.MOVE": ["phase == of.MOVE", "phase >= 0", "phase == of.LIFT"],
        "- pos[0, 2] >=": ["- 0 >=", "- 0.035 >=", "- pos[0, 2] >"],
        "both[carry].all()": ["True"],
        "carry.any() and": ["", "True or"],
        "(of.MOVE, of.LOWER)": ["of.MOVE", "of.LOWER", "(3, 4, 5)", "(4, 5, 6)"],
        "touches[-1] == 0": ["True", "touches[phase == 8].sum() == 0", "not both[-1]"],
        "phase[-1] == of.DONE and": ["", "of.DONE in phase and"],
        "near and": ["", "near or"],
        "lowest < rim[2] - of.BELOW": ["True", "lowest < rim[2]", "lowest < 0.04"],
        "rim[:2])": ["(0.55, 0.22))", "rim[:2], np.inf)"],
        "lowest <": ["not lowest >=", "lowest <="],
        "< of.CENTRED": ["<= of.CENTRED"],
        "pos[-5:] - pos[-1]": [
            "pos[-4:] - pos[-1]",
            "pos[-6:] - pos[-1]",
            "pos[-5:] - pos[-5]",
        ],
        "np.linalg.norm(pos[-5:] - pos[-1], axis=1)": [
            "abs(pos[-5:] - pos[-1])",
            "np.linalg.norm(np.diff(pos[-5:], axis=0), axis=1)",
            "np.linalg.norm((pos[-5:] - pos[-1])[:, :2], axis=1)",
            "abs(pos[-5] - pos[-1])",
        ],
        "moved.max()": ["moved.mean()"],
    },
    "wilson": {
        "1.96**2": ["1.96", "2**2"],
        "half = 1.96 *": ["half ="],
        "np.sqrt(": ["("],
        "(4 * n)": ["4 * n", "4"],
        "more / 2": ["more", "0"],
        "/ (1 + more)": [""],
        "(-1, 1)": ["(1, -1)", "(0, 1)"],
        "n < 1 or ": [""],
        "ValueError": ["KeyError"],
        "not 0 <= k <= n": ["k > n", "k < 0", "not 0 < k <= n", "not 0 <= k < n"],
        "return tuple(": ["return sum(", "return tuple(100 * x for x in "],
    },
    "creep": {
        "hand_z - object_z": [
            "object_z - hand_z",
            "-object_z",
            "hand_z",
            "0.05 * (hand_z)",
        ],
        "t.mean()": ["0", "t[0]"],
        "(after**2).sum()": ["after.sum()", "len(t)", "(t**2).sum()"],
        "after = ": [
            "t = 0.05 * np.arange(len(t)); after = ",
            "t = np.arange(len(t)); after = ",
        ],
        "return ": [
            "return np.median(np.diff(hand_z - object_z) / np.diff(t)); ",
            "return abs",
            "s = hand_z - object_z; return (s[-1] - s[0]) / (t[-1] - t[0]); ",
        ],
    },
}
