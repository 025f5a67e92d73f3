"""Profiles in files, one module per format: what a file says, and how it is written."""
