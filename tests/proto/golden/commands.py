"""Golden commands: texts with what must be read from them."""


def accepted(text, **request):
    return {"text": text, "request": request}


HIT = dict(triangle=411, barycentric=[0.25, 0.5, 0.25])
DRAG = dict(radius=0.03, stiffness=150, max_force=50, mode="live")
SLING = dict(radius=0.03, stiffness=20, max_force=50, mode="sling")

# The request is the command with all defaults written out.
ACCEPTED = [
    accepted('{"op":"pause"}', op="pause"),
    accepted(' \n{"op" : "resume", "id": 0}\t', op="resume", id=0),
    accepted('{"op":"resume","id":9007199254740992}', op="resume", id=9007199254740992),
    accepted('{"op":"hash","id":"a"}', op="hash", id="a"),
    accepted('{"op":"hash","id":"\\u00e9\\ud83e\\uddf5"}', op="hash", id="é🧵"),
    accepted('{"op":"reset","id":null,"unknown":[{"deep":[1]}]}', op="reset"),
    accepted('{"op":"policy","policy":"one_hand"}', op="policy", policy="one_hand"),
    accepted('{"op":"mute","viewer":4}', op="mute", viewer=4),
    accepted('{"op":"mute","viewer":4,"muted":false}', op="mute", viewer=4, muted=False),
    accepted('{"op":"give_hand","id":7,"viewer":4294967295}', op="give_hand", id=7, viewer=4294967295),
    accepted('{"op":"give_hand","viewer":4,"given":false}', op="give_hand", viewer=4, given=False),
    accepted('{"op":"presence"}', op="presence"),
    accepted('{"op":"presence","cursor":[0.5,1,-2]}', op="presence", cursor=[0.5, 1, -2]),
    accepted(
        '{"op":"presence","away":true,"camera":{"position":[0,1,3],"target":[0,1,0]}}',
        op="presence", away=True, camera={"position": [0, 1, 3], "target": [0, 1, 0], "up": [0, 1, 0], "fov": 45},
    ),
    accepted('{"op":"follow","viewer":3}', op="follow", viewer=3),
    accepted('{"op":"lead"}', op="lead"),
    accepted('{"op":"lead","on":false}', op="lead", on=False),
    accepted('{"op":"invite","right":"hold"}', op="invite", right="hold"),
    accepted('{"op":"hello"}', op="hello"),
    accepted(
        '{"op":"hello","name":"Żółć 🧵","color":"#00fFa9","token":""}',
        op="hello", name="Żółć 🧵", color="#00fFa9", token="",
    ),
    accepted('{"op":"hello","name":"' + "é" * 32 + '"}', op="hello", name="é" * 32),
    accepted(
        '{"op":"pick","origin":[0,1,3],"direction":[0,0,-1e-9]}',
        op="pick", origin=[0, 1, 3], direction=[0, 0, -1e-9],
    ),
    accepted(
        '{"op":"drag","phase":"start","triangle":411,"barycentric":[0.25,0.5,0.25]}',
        op="drag", phase="start", drag=0, **HIT, **DRAG,
    ),
    accepted(
        '{"op":"drag","phase":"start","drag":2147483647,"particle":2.0,"target":[-10000,10000,0],'
        '"radius":0,"stiffness":1e5,"max_force":0}',
        op="drag", phase="start", drag=2147483647, particle=2, target=[-10000, 10000, 0], mode="live",
        radius=0, stiffness=100000, max_force=0,
    ),
    accepted(
        '{"op":"drag","phase":"start","particle":3,"triangle":null,"target":null}',
        op="drag", phase="start", drag=0, particle=3, **DRAG,
    ),
    accepted(
        '{"op":"drag","phase":"move","drag":1,"target":[0.1,-0.0,5e-324]}',
        op="drag", phase="move", drag=1, target=[0.1, -0.0, 5e-324],
    ),
    accepted('{"op":"drag","phase":"end","drag":1}', op="drag", phase="end", drag=1),
    accepted('{"op":"drag","phase":"end","fire":true}', op="drag", phase="end", drag=0),
    accepted(
        '{"op":"drag","phase":"end","drag":1,"fire":false}',
        op="drag", phase="end", drag=1, fire=False,
    ),
    accepted(
        '{"op":"drag","phase":"start","particle":3,"mode":"sling"}',
        op="drag", phase="start", drag=0, particle=3, **SLING,
    ),
    accepted(
        '{"op":"drag","phase":"start","particle":3,"stiffness":7,"mode":"sling"}',
        op="drag", phase="start", drag=0, particle=3, **{**SLING, "stiffness": 7},
    ),
    accepted('{"op":"pin","particle":0}', op="pin", particle=0, radius=0),
    accepted(
        '{"op":"pin","triangle":0,"barycentric":[1,0,0],"radius":100}',
        op="pin", triangle=0, barycentric=[1, 0, 0], radius=100,
    ),
    accepted('{"op":"release","pin":4294967295}', op="release", pin=4294967295),
    accepted('{"op":"release","particle":7}', op="release", particle=7),
    accepted('{"op":"release","all":true}', op="release", all=True),
    accepted(
        '{"op":"camera","position":[0,1,3],"target":[0,1,0]}',
        op="camera", position=[0, 1, 3], target=[0, 1, 0], up=[0, 1, 0], fov=45,
    ),
    accepted(
        '{"op":"camera","position":[0,1,3],"target":[0,1,0],"up":[0,0,-2],"fov":179}',
        op="camera", position=[0, 1, 3], target=[0, 1, 0], up=[0, 0, -2], fov=179,
    ),
    accepted('{"op":"step"}', op="step", n=1),
    accepted('{"op":"step","n":600}', op="step", n=600),
    accepted('{"op":"speed","speed":0.01}', op="speed", speed=0.01),
    accepted(
        '{"op":"move","collider":"ball","position":[1000,-1000,0]}',
        op="move", collider="ball", position=[1000, -1000, 0], speed=0.5, turn_speed=2,
    ),
    accepted(
        '{"op":"move","collider":"b","rotation":[0,0.6,0,0.8],"speed":20,"turn_speed":0.001,'
        '"release":false}',
        op="move", collider="b", rotation=[0, 0.6, 0, 0.8], speed=20, turn_speed=0.001,
    ),
    accepted('{"op":"move","collider":2147483647,"release":true}', op="move", collider=2147483647,
             release=True),
    accepted('{"op":"move","collider":3.0,"position":[0,1,0]}', op="move", collider=3, position=[0, 1, 0],
             speed=0.5, turn_speed=2),
    accepted('{"op":"move","collider":"ball","release":true}', op="move", collider="ball",
             release=True),
    accepted(
        '{"op":"move","pin":4294967295,"position":[10000,-10000,0]}',
        op="move", pin=4294967295, position=[10000, -10000, 0], speed=2, max_force=50,
    ),
    accepted(
        '{"op":"move","pin":1,"position":[0,1,0],"speed":20,"max_force":0,"collider":null,"stop":false}',
        op="move", pin=1, position=[0, 1, 0], speed=20, max_force=0,
    ),
    accepted(
        '{"op":"move","pin":1,"position":[0,1,0],"seconds":3600,"max_force":1e6}',
        op="move", pin=1, position=[0, 1, 0], seconds=3600, max_force=1000000,
    ),
    accepted('{"op":"move","pin":1,"stop":true}', op="move", pin=1, stop=True),
    accepted('{"op":"query","what":"colliders"}', op="query", what="colliders", format="json"),
    accepted('{"op":"set","wind":[100,-100,0]}', op="set", wind=[100, -100, 0]),
    accepted(
        '{"op":"set","gravity":[0,-9.81,0],"wind":[0,0,0],"gust_speed":100,"gust_length":0.01,'
        '"air_density":1.2,"still_air":false,"drag":1000}',
        op="set", gravity=[0, -9.81, 0], wind=[0, 0, 0], gust_speed=100, gust_length=0.01,
        air_density=1.2, still_air=False, drag=1000,
    ),
    accepted('{"op":"set","fans":[]}', op="set", fans=[]),
    accepted('{"op":"set","softness":0.01,"budget_ms":1000,"over_budget":"soften"}',
             op="set", softness=0.01, budget_ms=1000, over_budget="soften"),
    accepted('{"op":"set","budget_ms":0,"over_budget":"slow"}', op="set", budget_ms=0,
             over_budget="slow"),
    accepted(
        '{"op":"set","fans":[{"position":[0,1,2],"direction":[0,0,-3]},{"position":[1,0,0],'
        '"direction":[1,0,0],"speed":50,"radius":0.01,"spread":0,"reach":100}]}',
        op="set", fans=[
            dict(position=[0, 1, 2], direction=[0, 0, -3], speed=5, radius=0.25, spread=0.2,
                 reach=1.5),
            dict(position=[1, 0, 0], direction=[1, 0, 0], speed=50, radius=0.01, spread=0,
                 reach=100),
        ],
    ),
    accepted('{"op":"advance","n":100000}', op="advance", n=100000),
    accepted('{"op":"advance","n":1,"frames":null}', op="advance", n=1),
    accepted('{"op":"advance","n":1,"frames":"all"}', op="advance", n=1, frames="all"),
    accepted('{"op":"advance","n":2,"frames":"last"}', op="advance", n=2, frames="last"),
    accepted('{"op":"advance","n":3,"frames":"none"}', op="advance", n=3, frames="none"),
    accepted('{"op":"advance","n":4,"observe":["velocities","grippers"]}', op="advance", n=4,
             observe=["velocities", "grippers"]),
    accepted('{"op":"query","what":"energies"}', op="query", what="energies", format="json"),
    accepted(
        '{"op":"query","what":"velocities","format":"f64"}',
        op="query", what="velocities", format="f64",
    ),
    accepted(
        '{"op":"query","what":"camera","viewer":4}',
        op="query", what="camera", format="json", viewer=4,
    ),
    accepted(
        '{"op":"gripper","name":"g","opening":0,"force":2.5}',
        op="gripper", name="g", opening=0, force=2.5,
    ),
    accepted(
        '{"op":"gripper","name":"g","position":[0,1,0],"rotation":[0,0,0.6,0.8],"speed":1,'
        '"turn_speed":2,"id":9}',
        op="gripper", name="g", position=[0, 1, 0], rotation=[0, 0, 0.6, 0.8], speed=1,
        turn_speed=2, id=9,
    ),
    accepted('{"op":"query","what":"grippers"}', op="query", what="grippers", format="json"),
    accepted('{"op":"query","what":"crossings"}', op="query", what="crossings", format="json"),
    accepted('{"op":"query","what":"contacts"}', op="query", what="contacts", format="json"),
    accepted('{"op":"query","what":"reactions"}', op="query", what="reactions", format="json"),
    accepted('{"op":"query","what":"trees"}', op="query", what="trees", format="json"),
    accepted(
        '{"op":"query","what":"boxes","tree":"object:form"}',
        op="query", what="boxes", format="json", tree="object:form",
    ),
    accepted(
        '{"op":"query","what":"boxes","tree":"triangles","level":255,"format":"f32"}',
        op="query", what="boxes", format="f32", tree="triangles", level=255,
    ),
    accepted('{"op":"ping","t":-1.5}', op="ping", t=-1.5),
    accepted('{"op":"load","scene":"drape-sphere_2.v"}', op="load", scene="drape-sphere_2.v"),
    accepted(
        '{"op":"load","scene":{"cloths":[{"rows":5,"width":0.5}],"name":"mine"}}',
        op="load", scene={"cloths": [{"rows": 5, "width": 0.5}], "name": "mine"},
    ),
    accepted('{"op":"create_room","name":"a"}', op="create_room", name="a"),
    accepted(
        '{"op":"create_room","name":"0-class-7-of-the-school-of-weave","scene":"flag","paused":true}',
        op="create_room", name="0-class-7-of-the-school-of-weave", scene="flag", paused=True,
    ),
    accepted('{"op":"save","name":"grasp"}', op="save", name="grasp"),
    accepted('{"op":"restore","name":"grasp"}', op="restore", name="grasp"),
    accepted('{"op":"fork","name":"mine"}', op="fork", name="mine"),
    accepted('{"op":"fork","name":"mine","paused":false}', op="fork", name="mine", paused=False),
    accepted('{"op":"list_rooms","id":3}', op="list_rooms", id=3),
    accepted('{"op":"close_room","name":"a-"}', op="close_room", name="a-"),
    accepted('{"op":"view","hz":0}', op="view", hz=0),
    accepted('{"op":"view","hz":59.94,"codec":"f32"}', op="view", hz=59.94, codec="f32"),
    accepted('{"op":"view","forces":true}', op="view", forces=True),
    accepted('{"op":"view","codec":"packed"}', op="view", codec="packed"),
    accepted('{"op":"view","error":0.00001}', op="view", error=0.00001),
]
