"""Gymnasium's classes where it is installed, and else what of them the environments need."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any

import numpy as np


def _installed(name: str) -> Any:
    try:
        return import_module(name)
    except ImportError:
        return None


gymnasium: Any = _installed("gymnasium")


class PlainBox:
    """Numbers of a shape between two bounds."""

    def __init__(self, low: float, high: float, shape: tuple[int, ...], dtype: Any = np.float32):
        self.low, self.high = np.full(shape, low, dtype), np.full(shape, high, dtype)
        self.shape, self.dtype = shape, np.dtype(dtype)
        self._chance = np.random.default_rng()

    def seed(self, seed: int | None = None) -> None:
        self._chance = np.random.default_rng(seed)

    def sample(self) -> Any:
        return self._chance.uniform(self.low, self.high).astype(self.dtype)

    def contains(self, value: Any) -> bool:
        fits = isinstance(value, np.ndarray) and value.shape == self.shape and value.dtype == self.dtype
        return bool(fits and np.all(value >= self.low) and np.all(value <= self.high))


class PlainDict:
    """Spaces by name."""

    def __init__(self, spaces: Mapping[str, PlainBox]):
        self.spaces = dict(spaces)

    def sample(self) -> dict[str, Any]:
        return {name: space.sample() for name, space in self.spaces.items()}

    def contains(self, value: Any) -> bool:
        return set(value) == set(self.spaces) and all(s.contains(value[name]) for name, s in self.spaces.items())


class PlainEnv:
    """What an environment has of its own accord: a source of chance that `reset` seeds."""

    metadata: dict[str, Any] = {}
    render_mode: str | None = None
    np_random: np.random.Generator = np.random.default_rng()

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> Any:
        if seed is not None or self.np_random is PlainEnv.np_random:
            self.np_random = np.random.default_rng(seed)

    @property
    def unwrapped(self) -> Any:
        return self


Box: Any = gymnasium.spaces.Box if gymnasium else PlainBox
Dict: Any = gymnasium.spaces.Dict if gymnasium else PlainDict
Env: Any = gymnasium.Env if gymnasium else PlainEnv
VectorEnv: Any = gymnasium.vector.VectorEnv if gymnasium else PlainEnv
