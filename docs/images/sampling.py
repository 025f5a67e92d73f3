"""Make the pictures of docs/sampling.md: `python docs/images/sampling.py`."""

from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import movingfrf as mf
from movingfrf.reports.axes import legend_above
from movingfrf.response.line import TRANSFORM, Given, Line
from movingfrf.roughness.excitation import Touch, excite

FOLDER = Path(__file__).parent


def canvas(rows: int, height: float) -> tuple[Figure, np.ndarray]:
    """Prepare axes one below the other."""
    figure = Figure(figsize=(9.6, height), layout="constrained", dpi=110)
    FigureCanvasAgg(figure)
    axes = np.atleast_1d(figure.subplots(rows, 1, sharex=True))
    for each in axes:
        each.spines[["top", "right"]].set_visible(False)
    return figure, axes


def record() -> None:
    """Draw a record of two seconds: the road, known and guessed, its fading, the window, and the output."""
    speed, duration, known = 15.0, 2.0, 32.0
    road = mf.realise(mf.IsoRoad.of_class("B", band=(0.05, 2.0)), length=60.0, seed=3)
    ends = road.stations <= known
    profile = mf.Profile(road.stations[ends], road.columns[ends, 0])
    wheel = Touch(positions=np.zeros(1), paths=[0], footprints=np.zeros(1), cams=np.zeros(1))
    line = Line(samples=400, time_step=5e-3, dying=1.0, fading=0.4, points=4096)
    seen = excite(profile, wheel, start=0.0, distance=speed * duration, blend=5.0)
    elevation = seen.elevation(speed * line.instants)
    spectrum = line.spectra(Given(elevation))
    time = np.arange(line.padded) * line.time_step
    faded = np.fft.irfft(spectrum[0, : line.padded // 2 + 1], line.padded) / line.time_step
    window = np.exp(-line.decay * time)

    figure, (above, below) = canvas(2, 5.2)
    at_end = known / speed
    before = line.instants <= at_end
    above.plot(line.instants[before], 1e3 * elevation[0, before], color="0.1", label="profile, blended in")
    above.plot(
        line.instants[~before], 1e3 * elevation[0, ~before], color="tab:orange", label="guessed past its end"
    )
    above.plot(time, 1e3 * faded / window, color="tab:blue", linestyle="--", label="faded out within the padding")
    above.set_ylabel("elevation [mm]")
    below.semilogy(
        time,
        window,
        color="tab:green",
        label=f"exponential window, to 1/{TRANSFORM.growth:g} at the end of the record",
    )
    scale = np.abs(faded).max()
    below.semilogy(time, np.abs(faded) / scale, color="tab:blue", label="what is transformed, its size")
    below.set_ylim(1e-6, 2.0)
    below.set_xlabel("time [s]")
    for axes in (above, below):
        axes.axvspan(duration, line.period, color="0.93")
        axes.set_xlim(0.0, line.period)
        legend_above(axes)
    above.annotate("end of the record", (duration, above.get_ylim()[0]), (4, 6), textcoords="offset points")
    figure.savefig(FOLDER / "sampling_record.png", metadata={"Software": None})


def steps() -> None:
    """Draw a corrugation of 720 Hz as a wheelset's contact force: as solved, and as a record in steps of 5 ms."""
    track = mf.track(
        mf.EulerBernoulliBeam(bending_stiffness=6.42e6, mass=60.2),
        mf.OnMass(
            above=mf.Spring(stiffness=3.0e8, damping=3.0e4),
            mass=250.0,
            below=mf.Spring(stiffness=1.0e8, damping=8.0e4),
        ),
    )
    wheelset = mf.wheelset(mass=1800.0, contact_stiffness=2.4e9)
    rail = mf.harmonic(amplitude=5e-6, wavelength=0.05, length=40.0)
    result = mf.simulate(track, wheelset, rail, speed=36.0, duration=0.8, time_step=2.1e-3)
    figure, (axes,) = canvas(1, 3.2)
    fine = (result.solved_time.values > 0.5) & (result.solved_time.values < 0.53)
    some = (result.time.values > 0.5) & (result.time.values < 0.53)
    axes.plot(
        result.solved_time[fine],
        1e-3 * result.solved_contact_force[fine, 0],
        color="0.6",
        label=f"as solved, every {1e3 * result.attrs['solved_step']:.2g} ms",
    )
    axes.plot(
        result.time[some],
        1e-3 * result.contact_force[some, 0],
        "o-",
        color="tab:blue",
        label="record, every 2.1 ms",
    )
    axes.set(xlabel="time [s]", ylabel="dynamic contact force [kN]")
    legend_above(axes)
    figure.savefig(FOLDER / "sampling_steps.png", metadata={"Software": None})


if __name__ == "__main__":
    record()
    steps()
