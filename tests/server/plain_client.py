"""A client of weft.v1 in plain Python, written from proto/README.md alone: commands, and frames in float32.

    cloth = Weft("127.0.0.1", 8080)
    cloth.ask("pause")
    cloth.ask("advance", n=60, frames="last")
    cloth.frame.positions[:3]       # x, y, z of vertex 0 [m]
"""

import base64
import hashlib
import json
import os
import socket
import struct
from array import array

TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10  # opcodes of WebSocket
ACCEPTING = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"
FRAME, MESH, DATA = 1, 2, 3  # types of binary messages
POSITIONS = 1  # a section of frames


class Refused(Exception):
    """The server's `error`; all of it is in `message`."""

    def __init__(self, message):
        super().__init__(message["message"])
        self.message = message


class Socket:
    """WebSocket over TCP, as a client needs it here."""

    def __init__(self, host, port, timeout):
        self.stream = socket.create_connection((host, port), timeout)
        self.reader = self.stream.makefile("rb")
        key = base64.b64encode(os.urandom(16)).decode()
        head = (f"GET /ws HTTP/1.1", f"Host: {host}:{port}", "Upgrade: websocket", "Connection: Upgrade",
                f"Sec-WebSocket-Key: {key}", "Sec-WebSocket-Version: 13", "Sec-WebSocket-Protocol: weft.v1")
        self.stream.sendall("\r\n".join((*head, "", "")).encode())
        status, fields = self.reader.readline().split(), {}
        while line := self.reader.readline().decode().strip():
            name, _, value = line.partition(":")
            fields[name.lower()] = value.strip()
        accepted = base64.b64encode(hashlib.sha1((key + ACCEPTING).encode()).digest()).decode()
        if status[1] != b"101" or fields.get("sec-websocket-accept") != accepted:
            raise ConnectionError(f"no WebSocket there: {status}")

    def send(self, payload, opcode):
        mask, size = os.urandom(4), len(payload)
        head = bytes([0x80 | opcode])
        if size < 126:
            head += bytes([0x80 | size])
        else:
            head += struct.pack(">BH", 0x80 | 126, size)  # commands have at most 64 KiB
        masked = int.from_bytes(payload, "little") ^ int.from_bytes((mask * (size // 4 + 1))[:size], "little")
        self.stream.sendall(head + mask + masked.to_bytes(size, "little"))

    def read(self, size):
        data = self.reader.read(size)
        if len(data) < size:
            raise ConnectionError("the connection ended")
        return data

    def receive(self):
        """The next message: str or bytes."""
        whole, kind = b"", None
        while True:
            first, size = self.read(2)
            if size > 125:
                size = int.from_bytes(self.read(2 if size == 126 else 8), "big")
            payload, opcode = self.read(size), first & 15
            if opcode == CLOSE:
                raise ConnectionError(f"closed: {payload[:2].hex()} {payload[2:].decode()}")
            if opcode == PING:
                self.send(payload, PONG)
            elif opcode != PONG:
                kind, whole = kind or opcode, whole + payload
                if first & 0x80:
                    return whole.decode() if kind == TEXT else whole


class Frame:
    """A frame in codec 0 (section 6)."""

    def __init__(self, message):
        _, _, codec, self.flags, length, *sums = struct.unpack_from("<BBBBIII", message)
        words = array("I", message)
        words[2] = words[3] = 0
        told = [sum(words) % 2**32, sum(j * word for j, word in enumerate(words, 1)) % 2**32]
        if codec != 0 or length != len(message) or told != sums:
            raise ValueError("this is no frame in float32")
        self.tick, self.time, self.server_time, self.sequence, _, self.epoch = struct.unpack_from("<QddIII", message, 16)
        sections, at = struct.unpack_from("<I", message, 60)[0], 64
        for _ in range(sections):
            kind, _, size = struct.unpack_from("<HHI", message, at)
            if kind == POSITIONS:
                self.positions = array("f", message[at + 8 : at + 8 + size])
            at += 8 + (size + 7) // 8 * 8


class Weft:
    """A viewer. Whatever the server tells is read while an answer or a frame is waited for."""

    def __init__(self, host, port, timeout=60):
        self.socket = Socket(host, port, timeout)
        self.told, self.frame, self.mesh, self.data, self.sent = {}, None, None, None, 0  # `told`: by `op`
        while self.mesh is None:
            self.listen()

    def listen(self):
        """Takes one message; a text message as a dict, None for a binary one."""
        message = self.socket.receive()
        if isinstance(message, str):
            message = json.loads(message)
            self.told[message["op"]] = message
            return message
        if message[0] == FRAME:
            self.frame = Frame(message)
            self.socket.send(struct.pack("<BBHI", 4, 1, 0, self.frame.sequence), BINARY)  # the ack
        elif message[0] == MESH:
            self.mesh = message
        elif message[0] == DATA:
            self.data = message

    def ask(self, op, **fields):
        """Sends a command and returns its result."""
        self.sent += 1
        self.socket.send(json.dumps({"op": op, "id": self.sent, **fields}).encode(), TEXT)
        while True:
            message = self.listen()
            if message and message.get("id") == self.sent:
                if message["op"] == "error":
                    raise Refused(message)
                return message

    def next_frame(self):
        before = self.frame
        while self.frame is before:
            self.listen()
        return self.frame
