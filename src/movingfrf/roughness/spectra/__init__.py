"""Spectra of roughness, one module per family."""
