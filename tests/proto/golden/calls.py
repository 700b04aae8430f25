"""Calls of clients and the commands that they send."""

from commands import HIT


def call(method, *args, sends, **options):
    return {"method": method, "args": list(args), "options": options, "sends": sends}


# What the clients must send (without the id) when a method is called.
CLIENT_CALLS = [
    call("hello", name="Ada", color="#e4572e",
         sends={"op": "hello", "name": "Ada", "color": "#e4572e"}),
    call("pick", [0, 1, 3], [0, 0, -1],
         sends={"op": "pick", "origin": [0, 1, 3], "direction": [0, 0, -1]}),
    call("pin", {"particle": 299}, radius=0.05,
         sends={"op": "pin", "particle": 299, "radius": 0.05}),
    call("pin", {**HIT, "position": [0, 1, 0], "particle": 222, "distance": 2.88},
         sends={"op": "pin", **HIT}),
    call("release", pin=9, sends={"op": "release", "pin": 9}),
    call("release", particle=299, sends={"op": "release", "particle": 299}),
    call("release", all=True, sends={"op": "release", "all": True}),
    call("camera", [0, 1.25, 3], [0, 1, 0], fov=50,
         sends={"op": "camera", "position": [0, 1.25, 3], "target": [0, 1, 0], "fov": 50}),
    call("pause", sends={"op": "pause"}),
    call("resume", sends={"op": "resume"}),
    call("step", sends={"op": "step", "n": 1}),
    call("step", 5, sends={"op": "step", "n": 5}),
    call("reset", sends={"op": "reset"}),
    call("speed", 0.25, sends={"op": "speed", "speed": 0.25}),
    call("move", "ball", position=[0, 1, 0], speed=2,
         sends={"op": "move", "collider": "ball", "position": [0, 1, 0], "speed": 2}),
    call("move", "ball", release=True,
         sends={"op": "move", "collider": "ball", "release": True}),
    call("move", {"collider": 3}, position=[0, 1, 0],
         sends={"op": "move", "collider": 3, "position": [0, 1, 0]}),
    call("move", 9, position=[0, 1, 0], seconds=1.5, max_force=20,
         sends={"op": "move", "pin": 9, "position": [0, 1, 0], "seconds": 1.5, "max_force": 20}),
    call("move", 9, stop=True, sends={"op": "move", "pin": 9, "stop": True}),
    call("gripper", "g", opening=0, force=3,
         sends={"op": "gripper", "name": "g", "opening": 0, "force": 3}),
    call("set", wind=[3, 0, 0], still_air=True,
         sends={"op": "set", "wind": [3, 0, 0], "still_air": True}),
    call("advance", 600, sends={"op": "advance", "n": 600}),
    call("advance", 1, frames="last", sends={"op": "advance", "n": 1, "frames": "last"}),
    call("advance", 10, observe=["velocities"], sends={"op": "advance", "n": 10, "observe": ["velocities"]}),
    call("query", "camera", viewer=4, sends={"op": "query", "what": "camera", "viewer": 4}),
    call("query", "boxes", tree="edges", level=3, sends={
        "op": "query", "what": "boxes", "tree": "edges", "level": 3}),
    call("query", "energies", sends={"op": "query", "what": "energies"}),
    call("hash", sends={"op": "hash"}),
    call("load", "flag", sends={"op": "load", "scene": "flag"}),
    call("create_room", "class-7", scene="flag", paused=True,
         sends={"op": "create_room", "name": "class-7", "scene": "flag", "paused": True}),
    call("create_room", "a", sends={"op": "create_room", "name": "a"}),
    call("save", "grasp", sends={"op": "save", "name": "grasp"}),
    call("restore", "grasp", sends={"op": "restore", "name": "grasp"}),
    call("fork", "mine", paused=False, sends={"op": "fork", "name": "mine", "paused": False}),
    call("list_rooms", sends={"op": "list_rooms"}),
    call("close_room", "class-7", sends={"op": "close_room", "name": "class-7"}),
    call("query", "contacts", sends={"op": "query", "what": "contacts"}),
    call("view", hz=0, sends={"op": "view", "hz": 0}),
    call("view", forces=True, sends={"op": "view", "forces": True}),
    call("view", codec="packed", error=1e-5,
         sends={"op": "view", "codec": "packed", "error": 1e-5}),
]
