"""How a computation says how far it has got."""

from __future__ import annotations

from collections.abc import Callable

# Called with the name of a stage and the fraction of it that is done.
Progress = Callable[[str, float], None]


def silent(stage: str, fraction: float) -> None:
    """Report no progress."""


def under(heading: str, progress: Progress) -> Progress:
    """Report stages under a heading.

    Parameters
    ----------
    heading : str
        What stands before the name of each stage.
    progress : callable
        What is reported to.

    Returns
    -------
    callable
        To be handed to whoever computes: it calls no one but `progress`.

    Examples
    --------
    >>> under("refined twice", lambda stage, fraction: print(f"{stage}: {fraction:.0%}"))("stepping", 0.5)
    refined twice, stepping: 50%
    """

    def told(stage: str, fraction: float) -> None:
        progress(f"{heading}, {stage}", fraction)

    return told
