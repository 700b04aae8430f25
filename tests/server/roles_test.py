"""Who may do what, over sockets: tokens, roles, the policy and the addresses that proxies tell. A client that
is not ours, written from proto/README.md, whose table of rights is what is tested."""

import asyncio
import contextlib
import json
import os
import re
import socket
import subprocess
import tempfile
import unittest
from pathlib import Path

import websockets
from connecting_test import UPGRADE, Answer
from foreign_client import PATIENCE, PROGRAM, Server, SocketTest, Viewer, main

ROOT = Path(__file__).resolve().parents[2]
LOOKER, OPERATOR, ADMIN = "look-0123456789abcdef", "operate-0123456789abcdef", "admin-0123456789abcdef"
TOKENS = f"# a class\nviewer {LOOKER} Class 7b\noperator {OPERATOR}\n\nadmin {ADMIN} Ada\n"


def rights():
    """Rows of the specification's table: right, command, and the words that a form of it has, if not every form."""
    page = (ROOT / "proto/README.md").read_text(encoding="utf-8")
    table = page.split("<!-- rights: written by generate.py -->")[1].split("<!-- end -->")[0]
    rows = re.findall(r"\| `(\w+)` \| (.*) \|", table)
    items = [(right, re.findall(r"`([^`]+)`", item)) for right, row in rows for item in row.split("; ")]
    return [(right, command, words) for right, (command, *words) in items]


def has_word(command, word):
    field, _, value = word.partition(": ")
    if value:
        return command.get(field) is json.loads(value)
    return command.get(field) not in (None, False) or word in (command.get("what"), command.get("phase"))


def right_to(command, table):
    """The right that a command needs: that of its form, or that of all other forms."""
    own = [(right, words) for right, op, words in table if op == command["op"]]
    of_form = [right for right, words in own if any(has_word(command, word) for word in words)]
    return (of_form or [right for right, words in own if not words])[0]


def goldens():
    """Commands that can be read, of each `op` and form."""
    texts = json.loads((ROOT / "tests/proto/golden/accepted_commands.json").read_text(encoding="utf-8"))
    return [entry["text"] for entry in texts]


async def enter(server, token=None, room="default", **hello):
    """A viewer that tells its token first; None without an answer to wait for."""
    connection = await websockets.connect(f"{server.websocket}/{room}", subprotocols=["weft.v1"], compression=None,
                                          max_size=None, ping_interval=None)
    viewer = Viewer(connection, True)
    if token is not None:
        await viewer.tell("hello", id="hello", token=token, **hello)
        viewer.welcome = await viewer.wait_text(lambda m: m["op"] == "welcome")
        viewer.id = viewer.welcome["viewer"]
    return viewer


