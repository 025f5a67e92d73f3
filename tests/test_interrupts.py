"""Told to end, the command ends: at once, in one line, from its first instruction on, whatever it is at."""

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import movingfrf as mf
from tests.test_cli import SHORT
from tests.test_disks import PROFILE

INTERRUPTED = "movingfrf: interrupted, nothing was written\n"
COMMANDS = ("run truck.toml", "check truck.toml", "--help", "vehicles", "profile road.csv -o out")

on_linux = pytest.mark.skipif(
    not Path("/proc/self/status").exists(), reason="when a process begins to listen is read from /proc"
)


def started(command, folder):
    return subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def await_first_instruction(process):
    """Wait until the process hears that it is told to end, which Python by itself does not listen for."""
    until = time.monotonic() + 30.0
    while time.monotonic() < until and process.poll() is None:
        status = Path(f"/proc/{process.pid}/status").read_text()
        heard = next(line.split()[1] for line in status.splitlines() if line.startswith("SigCgt"))
        if int(heard, 16) >> signal.SIGTERM - 1 & 1:
            return
        time.sleep(2e-4)


@on_linux
@pytest.mark.parametrize("numbers", [range(12), pytest.param(range(12, 50), marks=pytest.mark.slow)], ids=str)
def test_early_interrupts_at_random_moments(numbers, tmp_path):
    """Fifty in all, while modules are loaded, within 0.6 s of the first instruction; every third one twice."""
    (tmp_path / "truck.toml").write_text(SHORT)
    mf.write_profile(PROFILE, tmp_path / "road.csv")
    for number in numbers:
        drawn = random.Random(number)
        process = started([sys.executable, "-m", "movingfrf", *COMMANDS[number % len(COMMANDS)].split()], tmp_path)
        await_first_instruction(process)
        time.sleep(drawn.uniform(0.0, 0.6))
        process.send_signal(signal.SIGINT)
        if number % 3 == 0:
            time.sleep(drawn.uniform(0.0, 0.01))
            process.send_signal(signal.SIGINT)
        _, told = process.communicate(timeout=60)
        assert (process.returncode, told) in ((130, INTERRUPTED), (0, "")), f"number {number}"
        if process.returncode:
            left = {file.name for file in tmp_path.rglob("*")}
            assert left <= {"road.csv", "truck.toml", "out", "profile.html", "profile.json"}


@on_linux
def test_told_to_end_early_it_says_nothing(tmp_path):
    process = started([sys.executable, "-m", "movingfrf", "vehicles"], tmp_path)
    await_first_instruction(process)
    process.terminate()
    assert process.communicate(timeout=60) == ("", "")
    assert process.returncode == 143


def outcome(script, folder, *, name="movingfrf", before=None):
    """Run a script that passes for the command, or not, by its name: status, and what it said."""
    (folder / name).write_text("import os, signal\nfrom pathlib import Path\n" + script)
    process = subprocess.run(
        [sys.executable, name],
        cwd=folder,
        capture_output=True,
        text=True,
        preexec_fn=before,
        timeout=60,
        check=False,
    )
    return process.returncode, process.stdout + process.stderr


INTERRUPT = "signal.raise_signal(signal.SIGINT)\n"

# Where an exception would show, or be lost.
PLACES = {
    "a destructor": f"""
class Held:
    def __del__(self):
        {INTERRUPT}
import movingfrf
held = Held()
del held
""",
    "a module that is being loaded": f"""
import movingfrf
Path("loaded.py").write_text({"import signal; " + INTERRUPT!r})
try:
    import loaded
except BaseException:
    pass
""",
    "a second one, while tidying up": f"""
from movingfrf._basics.undoing import undone
with undone(lambda: signal.raise_signal(signal.SIGINT)):
    {INTERRUPT}
""",
    "what cannot be undone": f"""
from movingfrf._basics.undoing import undone
with undone(lambda: 1 / 0):
    {INTERRUPT}
""",
}


