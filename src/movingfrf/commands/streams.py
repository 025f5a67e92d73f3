"""Standard output and standard error of the command."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TextIO

from movingfrf._basics.output import naming


class StandardStream(io.TextIOWrapper):
    """Standard output or standard error: every letter is written as well as it can be, and what fails has a name.

    Parameters
    ----------
    stream : text file
        As Python opened it.
    name : str
        What it is called in a message.
    """

    OUTPUT = "standard output"  # its name in a message

    def __init__(self, stream: TextIO, name: str) -> None:
        super().__init__(stream.buffer, stream.encoding, "replace", line_buffering=bool(stream.line_buffering))
        self._called = Path(name)
        self._opened = stream  # which would close the file that both write to

    def write(self, text: str) -> int:
        """Write text."""
        with naming(self._called):
            return super().write(text)

    def flush(self) -> None:
        """Hand on what is still held back."""
        with naming(self._called):
            super().flush()
