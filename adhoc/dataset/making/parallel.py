"""Spreading work over processes, with results that do not depend on how many there are."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from typing import TypeVar

Progress = Callable[[int, int, str], None]
"""Is told how many pieces are done, of how many, and which was the latest."""
_Plan = TypeVar("_Plan")
_Result = TypeVar("_Result")


def in_processes(
    work: Callable[[_Plan], _Result],
    plans: Sequence[_Plan],
    workers: int,
    effort: Callable[[_Plan], float],
    name: Callable[[_Plan], str],
    progress: Progress,
) -> list[_Result]:
    """The results of `work` for all plans, in their order; those of most effort are begun first.

    With one worker everything happens in this process, else in spawned ones, which are given plans one at
    a time. What `work` raises is raised here, and ends the others.
    """
    order = sorted(range(len(plans)), key=lambda place: -effort(plans[place]))
    results: dict[int, _Result] = {}
    for place, result in _finished(work, plans, order, workers):
        results[place] = result
        progress(len(results), len(plans), name(plans[place]))
    return [results[place] for place in range(len(plans))]


def _finished(
    work: Callable[[_Plan], _Result], plans: Sequence[_Plan], order: Iterable[int], workers: int
) -> Iterator[tuple[int, _Result]]:
    if workers == 1:
        yield from ((place, work(plans[place])) for place in order)
        return
    pool = ProcessPoolExecutor(workers, mp_context=get_context("spawn"))
    try:
        places: dict[Future[_Result], int] = {pool.submit(work, plans[place]): place for place in order}
        for future in as_completed(places):
            yield places[future], future.result()
    finally:
        pool.shutdown(wait=True, cancel_futures=True)
