"""What an argument must be, and what to do where something else was given in its place."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import PurePath
from typing import Any, NamedTuple


class Wanted(NamedTuple):
    """What an argument must be, and by what was given instead, what to do.

    What was given is named by its class or one that it is based on; by its kind if it is a result; by `.name` if it
    has such an attribute; by `[Class]` if it is a list of these; by `text` if it is one, or the name of a file.
    """

    words: str
    instead: Mapping[str, str]


@cache
def wanted_kinds() -> Mapping[str, Wanted]:
    """Everything that may be wanted, by what it is called here."""
    order = "the order is guideway, vehicle, and then profile or spectrum"
    endless = {
        "EulerBernoulliBeam": "`track(beam, foundation)` puts a beam on a foundation",
        "TimoshenkoBeam": "`track(beam, foundation)` puts a beam on a foundation",
        "Vehicle": order,
        "Profile": order,
        ".variance_below": order,
        "Scenario": "`scenario.guideway` is that of a scenario",
        "text": "`read_scenario(file).guideway` is that of a scenario; `read_sampled_guideway` reads a record",
    }
    result = {
        "DataArray": "it is one variable of a result, and the whole Dataset is wanted",
        "Axes": "the order is result, axes",
        "Scenario": "`scenario.run()` computes its result",
        "Profile": "`simulate` computes the response to a profile",
        "Vehicle": "`simulate` computes the response of a vehicle",
        "text": '`xarray.load_dataset(file, engine="h5netcdf")` reads a result',
        "[Dataset]": "take one result after the other",
        ".shape": "the Dataset that `simulate` returned is wanted, not its numbers alone",
    }
    per_force = dict.fromkeys(
        ("receptance", "mobility", "accelerance"), "`plots.moving_frf` draws what a guideway answers to a force"
    )
    return {
        "guideway": Wanted(
            "have a moving FRF, as a track has",
            {
                "FiniteGuideway": "a finite road is for cdfm, sim and newmark_loads, or struck with "
                "moving_impulse_response",
                "Axes": "the order is guideway, axes",
                **endless,
            },
        ),
        "track": Wanted("be a track, whose waves are known", endless),
        "finite road": Wanted(
            "be a FiniteGuideway, which finite_track cuts out of a track",
            {**endless, "Track": "`finite_track(track, first=…, last=…)` does"},
        ),
        "record": Wanted(
            "be a SampledGuideway, which struck_track makes of a track",
            {**endless, "Track": "`struck_track(track, speed=…, offsets=…)` does"},
        ),
        "vehicle": Wanted(
            "be a Vehicle",
            {
                "Profile": order,
                ".variance_below": order,
                ".moving_frf": order,
                "FiniteGuideway": order,
                "Scenario": "`scenario.case.vehicle` is that of a scenario",
                "text": "`catalogue(name)` takes one from the catalogue, `read_vehicle(file)` reads one",
                "[Vehicle]": "`convoy(vehicles, spacing=…)` makes one of several",
                "dict": "`half_car(**table)` and its like make one of the keys of a table",
            },
        ),
        "profile": Wanted(
            "be a Profile",
            {
                "ReadProfile": "its `.profile` is one",
                "Road": "its `.profile` is one",
                ".variance_below": "`realise(spectrum, length)` makes one of a spectrum; `random_response` takes "
                "the spectrum itself",
                "Vehicle": order,
                ".moving_frf": order,
                "FiniteGuideway": order,
                "Scenario": "`scenario.case.road.profile` is that of a scenario",
                "text": "`read_profile(file).profile` reads one",
                "Dataset": "a result does not hold its profile: the one that it was computed from is wanted",
                "[Profile]": "`side_by_side(*profiles)` puts several beside each other, a path each, and "
                "`superposed(*profiles)` adds them up",
                "DataArray": "`Profile(distance, elevation)` makes one of stations and elevations",
                ".shape": "`Profile(distance, elevation)` makes one of stations and elevations",
                "list": "`Profile(distance, elevation)` makes one of stations and elevations",
                "tuple": "`Profile(distance, elevation)` makes one of stations and elevations",
                "float": "`harmonic(amplitude=0.0, …)` makes a level one",
                "int": "`harmonic(amplitude=0.0, …)` makes a level one",
                "NoneType": "`harmonic(amplitude=0.0, …)` makes a level one",
            },
        ),
        "spectrum": Wanted(
            "be a roughness spectrum, as IsoRoad is",
            {
                "Profile": "`simulate` takes a profile; `describe_profile` fits a spectrum to one",
                "Vehicle": order,
                ".moving_frf": order,
                "ReadProfile": "`simulate` takes its `.profile`",
                "text": "`IsoRoad.of_class(letter)` makes one of a class",
                "float": "`IsoRoad(roughness)` makes one of a density at 0.1 cycle/m [m³]",
                ".shape": "`TabulatedSpectrum(spatial_frequency, spectral_density)` makes one of numbers",
                "Scenario": "`scenario.case.road.spectrum` is that of a scenario, where it has one",
            },
        ),
        "scenario": Wanted(
            "be a Scenario",
            {
                "text": "`read_scenario(file)` reads one",
                "dict": "`read_scenario(file)` reads one",
                ".moving_frf": "`read_scenario(file)` reads one",
                "Vehicle": "`read_scenario(file)` reads one",
                "Drive": "the scenario that it is the case of is wanted",
                "Dataset": "`read_scenario(file)` reads one; a result is what `scenario.run()` returns",
            },
        ),
        "result": Wanted(
            "be a result of movingfrf over time or frequency",
            {**result, "Dataset": "`simulate`, `random_response` and their like return such"},
        ),
        "coupled result": Wanted(
            "be the coupled response of a vehicle, with contact_force, static_load and acceleration",
            {
                **result,
                "random": "`random_measures` measures it",
                "loaded": "`measures` measures it",
                **per_force,
                "Dataset": "`simulate`, `cdfm`, `sim` and `duhamel` return such",
            },
        ),
        "drawn result": Wanted(
            "be a result that can be drawn so",
            {
                **result,
                "coupled": "`contact_forces`, `deflections`, `accelerations` and `roughness` draw it",
                "loaded": "`prescribed_forces` and `deflections` draw it",
                "random": "`contact_force_spectra`, `deflection_spectra`, `acceleration_spectrum` and "
                "`roughness_spectrum` draw it",
                "transfer": "`abs(result.contact_force[:, 0, 0]).plot()` is xarray's way",
                **per_force,
                "Dataset": "`simulate`, `moving_loads` and `random_response` return such",
                ".moving_frf": "`moving_frf` draws the moving FRFs of a guideway",
            },
        ),
        "axes": Wanted(
            "be Axes of matplotlib",
            {
                "Dataset": "the order is result, axes",
                ".moving_frf": "the order is guideway, axes",
                ".subplots": "`Figure().subplots()` makes one",
                ".shape": "take one of them, as axes[0]",
                "[Axes]": "take one of them, as axes[0]",
                "NoneType": "`matplotlib.figure.Figure().subplots()` makes one",
            },
        ),
        "random result": Wanted(
            "be the response to a random road, from `random_response`",
            {**result, "Scenario": "`random_response` takes its guideway, vehicle and spectrum"},
        ),
        "file": Wanted(
            "be the name of a file",
            {
                "dict": "the tables of a scenario or a vehicle are read from a TOML file",
                "Dataset": "the result comes first, then the file",
                "Profile": "the profile comes first, then the file",
                "Vehicle": "the vehicle comes first, then the file",
                "SampledGuideway": "the guideway comes first, then the file",
                "[str]": "one file after the other",
            },
        ),
        "numbers": Wanted(
            "be an array of numbers",
            {
                "Dataset": "take a variable of it, such as result.contact_force or result.acceleration",
                "Profile": "take its `.stations` or `.columns`",
                "text": "numbers are wanted, not text",
            },
        ),
        "load coefficient": Wanted(
            "be dynamic load coefficients, numbers of at least zero",
            {
                "Dataset": "`dynamic_load_coefficient(result)` makes them of a result",
                "DataArray": "`dynamic_load_coefficient(result)` makes them of a result",
                ".shape": "`dynamic_load_coefficient(result)` makes them of a result, not of its forces",
            },
        ),
    }


def mistaken(wanted: str, value: object) -> str:
    """Say that an argument is not what is wanted, what was given, and what to do.

    Parameters
    ----------
    wanted : str
        What is wanted, a key of `wanted_kinds`.
    value : object
        What was given.

    Returns
    -------
    str
        What follows the name of the argument.

    Examples
    --------
    >>> mistaken("vehicle", None), mistaken("scenario", "truck.toml")
    ('must be a Vehicle, got None', "must be a Scenario, got 'truck.toml'; `read_scenario(file)` reads one")
    """
    return f"must {wanted_kinds()[wanted].words}, got {given(value)}{instead_of(wanted, value)}"


def instead_of(wanted: str, value: object) -> str:
    """Say what to do where something else was given, behind a semicolon; nothing if that is unknown."""
    instead = {} if isinstance(value, type) else wanted_kinds()[wanted].instead
    hint = next((instead[name] for name in _names(value) if name in instead), "")
    hint = hint or next((said for name, said in instead.items() if name[0] == "." and hasattr(value, name[1:])), "")
    return hint and f"; {hint}"


def beyond_limits(name: str, value: object) -> str:
    """Say which limit of the method a value in place of a number meets: several speeds, a law for a spring."""
    if isinstance(value, str) or not (callable(value) or hasattr(value, "__len__")):
        return ""
    if "speed" in name:
        limit = "one constant speed a call"
    elif "stiffness" in name or "damping" in name:
        limit = "springs and dashpots are linear"
    else:
        return ""
    return f'; {limit}: see "Limits" in docs/conventions.md'


def shown(value: object) -> str:
    """Write a refused value in a line, shortened where it is long; of what is shown in several, the class."""
    try:
        text = repr(value)
    except ValueError:  # an integer of thousands of digits
        text = "a number of thousands of digits"
    if "\n" in text:
        if type(value).__module__ not in ("builtins", "numpy"):
            return given(value)
        text = " ".join(text.split())
    return text if len(text) <= 60 else f"{text[:57]}..."


def given(value: object) -> str:
    """Name what was given: a short value itself, of others the class."""
    if isinstance(value, type):
        return f"the class {value.__name__} itself: brackets make one of it"
    if value is None or isinstance(value, (str, int, float, complex)):
        return shown(value)
    if kind := _kind(value):
        return f"a result of kind {kind!r}"
    if isinstance(value, (list, tuple)) and not hasattr(value, "_fields"):
        return f"a {type(value).__name__} of {type(value[0]).__name__}" if value else shown(value)
    name = type(value).__name__
    return f"{'an' if name[0] in 'AEIOUaeiou' or name == 'ndarray' else 'a'} {name}"


def one_of(name: str, value: Any) -> str:
    """Say how to take one column of what has several, behind a semicolon."""
    dims = getattr(value, "dims", None)
    if dims is None:
        return f"; one column at a time, as {name}[:, 0]"
    places = value.coords[dims[1]].values.tolist() if dims[1] in value.coords else []
    choice = f"sel({dims[1]}={places[0]!r})" if places else f"isel({dims[1]}=0)"
    return f"; one column at a time, as {f'result.{value.name}' if value.name else name}.{choice}"


def _kind(value: Any) -> str:
    """Kind of a result, as its attributes say; empty of anything else."""
    attrs = getattr(value, "attrs", None)
    return str(attrs.get("kind", "")) if isinstance(attrs, dict) and hasattr(value, "data_vars") else ""


def _names(value: Any) -> Iterator[str]:
    if isinstance(value, (list, tuple)) and value and not hasattr(value, "_fields"):
        yield f"[{type(value[0]).__name__}]"
    if isinstance(value, (str, PurePath)):
        yield "text"
    if kind := _kind(value):
        yield kind
    yield from (one.__name__ for one in type(value).__mro__)
