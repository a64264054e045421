"""The stages of `make book`, the store of executed pages, and the sources and keys of pages."""
