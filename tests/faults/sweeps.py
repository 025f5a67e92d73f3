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
    Fault("made of another table", "scenarios/reading.py", "(repr(table), repr(beside))", "(path, repr(beside))"),
    Fault("road of another way", "scenarios/reading.py", "(repr(table), repr(beside))", "(repr(table), path)"),
    Fault(
        "length of its own ignored",
        "scenarios/roads.py",
        "if length is None:\n            return",
        "if True:\n            return",
    ),
    Fault("origin ignored", "scenarios/roads.py", "self.first if origin is None else origin", "self.first"),
    Fault(
        "origin of a road as long as its journey",
        "scenarios/roads.py",
        "if length is None:\n                    check",
        "if False:\n                    check",
    ),
    Fault("made for every speed", "scenarios/roads.py", "keys=keys, beside=where)", "keys=keys)"),
    Fault(
        "parts made for every speed",
        "scenarios/reading.py",
        "build = self._taken if given else self._built",
        "build = self._built",
    ),
    Fault("nothing forgotten", "scenarios/reading.py", "while len(made) > most:", "while False:"),
    Fault(
        "roads that lie still taken for others",
        "scenarios/roads.py",
        '[(lies["length"], lies["start"])]',
        "[way]",
    ),
    Fault("vehicles of other lengths unsaid", "studies/sweep/plan.py", '("run", "vehicle")', '("run",)'),
    Fault(
        "the last of many overlooked",
        "studies/sweep/plan.py",
        "[*range(min(size, 16)), size - 1]",
        "[*range(min(size, 16))]",
    ),
    Fault(
        "what the road is along another axis overlooked",
        "studies/sweep/plan.py",
        "for kind in some(whole):",
        "for kind in some(whole)[:1]:",
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
    Fault(
        "number that no worker is told",
        "studies/sweep/workers.py",
        "for number in chunks))",
        "for number in chunks[1:]))",
    ),
    Fault(
        "names of files as one calls them",
        "studies/sweep/plan.py",
        "for axis in axes)], folder.resolve())",
        "for axis in axes)], folder)",
    ),
    Fault("worker of another version", "studies/sweep/cluster.py", "if there[name] != needed[name]]", "if False]"),
    Fault("worker with other files", "studies/sweep/cluster.py", "        plan.require_files()", "        pass"),
    Fault(
        "lost with a worker, and given up",
        "studies/sweep/cluster.py",
        'if task.status == "cancelled":',
        'if task.status in ("cancelled", "lost"):',
    ),
    Fault("chunk that never comes", "studies/sweep/cluster.py", 'if task.status == "error":', "if False:"),
    Fault(
        "function that ends who cannot load it",
        "studies/sweep/cluster.py",
        "(call, function, number, name)",
        "(chunk_of, number, name)",
    ),
    Fault(
        "chunk under another number",
        "studies/sweep/cluster.py",
        "client.get(graph, keys, sync=False)",
        "client.get(graph, keys[::-1], sync=False)",
    ),
    Fault("cluster of nobody", "studies/sweep/cluster.py", "if not address.strip():", "if False:"),
    Fault("words of dask", "studies/sweep/cluster.py", "    logging.disable()\n", "    pass\n"),
    Fault(
        "folder before there is a scheduler",
        "studies/sweep/sweep.py",
        "        with scheduler_at(cluster) as client:\n            stored = InFolder(folder, plan)\n",
        "        stored = InFolder(folder, plan)\n        with scheduler_at(cluster) as client:\n",
    ),
    Fault(
        "disk said to be full where others computed",
        "commands/main.py",
        "except (ChildProcessError, ConnectionError) as error:",
        "except ZeroDivisionError as error:",
    ),
    Fault(
        "workers beside a cluster",
        "commands/studies.py",
        "if workers is not None and cluster is not None:",
        "if False:",
    ),
    Fault("files of another folder", "scenarios/variants.py", "_from_here(tables[name], there)", "tables[name]"),
    Fault(
        "crossed at the solved case", "studies/sweep/page/answers.py", "share = over[within] / (", "share = 0 / ("
    ),
    Fault(
        "below for above",
        "studies/sweep/page/seen.py",
        "if self.below else values >",
        "if not self.below else values >",
    ),
    Fault(
        "what has no answer within limits",
        "studies/sweep/page/answers.py",
        "or not np.isfinite(over[outside])",
        "or False",
    ),
    Fault(
        "limit of another unit", "studies/sweep/page/seen.py", "value = scale * limit.value", "value = limit.value"
    ),
    Fault(
        "another contact limited",
        "studies/sweep/page/seen.py",
        "np.where(places == limit.place, values",
        "np.where(places != limit.place, values",
    ),
    Fault("rotations felt as motions", "studies/sweep/page/seen.py", "np.where(turning, np.nan, values)", "values"),
    Fault(
        "best of what is not drawn",
        "studies/sweep/page/choice.py",
        "np.nanmin(turned, axis=-1) if below else np.nanmax",
        "np.nanmax(turned, axis=-1) if below else np.nanmin",
    ),
    Fault(
        "exchanged samples counted",
        "studies/sweep/page/samples.py",
        'slice(2 * int(drawn["samples"]) if',
        "slice(None if",
    ),
    Fault(
        "certain shares", "studies/sweep/page/shares.py", "rng.integers(base, size=base)", "rng.permutation(base)"
    ),
    Fault(
        "means of what is missing",
        "studies/sweep/page/reaches.py",
        "np.isfinite(lines).all(axis=0)",
        "np.isfinite(lines).any(axis=0)",
    ),
    Fault(
        "variance that classes make",
        "studies/sweep/page/samples.py",
        "within / (values.size - classes)",
        "within / (values.size - 1)",
    ),
    Fault(
        "map on its side",
        "studies/sweep/page/choice.py",
        "for dim in (chosen.along, chosen.across) if dim]",
        "for dim in (chosen.across, chosen.along) if dim]",
    ),
    Fault("files in any order", "studies/sweep/words.py", "found = sorted(name for", "found = list(name for"),
    Fault("files from elsewhere", "studies/sweep/words.py", "root_dir=folder", "root_dir=None"),
    Fault(
        "steps found though they vary",
        "studies/sweep/plan.py",
        'stated=time_step is not None or histories or "run.time_step" in spanned.paths',
        "stated=time_step is not None",
    ),
    Fault("step not told", "studies/sweep/ways.py", "codes, step, found.turned", "codes, np.nan, found.turned"),
    Fault("histories of coarse steps", "studies/sweep/ways.py", "step=step / found.finer", "step=step"),
    Fault("observed too coarsely", "response/sampling.py", "observed: float = 0.4", "observed: float = 1.6"),
]
