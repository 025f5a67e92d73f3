"""What the tables of a scenario can be: family and kind → what makes it.

The Python signatures are the schema. A table's `kind` names a function or class, its keys are the keyword
arguments, and the checks are those that the function makes itself; a new kind is one line in `KINDS`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from movingfrf._basics.checks import checking
from movingfrf.guideways.beams import EulerBernoulliBeam, TimoshenkoBeam
from movingfrf.guideways.foundations import OnMass, ShearLayer, Spring
from movingfrf.guideways.rigid import RigidGuideway
from movingfrf.guideways.tensioned import TensionedBeam
from movingfrf.guideways.track import track
from movingfrf.roughness.files import read_profile
from movingfrf.roughness.preparation import prepared
from movingfrf.roughness.road import Road
from movingfrf.roughness.spectra.coherence import ExponentialCoherence, IsotropicCoherence
from movingfrf.scenarios import forces
from movingfrf.scenarios.roads import ROADS, SPECTRA
from movingfrf.vehicles.assembly import Body, Hinge, Suspension, assemble
from movingfrf.vehicles.cars import full_car, half_car, quarter_car
from movingfrf.vehicles.catalogue import catalogue
from movingfrf.vehicles.combined import convoy, on_paths, seated, train
from movingfrf.vehicles.contact import Contact
from movingfrf.vehicles.files import read_vehicle
from movingfrf.vehicles.journey import Journey
from movingfrf.vehicles.oscillator import sprung_mass
from movingfrf.vehicles.rail import bogie, carriage, wheelset
from movingfrf.vehicles.trucks import Axle, Unit, WalkingBeam, truck
from movingfrf.vehicles.vehicle import Vehicle


class Loads(NamedTuple):
    """Prescribed forces that travel along."""

    positions: np.ndarray
    histories: tuple[forces.History, ...]
    observe: np.ndarray


def profile(
    *,
    interval: tuple[float, float],
    file: Path,
    format: str | None = None,
    columns: Sequence[str | int] | None = None,
    across: Sequence[float] | None = None,
    crop_rims: bool = False,
    repair_gaps: float | None = None,
    paths: Sequence[int] | None = None,
    first: float | None = None,
    last: float | None = None,
    spike: float | None = None,
    detrend: int | None = None,
    high_pass: float | None = None,
    step: float | None = None,
    repeat_to: float | None = None,
    mirror_to: float | None = None,
) -> Road:
    """Read a measured profile, and prepare it as far as options ask for it; the description says what was done."""
    found, understood = read_profile(
        file, format=format, columns=columns, across=across, crop_rims=crop_rims, repair_gaps=repair_gaps
    )
    ready = prepared(
        found,
        paths=paths,
        first=first,
        last=last,
        spike=spike,
        detrend=detrend,
        high_pass=high_pass,
        step=step,
        repeat_to=repeat_to,
        mirror_to=mirror_to,
    )
    return Road(ready, "; ".join([understood, *ready.steps]))


def passage(*, speed: float, duration: float, time_step: float = 1e-3, truncation: float | None = None) -> Journey:
    """How prescribed loads travel: no vehicle, hence no profile to start on."""
    return Journey(speed=speed, duration=duration, time_step=time_step, truncation=truncation)


def vehicle_file(*, file: Path) -> Vehicle:
    """Read a vehicle from a file of matrices."""
    return read_vehicle(file)


def loads(
    *, positions: Sequence[float], force: Sequence[forces.History], observe: Sequence[float] | None = None
) -> Loads:
    """Prescribed loads: positions ahead of the reference point [m] and one force history for each."""
    with checking() as check:
        at = check.array("positions", positions, "m", (None,))
        points = at if observe is None else check.array("observe", observe, "m", (None,))
        if not check.faults and not (at.size and points.size):
            check.refuse("positions", "must hold at least one position [m], as must observe")
        if not check.faults and len(force) != at.size:
            check.refuse("force", f"must stand once per position, {at.size} times, got {len(force)}")
    return Loads(at, tuple(force), points)


# Family → kind → what makes it. `kind` is the Python name in snake_case.
KINDS: dict[str, dict[str, Callable[..., Any]]] = {
    "guideway": {"track": track, "rigid_guideway": RigidGuideway},
    "beam": {
        "euler_bernoulli_beam": EulerBernoulliBeam,
        "timoshenko_beam": TimoshenkoBeam,
        "tensioned_beam": TensionedBeam,
    },
    "foundation": {"spring": Spring, "shear_layer": ShearLayer, "on_mass": OnMass},
    "vehicle": {
        "half_car": half_car,
        "full_car": full_car,
        "quarter_car": quarter_car,
        "sprung_mass": sprung_mass,
        "truck": truck,
        "wheelset": wheelset,
        "bogie": bogie,
        "carriage": carriage,
        "convoy": convoy,
        "train": train,
        "seated": seated,
        "on_paths": on_paths,
        "catalogue": catalogue,
        "assemble": assemble,
        "vehicle": Vehicle,
        "vehicle_file": vehicle_file,
    },
    "contact": {"contact": Contact},
    "body": {"body": Body},
    "suspension": {"suspension": Suspension},
    "hinge": {"hinge": Hinge},
    "unit": {"unit": Unit},
    "axle": {"axle": Axle, "walking_beam": WalkingBeam},
    "roughness": {**ROADS, "profile": profile},
    "spectrum": SPECTRA,
    "coherence": {
        "isotropic_coherence": IsotropicCoherence,
        "exponential_coherence": ExponentialCoherence,
    },
    "journey": {"journey": Journey},
    "passage": {"passage": passage},
    "loads": {"loads": loads},
    "force": {
        "constant": forces.constant,
        "harmonics": forces.harmonics,
        "random_sum": forces.random_sum,
        "tabulated": forces.tabulated,
    },
}

# The kind that a table has if it does not say.
DEFAULT_KIND = {
    "guideway": "track",
    "contact": "contact",
    "body": "body",
    "suspension": "suspension",
    "hinge": "hinge",
    "unit": "unit",
    "axle": "axle",
    "journey": "journey",
    "passage": "passage",
    "loads": "loads",
}

# Arguments that are tables themselves, and those that are lists of tables, with their family.
TABLES = {
    "beam": "beam",
    "foundation": "foundation",
    "above": "foundation",
    "below": "foundation",
    "car": "vehicle",
    "vehicle": "vehicle",
    "spectrum": "spectrum",
    "coherence": "coherence",
}

TABLE_LISTS = {
    ("vehicle", "contacts"): "contact",
    ("vehicle", "bodies"): "body",
    ("vehicle", "suspensions"): "suspension",
    ("vehicle", "hinges"): "hinge",
    ("vehicle", "units"): "unit",
    ("vehicle", "vehicles"): "vehicle",
    ("unit", "axles"): "axle",
    ("loads", "force"): "force",
    ("roughness", "parts"): "roughness",
}
