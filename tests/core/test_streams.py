"""Streams are independent of each other and equal everywhere."""

from __future__ import annotations

from adhoc.core.streams import derive_seed, stream


def test_the_same_names_give_the_same_draws():
    assert stream(0, "agent", "a").integers(1 << 30, size=4).tolist() == (
        stream(0, "agent", "a").integers(1 << 30, size=4).tolist()
    )


def test_every_name_and_the_seed_matter():
    seeds = {
        derive_seed(0, "a", "b"),
        derive_seed(1, "a", "b"),
        derive_seed(0, "ab"),
        derive_seed(0, "b", "a"),
    }
    assert len(seeds) == 4


def test_seeds_are_the_same_on_every_machine():
    assert derive_seed(0, "agent", "newcomer") == 7131961440936484545
