"""Item 11: vehicle and road in three dimensions."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse.linalg import splu

from movingfrf import plots
from movingfrf._checks import FloatArray
from movingfrf.guideways.sampled import SampledGuideway
from movingfrf.page import Column
from movingfrf.paper.drawing import BLACK, BLUE, GREEN, ORANGE, PINK, SKY, canvas, curve, legend_outside, title
from movingfrf.paper.outcome import DataTable, Outcome, Plot, Statement, verdict
from movingfrf.paper.road import SUBSTITUTE
from movingfrf.paper.study import TRUNCATION, Study, quiet, relative, scenario
from movingfrf.paper.vehicle import ROUGHNESS, VEHICLE
from movingfrf.reference.coupled import cdfm
from movingfrf.reference.plate import finite_plate, struck_plate
from movingfrf.simulation import simulate
from movingfrf.vehicles.base import Vehicle
from movingfrf.wording import number

if TYPE_CHECKING:
    import xarray as xr

# Width of the road [m] (stated), Poisson's ratio of asphalt.
WIDTH, POISSON = 3.0, 0.35

# Transverse stiffnesses, as multiples of that of the isotropic plate.
STIFFNESSES = (1.0, 10.0, 100.0, 1e3, 1e4, 1e6)

# The window of road that travels along: how far it reaches around the vehicle, and its absorbing ends [m].
AROUND, ABSORBING = 16.0, 10.0

# Responses of two models that differ by less than this are the same.
SAME = 2e-2

ZOOM = (12.0, 13.0)

PLATE = (
    "The three-dimensional model is not described further. Substitute: an isotropic thin plate with free edges "
    f"(Poisson's ratio {POISSON:g}) on a viscoelastic foundation, 3 m wide, which carries, has and bends per "
    "width what the beam has on the whole; the half truck with half of each axle at either side, 2 m apart, and "
    "a radius of gyration of 0.79 m in roll."
)


@dataclass(frozen=True)
class Models:
    """The road as a plate, the vehicle with left and right wheels, and what they do.

    Parameters
    ----------
    study : Study
        The study.
    """

    study: Study

    @property
    def duration(self) -> float:
        """Time that is travelled [s]."""
        return 3.0 if self.study.quick else scenario("truck_3d").journey.duration

    @property
    def across(self) -> int:
        """Elements across."""
        return 3 if self.study.quick else 6

    @cached_property
    def vehicle(self) -> Vehicle:
        """The vehicle with seven degrees of freedom."""
        vehicle = scenario("truck_3d").vehicle
        assert vehicle is not None
        return vehicle

    def struck(self, transverse: float = 1.0) -> SampledGuideway:
        """Strike 40 m of plate as in the paper: the moving FRF between all contacts."""
        with quiet():
            return struck_plate(
                self.study.road,
                width=WIDTH,
                speed=self.study.speed,
                vehicle=self.vehicle,
                across=self.across,
                poisson=POISSON,
                transverse=transverse,
                plain=True,
                progress=self.study.progress,
            )

    def driven(self, guideway: SampledGuideway, name: str) -> xr.Dataset:
        """Drive the vehicle of a scenario over its roughness, by the moving FRF."""
        case = scenario(name)
        assert case.vehicle is not None
        assert case.road is not None
        with quiet():
            return simulate(
                guideway,
                case.vehicle,
                case.road.profile,
                speed=case.journey.speed,
                duration=self.duration,
                time_step=case.journey.time_step,
                truncation=TRUNCATION,
            )

    def stepped(self, name: str) -> xr.Dataset:
        """Step the same by the coupled method, on a plate that travels along."""
        case, at = scenario(name), self.vehicle.positions
        assert case.vehicle is not None
        assert case.road is not None
        plate = finite_plate(
            self.study.road,
            width=WIDTH,
            first=float(at.min()) - AROUND,
            last=float(at.max()) + AROUND,
            across=self.across,
            poisson=POISSON,
            absorbing=ABSORBING,
            travels=True,
        )
        return cdfm(
            plate,
            case.vehicle,
            case.road.profile,
            speed=case.journey.speed,
            duration=self.duration,
            time_step=case.journey.time_step,
            superposed=True,
            progress=self.study.progress,
        )

    def basin(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Deflection of the plate at rest under the vehicle's weight: places along and across, and w [m]."""
        plate = finite_plate(
            self.study.road,
            width=WIDTH,
            first=-20.0,
            last=20.0,
            element=0.25,
            across=12,
            poisson=POISSON,
            ends="clamped",
        )
        at, aside = self.vehicle.positions, self.vehicle.across
        load = plate.rows(at, 0, aside).T @ self.vehicle.static_loads
        deflection = splu(plate.stiffness).solve(load)
        along, across = np.linspace(-8.0, 8.0, 161), np.linspace(-0.5 * WIDTH, 0.5 * WIDTH, 61)
        mesh = np.meshgrid(along, across, indexing="ij")
        return along, across, (plate.rows(mesh[0].ravel(), 0, mesh[1].ravel()) @ deflection).reshape(mesh[0].shape)


