"""A gripper takes a cloth by its hem, lifts it off a table, and measures what it weighs and how it turns.

Usage: grip_and_lift.py ADDRESS, as ws://127.0.0.1:8080/ws or that of the page.
"""

import sys

import numpy as np
import weft

GRAVITY = 9.81  # [m/s²]
AREA = 0.5 * 0.5  # of the cloth of this scene [m²]
MEASURED_TICKS = 60  # over which forces are averaged: they carry the cloth's vibration


def main(address: str) -> None:
    with weft.open(address, name="grip and lift") as cloth:
        cloth.pause()
        cloth.load("gripper")
        x, y, z = cloth.query("grippers")[0]["position"]
        cloth.gripper("gripper", opening=0, force=5)
        cloth.advance(120)
        print("gripping:", cloth.query("grippers")[0]["gripping"])

        cloth.gripper("gripper", position=[x, y + 0.6, z], speed=0.5)
        cloth.set(drag=5)  # so that it soon hangs still
        cloth.advance(420)
        force, torque = np.zeros(3), np.zeros(3)
        for _ in range(MEASURED_TICKS):
            jaws = cloth.advance(1, observe=["grippers"])["observation"].grippers[0]
            force += np.array(jaws.reaction) / MEASURED_TICKS
            torque += np.array(jaws.torque) / MEASURED_TICKS
        density = cloth.query("state")["fabrics"][0].get("areal_density", 0)
        print(f"it carries {-force[1]:.3f} N; the cloth weighs {density * AREA * GRAVITY:.3f} N")
        print(f"its torque about the jaws' middle is {np.linalg.norm(torque) * 1000:.2f} mN m")

        cloth.gripper("gripper", opening=0.06)
        cloth.advance(30)
        print("gripping:", cloth.query("grippers")[0]["gripping"])


if __name__ == "__main__":
    main(sys.argv[1])
