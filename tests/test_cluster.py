"""Sweeps on a cluster of dask.distributed: the same bit for bit, whoever is killed; else a line that says why."""

from __future__ import annotations

import logging
import operator
import os
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace

import numpy as np
import pytest

from movingfrf._basics.version import VERSION
from movingfrf.studies.sweep import chunks
from movingfrf.studies.sweep import cluster as module
from movingfrf.studies.sweep.plan import plan_of
from movingfrf.studies.sweep.sweep import swept
from tests.cluster_parts import SOURCE, Cluster
from tests.sweep_parts import FILE, command, scenario_in

distributed = pytest.importorskip("distributed", reason="the extra `distributed` is not installed")
pytestmark = [
    pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning"),
    pytest.mark.xdist_group("cluster"),
    pytest.mark.skipif(os.name == "nt", reason="signals"),
]
# Six chunks.
AXES = {"run.speed": np.linspace(8.0, 12.0, 192), "roughness.seed": [0, 1]}
ASKED = ["--over", "run.speed=8:12:192", "--over", "roughness.seed=0,1", "--measures", "contact_force_rms"]


@pytest.fixture(scope="module")
def given(tmp_path_factory):
    """Write a scenario, and solve it without a cluster."""
    truck = scenario_in(tmp_path_factory.mktemp("given"))
    swept(plan_of(truck, AXES, measures="contact_force_rms"), truck.parent / "alone")
    return truck


@pytest.fixture
def cluster(tmp_path):
    with Cluster(tmp_path) as started:
        yield started


