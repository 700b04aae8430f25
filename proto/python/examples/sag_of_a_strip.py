"""The sag of a strip that is clamped at one end, against the closed form of a beam: q L⁴ / 8 B.

Usage: sag_of_a_strip.py ADDRESS, as ws://127.0.0.1:8080/ws or that of the page.
"""

import sys

import weft

DENSITY, RIGIDITY = 0.2, 0.06  # [kg/m²], [N m]
LENGTH, HELD, WIDTH, CELLS = 0.2, 0.05, 0.05, 20  # free and clamped length [m], cells along the free part
COLUMNS = round(CELLS * (1 + HELD / LENGTH))
GRAVITY = 9.81
SCENE = {
    "name": "strip",
    "environment": {"air_density": 0, "drag": 20},
    "cloths": [{"rows": 6, "columns": COLUMNS + 1, "width": LENGTH + HELD, "height": WIDTH, "origin": [-HELD, 1, 0],
                "v": [0, 0, 1],
                "fabric": {"areal_density": DENSITY, "bending_warp": RIGIDITY, "bending_weft": RIGIDITY,
                           "stretch_warp": 2000, "stretch_weft": 2000, "shear": 200}}],
    "pins": [{"place": "edge", "side": "left", "width": HELD}],
}


def main(address: str) -> None:
    with weft.open(address, name="sag of a strip") as cloth:
        cloth.pause()
        cloth.load(SCENE)
        cloth.advance(180)
        positions = cloth.query("positions", format="f64").values.reshape(6, COLUMNS + 1, 3)
        sag = 1 - positions[:, -1, 1].mean()
        closed = DENSITY * GRAVITY * LENGTH**4 / (8 * RIGIDITY)
        print(f"sag [mm]: {sag * 1000:.3f}")
        print(f"q L⁴/8B [mm]: {closed * 1000:.3f}")
        print(f"difference [%]: {100 * (sag / closed - 1):.2f}")


if __name__ == "__main__":
    main(sys.argv[1])
