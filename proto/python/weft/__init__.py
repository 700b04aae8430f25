"""Client of a Weft server: one shared cloth, simulated on the server, seen and held from here.

It speaks weft.v1 (proto/README.md) over the package `websockets` (10.4) and needs nothing else but Python 3.11.
Asynchronous:

    async with weft.connect("ws://127.0.0.1:8080/ws", name="script") as cloth:
        hit = await cloth.pick([0, 1, 3], [0, 0, -1])
        async with cloth.drag(hit, radius=0.05) as hand:
            await hand.move([0, 1.5, 1])
        frame = await cloth.next_frame()

and the same, blocking:

    with weft.open("ws://127.0.0.1:8080/ws") as cloth:
        cloth.pause()
        print(cloth.advance(60)["hash"])

Units are SI and y is up. Vertex data has one row per vertex: a numpy array if numpy is installed, else
`Rows`, a read-only sequence of tuples. Arguments may be numpy's numbers and vectors too.

No call waits forever: `timeout` of `connect` and `open` bounds joining, `call_timeout` every answer (30 s), and
each command takes a `timeout` of its own; None: no bound. A call without an answer in time raises CallTimeout.
`load`, `create_room` and `fork` wait 300 s by default, `advance` 60 s and one more for each tick, and only
`until_asleep` forever. Commands are paced to keep the server's limit of messages a second: a loop of calls simply
runs at that rate.
"""

from __future__ import annotations

import sys

from .binary import decode_binary, decode_data, encode_ack
from .blocking import SyncClient, SyncDrag, open
from .client import Client
from .connecting import SUBPROTOCOL, connect
from .drag import Drag
from .errors import CallTimeout, CommandError, ConnectionLost, ProtocolError, WeftError
from .frame_parts import ContactSample, GrabSample, GripperSample, Pose, ReactionSample
from .frames import decode_frame
from .meshes import decode_mesh
from .packed import FrameDecoder
from .page import Page
from .samples import ColliderMesh, Data, Frame, Hit, MeshData, Rows
from .version import __version__

if sys.byteorder != "little":
    raise ImportError("weft reads little-endian data as it is and needs such a machine")

__all__ = [
    "CallTimeout", "Client", "ColliderMesh", "CommandError", "ConnectionLost", "ContactSample", "Data", "Drag",
    "Frame", "FrameDecoder", "GrabSample", "GripperSample", "Hit", "MeshData", "Page", "Pose", "ProtocolError",
    "ReactionSample", "Rows", "SUBPROTOCOL", "SyncClient", "SyncDrag", "WeftError", "__version__", "connect",
    "decode_binary", "decode_data", "decode_frame", "decode_mesh", "encode_ack", "open",
]  # fmt: skip
