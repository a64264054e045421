"""Typical mistakes in the functions that a student writes in the lab."""

# By function, what is replaced in our solution, and what replaces it
MISTAKES = {
    "pairs": {
        "[q[:-1], pose[:-1]]": [
            "[q[1:], pose[1:]]",
            "[q[:-1], pose[1:]]",
            "[pose[:-1], q[:-1]]",
            "[q[:-1, :7], pose[:-1]]",
        ],
        "axis=1), sent": [
            "axis=1), np.roll(sent, 1, axis=0)",
            "axis=1), sent - q[:-1]",
            "axis=1)[1:], sent[:-1]",
            "axis=1)",
        ],
    },
    "scale": {
        "of = x[learned]": ["of = x", "of = x[~learned]", "of = x[: learned.sum()]"],
        "of.mean(axis=0)": ["x.mean(axis=0)", "of.mean()", "np.median(of, axis=0)"],
        "of.std(axis=0)": [
            "of.std(axis=0, ddof=1)",
            "of.var(axis=0)",
            "of.std()",
            "np.ptp(of, axis=0)",
        ],
        "np.maximum": ["np.minimum", "np.add"],
        "axis=0), least": ["axis=0), 1e-6", "axis=0), 0"],
    },
    "command": {
        "found = output * spread + mean": [
            "found = output * mean + spread",
            "found = (output - mean) / spread",
            "found = (output + mean) * spread",
            "output *= spread; output += mean; found = output",
        ],
        "+= offset": ["+= 0", "-= offset", "= offset"],
        "[:, :7]": ["[:, :1]"],
        "found[:, 7:] <": [
            "output[:, 7:] <",
            "found[:, 7:].mean(axis=1, keepdims=True) <",
            "found[:, 7:8] <",
            "found[:, 7:] >",
        ],
        "0.02": ["0", "0.01", "0.03"],
        "0, 0.04": ["0, found[:, 7:]", "0, 0.08"],
    },
    "rate": {
        "good / of": ["good", "good / good.max()"],
        "n < 2": ["n < 1", "n < 3"],
        "ValueError": ["KeyError"],
        "stdtrit(n - 1, 0.975)": ["1.96", "stdtrit(n, 0.975)", "stdtrit(n - 1, 0.95)"],
        "ddof=1": ["ddof=0"],
        "n**0.5": ["n", "(n * of) ** 0.5", "1"],
        "- half, share.mean() + half": ["+ half, share.mean() - half"],
    },
    "aggregate": {
        "asked[known]": ["asked", "asked[~known]", "asked[: known.sum()]"],
        "answers[known]": ["answers", "answers[~known]", "answers[: known.sum()]"],
        "[x, asked[known]]": ["[asked[known], x]", "[asked[known]]", "[x, x[known]]"],
        "[y, answers[known]]": ["[answers[known], y]", "[y]"],
    },
}
