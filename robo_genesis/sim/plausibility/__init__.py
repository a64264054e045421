"""What the arrays of a run must have in common, whatever metrics and checks they give."""
