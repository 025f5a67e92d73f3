"""Tests, and the processes that they start, hear an interrupt even where a shell runs them in the background."""

import signal

signal.signal(signal.SIGINT, signal.default_int_handler)
