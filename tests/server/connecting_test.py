"""Who may reach a server: hosts and origins as browsers tell them, with a client that is not ours."""

import json
import socket
import tempfile
import unittest
from pathlib import Path

from foreign_client import PATIENCE, Server, main

UPGRADE = ("Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
           "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: weft.v1\r\n")


class Answer:
    def __init__(self, raw):
        head, self.body = raw.split(b"\r\n\r\n", 1)
        lines = head.decode().split("\r\n")
        self.status = int(lines[0].split()[1])
        self.fields = {name.lower(): value for name, value in (line.split(": ", 1) for line in lines[1:])}

    @property
    def error(self):
        return json.loads(self.body)["error"]


class RunningServer(unittest.TestCase):
    options = ()

    def setUp(self):
        page = tempfile.TemporaryDirectory()
        self.addCleanup(page.cleanup)
        Path(page.name, "index.html").write_text("the page")
        self.server = Server("--paused", "--web", page.name, *self.options)
        self.port = self.server.addresses["port"]

    def tearDown(self):
        self.assertEqual(self.server.stop(), 0)

    def raw(self, request):
        """The answer to one request; after an upgrade, its head alone."""
        with socket.create_connection((self.server.addresses["host"], self.port), PATIENCE) as connection:
            connection.sendall(request.encode())
            received = b""
            while b"\r\n\r\n" not in received:
                received += connection.recv(65536)
            head = received.split(b"\r\n\r\n", 1)[0].lower()
            length = next((int(line.split(b":")[1]) for line in head.split(b"\r\n")
                           if line.startswith(b"content-length:")), 0)
            while len(received) < len(head) + 4 + length:
                part = connection.recv(65536)
                if not part:
                    break
                received += part
            return Answer(received)

    def get(self, host, path="/version"):
        return self.raw(f"GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n")

    def upgrade(self, host, origin=None, path="/ws"):
        field = f"Origin: {origin}\r\n" if origin else ""
        return self.raw(f"GET {path} HTTP/1.1\r\nHost: {host}\r\n{field}{UPGRADE}\r\n")


class Hosts(RunningServer):
    def test_a_forwarded_port_of_another_number_works(self):
        for host in ("localhost:9000", "LOCALHOST:9000", "127.0.0.1:9000", "[::1]:9000", "localhost"):
            with self.subTest(host=host):
                self.assertEqual(self.get(host).status, 200)
                self.assertEqual(self.upgrade(host, f"http://{host.lower()}").status, 101)
                self.assertEqual(self.upgrade(host, f"https://{host.lower()}").status, 101)

    def test_another_page_of_the_same_machine_does_not_open_the_socket(self):
        for origin in ("http://localhost:9001", "http://localhost", "null", "file://"):
            with self.subTest(origin=origin):
                self.assertEqual(self.upgrade("localhost:9000", origin).status, 403)

    def test_no_host_or_two_or_one_that_is_none_is_answered_with_400(self):
        for fields in ("", "Host: localhost\r\nHost: localhost\r\n", "Host: \r\n", "Host: a b\r\n",
                       "Host: a,b\r\n", "Host: u@localhost\r\n", "Host: localhost:99999\r\n", "Host: ::1\r\n"):
            for more in ("", UPGRADE):
                with self.subTest(fields=fields, upgrade=bool(more)):
                    answer = self.raw(f"GET /ws HTTP/1.1\r\n{fields}{more}\r\n")
                    self.assertEqual((answer.status, answer.error["code"]), (400, "bad_request"))

    def test_http_1_0_may_leave_its_host_out(self):
        self.assertEqual(self.raw("GET /version HTTP/1.0\r\n\r\n").status, 200)

    def test_a_target_in_absolute_form_is_taken_and_its_host_counts(self):
        port = self.port
        for target, host, status in (
                (f"http://127.0.0.1:{port}/version", f"127.0.0.1:{port}", 200),
                (f"HTTP://LocalHost:{port}/version", "localhost", 200),
                ("https://localhost/version", "evil.example", 200),
                (f"http://evil.example:{port}/version", f"127.0.0.1:{port}", 403),
                ("http://localhost/nothing", "localhost", 404),
                ("http://localhost?x=/y", "localhost", 200),
                ("http:///version", "localhost", 400),
                ("ftp://localhost/version", "localhost", 400),
                ("http://u@localhost/version", "localhost", 400)):
            with self.subTest(target=target, host=host):
                self.assertEqual(self.get(host, target).status, status)
        answer = self.upgrade("evil.example", "http://localhost:9000", "http://localhost:9000/ws?mesh=http")
        self.assertEqual(answer.status, 101)
        answer = self.raw("GET http://localhost/version HTTP/1.1\r\n\r\n")
        self.assertEqual(answer.status, 400)  # Host is needed all the same

    def test_a_page_can_ask_in_plain_http_what_its_upgrade_would_be_answered(self):
        self.assertEqual(self.get("localhost:9000", "/api/v1/connect?origin=http://localhost:9000").status, 200)
        self.assertEqual(self.get("localhost:9000", "/api/v1/connect").status, 200)
        refused = self.get("localhost:9000", "/api/v1/connect?x=1&origin=https://weft.example&y=2")
        self.assertEqual((refused.status, refused.error["code"]), (403, "not_allowed"))
        self.assertEqual(refused.error["value"], "https://weft.example")
        self.assertIn("--allow-origin https://weft.example", refused.error["hint"])
        self.assertNotIn("--allow-origin",
                         self.get("localhost", "/api/v1/connect?origin=null").error["hint"])

    def test_every_answer_forbids_guessing_types_and_telling_other_sites_where_one_was(self):
        for path in ("/", "/version", "/metrics", "/nothing"):
            fields = self.get("localhost", path).fields
            self.assertEqual(fields["x-content-type-options"], "nosniff")
            self.assertEqual(fields["referrer-policy"], "same-origin")
            self.assertNotIn("x-frame-options", fields)  # configurators show the page in a frame


