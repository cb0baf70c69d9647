"""A thousand houses outside the benchmark, all sound; `pytest -m slow -s` shows the rejection rates."""

from __future__ import annotations

import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import pytest

from adhoc.core.streams import derive_seed
from adhoc.dataset.checks.gravity import check_gravity
from adhoc.dataset.checks.house_checks import check_house
from adhoc.dataset.generator import ROOM_COUNTS, generate_house

HOUSES = [(rooms, number) for rooms in ROOM_COUNTS for number in range(100)]
HOUSES += [(ROOM_COUNTS[number % len(ROOM_COUNTS)], 100 + number) for number in range(100)]


@pytest.mark.slow
@pytest.mark.timeout(3000)
def test_nothing_is_wrong_with_a_thousand_houses():
    with ProcessPoolExecutor(max_workers=2, mp_context=get_context("spawn")) as pool:
        results = list(pool.map(inspected, *zip(*HOUSES), chunksize=10))
    assert len(results) == 1000
    sys.stdout.write(rejection_table(results))
    assert [violation for _, _, violations in results for violation in violations] == []


def inspected(rooms: int, number: int) -> tuple[int, tuple[str, ...], list[str]]:
    """Number of rooms of one house, why its earlier attempts were rejected, and what is wrong with it."""
    generated = generate_house(rooms, derive_seed(0, "thousand houses", number))
    violations = [*check_house(generated.house), *check_gravity(generated.house)]
    return rooms, generated.rejected, [f"{generated.house.source}: {violation}" for violation in violations]


def rejection_table(results: list[tuple[int, tuple[str, ...], list[str]]]) -> str:
    lines = ["", "rooms  houses  rejected attempts per 100 attempts, and why"]
    for rooms in ROOM_COUNTS:
        reasons = [rejected for count, rejected, _ in results if count == rooms]
        checks = Counter(reason.split(":")[0] for rejected in reasons for reason in rejected)
        share = 100 * checks.total() / (checks.total() + len(reasons))
        why = ", ".join(f"{check} {count}" for check, count in checks.most_common())
        lines.append(f"{rooms:5d} {len(reasons):7d} {share:9.1f}  {why}")
    return "\n".join([*lines, ""])
