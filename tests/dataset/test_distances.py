from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from adhoc.dataset.likeness.distances import kolmogorov_smirnov, noise_floor, shares, total_variation

numbers = st.lists(st.integers(-5, 5), min_size=1, max_size=20)


class TestKolmogorovSmirnov:
    def test_hand_computed(self):
        # Up to 2, three of four numbers of the first and one of four of the second.
        assert kolmogorov_smirnov([1, 1, 2, 9], [2, 3, 4, 9]) == pytest.approx(0.5)
        assert kolmogorov_smirnov([1, 2, 3], [3, 2, 1]) == 0
        assert kolmogorov_smirnov([1, 2], [3, 4, 5]) == 1

    def test_ties_count_at_once(self):
        assert kolmogorov_smirnov([0, 0, 0, 1], [0, 1, 1, 1]) == pytest.approx(0.5)

    def test_samples_of_different_size(self):
        assert kolmogorov_smirnov([5], [1, 5, 9]) == pytest.approx(1 / 3)

    def test_an_empty_sample(self):
        with pytest.raises(ValueError, match="empty"):
            kolmogorov_smirnov([], [1.0])

    @given(numbers, numbers)
    def test_agrees_with_the_definition(self, first, second):
        gaps = [
            abs(sum(a <= x for a in first) / len(first) - sum(b <= x for b in second) / len(second))
            for x in {*first, *second}
        ]
        assert kolmogorov_smirnov(first, second) == pytest.approx(max(gaps))
        assert kolmogorov_smirnov(second, first) == pytest.approx(max(gaps))


class TestTotalVariation:
    def test_hand_computed(self):
        assert total_variation({"Chair": 3, "Bed": 1}, {"Chair": 1, "Bed": 1}) == pytest.approx(0.25)
        assert total_variation({"Chair": 2}, {"Chair": 50}) == 0
        assert total_variation({"Chair": 2}, {"Bed": 50}) == 1
        assert total_variation({"a": 1, "b": 1}, {"b": 1, "c": 1}) == pytest.approx(0.5)

    def test_nothing_counted(self):
        with pytest.raises(ValueError, match="nothing"):
            total_variation({}, {"Chair": 1})

    def test_shares_are_ranked(self):
        assert list(shares({"b": 1, "c": 2, "a": 1}).items()) == [("c", 0.5), ("a", 0.25), ("b", 0.25)]


class TestNoiseFloor:
    def test_of_two_numbers_it_is_their_distance(self):
        assert noise_floor([1, 2], kolmogorov_smirnov, np.random.default_rng(0)) == 1
        assert noise_floor([1, 1], kolmogorov_smirnov, np.random.default_rng(0)) == 0

    def test_is_near_theory_for_many_numbers(self):
        values = list(np.random.default_rng(1).random(400))
        found = noise_floor(values, kolmogorov_smirnov, np.random.default_rng(0))
        assert found == pytest.approx(0.87 * np.sqrt(2 / 200), rel=0.2)

    def test_equal_generators_give_equal_floors(self):
        values = list(range(50))
        first, second = (noise_floor(values, kolmogorov_smirnov, np.random.default_rng(7)) for _ in range(2))
        assert first == second

    def test_halves_are_disjoint_and_as_large(self):
        seen = []

        def note(first, second):
            seen.append((set(first), set(second)))
            return 0.0

        noise_floor(list(range(7)), note, np.random.default_rng(0), splits=3)
        assert [(len(a), len(b), len(a & b)) for a, b in seen] == [(3, 4, 0)] * 3

    def test_few_others_make_more_noise(self):
        values = list(np.random.default_rng(1).random(400))
        found = noise_floor(values, kolmogorov_smirnov, np.random.default_rng(0), most=10)
        assert found == pytest.approx(0.87 * np.sqrt(1 / 200 + 1 / 10), rel=0.2)

    def test_nothing_to_compare(self):
        assert noise_floor([1], kolmogorov_smirnov, np.random.default_rng(0)) is None
        assert noise_floor([1, 2], lambda a, b: None, np.random.default_rng(0)) is None
