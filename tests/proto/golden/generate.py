#!/usr/bin/python3
"""Writes the golden files of the wire.

Written from proto/README.md alone and independent of the three implementations that are tested
against its output. Run it only if the specification changes; a test checks that the files are what
it writes. Usage: generate.py [FOLDER]
"""

import json
import struct
import sys
from pathlib import Path

import calls
import commands
import packed
import refusals
from samples import (
    APPLIED_NUMBERS,
    GRID,
    GRIPPING,
    HANDS,
    MOVED,
    REACTING,
    TETRAHEDRON,
    TOUCHING,
    applied_bytes,
    contact_bytes,
    grab_bytes,
    grid,
    gripper_bytes,
    pose_bytes,
    reaction_bytes,
)
from sealing import (
    floats,
    frame_body,
    integers,
    message,
    patched,
    round_float,
    seal,
    section,
)

FRAME, MESH, DATA, ACK = 1, 2, 3, 4
POSITIONS, GRABS, APPLIED, POSES, CONTACTS, REACTIONS = 1, 2, 3, 4, 5, 6
VELOCITIES, GRIPPERS = 8, 9
REST, TRIANGLES, UV, COLLIDER_POSITIONS, COLLIDER_TRIANGLES = 16, 17, 18, 19, 20
KEY, JUMP, PAUSED, OBSERVED = 1, 2, 4, 8
FLOAT32_MAX, FLOAT32_LEAST = 2.0**127 * (2 - 2.0**-23), 2.0**-149
NAN, INFINITY = float("nan"), float("inf")


