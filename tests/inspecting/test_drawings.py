from __future__ import annotations

import sys
import xml.etree.ElementTree as ElementTree

import matplotlib.image
import numpy as np
import pytest
from matplotlib.colors import to_rgb
from PIL import Image
from watched_grid import watched

from adhoc.core.errors import ConfigurationError, MissingDependency
from adhoc.evaluation.palette import MISPLACED, REPLACED, robot_colour
from adhoc.inspecting import film, rerun_file
from adhoc.inspecting.film import LAST_FRAMES, film_frames, write_film
from adhoc.inspecting.key_step_figure import draw_key_steps
from adhoc.inspecting.moment_drawing import TEAM_PATH, placed_at
from adhoc.inspecting.rerun_file import load_rerun, write_rerun


@pytest.fixture(scope="module")
def pair():
    return [watched(None), watched(3)]


def pixels_of(colour, picture):
    """How many pixels of a picture (H, W, 3) in 0..255 have about this colour."""
    wanted = 255 * np.array(to_rgb(colour))
    return int((np.abs(picture[..., :3].astype(float) - wanted).max(axis=-1) < 8).sum())


class TestKeyStepFigure:
    def test_a_row_for_each_episode_with_paths_and_objects(self, pair, tmp_path):
        png, svg = draw_key_steps(pair, tmp_path / "pictures", "episode")
        picture = 255 * matplotlib.image.imread(png)
        one, _ = draw_key_steps(pair[:1], tmp_path, "alone")
        assert picture.shape[0] > 1.5 * matplotlib.image.imread(one).shape[0]
        for colour in (TEAM_PATH, robot_colour(0), MISPLACED, REPLACED, "#fbe8d3"):
            assert pixels_of(colour, picture) > 20, colour
        assert ElementTree.parse(svg).getroot().tag.endswith("svg")

    def test_equal_episodes_give_equal_files(self, pair, tmp_path):
        first, second = (draw_key_steps(pair, tmp_path / name, "episode") for name in "ab")
        for one, other in zip(first, second):
            assert one.read_bytes() == other.read_bytes()


class TestFilm:
    def test_a_gif_has_a_frame_for_every_step_and_keeps_its_colours(self, pair, tmp_path):
        path = tmp_path / "films" / "film.gif"
        frames = write_film(pair, path)
        assert frames == pair[0].result.steps + LAST_FRAMES
        with Image.open(path) as picture:
            assert 0 < picture.n_frames <= frames
            picture.seek(picture.n_frames - 1)
            last = np.asarray(picture.convert("RGB"))
        for colour in (robot_colour(0), robot_colour(1), MISPLACED, REPLACED):
            assert pixels_of(colour, last) > 20, colour

    def test_the_picture_changes_and_what_was_drawn_is_gone(self, pair):
        frames = list(film_frames(pair))
        assert (frames[0] != frames[6]).any()
        assert (frames[-1] == frames[-2]).all()
        assert pixels_of(REPLACED, frames[0]) < pixels_of(REPLACED, frames[-1])
        assert all(side % 2 == 0 for side in frames[0].shape[:2])

    def test_long_episodes_are_shown_in_strides(self, pair, monkeypatch):
        monkeypatch.setattr(film, "MOST_FRAMES", 5)
        assert len(list(film_frames(pair))) == 4 + LAST_FRAMES

    def test_mp4_without_the_extra_says_what_to_install(self, pair, tmp_path, monkeypatch):
        monkeypatch.setattr(film, "find_spec", lambda name: None)
        with pytest.raises(MissingDependency, match=r"pip install 'adhoc\[viz\]'"):
            write_film(pair, tmp_path / "film.mp4")
        assert not (tmp_path / "film.mp4").exists()

    def test_mp4_with_the_extra(self, pair, tmp_path):
        pytest.importorskip("imageio", reason="needs adhoc[viz]")
        pytest.importorskip("imageio_ffmpeg", reason="needs adhoc[viz]")
        assert write_film(pair, tmp_path / "film.mp4") == pair[0].result.steps + LAST_FRAMES
        assert (tmp_path / "film.mp4").read_bytes()[4:8] == b"ftyp"

    def test_other_endings_are_refused(self, pair, tmp_path):
        with pytest.raises(ConfigurationError, match=r"film\.avi: a film must end with \.gif or \.mp4"):
            write_film(pair, tmp_path / "film.avi")

    def test_an_object_that_is_taken_again_is_not_in_place_any_more(self, pair):
        one = pair[1]
        assert [placed_at(one, step) for step in (4, 5, 12)] == [set(), {"apple"}, {"apple"}]


class TestRerun:
    def test_without_the_extra_it_says_what_to_install(self, monkeypatch):
        monkeypatch.setitem(sys.modules, "rerun", None)
        with pytest.raises(MissingDependency, match=r"pip install 'adhoc\[rerun\]'"):
            load_rerun()

    def test_another_package_of_that_name_is_not_taken_for_it(self, monkeypatch):
        monkeypatch.setitem(sys.modules, "rerun", rerun_file)
        with pytest.raises(MissingDependency, match="the installed 'rerun' is another"):
            load_rerun()

    def test_a_recording_is_written(self, pair, tmp_path):
        pytest.importorskip("rerun", reason="needs adhoc[rerun]")
        path = tmp_path / "recordings" / "episode.rrd"
        write_rerun(pair[1], path)
        assert path.read_bytes()[:4] == b"RRF2"
        assert path.stat().st_size > 10_000
