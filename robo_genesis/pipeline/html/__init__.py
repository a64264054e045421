"""The built HTML: render, check, pack, publish and serve it."""
