"""What is written and printed, whole or not at all, and how the command ends where it is told to."""

from __future__ import annotations

from tests.faults.fault import Fault

FAULTS = [
    Fault("report of another run that stays", "_basics/output.py", "target.unlink(missing_ok=True)", "pass"),
    # Files.
    Fault(
        "file that is written where it stands",
        "_basics/output.py",
        "file, target = temporary / str(number), folder / name",
        "file, target = folder / name, folder / name",
    ),
    Fault("folder made for nothing", "_basics/output.py", "each.rmdir()", "pass"),
    Fault("temporary place in a message", "_basics/output.py", "or str(error), str(place))", "or str(error))"),
    Fault("link that is replaced", "_basics/output.py", "path.resolve() if path.is_symlink()", "path if True"),
    Fault("pipe that is replaced", "_basics/output.py", "not path.is_file() and not", "path.is_file() and not"),
    Fault("text in other letters", "_basics/output.py", 'encode("utf-8", "replace")', 'encode("latin-1")'),
    Fault("clock in a file", "_basics/matlab_file.py", "    made.seek(0)\n", "    made.seek(0, 2)\n"),
    Fault("array cut short silently", "roughness/formats/hdf_child.py", "        sys.exit(4)", "        pass"),
    # Standard output.
    Fault("letters that are refused", "commands/streams.py", '"replace", line', '"strict", line'),
    Fault(
        "nameless standard output",
        "commands/main.py",
        "error.filename == StandardStream.OUTPUT and placed",
        "False",
    ),
    Fault("end before all is said", "commands/main.py", "            stream.flush()", "            pass"),
    Fault(
        "scenario in the letters of the console",
        "commands/console.py",
        'sys.stdout.reconfigure(encoding="utf-8")',
        "sys.stdout.flush()",
    ),
    # Told to end.
    Fault("heard too late", "__init__.py", "    heed()  # before", "    pass  # before"),
    Fault(
        "heard by others",
        "_basics/ending.py",
        '.partition(".")[0] in ("movingfrf", "movingfrf-script")',
        '.startswith("m")',
    ),
    Fault("heard although ignored", "_basics/ending.py", "!= _signal.SIG_IGN:", "is not None:"),
    Fault("exception in place of an end", "_basics/ending.py", "    os._exit(128 + number)", "    sys.exit(130)"),
    Fault("nothing written, though it was", "_basics/ending.py", "if placed else", "if not placed else"),
    Fault("half a set", "_basics/output.py", "with undisturbed():", "with suppress(ValueError):"),
    Fault("interrupt that is swallowed", "_basics/undoing.py", "signal.raise_signal(got)", "int(got)"),
    Fault("place of a full disk unsaid", "_basics/undoing.py", ", while it is {doing} in {folder.parent}", ""),
    Fault(
        "full disk taken for a damaged sheet",
        "roughness/formats/sheet_child.py",
        "        sys.exit(4)",
        "        sys.exit(3)",
    ),
    Fault("nameless export", "results/export.py", "with naming(file):", "with naming(Path()):"),
    Fault("child that runs on", "_basics/undoing.py", "undone(process.kill)", "undone(int)"),
]
