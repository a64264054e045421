"""Drawings and marks of cases, and the explorer of recorded results."""
