"""L06: many worlds at once."""
