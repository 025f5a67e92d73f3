"""What a result is called and measured in: the one place where arrays get labels."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.values import Listed
from movingfrf._basics.version import VERSION
from movingfrf._basics.wording import in_both_units
from movingfrf.results.findings import Finding, announced

if TYPE_CHECKING:
    import xarray as xr
    from xarray.indexes import PandasIndex

Values = TypeVar("Values", FloatArray, ComplexArray)


class Label(NamedTuple):
    """Dimensions, unit and long name of a variable; a coordinate has no meaning of its own."""

    dims: tuple[str, ...]
    units: str
    long_name: str
    coordinate: bool = False
    optional: bool = False


# The response of a vehicle and a guideway to a rough road.
COUPLED: dict[str, Label] = {
    "time": Label(("time",), "s", "time", coordinate=True),
    "contact": Label(("contact",), "1", "number of the contact", coordinate=True),
    "position": Label(("contact",), "m", "position of the contact, ahead positive", coordinate=True),
    "path": Label(("contact",), "1", "path of the profile that the contact follows", coordinate=True),
    "contact_name": Label(("contact",), "1", "name of the contact", coordinate=True, optional=True),
    "dof": Label(("dof",), "1", "degree of freedom", coordinate=True),
    "dof_unit": Label(("dof",), "1", "unit of the degree of freedom", coordinate=True),
    "contact_force": Label(("time", "contact"), "N", "dynamic contact force, compression positive"),
    "static_load": Label(("contact",), "N", "contact force in steady travel on the smooth road"),
    "deflection": Label(("time", "contact"), "m", "deflection of the guideway under the contact, down"),
    "static_deflection": Label(("contact",), "m", "deflection in steady travel on the smooth road, down"),
    "motion": Label(("time", "dof"), "m or rad", "motion about the steady state, down, nose down"),
    "acceleration": Label(("time", "dof"), "m/s2 or rad/s2", "acceleration, down, nose down"),
    "roughness": Label(("time", "contact"), "m", "elevation of the road under the contact, up"),
    # Points of a finite road that stand still, where they were asked for.
    "place": Label(("place",), "m", "position of a point of the road", coordinate=True, optional=True),
    "place_deflection": Label(("time", "place"), "m", "deflection of the road at that point, down", optional=True),
}

# The response of a guideway to prescribed forces.
LOADED: dict[str, Label] = {
    "time": COUPLED["time"],
    "load": Label(("load",), "m", "position of the load, ahead positive", coordinate=True),
    "point": Label(("point",), "m", "position of the observer, ahead positive", coordinate=True),
    "force": Label(("time", "load"), "N", "prescribed force, down"),
    "deflection": Label(("time", "point"), "m", "deflection of the guideway at the observer, down"),
}


def _as_solved(schema: dict[str, Label]) -> dict[str, Label]:
    """Label records in the steps in which they were solved, where those of the output do not show all of them."""
    return {
        f"solved_{name}": label._replace(
            dims=tuple("solved_time" if dim == "time" else dim for dim in label.dims),
            long_name=f"{label.long_name}, as it was solved",
            optional=True,
        )
        for name, label in schema.items()
        if label.dims[0] == "time" and not label.optional
    }


COUPLED.update(_as_solved(COUPLED))
LOADED.update(_as_solved(LOADED))

_OVER_FREQUENCY: dict[str, Label] = {
    "frequency": Label(("frequency",), "Hz", "frequency", coordinate=True),
    "omega": Label(("frequency",), "rad/s", "angular frequency", coordinate=True),
    **{name: COUPLED[name] for name in ("contact", "position", "path", "contact_name", "dof", "dof_unit")},
}

# The response per unit of roughness under one contact.
TRANSFER: dict[str, Label] = {
    **_OVER_FREQUENCY,
    "source": Label(("source",), "1", "contact under which the road is rough", coordinate=True),
    "contact_force": Label(("frequency", "contact", "source"), "N/m", "dynamic contact force, compression"),
    "deflection": Label(("frequency", "contact", "source"), "m/m", "deflection of the guideway under the contact"),
    "motion": Label(("frequency", "dof", "source"), "m/m or rad/m", "motion, down, nose down"),
    "acceleration": Label(("frequency", "dof", "source"), "1/s2 or rad/s2/m", "acceleration, down, nose down"),
}

# What a random response consists of, each quantity about the steady state: where it is told, units, words.
RANDOM_QUANTITIES = {
    "contact_force": ("contact", ("N",), "dynamic contact force"),
    "deflection": ("contact", ("m",), "dynamic deflection of the guideway under the contact"),
    "motion": ("dof", ("m", "rad"), "motion"),
    "acceleration": ("dof", ("m/s2", "rad/s2"), "acceleration"),
    "roughness": ("contact", ("m",), "elevation of the road under the contact"),
}


def _random_labels(name: str, place: str, units: tuple[str, ...], words: str) -> dict[str, Label]:
    """Spectral density and statistics of one quantity."""
    unit = " or ".join(units)
    squared = " or ".join(f"({unit})2/Hz" if "/" in unit else f"{unit}2/Hz" for unit in units)
    return {
        f"{name}_density": Label(("frequency", place), squared, f"one-sided spectral density of the {words}"),
        f"{name}_rms": Label((place,), unit, f"root mean square of the {words}"),
        f"{name}_crossing_rate": Label((place,), "1/s", f"upcrossings of zero per second of the {words}"),
        f"{name}_peak_rate": Label((place,), "1/s", f"maxima per second of the {words}"),
        f"{name}_irregularity": Label((place,), "1", f"crossing rate over peak rate of the {words}"),
        f"{name}_expected_peak": Label((place,), unit, f"expected largest value in the exposure of the {words}"),
    }


# The stationary response to a random road.
RANDOM: dict[str, Label] = {
    **_OVER_FREQUENCY,
    "bandwidth": Label(("frequency",), "Hz", "what the density at a frequency stands for", coordinate=True),
    "static_load": COUPLED["static_load"],
    "static_deflection": COUPLED["static_deflection"],
    "dynamic_load_coefficient": Label(("contact",), "1", "root mean square of the dynamic over the static force"),
    "lift_off_share": Label(("contact",), "1", "share of the time in which the total contact force is tensile"),
    "lift_off_rate": Label(("contact",), "1/s", "how often the total contact force turns tensile"),
    "weighted_acceleration": Label(("dof",), "m/s2 or rad/s2", "frequency-weighted root mean square acceleration"),
}
for _name, (_place, _units, _words) in RANDOM_QUANTITIES.items():
    RANDOM |= _random_labels(_name, _place, _units, _words)


# What a guideway answers to a unit force: displacement, velocity or acceleration.
_ALONG: dict[str, Label] = {
    "frequency": Label(("frequency",), "Hz", "frequency in the moving frame", coordinate=True),
    "omega": Label(("frequency",), "rad/s", "angular frequency in the moving frame", coordinate=True),
    "ahead": Label(("ahead",), "m", "receiver minus source, ahead positive", coordinate=True),
}


def _per_force(form: str, units: str) -> dict[str, Label]:
    """Response of a guideway per unit force."""
    words = f"{form} of the guideway, down per unit force down"
    return {**_ALONG, form: Label(("frequency", "ahead"), units, words)}


# Kind of a result, as its attribute says it → names, dimensions and units of its variables.
SCHEMAS: dict[str, dict[str, Label]] = {
    "coupled": COUPLED,
    "loaded": LOADED,
    "transfer": TRANSFER,
    "random": RANDOM,
    "receptance": _per_force("receptance", "m/N"),
    "mobility": _per_force("mobility", "m/s/N"),
    "accelerance": _per_force("accelerance", "m/s2/N"),
}

# Kinds that are histories.
HISTORIES = ("coupled", "loaded")


def attributes(
    kind: str, title: str, *, findings: Iterable[Finding] = (), **settings: str | float
) -> dict[str, str | float | int]:
    """Say what a result is, which version made it and how; and warn of what is to be known about it.

    Parameters
    ----------
    kind : str
        Key of `SCHEMAS`.
    title : str
        What the result is, in words.
    findings : iterable of Finding
        What a user should know.
    **settings : str, int or float
        How it was made: text or numbers only, nothing else survives netCDF.

    Returns
    -------
    dict
        Attributes of the Dataset.

    Warns
    -----
    ValidityWarning
        Of every finding.
    """
    plain_settings = {
        # A truth value is a number: netCDF knows no other.
        name: value if isinstance(value, str) else int(value) if isinstance(value, int) else float(value)
        for name, value in settings.items()
    }
    return {
        "title": title,
        "kind": kind,
        "movingfrf": VERSION,
        **plain_settings,
        "findings": announced(findings),
    }


def kind_of(result: object) -> str | None:
    """Say what kind of result something is; None if it is none.

    Parameters
    ----------
    result : xarray.Dataset or anything
        What was given as a result.

    Returns
    -------
    str or None
        Key of `SCHEMAS`. Results of version 0.1 do not say it themselves; their variables do.
    """
    said = getattr(result, "attrs", {}).get("kind")
    if said is not None:
        return str(said) if said in SCHEMAS else None
    variables = getattr(result, "variables", {})
    marks = {"random": "contact_force_density", "transfer": "source", "coupled": "contact_force", "loaded": "force"}
    return next((kind for kind, mark in marks.items() if mark in variables), None)


def turned(values: Values) -> Values:
    """Turn an array of the core, (*case, port, frequency or time), into one of a result, which leads with these.

    Examples
    --------
    >>> turned(np.zeros((3, 2, 100))).shape
    (100, 2, 3)
    """
    return values.T


def labelled(values: Mapping[str, ArrayLike], attributes: Mapping[str, str | float | int]) -> xr.Dataset:
    """Make the Dataset of a result.

    Parameters
    ----------
    values : mapping of str to array_like
        Arrays by their name in the schema of the result's kind.
    attributes : mapping of str to str, float or int
        What `attributes` returned.

    Returns
    -------
    xarray.Dataset
        With units and long names on every variable, as the CF conventions want them, and where they are kept a word
        that they are. What is in metres for some degrees of freedom and in radians for others has a comment instead
        of one unit.
    """
    import xarray as xr
    from xarray.indexes import PandasIndex

    schema = SCHEMAS[str(attributes["kind"])]
    arrays = {name: np.asarray(value) for name, value in values.items()}
    variables: dict[str, xr.Variable] = {}
    indexes: dict[str, PandasIndex] = {}
    of_dofs = frozenset(map(str, arrays.get("dof_unit", ("",))))
    for name, value in arrays.items():
        label = schema[name]
        either = " or " in label.units
        units = {unit_of(label.units, dof_unit) for dof_unit in of_dofs} if either else {label.units}
        said = {"units": units.pop()} if len(units) == 1 else {"comment": f"in {label.units}, as dof_unit says"}
        # Of a coordinate nothing is missing.
        encoding = {"_FillValue": None} if label.coordinate else None
        # What is an array needs no second look.
        variable = xr.Variable(label.dims, value, {**said, "long_name": label.long_name}, encoding, fastpath=True)
        if label.dims == (name,):
            # Made here: xarray would find out that they are needed, in twice the time.
            indexes[name] = PandasIndex(value, name, coord_dtype=value.dtype)
            variable = indexes[name].create_variables({name: variable})[name]
        variables[name] = variable
    kept = {"Conventions": "CF-1.11"} if _keep_cf(arrays, indexes) else {}
    # Variables that are ready need not be merged, which takes longer: coordinates, some of which become data.
    data = [name for name in variables if not schema[name].coordinate]
    coordinates = [name for name in variables if schema[name].coordinate]
    listed = {name: variables[name] for name in (*data, *coordinates)}
    result = xr.Coordinates(listed, indexes).to_dataset().reset_coords(data)
    result.attrs = {**attributes, **kept}
    return result


class Labels:
    """Labels of results that differ by their values alone: from the second one on they are ready.

    To put them on takes a third of the time that making them does; coordinates are shared then, and read-only.

    Parameters
    ----------
    steps : tuple
        What tells the coordinates of these results from those of others.
    """

    __slots__ = ("_asked", "_ready", "steps")

    def __init__(self, steps: tuple[float, ...]) -> None:
        self.steps = steps
        self._asked = False
        self._ready: xr.Dataset | None = None

    @property
    def ready(self) -> bool:
        """Whether `on` can put them on values."""
        return self._ready is not None

    def made(self, values: Mapping[str, ArrayLike], attributes: Mapping[str, str | float | int]) -> xr.Dataset:
        """Make the Dataset of a result, as `labelled` does, of coordinates and values."""
        result = labelled(values, attributes)
        if self._asked:
            self._ready = _emptied(result)
        self._asked = True
        return result

    def on(self, values: Mapping[str, FloatArray], attributes: Mapping[str, str | float | int]) -> xr.Dataset:
        """Make the same of values alone."""
        assert self._ready is not None
        result = self._ready.copy(deep=False, data=values)
        result.attrs = {**attributes, **result.attrs}
        return result


def _emptied(result: xr.Dataset) -> xr.Dataset:
    """Keep labels and coordinates of a result."""
    for coordinate in result.coords.values():
        coordinate.values.setflags(write=False)
    gone = {str(name): np.broadcast_to(0.0, variable.shape) for name, variable in result.data_vars.items()}
    labels = result.copy(deep=False, data=gone)
    labels.attrs = {name: said for name, said in result.attrs.items() if name == "Conventions"}
    return labels


def _keep_cf(arrays: Mapping[str, NDArray[Any]], along: Iterable[str]) -> bool:
    """Whether what the CF conventions ask of numbers is so: they are real, and those along a dimension in order."""
    steps = [np.diff(arrays[name]) for name in along if arrays[name].dtype.kind in "if"]
    real = all(array.dtype.kind != "c" for array in arrays.values())
    return real and all((step > 0).all() or (step < 0).all() for step in steps)


def unit_of(units: str, dof_unit: str = "") -> str:
    """Take the unit for a degree of freedom in m or rad; what has one unit for all, has it here too.

    Examples
    --------
    >>> unit_of("m/s2 or rad/s2", "rad")
    'rad/s2'
    """
    return units.split(" or ")[-1 if dof_unit == "rad" else 0]


def resolved(result: xr.Dataset) -> xr.Dataset:
    """Take a response as it was solved, in finer steps, if the result holds that.

    Parameters
    ----------
    result : xarray.Dataset
        A response over time.

    Returns
    -------
    xarray.Dataset
        The same variables, and the step among its attributes; the result itself where it shows all of the response.
    """
    if "solved_time" not in result.dims or "time" not in result.dims:
        return result
    # Of a part of the record, the same part.
    step, time, solved = result.attrs["time_step"], result.time.values, result.solved_time.values
    if not np.allclose(np.diff(time), step, rtol=1e-6):
        return result
    inside = (solved > time[0] - 1e-6 * step) & (solved < time[-1] + (1.0 - 1e-6) * step)
    fine = result.drop_dims("time").isel(solved_time=inside)
    fine = fine.rename({name: name[7:] for name in map(str, fine.variables) if name.startswith("solved_")})
    return fine.assign_attrs(time_step=time_step_of(fine))


def flaws(result: xr.Dataset, names: Iterable[str]) -> list[str]:
    """Say which variables a result lacks, and where one is not finite.

    Parameters
    ----------
    result : xarray.Dataset
        A result, from a file as a rule.
    names : iterable of str
        Variables that it should have.

    Returns
    -------
    list of str
        Clauses such as `lacks acceleration` and `has contact_force nan at time 0.3 s, contact 1`.
    """
    there = getattr(result, "variables", {})
    lacking = [name for name in names if name not in there]
    found = [f"lacks {', '.join(lacking)}"] if lacking else []
    for name in names:
        if name in lacking or result[name].dtype.kind != "f":
            continue
        values = result[name].values
        bad = np.argwhere(~np.isfinite(values))
        if bad.size:
            where = [_where(result, str(dim), at) for dim, at in zip(result[name].dims, bad[0], strict=True)]
            found.append(f"has {name} {values[tuple(bad[0])]} at {', '.join(where)}")
    return found


def contact_names(result: xr.Dataset) -> list[str]:
    """Names of the contacts; empty where they have none."""
    named = "contact_name" in result.coords
    return [str(name) for name in result.contact_name.values] if named else [""] * result.sizes["contact"]


def _where(result: xr.Dataset, dim: str, at: int) -> str:
    """Say where along a dimension something is."""
    if dim == "contact":
        return contacts_in_words(result)[at]
    place = result[dim].values[at]
    if result[dim].dtype.kind not in "iuf":
        return f"{dim} {place}"
    return f"{dim} {place:g} {result[dim].attrs.get('units', '')}".removesuffix(" 1").rstrip()


def contacts_in_words(result: xr.Dataset) -> list[str]:
    """Call each contact of a result by its number and, where it has one, its name.

    Parameters
    ----------
    result : xarray.Dataset
        A result with contacts, whole or a part.

    Returns
    -------
    list of str
        Words such as `contact 1 (rear)`.
    """
    numbers = result["contact"].values.tolist()
    called = [f" ({name})" if name else "" for name in contact_names(result)]
    return [f"contact {number}{name}" for number, name in zip(numbers, called, strict=True)]


def speed_in_words(result: xr.Dataset) -> str:
    """Write the speed in both units."""
    # Unbreakable spaces: a number stays with its unit.
    return "{} ({})".format(*(words.replace(" ", "\u00a0") for words in speeds_of(result)))


def speeds_of(result: xr.Dataset) -> tuple[str, str]:
    """Write the speed as it was given, and in the other unit."""
    return in_both_units(result.attrs["speed"], in_kmh="speed_kmh" in result.attrs)


def duration_of(result: xr.Dataset) -> float:
    """Duration of the record [s], free of the rounding of its last time."""
    return float(f"{result.sizes['time'] * time_step_of(result):.12g}")


def time_step_of(result: xr.Dataset) -> float:
    """Step in time [s], without the rounding of a difference."""
    time = result.time.values
    return float(f"{time[1] - time[0]:.12g}")


class Measure(NamedTuple):
    """One number about a result."""

    quantity: str  # what was measured, and where
    name: str  # which measure
    value: float
    units: str
    standard: str = ""  # the standard or the source that defines it, where the name alone does not
    note: str = ""  # what the standard makes of the value, or why there is none (nan)


def listed(found: Iterable[Measure]) -> list[Measure]:
    """Make a list of measures that is shown as a table."""
    return Listed(found, ("of", "measure", "value", "unit", "by"), _cells)


def _cells(measure: Measure) -> Sequence[str]:
    units = "" if measure.units == "1" else measure.units
    return measure.quantity, measure.name, f"{measure.value:.4g}", units, measure.standard