class WithTokens(SocketTest):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name, "tokens")
        self.path.write_text(TOKENS)
        self.path.chmod(0o600)
        self.server = Server("--paused", "--tokens", str(self.path))

    async def enter(self, token, **hello):
        viewer = await enter(self.server, token, **hello)

        async def end():
            await viewer.socket.close()
            await asyncio.wait({viewer.reader}, timeout=PATIENCE)
        self.addAsyncCleanup(end)
        return viewer

    async def test_a_token_tells_role_and_name_and_the_first_message_is_answered(self):
        for token, role, name in ((LOOKER, "viewer", "Class 7b"), (OPERATOR, "operator", None),
                                  (ADMIN, "admin", "Ada")):
            viewer = await self.enter(token)
            self.assertEqual(viewer.welcome["role"], role)
            self.assertEqual(viewer.welcome["name"], name or f"viewer {viewer.id}")
            answer = await viewer.wait_text(lambda m: m.get("id") == "hello")
            self.assertEqual((answer["op"], answer["role"]), ("result", role))
        named = await self.enter(LOOKER, name="Bea")
        roster = await named.wait_text(lambda m: m["op"] == "roster" and m["viewers"][-1]["name"] == "Bea")
        self.assertEqual([v["role"] for v in roster["viewers"]], ["viewer", "operator", "admin", "viewer"])
        frame = await named.wait_frame(lambda f: True)
        self.assertGreater(frame.vertices, 0)

    async def test_what_else_is_wrong_beside_a_known_token_is_refused_by_its_name_and_the_viewer_is_in(self):
        wrong = {"name": ["x" * 40, "", 5, "a\u0007"], "color": ["red", 7]}
        for field, values in wrong.items():
            for value in values:
                viewer = await self.enter(OPERATOR, **{field: value})
                error = await viewer.wait_text(lambda m: m["op"] != "welcome" and m.get("id") == "hello")
                self.assertEqual((error["op"], error["command"], error["field"]), ("error", "hello", field))
                self.assertNotEqual(error["code"], "not_allowed")
                ops = [m["op"] for m in viewer.texts if m["op"] in ("welcome", "error")]
                self.assertEqual(ops, ["welcome", "error"])
                self.assertEqual((await viewer.ask("hash"))["op"], "result")
        stranger = await enter(self.server)
        self.addAsyncCleanup(stranger.socket.close)
        await stranger.tell("hello", id=1, token="guessed-0123456789", name="x" * 40)
        self.assertEqual((await stranger.wait_text(lambda m: m.get("id") == 1))["field"], "token")
        self.assertEqual(await stranger.wait_closed(), 4003)

    async def test_a_link_counts_in_its_room_and_who_makes_a_copy_operates_that_alone(self):
        teacher = await self.enter(OPERATOR)
        link = (await teacher.ask("invite", right="hold"))["token"]
        pupil = await self.enter(link)
        self.assertEqual((await pupil.ask("reset"))["code"], "not_allowed")
        token = (await pupil.ask("fork", name="mine"))["token"]
        own = await self.enter(token, room="mine")
        self.assertEqual(own.welcome["role"], "operator")
        self.assertEqual((await own.ask("reset"))["op"], "result")
        for op, name in (("create_room", "more"), ("close_room", "other")):
            error = await own.ask(op, name=name)
            self.assertEqual((error["code"], error["field"], error["value"]), ("not_allowed", "name", name))
        self.assertEqual((await own.ask("fork", name="again"))["op"], "result")
        for elsewhere, room in ((link, "mine"), (token, "default")):
            guest = await self.enter(elsewhere, room=room)
            self.assertEqual(guest.welcome["role"], "viewer")
            self.assertEqual((await guest.ask("reset"))["code"], "not_allowed")
            self.assertEqual((await guest.ask("pin", particle=0))["op"], "result", "everybody may hold there")
        watcher = await self.enter((await teacher.ask("invite", right="look"))["token"], room="mine")
        self.assertEqual((await watcher.ask("pin", particle=0))["code"], "not_allowed")
        self.assertNotIn("token", await teacher.ask("fork", name="theirs"), "it operates all rooms already")
        # A room that takes the name of another has other links.
        await own.tell("close_room", name="mine")
        self.assertEqual(await own.wait_closed(), 4004)
        self.assertEqual((await teacher.ask("create_room", name="mine"))["op"], "result")
        late = await enter(self.server, room="mine")
        await late.tell("hello", token=token)
        self.assertEqual(await late.wait_closed(), 4003)

    async def test_whoever_has_no_token_is_let_in_to_nothing(self):
        loop = asyncio.get_running_loop()
        firsts = [json.dumps({"op": "hello", "id": 1, "token": LOOKER + "x"}),
                  json.dumps({"op": "hello", "id": 1, "token": LOOKER[:-1]}),
                  json.dumps({"op": "hello", "id": 1, "name": "Eve"}),
                  json.dumps({"op": "query", "id": 1, "what": "positions"}), "nonsense"]
        began = loop.time()
        refused = []
        for first in firsts:
            viewer = await enter(self.server)
            await viewer.socket.send(first)
            # What comes behind it is not read.
            await viewer.tell("hello", token=OPERATOR)
            refused.append((first, viewer))
        for first, viewer in refused:
            with self.subTest(first=first):
                self.assertEqual(await viewer.wait_closed(), 4003)
                self.assertEqual([m["op"] for m in viewer.texts], ["error"])
                error = viewer.texts[0]
                self.assertEqual((error["code"], error["field"]), ("not_allowed", "token"))
                said = {} if first == "nonsense" else json.loads(first)
                self.assertEqual((error.get("id"), error.get("command")), (said.get("id"), said.get("op")))
                self.assertNotIn(LOOKER, json.dumps(error))
                self.assertEqual((viewer.frames, viewer.binaries), ([], []))
        self.assertGreaterEqual(loop.time() - began, 0.5, "guessing costs time")

    async def test_a_connection_that_says_nothing_is_closed_after_5_s_and_blocks_nobody(self):
        loop = asyncio.get_running_loop()
        silent, began = await enter(self.server), loop.time()
        operator = await self.enter(OPERATOR)
        self.assertEqual((await operator.ask("hash"))["op"], "result")
        self.assertEqual(await silent.wait_closed(), 4001, "after which a client comes again")
        self.assertGreater(loop.time() - began, 4.5)
        roster = (await operator.ask("query", what="roster"))["data"]
        self.assertEqual(len(roster), 1, "it was never a viewer")

    async def all_refused(self, viewer):
        """Sends one of each form of each command; returns the right that each needs, and whether its role lacks it."""
        table, seen = rights(), {}
        for number, text in enumerate(goldens()):
            command = json.loads(text)
            command["id"] = number
            command.pop("token", None)  # is tested by itself
            await viewer.socket.send(json.dumps(command))
            answer = await viewer.wait_text(lambda m, n=number: m.get("id") == n)
            # A pin of another's is refused too, but for its owner's sake.
            lacks = answer.get("code") == "not_allowed" and answer.get("field") == "op"
            if lacks:
                self.assertEqual(answer["value"], command["op"])
                self.assertIn(answer["limit"]["allowed"], (["hand"], ["operator", "admin"]))
            seen[text] = (right_to(command, table), lacks)
        ops = {json.loads(text)["op"] for text in seen}
        self.assertEqual(ops, {op for _, op, _ in table}, "the table has every command, and every one was sent")
        return seen

    async def test_for_every_command_the_wire_refuses_what_the_table_of_rights_says(self):
        operator = await self.enter(OPERATOR)
        looker = await self.enter(LOOKER)
        await operator.ask("pin", particle=3)
        await operator.ask("policy", policy="watch")
        before = [(await operator.ask("query", what=what))["data"] for what in ("state", "pins", "grabs")]
        hash_before = (await operator.ask("hash"))["hash"]
        for text, (right, lacks) in (await self.all_refused(looker)).items():
            with self.subTest(text=text):
                self.assertEqual(lacks, right != "look")
        after = [(await operator.ask("query", what=what))["data"] for what in ("state", "pins", "grabs")]
        for old, new in zip(before, after):
            for changing in ("step_ms", "real_time_factor"):
                if isinstance(old, dict):
                    old.pop(changing), new.pop(changing)
            self.assertEqual(old, new)
        self.assertEqual((await operator.ask("hash"))["hash"], hash_before)

    async def test_a_viewer_with_a_hand_is_refused_every_command_of_operators_and_no_other(self):
        pupil = await self.enter(LOOKER)
        answers = await self.all_refused(pupil)
        self.assertEqual({right for right, _ in answers.values()}, {"look", "hold", "operate"})
        for text, (right, lacks) in answers.items():
            with self.subTest(text=text):
                self.assertEqual(lacks, right == "operate")

    async def test_hands_are_given_and_taken_live_and_all_are_told(self):
        operator, pupil = await self.enter(OPERATOR), await self.enter(LOOKER)
        self.assertEqual((await pupil.ask("drag", phase="start", particle=100))["op"], "result")
        seen = len(pupil.texts)
        await operator.ask("policy", policy="watch")
        await pupil.wait_text(lambda m: m["op"] == "grabs" and not m["grabs"], seen)
        await pupil.wait_text(lambda m: m["op"] == "state" and m["policy"] == "watch", seen)
        self.assertEqual((await pupil.ask("drag", phase="start", particle=100))["code"], "not_allowed")
        await operator.ask("give_hand", viewer=pupil.id)
        self.assertEqual((await pupil.ask("drag", phase="start", particle=100))["op"], "result")
        await operator.ask("mute", viewer=pupil.id)
        self.assertEqual((await pupil.ask("drag", phase="move", target=[0, 1, 0]))["code"], "not_allowed")

    async def test_who_was_muted_is_muted_when_it_comes_again_with_its_token(self):
        operator, pupil = await self.enter(OPERATOR), await self.enter(LOOKER)
        await operator.ask("mute", viewer=pupil.id)
        seen = len(operator.texts)
        await pupil.socket.close()
        await operator.wait_text(lambda m: m["op"] == "roster" and len(m["viewers"]) == 1, seen)
        again = await self.enter(LOOKER, name="Another")
        self.assertEqual((await again.ask("drag", phase="start", particle=100))["code"], "not_allowed")
        await operator.ask("mute", viewer=again.id, muted=False)
        self.assertEqual((await again.ask("drag", phase="start", particle=100))["op"], "result")

    async def test_one_pupil_has_four_rooms_and_copies_of_copies_and_what_guests_make_count_among_them(self):
        pupil = await self.enter(LOOKER)
        own = await self.enter((await pupil.ask("fork", name="a"))["token"], room="a")
        guest = await self.enter((await own.ask("invite", right="hold"))["token"], room="a")
        again = await self.enter(LOOKER)
        for maker, name in ((own, "b"), (guest, "c"), (again, "d")):
            self.assertEqual((await maker.ask("fork", name=name))["op"], "result")
        for maker in (pupil, own, guest, again):
            error = await maker.ask("fork", name="e")
            self.assertEqual((error["code"], error["limit"]), ("too_many", {"maximum": 4}))
            self.assertIn("operator", error["hint"])
        teacher = await self.enter(OPERATOR)
        for name in "efghi":
            self.assertEqual((await teacher.ask("fork", name=name))["op"], "result", "operators are not bound")
        await teacher.ask("close_room", name="b")
        self.assertEqual((await pupil.ask("fork", name="b"))["op"], "result")

    async def test_a_viewer_takes_a_better_token_at_once_and_a_wrong_one_is_refused(self):
        viewer = await self.enter(LOOKER)
        self.assertEqual((await viewer.ask("reset"))["code"], "not_allowed")
        wrong = await viewer.ask("hello", token="guessed-0123456789")
        self.assertEqual((wrong["code"], wrong["field"]), ("not_allowed", "token"))
        self.assertEqual((await viewer.ask("hello", token=OPERATOR))["role"], "operator")
        self.assertEqual((await viewer.ask("reset"))["op"], "result")

    async def test_the_third_wrong_token_closes_whoever_is_in_with_4003(self):
        guesser, other = await self.enter(LOOKER), await self.enter(OPERATOR)
        for number in range(3):
            error = await guesser.ask("hello", token=f"guessed-0123456789-{number}")
            self.assertEqual((error["code"], error["field"]), ("not_allowed", "token"))
        self.assertEqual(await guesser.wait_closed(), 4003)
        self.assertEqual((await other.ask("hash"))["op"], "result")


