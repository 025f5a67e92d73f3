"""ERD, the files of UMTRI's Engineering Research Division: a header of keywords, then numbers as text or binary."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import numpy as np

from movingfrf._basics import wording
from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.output import Content
from movingfrf.roughness.formats import columns as text
from movingfrf.roughness.formats.base import (
    Format,
    RawProfile,
    Wanted,
    bytes_of,
    chosen_columns,
    listed,
    scaled,
    units_taken,
)
from movingfrf.roughness.formats.fields import Table, numbers
from movingfrf.roughness.formats.roles import kind_of_unit, scales_of
from movingfrf.roughness.profile import Profile


@dataclass(frozen=True, slots=True, kw_only=True)
class Header:
    """What the lines above the numbers are like; a line with & continues the names of the line before."""

    signature: str = "ERDFILEV"
    field: int = 8  # characters of the keyword, and of each name
    longest: int = 2**20  # bytes, and channels: a header is short, what is longer is none [a convention]


HEADER = Header()

# How numbers are stored, by the fifth number of the second line: binary, or None for text.
STORED: dict[int, np.dtype[np.generic] | None] = {
    0: np.dtype("<i2"),
    1: np.dtype("<f4"),
    2: np.dtype("<f8"),
    5: None,
}
ENCODINGS = {"text": 5, "float": 1, "double": 2}


def read(path: Path, wanted: Wanted) -> RawProfile:
    """Read an ERD file; binary numbers lie beside it, in a file of its name that ends in .bin."""
    data = bytes_of(path)
    header, body, below = _split(data)
    count, samples, key, step = _storage(header)
    words = {line[: HEADER.field].strip().upper(): line[HEADER.field :] for line in header[2:]}
    for keyword in ("GAIN", "OFFSET"):
        if any(word.startswith(keyword) for word in words):
            raise ValueError(f"scales its numbers by {keyword}, which is not understood")
    names = _fields(header, "SHORTNAM", count)
    units = _fields(header, "UNITSNAM", count)
    used = list(range(count)) if wanted.columns is None else chosen_columns(names, wanted.columns)
    along, *taken = units_taken([words.get("XUNITS", "").strip(), *(units[n] for n in used)], wanted.units)
    timed = kind_of_unit(along or "") == "time"
    scale, *scales = scales_of([along, *taken], ["XUNITS", *(f"channel {names[n]!r}" for n in used)], timed)
    start = _number(words.get("XSTART", "0"), "XSTART")
    values = _text(body, count, below) if STORED[key] is None else _binary(path, count, STORED[key])
    if samples >= 0 and len(values) != samples:
        raise ValueError(
            f"announces {wording.count(samples, 'sample')} for each channel, but {len(values)} are there"
        )
    if not step > 0:
        raise ValueError(f"must have a positive step between samples, got {step!r}")
    elevations = np.stack(
        [scaled(values[:, n], s, wanted.missing) for n, s in zip(used, scales, strict=True)], axis=1
    )
    said = sorted({unit or "metres, since no unit is given" for unit in taken})
    understood = (
        f"ERD with {'text' if STORED[key] is None else f'binary numbers ({STORED[key]})'}, channels "
        f"{listed([names[n] for n in used])} in {', '.join(said)}, stations every {step:g} {along or 'm'}"
    )
    return RawProfile(
        (start + step * np.arange(len(values))) * scale,
        elevations,
        understood,
        source=words.get("TITLE", "").strip(),
        place=lambda row: f"sample {row + 1}",
        same_across=len(used) == 1,
        timed="XUNITS" if timed else "",
    )


def made(profile: Profile, encoding: str) -> dict[str, Content]:
    """Make an ERD file: numbers as text in full, or binary beside it."""
    step, done = profile.on_grid("an ERD file")
    elevation = profile.columns
    key = ENCODINGS[encoding]
    names = [f"Path{p}" for p in range(elevation.shape[1])]
    stored = STORED[key]
    record = -1 if stored is None else stored.itemsize * len(names)
    storage = f"{len(names)}, {len(elevation)}, -1, {record}, {key}, {step!r}, -1,"
    lines = [
        f"{HEADER.signature}2.00",
        storage,
        f"TITLE   {' '.join(profile.source.split())[:70]}",
        "SHORTNAM" + "".join(f"{name:{HEADER.field}}" for name in names),
        "UNITSNAM" + f"{'m':{HEADER.field}}" * len(names),
        "XLABEL  Distance",
        "XUNITS  m",
        f"XSTART  {float(profile.stations[0])!r}",
        *(f"HISTORY {' '.join(sentence.split())}" for sentence in done),
        "END",
    ]
    head = "".join(f"{line.rstrip()}\n" for line in lines).encode("latin-1", "replace")
    if stored is None:
        return {"": chain([head], text.rows([elevation], " "))}
    return {"": head, ".bin": elevation.astype(stored).tobytes()}


def _split(data: bytes) -> tuple[list[str], bytes, int]:
    """Lines of the header, what follows it, and the number of the line where that begins."""
    lines: list[str] = []
    at = 0
    while at < min(len(data), HEADER.longest):
        end = data.find(b"\n", at)
        end = len(data) if end < 0 else end
        line = data[at:end].decode("latin-1").rstrip("\r")
        at = end + 1
        if line[: HEADER.field].strip().upper() == "END":
            return lines, data[at:], len(lines) + 2
        lines.append(line)
    raise ValueError("has no line END that closes the header of an ERD file")


def _storage(header: Sequence[str]) -> tuple[int, int, int, float]:
    """Read the second line: number of channels and samples, how they are stored, and the step."""
    fields = [field.strip() for field in header[1].split(",")] if len(header) > 1 else []
    if len(fields) < 6:
        raise ValueError(
            "line 2: expected channels, samples, records, bytes, storage and step with commas between them"
        )
    try:
        count, samples, key = int(fields[0]), int(fields[1]), int(fields[4])
    except ValueError:
        raise ValueError(f"line 2: expected whole numbers, got {header[1][:60]!r}") from None
    if key not in STORED:
        known = ", ".join(map(str, STORED))
        raise ValueError(f"line 2: numbers stored in the way {key} are not understood, only in the ways {known}")
    if not 1 <= count <= HEADER.longest:
        raise ValueError(f"line 2: expected at least one channel, got {count}")
    return count, samples, key, _number(fields[5], "the step")


def _number(word: str, what: str) -> float:
    try:
        number = float(word)
    except ValueError:
        number = float("nan")
    if not np.isfinite(number):
        raise ValueError(f"must have a number for {what}, got {word.strip()[:30]!r}")
    return number


def _fields(header: Sequence[str], keyword: str, count: int) -> list[str]:
    """Texts of one keyword, one for each channel; empty where there are fewer."""
    words, width = "", HEADER.field
    current = False
    for line in header[2:]:
        if not line.startswith("&"):
            current = line[:width].strip().upper() == keyword
        if current:
            words += line[width:]
    found = [words[at : at + width].strip() for at in range(0, len(words), width)][:count]
    if keyword == "SHORTNAM":
        return [found[n] if n < len(found) and found[n] else str(n) for n in range(count)]
    return found + [""] * (count - len(found))


def _text(body: bytes, count: int, below: int) -> FloatArray:
    """Read numbers as text; a line may hold a part of a sample or several."""
    if not body.strip():
        raise ValueError("has no numbers behind its header")
    first = body.lstrip().split(b"\n", 1)[0]
    separator = "," if b"," in first else None
    width = len([word for word in first.decode("latin-1").split(separator) if word.strip()])
    if width < 1 or (width % count and count % width):
        raise ValueError(f"line {below}: {width} numbers in a line do not fit {count} channels")
    skipped = len(body) - len(body.lstrip())
    below += body[:skipped].count(b"\n")
    layout = Table(separator, ".", "#", width, False, frozenset(), 1, [], [])
    try:
        values = numbers(body[skipped:], "latin-1", layout).values
    except ValueError as error:
        raise ValueError(f"behind the header, which ends above line {below}: {error}") from None
    if values.size % count:
        raise ValueError(f"has {values.size} numbers, which do not fit {count} channels")
    return values.reshape(-1, count)


def _binary(path: Path, count: int, stored: np.dtype[np.generic] | None) -> FloatArray:
    """Read binary numbers, little-endian, sample by sample."""
    assert stored is not None
    beside = [file for file in (Path(f"{path}.bin"), path.with_suffix(".bin")) if file.exists()]
    if not beside:
        raise ValueError(f"needs its binary numbers in {path.name}.bin beside it, which is not there")
    data = bytes_of(beside[0])
    if len(data) % (stored.itemsize * count):
        raise ValueError(
            f"{beside[0].name} has {len(data)} bytes, which do not fit {count} channels of {stored.itemsize} bytes"
        )
    with np.errstate(invalid="ignore"):  # whatever the bits say is looked at later
        return np.frombuffer(data, stored).reshape(-1, count).astype(float)


def _recognises(head: bytes) -> bool:
    return head.startswith(HEADER.signature.encode())


FORMAT = Format("erd", "ERD", (".erd",), _recognises, read, made, tuple(ENCODINGS), takes=("units",))
