"""`python -m movingfrf` is the command `movingfrf`."""

from movingfrf.cli import entry

entry()
