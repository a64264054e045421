"""What maintainers run to change the engine pin."""
