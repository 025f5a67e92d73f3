"""Calls between rooms while a scenario runs and what is built on it: who calls whom, and how often.

    python tools/calls.py [--duration SECONDS] [--modules] [CASE …]     cases: run, random, compare, profile

A call that leads from a lower room back to a higher one is marked and ends with status 1: a callback, a method of
an object that a lower room should not know. Frames outside the package are looked through, and so are what
remembers (`_basics.remembered`) and what loads compiled loops (`_basics.compiling`): whoever asks is who calls.
PYTHONPATH=…/src looks at another checkout, by the rooms that its own tests name. Progress is silent.
"""

from __future__ import annotations

import argparse
import importlib.util
import sys
import threading
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import FrameType
from typing import NamedTuple

import movingfrf as mf

SOURCE = Path(mf.__file__).parent
SEEN_THROUGH = {"_basics.remembered", "_basics.compiling"}


def levels() -> dict[str, int]:
    """Room → number of its layer from the bottom, as the tests of the checkout under PYTHONPATH name them."""
    spec = importlib.util.spec_from_file_location("rooms", SOURCE.parents[1] / "tests" / "rooms.py")
    rooms = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(rooms)
    return rooms.LEVEL


class Call(NamedTuple):
    """From one function to another, each as module (without the package's name) and name."""

    caller: str
    calling: str
    callee: str
    called: str

    @property
    def rooms(self) -> tuple[str, str]:
        """The rooms of both."""
        return self.caller.split(".")[0], self.callee.split(".")[0]


def module_of(frame: FrameType) -> str:
    """Name the package's module that a frame runs in; '' outside, and where a module is being imported."""
    file = frame.f_code.co_filename
    if not file.startswith(str(SOURCE)) or frame.f_code.co_name == "<module>":
        return ""
    name = ".".join(Path(file).relative_to(SOURCE).with_suffix("").parts)
    return "" if name in SEEN_THROUGH else name


@contextmanager
def watched(calls: Counter[Call]) -> Iterator[None]:
    """Count the calls from module to module."""
    modules: dict[object, str] = {}

    def named(frame: FrameType) -> str:
        code = frame.f_code
        if code not in modules:
            modules[code] = module_of(frame)
        return modules[code]

    def look(frame: FrameType, event: str, _: object) -> None:
        if event != "call" or not (callee := named(frame)):
            return
        above = frame.f_back
        while above is not None and not named(above):
            above = above.f_back
        if above is not None and named(above) != callee:
            calls[Call(named(above), above.f_code.co_qualname, callee, frame.f_code.co_qualname)] += 1

    threading.setprofile(look)
    sys.setprofile(look)
    try:
        yield
    finally:
        sys.setprofile(None)
        threading.setprofile(None)


def cases(duration: float) -> dict[str, Callable[[], Callable[[], object]]]:
    """Say what prepares each case, from the scenario of the template, shortened; what it returns is watched."""
    from movingfrf.scenarios.reading import parse_scenario
    from movingfrf.scenarios.template import template

    lines = template("scenario").splitlines()
    text = "\n".join(f"duration = {duration}" if line.startswith("duration") else line for line in lines)
    scenario = parse_scenario(text, name="template")
    drive = getattr(scenario, "case", scenario)  # a scenario was once all in one
    guideway, vehicle, road, speed = drive.guideway, drive.vehicle, drive.road, drive.journey.speed

    # A value remembers what it implies: each run gets one that has not been asked yet.
    def run() -> Callable[[], object]:
        return parse_scenario(text, name="template").run

    def random() -> Callable[[], object]:
        return partial(mf.random_response, replace(guideway), replace(vehicle), road.spectrum, speed=speed)

    def compare() -> Callable[[], object]:
        methods, brief = ["moving-frf", "duhamel", "cdfm"], {"curve": False, "memory": False, "runs": 1}
        return partial(mf.compare, parse_scenario(text, name="template"), methods, **brief)

    def profile() -> Callable[[], object]:
        return partial(mf.describe_profile, road.profile)

    return {"run": run, "random": random, "compare": compare, "profile": profile}


def back(calls: Counter[Call], level: dict[str, int]) -> list[Call]:
    """List the calls from a room to one that does not lie below it."""
    return [call for call in calls if len(set(call.rooms)) == 2 and level[call.rooms[1]] >= level[call.rooms[0]]]


def table(calls: Counter[Call], level: dict[str, int], modules: bool) -> list[str]:
    """Lines to print: for each pair of rooms the edges from module to module, and the calls."""
    lines = []
    pairs = {call.rooms for call in calls if len(set(call.rooms)) == 2}
    for one, other in sorted(pairs, key=lambda pair: (-level[pair[0]], *pair)):
        between = {call: number for call, number in calls.items() if call.rooms == (one, other)}
        edges: Counter[tuple[str, str]] = Counter()
        for call, number in between.items():
            edges[call.caller, call.callee] += number
        mark = "" if level[one] > level[other] else "   <-- leads back"
        lines.append(f"  {one:10} -> {other:10} {len(edges):4} edges {sum(edges.values()):8} calls{mark}")
        if modules:
            lines += [f"      {a} -> {b}  {number}" for (a, b), number in edges.most_common()]
    return lines


def main(arguments: list[str] | None = None) -> int:
    """Watch the cases and print a table of each; 1 if a call leads back."""
    parser = argparse.ArgumentParser(prog="calls.py", description=__doc__.splitlines()[0])
    parser.add_argument("cases", nargs="*", metavar="CASE", help="run, random, compare, profile; all by default")
    parser.add_argument("--duration", type=float, default=2.0, help="of the scenario [s]")
    parser.add_argument("--modules", action="store_true", help="every edge from module to module, too")
    options = parser.parse_args(arguments)
    level, known = levels(), cases(options.duration)
    if unknown := set(options.cases) - set(known):
        parser.error(f"cases are {', '.join(known)}; got {', '.join(sorted(unknown))}")
    warnings.simplefilter("ignore", mf.ValidityWarning)
    wrong = 0
    print(f"calls between rooms of {SOURCE}")
    for name in options.cases or known:
        known[name]()()  # what is imported and compiled at first use is no call
        calls: Counter[Call] = Counter()
        case = known[name]()
        with watched(calls):
            case()
        across = sum(number for call, number in calls.items() if len(set(call.rooms)) == 2)
        edges = len({(call.caller, call.callee) for call in calls if len(set(call.rooms)) == 2})
        leading = back(calls, level)
        wrong += len(leading)
        print(f"{name}: {edges} edges between modules of different rooms, {across} calls, {len(leading)} lead back")
        print("\n".join(table(calls, level, options.modules)))
        for call in leading:
            print(f"  back: {call.caller}.{call.calling} -> {call.callee}.{call.called}, {calls[call]} times")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
