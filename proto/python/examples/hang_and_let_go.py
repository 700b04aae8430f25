"""Hangs a flag by two corners until it is still, and lets it go: it falls as everything does.

Usage: hang_and_let_go.py ADDRESS, as ws://127.0.0.1:8080/ws or that of the page.
"""

import sys

import weft

SCENE = {
    "name": "flag-to-let-go",
    "environment": {"air_density": 0, "drag": 5},  # damped while it comes to rest
    "cloths": [{"rows": 13, "columns": 19, "width": 0.9, "height": 0.6, "origin": [-0.45, 3, 0], "v": [0, -1, 0],
                "fabric": {"preset": "nylon"}}],
    "pins": [{"place": "corner", "corner": "top_left"}, {"place": "corner", "corner": "top_right"}],
}
AREA, GRAVITY = 0.9 * 0.6, 9.81  # of the flag [m²], [m/s²]
FALL_TICKS = 30


def main(address: str) -> None:
    with weft.open(address, name="hang and let go") as cloth:
        cloth.pause()
        cloth.load(SCENE)
        cloth.advance(180)
        hung = sum(pin["force"][1] for pin in cloth.query("reactions").get("pins", []))
        density = cloth.query("state")["fabrics"][0].get("areal_density", 0)
        print(f"the two pins carry {hung:.3f} N; the flag weighs {density * AREA * GRAVITY:.3f} N")

        cloth.set(drag=0)
        before = cloth.query("positions", format="f32").values
        cloth.release(all=True)
        cloth.advance(FALL_TICKS)
        after = cloth.query("positions", format="f32").values
        seconds = FALL_TICKS / 60
        print(f"in {seconds:g} s it fell {(before - after)[:, 1].mean():.3f} m; "
              f"g t²/2 is {GRAVITY * seconds**2 / 2:.3f} m")


if __name__ == "__main__":
    main(sys.argv[1])
