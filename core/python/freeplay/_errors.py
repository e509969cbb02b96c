"""What may go wrong, as exceptions: each has the exit code and the messages of the command line."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Mapping, NamedTuple, Sequence

if TYPE_CHECKING:
    from ._result import Result
    from ._table import Table

PREFIX = "freeplay: error: "


class Message(NamedTuple):
    """One message of a file: where, how grave, its stable id, what, and the word that was probably meant."""

    file: str | None
    line: int | None
    column: int | None
    severity: str
    id: str
    message: str
    suggestion: str | None


class Error(Exception):
    """Whatever Freeplay refuses. `str()` is what the command prints on stderr, `messages` the same as fields."""

    exit_code: int = 1

    def __init__(self, text: str = "", messages: Sequence[Message] = (), exit_code: int | None = None) -> None:
        super().__init__(text)
        self.args = (text,)
        self.messages: tuple[Message, ...] = tuple(messages)
        if exit_code is not None:
            self.exit_code = exit_code

    def __str__(self) -> str:
        return str(self.args[0])

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (type(self), str(self), self.messages, self.exit_code)


class UsageError(Error, ValueError):
    """Options, names or values of a call that cannot be meant."""

    exit_code = 2


class UnknownName(UsageError, KeyError):
    """A channel, an input or a column that is not there; the message says which was probably meant."""


class ModelError(Error, ValueError):
    """Mistakes in a model, a table or a URDF file: all messages of the file."""

    exit_code = 3


class NumericalError(Error, ArithmeticError):
    """A run or an analysis that could not go on. `result` has all rows up to the last accepted step; None for an analysis."""

    exit_code = 4
    result: Result | None = None


class PluginError(Error, RuntimeError):
    """A plugin that is missing, refused or failed."""

    exit_code = 5
    result: Result | None = None


class InternalError(Error, RuntimeError):
    """A mistake of Freeplay itself: please report it."""


class ResultError(Error, OSError):
    """Results that cannot be written or read."""

    exit_code = 6
    result: Result | None = None


class Interrupted(KeyboardInterrupt):
    """Ctrl-C, or interrupt(): the step in hand has ended and files are sealed. `result` or `table` has what was done."""

    exit_code = 130

    def __init__(self, text: str = "interrupted", result: Result | None = None, table: Table | None = None) -> None:
        super().__init__(text)
        self.result = result
        self.table = table


class ModelWarning(UserWarning):
    """Something in a model or in a run that deserves a look; it ran all the same."""


CLASSES: dict[int, type[Error]] = {2: UsageError, 3: ModelError, 4: NumericalError, 5: PluginError, 6: ResultError}


def _again(kind: type[Error], text: str, messages: Sequence[Message], exit_code: int) -> Error:
    return kind(text, messages, exit_code)


def message_of(fields: Mapping[str, Any]) -> Message:
    return Message(**fields)


def refused(exit_code: int, messages: Sequence[Mapping[str, Any]], text: str) -> Error:
    """The exception of an exit code; the core calls it."""
    text = text.rstrip("\n")
    if text.startswith(PREFIX):
        text = text[len(PREFIX):]
    return CLASSES.get(exit_code, InternalError)(text, [message_of(fields) for fields in messages], exit_code)


def usage(text: str, kind: type[UsageError] = UsageError, message_id: str = "usage", suggestion: str | None = None) -> UsageError:
    return kind(text, [Message(None, None, None, "error", message_id, text, suggestion)])


def unknown_name(what: str, name: str, known: Sequence[str]) -> UnknownName:
    """An error that says which name was probably meant."""
    import difflib

    if not isinstance(name, str):
        raise TypeError(f"the name of a {what} is a text, not {type(name).__name__}".replace("a input", "an input"))
    near = difflib.get_close_matches(name, known, 1, 0.5)
    text = f"there is no {what} '{name}'"
    hint = f"did you mean '{near[0]}'?" if near else None
    error = usage(text + (f"; {hint}" if hint else ""), UnknownName, "unknown-name", near[0] if near else None)
    assert isinstance(error, UnknownName)
    return error
