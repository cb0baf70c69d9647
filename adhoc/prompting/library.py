"""The prompt templates: found, compiled once, and filled from a planning context."""

from __future__ import annotations

import hashlib
import re
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

from jinja2 import ChoiceLoader, FileSystemLoader, StrictUndefined, Template, TemplateError, TemplateNotFound
from jinja2.sandbox import ImmutableSandboxedEnvironment

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import PromptError
from adhoc.core.plans import Context
from adhoc.core.resources import data_dir
from adhoc.prompting.describe import Limits, describe
from adhoc.prompting.stage import StageInput

_NEXT_MESSAGE = "\x1e"
"""Parts the system message from the user message; no value can contain it, being a control character."""
_GAP = re.compile(r"\n{3,}")
_NO_STAGE = StageInput()


class PromptLibrary:
    """Renders prompts (paper, appendix 'Prompt Template Design').

    Every prompt is a system message (task description, vocabulary, output format, in-context examples: the
    same at every step, so that providers can cache it) and a user message (state and capability,
    detections, teammates, messages, memory, the stage's subject, the instruction).

    Args:
        folder: A folder of templates that go before the shipped ones of the same name, for changing one
            template or adding some. None: the shipped ones alone.
        max_messages: The latest messages that a prompt carries, the robot's own among them. The paper carries
            all; the default holds what a team says in many steps, and keeps the usual prompt short.
        max_history: The latest events of memory that a prompt carries.
        max_message_characters: Where one message, event or reason is cut off.
        max_reply_characters: Where one reply to an intention is cut off: the verdict rests on what it says.
        max_objects: The objects of interest that a prompt lists: what needs attention first, then what is
            undecided, each by distance. The paper lists all.
        max_receptacles_per_type: The nearest receptacles of each type that a prompt lists per room.
        max_characters: The longest prompt. Where one is longer, the earlier half of its messages goes, then
            of its memory, until it fits. The paper's bound is 128,000 tokens; a token has about 4 characters.

    Raises:
        PromptError: `folder` is no folder, or the shipped templates are missing.
    """

    def __init__(
        self,
        folder: str | Path | None = None,
        max_messages: int = 40,
        max_history: int = 12,
        max_message_characters: int = 1000,
        max_objects: int = 15,
        max_receptacles_per_type: int = 3,
        max_characters: int = 400_000,
        max_reply_characters: int = 4000,
    ) -> None:
        folders = [data_dir("prompts")]
        if folder is not None:
            if not Path(folder).expanduser().is_dir():
                raise PromptError(f"prompts folder {folder}: no such folder; name a folder of *.jinja files")
            folders.insert(0, Path(folder).expanduser())
        self._limits = Limits(
            max_messages,
            max_history,
            max_message_characters,
            max_reply_characters,
            max_objects,
            max_receptacles_per_type,
        )
        self._max_characters = max_characters
        self._environment = ImmutableSandboxedEnvironment(
            loader=ChoiceLoader([FileSystemLoader(it) for it in folders]),
            undefined=StrictUndefined,
            trim_blocks=True,
            lstrip_blocks=True,
            auto_reload=False,
        )

    @property
    def names(self) -> tuple[str, ...]:
        """The names of all templates that can be rendered."""
        files = self._environment.list_templates(extensions=["jinja"])
        return tuple(it.removesuffix(".jinja") for it in files if "/" not in it and it != "layout.jinja")

    def check(self, template: str) -> None:
        """Raises PromptError if the template is missing or invalid."""
        self._template(template)

    def render(
        self, template: str, context: Context, stage: StageInput = _NO_STAGE
    ) -> tuple[ChatMessage, ...]:
        """The conversation of one stage: a system message and a user message.

        Raises:
            PromptError: the template is missing, is invalid, uses a variable that does not exist, or the
                prompt is too long even without messages and memory.
        """
        compiled = self._template(template)
        limits = self._limits
        text = self._fill(compiled, template, context, stage, limits)
        while len(text) > self._max_characters:
            limits = _tighter(limits, context, template, self._max_characters)
            text = self._fill(compiled, template, context, stage, limits)
        system, _, user = text.partition(_NEXT_MESSAGE)
        return ChatMessage("system", _tidy(system)), ChatMessage("user", _tidy(user))

    @property
    def fingerprint(self) -> str:
        """A hash of all template sources that are in force, for records of what was asked.

        It covers the whole library, since any template may include any part.
        """
        digest = hashlib.sha256()
        for file in self._environment.list_templates(extensions=["jinja"]):
            source = Path(str(self._environment.get_template(file).filename)).read_text(encoding="utf-8")
            digest.update(f"{file}\0{source}\0".encode())
        return digest.hexdigest()

    def _template(self, template: str) -> Template:
        try:
            return self._environment.get_template(f"{template}.jinja")
        except TemplateNotFound as error:
            raise PromptError(
                f"prompt template {template!r}: {error.name} not found; there are {', '.join(self.names)}"
            ) from error
        except TemplateError as error:
            raise PromptError(f"prompt template {template!r} is invalid: {error}") from error

    def _fill(
        self, compiled: Template, template: str, context: Context, stage: StageInput, limits: Limits
    ) -> str:
        try:
            return compiled.render(describe(context, stage, limits), next_message=_NEXT_MESSAGE)
        except TemplateError as error:
            raise PromptError(f"prompt template {template!r} cannot be filled: {error}") from error


@lru_cache(maxsize=1)
def shipped_prompts() -> PromptLibrary:
    """The shipped templates with default limits, compiled once per process."""
    return PromptLibrary()


def _tighter(limits: Limits, context: Context, template: str, max_characters: int) -> Limits:
    messages = min(limits.messages, len(context.messages))
    if messages:
        return replace(limits, messages=messages // 2)
    history = min(limits.history, len(context.history))
    if history:
        return replace(limits, history=history // 2)
    raise PromptError(
        f"prompt {template!r} is longer than {max_characters} characters even without messages and memory; "
        "raise max_characters, or lower max_objects"
    )


def _tidy(text: str) -> str:
    return _GAP.sub("\n\n", text.replace("\n## ", "\n\n## ")).strip()
