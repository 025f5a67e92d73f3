"""Files and lines of commits: python tools/effort.py COMMIT … [--table].

What each added (and took away), split into new files of the package, tests, documentation (README, CHANGELOG,
CONTRIBUTING, docs, examples), and what it had to change elsewhere in the package: the price of an addition.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from typing import NamedTuple

PARTS = ("new", "elsewhere", "tests", "docs", "other")


class Change(NamedTuple):
    """One file of a commit."""

    path: str
    new: bool
    added: int
    removed: int

    @property
    def part(self) -> str:
        """Which of `PARTS` it belongs to."""
        if self.path.startswith("src/"):
            return "new" if self.new else "elsewhere"
        if self.path.startswith("tests/"):
            return "tests"
        return "docs" if self.path.startswith(("docs/", "examples/")) or self.path.endswith(".md") else "other"


def git(*arguments: str) -> list[str]:
    """Lines that a git command prints."""
    done = subprocess.run(["git", *arguments], capture_output=True, text=True, check=True)
    return done.stdout.splitlines()


def changes(commit: str) -> list[Change]:
    """List the files of a commit, against its first parent."""
    span = f"{commit}^1", commit
    new = set(git("diff", "--no-renames", "--diff-filter=A", "--name-only", *span))
    found = []
    for line in git("diff", "--no-renames", "--numstat", *span):
        added, removed, path = line.split("\t")
        # What is binary has no lines.
        found.append(Change(path, path in new, *(0 if n == "-" else int(n) for n in (added, removed))))
    return found


def summed(some: list[Change]) -> str:
    """Files and lines of a part."""
    if not some:
        return "-"
    files = f"{len(some)} file" + ("s" if len(some) > 1 else "")
    added, removed = sum(change.added for change in some), sum(change.removed for change in some)
    return f"{files} +{added}" + (f" -{removed}" if removed else "")


def main(arguments: list[str] | None = None) -> int:
    """Print each commit with its parts, or one line of a table for each."""
    parser = argparse.ArgumentParser(prog="effort.py", description=__doc__.splitlines()[0])
    parser.add_argument("commits", nargs="+", metavar="COMMIT")
    parser.add_argument("--table", action="store_true", help="lines of a Markdown table")
    options = parser.parse_args(arguments)
    if options.table:
        print("| commit | new | elsewhere in src | tests | docs | other |\n|---|---|---|---|---|---|")
    for commit in options.commits:
        (head,) = git("log", "-1", "--format=%h %s", commit)
        found = changes(commit)
        parts = {part: [change for change in found if change.part == part] for part in PARTS}
        if options.table:
            print(f"| {head} | " + " | ".join(summed(parts[part]) for part in PARTS) + " |")
            continue
        print(head)
        for part, some in parts.items():
            if some:
                print(f"  {part:10} {summed(some)}")
                for change in some:
                    print(f"    {change.path} +{change.added}" + (f" -{change.removed}" if change.removed else ""))
    return 0


if __name__ == "__main__":
    sys.exit(main())
