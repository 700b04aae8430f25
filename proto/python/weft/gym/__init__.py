"""Cloth for reinforcement learning: environments of Gymnasium's form.

    env = weft.gym.ClothEnv("ws://127.0.0.1:8080/ws", actors=[weft.gym.Gripper()], render_mode="rgb_array")
    observation, info = env.reset(seed=1)
    observation, reward, finished, cut, info = env.step(env.action_space.sample())

It needs numpy, and works without gymnasium: spaces then have `sample`, `seed`, `contains`, `shape` and `dtype` alone.
"""

from .actors import Actor, Gripper, Hand
from .env import ClothEnv, Randomise, Reward, lifted
from .picture import Picture
from .vector import VectorClothEnv

__all__ = ["Actor", "ClothEnv", "Gripper", "Hand", "Picture", "Randomise", "Reward", "VectorClothEnv", "lifted"]
