"""Comparisons in the grid world that worker processes can build; by default every robot asks the model at
every step."""

from __future__ import annotations

import os
import signal
import struct
from dataclasses import dataclass, replace
from pathlib import Path

from grid_world import Errand, GridWorld, Script, fetch, scenario

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import ModelError
from adhoc.core.values import Action, ActionName
from adhoc.evaluation.contender import Conditions, Contender
from adhoc.experiments.comparison import Comparison, Comparisons, Entrant
from adhoc.llm.counting import CountingModel
from adhoc.llm.model import LMRequest

TURNS = [ActionName.MOVE_LEFT, ActionName.MOVE_RIGHT, ActionName.MOVE_AHEAD]


class Asker(Script):
    """Moves as the model says."""

    def __init__(self, model):
        super().__init__()
        self.model = model

    def act(self, observation, inbox):
        turn = super().act(observation, inbox)
        question = f"{self.me} {observation.step} {observation.pose.x:.2f} {observation.pose.y:.2f}"
        reply = self.model.complete(LMRequest((ChatMessage("user", question),), "move"))
        return replace(turn, action=Action(TURNS[len(reply.text) % 3]))


class Curious(Asker):
    """Asks its model for everything but answers, and says what it was told."""

    def act(self, observation, inbox):
        model = self.model
        together = model.may_go_together([LMRequest((), "first"), LMRequest((), "second")])
        told = (model.name, model.window, model.count_tokens([]), together)
        model.note(" ".join(map(str, told)), "noted")
        return super(Asker, self).act(observation, inbox)


class Dying(Script):
    """Is killed at its fourth step, as long as the folder holds fewer than `times` files for that."""

    def __init__(self, folder, times):
        super().__init__()
        self.folder, self.times = Path(folder), times

    def act(self, observation, inbox):
        if observation.step == 4 and len(list(self.folder.glob("death-*"))) < self.times:
            (self.folder / f"death-{os.getpid()}").touch()
            self.die()
        return super().act(observation, inbox)

    def die(self):
        os.kill(os.getpid(), signal.SIGKILL)


class Leaving(Dying):
    """Ends its process itself, as a library that crashes may."""

    def die(self):
        os._exit(9)


class Stammering(Dying):
    """Is killed while it says something long to the parent."""

    def __init__(self, folder, times, model):
        super().__init__(folder, times)
        self.connection = model._inner._line._connection.fileno()

    def die(self):
        os.write(self.connection, struct.pack("!i", 1_000_000) + b"the beginning")
        super().die()


@dataclass(frozen=True)
class Compare:
    """`MakeComparisons`, of one: so many scenarios, a team of scripts, and a newcomer of some kind."""

    newcomer: str = "asker"
    scenarios: int = 3
    folder: str = ""
    deaths: int = 0

    def __call__(self, model):
        return Comparisons([lambda: self.comparison(model)])

    def comparison(self, model):
        return Comparison(
            self.world(),
            [scenario(id=f"two_rooms-s{seed}", seed=seed) for seed in range(self.scenarios)],
            Conditions(Errand(), Contender("walkers", "Walkers", lambda seat: Script(), {}), max_steps=12),
            (Entrant(self.contender(CountingModel(model)), 3),),
        )

    def world(self):
        return GridWorld(disturb_step=2 if self.newcomer == "disturbed" else None)

    def contender(self, model):
        def make(seat):
            if self.newcomer == "asker":
                return Asker(model)
            if self.newcomer == "curious":
                return Curious(model)
            if self.newcomer == "dying":
                return Dying(self.folder, self.deaths)
            if self.newcomer == "leaving":
                return Leaving(self.folder, self.deaths)
            if self.newcomer == "stammering":
                return Stammering(self.folder, self.deaths, model)
            if self.newcomer == "faulty":
                raise ZeroDivisionError("a fault in a policy")
            return Script(*fetch("apple", "counter"))

        uses_model = self.newcomer in ("asker", "curious")
        return Contender(self.newcomer, self.newcomer, make, {}, model if uses_model else None)


class Refusing(Compare):
    """Its components cannot be built in a worker."""

    def __call__(self, model):
        raise ModelError("llm.model='gpt-9': there is no such model")
