"""How a provider is asked for structured replies, and what is asked instead where it refuses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import ModuleType
from typing import Any

from adhoc.core.errors import ConfigurationError, ModelError
from adhoc.core.replies import ReplyFormat

AUTO = "auto"
SCHEMA, JSON, TEXT = FORMS = ("schema", "json", "text")
"""From strict to free: a JSON schema, any JSON object, any text."""


class FormRefused(ModelError):
    """The endpoint refused a request; perhaps it takes one of a freer form."""


class StructuredOutput:
    """Chooses among `FORMS`; as `auto`, the strictest that the model takes, which it learns by refusals.

    Args:
        wanted: `auto`, or one of `FORMS`, which is then kept to.

    Raises:
        ConfigurationError: `wanted` is something else.
    """

    def __init__(self, wanted: str = AUTO) -> None:
        if wanted not in (AUTO, *FORMS):
            raise ConfigurationError(f"structured={wanted!r}: must be one of {', '.join((AUTO, *FORMS))}")
        self._wanted = wanted
        self._accepted: dict[str, str] = {}

    def forms(self, litellm: ModuleType, model: str, own_endpoint: bool) -> Sequence[str]:
        """What to try, in order; the next only if the endpoint refuses the one before."""
        if self._wanted != AUTO:
            return (self._wanted,)
        strictest = self._accepted.get(model) or _strictest(litellm, model, own_endpoint)
        return FORMS[FORMS.index(strictest) :]

    def accept(self, model: str, form: str) -> None:
        """The endpoint took this form: nothing stricter is tried again."""
        self._accepted[model] = form


def response_format(form: str, reply: ReplyFormat) -> Mapping[str, Any]:
    """What to add to the request.

    The schema is not sent as `strict`: it changes with every prompt, since it lists the ids that the prompt
    names, and providers that compile strict schemas take seconds for each new one. Replies are checked in
    any case.
    """
    if form == TEXT:
        return {}
    if form == JSON:
        return {"response_format": {"type": "json_object"}}
    schema = {"name": reply.name, "schema": dict(reply.schema), "strict": False}
    return {"response_format": {"type": "json_schema", "json_schema": schema}}


def _strictest(litellm: ModuleType, model: str, own_endpoint: bool) -> str:
    """By litellm's list; of an endpoint of one's own with an unknown model the most is hoped for.

    The paper's models take `response_format`, but no schema.
    """
    is_unknown = own_endpoint and model not in litellm.model_cost
    return SCHEMA if is_unknown or litellm.supports_response_schema(model=model) else JSON
