"""Typical mistakes in the functions that a student writes in the lab."""

# By function, what is replaced in our solution, and what replaces it
MISTAKES = {
    "height_after": {
        "(n + 1)": ["n", "(n - 1)"],
        "z0 - g": ["0.5 - 9.81"],
        "return z0 - g * h**2 * n * (n + 1) / 2": [
            "return max(z0 - g * h**2 * n * (n + 1) / 2, 0)"
        ],
    },
}