@pytest.mark.parametrize("place", PLACES)
def test_an_interrupt_anywhere_ends_in_a_line(place, tmp_path):
    assert outcome(PLACES[place], tmp_path) == (130, INTERRUPTED)


def test_what_was_written_before_is_said(tmp_path):
    script = "from movingfrf._basics.output import write_whole\nwrite_whole(Path('a.txt'), 'a')\n" + INTERRUPT
    assert outcome(script, tmp_path) == (130, "movingfrf: interrupted, already written: a.txt\n")
    assert (tmp_path / "a.txt").read_text() == "a"


def test_between_two_files_of_a_set(tmp_path):
    script = f"""
from movingfrf._basics.output import replacing
real = os.replace
def interrupted(*places):
    {INTERRUPT}
    real(*places)
os.replace = interrupted
with replacing(Path("out")) as files:
    files |= {{"a": "new", "b": "new"}}
"""
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "b").write_text("old")
    assert outcome(script, tmp_path) == (130, "movingfrf: interrupted, already written: out\n")
    assert {file.name: file.read_text() for file in (tmp_path / "out").iterdir()} == {"a": "new", "b": "new"}


def test_processes_and_folders_end_with_it(tmp_path):
    script = """
from movingfrf._basics.undoing import carried_out, scratch
from movingfrf._basics.output import replacing
signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(signal.SIGINT))
signal.setitimer(signal.ITIMER_REAL, 0.5)
with scratch() as folder, replacing(Path("deep/er")):
    Path("where").write_text(str(folder))
    carried_out(["sh", "-c", "echo $$ > number; exec sleep 60"])
"""
    assert outcome(script, tmp_path) == (130, INTERRUPTED)
    assert not Path((tmp_path / "where").read_text()).exists()
    assert not (tmp_path / "deep").exists()
    child = int((tmp_path / "number").read_text())
    until = time.monotonic() + 10.0
    while time.monotonic() < until:
        try:
            os.kill(child, 0)
        except ProcessLookupError:
            break
        time.sleep(0.01)
        if Path(f"/proc/{child}/stat").exists() and ") Z " in Path(f"/proc/{child}/stat").read_text():
            break  # ended, though nobody has asked for its status
    else:
        pytest.fail("the child runs on")


def test_what_only_imports_the_package_keeps_its_own_handling(tmp_path):
    script = "import movingfrf\nprint(signal.getsignal(signal.SIGINT) is signal.default_int_handler)\n"
    assert outcome(script, tmp_path, name="mine.py") == (0, "True\n")
    assert outcome(script, tmp_path) == (0, "False\n")


@pytest.mark.parametrize(
    "script",
    [
        "import sys\nsys.argv = ['x']\n",  # as programs do that take options off themselves
        "import sys\nsys.argv.clear()\n",
        "import sys\n",
    ],
)
def test_what_has_the_name_among_its_arguments_is_not_the_command(script, tmp_path):
    asks = "import movingfrf, signal\nprint(signal.getsignal(signal.SIGINT) is signal.default_int_handler)\n"
    (tmp_path / "mine.py").write_text(script + asks)
    for arguments in (["--project", "movingfrf.toml"], ["data/movingfrf"], ["-m", "movingfrf"]):
        told = subprocess.run([sys.executable, "mine.py", *arguments], cwd=tmp_path, capture_output=True, text=True)
        assert told.stdout == "True\n"
    (tmp_path / "movingfrf_tool.py").write_text(script + asks)
    told = subprocess.run([sys.executable, "-m", "movingfrf_tool"], cwd=tmp_path, capture_output=True, text=True)
    assert told.stdout == "True\n"


def test_an_interrupt_that_the_caller_ignores_stays_ignored(tmp_path):
    script = "import movingfrf\n" + INTERRUPT + "print('on')\n"
    assert outcome(script, tmp_path, before=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN)) == (0, "on\n")
