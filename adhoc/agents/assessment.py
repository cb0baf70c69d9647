"""State assessment (paper, section State Assessment): what became of an action, and what to plan again."""

from __future__ import annotations

from adhoc.agents.news import News
from adhoc.core.calls import Call
from adhoc.core.plans import Assessment, Replan
from adhoc.core.values import Observation


def assess_action(observation: Observation) -> Assessment | None:
    """Whether the last low-level action worked, with the world's reason where not; None at the start."""
    result = observation.last_result
    if result is None:
        return None
    if result.ok:
        return Assessment(True)
    reason = f"{result.action} failed: {result.failure.value if result.failure else ''}"
    return Assessment(False, f"{reason} ({result.detail})" if result.detail else reason)


def assess_skill(call: Call, failure: str | None, failures_in_a_row: int, patience: int) -> Assessment:
    """Whether a sub-skill succeeded.

    A failure asks for another sub-skill, and after `patience` failures in a row for another sub-task: the
    paper re-plans on failure and leaves the number open.
    """
    if failure is None:
        return Assessment(True, f"{call} succeeded", Replan.SKILL)
    replan = Replan.TASK if failures_in_a_row >= patience else Replan.SKILL
    return Assessment(False, f"{call} failed: {failure}", replan)


def assess_news(
    news: News, settled: tuple[str, ...], useful_receptacles: tuple[str, ...]
) -> Assessment | None:
    """What newly detected things mean for the plan, None if nothing.

    Misplaced objects, a teammate that stopped, and objects of the current sub-task that turn out to need
    nothing any more (`settled`) ask for another sub-task; receptacles that may take the object at hand
    (`useful_receptacles`) ask for another sub-skill.
    """
    if settled:
        return Assessment(True, f"no longer needed: {', '.join(settled)}", Replan.TASK)
    found = (*news.misplaced, *news.told)
    if found:
        return Assessment(True, f"found misplaced: {', '.join(found)}", Replan.TASK, found)
    if news.stopped:
        return Assessment(True, f"stopped: {', '.join(news.stopped)}", Replan.TASK)
    if useful_receptacles:
        return Assessment(True, f"found: {', '.join(useful_receptacles)}", Replan.SKILL, useful_receptacles)
    return None
