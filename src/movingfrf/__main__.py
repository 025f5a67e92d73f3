"""`python -m movingfrf` is the command `movingfrf`."""

from __future__ import annotations

from movingfrf.commands.main import entry

entry()
