"""One decision of one robot as a page to read: prompts, replies, candidates, ranking, verdicts, choice."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from adhoc.evaluation.episode_result import EpisodeResult
from adhoc.evaluation.records import Record
from adhoc.evaluation.trace import Decision
from adhoc.prompting.clean import one_line

_MARKS = re.compile(r"[\\`*~\[\]]|(?<!\w)_|_(?!\w)")
"""What Markdown takes for more than text within a line; `<` and `>` are none after `one_line`."""
_MAX_CHARACTERS = 8000


def write_transcript(result: EpisodeResult, record: Record) -> str | None:
    """The episode's most telling sub-task decision in Markdown; None if no policy reported one.

    Most telling is the one with the most replies of teammates, then the most candidates; the earliest of
    equals. Whatever a policy left out of its trace is left out of the page. What robots and models said is
    text on it, and brings no markup of its own: no heading, link or picture.
    """
    decisions = [decision for decision in result.trace.decisions if _plan(decision)]
    if not decisions:
        return None
    chosen = max(decisions, key=lambda decision: (*_richness(_plan(decision)), -decision.step))
    return "\n".join(_page(chosen, record)) + "\n"


def _page(decision: Decision, record: Record) -> Iterator[str]:
    plan = _plan(decision)
    yield f"# A decision of {_plain(decision.agent)} at step {decision.step}"
    yield ""
    yield f"- episode: {_code(record['episode_id'])}"
    yield f"- policy: {_plain(record['policy_label'])}; language model: {_plain(record['model'] or 'none')}"
    if plan.get("reason"):
        yield f"- why it planned: {_plain(plan['reason'])}"
    yield f"- **chosen sub-task: {_plain(plan.get('chosen', 'unknown'))}**"
    if plan.get("fallback"):
        yield f"- safe choice taken because: {_plain(plan['fallback'])}"
    for skill in _listed(decision.trace.get("skills")):
        yield f"- sub-skill: {_plain(skill.get('chosen') or 'refused: ' + str(skill.get('refused')))}"
    yield ""
    yield from _section("Candidates", [_candidate(one) for one in _listed(plan.get("candidates"))])
    yield from _section("Ranking", [_candidate(one) for one in _listed(plan.get("ranking"))], numbered=True)
    yield from _section("Predictions", [_prediction(one) for one in _listed(plan.get("predictions"))])
    yield from _section("Teammates' replies", [_reply(one) for one in _listed(plan.get("replies"))])
    yield from _section("Verdicts", [_verdict(one) for one in _listed(plan.get("verdicts"))])
    skill_exchanges = [one for skill in _listed(decision.trace.get("skills")) for one in _exchanges(skill)]
    yield from _conversation("Sub-task planner", _exchanges(plan))
    yield from _conversation("Sub-skill planner", skill_exchanges)


def _section(title: str, items: Sequence[str], numbered: bool = False) -> Iterator[str]:
    if not items:
        return
    yield f"## {title}"
    yield ""
    for number, item in enumerate(items, start=1):
        yield f"{f'{number}.' if numbered else '-'} {item}"
    yield ""


def _conversation(title: str, exchanges: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    for exchange in exchanges:
        yield f"## {title}: {_plain(exchange.get('stage', 'model call'))}"
        yield ""
        for message in _listed(exchange.get("prompt")):
            yield from _quoted(f"Prompt ({_plain(message.get('role', 'user'))})", message.get("content"))
        yield from _quoted("Reply", exchange.get("reply"))


def _quoted(title: str, text: object) -> Iterator[str]:
    content = "".join(
        it if it.isprintable() or it in "\n\t" else "\N{REPLACEMENT CHARACTER}" for it in str(text)
    )
    fence = "```"
    while fence in content:
        fence += "`"
    yield from (f"### {title}", "", f"{fence}text", content, fence, "")


def _candidate(candidate: Mapping[str, Any]) -> str:
    score = candidate.get("score")
    line = _code(candidate.get("sub_task")) + ("" if score is None else f" (score {score:g})")
    return line + (f": {_plain(candidate['rationale'])}" if candidate.get("rationale") else "")


def _prediction(prediction: Mapping[str, Any]) -> str:
    parts = (prediction.get("sub_task") or "unknown", prediction.get("sub_skill") or "unknown")
    return f"**{_plain(prediction.get('teammate', 'somebody'))}**: {', '.join(map(_code, parts))}"


def _reply(reply: Mapping[str, Any]) -> str:
    return f"**{_plain(reply.get('sender', 'somebody'))}**: {_plain(reply.get('text', ''))}"


def _verdict(verdict: Mapping[str, Any]) -> str:
    word = "feasible" if verdict.get("feasible") else "refused"
    reason = f", {_plain(verdict['reason'])}" if verdict.get("reason") else ""
    return f"{_code(verdict.get('sub_task'))}: {word}{reason}"


def _plain(value: object) -> str:
    """Text that means the same in Markdown."""
    return _MARKS.sub(r"\\\g<0>", one_line(str(value), _MAX_CHARACTERS))


def _code(value: object) -> str:
    return "`" + one_line(str(value), _MAX_CHARACTERS).replace("`", "'") + "`"


def _plan(decision: Decision) -> Mapping[str, Any]:
    plan = decision.trace.get("decision")
    return plan if isinstance(plan, Mapping) else {}


def _richness(plan: Mapping[str, Any]) -> tuple[int, int]:
    return len(_listed(plan.get("replies"))), len(_listed(plan.get("candidates")))


def _exchanges(part: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    return _listed(part.get("exchanges"))


def _listed(value: object) -> list[Mapping[str, Any]]:
    """The mappings in a list, whatever the value is."""
    if not isinstance(value, Sequence) or isinstance(value, str):
        return []
    return [item for item in value if isinstance(item, Mapping)]
