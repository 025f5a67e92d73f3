"""Damaged files for every reader of profiles: `python -m tests.fuzz_readers [--count 1000] [format …]`.

Each file of a small collection is changed at random (bytes, pieces, counts, the end) and read. A reader may give
a profile or a ValueError; anything else, more than `PATIENCE` seconds, or more memory than ten times the file (and
more than 128 MiB, which small files may take) is a defect, as is a warning. Batches run in a process of their own,
so that a crash is one too.
"""

from __future__ import annotations

import argparse
import multiprocessing
import signal
import sys
import tempfile
import time
import traceback
import tracemalloc
import warnings
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from movingfrf.roughness.files import FORMATS, read_profile, write_profile
from movingfrf.roughness.profile import Profile
from tests.spreadsheets import xlsx

TIMES, FLOOR, PATIENCE = 10, 2**27, 30.0

# Between one file and the next a process may grow by what its libraries keep.
GROWTH = 2 * FLOOR

# Pieces that mean something to one format or another.
GARBAGE = (
    rb"\x00 \xff\xff\xff\xff \xff\xff\xff\x7f 9999999999 2147483647 -1 nan 1e999 , ; \n \r \" [mm] END\n "
    rb"<ele> &x; <!DOCTYPE\x20gpx> $ROAD_CRG\n"
)
PIECES = [piece.decode("unicode_escape").encode("latin-1") for piece in GARBAGE.split()]

GPX = b"""<?xml version="1.0"?><gpx xmlns="http://www.topografix.com/GPX/1/1"><trk><name>A road</name><trkseg>%s
</trkseg></trk></gpx>"""
POINT = b'\n<trkpt lat="%.6f" lon="%.6f"><ele>%.2f</ele></trkpt>'


def profile(count: int = 60) -> Profile:
    """Make up a road of two paths."""
    elevation = 0.01 * np.random.default_rng(3).normal(size=(count, 2)).round(5)
    return Profile(0.25 * np.arange(count), elevation, source="a road", steps=("made up",), across=(0.75, -0.75))


def samples(folder: Path) -> dict[str, Path]:
    """Write one file of each format and encoding."""
    road = profile()
    for form in FORMATS.values():
        for encoding in form.encodings if form.made else ():
            name = f"{encoding or 'road'}{form.endings[0]}".replace(" ", "_")
            write_profile(road, folder / name, encoding=encoding or None)
    table = list(zip(road.stations.tolist(), road.columns.tolist(), strict=True))
    european = "Station [m];Left [mm];Right [mm]\n" + "".join(f"{x};{a};{b}\n" for x, (a, b) in table)
    (folder / "european.csv").write_text(european.replace(".", ","))
    rows = "".join(f'{x};"joint, {x}";{a:.5f}D+00;#N/A\n' for x, (a, _) in table)
    (folder / "remarked.txt").write_text(f'Lane 1\n\n"x, m";remark;"z, mm";temperature\n{rows}Total;;;\n')
    if find_spec("python_calamine"):
        xlsx(folder / "road.xlsx", {"A": [["x [m]", "z [mm]"], *([x, a] for x, (a, _) in table)]})
    points = b"".join(POINT % (48 + 1e-5 * n, 9.0, 300 + n) for n in range(60))
    (folder / "track.gpx").write_bytes(GPX % points)
    (folder / "segments.gpx").write_bytes(GPX % (points + b"</trkseg><trkseg>" + POINT % (48, 9, 300)))
    _packed(road, folder)
    return {file.name: file for file in sorted(folder.iterdir()) if file.suffix != ".bin"}


def _packed(road: Profile, folder: Path) -> None:
    """MATLAB files whose arrays are packed, of both versions."""
    import h5py
    from scipy.io import netcdf_file, savemat

    values = {"x": road.stations[:, None], "z": road.columns}
    savemat(folder / "packed.mat", values, do_compression=True)
    savemat(
        folder / "struct.mat", {"road": {**values, "more": {"note": "dry", "runs": np.array(["a", 1.0], object)}}}
    )
    savemat(folder / "structs.mat", {"road": {"x": road.stations, "z": road.columns}}, do_compression=True)
    savemat(folder / "matrix.mat", {"road": np.column_stack([road.stations, road.columns])})
    np.save(folder / "matrix.npy", np.column_stack([road.stations, road.columns]))
    with netcdf_file(folder / "classic.nc", "w") as file:
        file.createDimension("x", len(road.stations))
        for name, value in (("x", road.stations), ("z", np.int16(1e5 * road.columns[:, 0]))):
            file.createVariable(name, value.dtype.str[1:], ("x",))[:] = value
        file.variables["z"].scale_factor, file.variables["z"].units = 1e-5, b"m"
    with h5py.File(folder / "groups.nc", "w") as file:
        file["runs/x"], file["runs/z"] = road.stations, np.int16(1e5 * road.columns)
        file["runs/z"].attrs.update(
            {"scale_factor": 1e-5, "valid_range": np.array([-9999, 9999], "i2"), "missing_value": "-9999"}
        )
    with h5py.File(folder / "version73.mat", "w", userblock_size=512) as file:
        for name, value in values.items():
            file.create_dataset(name, data=value.T, compression="gzip", chunks=True)
    with (folder / "version73.mat").open("r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM")


