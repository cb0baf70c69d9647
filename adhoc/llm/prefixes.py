"""How much of each request a provider has just read, and may answer from its cache."""

from __future__ import annotations

import string

from adhoc.llm.model import LMRequest

_SMALL_LETTERS = string.ascii_lowercase.encode()


class SharedPrefixes:
    """Compares each request with the previous one of its stage, agent and sample, within one episode.

    Providers charge less for a prompt that begins as an earlier one did, up to the first byte that differs;
    hence prompts put first what stays the same. The first request of a stage shares nothing.
    """

    def __init__(self) -> None:
        self._previous: dict[tuple[str, str, int], bytes] = {}

    def share(self, request: LMRequest) -> float:
        """The part of the request's tokens, 0 to 1, in its beginning that equals that of the previous one.

        Tokens are told by all characters but small letters: in prompts of words, ids and numbers, there is
        about one token for each of these, while lengths in bytes would make the beginning, mostly prose, too
        large (by 2 to 3 hundredths).
        """
        text = _encoded(request)
        asked = request.stage, request.agent, request.sample
        previous = self._previous.get(asked, b"")
        self._previous[asked] = text
        whole = _tokens(text)
        return _tokens(text[: _common(previous, text)]) / whole if whole else 0.0


def _encoded(request: LMRequest) -> bytes:
    text = "".join(f"{message.role}\n{message.content}\0" for message in request.messages)
    return text.encode("utf-8", "surrogatepass")


def _tokens(text: bytes) -> int:
    return len(text.translate(None, _SMALL_LETTERS))


def _common(first: bytes, second: bytes) -> int:
    """The length of the common beginning, by bisection: prompts are long and compared at every call."""
    low, high = 0, min(len(first), len(second))
    while low < high:
        middle = (low + high + 1) // 2
        if first[low:middle] == second[low:middle]:
            low = middle
        else:
            high = middle - 1
    return low
