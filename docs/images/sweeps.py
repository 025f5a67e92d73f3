"""Make the picture of docs/sweeps.md: `python docs/images/sweeps.py`."""

from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg

import movingfrf as mf
from movingfrf._basics.toml_file import tables_of
from movingfrf.reports.figures import drawing
from movingfrf.reports.layout import arrange
from movingfrf.scenarios.template import template
from movingfrf.studies.sweep.page import maps
from movingfrf.studies.sweep.page.limits import Limit
from movingfrf.studies.sweep.page.page import views


def main() -> None:
    """Draw the map that a page has: random responses over speed and tyre stiffness."""
    axes = {"run.speed": np.linspace(5.0, 35.0, 31), "vehicle.tyre_stiffness.1": np.linspace(2e6, 6e6, 17)}
    tables = tables_of(template("scenario"))
    table = mf.sweep(tables, axes, response="random", measures="dynamic_load_coefficient")
    (view,) = views(table, [Limit("dynamic_load_coefficient", 0.12)])
    with drawing():
        figure = maps.figure(view)
        arrange(figure)
        FigureCanvasAgg(figure)
        figure.savefig(Path(__file__).parent / "sweep_map.png", dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    main()
