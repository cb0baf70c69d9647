"""Where templates are filled: they can read values and write text, and nothing else, in bounded amounts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sized
from pathlib import Path
from typing import Any

from jinja2 import ChoiceLoader, Environment, FileSystemLoader, StrictUndefined, Template
from jinja2.compiler import CodeGenerator, Frame
from jinja2.exceptions import SecurityError, TemplateNotFound
from jinja2.nodes import Concat
from jinja2.runtime import Context
from jinja2.sandbox import ImmutableSandboxedEnvironment

MAX_RANGE = 1000
"""Numbers that one `range` gives."""
MAX_CHARACTERS = 4_000_000
"""Of one prompt, before it is fitted into a window: four times the longest windows there are."""
_MAX_FACTOR = 10**6
_WIDENING_METHODS = frozenset(
    {"center", "expandtabs", "format", "format_map", "join", "ljust", "replace", "rjust", "zfill"}
)
_FORBIDDEN_FILTERS = (
    "batch",
    "center",
    "format",
    "indent",
    "random",
    "replace",
    "slice",
    "tojson",
    "wordwrap",
)
"""What widens a text, and what differs from call to call."""


class _BoundedConcatenation(CodeGenerator):
    """Compiles `~` so that what it makes is checked."""

    def visit_Concat(self, node: Concat, frame: Frame) -> None:  # noqa: N802
        self.write("environment.short(")
        super().visit_Concat(node, frame)
        self.write(")")


class PromptSandbox(ImmutableSandboxedEnvironment):
    """Jinja's immutable sandbox, without what makes much of little.

    A template sees the variables of `prompting.describe` and the other templates of its folders; no
    attribute that starts with `_`, no file outside of the folders, not by way of a link either, nothing that
    changes a value. Products, powers and remainders are of small numbers, `range` and every text that is put
    together are short, and what pads a text or picks at random is not there. Variables that do not exist are
    errors.

    Args:
        shipped: The folder of the library's templates.
        own: A folder of somebody's; its templates go before the shipped ones of the same name.

    Raises, when a template is filled, jinja's TemplateError for all of this.
    """

    intercepted_binops = frozenset({"*", "**", "%", "+"})
    code_generator_class = _BoundedConcatenation

    def __init__(self, shipped: Path, own: Path | None = None) -> None:
        folders = [FileSystemLoader(shipped)] if own is None else [_Folder(own), FileSystemLoader(shipped)]
        loader = ChoiceLoader(folders)
        super().__init__(
            loader=loader, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True, auto_reload=False
        )
        self._sources = loader
        self.globals = {"range": _short_range}
        for name in _FORBIDDEN_FILTERS:
            del self.filters[name]
        self.filters["join"] = _join

    def source(self, file: str) -> str:
        """The text of a template that need not be valid."""
        return self._sources.get_source(self, file)[0]

    def is_safe_attribute(self, obj: Any, attr: str, value: Any) -> bool:
        """Whether a template may read it; see the class."""
        return attr not in _WIDENING_METHODS and super().is_safe_attribute(obj, attr, value)

    def call_binop(self, context: Context, operator: str, left: Any, right: Any) -> Any:
        """A product, power or remainder of small numbers; a sum that is not too long."""
        if operator == "+" and isinstance(left, Sized) and isinstance(right, Sized):
            _check_length(len(left) + len(right))
            return super().call_binop(context, operator, left, right)
        largest = 100 if operator == "**" else _MAX_FACTOR
        for value in (left, right):
            if not isinstance(value, (int, float)) or abs(value) > largest:
                raise SecurityError(f"'{operator}' is for numbers up to {largest}")
        return super().call_binop(context, operator, left, right)

    def short(self, text: str) -> str:
        """The text, if it is not too long: what `~` puts together."""
        _check_length(len(text))
        return text


class _Folder(FileSystemLoader):
    """The templates, and nothing else, that really lie in a folder which came from anywhere."""

    def __init__(self, folder: Path) -> None:
        super().__init__(folder)
        self._folder = folder.resolve()

    def get_source(self, environment: Environment, template: str) -> tuple[str, str, Callable[[], bool]]:
        if not template.endswith(".jinja"):
            raise TemplateNotFound(template)
        source, file, is_current = super().get_source(environment, template)
        if not Path(file).resolve().is_relative_to(self._folder):
            raise SecurityError(f"{template} is a link that leads out of the folder {self._folder}")
        return source, file, is_current


def fill(template: Template, variables: dict[str, Any]) -> str:
    """The text of a template. Raises TemplateError, also where it grows beyond MAX_CHARACTERS."""
    return "".join(_bounded(template.generate(variables)))


def _bounded(pieces: Iterator[str]) -> Iterator[str]:
    length = 0
    for piece in pieces:
        length += len(piece)
        _check_length(length)
        yield piece


def _join(values: Iterable[Any], separator: str = "") -> str:
    texts = [str(value) for value in values]
    _check_length(sum(map(len, texts)) + len(texts) * len(str(separator)))
    return str(separator).join(texts)


def _check_length(length: int) -> None:
    if length > MAX_CHARACTERS:
        raise SecurityError(f"it makes more than {MAX_CHARACTERS} characters")


def _short_range(*bounds: int) -> range:
    numbers = range(*bounds)
    if len(numbers) > MAX_RANGE:
        raise SecurityError(f"range{bounds} has more than {MAX_RANGE} numbers")
    return numbers
