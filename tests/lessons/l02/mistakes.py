"""Typical mistakes in the functions that a student writes in the lab."""

# By function, what is replaced in our solution, and what replaces it
MISTAKES = {
    "usable_frame": {
        "(rgb != rgb[0, 0]).any()": ["rgb[..., 0].max() > 30"],
        " or rgb.dtype != np.uint8": [""],
        "rgb.shape != (540, 720, 3) or ": [""],
    },
    "stepped": {
        "z = z + v * h": ["z = z + (v - g * h / 2) * h"],  # continuous free fall
        "[0.0]": ["[]"],
    },
}
