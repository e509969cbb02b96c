"""Models, options and quantities of a caller, as the texts that the core reads."""
from __future__ import annotations

import json
import os
from numbers import Integral, Real
from typing import Any, Iterable, Mapping, Union

from ._errors import Error, Message, usage

Quantity = Union[float, str]
Source = Union[str, "os.PathLike[str]", Mapping[str, Any]]
OF_TEXT = "<model>"


def whole(name: str, text: str) -> str:
    """A text that UTF-8 can hold."""
    try:
        text.encode()
    except UnicodeEncodeError:
        raise usage(f"{name}: the text {ascii(text)} holds half a character", message_id="bad-value") from None
    return text


def text(name: str, value: Any) -> str:
    """A text and nothing else."""
    if not isinstance(value, str):
        raise TypeError(f"{name}: a text is needed, not {type(value).__name__}")
    return whole(name, value)


def flag(name: str, value: Any) -> bool:
    """True or False; None is False. A text such as 'no' would count as True."""
    if value is None or isinstance(value, bool) or type(value).__name__ == "bool_":
        return bool(value)
    raise TypeError(f"{name}: True or False is needed, not {type(value).__name__}")


def quantity(name: str, value: Any) -> str:
    """A number in SI, or a text with a unit, as the command line takes it. Raises TypeError for anything else."""
    if isinstance(value, str):
        return whole(name, value)
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError(f"{name}: a number in SI or a text such as '0.2 mm' is needed, not {type(value).__name__}")
    return repr(int(value)) if isinstance(value, Integral) else repr(float(value))


def path_of(name: str, value: Any) -> str:
    """A path as a text."""
    if isinstance(value, (str, os.PathLike)):
        path = os.fspath(value)
        if isinstance(path, str):
            return whole(name, path)
    raise TypeError(f"{name}: a path is needed, not {type(value).__name__}")


def count_of(name: str, value: int, least: int = 1) -> int:
    """A whole number from `least` on."""
    if type(value) is int and value >= least:
        return value  # a loop over steps waits for it
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise TypeError(f"{name}: a whole number is needed, not {type(value).__name__}")
    if value < least:
        raise usage(f"bad value '{value}' of {name}: it must be at least {least}", message_id="bad-value")
    return int(value)


def words(name: str, value: Any) -> list[str]:
    """One word or several."""
    if isinstance(value, str):
        return [whole(name, value)]
    try:
        found = list(value)
    except TypeError:
        raise TypeError(f"{name}: a text or a list of texts is needed, not {type(value).__name__}") from None
    for word in found:
        if not isinstance(word, str):
            raise TypeError(f"{name}: texts are needed, not {type(word).__name__}")
        whole(name, word)
    return found


def plain(value: Any, place: str) -> Any:
    """A tree of what JSON has. `place` is its path, for messages."""
    if value is None or isinstance(value, (str, bool, int)):
        return value
    if isinstance(value, float):
        return float(value)
    if isinstance(value, Mapping):
        for key in value:
            if not isinstance(key, str):
                raise TypeError(f"{place or 'the model'}: keys are texts, not {type(key).__name__}")
        return {key: plain(one, f"{place}.{key}" if place else key) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(one, f"{place}[{i}]") for i, one in enumerate(value)]
    if type(value).__module__ == "numpy" and hasattr(value, "tolist"):
        return plain(value.tolist(), place)
    raise TypeError(f"{place or 'the model'}: a model has no {type(value).__name__}")


def tree_text(tree: Mapping[str, Any]) -> str:
    """A model as its file: JSON is YAML."""
    try:
        return json.dumps(plain(tree, ""), indent=2, ensure_ascii=False) + "\n"
    except RecursionError:
        raise TypeError("the model: something in it holds itself, or is too deep") from None


def place_of(source: Any, folder: Any) -> dict[str, Any]:
    """`file`, and `text` where it is at hand."""
    if isinstance(source, Mapping):
        return {"text": whole("the model", tree_text(source)), "file": file_of_text(folder)}
    if isinstance(source, str) and "\n" in source:
        return {"text": whole("the model", source), "file": file_of_text(folder)}
    if isinstance(source, (str, os.PathLike)):
        path = os.fspath(source)
        if isinstance(path, str):
            return {"file": whole("the path", path)}
    raise TypeError(f"a model is a path, a text with a line feed or a mapping, not {type(source).__name__}")


def file_of_text(folder: Any) -> str:
    return OF_TEXT if folder is None else os.path.join(path_of("folder", folder), OF_TEXT)


def build_options(options: Mapping[str, Any]) -> dict[str, Any]:
    """Keywords of a call as the core takes them."""
    built: dict[str, Any] = {}
    changed = options.get("set")
    if changed is not None:
        if not isinstance(changed, Mapping):
            raise TypeError(f"set: a mapping of names to values is needed, not {type(changed).__name__}")
        for name in changed:
            if not isinstance(name, str):
                raise TypeError(f"set: names are texts, not {type(name).__name__}")
        built["set"] = [whole("set", f"{name}={quantity('set: ' + name, value)}") for name, value in changed.items()]
    for name in ("end", "step", "accuracy", "interval"):
        if options.get(name) is not None:
            built[name] = filled(name, quantity(name, options[name]))
    for name in ("integrator", "format"):
        if options.get(name) is not None:
            built[name] = filled(name, text(name, options[name]))
    for name in ("ideal", "plugins", "channels"):
        if options.get(name) is not None:
            built[name] = words(name, options[name])
    for name in ("strict", "allow_plugins"):
        built[name] = flag(name, options.get(name))
    return built


def kept_options(options: Mapping[str, Any]) -> dict[str, Any]:
    """Those that were given, as they are now: what a caller does with lists and mappings later, or took once from a generator, is no matter."""
    kept = {name: value for name, value in options.items() if value is not None}
    for name in ("ideal", "plugins", "channels"):
        if name in kept:
            kept[name] = words(name, kept[name])
    if isinstance(kept.get("set"), Mapping):
        kept["set"] = dict(kept["set"])
    return kept


def filled(name: str, text: str) -> str:
    if not text:
        raise usage(f"bad value '' of --{name}: it must not be empty", message_id="bad-value")
    return whole(f"--{name}", text)


def shown_name(file: str, folder: Any) -> str:
    """How messages name the file of a model: a text has one name wherever its paths count from."""
    return OF_TEXT if file == file_of_text(folder) else file


def renamed(error: Error, file: str, shown: str) -> Error:
    """The same error with the name that the file of a model is to have."""
    if file == shown:
        return error
    error.args = (str(error).replace(file, shown),)
    error.messages = tuple(message._replace(file=shown) if message.file == file else message for message in error.messages)
    return error


def remark(text: str) -> Message:
    return Message(None, None, None, "warning", "", text, None)


def names(value: str | Iterable[str]) -> list[str]:
    return words("channels", value)
