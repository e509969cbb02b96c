"""What there is: types, their descriptions, the schema of model files, and what this package was built from."""
from __future__ import annotations

from typing import Any

from . import _core
from ._source import text


def types(kind: str | None = None) -> list[dict[str, Any]]:
    """Types of joints, laws and integrators, as `freeplay list --json`. kind: joints, laws, forces, integrators or plugins."""
    return _core.types("" if kind is None else text("kind", kind))


def describe(name: str) -> Any:
    """One type with parameters and channels, as `freeplay describe --json`. name: of the type. Raises UsageError."""
    return _core.describe(text("name", name))


def schema(kind: str = "model") -> dict[str, Any]:
    """The JSON Schema of the model file, as `freeplay schema`. kind: model, study or summary."""
    return _core.schema_of(text("kind", kind))


def info() -> dict[str, Any]:
    """Versions, as `freeplay --version --json`, and those of Python and numpy."""
    import platform

    import numpy

    return {"freeplay": _core.version, "schema": _core.schema, "plugin_abi": _core.plugin_abi, "compiler": _core.compiler,
            "build": _core.build, "python": platform.python_version(), "numpy": numpy.__version__}
