"""The command that all others hang on, and what its exit statuses mean."""

from __future__ import annotations

from enum import IntEnum

from cyclopts import App, Parameter

from movingfrf._basics.version import VERSION


class Status(IntEnum):
    """Exit statuses. Python itself ends with that of a defect where an error was not foreseen."""

    DONE = 0
    DEFECT = 1
    REFUSED = 2  # a file, a value, a case without an answer
    INTERRUPTED = 130  # 128 + SIGINT, as a shell says it
    TERMINATED = 143  # 128 + SIGTERM


app = App(
    name="movingfrf",
    suppress_keyboard_interrupt=False,
    # A list is given by its items; `--empty-contact` for none of them is of no use.
    default_parameter=Parameter(negative_iterable=()),
    version=VERSION,
    help="""How vehicles and roads shake each other, computed in the frequency domain.

    A scenario file says which vehicle drives over which road, and how rough it is:

    1. movingfrf new truck.toml writes one to start from, with a comment and a unit on every line
    (--loads: prescribed forces instead of a vehicle).

    2. movingfrf check truck.toml says what it describes: natural frequencies, critical speed, roughness class.
    movingfrf vehicles lists vehicles to take from the catalogue, or describes one.

    3. movingfrf run truck.toml --output out/truck solves it and writes result.nc (netCDF: xarray, MATLAB, ...),
    summary.json and report.html; --method cdfm steps it through time, which a finite road (a bridge) needs.

    4. movingfrf compare truck.toml --output out/compared solves it by other methods too, stepping in time among
    them, and says how long each takes and how far it is from the converged answer.

    5. movingfrf random truck.toml --output out/random computes the response to all roads with its spectrum, without
    realising one; movingfrf measure out/truck/result.nc gives comfort, load on the road and fatigue of a result,
    movingfrf export out/truck/result.nc truck.csv a table (.mat for MATLAB, .uff for modal analysis).

    6. movingfrf sweep truck.toml --over run.speed=10,20,30 --output out/speeds solves many cases, and writes a line
    of measures for each.

    7. movingfrf paper --output out/paper reproduces the paper on the moving FRF, figure by figure.

    8. movingfrf profile road.csv describes a measured profile: class, waviness, IRI, what looks odd. movingfrf
    convert road.csv road.nc turns one format into another.

    Exit status: 0 done, 2 refused (a file, a value, a case without an answer), 130 interrupted, 1 a defect.""",
)
