"""The pages of the book: read, execute, key, store and compare them."""
