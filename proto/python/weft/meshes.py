"""Meshes: what is constant during an epoch."""

from __future__ import annotations

from typing import Any

from . import layout
from .errors import ProtocolError
from .order import read_order
from .reading import demand, read_common, read_sections, rows_of
from .samples import ColliderMesh, MeshData


def _triangles(payload: memoryview | None, count: int, vertices: int) -> Any:
    rows = rows_of(payload, "I", count, 3)
    demand(max((payload or memoryview(b"")).cast("I"), default=-1) < vertices, "an index is out of range")
    return rows


def _collider(sections: dict[tuple[int, int], memoryview], index: int) -> ColliderMesh:
    corners = sections[layout.COLLIDER_POSITIONS, index]
    faces = sections.get((layout.COLLIDER_TRIANGLES, index))
    if faces is None:
        raise ProtocolError("a collider has no triangles")
    vertices = len(corners) // 12
    positions = rows_of(corners, "f", vertices, 3)
    return ColliderMesh(index, positions, _triangles(faces, len(faces) // 12, vertices))


def decode_mesh(message: bytes) -> MeshData:
    start = layout.COMMON.size + layout.MESH_FIELDS.size
    read_common(message, layout.MESH, start, 0)
    fields = layout.MESH_FIELDS.unpack_from(message, layout.COMMON.size)
    vertices, triangles, collider_meshes, count = fields
    sections = read_sections(message, start, count)
    indices = sorted(index for kind, index in sections if kind == layout.COLLIDER_POSITIONS)
    faces = sum(kind == layout.COLLIDER_TRIANGLES for kind, _ in sections)
    promised = len(indices) == collider_meshes and faces == collider_meshes
    demand(promised, "the number of collider meshes does not fit")
    return MeshData(
        rest_positions=rows_of(sections.get((layout.REST, 0)), "f", vertices, 3),
        triangles=_triangles(sections.get((layout.TRIANGLES, 0)), triangles, vertices),
        uv=rows_of(sections.get((layout.UV, 0)), "f", vertices, 2),
        colliders=tuple(_collider(sections, index) for index in indices),
        order=_order_rows(sections.get((layout.ORDER, 0)), vertices),
    )


def _order_rows(payload: memoryview | None, vertices: int) -> Any:
    """Checked too: each vertex once, each neighbour before."""
    if payload is None:
        return None
    rows = rows_of(payload, "I", vertices, 4)
    read_order(rows)
    return rows
