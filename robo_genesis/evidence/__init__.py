"""Evidence bundles: their form (`bundle`), written by `record` and read by `verify`."""
