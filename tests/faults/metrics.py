"""Comfort, loads, fatigue, indices of a profile, decay along a track."""

from __future__ import annotations

from tests.faults.fault import Fault

FAULTS = [
    # Random roads.
    Fault("history taken for a spectrum", "metrics/fatigue.py", 'kind_of(result) != "random"', "False"),
    Fault("wide trapezoids", "metrics/fatigue.py", "(0.5 * (gaps[1:]", "(1.0 * (gaps[1:]"),
    # Measures.
    Fault(
        "rounded window of the IRI",
        "metrics/iri.py",
        "- 1, 0), (window**2 - 1) / 12",
        "- 1, 0), (round(window) ** 2 - 1) / 12",
    ),
    Fault("average counted twice", "metrics/iri.py", "(window**2 - 1) / 12", "window**2 / 12"),
    Fault(
        "spline no finer than the stations",
        "metrics/iri.py",
        "pieces = int(np.ceil(step / PROCEDURE.fine))",
        "pieces = 1",
    ),
    Fault("cost of a step turned", "metrics/iri.py", '"lower" if cost < 0', '"lower" if cost > 0'),
    Fault("car starts level", "metrics/iri.py", "zi=[-keep * gain * start]", "zi=[0.0 * gain]"),
    Fault("one mode of the golden car", "metrics/iri.py", "found += 2 * driven.real", "found = 2 * driven.real"),
    Fault(
        "ride number of the mean path",
        "metrics/iri.py",
        "np.sqrt(square.mean(axis=1))",
        "np.sqrt(square).mean(axis=1)",
    ),
    Fault("segments one step late", "metrics/iri.py", "bounds - half, 0", "bounds - half + 1, 0"),
    Fault("step of a weighting turned", "metrics/comfort.py", "* (f5 / f6) ** 2", "* (f6 / f5) ** 2"),
    Fault("transition without its zero", "metrics/comfort.py", "(1 + p / (2 * np.pi * first))", "1"),
    Fault(
        "weighting wraps around",
        "metrics/comfort.py",
        "samples + int(np.ceil(memory / time_step))",
        "samples",
    ),
    Fault("gravity weighted", "metrics/comfort.py", "return values - middle - np", "return values - np"),
    Fault(
        "drift weighted",
        "metrics/comfort.py",
        "- np.multiply.outer(time, slope), middle",
        "+ 0.0 * np.multiply.outer(time, slope), middle",
    ),
    Fault(
        "dose of squares",
        "metrics/comfort.py",
        "**4, axis=0) * time_step) ** 0.25",
        "**2, axis=0) * time_step) ** 0.25",
    ),
    Fault(
        "running rms of a mean",
        "metrics/comfort.py",
        "np.arange(1, len(energy)) - steps, 0)",
        "np.arange(1, len(energy)) - 2 * steps, 0)",
    ),
    Fault("rear axle first", "metrics/loads.py", "(points - start) / speed", "(points + start) / speed"),
    Fault("static load forgotten", "metrics/loads.py", "force = static[contact] + cubic", "force = cubic"),
    Fault("tension wears", "metrics/loads.py", "np.maximum(force, 0.0) ** power", "np.abs(force) ** power"),
    Fault("paths added up", "metrics/loads.py", "np.searchsorted(numbers, paths[contact])", "0 * paths[contact]"),
    Fault(
        "repeatability of the mean",
        "metrics/loads.py",
        "other - other.mean(axis=0)",
        "other - 0.0 * other.mean(axis=0)",
    ),
    Fault(
        "ranges for amplitudes",
        "metrics/fatigue.py",
        "np.abs(second - first) / 2",
        "np.abs(second - first)",
    ),
    Fault(
        "open cycles lost",
        "metrics/fatigue.py",
        "history[: top + 1]]",
        "history[:top]]",
    ),
    Fault(
        "variance for deviation",
        "metrics/fatigue.py",
        "np.log(2 * variance)",
        "np.log(2 * variance**2)",
    ),
    Fault(
        "cycles closed by smaller ones",
        "metrics/fatigue.py",
        ">= abs(waiting[-2] - waiting[-3])",
        "<= abs(waiting[-2] - waiting[-3])",
    ),
    Fault("Dirlik's exponential without its root of two", "metrics/fatigue.py", "(decay / np.sqrt(2))", "(decay)"),
    Fault("since ignored", "metrics/loads.py", "after(resolved(result), since)", "resolved(result)"),
    Fault("wear of the run-in", "metrics/loads.py", "power=power, since=since)", "power=power)"),
    Fault("falling through a level", "metrics/fatigue.py", "np.diff(history) > 0", "np.diff(history) < 0"),
    Fault(
        "accelerance with the wrong sign",
        "metrics/guideway.py",
        "(1j * omega[:, None]) ** POWERS",
        "omega[:, None] ** POWERS",
    ),
    Fault("decay rate: half a step at the end", "metrics/guideway.py", "/ 2, steps[-1:]]", "/ 2, steps[-1:] / 2]"),
    Fault(
        "decay of the nearest wave",
        "metrics/guideway.py",
        "np.abs(kappa.imag).min(axis=0)",
        "np.abs(kappa.imag).max(axis=0)",
    ),
    Fault(
        "damage beyond a Gaussian process", "metrics/fatigue.py", "if not 0 < share <= 1 + rounding:", "if False:"
    ),
    Fault("line that is no narrow band", "metrics/fatigue.py", "if irregularity < 1 - line", "if True"),
    Fault("damage at rest", "metrics/fatigue.py", "if not moment(2):", "if False:"),
    Fault(
        "running rms of the run-in",
        "metrics/comfort.py",
        "squares = histories[samples_before(since, time_step, len(histories)) :]",
        "squares = histories",
    ),
    Fault("damage of a negative life", "metrics/fatigue.py", "if not 0 < share <= 1", "if not share <= 1"),
    Fault("impact without the load", "metrics/impact.py", "high = load +", "high ="),
    Fault("median impact of a random road", "metrics/impact.py", "inv_cdf(CUSTOMARY / 100)", "inv_cdf(0.5)"),
    Fault("load that hangs divides", "metrics/loads.py", "where=load > 0)", "where=load != 0)"),
    Fault("load that hangs wears", "metrics/loads.py", "max(static[contact], 0.0)", "static[contact]"),
    Fault("points beyond memory", "metrics/loads.py", "(last - first) / spacing * (bytes", "0 * (bytes"),
    Fault("window longer than the road", "metrics/iri.py", "elif shortest > length:", "elif False:"),
    Fault("feet felt like the seat", "metrics/totals.py", "[ISO_2631.seated[name] for name in felt]", "1.0"),
    Fault(
        "histories mixed",
        "metrics/comfort.py",
        "array.reshape(len(array), -1)",
        "array.reshape(-1, 1)",
    ),
    # Profiles from files.
    Fault(
        "mean left in the spectrum", "_basics/welch.py", " - columns[start : start + length].mean(axis=0)", " + 0"
    ),
    Fault("last line counted twice", "_basics/welch.py", "if length % 2 == 0:", "if False:"),
    Fault("trend left in the spectrum", "_basics/welch.py", "piece -= np.outer", "_ = np.outer"),
    Fault("coherence of amplitudes", "metrics/profile.py", "(real**2 + imaginary**2)", "np.hypot(real, imaginary)"),
    Fault("edges counted with spikes", "metrics/profile.py", "np.flatnonzero(peak & (bend", "np.flatnonzero((bend"),
    Fault(
        "millimetres pass for metres",
        "metrics/profile.py",
        "if path.fit.roughness_at_two > ODDITIES.density or path.index > ODDITIES.index:",
        "if path.fit.roughness_at_two > 1e9 or path.index > 1e9:",
    ),
    Fault(
        "segments from the first station on",
        "metrics/profile.py",
        "np.ceil((first - step / 2) / span)",
        "(first / span)",
    ),
    Fault(
        "segments across gaps unmarked",
        "metrics/profile.py",
        "pieces[longest].paths), np.nan)",
        "pieces[longest].paths), 0.0)",
    ),
    Fault("index of markers", "metrics/profile.py", "found[:, marked] = np.nan", "pass"),
    Fault("one level stretch of many", "metrics/profile.py", "[: ODDITIES.most_stretches]", "[:1]"),
    # What is left out, told apart, cut and refused.
    Fault(
        "vehicle that never runs in",
        "metrics/entry.py",
        "after(self.whole, self.since)",
        "after(self.whole, 0.0)",
    ),
    Fault(
        "weighting that starts anew",
        "metrics/comfort.py",
        "felt(weighted(acceleration, time_step, weighting)[first:], ",
        "felt(weighted(np.asarray(acceleration)[first:], time_step, weighting), ",
    ),
    Fault("limit the other way", "metrics/listed.py", "if name in felt.exceeded", "if name not in felt.exceeded"),
    Fault("one refusal for all", "metrics/entry.py", "if common_points(self.result).size", "if True"),
]
