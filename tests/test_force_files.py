"""Forces over time from files: the time and the force are known by names and units."""

import numpy as np
import pytest

from movingfrf.scenarios.forces import tabulated
from tests.reader_parts import written

TIME = 0.05 * np.arange(8)
FORCE = 1000.0 + 100.0 * np.sin(20.0 * TIME)


def rows(form, **scales):
    """Write a line for each row, of t and f, with scales for both."""
    return "".join(
        form.format(t=round(t * scales.get("t", 1.0), 14), f=f / scales.get("f", 1.0), n=n) + "\n"
        for n, (t, f) in enumerate(zip(TIME, FORCE, strict=True))
    )


READABLE = {
    "as ever": ("t,F\n" + rows("{t},{f}"), {}),
    "no names": (rows("{t} {f}"), {}),
    "milliseconds and kilonewton": ("time [ms],force [kN]\n" + rows("{t},{f}", t=1e3, f=1e3), {}),
    "a line of units": ("Zeit;Radlast\ns;kN\n" + rows("{t};{f}", f=1e3).replace(".", ","), {}),
    "a line of units in brackets": ("time\tload\n[min]\t[MN]\n" + rows("{t}\t{f}", t=1 / 60, f=1e6), {}),
    "the unit as the last word": ("time_ms,force_kN\n" + rows("{t},{f}", t=1e3, f=1e3), {}),
    "the unit behind a comma": ('"time, ms","Load, lbf"\n' + rows("{t},{f}", t=1e3, f=4.4482216152605), {}),
    "kips": ("t [s],P [kip]\n" + rows("{t},{f}", f=4448.2216152605), {}),
    "the force first": ("force [N],time [s]\n" + rows("{f},{t}"), {}),
    "the force first, by number": ("force [N],time [s]\n" + rows("{f},{t}"), {"column": 0}),
    "a counter without a name": (",time [s],force [N]\n" + rows("{n},{t},{f}"), {}),
    "a counter with a name": ("No.,time,force\n" + rows("{n},{t},{f}"), {"column": 2}),
    "another quantity": ("time [s],speed [km/h],force [N]\n" + rows("{t},80,{f}"), {}),
    "one column of two": ("t,a,b\n" + rows("{t},{n},{f}"), {"column": 2}),
    "a clock": ("clock time,time [s],force [N]\n" + rows("12:00:0{n},{t},{f}"), {}),
    "a date": ("Date,time,force\n" + rows("20240501,{t},{f}"), {}),
    "remarks": ("time,force,note\n" + rows("{t},{f},joint"), {}),
    "one remark": ("time,force,note\n" + rows("{t},{f},{n}").replace(",3\n", ",joint\n"), {}),
    "an empty column": ("time,force,other\n" + rows("{t},{f},"), {}),
    "a gap elsewhere": ("time,other,force\n" + rows("{t},{n},{f}").replace(",5,", ",,"), {}),
    "a marker elsewhere": ("time,force,other\n" + rows("{t},{f},{n}").replace(",5\n", ",-9999\n"), {}),
    "lines above": ("600,0.05\ntime,force\n" + rows("{t},{f}"), {"skip_lines": 1}),
    "Fortran": ("# made by hand\ntime [s];force [kN]\n" + rows("{t};{f}D+00 // joint", f=1e3), {}),
}


@pytest.mark.parametrize("name", READABLE)
def test_one_force_in_every_form(tmp_path, name):
    text, options = READABLE[name]
    history = tabulated(file=written(tmp_path, "force.csv", text), **options)
    assert history(TIME[:-1]) == pytest.approx(FORCE[:-1], rel=1e-9)
    assert history.begins == pytest.approx(TIME[0])
    assert history.ends == pytest.approx(TIME[-1])


@pytest.mark.parametrize(
    ("text", "options", "message"),
    [
        ("time [ms],force [t]\n" + rows("{t},{f}"), {}, "the unit 't' of column 'force .t.' must be one of N, "),
        (
            "time [s],force [N]\n" + rows("{t},{f}").replace("0.15,", "0.1,"),
            {},
            "line 5: time must increase, got 0.1",
        ),
        ("time,force\n" + rows("{t},{f}").replace("0.15,", "0.15,-9999 #"), {}, "line 5: −9999 .* a missing value"),
        ("time,force\n" + rows("{t},{f}").replace("0.15,", "0.15,nan #"), {}, "line 5: expected a finite number"),
        ("time,force\n" + rows("{t},{f}").replace("0.15,", "0.15,x #"), {}, "line 5: expected numbers"),
        ("clock time,force\n" + rows("12:00:0{n},{f}"), {}, "line 2: expected two numbers"),
        ("time,force,b\n" + rows("12:00:0{n},{f},1"), {}, "the times must be numbers"),
        ("time,force\n" + rows("{t},{f}"), {"column": 2}, "column must be one of .1., counted from 0, got 2"),
        ("distance [m],force [N]\n" + rows("{t},{f}"), {}, "none of the columns .* is called a time"),
        ("time [s],speed [km/h]\n" + rows("{t},{f}"), {}, "none of the columns .* is a force"),
        (rows("{n} {t} {f}"), {}, "the first column may be a time .s. or a number of the row"),
        ("600,0.05\ntime,force\n" + rows("{t},{f}"), {}, "line 2: expected numbers .*`skip_lines`"),
        ("time,force\n0,1\n1,2\n", {}, "at least 4 rows"),
    ],
)
def test_what_is_no_force_over_time(tmp_path, text, options, message):
    with pytest.raises(ValueError, match=message):
        tabulated(file=written(tmp_path, "force.csv", text), **options)


def test_a_pulse_may_have_any_height(tmp_path):
    steady = "time,force\n" + "".join(f"{t},9999\n" for t in TIME)
    assert tabulated(file=written(tmp_path, "steady.csv", steady))(TIME)[3] == 9999.0
    text = "time,force\n" + "".join(f"{t},{9999 if n == 3 else 0}\n" for n, t in enumerate(TIME))
    assert tabulated(file=written(tmp_path, "force.csv", text))(TIME)[3] == 9999.0
