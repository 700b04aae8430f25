"""What all binary messages of the wire have in common, as proto/README.md section 6 says."""

import struct


def pad(data):
    return data + bytes(-len(data) % 8)


def seal(data, length=None):
    """Puts length and checksum into a message."""
    data = bytearray(data)
    struct.pack_into("<I", data, 4, len(data) if length is None else length)
    struct.pack_into("<II", data, 8, 0, 0)
    words = struct.unpack(f"<{len(data) // 4}I", data[: len(data) // 4 * 4])
    a = sum(words) % 2**32
    b = sum((j + 1) * word for j, word in enumerate(words)) % 2**32
    struct.pack_into("<II", data, 8, a, b)
    return bytes(data)


def message(kind, body, codec=0, flags=0, version=1):
    return seal(pad(struct.pack("<BBBBIII", kind, version, codec, flags, 0, 0, 0) + body))


def section(kind, index, payload):
    return pad(struct.pack("<HHI", kind, index, len(payload)) + payload)


def floats(values):
    return struct.pack(f"<{len(values)}f", *values)


def integers(values):
    return struct.pack(f"<{len(values)}I", *values)


def round_float(values):
    """What is left of numbers after a float32."""
    return list(struct.unpack(f"<{len(values)}f", floats(values)))


def frame_body(header, vertices, sections, step=0.0):
    fixed = struct.pack(
        "<QddIIIIfI",
        header["tick"],
        header["time"],
        header["server_time"],
        header["sequence"],
        header["reference"],
        header["epoch"],
        vertices,
        step,
        len(sections),
    )
    return fixed + b"".join(sections)


def patched(base, offset, layout, *values):
    """Other bytes at an offset, with the checksum put right again."""
    changed = bytearray(base)
    struct.pack_into("<" + layout, changed, offset, *values)
    return seal(changed, struct.unpack_from("<I", changed, 4)[0])
