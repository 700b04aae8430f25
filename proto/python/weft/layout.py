"""Numbers and fields of binary messages (sections 6 to 8 and 10 of the specification)."""

import struct

FRAME, MESH, DATA, ACK = 1, 2, 3, 4
VERSION = 1
POSITIONS, PACKED_POSITIONS = 1, 7  # those of frames beside them: frame_parts.py
REST, TRIANGLES, UV, COLLIDER_POSITIONS, COLLIDER_TRIANGLES, ORDER = 16, 17, 18, 19, 20, 21
FLOAT32, PACKED = 0, 2  # codecs of frames
COMMON = struct.Struct("<BBBBIII")
FRAME_FIELDS = struct.Struct("<QddIIIIfI")
MESH_FIELDS = struct.Struct("<IIII")
DATA_FIELDS = struct.Struct("<QIIII")
SECTION = struct.Struct("<HHI")
ACK_FIELDS = struct.Struct("<BBHI")
TICK_END = 2**53
