"""Readers of profiles, one file per format."""
