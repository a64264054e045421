"""L09: copy the expert."""
