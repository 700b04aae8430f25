"""Numbers and fields of binary messages (sections 6 to 8 and 10 of the specification)."""

import struct

FRAME, MESH, DATA, ACK = 1, 2, 3, 4
VERSION = 1
KEY, JUMP, PAUSED, OBSERVED = 1, 2, 4, 8
POSITIONS, GRABS, APPLIED, POSES, CONTACTS, REACTIONS, PACKED_POSITIONS = 1, 2, 3, 4, 5, 6, 7
VELOCITIES, GRIPPERS = 8, 9
REST, TRIANGLES, UV, COLLIDER_POSITIONS, COLLIDER_TRIANGLES, ORDER = 16, 17, 18, 19, 20, 21
FLOAT32, PACKED = 0, 2  # codecs of frames
COMMON = struct.Struct("<BBBBIII")
FRAME_FIELDS = struct.Struct("<QddIIIIfI")
MESH_FIELDS = struct.Struct("<IIII")
DATA_FIELDS = struct.Struct("<QIIII")
SECTION = struct.Struct("<HHI")
GRAB = struct.Struct("<II7f")
APPLIED_ENTRY = struct.Struct("<II")
POSE = struct.Struct("<I7f")
CONTACT = struct.Struct("<II11f")
REACTION = struct.Struct("<II3f")
GRIPPER = struct.Struct("<II15f")
NO_COLLIDER = 2**32 - 1
REACTION_OF: dict[int, str] = {0: "pin", 1: "collider"}
ACK_FIELDS = struct.Struct("<BBHI")
TICK_END = 2**53