class OpenServer(RunningServer):
    options = ("--open",)

    def test_a_name_that_was_pointed_here_is_refused_for_every_request_by_name(self):
        name = f"evil.example:{self.port}"
        for answer in (self.get(name), self.get(name, "/metrics"), self.get(name, "/api/v1/scenes"),
                       self.get(name, "/"), self.upgrade(name), self.upgrade(name, f"http://{name}")):
            self.assertEqual((answer.status, answer.error["code"]), (403, "not_allowed"))
            self.assertEqual(answer.error["value"], "evil.example")
            self.assertIn("evil.example", answer.error["message"])
            self.assertIn("localhost", answer.error["offered"])
            self.assertIn("--allow-origin http://evil.example", answer.error["hint"])

    def test_the_address_of_an_interface_works(self):
        self.assertEqual(self.upgrade("192.168.1.5:8080", "http://192.168.1.5:8080").status, 101)


class AllowedOrigins(RunningServer):
    options = ("--allow-origin", "https://weft.example", "--allow-origin", "http://localhost:3000")

    def test_a_proxy_that_keeps_the_host_and_one_that_sets_it_both_work(self):
        self.assertEqual(self.upgrade("weft.example", "https://weft.example").status, 101)
        self.assertEqual(self.upgrade(f"127.0.0.1:{self.port}", "https://weft.example").status, 101)
        self.assertEqual(self.get("weft.example", "/").status, 200)

    def test_pages_of_the_allowed_origins_open_the_socket_and_no_others(self):
        host = f"127.0.0.1:{self.port}"
        self.assertEqual(self.upgrade(host, "http://localhost:3000").status, 101)
        for origin in ("http://weft.example", "https://weft.example:8443", "https://a.weft.example",
                       "http://localhost:3001"):
            self.assertEqual(self.upgrade(host, origin).status, 403)
        self.assertEqual(self.get("other.example").error["offered"],
                         ["localhost", "weft.example", "any IP address"])


class Full(RunningServer):
    options = ("--max-viewers", "1")

    def test_a_page_is_told_that_the_server_is_full(self):
        with socket.create_connection((self.server.addresses["host"], self.port), PATIENCE) as first:
            first.sendall(f"GET /ws HTTP/1.1\r\nHost: localhost\r\n{UPGRADE}\r\n".encode())
            self.assertIn(b" 101 ", first.recv(4096))
            answer = self.get("localhost", "/api/v1/connect?origin=http://localhost")
        self.assertEqual((answer.status, answer.error["code"]), (503, "busy"))
        self.assertEqual(answer.error["message"], "at most 1 viewers")


if __name__ == "__main__":
    main()
