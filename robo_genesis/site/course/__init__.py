"""The course as a whole: its map, and the size of and time for its pages."""
