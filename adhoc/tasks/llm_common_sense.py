"""Common sense from a language model."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache, lru_cache
from types import MappingProxyType

from adhoc.core.errors import ConfigurationError, ReplyError
from adhoc.core.values import Place
from adhoc.houses import facts
from adhoc.houses.house import FLOOR
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Wrapper
from adhoc.llm.together import complete_together
from adhoc.llm.validating import ValidatingModel
from adhoc.prompting.library import PromptLibrary, shipped_prompts
from adhoc.tasks.common_sense import CommonSense, Judgements, Triple
from adhoc.tasks.place_question import PlaceQuestion

STAGE = "common_sense"
"""What records and cost tables call these questions."""
SEED = 0
"""Of every request: what belongs where does not depend on the scenario, so that all episodes of a run share
what the ledger holds."""


class LLMCommonSense(CommonSense):
    """A language model judges where things belong (paper: robots tidy up 'according to common sense').

    One call asks for all places where objects of one category belong, over all usual receptacle types and
    room types, and so settles each triple of category, receptacle type and room type once: the shortest way
    to ask about all of them. Only a receptacle or a room type that is not usual, such as one of a house of
    one's own, is asked about by a call more. The paper does not say how its robots ask.

    Every episode asks anew and its record counts what it asked; from the second episode on the answers come
    from the ledger and cost nothing. So the record of an episode is the same whatever was run before it, in
    this process or another one. An answer that cannot be used, after its repairs, means that nothing of the
    category is misplaced: a robot that is in doubt leaves things alone.

    Teammates may make up any number of categories and receptacle types. Hence no more than `max_unusual`
    questions of an episode are about what the placement table does not know; what is beyond them counts as
    unanswered.

    Args:
        model: Is asked, as stage `common_sense`.
        prompts: Where the template comes from; the shipped ones by default.
        template: Its name. It gets `category`, `receptacles` and `room_types`.
        repairs: See `ValidatingModel`.
        max_tokens: The longest reply.
        max_unusual: The most questions of an episode about unusual categories, receptacle types and room
            types.

    Raises:
        ConfigurationError: `max_tokens`, `max_unusual` or `repairs` is out of range.
        PromptError: There is no such template.
    """

    def __init__(
        self,
        model: LanguageModel,
        prompts: PromptLibrary | None = None,
        template: str = "questions/common_sense",
        repairs: int = 1,
        max_tokens: int = 1024,
        max_unusual: int = 100,
    ) -> None:
        if max_tokens < 1 or max_unusual < 0:
            raise ConfigurationError(
                f"LLMCommonSense: max_tokens={max_tokens} must be at least 1, max_unusual={max_unusual} 0"
            )
        self._model = _Indulgent(ValidatingModel(model, repairs))
        self._prompts = prompts or shipped_prompts()
        self._prompts.check(template)
        self._template, self._max_tokens, self._max_unusual = template, max_tokens, max_unusual
        self._unusual = 0
        self._answers: dict[PlaceQuestion, tuple[Place, ...] | None] = {}
        self._judged: dict[Triple, bool | None] = {}

    def is_misplaced(self, category: str, receptacle: str, room_type: str) -> bool:
        """See `CommonSense`. Any category can be asked about.

        Raises ModelError or BudgetReached if the model cannot be asked.
        """
        triple = (category, receptacle, room_type)
        if triple not in self._judged:
            places = self._ask(_question(*triple))
            self._judged[triple] = None if places is None else Place(receptacle, room_type) not in places
        return self._judged[triple] is True

    def places_for(self, category: str) -> Sequence[Place]:
        """See `CommonSense`; those on or in which a robot can put things. Raises like `is_misplaced`."""
        places = self._ask(_usual(category)) or ()
        return tuple(place for place in places if place.receptacle in _fixed())

    def consider(self, categories: Iterable[str]) -> None:
        """See `CommonSense`. All questions that are new go out together."""
        self._ask_all([_usual(category) for category in categories])

    def begin_episode(self) -> None:
        """See `CommonSense`."""
        self._answers.clear()
        self._judged.clear()
        self._unusual = 0

    @property
    def judge(self) -> str:
        """The model's name."""
        return self._model.name

    @property
    def judged(self) -> Judgements:
        """See `CommonSense`: the triples that robots asked about, each once."""
        return MappingProxyType(self._judged)

    def _ask(self, question: PlaceQuestion) -> tuple[Place, ...] | None:
        """The places that the model names; None if it did not answer."""
        self._ask_all([question])
        return self._answers.get(question)

    def _ask_all(self, questions: Iterable[PlaceQuestion]) -> None:
        new = [it for it in dict.fromkeys(questions) if it not in self._answers and self._admit(it)]
        responses = complete_together(self._model, [self._request(question) for question in new])
        self._answers.update((question, it.parsed) for question, it in zip(new, responses))

    def _admit(self, question: PlaceQuestion) -> bool:
        """Whether it is asked: usual questions are, of the others so many."""
        if question in _all_usual():
            return True
        self._unusual += 1
        return self._unusual <= self._max_unusual

    def _request(self, question: PlaceQuestion) -> LMRequest:
        return LMRequest(
            self._prompts.render_question(self._template, question.told),
            STAGE,
            self._max_tokens,
            reply=question.reply,
            template=self._prompts.fingerprint,
            # No robot asks. Told apart by what they are about, questions that go out together are counted
            # alike in whatever order they arrive.
            agent=question.category,
            seed=SEED,
        )


class _Indulgent(Wrapper):
    """Answers with nothing parsed where there is no usable reply: the outcome is noted by then."""

    def complete(self, request: LMRequest) -> LMResponse:
        try:
            return self._inner.complete(request)
        except ReplyError:
            return LMResponse("", self.name)


@lru_cache(maxsize=1024)
def _usual(category: str) -> PlaceQuestion:
    return PlaceQuestion(category, _receptacles(), facts.ROOM_TYPES)


@cache
def _all_usual() -> frozenset[PlaceQuestion]:
    return frozenset(map(_usual, facts.pickupable_categories()))


def _question(category: str, receptacle: str, room_type: str) -> PlaceQuestion:
    """The question that settles a triple; every triple has one."""
    if room_type not in facts.ROOM_TYPES:
        return PlaceQuestion(category, (receptacle,), (room_type,))
    if receptacle not in _receptacles():
        return PlaceQuestion(category, (receptacle,), facts.ROOM_TYPES)
    return _usual(category)


@cache
def _receptacles() -> tuple[str, ...]:
    """The usual receptacle types, things like bowls that hold others among them, and the floor."""
    return (*facts.receptacle_categories(), FLOOR)


@cache
def _fixed() -> frozenset[str]:
    """Those on or in which a robot can put things."""
    furniture = (it for it in facts.receptacle_categories() if facts.category_facts(it).is_receptacle)
    return frozenset((*furniture, FLOOR))