def damaged(content: bytes, random: np.random.Generator) -> bytes:
    """Change a file in one place or several."""
    changed = bytearray(content)
    for _ in range(random.integers(1, 6)):
        # Half of the places lie in the header, where counts are.
        reach = len(changed) if random.random() < 0.5 else min(len(changed), 400)
        at = int(random.integers(reach + 1))
        match int(random.integers(6)):
            case 0 if at < len(changed):
                changed[at] ^= 1 << int(random.integers(8))
            case 1:
                changed[at : at + 4] = random.bytes(4)
            case 2:
                changed[at:at] = PIECES[int(random.integers(len(PIECES)))]
            case 3:
                del changed[at : at + int(random.integers(1, 30))]
            case 4:
                piece = changed[at : at + int(random.integers(1, 200))]
                changed[at:at] = piece * int(random.integers(1, 4))
            case 5 if random.random() < 0.3:
                del changed[at:]
    return bytes(changed)


class Hung(BaseException):
    """A reader took too long."""


def read(file: Path) -> str:
    """Read a file; says `read`, `refused`, or what is wrong with the reader."""
    tracemalloc.clear_traces()
    tracemalloc.reset_peak()
    before = tracemalloc.get_traced_memory()[0]
    signal.setitimer(signal.ITIMER_REAL, PATIENCE)
    try:
        found = read_profile(file)
        said = "read" if np.isfinite(found.profile.columns).all() else "not finite"
    except ValueError as error:
        said = "refused" if str(error) else "refused without a word"
    except Hung:
        return "hung"
    except Exception:
        return traceback.format_exc()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
    peak = tracemalloc.get_traced_memory()[1] - before
    size = sum(part.stat().st_size for part in file.parent.glob(f"{file.name}*"))
    return said if peak <= max(TIMES * size, FLOOR) else f"took {peak} bytes for a file of {size}"


def batch(name: str, content: bytes, beside: bytes, seed: int, count: int, folder: str) -> dict[str, int]:
    """Read one file in many damaged states; counts what happened."""
    import resource

    def hung(*_: object) -> None:
        raise Hung

    signal.signal(signal.SIGALRM, hung)
    warnings.simplefilter("error")
    # All libraries are loaded before anything is measured.
    file = Path(folder) / name
    file.write_bytes(content)
    if beside:
        Path(f"{file}.bin").write_bytes(beside)
    tracemalloc.start()
    found = {read(file): 0}
    assert found == {"read": 0}, found
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    random = np.random.default_rng([seed, *name.encode()])
    for _ in range(count):
        state = damaged(content, random)
        file.write_bytes(state)
        said = read(file)
        found[said] = found.get(said, 0) + 1
        if said not in ("read", "refused"):
            print(f"{name}: {said}\n{state[:300]!r}", file=sys.stderr)
    grown = 1024 * (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - memory)
    if grown > GROWTH:
        found[f"grew by {grown} bytes"] = 1
    return found


def run(count: int, seed: int = 0, only: tuple[str, ...] = ()) -> dict[str, dict[str, int]]:
    """Read `count` damaged files of each kind; name of the file → what happened how often."""
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder) / "work"
        work.mkdir()
        source = Path(folder) / "source"
        source.mkdir()
        for name, file in samples(source).items():
            if only and not any(word in name for word in only):
                continue
            binary = Path(f"{file}.bin")
            beside = binary.read_bytes() if binary.exists() else b""
            with multiprocessing.get_context("fork").Pool(1) as pool:
                # Each HDF5 file and spreadsheet takes a process of its own, a hundred times the time of others.
                slow = ("road.nc", "groups.nc", "version73.mat", "road.xlsx")
                share = count if name not in slow else -(-count // 10)
                task = pool.apply_async(batch, (name, file.read_bytes(), beside, seed, share, str(work)))
                try:
                    found[name] = task.get(timeout=60 + count)
                except multiprocessing.TimeoutError:
                    found[name] = {"crashed or hung": 1}
    return found


def main() -> int:
    """Run as a program."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz_readers", description=__doc__.splitlines()[0])
    parser.add_argument("only", nargs="*", help="only files whose name contains one of these texts")
    parser.add_argument("--count", type=int, default=1000, help="damaged files of each kind; of HDF5 a tenth")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    began = time.perf_counter()
    found = run(options.count, options.seed, tuple(options.only))
    for name, counts in found.items():
        print(f"{name:16} {', '.join(f'{what.splitlines()[-1]} {n}' for what, n in counts.items())}")
    wrong = sum(n for counts in found.values() for what, n in counts.items() if what not in ("read", "refused"))
    total = sum(sum(counts.values()) for counts in found.values())
    print(f"{total} files in {time.perf_counter() - began:.0f} s, {wrong} defects")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
