"""What authors write in pages: terms, questions, formulas, excerpts."""
