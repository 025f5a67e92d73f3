"""Roughness: spectra, profiles, and what a contact sees of them."""
