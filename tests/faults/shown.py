"""What is read and shown: files of results, words, curves, tables, scenarios; what is remembered."""

from __future__ import annotations

from tests.faults.fault import Fault

FAULTS = [
    # Figures of pages, and what they cost.
    Fault(
        "no room for tick labels",
        "reports/layout.py",
        "ROOM.tick + _labels(ax.yaxis",
        "ROOM.tick + 0 * _labels(ax.yaxis",
    ),
    Fault("no room for legends", "reports/layout.py", "ROOM.legend * legend_rows(names)", "0.0"),
    Fault("powers as mathematics", "reports/layout.py", "isinstance(formatter, LogFormatterSciNotation)", "False"),
    Fault(
        "figure measured by drawing it",
        "reports/figures.py",
        "(SIZE.width, height))",
        '(SIZE.width, height), layout="tight")',
    ),
    Fault(
        "spline of another end",
        "_basics/spline.py",
        "above[0] = width[1], width[0] + width[1]",
        "above[0] = width[0], width[0] + width[1]",
    ),
    Fault(
        "spline of unordered places", "_basics/spline.py", "(flat[1:] >= flat[:-1]).all()", "flat[-1] >= flat[0]"
    ),
    Fault("area that begins anew at every knot", "_basics/spline.py", "raised[-1, ..., 1:] = ", "_ = "),
    # Values in the hand, doors, words.
    Fault(
        "shape that does not count",
        "_basics/values.py",
        "return value.shape, blake2b(numbers",
        "return 0, blake2b(numbers",
    ),
    Fault("two zeros", "_basics/values.py", '(0j if value.dtype.kind == "c" else 0.0)', "-0.0"),
    Fault(
        "nan unlike nan",
        "_basics/values.py",
        "numbers[np.isnan(numbers)] = np.nan",
        "numbers[np.isnan(numbers)] = id(value)",
    ),
    Fault("names that run as HTML", "_basics/values.py", "{escape(words)}</td>", "{words}</td>"),
    Fault("nothing to do instead", "_basics/door.py", 'return hint and f"; {hint}"', 'return ""'),
    Fault("no limit to point to", "_basics/door.py", "callable(value) or hasattr", "False and hasattr"),
    Fault("wk unknown", "_basics/checks.py", "same.get(word.casefold()", "same.get(word"),
    Fault("speed in the wrong unit", "scenarios/kinds.py", '"km/h") / 3.6', '"km/h") / 3.5'),
    Fault(
        "two speeds at once", "scenarios/kinds.py", "if speed is not None and speed_kmh is not None:", "if False:"
    ),
    Fault("digits that nobody gave", "_basics/wording.py", "other[0]:.4g}", "other[0]:.9g}"),
    Fault("rails called road", "vehicles/vehicle.py", '"rail" if self.on_rails else "road"', '"road"'),
    Fault("neighbours counted singly", "_basics/wording.py", "numbers[rank] - rank)", "numbers[rank])"),
    Fault(
        "tonnes for kilograms",
        "scenarios/unusual.py",
        "if least * (1 - rounding) <= value",
        "if True or value",
    ),
    Fault(
        "sags in silence",
        "scenarios/unusual.py",
        "(held / (4 * bending)) ** 0.25",
        "(held / (4e9 * bending)) ** 0.25",
    ),
    Fault("convoy called long", "scenarios/unusual.py", "np.ptp(places[part.contacts])", "np.ptp(places)"),
    Fault("absurd in silence", "scenarios/scenario.py", "warned(self.case.unusual))", "[])"),
    Fault("sentences broken anywhere", "commands/console.py", "break_long_words=False", "break_long_words=True"),
    Fault("number without its unit", "commands/console.py", '"\\u00a0", line)', '" ", line)'),
    Fault("lists that may be empty", "commands/root.py", "negative_iterable=()", 'negative_iterable=("empty",)'),
    # Paths, distributions, shapes.
    Fault(
        "shape that starts at zero",
        "scenarios/roads.py",
        'last - first, "start": first}',
        'last - first, "start": 0.0}',
    ),
    # What a table of a scenario can be.
    Fault("key that may be left out", "scenarios/kind.py", "=_without_none(", "=("),
    Fault(
        "value of another type a defect",
        "scenarios/kind.py",
        '"" if fits(value, self.type) else',
        '"" if value else',
    ),
    Fault("keys that all have to be there", "commands/kinds.py", '"" if key.needed else', '"" if 1 else'),
    Fault("unit of the neighbour", "_basics/documented.py", "[{units[place]}", "[{units[0]}"),
    Fault("part of a road for no journey", "scenarios/reading.py", "key.item == family.makes", "False"),
    Fault("kind that need not be said", "scenarios/schema.py", "kind.name != family.default else []", "0 else []"),
    Fault("infinity that is a mistake", "scenarios/schema.py", '["number", "null"]', '"number"'),
    Fault(
        "class and roughness at once",
        "scenarios/schema.py",
        "for name in kind.either]}",
        "for name in kind.either[:1]]}",
    ),
    Fault("list of no tables", "scenarios/schema.py", '{"minItems": 1}', "{}"),
    Fault("record without its widths", "guideways/files.py", "if array is not None}", 'if "across" not in name}'),
    Fault("journey off the road", "scenarios/stepped.py", "(journey.start, end)", "(end, end)"),
    # A scenario stepped through time.
    Fault(
        "weight of its own on a bridge",
        "scenarios/stepped.py",
        "superposed=superposed and not stands_still(guideway)",
        "superposed=superposed",
    ),
    Fault("bridge called steady", "reports/ways.py", 'and not attrs["superposed"]', 'and attrs["superposed"]'),
    Fault(
        "set-up in full in a batch",
        "studies/comparison/comparison.py",
        "row.setup_s / batch + row.solve_s",
        "row.setup_s + row.solve_s",
    ),
    Fault(
        "set-up of a batch free",
        "studies/comparison/comparison.py",
        "point.setup_s * (1 - 1 / batch)",
        "point.setup_s",
    ),
    Fault("times without numbers", "studies/comparison/page.py", 'f"{tick:g}" if free else ""', '""'),
    Fault("empty spectrum drawn", "reports/plots.py", "> SPECTRUM_STYLE.road_floor).any()", "> 0).any()"),
    Fault("run-in off the road", "scenarios/stepped.py", "max(0.0, math.floor(behind", "max(0.0, math.ceil(behind"),
    Fault("no room to run in", "scenarios/stepped.py", "journey.start - run_in * journey.speed", "journey.start"),
    # Profiles from files.
    Fault(
        "sparse by rows",
        "_basics/matlab_file.py",
        "filled[rows[:used], np.repeat",
        "filled.T[rows[:used], np.repeat",
    ),
    Fault(
        "characters by columns", "_basics/matlab_file.py", "whole[row::rows]", "whole[row * len(whole) // rows :]"
    ),
    Fault("texts of structs unread", "_basics/matlab_file.py", "        found.texts[name] =", "        {}[name] ="),
    Fault("first of several structs", "_basics/array_file.py", "if len(most) > 1:", "if len(most) > 9:"),
    Fault("decimal comma by itself", "_basics/toml_file.py", "{1}.{2}", "{1}.{1}"),
    Fault("line after the fault", "_basics/toml_file.py", "0, error.start) + 1", "0, error.start) + 2"),
    Fault("keys and words alike", "commands/kinds.py", "hanging=4", "hanging=0"),
    Fault("rows for columns", "_basics/matlab_file.py", 'reshape(shape, order="F")', "reshape(shape)"),
    Fault("packed bombs let in", "_basics/matlab_file.py", "most or limit)", "most or 0)"),
    # What is left out, told apart, cut and refused.
    Fault("nan that passes", "results/labels.py", "~np.isfinite(values)", "np.isinf(values)"),
    Fault("curve that hides another", "reports/curves.py", "<= coincident * np.abs(other)", "<= np.abs(other)"),
    Fault("roll for a bounce", "reports/curves.py", "units[dof] != units[one] or abs(size", "abs(size"),
    Fault("wheels before bodies", "reports/curves.py", "key=lambda dof: rms[dof])", "key=lambda dof: -rms[dof])"),
    Fault("moving FRF up to a truncation", "reports/frf.py", "return min(max(ends), kept)", "return kept"),
    Fault("table wider than the console", "commands/console.py", "if pieces[-1] and width > left:", "if False:"),
    Fault("once in 1e46 seconds", "_basics/wording.py", "0 < value < NEVER", "0 < value < 0"),
    Fault(
        "computed each time", "_basics/remembered.py", "return value._implied[name]\n", "return compute(value)\n"
    ),
    # Results for other programs.
    Fault("radians for metres", "results/labels.py", 'if dof_unit == "rad" else 0', 'if dof_unit == "m" else 0'),
    Fault("real part twice", "results/exports/columns.py", "column.values.imag))", "column.values.real))"),
    Fault("road upside down", "results/exports/universal.py", "form.up if upwards", "form.down if upwards"),
    Fault(
        "two places at one node",
        "results/exports/universal.py",
        "DATASET_58.other_nodes) + place.number",
        "DATASET_58.other_nodes)",
    ),
    Fault("names alike in MATLAB", "results/exports/matlab.py", "while valid in others:", "while False:"),
    Fault(
        "variable lost to a structure", "results/exports/matlab.py", 'taken=(*content, "settings"))', "taken=())"
    ),
    Fault(
        "part without its names",
        "results/exports/base.py",
        "in variable.dims or dim in result.coords]",
        "in variable.dims]",
    ),
    Fault("dimensions in one order only", "results/exports/base.py", ".transpose(axis, ...)", ".transpose(...)"),
    Fault(
        "unit of another's",
        "results/exports/base.py",
        'attrs.get("units", label.units',
        'attrs.get("x", label.units',
    ),
    Fault("numbers alone where they are read", "commands/console.py", "words.get(place, place)", "place"),
    Fault("contact without its name", "results/labels.py", 'f" ({name})" if name else "" for', '"" for'),
    Fault(
        "entry of the catalogue taken for no word",
        "scenarios/reading.py",
        'if "catalogue" in kinds and',
        "if False and",
    ),
    Fault("refusal wider than a terminal", "commands/main.py", "if sys.stderr.isatty():", "if False:"),
    Fault("the same fault twice", "metrics/comfort.py", "if len(check.faults) > before:", "if False:"),
    Fault("message of several lines", "_basics/door.py", '" ".join(text.split())', "text"),
    Fault("file replaced unasked", "results/export.py", "if file.exists() and not force:", "if False:"),
    Fault("complex numbers in CF", "results/labels.py", "return real and all(", "return all("),
    # What is drawn and chosen, and how it is refused.
    Fault("any kind drawn", "reports/plots.py", "if kind not in kinds:", "if kind is None:"),
    Fault(
        "interval beyond the record", "reports/plots.py", "elif last <= time[0] or first > time[-1]:", "elif False:"
    ),
    Fault("interval backwards", "reports/plots.py", "if first >= last:", "if False:"),
    Fault(
        "speed of the first curve",
        "reports/frf.py",
        "for row, speed in enumerate(speeds)",
        "for row, speed in enumerate(speeds[:1] * len(speeds))",
    ),
    Fault(
        "true for the first contact",
        "_basics/checks.py",
        "isinstance(value, int) and not isinstance(value, bool) and 0",
        "isinstance(value, int) and 0",
    ),
    Fault(
        "spectrum estimated where it is known",
        "metrics/spectra.py",
        "return result.frequency.values / speed, speed * density",
        "return result.frequency.values, density",
    ),
    Fault("two neighbours as a range", "_basics/wording.py", "if len(words) == 2:", "if False:"),
    Fault("truck as fast as a car", "scenarios/unusual.py", "if heaviest > USUAL.truck_axle:", "if False:"),
    Fault("loose dampers in silence", "scenarios/unusual.py", "if share < least:", "if False:"),
    Fault(
        "half a word for a label",
        "results/exports/universal.py",
        'return textwrap.shorten(words, DATASET_58.label, placeholder="") or',
        "return",
    ),
    Fault("file without accelerations", "results/files.py", "if not label.optional]", "if label.optional]"),
]
