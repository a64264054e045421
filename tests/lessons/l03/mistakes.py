"""Typical mistakes in the functions that a student writes in the lab."""

# By function, what is replaced in our solution, and what replaces it
MISTAKES = {
    "read_contacts": {
        "with_entity=table": ["with_entity=None"],
        " if len(depths) else 0.0": [""],
        "depths.max()": ["depths[0]"],
    },
}
