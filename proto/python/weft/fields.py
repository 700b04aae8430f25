"""Values of commands, as they can be sent."""

from __future__ import annotations

from .samples import Hit


def is_number(value) -> bool:
    """Whether it is a whole number, also one of numpy."""
    return hasattr(value, "__index__")


def plain(value):
    """Converts numpy's numbers and arrays, and any type with their `tolist`, for JSON."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"a value of type {type(value).__name__} cannot be sent")


def hold_fields(hold) -> dict:
    """Fields that tell where to hold, from a Hit, a particle's number, or a dict with them."""
    if is_number(hold):
        return {"particle": hold}
    if isinstance(hold, Hit):
        return {"triangle": hold.triangle, "barycentric": list(hold.barycentric)}
    names = ("triangle", "barycentric") if "triangle" in hold else ("particle",)
    return {name: hold[name] for name in names}


def listed(vector):
    """A vector as it can be sent; what lists itself, as numpy's do, is sent as it is."""
    return vector if vector is None or hasattr(vector, "tolist") else list(vector)


def without_none(fields: dict) -> dict:
    return {name: value for name, value in fields.items() if value is not None}
