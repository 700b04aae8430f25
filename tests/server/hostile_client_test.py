"""What a client may send and must not achieve: each malformed command gets its typed error and the state
stays what it was. A foreign client on real sockets."""

import asyncio
import json
import re
import socket
import struct

import websockets

from foreign_client import PATIENCE, Server, SocketTest, Viewer, main

# (text message, code, field or None if it is left open)
MALFORMED = [
    # not JSON, or not one object
    ("", "bad_json", None),
    ("{", "bad_json", None),
    ("nonsense", "bad_json", None),
    ('{"op":"hash"} {"op":"hash"}', "bad_json", None),
    ('{"op":"hash",}', "bad_json", None),
    ("{'op':'hash'}", "bad_json", None),
    ('{"op":"speed","speed":NaN}', "bad_json", None),
    ('{"op":"speed","speed":Infinity}', "bad_json", None),
    ('{"op":"speed","speed":-Infinity}', "bad_json", None),
    ('{"op":"speed","speed":01}', "bad_json", None),
    ('{"op":"speed","speed":.5}', "bad_json", None),
    ('{"op":"speed","speed":0x10}', "bad_json", None),
    ('{"op":"hash"}\x00', "bad_json", None),
    ('{"op":"hash","x":' + "[" * 9 + "]" * 9 + "}", "bad_json", None),
    ("[" * 30000, "bad_json", None),
    ('{"a":' * 10000, "bad_json", None),
    ("[]", "not_an_object", None),
    ("3", "not_an_object", None),
    ("null", "not_an_object", None),
    ('"hash"', "not_an_object", None),
    ('{"op":"hash","op":"reset"}', "duplicate_key", None),
    ('{"op":"reset","id":1,"id":2}', "duplicate_key", None),
    ('{"op":"hash","x":{"a":1,"a":2}}', "duplicate_key", None),
    ('{"op":"hash","x":"' + "y" * 66000 + '"}', "too_large", None),
    # the envelope
    ("{}", "missing_field", "op"),
    ('{"op":1}', "wrong_type", "op"),
    ('{"op":null}', "missing_field", "op"),
    ('{"op":["hash"]}', "wrong_type", "op"),
    ('{"op":"explode"}', "unknown_op", None),
    ('{"op":"HASH"}', "unknown_op", None),
    ('{"op":""}', "unknown_op", None),
    ('{"op":"hash","id":true}', "wrong_type", "id"),
    ('{"op":"hash","id":[1]}', "wrong_type", "id"),
    ('{"op":"hash","id":1.5}', None, "id"),
    ('{"op":"hash","id":-1}', "out_of_range", "id"),
    ('{"op":"hash","id":9007199254740994}', "out_of_range", "id"),
    ('{"op":"hash","id":""}', "wrong_length", "id"),
    ('{"op":"hash","id":"' + "i" * 65 + '"}', "wrong_length", "id"),
    # numbers
    ('{"op":"speed","speed":1e999}', "not_finite", None),
    ('{"op":"speed","speed":-1e999}', "not_finite", None),
    ('{"op":"speed"}', "missing_field", "speed"),
    ('{"op":"speed","speed":"1"}', "wrong_type", "speed"),
    ('{"op":"speed","speed":true}', "wrong_type", "speed"),
    ('{"op":"speed","speed":null}', "missing_field", "speed"),
    ('{"op":"speed","speed":0}', "out_of_range", "speed"),
    ('{"op":"speed","speed":10.001}', "out_of_range", "speed"),
    ('{"op":"step","n":0}', "out_of_range", "n"),
    ('{"op":"step","n":601}', "out_of_range", "n"),
    ('{"op":"step","n":1.5}', None, "n"),
    ('{"op":"advance","n":0}', "out_of_range", "n"),
    ('{"op":"advance","n":100001}', "out_of_range", "n"),
    ('{"op":"advance","n":-5}', "out_of_range", "n"),
    ('{"op":"advance","n":1e300}', None, "n"),
    ('{"op":"advance"}', "missing_field", "n"),
    # rays
    ('{"op":"pick","origin":[0,0,0]}', "missing_field", "direction"),
    ('{"op":"pick","origin":[0,0],"direction":[0,0,1]}', "wrong_length", "origin"),
    ('{"op":"pick","origin":[0,0,0,0],"direction":[0,0,1]}', "wrong_length", "origin"),
    ('{"op":"pick","origin":{"x":0},"direction":[0,0,1]}', "wrong_type", "origin"),
    ('{"op":"pick","origin":[0,"0",0],"direction":[0,0,1]}', "wrong_type", "origin[1]"),
    ('{"op":"pick","origin":[0,0,20000],"direction":[0,0,1]}', "out_of_range", "origin[2]"),
    ('{"op":"pick","origin":[0,0,1e999],"direction":[0,0,1]}', "not_finite", None),
    ('{"op":"pick","origin":[0,0,0],"direction":[0,0,0]}', "out_of_range", "direction"),
    ('{"op":"pick","origin":[' + ",".join(["0"] * 20000) + '],"direction":[0,0,1]}', "wrong_length",
     "origin"),
    # drags
    ('{"op":"drag"}', "missing_field", "phase"),
    ('{"op":"drag","phase":"hold"}', "unknown_value", "phase"),
    ('{"op":"drag","phase":7}', "wrong_type", "phase"),
    ('{"op":"drag","phase":"start"}', "missing_field", None),
    ('{"op":"drag","phase":"start","particle":1,"triangle":1,"barycentric":[1,0,0]}',
     "conflicting_fields", None),
    ('{"op":"drag","phase":"start","triangle":1}', "missing_field", "barycentric"),
    ('{"op":"drag","phase":"start","triangle":1,"barycentric":[0.5,0.5,0.5]}', "out_of_range", None),
    ('{"op":"drag","phase":"start","triangle":1,"barycentric":[2,-1,0]}', "out_of_range",
     "barycentric[0]"),
    ('{"op":"drag","phase":"start","triangle":1,"barycentric":[0,0,0]}', "out_of_range", None),
    ('{"op":"drag","phase":"start","triangle":99999,"barycentric":[1,0,0]}', "out_of_range", "triangle"),
    ('{"op":"drag","phase":"start","triangle":-1,"barycentric":[1,0,0]}', "out_of_range", "triangle"),
    ('{"op":"drag","phase":"start","particle":600}', "out_of_range", "particle"),
    ('{"op":"drag","phase":"start","particle":-1}', "out_of_range", "particle"),
    ('{"op":"drag","phase":"start","particle":1e18}', "out_of_range", "particle"),
    ('{"op":"drag","phase":"start","particle":"3"}', "wrong_type", "particle"),
    ('{"op":"drag","phase":"start","particle":3,"target":[0,1e5,0]}', "out_of_range", "target[1]"),
    ('{"op":"drag","phase":"start","particle":3,"radius":-0.1}', "out_of_range", "radius"),
    ('{"op":"drag","phase":"start","particle":3,"radius":101}', "out_of_range", "radius"),
    ('{"op":"drag","phase":"start","particle":3,"stiffness":100001}', "out_of_range", "stiffness"),
    ('{"op":"drag","phase":"start","particle":3,"max_force":-1}', "out_of_range", "max_force"),
    ('{"op":"drag","phase":"start","particle":3,"drag":-1}', "out_of_range", "drag"),
    ('{"op":"drag","phase":"start","particle":3,"drag":4294967296}', "out_of_range", "drag"),
    ('{"op":"drag","phase":"move","target":[0,0,0]}', "unknown_drag", "drag"),
    ('{"op":"drag","phase":"move"}', "missing_field", "target"),
    ('{"op":"drag","phase":"end","drag":5}', "unknown_drag", "drag"),
    # pins
    ('{"op":"pin"}', "missing_field", None),
    ('{"op":"pin","particle":600}', "out_of_range", "particle"),
    ('{"op":"pin","particle":0.5}', None, "particle"),
    ('{"op":"pin","particle":3,"radius":1e9}', "out_of_range", "radius"),
    ('{"op":"release"}', "missing_field", None),
    ('{"op":"release","pin":999999}', "unknown_pin", "pin"),
    ('{"op":"release","pin":1,"all":true}', "conflicting_fields", None),
    ('{"op":"release","all":1}', "wrong_type", "all"),
    ('{"op":"release","particle":600}', "out_of_range", "particle"),
    # the rest
    ('{"op":"camera","position":[0,0,0]}', "missing_field", "target"),
    ('{"op":"camera","position":[0,0,0],"target":[0,0,0]}', "out_of_range", None),
    ('{"op":"camera","position":[0,0,1],"target":[0,0,0],"fov":180}', "out_of_range", "fov"),
    ('{"op":"set"}', "missing_field", None),
    ('{"op":"set","gravity":[0,0,-1001]}', "out_of_range", "gravity[2]"),
    ('{"op":"set","gravity":[0,-1,0],"wind":[0,0,101]}', "out_of_range", "wind[2]"),
    ('{"op":"set","gravity":[0,-1,0],"drag":"much"}', "wrong_type", "drag"),
    ('{"op":"set","gust_length":0}', "out_of_range", "gust_length"),
    ('{"op":"set","still_air":1}', "wrong_type", "still_air"),
    ('{"op":"query"}', "missing_field", "what"),
    ('{"op":"query","what":"secrets"}', "unknown_value", "what"),
    ('{"op":"query","what":"positions","format":"f16"}', "unknown_value", "format"),
    ('{"op":"query","what":"energies","format":"f32"}', None, None),
    ('{"op":"query","what":"camera","viewer":77}', "unknown_viewer", "viewer"),
    ('{"op":"load"}', "missing_field", "scene"),
    ('{"op":"load","scene":"../../etc/passwd"}', None, "scene"),
    ('{"op":"load","scene":"/etc/passwd"}', None, "scene"),
    ('{"op":"load","scene":".hidden"}', None, "scene"),
    ('{"op":"load","scene":"' + "s" * 65 + '"}', "wrong_length", "scene"),
    ('{"op":"load","scene":"nowhere"}', "unknown_scene", "scene"),
    ('{"op":"hello","name":""}', "wrong_length", "name"),
    ('{"op":"hello","name":"' + "n" * 33 + '"}', "wrong_length", "name"),
    ('{"op":"hello","name":"a\\u0007b"}', None, "name"),
    ('{"op":"hello","color":"red"}', None, "color"),
    ('{"op":"hello","token":"' + "t" * 257 + '"}', "wrong_length", "token"),
    ('{"op":"view","hz":-1}', "out_of_range", "hz"),
    ('{"op":"view","hz":241}', "out_of_range", "hz"),
    ('{"op":"view","codec":"h264"}', "unknown_value", "codec"),
    ('{"op":"ping"}', "missing_field", "t"),
    ('{"op":"ping","t":"now"}', "wrong_type", "t"),
    ('{"op":"hello","name":"\\ud800"}', None, None),
]


