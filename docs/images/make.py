"""Make the picture of the README: `python docs/images/make.py`."""

from pathlib import Path

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from movingfrf.reports import plots
from movingfrf.reports.axes import legend_above
from movingfrf.scenarios.reading import parse_scenario
from movingfrf.scenarios.template import template


def main() -> None:
    """Draw the reference case: contact forces and deflections, five seconds of them."""
    result = parse_scenario(template("scenario")).run()
    figure = Figure(figsize=(9.6, 4.6), layout="constrained", dpi=110)
    FigureCanvasAgg(figure)
    above, below = figure.subplots(2, 1, sharex=True)
    plots.contact_forces(result, above, interval=(12.0, 17.0))
    legend_above(above)
    above.set_xlabel("")
    plots.deflections(result, below, interval=(12.0, 17.0))
    for axes in (above, below):
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(Path(__file__).with_name("reference_case.png"), metadata={"Software": None})


if __name__ == "__main__":
    main()
