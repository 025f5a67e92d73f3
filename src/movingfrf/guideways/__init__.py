"""Guideways: what carries the contact."""
