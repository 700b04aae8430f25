"""The golden files and the examples of the specification."""

import json
import re
import struct
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
GOLDEN = ROOT / "tests/proto/golden"
sys.path.insert(0, str(ROOT / "proto/python"))


def read(name):
    return (GOLDEN / name).read_bytes()


def read_json(name):
    return json.loads(read(name))


def messages():
    """Golden binary messages: name, what must be read, bytes."""
    return [(name, content, read(f"{name}.bin")) for name, content in read_json("binary.json").items()]


def examples():
    """The JSON examples of the specification."""
    page = (ROOT / "proto/README.md").read_text(encoding="utf-8")
    return [json.loads(text) for text in re.findall(r"^```json\n(.*?)^```$", page, re.M | re.S)]


def sealed(message):
    """Length and checksum put right again after a change, so that a decoder looks further."""
    if len(message) < 16:
        return bytes(message)
    message = bytearray(message)
    struct.pack_into("<III", message, 4, len(message), 0, 0)
    count = len(message) // 4
    a = b = 0
    for j, word in enumerate(struct.unpack(f"<{count}I", message[: 4 * count])):
        a, b = a + word, b + (j + 1) * word
    struct.pack_into("<II", message, 8, a % 2**32, b % 2**32)
    return bytes(message)


def packed_streams():
    """Golden streams of the codec `packed`: name, cloths, mesh message, pairs of frames (packed, plain)."""
    streams = []
    for name, content in read_json("packed.json").items():
        if name == "refused":
            continue
        stream, cut = read(f"{name}.bin"), []
        while stream:
            length = struct.unpack_from("<I", stream, 4)[0]
            cut.append(stream[:length])
            stream = stream[length:]
        streams.append((name, content["cloths"], cut[0], list(zip(cut[1::2], cut[2::2]))))
    return streams
