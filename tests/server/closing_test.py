"""What the server says last arrives, even at a client that is still sending. A socket closed over unread
bytes resets its connection, and the client then loses what it has not read yet."""

import select
import socket
import struct
import time

from foreign_client import PATIENCE, SocketTest, main

UPGRADE = (b"GET /ws HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
           b"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
           b"Sec-WebSocket-Protocol: weft.v1\r\n\r\n")
NO_MASK = bytes(4)  # a mask of zeros leaves the payload as it is
PART = 64 * 1024


class Raw:
    """A client without any library between the test and the socket."""

    def __init__(self, server):
        self.socket = socket.create_connection((server.addresses["host"], server.addresses["port"]),
                                               timeout=PATIENCE)
        self.received = bytearray()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def upgrade(self):
        """Becomes a viewer and reads the server's messages up to its roster."""
        self.socket.sendall(UPGRADE)
        while b'"op":"roster"' not in self.received:
            self.received += self.socket.recv(PART)

    def wait_readable(self):
        assert select.select([self.socket], [], [], PATIENCE)[0], "nothing came"

    def read_to_the_end(self):
        """All that comes until the server's end; a reset raises ConnectionResetError."""
        answer = b""
        while part := self.socket.recv(PART):
            answer += part
        return answer


class LastWords(SocketTest):
    options = ("--paused",)

    def closes_while_sending(self, begin, rest):
        """Sends `begin`, waits for the server's reaction, then sends `rest` and only then reads."""
        with Raw(self.server) as client:
            client.upgrade()
            client.socket.sendall(begin)
            client.wait_readable()
            for _ in range(rest // PART):
                client.socket.sendall(bytes(PART))
            return client.read_to_the_end()

    def check_closed_with(self, code, answer):
        # Other messages may come before it, but nothing behind it.
        at = answer.rfind(b"\x88")
        self.assertEqual(len(answer), at + 2 + answer[at + 1], answer[-40:])
        self.assertEqual(struct.unpack(">H", answer[at + 2:at + 4])[0], code)

    def test_the_code_of_a_message_too_large_arrives_before_the_message_is_sent(self):
        for opcode in (b"\x81", b"\x82"):
            header = opcode + b"\xff" + struct.pack(">Q", 4 << 20) + NO_MASK
            self.check_closed_with(1009, self.closes_while_sending(header + bytes(300_000), 4 << 20))

    def test_the_code_of_a_broken_frame_arrives_at_who_goes_on_sending(self):
        self.check_closed_with(1002, self.closes_while_sending(b"\xff\xff" + bytes(14), 4 << 20))

    def test_the_code_of_text_that_is_no_utf8_arrives_at_who_goes_on_sending(self):
        begin = b"\x81\x81" + NO_MASK + b"\xff"
        self.check_closed_with(1007, self.closes_while_sending(begin, 4 << 20))

    def test_the_code_of_a_message_that_is_no_ack_arrives_at_who_goes_on_sending(self):
        begin = b"\x82\x81" + NO_MASK + b"\x00"
        with Raw(self.server) as client:
            client.upgrade()
            client.socket.sendall(begin)
            client.wait_readable()
            # This close waits for the client's own, so what follows must be frames of the protocol.
            for _ in range(64):
                client.socket.sendall(b"\x82\xff" + struct.pack(">Q", PART) + NO_MASK + bytes(PART))
            client.socket.sendall(b"\x88\x82" + NO_MASK + struct.pack(">H", 1000))
            self.check_closed_with(1003, client.read_to_the_end())

    def answer_while_sending(self, begin, rest):
        with Raw(self.server) as client:
            client.socket.sendall(begin)
            client.wait_readable()
            for _ in range(rest // PART):
                client.socket.sendall(b"a" * PART)
            return client.read_to_the_end()

    def test_the_answer_to_a_request_arrives_before_its_body_is_sent(self):
        for begin, status in (
                (b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 4194304\r\n\r\n", b"413"),
                (b"nonsense\r\n\r\n", b"400"),
                (b"GET /" + b"a" * 20000, b"431"),
                (b"GET /version HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n", b"200")):
            with self.subTest(status=status):
                answer = self.answer_while_sending(begin, 4 << 20)
                self.assertTrue(answer.startswith(b"HTTP/1.1 " + status), answer[:40])

    def test_who_never_stops_sending_is_cut_off(self):
        for begin in (b"nonsense\r\n\r\n", UPGRADE + b"\xff\xff" + bytes(14)):
            with self.subTest(begin=begin[:8]), Raw(self.server) as client:
                client.socket.sendall(begin)
                with self.assertRaises(ConnectionError):
                    for _ in range(2**14):
                        client.socket.sendall(bytes(PART))

    def test_who_never_closes_is_cut_off(self):
        for begin in (b"nonsense\r\n\r\n", UPGRADE + b"\xff\xff" + bytes(14),
                      UPGRADE + b"\x82\x81" + NO_MASK + b"\x00"):
            with self.subTest(begin=begin[:8]), Raw(self.server) as client:
                client.socket.sendall(begin)
                client.read_to_the_end()
                # The server has ended its half and now waits. Without an answer it closes, and what comes
                # later meets a reset.
                with self.assertRaises(ConnectionError):
                    while True:
                        time.sleep(0.05)
                        client.socket.sendall(b"a")


class Refusals(SocketTest):
    options = ("--max-connections", "2", "--paused")

    def test_the_answer_that_there_are_too_many_arrives_at_who_goes_on_sending(self):
        with Raw(self.server), Raw(self.server), Raw(self.server) as third:
            third.socket.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
            third.wait_readable()
            for _ in range(64):
                third.socket.sendall(b"a" * PART)
            self.assertTrue(third.read_to_the_end().startswith(b"HTTP/1.1 503"))


if __name__ == "__main__":
    main()
