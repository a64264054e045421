"""L08: a scripted expert."""
