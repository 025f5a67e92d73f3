"""Anything becomes numbers: histories, spectra, profiles and guideways."""