class TokensAtTheStart(unittest.TestCase):
    def serve(self, *options, **environment):
        return subprocess.run([PROGRAM, "serve", "--port", "0", "--max-seconds", "0.2", *options],
                              capture_output=True, text=True, timeout=PATIENCE,
                              env={**os.environ, **environment})

    def test_a_file_that_others_may_read_is_told_and_no_token_appears_in_any_log(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "tokens")
            path.write_text(TOKENS)
            path.chmod(0o644)
            done = self.serve("--tokens", str(path), "--log-level", "trace")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("chmod 600", done.stderr)
        for token in (LOOKER, OPERATOR, ADMIN):
            self.assertNotIn(token, done.stdout + done.stderr)

    def test_wrong_files_are_refused_by_line_without_the_token(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "tokens")
            for text, named in ((TOKENS + "owner 0123456789abcdefgh\n", "line 6"), ("viewer short\n", "line 1"),
                                ("", "role token"), ("#" * 70000, "65536 bytes")):
                path.write_text(text)
                done = self.serve("--tokens", str(path))
                self.assertEqual(done.returncode, 2)
                self.assertIn(named, done.stderr)
                self.assertNotIn("0123456789abcdefgh", done.stderr)
            self.assertEqual(self.serve("--tokens", folder).returncode, 2)
            self.assertEqual(self.serve("--tokens", str(Path(folder, "absent"))).returncode, 2)

    def test_where_tokens_are_asked_for_and_none_is_given_no_server_starts(self):
        for options, environment, named in (((), {"WEFT_TOKENS": ""}, "WEFT_TOKENS"),
                                            ((), {"WEFT_TOKENS": "\n"}, "WEFT_TOKENS"),
                                            (("--tokens", ""), {}, "--tokens"),
                                            (("--tokens", "/dev/null"), {"WEFT_TOKENS": TOKENS}, "--tokens")):
            done = self.serve(*options, **environment)
            self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
            self.assertIn(f"weft: {named} = ", done.stderr)
            self.assertIn("allowed is", done.stderr)

    def test_the_environment_gives_tokens_too(self):
        done = self.serve("--bind", "0.0.0.0", WEFT_TOKENS=TOKENS)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.serve(WEFT_TOKENS="viewer short").returncode, 2)


