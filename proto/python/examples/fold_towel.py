"""Two grippers take a towel by the hem that hangs over the edge of a table and fold it in half.

Usage: fold_towel.py ADDRESS, as ws://127.0.0.1:8080/ws or that of the page.
"""

import math
import sys

import weft

SIDE, TABLE, OVERHANG = 0.4, 0.3, 0.06  # of the towel, height of the table, what hangs over its edge [m]
EDGE = 0.25  # of the table [m]
CLEARANCE = 0.02  # of the jaws above the table when they let go [m]
JAWS = {"half_extents": [0.006, 0.015, 0.02], "opening": 0.06, "force": 5, "speed": 0.4,
        "orientation": [0, 0, math.sqrt(0.5), math.sqrt(0.5)]}  # they close up and down
NAMES = {"near": -0.12, "far": 0.12}  # the grippers, and where they are along the hem
SCENE = {
    "name": "towel",
    "environment": {"drag": 1},
    "cloths": [{"name": "towel", "rows": 15, "columns": 15, "width": SIDE, "height": SIDE, "u": [1, 0, 0],
                "v": [0, 0, 1], "origin": [EDGE + OVERHANG - SIDE, TABLE + 0.006, -SIDE / 2],
                "fabric": {"preset": "cotton"}}],
    "colliders": [{"name": "table", "shape": "box", "center": [0, TABLE / 2, 0], "half_extents": [EDGE, TABLE / 2, 0.3]}],
    "grippers": [{"name": name, "center": [EDGE + OVERHANG - 0.02, TABLE, z], **JAWS} for name, z in NAMES.items()],
}


def both(cloth: weft.SyncClient, ticks: int, *, x: float = 0, y: float = 0, turn: float | None = None,
         opening: float | None = None) -> None:
    """Moves both grippers by the same way and turns them about the hem [rad], or opens and closes them."""
    rotation = None if turn is None else [0, 0, math.sin(turn / 2), math.cos(turn / 2)]
    for name, jaws in zip(NAMES, cloth.query("grippers")):
        a, b, c = jaws["position"]
        cloth.gripper(name, position=[a + x, b + y, c], rotation=rotation, opening=opening)
    cloth.advance(ticks)


def length(cloth: weft.SyncClient) -> float:
    """How far the towel reaches along x [m]."""
    x = cloth.query("positions", format="f32").values[:, 0]
    return float(x.max() - x.min())


def main(address: str) -> None:
    with weft.open(address, name="fold a towel") as cloth:
        cloth.pause()
        cloth.load(SCENE)
        both(cloth, 90, opening=0)
        print("gripping:", *(jaws["gripping"] for jaws in cloth.query("grippers")))
        print(f"flat it is {length(cloth):.3f} m long")
        # Half a circle about the crease, turning as a wrist does, to just above the other hem.
        steps, middle = 24, SIDE / 2 - 0.03
        for k in range(steps):
            now, then = (math.pi * n / steps for n in (k, k + 1))
            across = middle * (math.cos(then) - math.cos(now))
            up = middle * (math.sin(then) - math.sin(now)) + CLEARANCE / steps
            both(cloth, 8, x=across, y=up, turn=then)
        both(cloth, 30, opening=0.02)
        both(cloth, 60, x=-0.1)
        cloth.advance(90)
        print(f"folded it is {length(cloth):.3f} m long")
        print("crossings:", cloth.query("crossings")["count"])


if __name__ == "__main__":
    main(sys.argv[1])
