"""Sweeps: what varies, the order of the cases, chunks, and what is made of their measures."""

from __future__ import annotations

from tests.faults.fault import Fault

FAULTS = [
    Fault("cases at other places", "studies/sweep/sweep.py", "np.ravel_multi_index(places, shape)", "len(places)"),
    Fault(
        "order of the axes taken for theirs",
        "studies/sweep/axes.py",
        "places[axis]) for axis in range",
        "list(places.values())[axis]) for axis in range",
    ),
    Fault(
        "values in the tables of others",
        "scenarios/variants.py",
        "return {**tables, name:",
        "tables[name] = value; return {**tables, name:",
    ),
    Fault(
        "scenario that is not varied",
        "scenarios/variants.py",
        "tables = changed(tables, names, there)",
        "tables = tables if changed(tables, names, there) else {}",
    ),
    Fault(
        "made of another table", "scenarios/reading.py", "(repr(tables[key]), *([] if stays", "(key, *([] if stays"
    ),
    Fault(
        "road of another way",
        "scenarios/reading.py",
        "if stays else given.values())",
        "if True else given.values())",
    ),
    Fault(
        "impossible case that ends all",
        "studies/sweep/solving.py",
        "except (ValueError, SolveError) as refused:",
        "except SolveError as refused:",
    ),
    Fault(
        "compiled as it comes",
        "studies/sweep/solving.py",
        "with compiling(numba_is_there()):",
        "with compiling(None):",
    ),
    Fault("chunks of another sweep", "studies/sweep/chunks.py", "if text == plan.text:", "if True:"),
    Fault("every chunk again", "studies/sweep/chunks.py", "if not self._file(number).exists()", "if True"),
    Fault("part of others", "studies/sweep/sweep.py", "number % part[1] == part[0] - 1", "number % part[1] == 0"),
    Fault("last case left out", "studies/sweep/chunks.py", "+ 1) * size, cases)", "+ 1) * size, cases - 1)"),
    Fault("worker that nobody misses", "studies/sweep/workers.py", "if process.returncode:", "if False:"),
    Fault("workers that live on", "studies/sweep/workers.py", "process.kill()", "pass"),
    Fault(
        "last number left out", "studies/sweep/words.py", "list(range(first, last + 1))", "list(range(first, last))"
    ),
    Fault(
        "keys that do not vary together",
        "studies/sweep/words.py",
        "[*zip(*columns, strict=True)] if len(keys) > 1",
        "[*zip(*columns[::-1], strict=True)] if len(keys) > 1",
    ),
    Fault(
        "mixed the wrong way",
        "studies/sweep/design.py",
        "one[:, key] = second[:, key]",
        "one[:, key] = first[::-1, key]",
    ),
    Fault(
        "range the wrong way",
        "studies/sweep/design.py",
        "low + (high - low) * np.asarray(share)",
        "high + (high - low) * np.asarray(share)",
    ),
    Fault(
        "worst where it is best",
        "studies/sweep/page/seen.py",
        "np.nanargmin(self.worst) if self.below else np.nanargmax",
        "np.nanargmax(self.worst) if self.below else np.nanargmin",
    ),
    Fault(
        "unit of another degree of freedom",
        "studies/sweep/files.py",
        '-1 if units.values[number] == "rad" else 0',
        "0",
    ),
    Fault("files forgotten", "scenarios/variants.py", "found |= contents(tables, there)", "pass"),
    Fault("files of another folder", "scenarios/variants.py", "_from_here(tables[name], there)", "tables[name]"),
]
