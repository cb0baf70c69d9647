"""`adhoc inspect DIR EPISODE`: an episode of a run as a page, as pictures, as a film."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from adhoc.cli.output_files import check_output
from adhoc.cli.replaying import ReplayFolder
from adhoc.cli.trust import add_trust
from adhoc.core.errors import ConfigurationError
from adhoc.inspecting.watching import Watched

FILMS = (".gif", ".mp4")
MOST_LISTED = 100


def main(arguments: Sequence[str]) -> int:
    """Replay and draw. Raises AdhocError for whatever is wrong with the input."""
    options = _parse(arguments)
    _check(options)
    folder = ReplayFolder(options.folder, options.trust)
    console = Console(highlight=False, markup=False, soft_wrap=True)
    if options.episode is None:
        _list(folder, console)
        return 0
    try:
        watched = _watch(folder, options.episode, options.beside, console)
    finally:
        folder.close()
    for path in _written(watched, options):
        console.print(f"written: {path}")
    return 0


def _parse(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="adhoc inspect",
        description="Replay an episode of a run without any call of a model, and write one HTML file that "
        "shows every step, message and decision, beside the episode of the team alone.",
    )
    parser.add_argument("folder", metavar="DIR", type=Path, help="the folder of the run")
    parser.add_argument("episode", metavar="EPISODE", nargs="?", help="its id; without it, ids are listed")
    parser.add_argument("--out", type=Path, metavar="FILE", help="the page (DIR/inspect/EPISODE.html)")
    parser.add_argument(
        "--beside",
        action="append",
        metavar="EPISODE2",
        help="another episode of the same task to show beside it (the team alone); may be repeated",
    )
    parser.add_argument("--pictures", type=Path, metavar="DIR", help="draw key steps as PNG and SVG into DIR")
    parser.add_argument("--film", type=Path, metavar="FILE", help="draw a film, .gif or .mp4 (adhoc[viz])")
    parser.add_argument("--rrd", type=Path, metavar="FILE", help="write a Rerun recording (adhoc[rerun])")
    add_trust(parser)
    return parser.parse_args(list(arguments))


def _check(options: argparse.Namespace) -> None:
    """What can be wrong with the options shows before minutes are spent on a replay."""
    check_output("--out", options.out)
    if options.film is not None:
        if options.film.suffix.lower() not in FILMS:
            raise ConfigurationError(f"--film {options.film}: must end with {' or '.join(FILMS)}")
        from adhoc.inspecting.film import check_film

        check_film(options.film)
    if options.rrd is not None:
        if options.rrd.suffix.lower() != ".rrd":
            raise ConfigurationError(f"--rrd {options.rrd}: must end with .rrd")
        from adhoc.inspecting.rerun_file import load_rerun

        load_rerun()


def _list(folder: ReplayFolder, console: Console) -> None:
    for record in folder.records[:MOST_LISTED]:
        outcome = "success" if record["success"] else record["ending"]
        console.print(f"{record['episode_id']}  {outcome}, {record['steps']} steps")
    if len(folder.records) > MOST_LISTED:
        console.print(f"... {len(folder.records)} episodes; episodes.jsonl has all of them")


def _watch(
    folder: ReplayFolder, episode_id: str, beside: Sequence[str] | None, console: Console
) -> list[Watched]:
    """The episode, behind those that it is shown beside."""
    record = folder.record(episode_id)
    others = [folder.record(it)["episode_id"] for it in beside or [folder.alone(record)["episode_id"]]]
    watched = []
    for one in dict.fromkeys([*others, str(record["episode_id"])]):
        console.print(f"replaying {one}")
        watched.append(folder.replay(one))
    return watched


def _written(watched: Sequence[Watched], options: argparse.Namespace) -> list[Path]:
    from adhoc.inspecting.page import write_page

    name = str(watched[-1].record["episode_id"])
    page = options.out or options.folder / "inspect" / f"{name}.html"
    write_page(watched, page)
    written: list[Path] = [page]
    if options.pictures is not None:
        from adhoc.inspecting.key_step_figure import draw_key_steps

        written += draw_key_steps(watched, options.pictures, name)
    if options.film is not None:
        from adhoc.inspecting.film import write_film

        write_film(watched, options.film)
        written.append(options.film)
    if options.rrd is not None:
        from adhoc.inspecting.rerun_file import write_rerun

        write_rerun(watched[-1], options.rrd)
        written.append(options.rrd)
    return written
