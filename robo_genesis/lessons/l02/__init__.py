"""L02: scenes, entities, and the simulation life cycle."""
