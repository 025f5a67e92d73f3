"""The command that writes the schema of scenarios."""

from __future__ import annotations

from pathlib import Path

from movingfrf.commands.console import hand_out, plain_console


def schema(file: Path | None = None, /) -> None:
    """Write the JSON Schema of scenarios, by which editors complete keys, show units and mark mistakes.

    A scenario that begins with the line `#:schema ./movingfrf.schema.json`, as those of `movingfrf new` do, is
    completed and checked by editors that know TOML, once the schema lies beside it.

    Parameters
    ----------
    file
        The file to write, movingfrf.schema.json for the line above; without it the schema goes to standard output.
    """
    from movingfrf._basics.output import write_whole
    from movingfrf.scenarios.schema import TITLE, schema_as_json

    text = schema_as_json()
    if file is None:
        hand_out(text)
        return
    if file.is_file() and TITLE not in file.read_text(encoding="utf-8", errors="replace"):
        raise ValueError(f"{file} exists and is no schema of scenarios; choose another name")
    write_whole(file, text)
    plain_console().print(f"wrote {file}", soft_wrap=True)