class Malformed(SocketTest):
    options = ("--paused",)

    async def test_each_malformed_command_gets_its_error_and_the_hash_is_unchanged(self):
        viewer, other = await self.viewer(), await self.viewer()
        await viewer.ask("advance", n=20)
        before = await other.ask("hash")
        await other.ask("query", what="crossings")  # which a cloth that stands counts once, sooner or later
        state = (await other.ask("query", what="state"))["data"]
        for text, code, field in MALFORMED:
            with self.subTest(text=text[:100]):
                seen = len(viewer.texts)
                await viewer.socket.send(text)
                error = await viewer.wait_text(lambda m: m["op"] in ("error", "result"), seen)
                self.assertEqual(error["op"], "error")
                self.assertTrue(error["message"])
                self.assertNotEqual(error["code"], "internal")
                if code:
                    self.assertEqual(error["code"], code, error)
                if field:
                    self.assertEqual(error["field"], field, error)
        after = await other.ask("hash")
        self.assertEqual((after["hash"], after["tick"]), (before["hash"], before["tick"]))
        now = (await other.ask("query", what="state"))["data"]
        self.assertEqual(now, state)
        self.assertEqual(len((await other.ask("query", what="roster"))["data"]), 2)

    async def test_an_error_carries_the_id_and_the_name_of_its_command(self):
        viewer = await self.viewer()
        error = await viewer.ask("speed", speed=1e99)
        self.assertEqual(error["command"], "speed")
        self.assertEqual(error["limit"], {"minimum": 0.01, "maximum": 10})
        self.assertEqual(error["value"], 1e99)

    async def test_text_that_is_not_utf8_closes_with_1007(self):
        for payload in (b'{"op":"hello","name":"\xff"}', b"\xc0\x80", b"\xed\xa0\x80"):
            viewer = await self.viewer()
            await viewer.socket.ensure_open()
            await viewer.socket.write_frame(True, 1, payload)
            self.assertEqual(await viewer.wait_closed(), 1007)

    async def test_a_binary_message_that_is_no_ack_closes_with_1003(self):
        for payload in (b"", b"hello", b"\x04\x01\x00\x00", b"\x04\x02\x00\x00\x01\x00\x00\x00",
                        b"\x04\x01\x00\x00\x01\x00\x00\x00\x00", b"\x01" * 8):
            viewer = await self.viewer()
            await viewer.socket.send(payload)
            self.assertEqual(await viewer.wait_closed(), 1003)

    async def test_a_message_far_too_large_closes_with_1009_and_others_go_on(self):
        other = await self.viewer()
        for payload in ("x" * 2_000_000, b"x" * 2_000_000):
            viewer = await self.viewer()
            try:
                await viewer.socket.send(payload)
            except websockets.ConnectionClosed:
                pass
            self.assertEqual(await viewer.wait_closed(), 1009)
        self.assertEqual((await other.ask("hash"))["op"], "result")

    async def test_broken_frames_of_the_protocol_end_their_viewer_alone(self):
        other = await self.viewer()
        # Reserved bits, no mask, a fragmented close, a fragmented and too long ping; each with bytes enough
        # for the longest header, because the server rightly waits for the rest of one.
        for begin in (b"\xff\xff", b"\x81\x05hello", b"\x08\x80", b"\x09\xfe"):
            with self.subTest(begin=begin):
                viewer = await self.viewer()
                viewer.socket.transport.write(begin + bytes(14))
                self.assertEqual(await viewer.wait_closed(), 1002)
        self.assertEqual((await other.ask("hash"))["op"], "result")


