"""What maintainers run to change the engine pin, write the lock and add a lesson."""
