"""Vehicles, and the functions that fill them."""
