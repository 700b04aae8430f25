"""What a script may write, in both forms: a strict checker finds nothing in it."""

import asyncio

import numpy as np
import weft


def hold(address: str) -> float:
    with weft.open(address, name="script", call_timeout=10) as cloth:
        cloth.pause()
        cloth.set(wind=np.zeros(3), fans=[{"position": [0, 1, 2], "direction": [0, 0, -1]}], over_budget="slow")
        cloth.set(fabric={"preset": "silk", "friction": 0.2}, cloth=0)
        hit = cloth.pick([0, 1, 3], (0, 0, -1))
        if hit is not None:
            with cloth.drag(hit, radius=0.05, mode="sling") as hand:
                hand.move(np.array([0, 1.5, 1], np.float32))
        tick: int = cloth.advance(3, frames="last")["tick"]
        seen = cloth.advance(1, observe=["velocities"])["observation"]
        heights = seen.positions[:, 1]
        energy: float = cloth.query("energies")["kinetic"]
        pulled = sum(pin["force"][1] for pin in cloth.query("reactions").get("pins", []))
        values = cloth.query("positions", format="f64").values
        cloth.call_timeout = None
        names = [part["name"] for part in cloth.mesh["cloths"]]
        assert cloth.state is None or cloth.state["guarantee"]["state"] != "void"
        return tick + energy + float(heights.max()) + pulled + len(values) + len(names)


async def watch(address: str) -> list[int]:
    ticks: list[int] = []
    async with weft.connect(address, reconnect=True) as cloth:
        await cloth.gripper("gripper", opening=0, position=[0, 1, 0])
        print((await cloth.query("grippers"))[0]["torque"])
        async for frame in cloth.frames():
            ticks.append(frame.tick)
            if len(ticks) > 3:
                break
    return ticks


if __name__ == "__main__":
    print(weft.__version__, hold("ws://127.0.0.1:8080/ws"), asyncio.run(watch("ws://127.0.0.1:8080/ws")))
