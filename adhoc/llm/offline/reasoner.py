"""The offline reasoner: the default language model of the library, which is none."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from typing import Any

from adhoc.core.errors import ConfigurationError
from adhoc.core.values import Place
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Usage
from adhoc.llm.offline.course import next_skill, searching_skill
from adhoc.llm.offline.evaluation import Effect, evaluate
from adhoc.llm.offline.facts import CallText, Facts, TeammateFact
from adhoc.llm.offline.judgement import judge
from adhoc.llm.offline.knowledge import Knowledge
from adhoc.llm.offline.mistakes import MistakeRates, mistaken
from adhoc.llm.offline.negotiation import disagreements
from adhoc.llm.offline.options import Option, options
from adhoc.llm.offline.reading import read_prompt

OFFLINE_NAME = "offline (not a language model)"
_COUNT = re.compile(r"\b(\d+) different\b")
_CHARACTERS_PER_TOKEN = 4


class OfflineReasoner(LanguageModel):
    """A deterministic stand-in that sees nothing but the prompt, needs no key and no network.

    It reads the prompt that a real model would get, so a fact that is missing from a prompt shows as a bad
    plan. It knows no task: it fills the vocabulary that the prompt lists with the things that the prompt
    names, prefers what needs attention and is near, leaves alone what teammates are at, and follows the
    usual course that the prompt prints. Every stage is a reading of its own prompt: evaluation weighs the
    candidates that it finds there by their effect on the team (`offline.evaluation`), whoever generated them.
    It makes three kinds of mistakes, as models do. None of them is about where things belong: asked for that,
    it tells its prior knowledge.

    Its token counts are a convention: one token per four characters, rounded up. It costs nothing.

    Args:
        places: Where things belong, by category, likeliest first: prior knowledge, as in a model's weights.
        seed: Of the mistakes.
        forget_capability: Probability per call to forget that it cannot manipulate or lift something.
        ignore_teammate: Probability per call to overlook one teammate.
        ignore_reply: Probability per call to overlook one reply.

    Raises:
        ConfigurationError: a probability is not within 0 to 1.
    """

    def __init__(
        self,
        places: Mapping[str, Sequence[Place]],
        seed: int = 0,
        forget_capability: float = 0.05,
        ignore_teammate: float = 0.05,
        ignore_reply: float = 0.05,
    ) -> None:
        rates = {
            "forget_capability": forget_capability,
            "ignore_teammate": ignore_teammate,
            "ignore_reply": ignore_reply,
        }
        for name, rate in rates.items():
            if not 0.0 <= rate <= 1.0:
                raise ConfigurationError(f"OfflineReasoner: {name} is {rate}, it must be within 0 to 1")
        self._knowledge = Knowledge(places)
        self._seed = seed
        self._rates = MistakeRates(**rates)

    @property
    def name(self) -> str:
        """`offline (not a language model)`: no record may pass it off as one."""
        return OFFLINE_NAME

    def complete(self, request: LMRequest) -> LMResponse:
        """See `LanguageModel`. Never fails; a prompt that it cannot read gives an empty JSON object."""
        texts = [message.content for message in request.messages]
        prompt = "\n".join(texts)
        facts = read_prompt(texts)
        facts = mistaken(facts, self._rates, self._seed, prompt, request.sample)
        answer = self._answer(facts)
        if '"analysis"' not in facts.output_format:
            answer.pop("analysis", None)
        text = json.dumps(answer, ensure_ascii=False)
        return LMResponse(text, self.name, Usage(_tokens(prompt), _tokens(text)))

    def _answer(self, facts: Facts) -> dict[str, Any]:
        """The answer in the form that the prompt asks for, told by the fields of its output format."""
        wanted = facts.output_format
        if '"predictions"' in wanted:
            return self._predict(facts)
        if '"scores"' in wanted:
            return self._score(facts)
        if '"ranking"' in wanted:
            return self._rank(facts)
        if '"feasible"' in wanted:
            return self._reflect(facts)
        if '"agree"' in wanted:
            return self._negotiate(facts)
        if '"sub_tasks"' in wanted:
            return self._generate(facts)
        if '"sub_skill"' in wanted:
            return self._choose_skill(facts)
        if '"places"' in wanted:
            return self._place(facts)
        return {}

    def _place(self, facts: Facts) -> dict[str, Any]:
        places = self._knowledge.belongs(facts).items()
        return {"places": [{"receptacle": name, "room_types": room_types} for name, room_types in places]}

    def _generate(self, facts: Facts) -> dict[str, Any]:
        match = _COUNT.search(facts.instruction)
        best = options(_as_predicted(facts), self._knowledge)[: int(match[1]) if match else 1]
        reasons = [{"reason": it.reason} if '"reason"' in facts.output_format else {} for it in best]
        sub_tasks = [{**_call_json(it.call), **reason} for it, reason in zip(best, reasons)]
        return {"analysis": _say(best), "sub_tasks": sub_tasks}

    def _rank(self, facts: Facts) -> dict[str, Any]:
        effects = evaluate(facts)
        return {"analysis": "; ".join(map(str, effects)), "ranking": _best_first(effects)}

    def _score(self, facts: Facts) -> dict[str, Any]:
        """Scores that fall with the rank; none for what would help nobody."""
        effects = evaluate(_as_predicted(facts))
        step = 10.0 / max(len(effects), 1)
        scores = [
            {"index": index, "score": 0 if effects[index].hopeless else round(10 - step * rank, 1)}
            for rank, index in enumerate(_best_first(effects))
        ]
        return {"analysis": "; ".join(map(str, effects)), "scores": scores}

    def _reflect(self, facts: Facts) -> dict[str, Any]:
        feasible, reason = judge(facts, self._knowledge)
        return {"analysis": reason, "feasible": feasible, "reason": reason}

    def _negotiate(self, facts: Facts) -> dict[str, Any]:
        """What speaks against the plans of others, and the best that is left beside those that stand."""
        against = dict(disagreements(facts))
        standing = facts._replace(plans={it: call for it, call in facts.plans.items() if it not in against})
        found = [
            it for it in options(_as_planned(standing), self._knowledge) if it.call not in facts.objected
        ]
        if not found:
            return {}
        return {
            "analysis": "; ".join([*against.values(), _say(found[:1])]),
            "agree": not against,
            "objections": [{"teammate": it, "reason": reason} for it, reason in against.items()],
            "sub_task": {**_call_json(found[0].call), "reason": found[0].reason},
        }

    def _predict(self, facts: Facts) -> dict[str, Any]:
        predictions = []
        for teammate in facts.teammates:
            sub_task = teammate.sub_task or self._as_teammate(facts, teammate)
            look = searching_skill(facts)
            sub_skill = teammate.sub_skill or look
            predictions.append(
                {
                    "teammate": teammate.name,
                    "sub_task": None if sub_task is None else _call_json(sub_task),
                    "sub_skill": None if sub_skill is None else _call_json(sub_skill),
                }
            )
        return {
            "analysis": "a teammate goes on with what it is at, else does the best it can",
            "predictions": predictions,
        }

    def _as_teammate(self, facts: Facts, teammate: TeammateFact) -> CallText | None:
        """What the teammate would do if it reasoned as this robot does."""
        others = tuple(it for it in facts.teammates if it is not teammate)
        view = facts._replace(
            manipulation=teammate.manipulation,
            payload=teammate.payload,
            holding=teammate.holding,
            teammates=others,
        )
        best = options(view, self._knowledge)
        return best[0].call if best else None

    def _choose_skill(self, facts: Facts) -> dict[str, Any]:
        if facts.current is not None:
            call = next_skill(facts, facts.current, facts.current_steps, facts.current_arguments)
            return {"analysis": f"the next step of {facts.current} is {call}", "sub_skill": _call_json(call)}
        best = options(facts, self._knowledge)
        if not best:
            return {}
        sub_task = best[0].call
        spec = next(it for it in facts.sub_tasks if it.name == sub_task.name)
        arguments = {
            name: (kind, value) for (name, kind), value in zip(spec.parameters.items(), sub_task.args)
        }
        recent = facts._replace(done=facts.done[-len(spec.steps) :] if spec.steps else ())
        call = next_skill(recent, sub_task, spec.steps, arguments)
        return {"analysis": f"{best[0].reason}; hence {call}", "sub_skill": _call_json(call)}


def _as_predicted(facts: Facts) -> Facts:
    """The facts with the predicted plans, where the prompt has any, taken for the teammates' own."""
    return facts._replace(
        teammates=tuple(
            it._replace(sub_task=facts.predictions.get(it.name, it.sub_task)) for it in facts.teammates
        )
    )


def _as_planned(facts: Facts) -> Facts:
    """The facts with the plans of the team, where the prompt has any, taken for what its members do."""
    return facts._replace(
        teammates=tuple(
            it._replace(sub_task=facts.plans.get(it.name), sub_skill=None) if facts.plans else it
            for it in facts.teammates
        )
    )


def _best_first(effects: Sequence[Effect]) -> list[int]:
    return sorted(range(len(effects)), key=lambda index: effects[index].worth)


def _call_json(call: CallText) -> dict[str, Any]:
    return {"name": call.name, "args": list(call.args)}


def _say(best: Sequence[Option]) -> str:
    return "; ".join(it.reason for it in best) or "I see nothing that could be done"


def _tokens(text: str) -> int:
    return -(-len(text) // _CHARACTERS_PER_TOKEN)
