"""The prompt templates: found, compiled once, and filled from a planning context."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from functools import cached_property, lru_cache
from pathlib import Path

from jinja2 import Template, TemplateError, TemplateNotFound

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import PromptError
from adhoc.core.plans import Context
from adhoc.core.resources import data_dir
from adhoc.prompting.describe import describe
from adhoc.prompting.fitting import Fits, FittedPrompt, fit
from adhoc.prompting.limits import Limits, history_shown, messages_shown
from adhoc.prompting.sandbox import PromptSandbox, fill
from adhoc.prompting.stage import StageInput

_NEXT_MESSAGE = "\x1e"
"""Parts the system message from the user message; no value can contain it, being a control character."""
_GAP = re.compile(r"\n{3,}")
_NO_STAGE = StageInput()
_TEMPLATE_FAULTS = (ArithmeticError, AttributeError, RecursionError, TypeError, ValueError)
"""What a template raises that computes with the wrong things, or includes itself."""


class PromptLibrary:
    """Renders prompts (paper, appendix 'Prompt Template Design').

    Every prompt is a system message (task description, vocabulary, output format, in-context examples: the
    same at every step, so that providers can cache it) and a user message (state and capability,
    detections, teammates, messages, memory, the stage's subject, the instruction).

    Args:
        folder: A folder of templates that go before the shipped ones of the same name, for changing one
            template or adding some. None: the shipped ones alone.
        max_messages: The most messages that a prompt carries, the robot's own among them: the latest; once
            there are more, the earliest third goes at a time, so that what remains is byte for byte the
            beginning of the next prompt. The paper carries all that fit into the window; the default holds
            what a team says in many steps, and bounds what a call costs.
        max_history: The latest events of memory that a prompt carries.
        max_message_characters: Where one message, event or reason is cut off.
        max_reply_characters: Where one reply to an intention is cut off: the verdict rests on what it says.
        max_objects: The objects of interest that a prompt lists: what needs attention first, then what is
            undecided, each by distance. The paper lists all.
        max_receptacles_per_type: The nearest receptacles of each type that a prompt lists per room.

    Raises:
        PromptError: `folder` is no folder, or the shipped templates are missing.
    """

    def __init__(
        self,
        folder: str | Path | None = None,
        max_messages: int = 200,
        max_history: int = 12,
        max_message_characters: int = 1000,
        max_objects: int = 15,
        max_receptacles_per_type: int = 3,
        max_reply_characters: int = 4000,
    ) -> None:
        own = None if folder is None else Path(folder).expanduser()
        if own is not None and not own.is_dir():
            raise PromptError(f"prompts folder {folder}: no such folder; name a folder of *.jinja files")
        self._limits = Limits(
            max_messages,
            max_history,
            max_message_characters,
            max_reply_characters,
            max_objects,
            max_receptacles_per_type,
        )
        self._environment = PromptSandbox(data_dir("prompts"), own)

    @property
    def names(self) -> tuple[str, ...]:
        """The names of all templates that can be rendered."""
        files = self._environment.list_templates(extensions=["jinja"])
        return tuple(it.removesuffix(".jinja") for it in files if "/" not in it and it != "layout.jinja")

    def check(self, template: str) -> None:
        """Raises PromptError if the template is missing or invalid, or one of the folder cannot be read."""
        self._template(template)
        _ = self.fingerprint

    def render(
        self, template: str, context: Context, stage: StageInput = _NO_STAGE
    ) -> tuple[ChatMessage, ...]:
        """The conversation of one stage, whatever its length: a system message and a user message.

        Raises:
            PromptError: the template is missing, is invalid, or uses a variable that does not exist.
        """
        return self._fill(template, context, stage, self._limits)

    def fit(self, template: str, context: Context, stage: StageInput, fits: Fits) -> FittedPrompt:
        """The conversation of one stage, cut down until it `fits`.

        Where it is too long, the earliest communication messages are left out one after the other, as in the
        paper, then the earliest events of memory.

        Raises:
            PromptError: as `render`, and where the rest does not fit either.
        """
        return fit(
            lambda limits: self._fill(template, context, stage, limits),
            len(messages_shown(context, stage.replies, self._limits)),
            len(history_shown(context, self._limits)),
            self._limits,
            fits,
            template,
        )

    def render_question(self, template: str, values: Mapping[str, object]) -> tuple[ChatMessage, ...]:
        """The conversation of a question that is about no robot's situation, filled from `values` alone.

        Raises PromptError like `render`.
        """
        return self._conversation(template, values)

    @cached_property
    def fingerprint(self) -> str:
        """A hash of all template sources that are in force, for records of what was asked.

        It covers the whole library, since any template may include any part. Raises PromptError if one of
        them cannot be read.
        """
        digest = hashlib.sha256()
        for file in self._environment.list_templates(extensions=["jinja"]):
            try:
                source = self._environment.source(file)
            except (TemplateError, UnicodeDecodeError, OSError) as error:
                raise PromptError(f"prompt template {file!r} cannot be read: {error}") from error
            digest.update(f"{file}\0{source}\0".encode())
        return digest.hexdigest()

    def _template(self, template: str) -> Template:
        try:
            return self._environment.get_template(f"{template}.jinja")
        except TemplateNotFound as error:
            raise PromptError(
                f"prompt template {template!r}: {error.name} not found; there are {', '.join(self.names)}"
            ) from error
        except (TemplateError, UnicodeDecodeError) as error:
            raise PromptError(f"prompt template {template!r} is invalid: {error}") from error

    def _fill(
        self, template: str, context: Context, stage: StageInput, limits: Limits
    ) -> tuple[ChatMessage, ...]:
        return self._conversation(template, describe(context, stage, limits))

    def _conversation(self, template: str, values: Mapping[str, object]) -> tuple[ChatMessage, ...]:
        compiled = self._template(template)
        try:
            text = fill(compiled, {**values, "next_message": _NEXT_MESSAGE})
        except (TemplateError, *_TEMPLATE_FAULTS) as error:
            raise PromptError(f"prompt template {template!r} cannot be filled: {error}") from error
        system, _, user = text.partition(_NEXT_MESSAGE)
        return ChatMessage("system", _tidy(system)), ChatMessage("user", _tidy(user))


@lru_cache(maxsize=1)
def shipped_prompts() -> PromptLibrary:
    """The shipped templates with default limits, compiled once per process."""
    return PromptLibrary()


def _tidy(text: str) -> str:
    return _GAP.sub("\n\n", text.replace("\n## ", "\n\n## ")).strip()
