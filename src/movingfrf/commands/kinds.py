"""The command that says what the tables of a scenario can be."""

from __future__ import annotations

from movingfrf.commands.console import plain_console


def kinds(name: str | None = None, /) -> None:
    """List what the tables of a scenario can be, or the keys of a kind with units and defaults.

    Parameters
    ----------
    name
        A kind, as half_car, or a table, as vehicle; all tables and their kinds by default.
    """
    from movingfrf._basics.checks import nearest
    from movingfrf.scenarios.kinds import DRIVE, TABLES

    families = {family.name: family.kinds for family in (*TABLES.values(), DRIVE["run"])}
    console = plain_console()
    if name is None:
        for table, members in families.items():
            console.print(table, style="bold")
            console.print(f"  {', '.join(members)}", soft_wrap=True)
        console.print("\nmovingfrf kinds NAME: the keys of one of them, units and defaults", soft_wrap=True)
        return
    # Of a spectrum that is a road as well, the road: it has the keys of both.
    every = {kind: members[kind] for members in reversed(families.values()) for kind in members}
    wanted = families.get(name) or every
    if name not in families and name not in wanted:
        hint = nearest(name, [*families, *wanted])
        raise ValueError(f"there is no table and no kind {name!r}{hint}; `movingfrf kinds` lists all")
    for kind in wanted.values() if name in families else [wanted[name]]:
        console.print(kind.name, style="bold")
        console.print(f"  {kind.words}", soft_wrap=True)
        for key in kind.keys:
            default = "" if key.needed else " (optional)" if key.default is None else f" = {key.default!r}"
            console.print(f"  {key.name}{default}: {key.words}", soft_wrap=True, hanging=4)
