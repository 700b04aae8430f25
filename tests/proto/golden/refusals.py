"""Golden refusals: texts and bytes that are no commands, with the errors that answer them."""


def limits(minimum, maximum):
    return {"minimum": minimum, "maximum": maximum}


def refuse(text, code, **error):
    return {"text": text, "error": dict(code=code, **error)}


POSITION = limits(-10000, 10000)
START = '{"op":"drag","phase":"start",'
MOVE = '{"op":"drag","phase":"move","drag":1,"target":'


def refused_texts():
    """Messages that are no JSON object of the allowed shape."""
    for text in ("", "{", "}", '{"op":"pause"', '{"op":"pause"}}', '{"op":"pause"} {}', "nul",
                 '{"op":"pause",}', "{'op':'pause'}", '{"op":"pau\nse"}', '{"op":"\\ud800"}',
                 '{"op":"\\x41"}', '{op:"pause"}', '/**/{"op":"pause"}', '{"t":NaN}', '{"t":01}',
                 '{"t":Infinity}', '{"t":+1}', '{"t":.5}', '{"t":1.}', "\0", '{"op":"pause"}\0',
                 '{"op":"pause"}\0{', '{"op":\0"pause"}'):
        yield refuse(text, "bad_json")
    yield refuse('{"op":"pause","a":' + "[" * 7 + "]" * 7 + ',"id":[[[[[[[[', "bad_json")
    yield refuse('{"op":"pause","a":' + "[" * 8 + "]" * 8 + "}", "bad_json")
    for text in ("null", "1", '"pause"', "[]", '[{"op":"pause"}]'):
        yield refuse(text, "not_an_object")
    yield refuse('{"op":"pause","op":"resume"}', "duplicate_key", field="op")
    yield refuse('{"op":"pause","a":[{"b":1,"b":1}]}', "duplicate_key", field="a[0].b")
    yield refuse('{"op":"pause","\\u0061":1,"a":2}', "duplicate_key", field="a")
    yield refuse('{"op":"ping","t":1e999}', "not_finite", field="t", value="1e999")
    yield refuse(MOVE + "[0,-1e400,0]}", "not_finite", field="target[1]", value="-1e400")
    # Not read, but the id can be found.
    yield refuse('{"op":"ping","t":1e999,"id":5}', "not_finite", field="t", id=5)
    yield refuse('{"op":"pause","id":"a","a":{"b":1,"b":[{"id":2}]}}', "duplicate_key", field="a.b", id="a")
    yield refuse('{"op":"pause","a":' + "[" * 8 + "]" * 8 + ' , "id" : 7.0 }', "bad_json", id=7)


def refused_bytes():
    """Bytes that are not UTF-8."""
    for middle in (b"\x80", b"\xc0\xaf", b"\xc2", b"\xe0\x80\x80", b"\xed\xa0\x80", b"\xf5\x80\x80\x80",
                   b"\xf4\x90\x80\x80", b"\xff", b"\xe2\x82"):
        content = b'{"op":"hello","name":"' + middle + b'"}'
        yield {"hex": content.hex(), "error": {"code": "bad_utf8"}}


