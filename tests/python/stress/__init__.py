"""Stress: what `make stress` runs, each file a set of checks."""
