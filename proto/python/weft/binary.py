"""Any binary message of a server, and the answer to a frame."""

from __future__ import annotations

from . import layout
from .errors import ProtocolError
from .frames import decode_frame
from .meshes import decode_mesh
from .reading import demand, padded, read_common, rows_of
from .samples import Data, Frame, MeshData


def decode_data(message: bytes) -> Data:
    start = layout.COMMON.size + layout.DATA_FIELDS.size
    codec, _ = read_common(message, layout.DATA, start, 1)
    tick, transfer, count, components, zero = layout.DATA_FIELDS.unpack_from(message, layout.COMMON.size)
    demand(tick < layout.TICK_END and zero == 0 and 1 <= components <= 16, "the header does not fit")
    size = count * components * (4 if codec == 0 else 8)
    demand(len(message) == start + padded(size), "the values do not fit")
    demand(not any(message[start + size :]), "padding is not zero")
    payload = memoryview(message)[start : start + size]
    return Data(tick, transfer, components, rows_of(payload, "d" if codec else "f", count, components))


def decode_binary(message: bytes) -> Frame | MeshData | Data:
    """Reads any binary message of a server. Raises ProtocolError and nothing else on the bytes."""
    decoders = {layout.FRAME: decode_frame, layout.MESH: decode_mesh, layout.DATA: decode_data}
    decode = decoders.get(message[0] if message else 0)
    if decode is None:
        raise ProtocolError("unknown type")
    return decode(message)


def encode_ack(sequence: int) -> bytes:
    """The answer to a frame."""
    return layout.ACK_FIELDS.pack(layout.ACK, layout.VERSION, 0, sequence)
