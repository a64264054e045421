"""What every written page shares: how it is read, kept, corrected and styled."""
