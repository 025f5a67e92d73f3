"""Where solved cases are kept: in memory, or in a folder, a file a chunk, each there whole or not at all."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np

from movingfrf._basics.output import write_whole
from movingfrf.studies.sweep.plan import Plan
from movingfrf.studies.sweep.solving import Solved


@dataclass(frozen=True, slots=True, kw_only=True)
class Chunking:
    """How cases are put together; in brackets, between what each number is safe."""

    cases: int = 64  # of a chunk, where there are few [16 to 1024]
    look: float = 0.02  # between looks at what other processes have solved [s; 0.01 to 1]
    most: int = 4096  # chunks; of more cases twice as many each, and so on [256 to 65 536]
    word: int = 4  # bytes of a number that a worker is told [a convention]
    answer: float = 5.0  # within which the scheduler of a cluster answers [s; 1 to 60]


CHUNKING = Chunking()


def chunk_size(cases: int) -> int:
    """Cases of a chunk: it depends on how many there are in all, and on nothing else."""
    size = CHUNKING.cases
    while size * CHUNKING.most < cases:
        size *= 2
    return size


def chunk_count(cases: int) -> int:
    """Chunks of so many cases."""
    return -(-cases // chunk_size(cases))


def cases_of(number: int, cases: int) -> tuple[int, int]:
    """Say from which of all cases on a chunk goes, and up to which, in the order in which they are solved."""
    size = chunk_size(cases)
    return number * size, min((number + 1) * size, cases)


class Kept(Protocol):
    """Where chunks are kept."""

    def missing(self) -> list[int]:
        """Numbers of the chunks that are not there."""
        ...

    def put(self, number: int, solved: Solved) -> None:
        """Keep a chunk."""
        ...

    def all(self) -> Iterator[Solved]:
        """Go through all chunks in order."""
        ...


class InMemory:
    """Chunks that are gone with the process.

    Parameters
    ----------
    plan : Plan
        The sweep.
    """

    def __init__(self, plan: Plan) -> None:
        self._chunks: list[Solved | None] = [None] * chunk_count(plan.axes.cases)

    def missing(self) -> list[int]:
        """Numbers of the chunks that are not there."""
        return [number for number, chunk in enumerate(self._chunks) if chunk is None]

    def put(self, number: int, solved: Solved) -> None:
        """Keep a chunk."""
        self._chunks[number] = solved

    def all(self) -> Iterator[Solved]:
        """Go through all chunks in order."""
        yield from (chunk for chunk in self._chunks if chunk is not None)


class InFolder:
    """Chunks in a folder, beside what they are chunks of.

    Two that work on one folder at once do no harm: a file appears whole, and whoever wrote it wrote the same.

    Parameters
    ----------
    folder : Path
        The folder; made if it is not there.
    plan : Plan
        The sweep.

    Raises
    ------
    ValueError
        If the folder holds another sweep.
    """

    def __init__(self, folder: Path, plan: Plan) -> None:
        self._folder, self._count = folder, chunk_count(plan.axes.cases)
        said = folder / "sweep.json"
        if said.exists():
            _require_same(said, plan)
        else:
            write_whole(said, plan.text)

    def _file(self, number: int) -> Path:
        return self._folder / "chunks" / f"{number:05d}.npz"

    def missing(self) -> list[int]:
        """Numbers of the chunks that are not there."""
        return [number for number in range(self._count) if not self._file(number).exists()]

    def put(self, number: int, solved: Solved) -> None:
        """Write a chunk, whole or not at all."""
        self.store(number, as_bytes(solved))

    def store(self, number: int, content: bytes) -> None:
        """Write what `as_bytes` made of a chunk, whole or not at all."""
        write_whole(self._file(number), content)

    def all(self) -> Iterator[Solved]:
        """Read all chunks in order."""
        yield from (of_file(self._file(number)) for number in range(self._count))


def _require_same(file: Path, plan: Plan) -> None:
    """Refuse a folder that holds another sweep, with what it differs by."""
    text = file.read_text(encoding="utf-8")
    if text == plan.text:
        return
    try:
        there = json.loads(text)
    except ValueError:
        there = {}
    here = plan.told
    off = [key for key in here if here[key] != there.get(key)] if isinstance(there, dict) else list(here)
    raise ValueError(
        f"{file.parent} holds another sweep: it differs in {', '.join(off) or 'how it is written'}; "
        "choose another folder, or remove this one"
    )


def as_bytes(solved: Solved) -> bytes:
    """Put a chunk into bytes: equal chunks, equal bytes."""
    arrays: dict[str, np.ndarray] = {}
    for name, each in solved.values.items():
        arrays[f"{name}.sizes"] = np.array([values.size for values in each])
        arrays[name] = np.concatenate([np.zeros(0), *each])
    told = json.dumps([solved.contacts, solved.dofs, solved.units, solved.status, solved.findings])
    arrays["steps"] = np.array(solved.steps)
    for number, histories in enumerate(solved.histories):
        arrays |= {f"{number}.{name}": values for name, values in histories.items()}
    buffer = io.BytesIO()
    np.savez(buffer, **arrays, told=np.frombuffer(told.encode(), np.uint8))  # type: ignore[arg-type]
    return buffer.getvalue()


def of_file(file: Path) -> Solved:
    """Read what `as_bytes` wrote.

    Raises
    ------
    ValueError
        If it is damaged.
    """
    try:
        with np.load(io.BytesIO(file.read_bytes())) as arrays:
            told = json.loads(arrays["told"].tobytes())
            names = [name.removesuffix(".sizes") for name in arrays.files if name.endswith(".sizes")]
            steps = arrays["steps"].tolist()
            histories: list[dict[str, np.ndarray]] = [{} for _ in steps]
            for name in arrays.files:
                number, point, history = name.partition(".")
                if number.isdecimal() and point:
                    histories[int(number)][history] = arrays[name]
            values = {
                name: np.split(arrays[name], np.cumsum(arrays[f"{name}.sizes"])[:-1].astype(int)) for name in names
            }
    except (ValueError, KeyError, EOFError, zipfile.BadZipFile):
        raise ValueError(f"{file}: is damaged; remove it, and it is computed again") from None
    contacts, dofs, units = ([tuple(names) for names in part] for part in told[:3])
    return Solved(values, contacts, dofs, units, told[3], told[4], steps, histories)
