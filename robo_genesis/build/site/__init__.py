"""The site of a build: rendered, packed, checked, published and served."""