class Connecting(SocketTest):
    options = ("--paused",)

    async def refused(self, **fields):
        with self.assertRaises(websockets.InvalidStatusCode) as caught:
            await websockets.connect(fields.pop("url", self.server.websocket), **fields)
        return caught.exception.status_code

    async def test_an_unknown_subprotocol_is_refused_with_400(self):
        for offered in (None, ["weft.v7"], ["chat", "weft.v2"]):
            self.assertEqual(await self.refused(subprotocols=offered), 400)
        socket_ = await websockets.connect(self.server.websocket, subprotocols=["weft.v9", "weft.v1"])
        self.assertEqual(socket_.subprotocol, "weft.v1")
        await socket_.close()

    def test_a_foreign_name_that_points_here_is_not_an_origin_of_our_own(self):
        port = self.server.addresses["port"]
        answer = self.raw(f"GET /ws HTTP/1.1\r\nHost: evil.example:{port}\r\nUpgrade: websocket\r\n"
                          f"Origin: http://evil.example:{port}\r\nConnection: Upgrade\r\n"
                          "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
                          "Sec-WebSocket-Protocol: weft.v1\r\n\r\n".encode())
        self.assertTrue(answer.startswith(b"HTTP/1.1 403"), answer)

    def test_the_refusal_says_what_is_offered(self):
        answer = self.raw(b"GET /ws HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                          b"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
                          b"Sec-WebSocket-Protocol: weft.v7\r\n\r\n")
        body = json.loads(answer.split(b"\r\n\r\n", 1)[1])["error"]
        self.assertEqual((body["code"], body["value"], body["offered"]),
                         ("unknown_protocol", "weft.v7", ["weft.v1"]))

    async def test_extensions_are_not_accepted(self):
        socket_ = await websockets.connect(self.server.websocket, subprotocols=["weft.v1"],
                                           compression="deflate")
        self.assertEqual(socket_.extensions, [])
        await socket_.close()

    async def test_pages_of_other_origins_are_refused(self):
        port = self.server.addresses["port"]
        for origin in ("http://evil.example", f"http://evil.example:{port}", "null",
                       f"http://127.0.0.1.evil.example:{port}", f"http://localhost:{port + 1}"):
            self.assertEqual(await self.refused(origin=origin, subprotocols=["weft.v1"]), 403)
        for origin in (f"http://127.0.0.1:{port}", f"http://localhost:{port}"):
            socket_ = await websockets.connect(self.server.websocket, subprotocols=["weft.v1"], origin=origin)
            await socket_.close()

    async def test_other_rooms_are_404(self):
        self.assertEqual(await self.refused(url=self.server.websocket + "/other",
                                            subprotocols=["weft.v1"]), 404)

    async def test_messages_sent_along_with_the_upgrade_request_are_not_lost(self):
        host, port = self.server.addresses["host"], self.server.addresses["port"]
        reader, writer = await asyncio.open_connection(host, port)
        text = json.dumps({"op": "ping", "id": 7, "t": 1, "padding": "p" * 3000}).encode()
        mask = b"\x01\x02\x03\x04"
        frame = (b"\x81\xfe" + struct.pack(">H", len(text)) + mask
                 + bytes(c ^ mask[i % 4] for i, c in enumerate(text)))
        writer.write(b"GET /ws HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                     b"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
                     b"Cookie: " + b"c" * 4000 + b"\r\n"
                     b"Sec-WebSocket-Protocol: weft.v1\r\n\r\n" + frame)
        await asyncio.wait_for(reader.readuntil(b'"id":7,"command":"ping"'), PATIENCE)
        writer.close()

    def raw(self, request):
        address = (self.server.addresses["host"], self.server.addresses["port"])
        with socket.create_connection(address, timeout=PATIENCE) as connection:
            connection.sendall(request)
            answer = b""
            while b"\r\n\r\n" not in answer or b"Content-Length: 0" in answer:
                part = connection.recv(65536)
                if not part:
                    break
                answer += part
            while part := connection.recv(65536) if b"Connection: close" in answer else b"":
                answer += part
            return answer

    def test_http_that_is_none_is_answered_with_400(self):
        self.assertTrue(self.raw(b"nonsense\r\n\r\n").startswith(b"HTTP/1.1 400"))
        self.assertTrue(self.raw(b"GET /" + b"a" * 20000).startswith(b"HTTP/1.1 431"))
        self.assertTrue(self.raw(b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n\r\n")
                        .startswith(b"HTTP/1.1 405"))
        self.assertTrue(self.raw(b"GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n\r\nhello")
                        .startswith(b"HTTP/1.1 413"))

    def test_paths_never_leave_the_page(self):
        for path in ("/../weft", "/..%2f..%2fetc/passwd", "//etc/passwd", "/./healthz", "/%00"):
            answer = self.raw(f"GET {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n".encode())
            self.assertTrue(answer.startswith(b"HTTP/1.1 404"), answer[:100])

    def test_the_plain_paths_answer_as_specified(self):
        self.assertEqual(self.server.get("/healthz")[::2], (200, b"ok"))
        self.assertEqual(json.loads(self.server.get("/readyz")[2])["scene"], "default")
        self.assertEqual(json.loads(self.server.get("/version")[2])["protocols"], ["weft.v1"])
        names = [s["name"] for s in json.loads(self.server.get("/api/v1/scenes")[2])["scenes"]]
        self.assertEqual(names[0], "default")
        self.assertIn(b"weft_tick_seconds_bucket", self.server.get("/metrics")[2])
        self.assertEqual(self.server.get("/ws")[0], 426)
        self.assertEqual(self.server.get("/nothing")[0], 404)
        self.assertEqual(self.server.get("/api/v1/mesh/0000000000000000")[0], 404)

    async def test_the_mesh_comes_over_http_too_and_is_then_not_sent(self):
        both = await Viewer.open(self.server)
        sent = await both.wait_binary(1)
        announced = await both.wait_text(lambda m: m["op"] == "mesh")
        status, headers, body = await asyncio.get_running_loop().run_in_executor(
            None, self.server.get, announced["url"])
        self.assertEqual((status, body), (200, sent))
        self.assertIn("immutable", headers["Cache-Control"])
        self.assertEqual(len(body), announced["bytes"])
        without = await Viewer.open(self.server, query="?mesh=http")
        await without.wait_frame(lambda f: True)
        self.assertEqual(without.binaries, [])
        await both.close()
        await without.close()


class Limits(SocketTest):
    options = ("--max-viewers", "3", "--max-connections", "8", "--max-messages-per-second", "50", "--paused")

    async def test_a_full_server_answers_503_and_has_room_again_when_one_leaves(self):
        viewers = [await Viewer.open(self.server) for _ in range(3)]
        with self.assertRaises(websockets.InvalidStatusCode) as caught:
            await Viewer.open(self.server)
        self.assertEqual(caught.exception.status_code, 503)
        await viewers[0].close()
        await viewers[1].wait_text(lambda m: m["op"] == "roster" and len(m["viewers"]) == 2
                                   and all(v["id"] != viewers[0].id for v in m["viewers"]))
        viewers[0] = await Viewer.open(self.server)
        for viewer in viewers:
            await viewer.close()

    async def test_too_many_sockets_are_answered_with_503(self):
        address = (self.server.addresses["host"], self.server.addresses["port"])
        # Connections are taken in the order in which they came.
        idle = [socket.create_connection(address) for _ in range(8)]
        status = await asyncio.get_running_loop().run_in_executor(None, self.server.get, "/healthz")
        self.assertEqual(status[0], 503)
        for connection in idle:
            connection.close()

    async def test_too_many_messages_get_rate_limited_and_going_on_closes_with_1008(self):
        viewer = await self.viewer()
        try:
            for _ in range(2000):
                await viewer.tell("ping", t=0)
        except websockets.ConnectionClosed:
            pass
        self.assertEqual(await viewer.wait_closed(), 1008)
        self.assertTrue(any(m["op"] == "error" and m["code"] == "rate_limited" for m in viewer.texts))

    async def test_each_refused_message_is_answered_with_its_id_and_only_a_flood_closes_its_viewer(self):
        viewer, other = await self.viewer(), await self.viewer()
        ids = [f"call {k}" if k % 2 else k for k in range(90)]  # below twice the limit of 50
        for id_ in ids:
            await viewer.socket.send(json.dumps({"op": "hash", "id": id_, "x": [{"id": 5}, "]}"]}))
        answers = [await viewer.wait_text(lambda m, id_=id_: m.get("id") == id_) for id_ in ids]
        refused = [m for m in answers if m["op"] == "error"]
        self.assertGreater(len(refused), 0)
        for error in refused:
            self.assertEqual((error["code"], error["limit"]), ("rate_limited", {"maximum": 50}))
        self.assertEqual(sum(m["op"] == "result" for m in answers), 90 - len(refused))
        seen = len(viewer.texts)
        await viewer.socket.send("nonsense")
        self.assertNotIn("id", await viewer.wait_text(lambda m: m["op"] == "error", seen))
        self.assertEqual((await other.ask("hash"))["op"], "result")

    async def test_messages_that_are_not_read_are_answered_with_their_id_too(self):
        viewer = await self.viewer()
        for text, code in (('{"op":"load","id":"large","scene":"' + "s" * 70000 + '"}', "too_large"),
                           ('{"op":"hash","op":"hash","id":"large"}', "duplicate_key"),
                           ('{"op":"ping","t":1e999,"id":"large"}', "not_finite")):
            seen = len(viewer.texts)
            await viewer.socket.send(text)
            error = await viewer.wait_text(lambda m: m["op"] == "error", seen)
            self.assertEqual((error["code"], error.get("id")), (code, "large"))


class SlowReaders(SocketTest):
    options = ("--scene", "drape-sphere")

    async def test_a_viewer_that_does_not_read_or_ack_holds_up_nobody(self):
        silent = await self.viewer(acknowledge=False)
        deaf = await Viewer.open(self.server, max_queue=1)
        deaf.reader.cancel()
        deaf.socket.transport.pause_reading()
        await silent.wait_frame(lambda f: True, 1)
        fast = await self.viewer()
        await fast.wait_frame(lambda f: len(fast.frames) >= 60)
        # Two frames without an ack, then none.
        self.assertEqual(len(silent.frames), 2)
        last = silent.frames[-1]
        await silent.ack(last.sequence)
        newest = await silent.wait_frame(lambda f: f.sequence > last.sequence)
        self.assertGreater(newest.tick, last.tick + 50)
        deaf.socket.transport.abort()

    async def test_hz_0_stops_the_frames_and_hz_240_brings_them_back(self):
        viewer = await self.viewer()
        await viewer.wait_frame(lambda f: True)
        await viewer.ask("view", hz=0)
        await viewer.ask("hash")
        count = len(viewer.frames)
        await asyncio.sleep(0.3)
        self.assertEqual(len(viewer.frames), count)
        await viewer.ask("view", hz=240)
        await viewer.wait_frame(lambda f: True, count)


class Overflow(SocketTest):
    options = ("--paused",)

    async def queries_taken(self):
        """How many queries the server has taken, once it takes no more."""
        counts = [-1]
        while len(counts) < 4 or len(set(counts[-3:])) > 1:
            await asyncio.sleep(0.05)
            metrics = (await asyncio.get_running_loop().run_in_executor(None, self.server.get, "/metrics"))[2]
            found = re.search(rb'weft_commands_total{op="query"} (\d+)', metrics)
            counts.append(int(found[1]) if found else 0)
        return counts[-1]

    async def test_a_viewer_that_does_not_read_its_answers_is_closed_with_4000(self):
        other, deaf = await self.viewer(), await self.viewer()
        with self.assertRaises((ConnectionError, websockets.ConnectionClosed)):
            # One round overflows the queue of 512 messages; more if the machine is too slow to settle.
            for _ in range(10):
                deaf.socket.transport.pause_reading()
                for _ in range(900):
                    await deaf.tell("query", id="deaf", what="positions")
                self.assertGreater(await self.queries_taken(), 0)
                deaf.socket.transport.resume_reading()
                await deaf.ask("hash")
        self.assertEqual(await deaf.wait_closed(), 4000)
        await other.wait_text(lambda m: m["op"] == "roster" and len(m["viewers"]) == 1,
                              max(i for i, m in enumerate(other.texts) if m["op"] == "roster"))
        self.assertEqual((await other.ask("hash"))["op"], "result")


class Silence(SocketTest):
    options = ("--pong-seconds", "3", "--paused")

    async def test_no_answer_to_pings_closes_with_4001_and_lets_go(self):
        other, mute = await self.viewer(), await self.viewer(acknowledge=False)
        quiet = await self.viewer(acknowledge=False)  # says nothing either, but its library answers pings
        await mute.ask("drag", phase="start", particle=300)
        await other.wait_text(lambda m: m["op"] == "grabs" and m["grabs"])

        async def no_pong(data=b""):
            pass
        mute.socket.pong = no_pong
        seen = len(other.texts)
        self.assertEqual(await mute.wait_closed(), 4001)
        await other.wait_text(lambda m: m["op"] == "grabs" and not m["grabs"], seen)
        self.assertEqual((await quiet.ask("hash"))["op"], "result")


class Ending(SocketTest):
    async def test_a_stop_says_bye_and_closes_with_1001(self):
        viewer = await self.viewer()
        code = await asyncio.get_running_loop().run_in_executor(None, self.server.stop)
        self.assertEqual(code, 0)
        self.assertEqual(await viewer.wait_closed(), 1001)
        self.assertEqual(viewer.texts[-1], {"op": "bye", "code": 1001, "reason": "the server stops"})

    def test_the_session_is_new_for_each_process(self):
        async def session(server):
            viewer = await Viewer.open(server)
            await viewer.close()
            return viewer.welcome["session"]
        other = Server("--paused")
        self.assertNotEqual(asyncio.run(session(self.server)), asyncio.run(session(other)))
        self.assertEqual(other.stop(), 0)


if __name__ == "__main__":
    main()
