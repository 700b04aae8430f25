"""Values of commands, as they can be sent."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from typing import Any, TypeGuard

from . import messages
from .samples import Hit

# Where to hold: what `pick` found, a particle's number, or a dict with `particle`, or `triangle` and `barycentric`.
Hold = Hit | int | Mapping[str, Any]


def is_number(value: object) -> TypeGuard[int]:
    """Whether it is a whole number, also one of numpy."""
    return hasattr(value, "__index__")


def plain(value: Any) -> Any:
    """Converts numpy's numbers and arrays, and any type with their `tolist`, for JSON."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"a value of type {type(value).__name__} cannot be sent")


def text_of(op: str, fields: dict[str, Any]) -> str:
    """A command as it is sent; a ValueError names a number that is not finite, for which JSON has no word."""
    try:
        return json.dumps({"op": op, **fields}, allow_nan=False, default=plain)
    except ValueError as error:
        fault = _not_finite(fields, op)
        raise ValueError(f"{fault}: numbers have to be finite") if fault else error from None


def _not_finite(value: Any, path: str) -> str | None:
    """The first number that is not finite, with its place."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, float):
        return None if math.isfinite(value) else f"{path} = {value}"
    parts = [(f"{path}.{key}", part) for key, part in value.items()] if isinstance(value, Mapping) else []
    if isinstance(value, (list, tuple)):
        parts = [(f"{path}[{place}]", part) for place, part in enumerate(value)]
    return next(filter(None, (_not_finite(part, name) for name, part in parts)), None)


def hold_fields(hold: Hold) -> dict[str, Any]:
    """Fields that tell where to hold."""
    if is_number(hold):
        return {"particle": hold}
    if isinstance(hold, Hit):
        return {"triangle": hold.triangle, "barycentric": list(hold.barycentric)}
    if hold is None:
        raise TypeError("nothing to hold: `pick` answers None where its ray misses the cloth")
    if not isinstance(hold, Mapping):
        raise TypeError(f"{hold!r} is no place to hold: give a particle, a hit or a dict")
    known(messages.Hit, "a place to hold", hold)
    names = ("triangle", "barycentric") if "triangle" in hold else ("particle",)
    missing = [name for name in names if name not in hold]
    if missing:
        raise TypeError(f"a place to hold lacks {missing[0]!r}: it has a particle, or triangle and barycentric")
    return {name: hold[name] for name in names}


def listed(vector: Iterable[float] | None) -> Any:
    """A vector as it can be sent; what lists itself, as numpy's do, is sent as it is."""
    return vector if vector is None or hasattr(vector, "tolist") else list(vector)


def known(kind: type, name: str, value: Any) -> Any:
    """The value, a dict of such a kind or a list of some, or a TypeError that names a field that it has not: the
    server ignores what it does not know, so that a misspelt field would do nothing."""
    for part in value if isinstance(value, (list, tuple)) else [value]:
        unknown = sorted(set(part) - set(kind.__annotations__)) if isinstance(part, Mapping) else []
        if unknown:
            has = ", ".join(kind.__annotations__)
            raise TypeError(f"{name} has no field {unknown[0]!r}; it has {has}")
    return value


def without_none(fields: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in fields.items() if value is not None}
