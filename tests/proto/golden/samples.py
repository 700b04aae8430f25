"""What golden messages tell, and the bytes of what frames tell beside positions, as proto/README.md
section 6 says."""

import struct


def grab_bytes(grabs):
    return b"".join(
        struct.pack("<II7f", g["id"], g["viewer"], *g["held"], *g["target"], g["force"])
        for g in grabs
    )


def applied_bytes(applied):
    return b"".join(struct.pack("<II", a["viewer"], a["number"]) for a in applied)


def pose_bytes(poses):
    return b"".join(
        struct.pack("<I7f", p["collider"], *p["position"], *p["rotation"]) for p in poses
    )


def contact_bytes(contacts):
    return b"".join(
        struct.pack(
            "<II11f",
            2**32 - 1 if c["collider"] is None else c["collider"],
            c["particle"],
            *c["point"],
            *c["normal"],
            c["gap"],
            c["normal_force"],
            *c["friction"],
        )
        for c in contacts
    )


def reaction_bytes(reactions):
    places = {"pin": 0, "collider": 1}
    return b"".join(
        struct.pack("<II3f", places.get(r["of"], r["of"]), r["id"], *r["force"])
        for r in reactions
    )


def gripper_bytes(grippers):
    return b"".join(
        struct.pack(
            "<II15f",
            g["jaw"],
            g["gripping"],
            *g["position"],
            *g["rotation"],
            g["opening"],
            g["force"],
            *g["reaction"],
            *g["torque"],
        )
        for g in grippers
    )


HANDS = [
    dict(id=17, viewer=3, held=[0.1, 0.9, 0.2], target=[0.2, 1.1, 0.4], force=12.5),
    dict(id=4294967295, viewer=4, held=[0.0, 0.0, 0.0], target=[-1e4, 1e4, 0.0], force=50.0),
]
MOVED = [
    dict(collider=0, position=[0.1, -0.2, 0.3], rotation=[0.0, 0.6, 0.0, 0.8]),
    dict(collider=65535, position=[-1000.0, 1000.0, 0.0], rotation=[0.5, -0.5, 0.5, -0.5]),
]
APPLIED_NUMBERS = [dict(viewer=3, number=41), dict(viewer=4, number=1), dict(viewer=9, number=7)]


TOUCHING = [
    dict(
        collider=2,
        particle=5,
        point=[0.1, 0.004, -0.3],
        normal=[0.0, 1.0, 0.0],
        gap=0.004,
        normal_force=0.0123,
        friction=[0.002, 0.0, -0.001],
    ),
    dict(
        collider=None,
        particle=0,
        point=[1.5, -2.0, 1e-3],
        normal=[0.6, 0.0, -0.8],
        gap=0.0,
        normal_force=0.0,
        friction=[0.0, 0.0, 0.0],
    ),
]
REACTING = [
    dict(of="pin", id=7, force=[0.1, 0.98, -0.2]),
    dict(of="collider", id=0, force=[0.0, -0.5, 0.0]),
    dict(of=77, id=3, force=[1.0, 2.0, 3.0]),
]

GRIPPING = [
    dict(
        jaw=4,
        gripping=True,
        position=[0.28, 0.9, 0.0],
        rotation=[0.0, 0.6, 0.0, 0.8],
        opening=0.008,
        force=5.0,
        reaction=[0.1, -0.8, 0.0],
        torque=[0.02, 0.0, -0.03],
    ),
    dict(
        jaw=6,
        gripping=False,
        position=[-1000.0, 1e-3, 1000.0],
        rotation=[0.0, 0.0, 0.0, 1.0],
        opening=1.0,
        force=0.0,
        reaction=[0.0, 0.0, 0.0],
        torque=[0.0, 0.0, 0.0],
    ),
]


def grid(rows, columns):
    """Rest positions, triangles and uv of a small grid."""
    rest, uv, triangles = [], [], []
    for r in range(rows):
        for c in range(columns):
            rest += [0.1 * c, 1.5 - 0.1 * r, 0.0]
            uv += [c / (columns - 1), r / (rows - 1)]
    for r in range(rows - 1):
        for c in range(columns - 1):
            i = r * columns + c
            triangles += [i, i + columns, i + 1, i + 1, i + columns, i + columns + 1]
    return rest, triangles, uv


GRID = grid(2, 3)
TETRAHEDRON = dict(
    positions=[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
    triangles=[0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3],
)
