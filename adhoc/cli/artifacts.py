"""What a run leaves beside its records: pictures and transcripts."""

from __future__ import annotations

from pathlib import Path

from adhoc.core.whole_file import write_whole
from adhoc.evaluation.episode_key import EpisodeKey
from adhoc.evaluation.episode_result import EpisodeResult
from adhoc.evaluation.records import Record, writing
from adhoc.evaluation.transcript import write_transcript
from adhoc.experiments.comparison import Artifact


def artifacts_for(folder: Path, pictures: bool, transcript: bool) -> list[Artifact]:
    """What to do with each fresh episode: `pictures/EPISODE.png`, `transcripts/EPISODE.md`."""

    def draw(key: EpisodeKey, result: EpisodeResult, record: Record) -> None:
        from adhoc.evaluation.picture import draw_episode

        draw_episode(result, record, folder / "pictures" / f"{key.id}.png")

    def write(key: EpisodeKey, result: EpisodeResult, record: Record) -> None:
        page = write_transcript(result, record)
        if page is not None:
            path = folder / "transcripts" / f"{key.id}.md"
            with writing(path):
                write_whole(path, page.encode())

    return [*([draw] if pictures else []), *([write] if transcript else [])]
