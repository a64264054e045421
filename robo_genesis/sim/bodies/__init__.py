"""Free rigid bodies: falls, contacts, and the laws of their runs."""
