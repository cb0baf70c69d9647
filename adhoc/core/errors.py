"""The error hierarchy.

Everything that `adhoc` raises on purpose derives from `AdhocError`, and its text names the file,
the field and the value at fault, and what would be right. Two kinds of trouble are *not* errors: an
action that fails in a world (a value with a reason, `core.values.ActionResult`) and a plan that is
judged infeasible (`core.plans.Verdict`).
"""

from __future__ import annotations


class AdhocError(Exception):
    """Base of every error that the library raises on purpose."""


class HouseError(AdhocError):
    """A house file is broken, truncated, foreign, or describes an impossible house."""


class AssetError(AdhocError):
    """An asset or an object type is not in the fact tables."""


class WorldError(AdhocError):
    """A world was asked for something impossible: a robot in a wall, a house with no free cell."""


class TaskError(AdhocError):
    """A task, a sub-task or a sub-skill is declared wrongly."""


class ConfigurationError(AdhocError):
    """A configuration value is unknown, ill-typed or contradicts another."""


class RecordError(AdhocError):
    """A run folder or an episode record cannot be read or does not belong with the others."""


class DatasetError(AdhocError):
    """A dataset's file is broken, foreign, of another version, or describes an impossible task."""


class CheckpointError(AdhocError):
    """A checkpoint is missing, damaged or foreign, or a tensor of it is not of the shape that is needed."""


class EpisodeError(AdhocError):
    """An episode broke one of its own rules: its past differs from that of the team alone, or a policy
    asked a question outside its turn, said something that is no message or did something that is no turn."""


class EpisodesFailed(AdhocError):
    """More episodes of a run failed than it bears; what went wrong in each is in its `failures.jsonl`."""


class WorkerError(AdhocError):
    """A worker process of a run ended by itself, or was killed again and again in one episode."""


class PromptError(AdhocError):
    """A prompt template is missing, invalid, or refers to something that is not provided."""


class ModelError(AdhocError):
    """A language model cannot be used at all: missing key, unknown name, unreachable endpoint."""


class ModelBusy(ModelError):
    """A language model cannot be used right now: rate limit, server fault, time-out. Later may work.

    `retry_after` is after how many seconds, if the provider said so; `rate_limited` whether it asked for
    fewer requests.
    """

    def __init__(self, message: str, retry_after: float | None = None, rate_limited: bool = False) -> None:
        super().__init__(message)
        self.retry_after, self.rate_limited = retry_after, rate_limited


class BudgetReached(AdhocError):
    """A call was not made because it could pass a cap on calls, tokens or money.

    `scope` is `episode` or `run`; `cap` is the cap's place in the configuration, e.g. `budget.run.usd`.
    """

    def __init__(self, message: str, scope: str = "episode", cap: str = "") -> None:
        super().__init__(message)
        self.scope, self.cap = scope, cap


class LedgerError(AdhocError):
    """A ledger of model calls is damaged, foreign or of another version, or lacks a call to be replayed."""


class ReplyError(AdhocError):
    """A language model answered, but not with what was asked for: ask again, or fall back.

    `outcome` is a short stable name that records count: `empty`, `truncated`, `unreadable`, `illegal`,
    `duplicate`, `unknown id` (see `core.replies`). `response` is the answer as far as there was one (an
    `llm.model.LMResponse`): it was paid for.
    """

    def __init__(self, message: str, outcome: str = "unreadable", response: object = None) -> None:
        super().__init__(message)
        self.outcome, self.response = outcome, response


class CommandError(AdhocError):
    """A person who plays a robot typed something that it cannot do; the text says why, as a sentence."""


class MissingDependency(AdhocError):
    """An optional package is needed for what was asked, and is not installed."""