def paired(result: xr.Dataset) -> dict[str, FloatArray]:
    """Pick what a plane model knows of a response in three dimensions, each (time, channel)."""
    force, wheels = result.contact_force.values, result.acceleration.values[:, 3:]
    sag = (result.deflection - result.static_deflection).values
    return {
        "contact force": force[:, 0::2] + force[:, 1::2],
        "deflection": 0.5 * (sag[:, 0::2] + sag[:, 1::2]),
        "bounce acceleration": result.acceleration.values[:, :1],
        "pitch acceleration": result.acceleration.values[:, 1:2],
        "wheel acceleration": 0.5 * (wheels[:, 0::2] + wheels[:, 1::2]),
    }


def plane(result: xr.Dataset) -> dict[str, FloatArray]:
    """Pick the same of a response in the plane."""
    acceleration = result.acceleration.values
    return {
        "contact force": result.contact_force.values,
        "deflection": (result.deflection - result.static_deflection).values,
        "bounce acceleration": acceleration[:, :1],
        "pitch acceleration": acceleration[:, 1:2],
        "wheel acceleration": acceleration[:, 2:],
    }


def _differences(found: dict[str, FloatArray], wanted: dict[str, FloatArray]) -> dict[str, float]:
    return {name: relative(found[name], wanted[name]) for name in wanted}


