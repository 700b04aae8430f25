"""What environments take: arguments within their bounds, and actions."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..fields import is_number

NUMBERS = 4  # of an action for each actor: three of the way, one of the grip


def whole(name: str, value: Any, least: int, most: int | None = None) -> int:
    """A whole number within bounds, or a ValueError that tells them."""
    if not is_number(value) or int(value) < least or (most is not None and int(value) > most):
        bounds = f"of at least {least}" if most is None else f"from {least} to {most}"
        raise ValueError(f"{name} is a whole number {bounds}, not {value!r}")
    return int(value)


def number(name: str, value: Any, least: float, most: float) -> float:
    """A number within bounds, or a ValueError that tells them."""
    try:
        given = float(value)
    except (TypeError, ValueError):
        given = math.nan
    if not least <= given <= most:
        raise ValueError(f"{name} is a number from {least:g} to {most:g}, not {value!r}")
    return given


def actions(value: Any, shape: tuple[int, ...]) -> Any:
    """Actions as they are carried out, each number clipped to -1 to 1; or a ValueError that tells what is expected."""
    what = "an action has" if len(shape) == 1 else "actions have a row for each environment, in it"
    wanted = f"{what} {NUMBERS} numbers from -1 to 1 for each actor, shape {shape}"
    try:
        given = np.asarray(value, np.float64)
    except (TypeError, ValueError):
        raise ValueError(f"{wanted}, not {value!r}") from None
    if given.shape != shape:
        raise ValueError(f"{wanted}, not {given.shape}")
    wrong = np.argwhere(~np.isfinite(given))
    if len(wrong):
        raise ValueError(f"{wanted}; at {wrong[0].tolist()} there is {given[tuple(wrong[0])]}")
    return np.clip(given, -1, 1)
