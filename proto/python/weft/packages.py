"""The packages that are used where they are installed."""

from importlib import import_module
from typing import Any


def _installed(name: str) -> Any:
    try:
        return import_module(name)
    except ImportError:
        return None


numpy: Any = _installed("numpy")  # optional; everything works without it
websockets: Any = _installed("websockets")  # only the decoders work without it
