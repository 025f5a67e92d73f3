"""The version of the package, at the bottom of the layers so that every one of them may state it."""

from __future__ import annotations

VERSION = "0.1.0"
