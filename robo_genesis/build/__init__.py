"""The stages of `make book`, and what executes, checks and publishes pages."""
