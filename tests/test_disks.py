"""What is written is there whole or not at all: full disks, quotas, vanished folders; consoles without letters."""

import errno
import os
import resource
import shutil
import signal
import subprocess
import sys
from contextlib import contextmanager
from tempfile import gettempdir

import numpy as np
import pytest
import xarray as xr

import movingfrf as mf
from movingfrf._basics.netcdf_file import as_netcdf
from movingfrf._basics.output import replacing, write_whole
from movingfrf.commands.main import main
from movingfrf.commands.streams import StandardStream
from movingfrf.reports import profile as profile_page
from movingfrf.reports import result as result_page
from movingfrf.roughness.files import FORMATS
from movingfrf.scenarios.template import template
from tests.spreadsheets import xlsx
from tests.test_cli import SHORT

PROFILE = mf.Profile(0.25 * np.arange(200.0), 1e-3 * np.sin(np.arange(200.0)), source="näher")
CONSOLE = {"PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0", "LC_ALL": "C"}


@contextmanager
def quota(size):
    """No file of this process may become larger, as `ulimit -f` has it."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def everything(folder):
    """All that lies in a folder, folders within it included."""
    return {str(p.relative_to(folder)): p.read_bytes() if p.is_file() else None for p in folder.rglob("*")}


def command(*arguments, **how):
    environment = {**os.environ, **how.pop("env", {})}
    return subprocess.run(
        [sys.executable, "-m", "movingfrf", *map(str, arguments)],
        stdin=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        env=environment,
        timeout=60,
        check=False,
        **how,
    )


@pytest.fixture(scope="module")
def given(tmp_path_factory):
    """Make a profile, a scenario and a result."""
    folder = tmp_path_factory.mktemp("given")
    mf.write_profile(PROFILE, folder / "road.csv")
    (folder / "truck.toml").write_text(SHORT, encoding="utf-8")
    result = mf.read_scenario(folder / "truck.toml").run()
    write_whole(folder / "result.nc", as_netcdf(result))
    return folder


def sizes(full):
    """Nothing, one byte, somewhere, all but one."""
    return sorted({0, 1, full // 3, full - 1})


WRITTEN = {form.name: f"road{form.endings[0]}" for form in FORMATS.values() if form.made}


@pytest.mark.parametrize("name", WRITTEN.values())
def test_a_profile_that_finds_no_room_leaves_the_one_before(name, given, tmp_path, capsys):
    if name.endswith(".crg"):
        pytest.importorskip("pyopencrg")
    arguments = ["convert", str(given / "road.csv"), str(tmp_path / name), "--force"]
    assert main(arguments) == 0
    before = everything(tmp_path)
    capsys.readouterr()
    for size in sizes(len(before[name])):
        with quota(size):
            assert main(arguments) == 2
        told = capsys.readouterr().err.splitlines()
        assert len(told) == 1
        # What a library must write to a file of its own fails there.
        assert os.strerror(errno.EFBIG) in told[0] or "No usable temporary directory" in told[0]
        assert f"cannot read or write: {tmp_path / name}: " in told[0]
        assert "movingfrf-" not in told[0]
        assert everything(tmp_path) == before
    with quota(len(before[name])):
        assert main(arguments) == 0


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        (["new", "OUT/a.toml"], "a.toml"),
        (["schema", "OUT/a.json"], "a.json"),
        (["vehicles", "half_truck", "-o", "OUT/a.npz"], "a.npz"),
        (["vehicles", "half_truck", "-o", "OUT/a.mat"], "a.mat"),
        (["measure", "IN/result.nc", "-o", "OUT/a.json"], "a.json"),
        (["measure", "IN/result.nc", "-o", "OUT/a.csv"], "a.csv"),
    ],
)
def test_a_file_that_finds_no_room_is_not_begun(arguments, name, given, tmp_path, capsys):
    out = tmp_path / "out"
    typed = [word.replace("OUT", str(out)).replace("IN", str(given)) for word in arguments]
    assert main(typed) == 0
    full = (out / name).stat().st_size
    shutil.rmtree(out)
    capsys.readouterr()
    for size in sizes(full):
        with quota(size):
            assert main(typed) == 2
        assert capsys.readouterr().err == (
            f"movingfrf: cannot read or write: {out / name}: {os.strerror(errno.EFBIG)}\n"
        )
        assert not out.exists()
    with quota(full):
        assert main(typed) == 0


@pytest.fixture
def short_pages(monkeypatch):
    """Draw nothing, which takes most of the time."""
    for module in (profile_page, result_page):
        monkeypatch.setattr(module, "render", lambda *_, **__: "page" * 1000)


@pytest.mark.usefixtures("short_pages")
@pytest.mark.parametrize("arguments", [["run"], ["profile"]])
def test_of_a_set_all_files_find_room_or_none_is_there(arguments, given, tmp_path, capsys):
    require_all_or_none(arguments, given, tmp_path, capsys)


@pytest.mark.slow
@pytest.mark.parametrize("arguments", [["run"], ["run", "--method", "cdfm"], ["random"], ["profile"]])
def test_of_a_drawn_set_all_files_find_room_or_none_is_there(arguments, given, tmp_path, capsys):
    require_all_or_none(arguments, given, tmp_path, capsys)


def require_all_or_none(arguments, given, tmp_path, capsys):
    source = given / ("road.csv" if arguments[0] == "profile" else "truck.toml")
    typed = [arguments[0], str(source), *arguments[1:], "-o", str(tmp_path / "out")]
    assert main(typed) == 0
    before = everything(tmp_path)
    capsys.readouterr()
    largest = max(len(content) for content in before.values() if content)
    for size in (100, largest - 1):
        with quota(size):
            assert main(typed) == 2
        told = capsys.readouterr().err
        assert told.startswith(f"movingfrf: cannot read or write: {tmp_path / 'out'}")
        assert told.endswith(f"{os.strerror(errno.EFBIG)}\n")
        assert told.count("\n") == 1
        assert everything(tmp_path) == before


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_a_sampled_guideway_finds_no_room(tmp_path):
    guideway = mf.SampledGuideway(response=np.ones((100, 1)), time_step=1e-3, offsets=[0.0], speed=10.0)
    for name in ("a.npz", "a.mat"):
        mf.write_sampled_guideway(guideway, tmp_path / name)
        before = everything(tmp_path)
        with quota(300), pytest.raises(OSError, match=name):
            mf.write_sampled_guideway(guideway, tmp_path / name)
        assert everything(tmp_path) == before


def test_hdf5_does_not_take_the_process_with_it(given, tmp_path):
    """Its library crashed where the file that it wrote to was full, at the latest when the process ended."""

    def limited():
        resource.setrlimit(resource.RLIMIT_FSIZE, (5000, 5000))

    done = command("convert", given / "road.csv", tmp_path / "a.nc", stdout=subprocess.PIPE, preexec_fn=limited)
    assert done.returncode == 2
    assert done.stderr.decode().splitlines() == [
        f"movingfrf: cannot read or write: {tmp_path / 'a.nc'}: {os.strerror(errno.EFBIG)}"
    ]
    assert not list(tmp_path.iterdir())


def test_no_room_to_unpack_is_not_a_damaged_file(given, tmp_path, capsys):
    mf.write_profile(PROFILE, tmp_path / "road.nc")
    xlsx(tmp_path / "road.xlsx", {"road": [["x [m]", "z [m]"], *([n, 0.125] for n in range(200))]})
    for file in (tmp_path / "road.nc", tmp_path / "road.xlsx"):
        with quota(300):
            assert main(["profile", str(file)]) == 2
        assert capsys.readouterr().err == (
            f"movingfrf: cannot read {file}: {os.strerror(errno.EFBIG)}, while it is unpacked in {gettempdir()}\n"
        )


@pytest.fixture(params=["size=32k", "ro"])
def small_disk(request, tmp_path):
    """Mount a disk, full soon or read-only."""
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", request.param, "tmpfs", str(disk)]
    if shutil.which("mount") is None or subprocess.run(mount, capture_output=True, check=False).returncode:
        pytest.skip("no disk may be mounted here: run as root, in a container of one's own, to see this")
    yield disk
    subprocess.run(["umount", str(disk)], check=True)


def test_a_disk_is_full_or_read_only(small_disk, tmp_path, capsys):
    road = mf.Profile(0.1 * np.arange(20_000.0), np.sin(np.arange(20_000.0)))
    mf.write_profile(road, tmp_path / "road.csv")
    for name in WRITTEN.values():
        assert main(["convert", str(tmp_path / "road.csv"), str(small_disk / name)]) == 2
        told = capsys.readouterr().err
        assert told.count("\n") == 1
        assert str(small_disk) in told
        assert os.strerror(errno.ENOSPC) in told or os.strerror(errno.EROFS) in told
        assert not list(small_disk.iterdir())


@pytest.mark.parametrize("workers", [1, 2])
def test_a_disk_that_is_full_in_mid_sweep(workers, tmp_path):
    """The chunk at hand is lost, and no other: with room again, the sweep goes on from there."""
    (tmp_path / "truck.toml").write_text(SHORT, encoding="utf-8")
    # A process of its own, of which, and of whose workers, every file past the first ones finds no room.
    (tmp_path / "sitecustomize.py").write_text(
        "import errno, os\n"
        "real = os.fsync\n"
        "def full(number):\n"
        "    if os.path.isdir('kept/chunks') and len([n for n in os.listdir('kept/chunks') if n[0] != '.']) > 1:\n"
        "        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))\n"
        "    real(number)\n"
        "os.fsync = full\n"
    )
    order = ["sweep", "truck.toml", "--over", "run.speed=8:12:300", "--measures", "static_load", "-o", "kept"]
    order += ["--workers", str(workers)]
    paths = os.pathsep.join([str(tmp_path), *sys.path])
    done = command(*order, stdout=subprocess.PIPE, cwd=tmp_path, env={"PYTHONPATH": paths})
    assert done.returncode == 2
    (said,) = done.stderr.decode().splitlines()
    assert os.strerror(errno.ENOSPC) in said
    kept = everything(tmp_path / "kept")
    chunks = {name: content for name, content in kept.items() if name.endswith(".npz")}
    assert 2 <= len(chunks) < 5
    assert set(kept) == {"sweep.json", "chunks", *chunks}
    again = command(*order, stdout=subprocess.PIPE, cwd=tmp_path)
    assert (again.returncode, again.stderr) == (0, b"")
    assert chunks.items() <= everything(tmp_path / "kept").items()
    assert b"300 cases, none without an answer" in again.stdout


def test_a_folder_that_vanishes_meanwhile(tmp_path):
    def computed(folder):
        with replacing(folder) as files:
            shutil.rmtree(folder)
            files["report.html"] = "all of it"

    with pytest.raises(FileNotFoundError, match=r"report\.html"):
        computed(tmp_path / "out")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("name", "reason"), [("x" * 300, errno.ENAMETOOLONG), ("file/a.toml", errno.EEXIST), ("folder", errno.EISDIR)]
)
def test_a_name_that_cannot_be(name, reason, tmp_path, capsys):
    (tmp_path / "file").write_text("mine")
    (tmp_path / "folder").mkdir()
    assert main(["new", str(tmp_path / name)]) == 2
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert os.strerror(reason) in told or reason == errno.EISDIR
    assert sorted(p.name for p in tmp_path.rglob("*")) == ["file", "folder"]


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_of_somebody_else(tmp_path, capsys):
    tmp_path.chmod(0o500)
    assert main(["new", str(tmp_path / "a.toml")]) == 2
    tmp_path.chmod(0o700)
    assert os.strerror(errno.EACCES) in capsys.readouterr().err


def test_a_link_stays_and_a_pipe_takes_what_it_can(tmp_path):
    (tmp_path / "far").mkdir()
    (tmp_path / "near.txt").symlink_to(tmp_path / "far" / "away.txt")
    (tmp_path / "road.csv").symlink_to(tmp_path / "far" / "road.csv")
    write_whole(tmp_path / "near.txt", "text")
    mf.write_profile(PROFILE, tmp_path / "road.csv")
    assert (tmp_path / "near.txt").is_symlink()
    assert (tmp_path / "far" / "away.txt").read_text() == "text"
    assert (tmp_path / "road.csv").is_symlink()
    assert (tmp_path / "far" / "road.csv").stat().st_size > 1000
    # A pipe, since a fault that replaced it would leave no /dev/null on this machine.
    os.mkfifo(tmp_path / "pipe")
    reading = os.open(tmp_path / "pipe", os.O_RDONLY | os.O_NONBLOCK)
    write_whole(tmp_path / "pipe", "text")
    assert os.read(reading, 10) == b"text"
    os.close(reading)
    assert (tmp_path / "pipe").is_fifo()


def test_an_interrupt_waits_until_all_files_are_in_place(tmp_path, monkeypatch):
    """Between two renamings, where one of two files would be the old one."""
    (tmp_path / "b").write_text("old")
    real = os.replace

    def interrupted(*places):
        signal.raise_signal(signal.SIGINT)
        real(*places)

    def computed():
        with replacing(tmp_path) as files:
            files |= {"a": "new", "b": "new"}

    monkeypatch.setattr(os, "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        computed()
    assert everything(tmp_path) == {"a": b"new", "b": b"new"}
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_an_interrupt_while_computing_leaves_nothing(tmp_path):
    def computed():
        with replacing(tmp_path / "deep" / "er") as files:
            files["a"] = "new"
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        computed()
    assert not list(tmp_path.iterdir())


def test_equal_content_gives_equal_bytes_and_holds_it(tmp_path):
    held = xr.Dataset({"a": ("x", np.arange(3.0))}, attrs={"said": "ä"})
    assert as_netcdf(held) == as_netcdf(held)
    write_whole(tmp_path / "a.nc", as_netcdf(held))
    with xr.open_dataset(tmp_path / "a.nc", engine="h5netcdf") as opened:
        xr.testing.assert_identical(opened.load(), held)
    mf.write_profile(PROFILE, tmp_path / "a.mat")
    assert (tmp_path / "a.mat").read_bytes()[:116].rstrip() == b"MATLAB 5.0 MAT-file, written by movingfrf"


# Standard output.


@pytest.mark.usefixtures("short_pages")
def test_results_are_there_where_standard_output_is_full(given, tmp_path, capsys, monkeypatch):
    full = StandardStream(open("/dev/full", "w"), StandardStream.OUTPUT)
    monkeypatch.setattr(sys, "stdout", full)
    assert main(["run", str(given / "truck.toml"), "-o", str(tmp_path / "out")]) == 2
    monkeypatch.undo()
    with pytest.raises(OSError, match=os.strerror(errno.ENOSPC)):
        full.close()
    assert capsys.readouterr().err == (
        f"movingfrf: cannot read or write: standard output: {os.strerror(errno.ENOSPC)}; "
        f"already written: {tmp_path / 'out'}\n"
    )
    assert sorted(everything(tmp_path / "out")) == ["report.html", "result.nc", "summary.json"]


SLOWER = [pytest.param(["new"], marks=pytest.mark.slow), pytest.param(["vehicles"], marks=pytest.mark.slow)]


@pytest.mark.parametrize("arguments", [["--help"], *SLOWER])
def test_a_pipe_that_nobody_reads_and_a_full_device(arguments):
    for gone in (True, False):
        reading, writing = os.pipe()
        if not gone:
            os.dup2(os.open("/dev/full", os.O_WRONLY), writing)
        os.close(reading)
        done = command(*arguments, stdout=writing)
        os.close(writing)
        full = f"movingfrf: cannot read or write: standard output: {os.strerror(errno.ENOSPC)}\n"
        # Who reads no more has read enough.
        assert (done.stderr.decode(), done.returncode) == (("", 0) if gone else (full, 2))


def test_nothing_can_be_said_at_all():
    with open("/dev/full", "w") as full:
        assert subprocess.run([sys.executable, "-m", "movingfrf", "new"], stdout=full, stderr=full).returncode == 2


@pytest.mark.parametrize("encoding", ["", *(pytest.param(e, marks=pytest.mark.slow) for e in ("ascii", "cp1252"))])
def test_a_console_without_all_letters(encoding, given, tmp_path):
    """`−` is in none of them; a scenario that is redirected is UTF-8 all the same."""
    console = {"PYTHONIOENCODING": encoding} if encoding else CONSOLE
    done = command("kinds", "half_car", stdout=subprocess.PIPE, env=console)
    assert (done.returncode, done.stderr) == (0, b"")
    assert b"(+a, ?b)" in done.stdout
    new = command("new", stdout=subprocess.PIPE, env=console)
    assert new.stdout.decode("utf-8") == template("scenario")
    assert "N/m²" in template("scenario")


def test_files_are_utf_8_whatever_the_locale(given, tmp_path):
    file = tmp_path / "a.json"
    done = command("measure", given / "result.nc", "-o", file, stdout=subprocess.DEVNULL, env=CONSOLE)
    assert (done.returncode, done.stderr) == (0, b"")
    assert "m/s²" in file.read_text(encoding="utf-8")


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_a_scenario_that_was_redirected_on_another_system(encoding, tmp_path, capsys):
    (tmp_path / "a.toml").write_text(SHORT, encoding=encoding)
    assert main(["check", str(tmp_path / "a.toml")]) == 0


def test_who_may_read_a_file_stays(tmp_path):
    place = tmp_path / "mine.toml"
    write_whole(place, "first")
    usual = place.stat().st_mode
    place.chmod(0o600)
    write_whole(place, "second")
    assert place.stat().st_mode & 0o777 == 0o600
    write_whole(tmp_path / "other.toml", "third")
    assert (tmp_path / "other.toml").stat().st_mode == usual


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_whatever_ends_the_process_waits_until_all_files_are_in_place(number, tmp_path):
    script = f"""
import os, signal
import movingfrf._basics.ending as ending
from pathlib import Path
from movingfrf._basics.output import replacing
ending.heed()
real = os.replace
def told(*places):
    real(*places)
    os.kill(os.getpid(), {int(number)})
os.replace = told
with replacing(Path({str(tmp_path)!r})) as files:
    files |= {{"a": "new", "b": "new"}}
"""
    (tmp_path / "b").write_text("old")
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, check=False)
    assert done.returncode == 128 + number
    assert everything(tmp_path) == {"a": b"new", "b": b"new"}
