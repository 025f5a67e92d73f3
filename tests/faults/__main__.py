"""Run deliberate faults: `python -m tests.faults [--parts] [--list] [--part PART] [name …]`.

Each fault changes one piece of text in a copy of the package; the laws and the analytic tests then run against
the copy and must fail. A fault that survives is a gap in the tests.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from tests.faults import PARTS, covers, faults_of, stale
from tests.faults.fault import ROOT, Fault

# Run in this order; the first failure ends the run. A fault changes what its text says, so the test of the
# texts themselves stays out.
SELECTION = [
    "tests/test_remembered.py",
    "tests/analytic",
    "tests/laws/test_vehicles.py",
    "tests/laws/test_coupled.py",
    "tests/laws/test_guideways.py",
    "tests/laws/test_properties.py",
    "tests/laws/test_truncation.py",
    "tests/laws/test_switched_loads.py",
    "tests/laws/test_cases.py",
    "tests/laws/test_trains.py",
    "tests/laws/test_random.py",
    "tests/laws/test_random_statistics.py",
    "tests/test_roads.py",
    "tests/test_one_path.py",
    "tests/test_random_command.py",
    "tests/test_door.py",
    "tests/test_matlab_vehicles.py",
    "tests/test_words.py",
    "tests/test_in_the_hand.py",
    "tests/test_export.py",
]

# These first where it lies in how files of arrays and texts are taken apart.
FILES = ["tests/test_matlab_vehicles.py", "tests/test_toml_words.py"]

# These first where the fault lies in files of profiles, what is done to them and what is said of them.
PROFILES = [
    "tests/test_gaps.py",
    "tests/test_more_tables.py",
    "tests/test_tables.py",
    "tests/test_preparation.py",
    "tests/test_classic_files.py",
    "tests/test_roles.py",
    "tests/test_recordings.py",
    "tests/test_choice.py",
    "tests/test_even_and_digits.py",
    "tests/test_readers.py",
    "tests/test_readers_binary.py",
    "tests/test_profile_description.py",
]

ABOUT_PROFILES = (
    "roughness/fi",
    "roughness/gaps",
    "roughness/formats",
    "roughness/preparation",
    "roughness/steps",
    "roughness/profile",
    "metrics/profile",
    "reports/profile",
    "roughness/sentinels",
    "_basics/wording",
)

# These first where the fault lies in what is shown: figures, tables, files.
REPORTS = [
    "tests/test_export.py",
    "tests/test_plots.py",
    "tests/test_measure_command.py",
    "tests/test_random_command.py",
    "tests/test_report.py",
    "tests/test_cli.py",
    "tests/test_kinds_command.py",
]
# These first where it is one of how files are written, and how the command ends.
WRITTEN = ["tests/test_disks.py", "tests/test_interrupts.py"]
# These where it lies in what a user writes.
SCENARIOS = [
    "tests/test_force_files.py",
    "tests/test_scenario.py",
    "tests/test_schema.py",
    "tests/test_sampled_files.py",
    "tests/test_roads.py",
    "tests/test_vehicle_scenarios.py",
    "tests/test_finite_scenarios.py",
]
SHOWN = ("reports/", "commands/", "results/files", "results/export", "_basics/wording")

# These first where the fault lies in what is sampled where.
SAMPLED = (
    "response/sampling",
    "response/influence",
    "response/accuracy",
    "response/line",
    "roughness/excitation",
    "roughness/along",
)
SAMPLING = ["tests/analytic/test_excitation.py", "tests/analytic/test_sampling.py", "tests/test_honest.py"]

# These first where the fault lies in the independent way, and last otherwise.
REFERENCE = [
    "tests/stepping/test_elements.py",
    "tests/stepping/test_enveloping.py",
    "tests/stepping/test_sampled.py",
    "tests/stepping/test_record.py",
    "tests/stepping/test_coupled.py",
    "tests/stepping/test_coupled_laws.py",
    "tests/stepping/test_duhamel.py",
    "tests/stepping/test_refusals.py",
    "tests/stepping/test_impulse.py",
    "tests/stepping/test_schemes.py",
    "tests/stepping/test_plate.py",
    "tests/stepping/test_plate_travel.py",
]

# Two processes share the machine, each on one core.
AT_A_TIME, LIMIT = 2, 600


def selection(fault: Fault | None) -> list[str]:
    """List what runs against a fault: first the tests that lie next to it."""
    file = fault.file if fault else ""
    if file == "_basics/checks.py":
        return ["tests/test_door.py", *SELECTION]
    if fault in faults_of("written"):
        return WRITTEN + SELECTION
    if file.endswith(("compiled.py", "lanes.py")):
        return ["tests/laws/test_compiled.py", *SELECTION, *REFERENCE]
    if file.startswith(SAMPLED):
        return [*SAMPLING, *SELECTION, *REFERENCE]
    independent = file.startswith(("stepping/", "guideways/sampled", "guideways/record", "guideways/files"))
    if file.startswith(("_basics/array_file", "_basics/matlab", "_basics/toml", "vehicles/files")):
        return FILES + PROFILES + SELECTION
    if file.startswith(ABOUT_PROFILES):
        return PROFILES + SELECTION + REFERENCE
    if file == "studies/sweep/cluster.py":
        return ["tests/test_cluster.py"]
    if fault in faults_of("optimise"):
        return ["tests/test_optimise.py"]
    if file.startswith("studies/sweep") or fault in faults_of("sweeps"):
        return [
            "tests/test_sweep_steps.py",
            "tests/test_roads_by_seed.py",
            "tests/test_sweep_page.py",
            "tests/test_sweep.py",
            "tests/test_designs.py",
            "tests/test_cluster.py",
            *SELECTION,
        ]
    if file.startswith("scenarios/"):
        return SCENARIOS + SELECTION
    if file.startswith(SHOWN):
        return REPORTS + SELECTION + REFERENCE
    chosen = REFERENCE + SELECTION if independent else SELECTION + REFERENCE
    return sorted(chosen, key=lambda tests: "plate" not in tests) if "plate" in file else chosen


# Prints where the package came from, so that a run cannot quietly test the original.
RUN = """
import sys
from pathlib import Path
import movingfrf, pytest
assert Path(movingfrf.__file__).is_relative_to(Path.cwd()), movingfrf.__file__
sys.exit(pytest.main(sys.argv[1:]))
"""


def outcome(fault: Fault | None) -> tuple[int, str]:
    """Run the tests against a copy, with a fault or without: exit status and the first test that failed."""
    with tempfile.TemporaryDirectory(prefix="movingfrf-fault-") as folder:
        copy = Path(folder).resolve()
        for part in ("src", "tests", "docs", "examples"):
            shutil.copytree(ROOT / part, copy / part, ignore=shutil.ignore_patterns("__pycache__"))
        for file in ("pyproject.toml", "README.md"):
            shutil.copy(ROOT / file, copy)
        if fault:
            path = copy / "src" / "movingfrf" / fault.file
            path.write_text(path.read_text().replace(fault.old, fault.new))
        environment = os.environ | {
            "PYTHONPATH": os.pathsep.join([str(copy / "src"), str(copy)]),
            "PYTHONDONTWRITEBYTECODE": "1",
            "OMP_NUM_THREADS": "1",
            "OPENBLAS_NUM_THREADS": "1",
        }
        command = [sys.executable, "-c", RUN, "-x", "-q", "-p", "no:cacheprovider", "--tb=line", *selection(fault)]
        try:
            done = subprocess.run(
                command, cwd=copy, env=environment, capture_output=True, text=True, timeout=LIMIT, check=False
            )
        except subprocess.TimeoutExpired:
            return -1, f"no end within {LIMIT} s"
    failed = re.search(r"^(?:FAILED|ERROR) (\S+)", done.stdout, re.MULTILINE)
    # 0 all passed, 1 a test failed, 2 the copy could not even be collected; anything else is no verdict.
    return done.returncode, failed.group(1) if failed else (done.stdout + done.stderr)[-2000:]


def main() -> int:
    """Run the faults, two at a time."""
    parser = argparse.ArgumentParser(prog="python -m tests.faults", description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="only faults whose name contains one of these texts")
    parser.add_argument("--part", action="append", choices=PARTS, help="only this part; again for another")
    parser.add_argument("--parts", action="store_true", help="say what each part covers and run nothing")
    parser.add_argument("--list", action="store_true", help="list the faults and run nothing")
    options = parser.parse_args()
    if options.parts:
        for part in PARTS:
            print(f"{part:12}{len(faults_of(part)):4} faults  {covers(part)}")
        return 0
    listed = [fault for part in options.part or PARTS for fault in faults_of(part)]
    chosen = [f for f in listed if not options.names or any(text in f.name for text in options.names)]
    if options.list:
        for fault in chosen:
            print(f"{fault.name:40} {fault.file}")
        return 0
    if not chosen:
        print("no fault of such a name")
        return 1
    if outdated := stale():
        print("\n".join(["no longer in the source:", *outdated]))
        return 1
    status, message = outcome(None)
    if status != 0:
        print(f"without any fault the tests do not pass: {message}")
        return 1
    survived = 0
    with ThreadPoolExecutor(AT_A_TIME) as pool:
        for fault, (status, message) in zip(chosen, pool.map(outcome, chosen), strict=True):
            killed = status in (1, 2)  # the package may refuse a fault itself, before any test runs
            survived += not killed
            print(
                f"{fault.name:40} {'killed by ' + message if killed else f'SURVIVED ({status}) {message}'}",
                flush=True,
            )
    print(f"{len(chosen) - survived} of {len(chosen)} faults killed")
    return 1 if survived else 0


if __name__ == "__main__":
    sys.exit(main())
