"""Item 11: vehicle and road in three dimensions."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.sparse.linalg import splu

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.wording import number
from movingfrf.guideways.guideway import Guideway
from movingfrf.guideways.sampled import SampledGuideway
from movingfrf.reports.curves import INK, PALETTE
from movingfrf.reports.tables import Column
from movingfrf.roughness.profile import Profile
from movingfrf.stepping.coupled import cdfm
from movingfrf.stepping.finite_plate import finite_plate, struck_plate
from movingfrf.studies.paper.drawing import STROKES, canvas, curve, legend_outside, logarithmic, title
from movingfrf.studies.paper.outcome import AGREEMENT, DataTable, Outcome, Plot, Statement, Verdict, verdict
from movingfrf.studies.paper.stated import STATED, SUBSTITUTES
from movingfrf.studies.paper.study import Study, drive, quiet, relative, scenario
from movingfrf.vehicles.vehicle import Vehicle

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


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
        return 2.0 if self.study.quick else scenario("truck_3d").journey.duration

    @property
    def across(self) -> int:
        """Elements across."""
        return 3 if self.study.quick else 6

    @cached_property
    def vehicle(self) -> Vehicle:
        """The vehicle with seven degrees of freedom."""
        return drive("truck_3d").vehicle

    def struck(self, transverse: float = 1.0) -> SampledGuideway:
        """Strike 40 m of plate as in the paper: the moving FRF between all contacts."""
        with quiet():
            return struck_plate(
                self.study.guideway,
                width=STATED.width,
                speed=self.study.speed,
                vehicle=self.vehicle,
                across=self.across,
                poisson=SUBSTITUTES.poisson,
                transverse=transverse,
                plain=True,
                progress=self.study.progress,
            )

    def driven(self, guideway: Guideway, name: str, profile: Profile | None = None) -> xr.Dataset:
        """Drive the vehicle of a scenario, by the moving FRF."""
        return self.study.driven(guideway, name, duration=self.duration, profile=profile)

    def stepped(self, name: str) -> xr.Dataset:
        """Step the same by the coupled method, on a plate that travels along."""
        case, at = drive(name), self.vehicle.positions
        around = 16.0  # how far the plate reaches around the vehicle [m]
        plate = finite_plate(
            self.study.guideway,
            width=STATED.width,
            first=float(at.min()) - around,
            last=float(at.max()) + around,
            across=self.across,
            poisson=SUBSTITUTES.poisson,
            absorbing=10.0,  # of that, at either end
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

    def basin(self, poisson: float = SUBSTITUTES.poisson, transverse: float = 1.0) -> Basin:
        """Deflection of the plate at rest under the vehicle's weight."""
        plate = finite_plate(
            self.study.guideway,
            width=STATED.width,
            first=-20.0,
            last=20.0,
            element=0.5 if self.study.quick else 0.25,
            across=2 * self.across,
            poisson=poisson,
            transverse=transverse,
            ends="clamped",
        )
        at, aside = self.vehicle.positions, self.vehicle.across
        deflection = splu(plate.stiffness).solve(plate.rows(at, 0, aside).T @ self.vehicle.static_loads)
        along = np.union1d(np.linspace(-8.0, 8.0, 161), at)
        across = np.linspace(-0.5 * STATED.width, 0.5 * STATED.width, 61)
        mesh = np.meshgrid(along, across, indexing="ij")
        values = (plate.rows(mesh[0].ravel(), 0, mesh[1].ravel()) @ deflection).reshape(mesh[0].shape)
        front = along == at[0]
        return Basin(
            along,
            across,
            values,
            float(np.interp(aside[0], across, values[front][0])),
            float(np.trapezoid(values[front][0], across) / STATED.width),
        )

    @cached_property
    def beam(self) -> float:
        """Deflection of the plane road at rest under the front axle [m]."""
        at = self.vehicle.positions
        return float(self.study.guideway.moving_frf(at[0] - at, 0.0, [0.0])[0].real @ self.vehicle.static_loads)


class Basin(NamedTuple):
    """Deflection at rest [m]: everywhere, in the front wheel path, and the mean of the front axle's section."""

    along: FloatArray
    across: FloatArray
    deflection: FloatArray
    wheel: float
    average: float


