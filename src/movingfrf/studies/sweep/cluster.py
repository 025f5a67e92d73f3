"""Chunks of a sweep that the workers of a running scheduler of dask.distributed solve (the extra `distributed`).

A chunk is a task, so that there are thousands at most. Its bytes come back and are written here as it is done: a
cluster need not see the folder of the sweep, and what is killed loses no more than what was being solved.
"""

from __future__ import annotations

import json
import logging
import platform
import secrets
import time
import warnings
from collections.abc import Iterator, Sequence
from concurrent.futures import CancelledError
from contextlib import contextmanager
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, version
from operator import call
from pkgutil import resolve_name
from threading import Lock
from typing import TYPE_CHECKING, Any

from threadpoolctl import threadpool_limits

from movingfrf._basics.progress import Progress
from movingfrf._basics.version import VERSION
from movingfrf.scenarios.variants import Variants
from movingfrf.studies.sweep.chunks import CHUNKING, InFolder, as_bytes, cases_of
from movingfrf.studies.sweep.plan import Plan
from movingfrf.studies.sweep.solving import solved

if TYPE_CHECKING:
    from distributed import Client, Future

# What is chosen for a process (compiled or not, warnings, threads of BLAS) is not a thread's own.
_one_at_a_time = Lock()


def software() -> dict[str, str]:
    """Tell the versions that the last digits depend on, by name."""
    found = dict(movingfrf=VERSION)
    for name in ("numpy", "scipy", "numba"):
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "none"
    return found


def chunk_of(number: int, asked: str) -> bytes:
    """Solve a chunk: what a worker does.

    Parameters
    ----------
    number : int
        Which.
    asked : str
        The sweep and the software with which it was asked for, as JSON.

    Returns
    -------
    bytes
        What is stored of it.

    Raises
    ------
    ValueError
        If this machine has other versions, lacks a file that the sweep names, or holds another of that name.
    """
    with _one_at_a_time, threadpool_limits(1):
        plan, variants = _prepared(asked)
        return as_bytes(solved(plan, variants, *cases_of(number, plan.axes.cases)))


@lru_cache(maxsize=1)
def _prepared(asked: str) -> tuple[Plan, Variants]:
    """Give a sweep and its scenarios, which remember what they made from chunk to chunk; or refuse it."""
    needed, text = json.loads(asked)
    there, plan = software(), Plan.of_text(text)
    other = [f"{name} {there[name]} in place of {needed[name]}" for name in needed if there[name] != needed[name]]
    if other:
        raise ValueError(f"a worker on {platform.node()} has {' and '.join(other)}")
    try:
        plan.require_files()
    except ValueError as refused:
        raise ValueError(f"for a worker on {platform.node()} {refused}") from None
    return plan, plan.to_solve


@contextmanager
def scheduler_at(address: str) -> Iterator[Client]:
    """Be a client of a scheduler while the block lasts; what is not done by then is not done.

    Parameters
    ----------
    address : str
        Where it listens, as `tcp://host:8786`.

    Yields
    ------
    Client
        Of dask.distributed, which says nothing by itself: it would of every connection that is lost.

    Raises
    ------
    ValueError
        If there is no address, or dask.distributed is not installed.
    ConnectionError
        If nobody answers.
    """
    if not address.strip():
        raise ValueError("a cluster needs the address of its scheduler, as tcp://host:8786, got an empty text")
    try:
        import dask
        from distributed import Client
    except ImportError:
        raise ValueError(
            "a cluster needs dask.distributed: pip install distributed, or the extra `distributed`"
        ) from None
    before = logging.root.manager.disable
    logging.disable()
    try:
        with warnings.catch_warnings(), dask.config.set({"distributed.comm.timeouts.connect": CHUNKING.answer}):
            warnings.simplefilter("ignore")
            try:
                client = Client(address, timeout=CHUNKING.answer, set_as_default=False)
            except Exception:  # of many kinds: no such host, nobody there, somebody who speaks another language
                raise ConnectionError(
                    f"no scheduler of dask.distributed has answered at {address} within {CHUNKING.answer:g} s"
                ) from None
            try:
                yield client
            finally:
                if client.status == "running":  # else it tries to find the scheduler again, and ends by itself
                    client.close(timeout=CHUNKING.answer)
    finally:
        logging.disable(before)


def carried_out_by(client: Client, plan: Plan, kept: InFolder, chunks: Sequence[int], progress: Progress) -> None:
    """Have chunks solved by the workers of a cluster, and store each as it is done.

    Parameters
    ----------
    client : Client
        Of a scheduler.
    plan : Plan
        The sweep.
    kept : InFolder
        Where chunks are stored.
    chunks : sequence of int
        Which are solved.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Raises
    ------
    ChildProcessError
        If a worker is refused (`chunk_of`), fails, or a chunk has ended one worker after the other.
    ConnectionError
        If the scheduler has ended.
    """
    name = f"movingfrf-{secrets.token_hex(8)}"
    # The plan may be long: a task of its own, from which the others take it, and which is repeated if it is lost.
    # What they call is named and not handed over: a scheduler or a worker that cannot load it would end by that.
    function = (resolve_name, f"{__name__}:{chunk_of.__name__}")
    graph: dict[str, Any] = {name: (str, json.dumps([software(), plan.text]))}
    keys = [f"{name}-{number}" for number in chunks]
    graph |= {key: (call, function, number, name) for key, number in zip(keys, chunks, strict=True)}
    with _connected():
        stage = "cases" if client.nthreads() else "waiting for workers"
        waiting = dict(zip(client.get(graph, keys, sync=False), chunks, strict=True))
    while waiting:
        progress(stage, 1.0 - len(waiting) / len(chunks))
        done = [task for task in waiting if task.status == "finished"]
        with _connected():
            contents = client.gather(done)
        for task, content in zip(done, contents, strict=True):
            # Nothing refers to it any more, upon which the cluster forgets it.
            kept.store(waiting.pop(task), content)
            stage = "cases"
        # Whatever is done is stored, and then told what went wrong.
        for task in waiting:
            _require_well(task)
        if not done:
            time.sleep(CHUNKING.look)


def _require_well(task: Future) -> None:
    """Refuse to go on without a task; one that is lost with a worker is done again by another."""
    if task.status == "cancelled":
        raise _alone()
    if task.status == "error":
        with _connected():
            error = task.exception()
        raise _unsolved(error)


@contextmanager
def _connected() -> Iterator[None]:
    """Say what goes wrong with a scheduler, of many kinds, in a line."""
    try:
        yield
    except (CancelledError, OSError):
        raise _alone() from None
    except Exception as error:  # what a worker found wrong, between two looks
        raise _unsolved(error) from None


def _alone() -> ConnectionError:
    return ConnectionError(f"the scheduler of the cluster has ended, or cancelled the sweep; {_goes_on()}")


def _unsolved(error: BaseException) -> ChildProcessError:
    # Of a refusal its words say enough.
    said = str(error) if isinstance(error, ValueError) else f"{type(error).__name__}: {error}"
    return ChildProcessError(f"the cluster cannot solve the cases: {' '.join(said.split())}; {_goes_on()}")


def _goes_on() -> str:
    return "what is solved is kept, and called again the sweep goes on from there"
