"""Spectra, realisations, shapes, what a contact sees; profiles from files and what is done to them."""

from __future__ import annotations

from tests.faults.fault import Fault

FAULTS = [
    # Road.
    Fault(
        "two-sided density",
        "roughness/realisation.py",
        "np.sqrt(2 * harmonics.variances",
        "np.sqrt(harmonics.variances",
    ),
    Fault(
        "another road at another step",
        "roughness/realisation.py",
        "(spectrum.band, ask.length)",
        "(spectrum.band, 99 * step + ask.length)",
    ),
    Fault(
        "lines beside the band",
        "roughness/realisation.py",
        "int(np.ceil(band[0] * period",
        "int(np.floor(band[0] * period",
    ),
    Fault(
        "chirp of another turn",
        "roughness/realisation.py",
        "np.pi * np.remainder(",
        "np.pi * (1 + 1e-9) * np.remainder(",
    ),
    Fault("stations beside whole steps", "roughness/realisation.py", "np.floor(first + SLACK)", "np.ceil(first)"),
    Fault("four stations to a wave", "roughness/realisation.py", "sixteenth = 0.0625 /", "sixteenth = 0.25 /"),
    Fault(
        "wheel that touches at stations alone", "roughness/combination.py", "sharpest))), 16)", "sharpest))), 1)"
    ),
    Fault(
        "wheel on the waves of a spline",
        "roughness/combination.py",
        "[1:]) + 0.5 * least",
        "[1:]) + 0.5 * bent.max()",
    ),
    Fault("no road beyond the journey", "scenarios/roads.py", "+ reach + beyond))", "+ reach))"),
    Fault(
        "a road for every rounding of the duration",
        "scenarios/roads.py",
        "last = end - journey.distance + journey.speed * journey.duration",
        "last = end",
    ),
    Fault(
        "one path for what is measured", "roughness/profile.py", "and not self.full_width", "and self.full_width"
    ),
    Fault(
        "one path unsaid by the coupled method",
        "stepping/coupled.py",
        "*find.one_path(profile.one_path, vehicle.paths, vehicle.across),",
        "",
    ),
    Fault("one path for one wheel", "results/findings.py", "if not known or abreast == 1:", "if not known:"),
    Fault("arithmetic class centres", "roughness/spectra/iso.py", "16e-6 * 4.0**n", "20e-6 * 4.0**n"),
    Fault("slopes exchanged", "roughness/spectra/two_slope.py", "MEETING, long, short)", "MEETING, short, long)"),
    Fault(
        "slopes overlap", "roughness/spectra/two_slope.py", "(np.minimum, np.maximum)", "(np.minimum, np.minimum)"
    ),
    Fault("limits at the centres", "roughness/spectra/iso.py", "roughness < 2 * centre", "roughness < centre"),
    Fault(
        "waviness ignored",
        "roughness/spectra/spectrum.py",
        "power = 1 - np.asarray(exponent, float)",
        "power = np.array(-1.0)",
    ),
    Fault(
        "variance from zero on",
        "roughness/spectra/spectrum.py",
        "self._integral(self.band[0],",
        "self._integral(0.5 * self.band[0],",
    ),
    Fault(
        "content beside the band",
        "roughness/spectra/spectrum.py",
        "np.where(n == asked, self._formula(n), 0.0)",
        "self._formula(n)",
    ),
    Fault(
        "per radian",
        "roughness/spectra/rail.py",
        "self._CORNER**2 / (2 * np.pi) ** 3",
        "self._CORNER**2 / (2 * np.pi) ** 2",
    ),
    Fault(
        "German per radian",
        "roughness/spectra/rail.py",
        "return self.roughness / (2 * np.pi) * c**2",
        "return self.roughness * c**2",
    ),
    Fault("cubic centimetres", "roughness/spectra/rail.py", "3.9488e-4]) * 1e-6", "3.9488e-4]) * 1e-4"),
    Fault("pieces without an end", "roughness/spectra/rail.py", "np.array([*self._BREAKS, np.inf])", "np.inf"),
    Fault("partial fraction", "roughness/spectra/rail.py", "b**2 / 3 * (low", "b**2 * (low"),
    Fault(
        "level of an amplitude",
        "roughness/spectra/tabulated.py",
        "REFERENCE_AMPLITUDE**2 * 10 ** (np.asarray(self.level)[order] / 10)",
        "REFERENCE_AMPLITUDE**2 * 10 ** (np.asarray(self.level)[order] / 20)",
    ),
    Fault(
        "levels in the order given",
        "roughness/spectra/tabulated.py",
        "order = np.argsort(-np.asarray(self.wavelength))",
        "order = np.arange(np.size(self.wavelength))",
    ),
    Fault(
        "table straight in density",
        "roughness/spectra/tabulated.py",
        "np.interp(np.log(n), np.log(knots), np.log(values))",
        "np.log(np.interp(n, knots, values))",
    ),
    # Paths, distributions, shapes.
    Fault(
        "coherence over half of the distance",
        "roughness/spectra/coherence.py",
        "z = 2 * np.pi * _products",
        "z = np.pi * _products",
    ),
    Fault(
        "waviness for the order",
        "roughness/spectra/coherence.py",
        "order = self.waviness / 2",
        "order = self.waviness / 2.5",
    ),
    Fault(
        "variance of the line below",
        "roughness/realisation.py",
        "(self.numbers[:-1] + 0.5)",
        "(self.numbers[:-1] - 0.0)",
    ),
    Fault(
        "paths without an own part",
        "roughness/realisation.py",
        "own = rest[:, :1] > smallest_pivot",
        "own = rest[:, :1] > 0.9",
    ),
    Fault(
        "coherence squared in realisations",
        "roughness/realisation.py",
        "rest = matrix[:, j:, j] -",
        "rest = matrix[:, j:, j] ** 2 -",
    ),
    Fault(
        "spread of a Laplace road",
        "roughness/realisation.py",
        "spread = kurtosis / 3 - 1",
        "spread = kurtosis / 6 - 0.5",
    ),
    Fault(
        "Laplace road half as rough",
        "roughness/realisation.py",
        "rng.gamma(1 / spread, spread,",
        "rng.gamma(1 / spread, spread / 2,",
    ),
    Fault("what a mask hides", "_basics/checks.py", "uncovered(value) if masks(value) else value", "value"),
    Fault("true is one", "_basics/checks.py", "if kinds & {bool, np.bool_}:", "if False:"),
    Fault("segments of a step", "roughness/realisation.py", "/ count / segment)", "/ count)"),
    Fault(
        "a flat lifts the wheel",
        "roughness/irregularities.py",
        "elevation = -(np.maximum(chord / 2",
        "elevation = (np.maximum(chord / 2",
    ),
    Fault("flat once per diameter", "roughness/irregularities.py", "at, 2 * np.pi * radius))", "at, 2 * radius))"),
    Fault("pothole that rises", "roughness/irregularities.py", "-depth * smooth_step(", "depth * smooth_step("),
    Fault(
        "weld twice as deep",
        "roughness/irregularities.py",
        "d * np.cos(np.pi * np.clip(",
        "2 * d * np.cos(np.pi * np.clip(",
    ),
    Fault(
        "joints that do not bend",
        "roughness/irregularities.py",
        "1 - away / reach, 0.0) ** 2",
        "1 - away / reach, 0.0)",
    ),
    Fault("wheel that falls into a gap", "roughness/combination.py", "relief = min(", "relief = 0.5 * min("),
    Fault(
        "sum on the first grid",
        "roughness/combination.py",
        "[profile.stations for profile in profiles]))",
        "[profile.stations for profile in profiles[:1]]))",
    ),
    Fault(
        "strangers taken for one path", "roughness/road.py", "return 0.0 if different", "return 1.0 if different"
    ),
    Fault(
        "surface without a coherence",
        "roughness/road.py",
        "return coherence if coherence is not None else presumed(spectrum)",
        "return coherence",
    ),
    Fault("seed ignored", "roughness/realisation.py", "default_rng(number)", "default_rng(0)"),
    Fault("second path is the first", "roughness/profile.py", "elevation[:, path]", "elevation[:, 0]"),
    Fault("datum left in", "roughness/along.py", "found -= self.datum\n", "found -= 0.0\n"),
    Fault(
        "blend twice as long",
        "roughness/excitation.py",
        "- group.foremost) / (self.blend or 1.0)",
        "- group.foremost) / (2 * self.blend or 1.0)",
    ),
    Fault(
        "each wheel blends from its own start",
        "roughness/excitation.py",
        "(distance[:, :blending] - group.foremost)",
        "(distance[:, :blending] - distance[:, :1])",
    ),
    Fault(
        "wheels exchanged along the road",
        "roughness/excitation.py",
        "self.start + self.touch.positions[rows, None]",
        "self.start - self.touch.positions[rows, None]",
    ),
    Fault("rate of the blending missing", "roughness/excitation.py", "smooth_step_slope(setting_in)", "0.0"),
    Fault("average about the datum", "roughness/along.py", "around.c[3] -= height", "height = 0.0"),
    Fault("cams one behind the other only", "roughness/along.py", "[[-1.0], [1.0]] if cams", "[[-1.0]] if cams"),
    Fault("footprint twice as long in space", "roughness/along.py", "0.5 * footprint\n", "1.0 * footprint\n"),
    Fault(
        "road that levels off at its end",
        "roughness/along.py",
        "elevation, slope - grade, length)",
        "0.0 * after, 0.0, length)",
    ),
    Fault(
        "stations predicted backwards",
        "_basics/prediction.py",
        "coefficients[::-1].copy()",
        "coefficients.copy()",
    ),
    Fault("nothing predicted", "roughness/along.py", "if not missed < GOING_ON.better", "if not missed < 0.0"),
    Fault(
        "short waves are made less",
        "_basics/short_waves.py",
        "for zero in _zeros()) ** 2",
        "for zero in _zeros()) ** 4",
    ),
    Fault("slope of the end fades not", "_basics/smooth.py", "* (1.0 - smooth_step(beyond / length))", "* 1.0"),
    Fault(
        "grade left in",
        "roughness/excitation.py",
        "grade = slope if blend and counts else 0.0",
        "grade = 0.0",
    ),
    Fault("grade without a blend", "roughness/excitation.py", "slope if blend and counts", "slope if counts"),
    Fault("short profiles have grades", "roughness/excitation.py", "(SETTING.grade_over / length) ** 2", "1.0"),
    Fault(
        "no doubt at the end",
        "roughness/along.py",
        "cubic(beyond, np.array(off),",
        "cubic(beyond, 0 * np.array(off),",
    ),
    Fault(
        "contacts abreast",
        "roughness/excitation.py",
        "np.outer(self.positions, wave",
        "np.outer(0 * self.positions, wave",
    ),
    # Profiles from files.
    Fault("units not converted", "roughness/formats/base.py", "else values * scale", "else values"),
    Fault("decimal comma taken for none", "roughness/formats/fields.py", "decimal=table.decimal", 'decimal="."'),
    Fault("a spreadsheet's error a comment", "roughness/formats/fields.py", "WRITING.sharp.search(body)", "False"),
    Fault(
        "a quotation mark swallows lines",
        "roughness/formats/fields.py",
        "all(map(_quoting(",
        "all(map(lambda line: True or _quoting(",
    ),
    Fault("a damaged row is a trailing line", "roughness/formats/fields.py", "{2,}[^\\d]*", "{1,}.*"),
    Fault("letterless exponent lost", "roughness/formats/fields.py", "|(?<=[\\d.])(?=[+-]\\d{3}$)", ""),
    Fault("a counter for a station", "roughness/formats/choice.py", "if counts(counting) and", "if False and"),
    Fault("an unnamed column for a station", "roughness/formats/heads.py", 'Head("counter")', 'Head("station")'),
    Fault(
        "units asked for forgotten",
        "roughness/formats/base.py",
        "if asked is None:\n        return [unit or",
        "if True:\n        return [unit or",
    ),
    Fault("times taken for distances", "roughness/files.py", "raw.stations * speed", "raw.stations"),
    Fault(
        "a second line of names skipped",
        "roughness/formats/heads.py",
        "any(len(row.fields) > 1 for",
        "any(False for",
    ),
    Fault("the first of several sheets", "roughness/formats/sheets.py", "if sheet.raw] or", "if sheet.raw][:1] or"),
    Fault("right for left in a grid", "roughness/formats/crg.py", "road.surface_z()[:, ::-1]", "road.surface_z()"),
    Fault("slope and banking left out", "roughness/formats/crg.py", "road.surface_z()[", "road.z["),
    Fault("first path of an ERD file twice", "roughness/formats/erd.py", "values[:, n]", "values[:, 0]"),
    Fault("columns for rows", "_basics/numpy_file.py", '"F" if header.by_columns', '"C" if header.by_columns'),
    Fault("bombs unpacked", "_basics/numpy_file.py", "> UNPACKING.most(len(data))", "> np.inf"),
    Fault("sphere for the ellipsoid", "roughness/formats/gpx.py", "6.694_379_990_141e-3", "0.0"),
    Fault("paths between sections", "roughness/files.py", "rights + share * (lefts - rights)", "rights"),
    Fault("formats not told", "roughness/files.py", ".replace(words, instead)", '.replace(words, "")'),
    Fault(
        "missing values of netCDF read",
        "roughness/formats/hdf_child.py",
        'for name in ("_FillValue", "missing_value"):',
        'for name in ("_FillValue",):',
    ),
    Fault("class of a straight line", "roughness/straight.py", "most <= _rounding(column)", "most <= FLAT"),
    Fault("digits of a file are roughness", "roughness/straight.py", "max(2 * resolution(elevation), ", "max("),
    Fault("slope per station", "roughness/straight.py", "/ (along @ along)", "/ along.size"),
    Fault("what is not wanted is checked", "roughness/files.py", "raw = _selected(raw, paths)", "raw = raw"),
    Fault("choice made twice", "roughness/preparation.py", "in keys and key not in reading}", "in keys}"),
    Fault("a wild station cropped off", "roughness/steps/cropped.py", "int(there[-1]) + 1 if", "there.size if"),
    Fault(
        "recordings joined in silence",
        "roughness/formats/base.py",
        "if asked is None and len(recordings) == 1:",
        "if asked is None:",
    ),
    Fault(
        "waypoint for the name of a track", "roughness/formats/gpx.py", '(["trk"], ["rte"])', '(["wpt"], ["rte"])'
    ),
    Fault("time for distance", "roughness/formats/arrays.py", "timed = head(", "timed = False and head("),
    Fault("row for column", "roughness/formats/arrays.py", "counts(values[:, 0]) and", "False and"),
    Fault(
        "fields of a struct mixed up", "_basics/matlab_file.py", "names[n % len(names)]", "names[-n % len(names)]"
    ),
    Fault(
        "limits of what is packed",
        "roughness/formats/hdf_child.py",
        "about = stored if packed else found",
        "about = stored",
    ),
    Fault("single precision is uneven", "roughness/profile.py", "uneven = 0.02", "uneven = 1e-6"),
    Fault("six digits whatever it takes", "_basics/wording.py", "range(digits, 18)", "range(digits, digits + 1)"),
    Fault("a kerb for a marker", "roughness/sentinels.py", "if off > STANDING.steps * step", "if True"),
    Fault(
        "unit of a name overlooked", "roughness/formats/roles.py", "stated = words.pop(within)", "words.pop(within)"
    ),
    Fault(
        "unit of an array's name overlooked",
        "roughness/formats/arrays.py",
        "return array.unit or head(",
        "return array.unit or None and head(",
    ),
    Fault(
        "kilometres of stationing twice",
        "roughness/formats/columns.py",
        "and _stationing(",
        "and False and _stationing(",
    ),
    Fault(
        "units above a table overlooked",
        "roughness/formats/heads.py",
        "declared=(along, up)",
        "declared=(None, None)",
    ),
    Fault(
        "recordings side by side joined",
        "roughness/formats/choice.py",
        "return found if len(found) > 1 else {}",
        "return {}",
    ),
    Fault(
        "recordings in turns joined",
        "roughness/formats/choice.py",
        "(_in_turns(series, stations) if ordered else {})",
        "{}",
    ),
    Fault(
        "a map for a distance", "roughness/formats/choice.py", "if station not in pair or None in pair", "if True"
    ),
    Fault(
        "a number of a path for elevations",
        "roughness/formats/choice.py",
        "if _has_length(series[n]) or _which(",
        "if True or _which(",
    ),
    Fault(
        "a kilometre of one metre", "roughness/formats/roles.py", 'stated = implied_unit(name) or ""', 'stated = ""'
    ),
    Fault(
        "a reference followed anywhere",
        "roughness/formats/crg.py",
        "or not target.resolve().is_relative_to(path.parent.resolve())",
        "or False",
    ),
    Fault("gaps filled unasked", "roughness/gaps.py", "if longest is None:", "if False:"),
    Fault("holes between stations unseen", "roughness/gaps.py", "if not holes.size:", "if True:"),
    Fault("long gaps filled in pieces", "roughness/gaps.py", "and gap.length <= longest * (1 + SLACK)]", "]"),
    Fault("markers left in", "roughness/formats/base.py", "for marker in missing:", "for marker in ():"),
    Fault("turned round in place", "roughness/files.py", "elevations=raw.elevations[::-1],", ""),
    Fault("gaps of any length filled", "roughness/gaps.py", "> longest * (1 + SLACK):\n", "> np.inf:\n"),
    Fault(
        "rows in quotation marks",
        "roughness/formats/fields.py",
        'return kinds.count("n") > 1 or (',
        "return (False and ",
    ),
    Fault(
        "a text among elevations", "roughness/formats/columns.py", "found.require(taken.used)", "found.require(())"
    ),
    Fault(
        "a text in an ERD file",
        "roughness/formats/fields.py",
        "found.require(range(table.width))",
        "found.require(())",
    ),
    Fault("millinewton for meganewton", "roughness/formats/roles.py", '"MN": 1e6', '"MN": 1e-3'),
    Fault(
        "the first column for the time",
        "scenarios/force_files.py",
        "if called := [",
        "if False and [",
    ),
    Fault("markers among forces", "scenarios/force_files.py", "(marker.value < 0 or", "(False and"),
    Fault("another table beside", "roughness/formats/sheets.py", "few = 0.25", "few = 2.0"),
    Fault("netCDF 3 not scaled", "roughness/formats/classic.py", "found * scale[0]", "found"),
    Fault("high pass of first order", "roughness/steps/base.py", "order=FILTER.gentle", "order=1"),
    Fault(
        "resampled with aliases",
        "roughness/steps/resampled.py",
        "if step > old * (1 + 1e-6):",
        "if step > old * (1 + 1e6):",
    ),
    Fault("spikes left in", "roughness/steps/repaired.py", "column[out] = np.interp", "_ = np.interp"),
    Fault(
        "mirror doubles its end", "roughness/steps/mirrored.py", "% (2 * last) - last", "% (2 * last + 1) - last"
    ),
    Fault("fault by the name in Python", "roughness/preparation.py", "key_of.get(fault.name, ", "("),
    Fault("short for long waves", "roughness/steps/low_passed.py", '"shorter", wavelength', '"longer", wavelength'),
    Fault("steps exclude nothing", "roughness/preparation.py", "if step.without in asked and", "if"),
    Fault("steps forgotten", "roughness/steps/base.py", "steps=(*profile.steps, sentence)", "steps=(sentence,)"),
    Fault(
        "fitted beyond the content",
        "roughness/fitting.py",
        "start + _until_cliff(log_n",
        "log_n.size + 0 * len(log_n",
    ),
    Fault(
        "fitted below the content", "roughness/fitting.py", "return end - _until_cliff", "return 0 * _until_cliff"
    ),
    Fault("long waves that bend cut off", "roughness/fitting.py", "beyond = max(slope, 0.0)", "beyond = 0.0"),
    Fault(
        "corner of a filter fitted", "roughness/fitting.py", "(below[:end] < FIT.kept)", "(below[:end] < np.inf)"
    ),
    Fault("any spectrum a power law", "roughness/fitting.py", "> FIT.largest_misfit:", "> np.inf:"),
    Fault("class from far away", "roughness/fitting.py", "if not near or", "if"),
    Fault("no doubt about a class", "roughness/fitting.py", "< to_the_next", "< np.inf"),
    Fault(
        "equal paths told apart",
        "roughness/profile.py",
        "setdefault(blake2b(column + 0.0).digest()",
        "setdefault(bytes([path])",
    ),
    Fault(
        "remembered: excitation of another journey",
        "roughness/excitation.py",
        "== (start, distance, blend)",
        "[:1] == (start,)",
    ),
    Fault("remembered: other contacts", "roughness/excitation.py", "known.touch.told == touch.told", "True"),
    Fault(
        "compiled: a spline kinked at its end", "_basics/compiled.py", "(width - both * above[size - 2])", "width"
    ),
    Fault(
        "compiled: prediction from all errors",
        "_basics/compiled.py",
        "for n in range(size - step):\n            power",
        "for n in range(size):\n            power",
    ),
    Fault(
        "compiled: predicted backwards",
        "_basics/compiled.py",
        "record[n - 1 - before]",
        "record[n - order + before]",
    ),
]