def in_three_dimensions(study: Study) -> Outcome:
    """Compare vehicle and road in three dimensions with the plane model."""
    models = Models(study)
    case = scenario("truck")
    assert case.vehicle is not None
    assert case.road is not None
    with quiet():
        flat = simulate(
            study.struck,
            case.vehicle,
            case.road.profile,
            speed=case.journey.speed,
            duration=models.duration,
            time_step=case.journey.time_step,
            truncation=TRUNCATION,
        )
    stiffnesses = STIFFNESSES[:1] + STIFFNESSES[-1:] if study.quick else STIFFNESSES
    found: dict[float, dict[str, float]] = {}
    sag: dict[float, float] = {}
    struck = models.struck()
    same = models.driven(struck, "truck_3d")
    for n, transverse in enumerate(stiffnesses):
        guideway = struck if transverse == 1.0 else models.struck(transverse)
        result = same if transverse == 1.0 else models.driven(guideway, "truck_3d")
        found[transverse] = _differences(paired(result), plane(flat))
        sag[transverse] = float(np.abs(_sag(result) / flat.static_deflection.values - 1).max())
        study.told("transverse stiffness", n + 1, len(stiffnesses))
    stepped = models.stepped("truck_3d")
    agreement = _differences(paired(same), paired(stepped))
    apart = models.driven(struck, "truck_3d_paths")
    mean = _mean_profile(models, study)
    from_mean = _differences(paired(apart), plane(mean))
    along, across, deflection = models.basin()
    here = deflection[np.abs(along - models.vehicle.positions[0]).argmin()]
    wheel, average = float(np.interp(1.0, across, here)), float(np.trapezoid(here, across) / WIDTH)
    beam = _plane_basin(study, models)
    compliance = float(study.road.moving_frf([0.0], 0.0, [0.0])[0, 0].real)
    road_over_tyres = 1 / (compliance * case.vehicle.contacts[0].stiffness)
    real = found[1.0]
    roll = apart.motion.values[:, 2]
    unequal = apart.contact_force.values[:, 0::2] - apart.contact_force.values[:, 1::2]
    share = float(unequal.std() / (apart.contact_force.values[:, 0::2] + apart.contact_force.values[:, 1::2]).std())

    time = flat.time.values
    begin = min(ZOOM[0], models.duration - 1.0)
    some = (time >= begin) & (time <= begin + 1.0)
    model, (top, section) = canvas(1, 2, 2.2, width_ratios=(3, 2))
    drawn = top.contourf(along, across, 1e3 * deflection.T, 14, cmap="cividis")
    top.plot(
        models.vehicle.positions, models.vehicle.across, "s", color="white", markeredgecolor="black", markersize=5
    )
    top.set(xlabel="along the road [m]", ylabel="across [m]")
    top.grid(False)
    model.colorbar(drawn, ax=top, label="deflection [mm]")
    curve(section, across, 1e3 * here, BLUE, "plate, under the front axle")
    section.axhline(1e3 * average, color=plots.INK, linewidth=1.0, linestyle="--", label="its average")
    section.plot([-1, 1], [1e3 * wheel] * 2, "s", color="white", markeredgecolor="black", markersize=5)
    section.set(xlabel="across [m]", ylabel="deflection [mm]")
    section.legend()
    histories, axes = canvas(2, 2, 3.9)
    for ax, (name, label) in zip(
        axes,
        (
            ("bounce acceleration", "bounce [m/s²]"),
            ("pitch acceleration", "pitch [rad/s²]"),
            ("wheel acceleration", "front wheel [m/s²]"),
            ("deflection", "dynamic deflection [mm]"),
        ),
        strict=True,
    ):
        scale = 1e3 if name == "deflection" else 1.0
        for values, line, what in (
            (plane(flat), BLACK, "2-D, moving FRF"),
            (paired(stepped), SKY, "3-D, CDFM"),
            (paired(same), ORANGE, "3-D, moving FRF"),
        ):
            curve(ax, time[some], scale * values[name][some, 0], line, what)
        ax.set(xlabel="time [s]", ylabel=label, xlim=(begin, begin + 1.0))
    legend_outside(histories, axes[0])
    limit, (grows, rolls, forces) = canvas(1, 3, 2.5)
    for name, line in zip(real, (BLUE, ORANGE, GREEN, PINK, SKY), strict=True):
        grows.plot(
            stiffnesses,
            [found[s][name] for s in stiffnesses],
            **line._asdict(),
            marker="o",
            markersize=3,
            label=name,
        )
    grows.set(
        xscale="log", yscale="log", xlabel="transverse stiffness, times isotropic", ylabel="difference from 2-D"
    )
    grows.legend(fontsize=6.5)
    curve(rolls, time[some], 1e3 * roll[some], BLUE)
    rolls.set(xlabel="time [s]", ylabel="roll [mrad]", xlim=(begin, begin + 1.0))
    for column, (line, side) in enumerate(((BLUE, "left"), (ORANGE, "right"))):
        curve(forces, time[some], 1e-3 * apart.contact_force.values[some, column], line, f"front {side}")
    forces.set(xlabel="time [s]", ylabel="dynamic contact force [kN]", xlim=(begin, begin + 1.0))
    forces.legend()
    for ax, words in (
        (grows, "3-D tends to 2-D"),
        (rolls, "different paths: roll"),
        (forces, "different paths: forces"),
    ):
        title(ax, words)
    names = list(real)
    return Outcome(
        statements=[
            Statement(
                "Vehicle responses by a three-dimensional finite-element model agree with the plane model (Fig. "
                "18 and the comparison after it).",
                "With the same roughness on both paths the wheel accelerations differ by "
                f"{number(real['wheel acceleration'], 2)}, bounce by {number(real['bounce acceleration'], 2)} and "
                f"contact forces by {number(real['contact force'], 2)} (relative L2); the road's dynamic "
                f"deflection under the wheels differs by {number(real['deflection'], 2)}.",
                verdict(max(real["wheel acceleration"], real["bounce acceleration"], real["contact force"]) < SAME),
            ),
            Statement(
                "(Not in the paper.) The plane model is the limit of a stiff section, and cannot follow "
                "roughness that differs from left to right.",
                f"With the section {number(stiffnesses[-1], 1)} times as stiff across, forces differ from the "
                f"plane model by {number(found[stiffnesses[-1]]['contact force'], 1)}. On different paths the "
                "mean of both still gives what bounces and pitches "
                f"({number(from_mean['bounce acceleration'], 1)}, {number(from_mean['contact force'], 1)} in the "
                f"sum of forces), but left and right forces differ by {number(100 * share, 2)} % of what their "
                f"sum varies by, and the body rolls by up to {number(1e3 * float(np.abs(roll).max()), 2)} mrad.",
                verdict(found[stiffnesses[-1]]["contact force"] < 0.5 * real["contact force"]),
            ),
        ],
        numbers={
            **{f"difference_from_plane_{name.replace(' ', '_')}": value for name, value in real.items()},
            **{f"stiff_section_{name.replace(' ', '_')}": value for name, value in found[stiffnesses[-1]].items()},
            **{f"moving_frf_against_cdfm_{name.replace(' ', '_')}": value for name, value in agreement.items()},
            "wheel_path_over_average_deflection": wheel / average,
            "average_over_plane_deflection": average / beam,
            "steady_deflection_over_plane": 1 + sag[1.0],
            "largest_roll_rad": float(np.abs(roll).max()),
            "left_minus_right_over_sum": share,
        },
        computed=[
            "Road: Bogner–Fox–Schmit elements assembled by scikit-fem; struck at both wheel paths, 40 m long, "
            "simply supported, 1 ms, exactly as the beam in the other items, so that what differs is the third "
            "dimension. The moving FRF then relates all four contacts, ahead, behind and across.",
            f"Verified by CDFM on a plate that travels along (elements of 0.5 m, {models.across} across): contact "
            f"forces {number(agreement['contact force'], 2)}, wheel accelerations "
            f"{number(agreement['wheel acceleration'], 2)}.",
            "Cause of the difference: the section bends. Under the front axle at rest the road deflects by "
            f"{number(wheel / average, 4)} times the section's average in the wheel paths, while that average is "
            f"{number(average / beam, 4)} times the plane model's deflection. The vehicle feels less of it than "
            f"the road, which is {number(road_over_tyres, 2)} times as stiff as the tyres of the front axle.",
            *(
                [f"Quick: {models.duration:g} s of the journey, {models.across} elements across."]
                if study.quick
                else []
            ),
        ],
        substitutes=[
            SUBSTITUTE,
            PLATE,
            VEHICLE,
            ROUGHNESS,
            "Different paths: two realisations without anything in common, which real roads are not; the extreme "
            "case.",
        ],
        plots=[
            Plot(
                "figure_18",
                "The road in three dimensions",
                "(a) Deflection of the plate under the vehicle at rest, squares the wheels; (b) across the road "
                "under the front axle: the section bends.",
                model,
            ),
            Plot(
                "item_11_responses",
                "Responses in two and in three dimensions",
                "Accelerations of the vehicle and dynamic deflection under the front axle (mean of left and "
                "right): plane model, and plate by moving FRF and by CDFM.",
                histories,
            ),
            Plot(
                "item_11_limit",
                "From three dimensions to two, and what two cannot do",
                "(a) Difference from the plane model over the transverse stiffness of the road; (b), (c) roll "
                "and front contact forces on roughness that differs from left to right.",
                limit,
            ),
        ],
        tables=[
            DataTable(
                "item_11",
                "Relative L2 difference between three dimensions and two, by moving FRF, the worst channel, over "
                "the transverse stiffness; and of the largest steady deflection.",
                "transverse stiffness, times isotropic",
                [*(Column(name, "") for name in names), Column("steady deflection", "")],
                [(f"{s:g}", [*found[s].values(), sag[s]]) for s in stiffnesses],
            ),
            DataTable(
                "item_11_methods",
                "Moving FRF against CDFM in three dimensions, relative L2 difference, the worst channel.",
                "roughness",
                [Column(name, "") for name in names],
                [("the same on both paths", list(agreement.values()))],
            ),
        ],
    )


def _sag(result: xr.Dataset) -> FloatArray:
    sag = result.static_deflection.values
    return 0.5 * (sag[0::2] + sag[1::2])


def _plane_basin(study: Study, models: Models) -> float:
    """Deflection under the front axle of the beam at rest under the vehicle's weight [m]."""
    at = models.vehicle.positions
    frf = study.road.moving_frf(at[0] - at, 0.0, [0.0])[0].real
    return float(frf @ models.vehicle.static_loads)


def _mean_profile(models: Models, study: Study) -> xr.Dataset:
    """Response of the plane model to the mean of both paths."""
    case, both = scenario("truck"), scenario("truck_3d_paths")
    assert case.vehicle is not None
    assert both.road is not None
    profile = both.road.profile
    with quiet():
        return simulate(
            study.struck,
            case.vehicle,
            replace(profile, elevation=np.asarray(profile.elevation).mean(axis=1)),
            speed=case.journey.speed,
            duration=models.duration,
            time_step=case.journey.time_step,
            truncation=TRUNCATION,
        )