def begun(truck, cluster, folder, *others):
    """Ask a cluster for the sweep."""
    order = ["sweep", str(truck), *ASKED, "--cluster", cluster.address, "-o", str(folder), *others]
    return subprocess.Popen(
        [sys.executable, "-m", "movingfrf", *order], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def stored(folder):
    """Chunks that are there, with when they were written."""
    return {file.name: file.stat().st_mtime_ns for file in folder.glob("chunks/*.npz")}


def await_chunks(process, folder, count=1):
    until = time.monotonic() + 60.0
    while len(stored(folder)) < count and process.poll() is None and time.monotonic() < until:
        time.sleep(0.01)


def require_same(truck, folder):
    """Find what a process alone has stored, byte for byte."""
    alone = {file.name: file.read_bytes() for file in (truck.parent / "alone" / "chunks").iterdir()}
    assert {file.name: file.read_bytes() for file in (folder / "chunks").iterdir()} == alone


def said_in_a_line(said):
    assert said.startswith("movingfrf: ")
    assert said.count("\n") == 1
    return said


def tasks_left(cluster):
    with distributed.Client(cluster.address, set_as_default=False) as client:
        until = time.monotonic() + 5.0
        while client.run_on_scheduler(lambda dask_scheduler: len(dask_scheduler.tasks)):
            if time.monotonic() > until:
                return True
            time.sleep(0.05)
    return False


@pytest.mark.slow
def test_the_client_is_told_to_end_and_killed(given, cluster, tmp_path):
    """What is solved is stored, what is not is solved by nobody; called again, nothing is solved twice."""
    kept = tmp_path / "kept"
    before = {}
    for number, words in ((signal.SIGINT, "interrupted, already written: "), (signal.SIGKILL, "")):
        process = begun(given, cluster, kept)
        await_chunks(process, kept, len(before) + 1)
        process.send_signal(number)
        _, said = process.communicate(timeout=30)
        assert process.returncode == (130 if words else -number)
        assert words in (said_in_a_line(said) if words else said)
        assert not tasks_left(cluster)
        assert before.items() < stored(kept).items()
        before = stored(kept)
        assert len(before) < 6
    swept(plan_of(given, AXES, measures="contact_force_rms"), kept, cluster=cluster.address)
    require_same(given, kept)
    assert before.items() < stored(kept).items()


@pytest.mark.slow
def test_a_worker_is_killed(given, cluster, tmp_path):
    """Others take what it was at."""
    kept = tmp_path / "kept"
    process = begun(given, cluster, kept)
    await_chunks(process, kept)
    cluster.workers[0].kill()
    out, said = process.communicate(timeout=60)
    assert (process.returncode, said) == (0, "")
    assert "384 cases, none without an answer" in out
    require_same(given, kept)


def test_a_worker_is_killed_with_what_it_has_solved(given, cluster, tmp_path, caplog):
    """What it had not handed over is solved again; whatever dask logs of it is nothing to the user."""

    def kill():
        logging.getLogger("of dask").error("a connection is lost")
        first = cluster.workers[0]
        with distributed.Client(cluster.address, set_as_default=False) as client:
            while first.poll() is None or len(client.nthreads()) > 1:
                states = client.run_on_scheduler(
                    lambda dask_scheduler: [*map(state, dask_scheduler.tasks.values())]
                )
                if len(states) > 6 and set(states) <= {"memory", "released", "forgotten"}:
                    first.kill()
                time.sleep(0.02)

    state = operator.attrgetter("state")
    calls = iter([kill])
    kept = swept(
        plan_of(given, AXES, measures="contact_force_rms"),
        tmp_path / "kept",
        cluster=cluster.address,
        progress=lambda *_: next(calls, int)(),
    )
    assert not kept.missing()
    require_same(given, tmp_path / "kept")
    assert not caplog.records
    logging.getLogger("of others").error("is heard again")
    assert len(caplog.records) == 1


def test_the_scheduler_is_killed(given, cluster, tmp_path):
    """One line; another one goes on from there."""
    kept = tmp_path / "kept"
    process = begun(given, cluster, kept)
    await_chunks(process, kept)
    cluster.scheduler.kill()
    _, said = process.communicate(timeout=30)
    assert process.returncode == 2
    assert "the scheduler of the cluster has ended" in said_in_a_line(said)
    before = stored(kept)
    assert 1 <= len(before) < 6
    swept(plan_of(given, AXES, measures="contact_force_rms"), kept)
    require_same(given, kept)
    assert before.items() < stored(kept).items()


def test_parts_by_a_worker_of_two_threads(given, tmp_path):
    """What a process chooses for itself is not a thread's own: one chunk after the other."""
    kept = tmp_path / "kept"
    with Cluster(tmp_path, workers=0) as cluster:
        cluster.add_worker(threads=2)
        for part, words in (("2/2", "3 chunks of other parts not yet"), ("1/2", "0 chunks")):
            out, said = begun(given, cluster, kept, "--part", part).communicate(timeout=60)
            assert said == ""
            assert words in out
    require_same(given, kept)


def test_workers_that_cannot_be_used(given, tmp_path):
    """Another version, none at all: one line each, and no number."""
    other = tmp_path / "other"
    shutil.copytree(SOURCE, other, ignore=shutil.ignore_patterns("__pycache__"))
    version = other / "movingfrf" / "_basics" / "version.py"
    version.write_text(version.read_text().replace(VERSION, "0.0.7"))
    # Stands before one that is installed.
    nothing = tmp_path / "nothing"
    (nothing / "movingfrf").mkdir(parents=True)
    (nothing / "movingfrf" / "__init__.py").touch()
    for source, words in (
        (other, f" has movingfrf 0.0.7 in place of {VERSION}"),
        (nothing, "ModuleNotFoundError: No module named 'movingfrf."),
    ):
        with Cluster(tmp_path, workers=0) as cluster:
            cluster.add_worker(source)
            process = begun(given, cluster, tmp_path / "kept")
            _, said = process.communicate(timeout=60)
            assert process.returncode == 2
            assert said_in_a_line(said).startswith("movingfrf: the cluster cannot solve the cases: ")
            assert words in said
            assert not stored(tmp_path / "kept")
            # It has not been ended by that.
            assert cluster.workers[0].poll() is None


def test_files_that_a_worker_does_not_have(tmp_path, monkeypatch):
    truck = scenario_in(tmp_path)
    # Named by a path that is the same wherever the sweep is called from.
    here = plan_of(truck, {"roughness": [FILE], "run.speed": [9.0]})
    monkeypatch.chdir(tmp_path)
    plan = plan_of("truck.toml", {"roughness": [FILE], "run.speed": [9.0]})
    assert plan.text == here.text
    with Cluster(tmp_path, workers=1) as cluster:
        road = (tmp_path / "road.csv").read_bytes()
        (tmp_path / "road.csv").write_bytes(road + b"\n")
        with pytest.raises(ChildProcessError, match=r"for a worker on .*road.csv holds something else; what is"):
            swept(plan, tmp_path / "kept", cluster=cluster.address)
        (tmp_path / "road.csv").unlink()
        with pytest.raises(ChildProcessError, match=r"for a worker on .*road.csv is not there; what is"):
            swept(plan, tmp_path / "kept", cluster=cluster.address)
        (tmp_path / "road.csv").write_bytes(road)
        assert not swept(plan, tmp_path / "kept", cluster=cluster.address).missing()


def test_what_is_refused(given, tmp_path, monkeypatch):
    """Before anything is computed, or written."""
    monkeypatch.setattr(chunks, "CHUNKING", replace(chunks.CHUNKING, answer=1.0))
    monkeypatch.setattr(module, "CHUNKING", chunks.CHUNKING)
    with pytest.raises(
        ConnectionError, match=r"no scheduler of dask\.distributed has answered at 127\.0\.0\.1:1 wi"
    ):
        swept(plan_of(given, {"run.speed": [9.0]}), tmp_path / "kept", cluster="127.0.0.1:1")
    with pytest.raises(ValueError, match="needs the address of its scheduler"):
        swept(plan_of(given, {"run.speed": [9.0]}), tmp_path / "kept", cluster=" ")
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(ValueError, match="or the extra `distributed`"):
        swept(plan_of(given, {"run.speed": [9.0]}), tmp_path / "kept", cluster="127.0.0.1:1")
    done = command("sweep", given, *ASKED, "--cluster", "127.0.0.1:1", "--workers", "2", "-o", tmp_path / "kept")
    assert done.returncode == 2
    assert "--workers and --cluster exclude each other" in said_in_a_line(done.stderr)
    assert not (tmp_path / "kept").exists()