def paired(result: xr.Dataset) -> dict[str, FloatArray]:
    """Pick what a plane model knows of a response in three dimensions, each (time, channel)."""
    force, wheels = result.contact_force.values, result.acceleration.values[:, 3:]
    sag = (result.deflection - result.static_deflection).values
    return {
        "contact force": force[:, 0::2] + force[:, 1::2],
        "deflection": 0.5 * (sag[:, 0::2] + sag[:, 1::2]),
        "bounce": result.motion.values[:, :1],
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
        "bounce": result.motion.values[:, :1],
        "bounce acceleration": acceleration[:, :1],
        "pitch acceleration": acceleration[:, 1:2],
        "wheel acceleration": acceleration[:, 2:],
    }


def _differences(found: dict[str, FloatArray], wanted: dict[str, FloatArray]) -> dict[str, float]:
    return {name: relative(found[name], wanted[name]) for name in wanted}


def in_three_dimensions(study: Study) -> Outcome:
    """Compare vehicle and road in three dimensions with the plane model."""
    models = Models(study)
    flat = models.driven(study.struck, "truck")
    # Transverse stiffnesses, as multiples of that of the isotropic plate.
    stiffnesses = (1.0, 1e6) if study.quick else (1.0, 10.0, 100.0, 1e3, 1e4, 1e6)
    struck = models.struck()
    same, apart = models.driven(struck, "truck_3d"), models.driven(struck, "truck_3d_paths")
    found, basins = {1.0: _differences(paired(same), plane(flat))}, {1.0: models.basin()}
    for n, transverse in enumerate(stiffnesses[1:], start=1):
        study.told("transverse stiffness", n, len(stiffnesses))
        result = models.driven(models.struck(transverse), "truck_3d")
        found[transverse] = _differences(paired(result), plane(flat))
        basins[transverse] = models.basin(transverse=transverse)
    stepped = models.stepped("truck_3d")
    agreement = _differences(paired(same), paired(stepped))
    road = drive("truck_3d_paths").road
    mean = replace(road.profile, elevation=np.asarray(road.profile.elevation).mean(axis=1))
    from_mean = _differences(paired(apart), plane(models.driven(study.struck, "truck", mean)))
    real, stiff, basin, straight = found[1.0], found[stiffnesses[-1]], basins[1.0], models.basin(poisson=0.0)
    force = apart.contact_force.values
    share = float((force[:, 0::2] - force[:, 1::2]).std() / (force[:, 0::2] + force[:, 1::2]).std())
    roll = float(np.abs(apart.motion.values[:, 2]).max())
    vehicle = {name: value for name, value in real.items() if name not in ("contact force", "deflection")}
    names = list(real)
    return Outcome(
        statements=[
            Statement(
                'A 3-D finite-element model whose "system parameters are consistent with the 2D model '
                'parameters" (Fig. 18 '
                "and the comparison after it); (implied) vehicle responses agree.",
                "With the same roughness on both paths the vehicle's responses differ by "
                f"{number(min(vehicle.values()), 2)} to {number(max(vehicle.values()), 2)} (relative L2; the "
                f"displacement of the body by {number(real['bounce'], 2)}, the acceleration of the wheels by "
                f"{number(real['wheel acceleration'], 2)}), contact forces by {number(real['contact force'], 2)}; "
                f"the road's dynamic deflection under the wheels differs by {number(real['deflection'], 2)}.",
                verdict(max(*vehicle.values(), real["contact force"]) < AGREEMENT.one_curve),
                "holds below 1 %, the road's deflection apart",
            ),
            Statement(
                "Beyond the paper: the plane model as the limit of a stiff section, and what it cannot do.",
                f"With a section {number(stiffnesses[-1], 1)} times as stiff across, contact forces differ from "
                f"the plane model by {number(stiff['contact force'], 1)}. On different paths the plane model on "
                f"their mean still gives what bounces (within {number(from_mean['bounce acceleration'], 1)}) and "
                f"the sum of forces ({number(from_mean['contact force'], 1)}), but not that left and right forces "
                f"differ by {number(100 * share, 2)} % of what their sum varies by, and that the body rolls by up "
                f"to {number(1e3 * roll, 2)} mrad.",
                Verdict.SHOWN,
            ),
        ],
        numbers={
            **_named("difference_from_plane", real),
            **_named("stiff_section", stiff),
            **_named("moving_frf_against_cdfm", agreement),
            **_named("different_paths_from_plane_on_their_mean", from_mean),
            "wheel_path_over_average_deflection": basin.wheel / basin.average,
            "average_over_plane_deflection": basin.average / models.beam,
            "average_over_plane_deflection_without_poisson": straight.average / models.beam,
            "largest_roll_rad": roll,
            "left_minus_right_over_sum": share,
        },
        computed=[
            "Road: Bogner–Fox–Schmit elements assembled by scikit-fem; struck at the wheel paths, 40 m long, "
            "simply supported, 1 ms, exactly as the beam in the other items, so that what differs is the third "
            "dimension. The moving FRF then relates all four contacts, ahead, behind and across.",
            "Verified by CDFM on a plate that travels along (elements of 0.5 m, "
            f"{models.across} across): contact forces {number(agreement['contact force'], 2)}, wheel accelerations "
            f"{number(agreement['wheel acceleration'], 2)}.",
            "Cause of the difference: the section bends. At rest, under the front axle, the road deflects by "
            f"{number(basin.wheel / basin.average, 4)} times the section's average in the wheel paths. That "
            f"average is {number(basin.average / models.beam, 4)} times the plane model's deflection, the rest "
            f"being Poisson's effect ({number(straight.average / models.beam, 4)} with ν = 0). The vehicle feels "
            f"less of it than the road, which is {number(_guideway_over_tyres(study, models), 2)} times as stiff "
            "as the tyres of the front axle.",
            "Towards the stiff limit the dynamic differences level off at what steps of 1 ms make of the fast "
            "vibrations of a stiff section; the deflection at rest does not.",
            *(
                [f"Quick: {models.duration:g} s of the journey, {models.across} elements across."]
                if study.quick
                else []
            ),
        ],
        substitutes=[
            SUBSTITUTES.road,
            SUBSTITUTES.plate,
            SUBSTITUTES.vehicle,
            SUBSTITUTES.roughness,
            "Different paths: two realisations without anything in common, which real roads are not; the extreme "
            "case.",
        ],
        plots=[
            Plot(
                "figure_18",
                "The road in three dimensions",
                "(a) Deflection of the plate under the vehicle at rest, squares the wheels; (b) across the road "
                "under the front axle: the section bends.",
                _figure_18(models, basin),
            ),
            Plot(
                "item_11_responses",
                "Responses in two and in three dimensions",
                "Displacement and accelerations of the vehicle and dynamic deflection under the front axle (mean "
                "of left and right): plane model, and plate by moving FRF and by CDFM.",
                _figure_of_responses(models, plane(flat), paired(stepped), paired(same), flat.time.values),
            ),
            Plot(
                "item_11_limit",
                "From three dimensions to two, and what two cannot do",
                "(a) Difference from the plane model over the transverse stiffness of the road; (b), (c) roll "
                "and front contact forces on roughness that differs from left to right.",
                _figure_of_limits(models, found, apart),
            ),
        ],
        tables=[
            DataTable(
                "item_11",
                "Relative L2 difference between three dimensions and two, by moving FRF, the worst channel, over "
                "the transverse stiffness; last, deflection at rest in the front wheel paths, relative to the "
                "plane model.",
                "transverse stiffness, times isotropic",
                [*(Column(name, "") for name in names), Column("at rest", "")],
                [(f"{s:g}", [*found[s].values(), basins[s].wheel / models.beam - 1]) for s in stiffnesses],
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


def _named(prefix: str, values: dict[str, float]) -> dict[str, float]:
    return {f"{prefix}_{name.replace(' ', '_')}": value for name, value in values.items()}


def _guideway_over_tyres(study: Study, models: Models) -> float:
    """Point stiffness of the plane road at rest over that of the front axle's tyres."""
    compliance = float(study.guideway.moving_frf([0.0], 0.0, [0.0])[0, 0].real)
    return 1 / (compliance * 2 * models.vehicle.contacts[0].stiffness)


def _figure_18(models: Models, basin: Basin) -> Figure:
    figure, (top, section) = canvas(1, 2, 2.4, width_ratios=(3, 2))
    drawn = top.contourf(basin.along, basin.across, 1e3 * basin.deflection.T, 14, cmap="cividis")
    wheels: dict[str, Any] = {"color": "white", "markeredgecolor": "black", "markersize": 5, "linestyle": ""}
    top.plot(models.vehicle.positions, models.vehicle.across, marker="s", **wheels)
    top.set(xlabel="along the road [m]", ylabel="across, left positive [m]")
    top.grid(False)
    figure.colorbar(drawn, ax=top, label="deflection [mm]")
    here = basin.deflection[basin.along == models.vehicle.positions[0]][0]
    curve(section, basin.across, 1e3 * here, STROKES.blue, "plate")
    section.axhline(1e3 * basin.average, color=PALETTE[0], linewidth=0.9, linestyle="--", label="its average")
    section.axhline(1e3 * models.beam, color=INK, linewidth=1.0, label="plane model")
    section.plot(models.vehicle.across[:2], [1e3 * basin.wheel] * 2, marker="s", **wheels)
    section.set(xlabel="across, left positive [m]", ylabel="deflection [mm]")
    section.set_ylim(None, 1e3 * here.max() + 0.08)
    section.legend(ncols=3, loc="upper center", columnspacing=0.9, handlelength=1.4, fontsize=6.5)
    return figure


def _shown(models: Models) -> tuple[float, float]:
    """Choose a second of the journey to show [s]."""
    begin = min(12.0, models.duration - 1.0)
    return begin, begin + 1.0


def _figure_of_responses(
    models: Models,
    flat: dict[str, FloatArray],
    stepped: dict[str, FloatArray],
    found: dict[str, FloatArray],
    time: FloatArray,
) -> Figure:
    figure, axes = canvas(2, 2, 4.1)
    interval = _shown(models)
    some = (time >= interval[0]) & (time <= interval[1])
    quantities = (
        ("bounce", 1e3, "bounce [mm]"),
        ("bounce acceleration", 1.0, "bounce acceleration [m/s²]"),
        ("wheel acceleration", 1.0, "front wheel acceleration [m/s²]"),
        ("deflection", 1e3, "dynamic deflection [mm]"),
    )
    for ax, (name, scale, label) in zip(axes, quantities, strict=True):
        for values, line, what in (
            (flat, STROKES.black, "2-D, moving FRF"),
            (stepped, STROKES.sky, "3-D, CDFM"),
            (found, STROKES.orange, "3-D, moving FRF"),
        ):
            curve(ax, time[some], scale * values[name][some, 0], line, what)
        ax.set(xlabel="time [s]", ylabel=label, xlim=interval)
    legend_outside(figure, axes[0])
    return figure


def _figure_of_limits(models: Models, found: dict[float, dict[str, float]], apart: xr.Dataset) -> Figure:
    figure, (grows, rolls, forces) = canvas(1, 3, 3.0)
    stiffnesses, time, interval = list(found), apart.time.values, _shown(models)
    some = (time >= interval[0]) & (time <= interval[1])
    for name, line in zip(found[1.0], STROKES.coloured, strict=True):
        values = [found[s][name] for s in stiffnesses]
        grows.plot(stiffnesses, values, **line._asdict(), marker="o", markersize=3, label=name)
    grows.set(xscale="log", xlabel="transverse stiffness,\ntimes isotropic", ylabel="difference from 2-D")
    logarithmic(grows)
    figure.legend(
        *grows.get_legend_handles_labels(), loc="outside upper left", ncols=3, fontsize=6.5, title="in (a)"
    )
    curve(rolls, time[some], 1e3 * apart.motion.values[some, 2], STROKES.blue)
    rolls.set(xlabel="time [s]", ylabel="roll [mrad]", xlim=interval)
    for column, (line, side) in enumerate(((STROKES.blue, "left"), (STROKES.orange, "right"))):
        curve(forces, time[some], 1e-3 * apart.contact_force.values[some, column], line, f"front {side}")
    forces.set(xlabel="time [s]", ylabel="dynamic contact force [kN]", xlim=interval)
    low, high = forces.get_ylim()
    forces.set_ylim(low, high + 0.2 * (high - low))
    forces.legend(loc="upper right", ncols=2, columnspacing=1.0, handlelength=1.4)
    for ax in (rolls, forces):
        ax.locator_params(axis="x", nbins=4)
    for ax, words in ((grows, "3-D tends to 2-D"), (rolls, "different paths"), (forces, "different paths")):
        title(ax, words)
    return figure