def refused_fields():
    yield refuse("{}", "missing_field", field="op")
    yield refuse('{"id":5}', "missing_field", field="op", id=5)
    yield refuse('{"op":7,"id":5}', "wrong_type", field="op", value=7, id=5)
    yield refuse('{"op":"jump","id":"j"}', "unknown_op", field="op", value="jump", id="j")
    yield refuse('{"op":"Pause"}', "unknown_op", field="op", value="Pause")
    yield refuse('{"op":"pause","id":-1}', "out_of_range", field="id", value=-1)
    for beyond in (2**53 + 1, 2**53 + 2, 2**63, 2**64 - 1):
        yield refuse(f'{{"op":"pause","id":{beyond}}}', "out_of_range", field="id", value=beyond,
                     limit=limits(0, 9007199254740992))
    yield refuse('{"op":"step","n":9007199254740993}', "out_of_range", field="n")
    yield refuse('{"op":"pause","id":0.5}', "wrong_type", field="id", value=0.5)
    yield refuse('{"op":"pause","id":[1]}', "wrong_type", field="id", value=[1])
    yield refuse('{"op":"pause","id":""}', "wrong_length", field="id", value="",
                 limit=limits(1, 64))
    yield refuse('{"op":"pause","id":"' + "i" * 65 + '"}', "wrong_length", field="id")
    yield refuse('{"op":"hello","name":""}', "wrong_length", field="name", command="hello",
                 limit=limits(1, 32))
    yield refuse('{"op":"hello","name":"' + "é" * 33 + '"}', "wrong_length", field="name")
    yield refuse('{"op":"hello","name":"a\\u0007"}', "unknown_value", field="name")
    yield refuse('{"op":"hello","name":"a\\u0085"}', "unknown_value", field="name")
    for color in ("red", "#12345", "#1234567", "#12345g", ""):
        yield refuse(f'{{"op":"hello","color":"{color}"}}', "unknown_value", field="color", value=color)
    yield refuse('{"op":"hello","token":"' + "t" * 257 + '"}', "wrong_length", field="token",
                 limit=limits(0, 256))
    yield refuse('{"op":"pick","direction":[0,0,1]}', "missing_field", field="origin")
    yield refuse('{"op":"pick","id":1,"origin":[0,1,3],"direction":[0,0,0]}', "out_of_range",
                 field="direction", value=[0, 0, 0], id=1, command="pick")
    yield refuse('{"op":"pick","origin":[0,1],"direction":[0,0,1]}', "wrong_length",
                 field="origin", value=[0, 1], limit={"length": 3})
    yield refuse('{"op":"pick","origin":{"x":0},"direction":[0,0,1]}', "wrong_type", field="origin")
    yield refuse('{"op":"pick","origin":[0,"1",0],"direction":[0,0,1]}', "wrong_type",
                 field="origin[1]", value="1")
    yield refuse('{"op":"pick","origin":[0,0,null],"direction":[0,0,1]}', "wrong_type",
                 field="origin[2]", value=None)
    yield refuse('{"op":"drag","id":3}', "missing_field", field="phase", command="drag", id=3)
    yield refuse('{"op":"drag","phase":"shake"}', "unknown_value", field="phase", value="shake",
                 limit={"allowed": ["start", "move", "end"]})
    yield refuse(START + '"drag":1}', "missing_field", field="particle")
    yield refuse(START + '"particle":1,"mode":"throw"}', "unknown_value", field="mode",
                 value="throw", limit={"allowed": ["live", "sling"]})
    yield refuse('{"op":"drag","phase":"end","fire":1}', "wrong_type", field="fire", value=1)
    yield refuse(START + '"particle":1,"triangle":2,"barycentric":[1,0,0]}', "conflicting_fields",
                 field="triangle")
    yield refuse(START + '"triangle":2}', "missing_field", field="barycentric")
    yield refuse(START + '"triangle":2,"barycentric":[0.5,0.6,0]}', "out_of_range",
                 field="barycentric", value=[0.5, 0.6, 0])
    yield refuse(START + '"triangle":2,"barycentric":[1.5,-0.5,0]}', "out_of_range",
                 field="barycentric[0]", value=1.5, limit=limits(0, 1))
    yield refuse(START + '"particle":-1}', "out_of_range", field="particle", value=-1,
                 limit=limits(0, 2147483647))
    yield refuse(START + '"particle":1.5}', "wrong_type", field="particle", value=1.5)
    yield refuse(START + '"particle":true}', "wrong_type", field="particle", value=True)
    yield refuse(START + '"particle":1e300}', "out_of_range", field="particle", value=1e300)
    yield refuse(START + '"particle":1,"drag":2147483648}', "out_of_range", field="drag")
    yield refuse(START + '"particle":1,"radius":-0.1}', "out_of_range", field="radius", value=-0.1,
                 limit=limits(0, 100))
    yield refuse(START + '"particle":1,"stiffness":100001}', "out_of_range", field="stiffness",
                 limit=limits(0, 100000))
    yield refuse(START + '"particle":1,"max_force":1e7}', "out_of_range", field="max_force",
                 limit=limits(0, 1000000))
    yield refuse('{"op":"drag","phase":"move","drag":1}', "missing_field", field="target")
    yield refuse(MOVE + '[0,1e99,0],"id":13}', "out_of_range", field="target[1]", value=1e99,
                 limit=POSITION, id=13, command="drag")
    yield refuse(MOVE + "[0,0,0,0]}", "wrong_length", field="target", limit={"length": 3})
    yield refuse(MOVE + '"up"}', "wrong_type", field="target", value="up")
    yield refuse('{"op":"pin"}', "missing_field", field="particle", command="pin")
    yield refuse('{"op":"pin","particle":1,"radius":101}', "out_of_range", field="radius")
    yield refuse('{"op":"release"}', "missing_field", field="pin")
    yield refuse('{"op":"release","pin":1,"all":true}', "conflicting_fields", field="pin", value=1)
    yield refuse('{"op":"release","all":false}', "unknown_value", field="all", value=False)
    yield refuse('{"op":"release","all":1}', "wrong_type", field="all", value=1)
    yield refuse('{"op":"release","pin":4294967296}', "out_of_range", field="pin")
    yield refuse('{"op":"camera","position":[0,1,3]}', "missing_field", field="target")
    yield refuse('{"op":"camera","position":[0,1,3],"target":[0,1,3]}', "out_of_range",
                 field="target")
    yield refuse('{"op":"camera","position":[0,1,3],"target":[0,1,0],"up":[0,0,0]}',
                 "out_of_range", field="up")
    yield refuse('{"op":"camera","position":[0,1,3],"target":[0,1,0],"fov":180}', "out_of_range",
                 field="fov", limit=limits(1, 179))
    yield refuse('{"op":"step","n":0}', "out_of_range", field="n", limit=limits(1, 600))
    yield refuse('{"op":"step","n":601}', "out_of_range", field="n", value=601)
    yield refuse('{"op":"step","n":1.5}', "wrong_type", field="n", value=1.5)
    yield refuse('{"op":"speed"}', "missing_field", field="speed")
    yield refuse('{"op":"speed","speed":0}', "out_of_range", field="speed", limit=limits(0.01, 10))
    yield refuse('{"op":"speed","speed":"fast"}', "wrong_type", field="speed", value="fast")
    yield refuse('{"op":"move","position":[0,1,0]}', "missing_field", field="collider")
    yield refuse('{"op":"move","collider":"","position":[0,1,0]}', "wrong_length", field="collider")
    yield refuse('{"op":"move","collider":"' + 65 * "b" + '","position":[0,1,0]}', "wrong_length", field="collider")
    for wrong in ("-1", "2147483648"):
        yield refuse('{"op":"move","collider":%s,"position":[0,1,0]}' % wrong, "out_of_range", field="collider",
                     limit={"minimum": 0, "maximum": 2147483647})
    for wrong in ("0.5", "true", "[2]", "{}"):
        yield refuse('{"op":"move","collider":%s,"position":[0,1,0]}' % wrong, "wrong_type", field="collider")
    yield refuse('{"op":"move","collider":"ball"}', "missing_field", field="position")
    yield refuse('{"op":"move","collider":"ball","position":[0,1000.5,0]}', "out_of_range",
                 field="position[1]", limit=limits(-1000, 1000))
    yield refuse('{"op":"move","collider":"ball","rotation":[0,0,1]}', "wrong_length",
                 field="rotation", limit={"length": 4})
    yield refuse('{"op":"move","collider":"ball","rotation":[0,0,0.5,0.5]}', "out_of_range",
                 field="rotation")
    yield refuse('{"op":"move","collider":"ball","position":[0,1,0],"speed":20.5}', "out_of_range",
                 field="speed", limit=limits(0.001, 20))
    yield refuse('{"op":"move","collider":"ball","position":[0,1,0],"turn_speed":0}',
                 "out_of_range", field="turn_speed", limit=limits(0.001, 60))
    yield refuse('{"op":"move","collider":"ball","position":[0,1,0],"release":true}',
                 "conflicting_fields", field="position")
    yield refuse('{"op":"move","collider":"ball","position":[0,1,0],"seconds":1}',
                 "conflicting_fields", field="seconds", value=1)
    yield refuse('{"op":"move","pin":1,"collider":"ball","position":[0,1,0]}',
                 "conflicting_fields", field="collider", value="ball")
    yield refuse('{"op":"move","pin":"a","position":[0,1,0]}', "wrong_type", field="pin", value="a")
    yield refuse('{"op":"move","pin":4294967296,"position":[0,1,0]}', "out_of_range", field="pin",
                 limit=limits(0, 4294967295))
    yield refuse('{"op":"move","pin":1}', "missing_field", field="position", command="move")
    yield refuse('{"op":"move","pin":1,"position":[0,10001,0]}', "out_of_range",
                 field="position[1]", value=10001, limit=POSITION)
    yield refuse('{"op":"move","pin":1,"position":[0,1,0],"rotation":[0,0,0,1]}',
                 "conflicting_fields", field="rotation")
    yield refuse('{"op":"move","pin":1,"position":[0,1,0],"speed":0}', "out_of_range",
                 field="speed", value=0, limit=limits(0.001, 20))
    yield refuse('{"op":"move","pin":1,"position":[0,1,0],"seconds":0}', "out_of_range",
                 field="seconds", value=0, limit=limits(0.001, 3600))
    yield refuse('{"op":"move","pin":1,"position":[0,1,0],"seconds":1,"speed":1}',
                 "conflicting_fields", field="speed", value=1)
    yield refuse('{"op":"move","pin":1,"position":[0,1,0],"max_force":-1}', "out_of_range",
                 field="max_force", value=-1, limit=limits(0, 1000000))
    yield refuse('{"op":"move","pin":1,"position":[0,1,0],"stop":true}', "conflicting_fields",
                 field="position", value=[0, 1, 0])
    yield refuse('{"op":"move","pin":1,"stop":1}', "wrong_type", field="stop", value=1)
    yield refuse('{"op":"set"}', "missing_field", command="set")
    yield refuse('{"op":"set","winds":[1,0,0]}', "missing_field")
    yield refuse('{"op":"set","fans":{}}', "wrong_type", field="fans", value={})
    yield refuse('{"op":"set","fans":[3]}', "wrong_type", field="fans[0]", value=3)
    yield refuse('{"op":"set","fans":[{},{},{},{},{}]}', "wrong_length", field="fans",
                 limit={"maximum": 4})
    yield refuse('{"op":"set","fans":[{"direction":[0,0,1]}]}', "missing_field",
                 field="fans[0].position")
    yield refuse('{"op":"set","wind":[1,0,0],"fans":[{"position":[0,0,0],"direction":[0,0,1]},'
                 '{"position":[0,0,0],"direction":[0,0,1],"speed":51}]}', "out_of_range",
                 field="fans[1].speed", value=51, limit=limits(0, 50))
    yield refuse('{"op":"set","fans":[{"position":[0,0,0],"direction":[0,0,0]}]}', "out_of_range",
                 field="fans[0].direction")
    yield refuse('{"op":"set","wind":[1,0,0],"gravity":[0,-1001,0]}', "out_of_range",
                 field="gravity[1]", limit=limits(-1000, 1000))
    yield refuse('{"op":"set","wind":[0,0,100.5]}', "out_of_range", field="wind[2]")
    yield refuse('{"op":"set","gust_length":0}', "out_of_range", field="gust_length")
    yield refuse('{"op":"set","still_air":1}', "wrong_type", field="still_air", value=1)
    yield refuse('{"op":"set","softness":0}', "out_of_range", field="softness",
                 limit=limits(0.01, 1))
    yield refuse('{"op":"set","budget_ms":-1}', "out_of_range", field="budget_ms",
                 limit=limits(0, 1000))
    yield refuse('{"op":"set","over_budget":"stop"}', "unknown_value", field="over_budget",
                 value="stop", limit={"allowed": ["slow", "soften"]})
    yield refuse('{"op":"set","drag":-1}', "out_of_range", field="drag", limit=limits(0, 1000))
    yield refuse('{"op":"advance"}', "missing_field", field="n")
    yield refuse('{"op":"advance","n":100001}', "out_of_range", field="n", limit=limits(1, 100000))
    yield refuse('{"op":"advance","n":1,"frames":"some"}', "unknown_value", field="frames", value="some",
                 limit={"allowed": ["none", "last", "all"]})
    yield refuse('{"op":"advance","n":1,"frames":1}', "wrong_type", field="frames", value=1)
    yield refuse('{"op":"query"}', "missing_field", field="what")
    yield refuse('{"op":"query","what":"secrets"}', "unknown_value", field="what", value="secrets")
    yield refuse('{"op":"query","what":"energies","format":"f32"}', "conflicting_fields",
                 field="format", value="f32")
    yield refuse('{"op":"query","what":"positions","format":"f16"}', "unknown_value",
                 field="format", limit={"allowed": ["json", "f32", "f64"]})
    yield refuse('{"op":"move","collider":"c","position":[0,0,0],"force":1}', "wrong_type",
                 field="force", value=1)
    yield refuse('{"op":"gripper","opening":0}', "missing_field", field="name")
    yield refuse('{"op":"gripper","name":"g"}', "missing_field")
    yield refuse('{"op":"gripper","name":"","opening":0}', "wrong_length", field="name")
    yield refuse('{"op":"gripper","name":"' + "g" * 57 + '","opening":0}', "wrong_length",
                 field="name", value="g" * 57)
    yield refuse('{"op":"gripper","name":"g","opening":-0.1}', "out_of_range", field="opening",
                 value=-0.1, limit=limits(0, 1))
    yield refuse('{"op":"gripper","name":"g","force":1001}', "out_of_range", field="force",
                 value=1001, limit=limits(0, 1000))
    yield refuse('{"op":"gripper","name":"g","rotation":[0,0,0,2]}', "out_of_range",
                 field="rotation[3]", value=2, limit=limits(-1, 1))
    yield refuse('{"op":"gripper","name":"g","rotation":[0,0,0.5,0.5]}', "out_of_range",
                 field="rotation")
    yield refuse('{"op":"gripper","name":"g","position":[0,"1",0]}', "wrong_type",
                 field="position[1]", value="1")
    yield refuse('{"op":"query","what":"contacts","format":"f64"}', "conflicting_fields",
                 field="format", value="f64")
    yield refuse('{"op":"query","what":"reactions","viewer":1}', "conflicting_fields",
                 field="viewer")
    yield refuse('{"op":"view","forces":1}', "wrong_type", field="forces", value=1)
    yield refuse('{"op":"query","what":"pins","viewer":1}', "conflicting_fields", field="viewer")
    yield refuse('{"op":"query","what":"pins","tree":"triangles"}', "conflicting_fields", field="tree")
    yield refuse('{"op":"query","what":"trees","level":1}', "conflicting_fields", field="level")
    yield refuse('{"op":"query","what":"boxes"}', "missing_field", field="tree")
    yield refuse('{"op":"query","what":"boxes","tree":7}', "wrong_type", field="tree", value=7)
    yield refuse('{"op":"query","what":"boxes","tree":"' + "t" * 81 + '"}', "wrong_length",
                 field="tree")
    yield refuse('{"op":"query","what":"boxes","tree":"triangles","level":256}', "out_of_range",
                 field="level", value=256, limit=limits(0, 255))
    yield refuse('{"op":"query","what":"boxes","tree":"triangles","level":0.5}', "wrong_type",
                 field="level", value=0.5)
    yield refuse('{"op":"ping"}', "missing_field", field="t")
    for scene in ("../secret", "/etc/passwd", ".hidden", "a b", "a/b", "c:d", "ä"):
        yield refuse(f'{{"op":"load","scene":"{scene}"}}', "unknown_value", field="scene", value=scene)
    yield refuse('{"op":"load","scene":""}', "wrong_length", field="scene")
    yield refuse('{"op":"load","scene":"' + "s" * 65 + '"}', "wrong_length", field="scene",
                 value="s" * 65)
    yield refuse('{"op":"load","scene":"' + "s" * 81 + '"}', "wrong_length", field="scene",
                 value="s" * 80 + "...")
    yield refuse('{"op":"create_room"}', "missing_field", field="name")
    yield refuse('{"op":"create_room","name":"a","scene":"../b"}', "unknown_value", field="scene", value="../b")
    yield refuse('{"op":"create_room","name":"a","paused":1}', "wrong_type", field="paused", value=1)
    for name in ("A", "-a", "a_b", "a.b", "a b", "ä"):
        yield refuse(f'{{"op":"create_room","name":"{name}"}}', "unknown_value", field="name", value=name)
    for name in ("", "a" * 33):
        yield refuse(f'{{"op":"close_room","name":"{name}"}}', "wrong_length", field="name", value=name)
    yield refuse('{"op":"save"}', "missing_field", field="name")
    yield refuse('{"op":"restore","name":"../a"}', "unknown_value", field="name", value="../a")
    yield refuse('{"op":"fork"}', "missing_field", field="name")
    yield refuse('{"op":"fork","name":"a","paused":"no"}', "wrong_type", field="paused", value="no")
    yield refuse('{"op":"close_room","name":7}', "wrong_type", field="name", value=7)
    yield refuse('{"op":"view"}', "missing_field", field="hz")
    yield refuse('{"op":"view","hz":241}', "out_of_range", field="hz", limit=limits(0, 240))
    yield refuse('{"op":"view","codec":"zip"}', "unknown_value", field="codec",
                 limit={"allowed": ["f32", "packed"]})
    yield refuse('{"op":"view","error":0}', "out_of_range", field="error", limit=limits(1e-5, 1))


def refused():
    return [*refused_texts(), *refused_bytes(), *refused_fields()]