class BehindAProxy(unittest.TestCase):
    LIMIT = 3

    def connection(self, server, *fields):
        """One that has been answered, kept open, and the status of its answer."""
        opened = socket.create_connection((server.addresses["host"], server.addresses["port"]), PATIENCE)
        self.addCleanup(opened.close)
        head = "".join(f"{field}\r\n" for field in fields)
        opened.sendall(f"GET /healthz HTTP/1.1\r\nHost: localhost\r\n{head}\r\n".encode())
        received = b""
        while b"\r\n\r\n" not in received:
            received += opened.recv(65536)
        return Answer(received).status

    def statuses(self, server, *fields):
        return [self.connection(server, *fields) for _ in range(self.LIMIT + 1)]

    def serve(self, *options):
        server = Server("--paused", "--max-connections-per-address", str(self.LIMIT), *options)
        self.addCleanup(lambda: self.assertEqual(server.stop(), 0))
        return server

    def test_each_client_of_a_trusted_proxy_is_counted_by_itself(self):
        server = self.serve("--trusted-proxy", "127.0.0.0/8")
        full = [200] * self.LIMIT + [503]
        self.assertEqual(self.statuses(server, "X-Forwarded-For: 203.0.113.9"), full)
        self.assertEqual(self.statuses(server, "X-Forwarded-For: 203.0.113.8"), full)
        self.assertEqual(self.statuses(server, 'Forwarded: for="[2001:db8::1]"'), full)
        # What the client itself wrote before the proxy's word changes nothing.
        self.assertEqual(self.connection(server, "X-Forwarded-For: 198.51.100.1, 203.0.113.9"), 503)
        self.assertEqual(self.connection(server, "X-Forwarded-For: 198.51.100.1"), 200)

    def test_nobody_else_is_believed(self):
        server = self.serve("--trusted-proxy", "192.0.2.7")
        answers = [self.connection(server, f"X-Forwarded-For: 203.0.113.{k}") for k in range(self.LIMIT + 1)]
        self.assertEqual(answers, [200] * self.LIMIT + [503])

    def test_a_socket_counts_for_its_client_as_long_as_it_is_open(self):
        server = self.serve("--trusted-proxy", "127.0.0.1")
        opened = []
        for _ in range(self.LIMIT):
            connection = socket.create_connection((server.addresses["host"], server.addresses["port"]), PATIENCE)
            opened.append(connection)
            connection.sendall(f"GET /ws HTTP/1.1\r\nHost: localhost\r\nX-Forwarded-For: 203.0.113.9\r\n"
                               f"{UPGRADE}\r\n".encode())
            self.assertIn(b" 101 ", connection.recv(65536))
        self.assertEqual(self.connection(server, "X-Forwarded-For: 203.0.113.9"), 503)
        self.assertEqual(self.connection(server, "X-Forwarded-For: 203.0.113.8"), 200)
        for connection in opened:
            with contextlib.closing(connection):
                connection.shutdown(socket.SHUT_RDWR)


if __name__ == "__main__":
    main()
