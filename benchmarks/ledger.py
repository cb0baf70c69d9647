"""What the models around a backend add to a call, with a ledger of 100,000 calls, in one run on this machine.

    python benchmarks/ledger.py [CALLS]

The backend answers at once, so that all that is measured is the stack: validating, counting, caps of episode
and run, ledger, retries. Beside it stands what it takes to write the same bytes to the same disk and to wait
for them to arrive, which the ledger does not do.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from collections.abc import Callable, Iterable
from itertools import chain, count
from pathlib import Path
from statistics import median, quantiles

from rich.console import Console

from adhoc.core.chat import ChatMessage
from adhoc.core.replies import Reading, ReplyFormat
from adhoc.llm.budget import Caps, EpisodeCapModel, RunCapModel
from adhoc.llm.counting import CountingModel
from adhoc.llm.ledger.entry import FORMAT, VERSION, Entry, Header
from adhoc.llm.ledger.index import open_ledger
from adhoc.llm.ledger.key import CallKeys
from adhoc.llm.ledger.line import encoded
from adhoc.llm.ledger.recording import LedgerModel
from adhoc.llm.ledger.spending import spent
from adhoc.llm.ledger.translation import answer_entry, call_entry, texts_of
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Usage
from adhoc.llm.retrying import RetryingModel
from adhoc.llm.validating import ValidatingModel

MEASURED = 500
SYSTEM = "You are one of several robots that tidy up a home together. " * 160
SCENE = "Mug-3 lies on DiningTable-1 in the kitchen, 0.42 kg, 2.1 m away. " * 100
REPLY = '{"sub_task": "move", "object": "Mug-3", "to": "Sink-1"}'
RAW = {"id": "chatcmpl-0", "choices": [{"index": 0, "message": {"role": "assistant", "content": REPLY}}]}
FORM = ReplyFormat("sub_task", {"type": "object", "required": ["sub_task"]}, Reading)


class Instant(LanguageModel):
    """A backend that takes no time."""

    name = "instant"

    def complete(self, request: LMRequest) -> LMResponse:
        """Always the same."""
        return LMResponse(REPLY, self.name, Usage(4500, 20, 0.05), raw=RAW)


def main(calls: int) -> None:
    """Print all figures."""
    say = Console(width=110, highlight=False).print
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_ledger(folder, calls)
        size = sum(path.stat().st_size for path in folder.iterdir()) / 2**20
        say(f"a ledger of {calls} calls ({size:.0f} MB), prompts of {(len(SYSTEM) + len(SCENE)) // 1000} kB")
        opened, added = seconds(lambda: open_ledger(folder)), seconds(lambda: spent(folder))
        say(f"  opened in {opened:.1f} s, its cost added up in {added:.1f} s")
        numbers = count()
        alone = times(Instant(), numbers)
        stack = chain_around(Instant(), folder)
        new = times(stack, numbers)
        stack.begin_episode("bench", 0)
        again = times(stack, count(MEASURED))
        by_hand = median(disk_times(folder))
    extra, again_extra = (median(these) - median(alone) for these in (new, again))
    slow = quantiles(new, n=20)[-1]
    say(f"  the stack adds {1000 * extra:.2f} ms to a new call at the median (95%: {1000 * slow:.2f} ms)")
    say(f"  the same bytes written and synced by hand: {1000 * by_hand:.2f} ms; ratio {extra / by_hand:.2f}")
    say(f"  a call from the ledger: {1000 * again_extra:.2f} ms")


def chain_around(backend: LanguageModel, folder: Path) -> LanguageModel:
    """Everything that stands between a planner and a backend."""
    caps = Caps(calls=10**9, tokens=10**12, usd=10.0**9)
    recorded = LedgerModel(RunCapModel(RetryingModel(backend), caps), folder)
    model = ValidatingModel(CountingModel(EpisodeCapModel(recorded, caps)))
    model.begin_episode("bench", 0)
    return model


def request(number: int, scene: str = SCENE) -> LMRequest:
    """A request like no other number's."""
    messages = (ChatMessage("system", SYSTEM), ChatMessage("user", f"{scene} Step {number}."))
    return LMRequest(messages, "generate", reply=FORM, agent="r1", episode="bench", seed=0)


def times(model: LanguageModel, numbers: Iterable[int]) -> list[float]:
    """Seconds of each of some calls."""
    asked = [request(number) for number, _ in zip(numbers, range(MEASURED))]
    return [seconds(lambda one=one: model.complete(one)) for one in asked]  # type: ignore[misc]


def disk_times(folder: Path) -> list[float]:
    """Seconds to append and sync what one call appends and syncs."""
    one = request(0)
    texts = list(texts_of(one))
    call = call_entry("0" * 64, 0, one, "instant")
    before = b"".join(map(encoded, [texts[-1], call]))
    after = encoded(answer_entry("0" * 64, Instant().complete(one), 0.0))
    with open(folder / "by-hand.bin", "ab", buffering=0) as file:

        def write() -> None:
            for data in (before, after):
                file.write(data)
                os.fsync(file.fileno())

        return [seconds(write) for _ in range(MEASURED)]


def write_ledger(folder: Path, calls: int) -> None:
    """A ledger of so many answered calls with short prompts."""
    keys = CallKeys(Instant.name, {})
    header = Header(FORMAT, VERSION, "bench", Instant.name, None, {}, "2000-01-01T00:00:00.000+00:00")
    with open(folder / "earlier.jsonl", "wb") as file:
        file.write(encoded(header))
        for number in range(calls):
            file.writelines(map(encoded, entries(keys, -1 - number)))


def entries(keys: CallKeys, number: int) -> Iterable[Entry]:
    """What one call leaves in a ledger."""
    one = request(number, "Nothing is to be seen.")
    key, repeat = keys.next(one)
    first = list(texts_of(one)) if number == -1 else list(texts_of(one))[-1:]
    return chain(
        first, [call_entry(key, repeat, one, "instant"), answer_entry(key, Instant().complete(one), 0.5)]
    )


def seconds(work: Callable[[], object]) -> float:
    """How long it takes."""
    started = time.perf_counter()
    work()
    return time.perf_counter() - started


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 100_000)
