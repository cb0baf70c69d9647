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


class EpisodeError(AdhocError):
    """An episode broke one of its own rules: its past differs from that of the team alone, or a policy
    asked a question outside its turn or said something that is no message."""


class PromptError(AdhocError):
    """A prompt template is missing, invalid, or refers to something that is not provided."""


class ModelError(AdhocError):
    """A language model cannot be used at all: missing key, unknown name, unreachable endpoint."""


class ModelBusy(ModelError):
    """A language model cannot be used right now: rate limit, server fault, time-out. Later may work."""


class ReplyError(AdhocError):
    """A language model answered, but not with what was asked for: ask again, or fall back.

    `outcome` is a short stable name that records count: `empty`, `truncated`, `unreadable`,
    `illegal`.
    """

    def __init__(self, message: str, outcome: str = "unreadable") -> None:
        super().__init__(message)
        self.outcome = outcome


class MissingDependency(AdhocError):
    """An optional package is needed for what was asked, and is not installed."""
