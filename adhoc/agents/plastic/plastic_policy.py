"""The PLASTIC ad hoc policy of the paper: know the type of the team, act as did work beside that type."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from adhoc.agents.learned.decision import SubSkillKind
from adhoc.agents.learned.situation import Situation
from adhoc.agents.plastic.beliefs import Beliefs
from adhoc.agents.plastic.library import library_fingerprint, types_in
from adhoc.agents.plastic.newcomer import LearnedNewcomer
from adhoc.agents.plastic.watching import Behaviour
from adhoc.agents.policy import Ask, Turn
from adhoc.core.messages import Message
from adhoc.core.values import Capability, Observation
from adhoc.perception.perception import PerceptionSettings
from adhoc.tasks.common_sense import CommonSense
from adhoc.tasks.task import Task


class PlasticPolicy(LearnedNewcomer):
    """PLASTIC-Policy (Barrett et al. 2017; paper, section 'PLASTIC Policy') in a house.

    It has a library of types of teams. Each holds models of how its members behave, and a policy that was
    learned by imitation beside teams of that type. Every observed behaviour of a teammate changes the belief
    in each type by how probable it was for that type (`Beliefs`); the policy of the most likely type chooses
    the kind of the next sub-skill, and rules execute it. Where no teammate is heard or seen, beliefs stay.

    The trace of a step holds `beliefs` in the first step and whenever they changed, and `behaviour`, what
    changed them; a step without either has an empty trace.

    Args:
        types: Names of the types that it knows; all of the library if None.
        eta: How much one observation can change, see `Beliefs`.
        checkpoints: The folder of the library; the shipped one if None.
        common_sense: Judges what is misplaced; the learned team's if None.
        team_checkpoints: The folder of the learned team's checkpoints; the shipped one if None.
        perception: Settings of its perception.

    Raises:
        CheckpointError: A checkpoint cannot be read or does not fit.
        ConfigurationError: A type is not in the library, or `eta` is out of its range.
    """

    def __init__(
        self,
        types: Sequence[str] | None = None,
        eta: float = 0.5,
        checkpoints: str | None = None,
        common_sense: CommonSense | None = None,
        team_checkpoints: str | None = None,
        perception: PerceptionSettings | None = None,
    ) -> None:
        super().__init__(self._choose_kind, self._learn, common_sense, team_checkpoints, perception)
        self._types, self._library = types_in(checkpoints, types), library_fingerprint(checkpoints)
        self._eta = eta
        self._beliefs = Beliefs(tuple(self._types), eta)

    @property
    def fingerprint(self) -> str:
        """See `Policy`: of its library, and of what judges."""
        return f"{self._library}{super().fingerprint}"

    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        """See `Policy`."""
        super().reset(me, capability, task, seed, ask)
        self._beliefs = Beliefs(tuple(self._types), self._eta)
        self._noticed: list[Behaviour] = []
        self._told = False

    def act(self, observation: Observation, inbox: Sequence[Message]) -> Turn:
        """See `Policy`."""
        self._noticed = []
        turn = super().act(observation, inbox)
        if self._told and not self._noticed:
            return turn
        self._told = True
        return replace(turn, trace={**turn.trace, **self._belief_trace()})

    @property
    def beliefs(self) -> Mapping[str, float]:
        """The belief in each type, by name; they sum to 1."""
        return self._beliefs.probabilities

    def _learn(self, behaviour: Behaviour) -> None:
        self._noticed.append(behaviour)
        self._beliefs.update({name: it.probability(behaviour) for name, it in self._types.items()})

    def _choose_kind(self, situation: Situation) -> SubSkillKind:
        return self._types[self._beliefs.most_likely].policy.decide(situation)

    def _belief_trace(self) -> dict[str, Any]:
        noticed = [{"teammate": it.teammate, "deed": it.deed.name.lower()} for it in self._noticed]
        beliefs = {name: round(belief, 4) for name, belief in self.beliefs.items()}
        return {"beliefs": beliefs, **({"behaviour": noticed} if noticed else {})}
