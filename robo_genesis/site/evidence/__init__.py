"""Measured values, provenance and the ledger on the pages."""
