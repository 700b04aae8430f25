"""A hundred episodes with a fabric drawn at random each: how far a cloth pulled at its hem gives way.

Usage: random_fabrics.py ADDRESS [EPISODES [SEED]], the address as ws://127.0.0.1:8080/ws or that of the page.
"""

import sys

import numpy as np
import weft

SCENE = {
    "name": "hem",
    "environment": {"drag": 8, "air_density": 0},
    "cloths": [{"rows": 9, "columns": 9, "width": 0.3, "height": 0.3, "origin": [0, 1, 0], "v": [0, -1, 0]}],
    "pins": [{"place": "edge", "side": "top"}],
}
HEIGHT, GRAVITY, TICKS = 0.3, 9.81, 60


def main(address: str, episodes: int = 100, seed: int = 7) -> None:
    chance = np.random.default_rng(seed)
    measured, expected = np.zeros(episodes), np.zeros(episodes)
    with weft.open(address, name="random fabrics") as cloth:
        cloth.view(hz=0)
        cloth.pause()
        cloth.load(SCENE)
        for k in range(episodes):
            density, stiffness = chance.uniform(0.1, 0.4), 10 ** chance.uniform(1.5, 2.5)
            cloth.reset()
            cloth.set(fabric={"areal_density": density, "stretch_weft": stiffness, "shear": stiffness / 10})
            cloth.advance(TICKS)
            lowest = cloth.query("positions", format="f32").values[:, 1].min()
            measured[k] = 1 - HEIGHT - lowest
            expected[k] = density * GRAVITY * HEIGHT**2 / (2 * stiffness)
        digest = cloth.hash()
    print(f"episodes: {episodes}")
    print(f"longer by {measured.min() * 1000:.3f} to {measured.max() * 1000:.3f} mm")
    print(f"correlation with sigma g L²/2k: {np.corrcoef(measured, expected)[0, 1]:.5f}")
    print("hash of the last state:", digest)


if __name__ == "__main__":
    main(sys.argv[1], *map(int, sys.argv[2:4]))
