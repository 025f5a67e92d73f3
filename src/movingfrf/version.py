"""The version of the package, at the bottom of the layers so that every one of them may state it."""

VERSION = "0.1.0"
