"""The same work on many items in several processes, made by fork: what is imported and loaded is shared.

All numbers of chunks stand in one pipe before the first process begins, and whoever is free takes the next,
so that nobody waits for an answer. Results come back as plain data through a pipe for each process. A process
that ends before it said so is noticed by the end of its pipe.
"""

from __future__ import annotations

import contextlib
import marshal
import os
import select
import signal
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, NoReturn

from xei_lang.cli.bug import ReportedBugError, bug_lines

Work = Callable[[int], Any]
"""Item number to a result of plain data (what marshal takes)."""

_CHUNKS = 1000
"""At most so many chunks: their numbers must fit into a pipe that nobody reads yet (4096 bytes at least)."""
_LARGEST = 8


class WorkerDiedError(Exception):
    """A process ended too soon; `items` are those that it was at."""

    def __init__(self, how: str, items: Sequence[int]) -> None:
        super().__init__(how)
        self.how = how
        self.items = items


@dataclass(slots=True, eq=False)
class _Worker:
    """A process (0 once it is gone), the chunk that it is at, what has come of its next message."""

    pid: int
    chunk: int | None = None
    ended: bool = False
    received: bytearray = field(default_factory=bytearray)


def in_processes(work: Work, count: int, processes: int, progress: Callable[[int], None]) -> list[Any]:
    """The results of `work` for the items 0 to `count - 1`, in their order. `progress` is told how many are
    done.

    Raises WorkerDiedError, ReportedBugError, or OSError where the system makes no process; however it ends,
    no process is left.
    """
    size = max(1, min(_LARGEST, count // (processes * 4)), -(-count // _CHUNKS))
    chunks = [range(start, min(start + size, count)) for start in range(0, count, size)]
    tasks = _tasks(len(chunks))
    workers: dict[int, _Worker] = {}
    try:
        for _ in range(min(processes, len(chunks))):
            _start(work, chunks, tasks, workers)
        return _collect(workers, chunks, progress)
    finally:
        os.close(tasks)
        for pipe, worker in workers.items():
            os.close(pipe)
            if worker.pid:
                os.kill(worker.pid, signal.SIGKILL)
                os.waitpid(worker.pid, 0)


def _tasks(chunks: int) -> int:
    reading, writing = os.pipe()
    os.write(writing, b"".join(number.to_bytes(4, "big") for number in range(chunks)))
    os.close(writing)
    return reading


def _start(work: Work, chunks: Sequence[range], tasks: int, workers: dict[int, _Worker]) -> None:
    reading, writing = os.pipe()
    # An interrupt between fork and the new process's own handling of it would end both in the same way.
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        pid = os.fork()
        if pid == 0:
            _live(work, chunks, tasks, writing, (reading, *workers), before)
        workers[reading] = _Worker(pid)
    except OSError:
        os.close(reading)
        if not workers:
            raise
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
        os.close(writing)


def _live(
    work: Work, chunks: Sequence[range], tasks: int, writing: int, others: tuple[int, ...], mask: set[Any]
) -> NoReturn:
    """The whole life of a process: chunk after chunk; nothing of the parent's is flushed or cleaned up."""
    try:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        for pipe in others:
            os.close(pipe)
        results: list[Any] = []
        while number := os.read(tasks, 4):
            chunk = int.from_bytes(number, "big")
            _send(writing, ("takes", chunk, results))
            results = [(item, work(item)) for item in chunks[chunk]]
        _send(writing, ("ends", None, results))
    except BaseException as bug:
        with contextlib.suppress(OSError):  # nobody may listen any more
            _send(writing, ("bug", None, bug_lines(bug)))
    finally:
        os._exit(0)


def _send(pipe: int, message: tuple[Any, ...]) -> None:
    payload = marshal.dumps(message)
    data = memoryview(len(payload).to_bytes(8, "big") + payload)
    while data:
        data = data[os.write(pipe, data) :]


def _collect(
    workers: dict[int, _Worker], chunks: Sequence[range], progress: Callable[[int], None]
) -> list[Any]:
    found: dict[int, Any] = {}
    while waiting := [pipe for pipe, worker in workers.items() if not worker.ended]:
        for pipe in select.select(waiting, [], [])[0]:
            data = os.read(pipe, 1 << 20)
            if not data:
                _died(workers[pipe], chunks)
            for results in _messages(workers[pipe], data):
                found.update(results)
                progress(len(found))
    return [found[item] for item in sorted(found)]


def _messages(worker: _Worker, data: bytes) -> list[Any]:
    """The results in what has come; takes note of where the process is."""
    received, found = worker.received, list[Any]()
    received += data
    while len(received) >= 8 and len(received) >= 8 + (size := int.from_bytes(received[:8], "big")):
        kind, chunk, content = marshal.loads(received[8 : 8 + size])
        del received[: 8 + size]
        if kind == "bug":
            raise ReportedBugError(content)
        worker.chunk, worker.ended = chunk, kind == "ends"
        found.append(content)
    return found


def _died(worker: _Worker, chunks: Sequence[range]) -> NoReturn:
    pid, worker.pid = worker.pid, 0
    code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
    if code == -signal.SIGINT:
        raise KeyboardInterrupt
    how = f"was ended by {signal.Signals(-code).name}" if code < 0 else f"ended with exit code {code}"
    raise WorkerDiedError(how, () if worker.chunk is None else chunks[worker.chunk])
