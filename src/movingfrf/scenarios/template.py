"""Scenarios to start from."""

from __future__ import annotations

from importlib.resources import files


def template(name: str) -> str:
    """Read a scenario that ships with the package.

    Parameters
    ----------
    name : str
        `scenario`, a half truck on a class A road, or `loads`, prescribed loads.

    Returns
    -------
    str
        TOML, with a comment and a unit on every line.
    """
    return files("movingfrf").joinpath("scenarios", "templates", f"{name}.toml").read_text(encoding="utf-8")
