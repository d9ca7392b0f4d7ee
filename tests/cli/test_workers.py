"""Several processes give what one gives; one that dies or fails ends the work, with words."""

from __future__ import annotations

import os
import signal

import pytest

from xei_lang.cli.bug import ReportedBugError
from xei_lang.cli.workers import WorkerDiedError, in_processes


def no_child_is_left() -> bool:
    try:
        os.waitpid(-1, os.WNOHANG)
    except ChildProcessError:
        return True
    return False


@pytest.mark.parametrize("count", [1, 2, 7, 2500])
@pytest.mark.parametrize("processes", [1, 2, 5])
def test_results_keep_their_order(count, processes):
    told: list[int] = []
    found = in_processes(lambda item: [item, str(item)], count, processes, told.append)
    assert found == [[item, str(item)] for item in range(count)]
    assert told == sorted(told)
    assert told[-1] == count
    assert no_child_is_left()


def test_the_work_is_done_in_other_processes():
    assert os.getpid() not in in_processes(lambda _: os.getpid(), 8, 2, lambda _: None)


def test_results_larger_than_a_pipe_arrive():
    found = in_processes(lambda item: "x" * (300_000 + item), 6, 2, lambda _: None)
    assert [len(text) for text in found] == [300_000 + item for item in range(6)]


@pytest.mark.parametrize("item", [0, 5, 19])
def test_a_process_that_is_killed_is_told_of_with_what_it_was_at(item):
    def work(number: int) -> int:
        if number == item:
            os.kill(os.getpid(), signal.SIGKILL)
        return number

    with pytest.raises(WorkerDiedError) as death:
        in_processes(work, 20, 2, lambda _: None)
    assert death.value.how == "was ended by SIGKILL"
    assert item in death.value.items
    assert no_child_is_left()


def test_a_process_that_leaves_is_told_of():
    with pytest.raises(WorkerDiedError, match="ended with exit code 7"):
        in_processes(lambda _: os._exit(7), 4, 2, lambda _: None)


def test_a_process_that_was_interrupted_interrupts_all():
    with pytest.raises(KeyboardInterrupt):
        in_processes(lambda _: os.kill(os.getpid(), signal.SIGINT), 4, 2, lambda _: None)
    assert no_child_is_left()


@pytest.mark.parametrize("error", [ValueError("odd"), OSError("odd"), RecursionError("odd")])
def test_an_exception_comes_over_as_a_bug(error):
    def work(_number: int) -> None:
        raise error

    with pytest.raises(ReportedBugError) as bug:
        in_processes(work, 4, 2, lambda _: None)
    assert bug.value.lines[0].startswith("internal error: this is a bug in xei")
    assert bug.value.lines[-1].strip() == f"{type(error).__name__}: odd"
    assert no_child_is_left()