def frame(
    name,
    header,
    positions,
    grabs=(),
    applied=(),
    poses=(),
    contacts=(),
    reactions=(),
    grippers=(),
    velocities=(),
    extra_before=(),
    extra_after=(),
):
    """A frame, and what must be read from it. Unknown sections may stand anywhere."""
    sections = list(extra_before) + [section(POSITIONS, 0, floats(positions))]
    if grabs:
        sections.append(section(GRABS, 0, grab_bytes(grabs)))
    if applied:
        sections.append(section(APPLIED, 0, applied_bytes(applied)))
    if poses:
        sections.append(section(POSES, 0, pose_bytes(poses)))
    if contacts:
        sections.append(section(CONTACTS, 0, contact_bytes(contacts)))
    if reactions:
        sections.append(section(REACTIONS, 0, reaction_bytes(reactions)))
    if grippers:
        sections.append(section(GRIPPERS, 0, gripper_bytes(grippers)))
    if velocities:
        sections.append(section(VELOCITIES, 0, floats(velocities)))
    sections += extra_after
    body = frame_body(header, len(positions) // 3, sections)
    content = {
        "type": "frame",
        "encoder_writes_it": not extra_before and not extra_after,
        "header": header,
        "positions": round_float(positions),
        "grabs": [
            dict(
                g,
                held=round_float(g["held"]),
                target=round_float(g["target"]),
                force=round_float([g["force"]])[0],
            )
            for g in grabs
        ],
        "applied": list(applied),
        "poses": [
            dict(p, position=round_float(p["position"]), rotation=round_float(p["rotation"]))
            for p in poses
        ],
        "contacts": [
            dict(
                c,
                point=round_float(c["point"]),
                normal=round_float(c["normal"]),
                gap=round_float([c["gap"]])[0],
                normal_force=round_float([c["normal_force"]])[0],
                friction=round_float(c["friction"]),
            )
            for c in contacts
        ],
        "reactions": [dict(r, force=round_float(r["force"])) for r in reactions],
        "velocities": round_float(velocities),
        "grippers": [
            {k: round_float(v) if isinstance(v, list) else v for k, v in dict(
                g, opening=round_float([g["opening"]])[0], force=round_float([g["force"]])[0]
            ).items()}
            for g in grippers
        ],
    }
    return name, message(FRAME, body, flags=header["flags"]), content


def frame_header(**changes):
    header = dict(flags=KEY, tick=0, time=0.0, server_time=0.0, sequence=1, epoch=1)
    header.update(changes)
    header.setdefault("reference", header["sequence"])
    return header


def mesh_body(rest, triangles, uv, colliders, extra=(), collider_count=None):
    sections = [
        section(REST, 0, floats(rest)),
        section(TRIANGLES, 0, integers(triangles)),
        section(UV, 0, floats(uv)),
    ]
    for collider in colliders:
        index = collider["collider"]
        sections.append(section(COLLIDER_POSITIONS, index, floats(collider["positions"])))
        sections.append(section(COLLIDER_TRIANGLES, index, integers(collider["triangles"])))
    sections += extra
    if collider_count is None:
        collider_count = len(colliders)
    counts = (len(rest) // 3, len(triangles) // 3, collider_count, len(sections))
    return integers(counts) + b"".join(sections)


def mesh(name, rest, triangles, uv, colliders=(), extra=()):
    content = {
        "type": "mesh",
        "encoder_writes_it": not extra,
        "rest_positions": round_float(rest),
        "triangles": triangles,
        "uv": round_float(uv),
        "colliders": [dict(c, positions=round_float(c["positions"])) for c in colliders],
    }
    return name, message(MESH, mesh_body(rest, triangles, uv, colliders, extra)), content


def data(name, real, tick, transfer, components, values):
    body = struct.pack("<QIIII", tick, transfer, len(values) // components, components, 0)
    body += struct.pack(f"<{len(values)}{real}", *values)
    content = {
        "type": "data",
        "encoder_writes_it": True,
        "format": {"f": "f32", "d": "f64"}[real],
        "tick": tick,
        "transfer": transfer,
        "components": components,
        "values": round_float(values) if real == "f" else list(values),
    }
    return name, message(DATA, body, codec={"f": 0, "d": 1}[real]), content


def accepted():
    yield frame("frame_one_vertex", frame_header(), [0.5, 1.25, -2.0])
    yield frame("frame_no_vertex", frame_header(sequence=0), [])
    yield frame(
        "frame_hands",
        frame_header(
            flags=KEY | PAUSED, tick=2**40 + 5, time=86.0, server_time=91.5, sequence=2**32 - 1
        ),
        GRID[0],
        HANDS,
        APPLIED_NUMBERS,
    )
    yield frame("frame_poses", frame_header(tick=7), GRID[0], HANDS[:1], (), MOVED)
    yield frame(
        "frame_forces", frame_header(tick=8), GRID[0], (), (), (), TOUCHING, REACTING
    )
    moving = [0.01 * i - 0.05 for i in range(len(GRID[0]))]
    yield frame(
        "frame_observed", frame_header(flags=KEY | PAUSED | OBSERVED, tick=60), GRID[0],
        HANDS[:1], (), (), TOUCHING, REACTING, GRIPPING, moving,
    )
    extremes = [FLOAT32_MAX, -FLOAT32_MAX, FLOAT32_LEAST, -0.0, 1.0 / 3.0, -1e-20]
    yield frame("frame_jump", frame_header(flags=KEY | JUMP, epoch=7, tick=2**53 - 1), extremes)
    yield frame(
        "frame_unknown_sections",
        frame_header(flags=KEY | 128, tick=9),
        GRID[0],
        HANDS[:1],
        extra_before=[section(900, 0, b"12345"), section(POSITIONS, 1, floats([NAN]))],
        extra_after=[section(900, 1, b""), section(65535, 65535, b"\xff" * 16)],
    )
    yield mesh("mesh_grid", *GRID)
    yield mesh(
        "mesh_colliders",
        *grid(2, 2),
        colliders=[dict(TETRAHEDRON, collider=1), dict(TETRAHEDRON, collider=4)],
    )
    yield mesh("mesh_unknown_section", *GRID, extra=[section(901, 3, b"x" * 11)])
    yield data("data_f32", "f", 600, 1, 3, [0.1 * i for i in range(15)])
    yield data("data_f64", "d", 2**40, 2**32 - 1, 3, [0.1 * i for i in range(6)])
    yield data("data_scalars", "f", 0, 0, 1, [1.0, 2.0, 3.0])
    yield data("data_nothing", "d", 1, 2, 16, [])


def refused_frames(good):
    """Each breaks one rule and keeps all others, the checksum too."""
    header = frame_header()
    positions = section(POSITIONS, 0, floats([1.0, 2.0, 3.0]))

    def built(*sections, vertices=1, flags=KEY, **more):
        return message(FRAME, frame_body(header, vertices, sections, **more), flags=flags)

    yield "version 0", patched(good, 1, "B", 0)
    yield "version 2", patched(good, 1, "B", 2)
    yield "type of a mesh", patched(good, 0, "B", MESH)
    yield "codec 1", patched(good, 2, "B", 1)
    yield "length too small", patched(good, 4, "I", len(good) - 8)
    yield "length too large", patched(good, 4, "I", len(good) + 8)
    yield "length not a multiple of 8", seal(good + bytes(4))
    yield "checksum A", good[:8] + bytes([good[8] ^ 1]) + good[9:]
    yield "checksum B", good[:15] + bytes([good[15] ^ 128]) + good[16:]
    yield "a word more than the sections", seal(good + bytes(8))
    yield "tick of 2^53", patched(good, 16, "Q", 2**53)
    yield "time is NaN", patched(good, 24, "d", NAN)
    yield "server time is infinite", patched(good, 32, "d", INFINITY)
    yield "another reference", patched(good, 44, "I", 12345)
    yield "a vertex more", patched(good, 52, "I", 2)
    yield "2^32 - 1 vertices", patched(good, 52, "I", 2**32 - 1)
    yield "a step", patched(good, 56, "f", 0.5)
    yield "no section", patched(good, 60, "I", 0)
    yield "a section more", patched(good, 60, "I", 2)
    yield "2^32 - 1 sections", patched(good, 60, "I", 2**32 - 1)
    yield "section too long", patched(good, 68, "I", 17)
    yield "section of 2^32 - 1 bytes", patched(good, 68, "I", 2**32 - 1)
    yield "section too short", patched(good, 68, "I", 8)
    yield "not key", built(positions, flags=0)
    yield "no positions", built(section(APPLIED, 0, applied_bytes(APPLIED_NUMBERS)))
    yield "positions twice", built(positions, positions)
    yield "unknown kind twice", built(positions, section(900, 1, b""), section(900, 1, b""))
    yield "padding not zero", built(positions[:-1] + b"\1")
    yield "position is NaN", built(section(POSITIONS, 0, floats([1.0, NAN, 3.0])))
    yield "position is infinite", built(section(POSITIONS, 0, floats([1.0, 2.0, -INFINITY])))
    yield "a hand cut off", built(positions, section(GRABS, 0, grab_bytes(HANDS)[:-4]))
    bad_hand = dict(HANDS[0], held=[NAN, 0.0, 0.0])
    yield "a hand is NaN", built(positions, section(GRABS, 0, grab_bytes([bad_hand])))
    yield "a pose cut off", built(positions, section(POSES, 0, pose_bytes(MOVED)[:-4]))
    bad_pose = dict(MOVED[0], rotation=[0.0, 0.0, INFINITY, 1.0])
    yield "a pose is infinite", built(positions, section(POSES, 0, pose_bytes([bad_pose])))
    touching = section(CONTACTS, 0, contact_bytes(TOUCHING)[:-4])
    yield "a contact cut off", built(positions, touching)
    bad_contact = dict(TOUCHING[0], gap=NAN)
    yield "a gap is NaN", built(positions, section(CONTACTS, 0, contact_bytes([bad_contact])))
    bad_contact = dict(TOUCHING[0], friction=[0.0, 0.0, INFINITY])
    yield "a friction is infinite", built(
        positions, section(CONTACTS, 0, contact_bytes([bad_contact]))
    )
    reacting = section(REACTIONS, 0, reaction_bytes(REACTING)[:-8])
    yield "a reaction cut off", built(positions, reacting)
    bad_reaction = dict(REACTING[0], force=[-INFINITY, 0.0, 0.0])
    yield "a force is infinite", built(
        positions, section(REACTIONS, 0, reaction_bytes([bad_reaction]))
    )
    gripping = section(GRIPPERS, 0, gripper_bytes(GRIPPING)[:-8])
    yield "a gripper cut off", built(positions, gripping)
    bad_gripper = dict(GRIPPING[0], opening=NAN)
    yield "an opening is NaN", built(positions, section(GRIPPERS, 0, gripper_bytes([bad_gripper])))
    slow = floats([0.5] * (len(GRID[0]) - 3))
    yield "velocities of too few", built(positions, section(VELOCITIES, 0, slow))
    fast = floats([INFINITY] + [0.5] * (len(GRID[0]) - 1))
    yield "a velocity is infinite", built(positions, section(VELOCITIES, 0, fast))
    yield "applied cut off", built(positions, section(APPLIED, 0, b"\0" * 12))


def refused_meshes(good):
    rest, triangles, uv = GRID
    tetrahedron = dict(TETRAHEDRON, collider=1)

    def built(**changes):
        parts = dict(rest=rest, triangles=triangles, uv=uv, colliders=[])
        parts.update(changes)
        return message(MESH, mesh_body(**parts))

    yield "version 2", patched(good, 1, "B", 2)
    yield "type of a frame", patched(good, 0, "B", FRAME)
    yield "codec 1", patched(good, 2, "B", 1)
    yield "2^32 - 1 vertices", patched(good, 16, "I", 2**32 - 1)
    yield "2^32 - 1 triangles", patched(good, 20, "I", 2**32 - 1)
    yield "a triangle less", patched(good, 20, "I", len(triangles) // 3 - 1)
    yield "2^32 - 1 sections", patched(good, 28, "I", 2**32 - 1)
    yield "index is the number of vertices", built(triangles=[0, 1, 6] + triangles[3:])
    yield "rest position is NaN", built(rest=[NAN] + rest[1:])
    yield "uv is infinite", built(uv=[INFINITY] + uv[1:])
    yield "uv too short", built(uv=uv[:-1])
    yield "no triangles", message(
        MESH,
        integers((6, 0, 0, 2)) + section(REST, 0, floats(rest)) + section(UV, 0, floats(uv)),
    )
    yield "a collider promised", built(collider_count=1)
    yield "a collider too many", built(colliders=[tetrahedron], collider_count=0)
    yield "collider index too large", built(colliders=[dict(tetrahedron, triangles=[0, 1, 4])])
    yield "collider position is NaN", built(
        colliders=[dict(tetrahedron, positions=[NAN] + tetrahedron["positions"][1:])]
    )
    yield "collider with half a triangle", built(colliders=[dict(tetrahedron, triangles=[0, 1])])
    corners = section(COLLIDER_POSITIONS, 1, floats(TETRAHEDRON["positions"]))
    faces = section(COLLIDER_TRIANGLES, 1, integers(TETRAHEDRON["triangles"]))
    other = section(COLLIDER_TRIANGLES, 2, integers(TETRAHEDRON["triangles"]))
    yield "collider without triangles", built(extra=[corners], collider_count=1)
    yield "collider without positions", built(extra=[faces], collider_count=1)
    yield "collider with another's triangles", built(extra=[corners, other], collider_count=1)


def refused_data(good):
    yield "version 2", patched(good, 1, "B", 2)
    yield "codec 2", patched(good, 2, "B", 2)
    yield "f32 read as f64", patched(good, 2, "B", 1)
    yield "tick of 2^64 - 1", patched(good, 16, "Q", 2**64 - 1)
    yield "a row more", patched(good, 28, "I", 6)
    yield "2^32 - 1 rows", patched(good, 28, "I", 2**32 - 1)
    yield "no components", patched(good, 32, "I", 0)
    yield "17 components", patched(good, 32, "I", 17)
    yield "2^32 - 1 components", patched(good, 32, "I", 2**32 - 1)
    yield "reserved is not 0", patched(good, 36, "I", 1)
    yield "padding not zero", patched(good, len(good) - 1, "B", 1)
    yield "value is NaN", patched(good, 40, "f", NAN)
    yield "8 bytes more", seal(good + bytes(8))


def refused(messages):
    for kind, cases, base in (
        ("frame", refused_frames, "frame_one_vertex"),
        ("mesh", refused_meshes, "mesh_grid"),
        ("data", refused_data, "data_f32"),
    ):
        for rule, content in cases(messages[base]):
            yield {"type": kind, "rule": rule, "hex": content.hex()}


def write_json(path, value):
    path.write_text(json.dumps(value, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


def main(folder):
    folder.mkdir(parents=True, exist_ok=True)
    messages, contents = {}, {}
    for name, content, description in accepted():
        messages[name], contents[name] = content, description
        (folder / f"{name}.bin").write_bytes(content)
    (folder / "ack.bin").write_bytes(struct.pack("<BBHI", ACK, 1, 0, 2**32 - 2))
    write_json(folder / "binary.json", contents)
    write_json(folder / "refused_binary.json", list(refused(messages)))
    packed.write(folder)
    write_json(folder / "accepted_commands.json", commands.ACCEPTED)
    write_json(folder / "refused_commands.json", refusals.refused())
    write_json(folder / "client_calls.json", calls.CLIENT_CALLS)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
