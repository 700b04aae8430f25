"""Pictures of a frame without a window: triangles into a buffer of depths, in numpy."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..announcement import Collider, Mesh
from ..frame_parts import Pose
from ..samples import Frame, MeshData

BACKGROUND, OBJECT, CLOTH, BACK = (236, 238, 242), (150, 155, 165), (42, 111, 151), (224, 122, 95)
LIGHT = np.array([0.4, 0.8, 0.45]) / np.linalg.norm([0.4, 0.8, 0.45])
AMBIENT = 0.35  # part of the light that comes from everywhere
FIELD = np.radians(35)  # vertical angle of view
MARGIN = 1.2  # of the picture beside what is looked at
NEAR = 1e-3  # nothing nearer is drawn [m]


def colour_of(text: str | None, usual: tuple[int, int, int]) -> Any:
    """Red, green and blue of "#rrggbb"."""
    return np.array([int(text[k : k + 2], 16) for k in (1, 3, 5)] if text else usual, float)


def rotated(rotation: Any, points: Any) -> Any:
    """Points turned by a unit quaternion x, y, z, w."""
    axis, w = np.array(rotation[:3]), rotation[3]
    return points + 2 * np.cross(axis, np.cross(axis, points) + w * points)


def box_of(half: Any) -> tuple[Any, Any]:
    """Corners and triangles of a box about the origin; each side has corners of its own."""
    sides, triangles = [], []
    for axis in range(3):
        for sign in (-1, 1):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                corner = np.zeros(3)
                corner[axis], corner[u], corner[v] = sign, a * sign, b
                sides.append(corner * half)
            first = len(sides) - 4
            triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return np.array(sides), np.array(triangles)


def ball_of(radius: float, a: Any, b: Any) -> tuple[Any, Any]:
    """A capsule between two points, or a sphere where they are one."""
    up = np.array(b, float) - np.array(a, float)
    length = np.linalg.norm(up)
    up = up / length if length > 0 else np.array([0.0, 1, 0])
    side = np.cross(up, [1, 0, 0] if abs(up[0]) < 0.9 else [0, 0, 1])
    side /= np.linalg.norm(side)
    across, rows, around = np.cross(up, side), 12, 20
    points = []
    for i in range(rows + 1):
        angle = np.pi * i / rows - np.pi / 2
        middle = np.array(b if angle > 0 else a, float)
        for j in range(around):
            turn = 2 * np.pi * j / around
            flat = np.cos(turn) * side + np.sin(turn) * across
            points.append(middle + radius * (np.sin(angle) * up + np.cos(angle) * flat))
    at = lambda i, j: i * around + j % around  # noqa: E731
    triangles = []
    for i in range(rows):
        for j in range(around):
            triangles += [(at(i, j), at(i + 1, j), at(i, j + 1)), (at(i, j + 1), at(i + 1, j), at(i + 1, j + 1))]
    return np.array(points), np.array(triangles)


def solid_of(collider: Collider, index: int, data: MeshData) -> tuple[Any, Any] | None:
    """Vertices and triangles of an object as it is defined; None for a plane, which has no end."""
    kind = collider["kind"]
    if kind == "box":
        points, triangles = box_of(np.array(collider.get("half_extents", [1, 1, 1])))
        placed = rotated(collider.get("orientation", [0, 0, 0, 1]), points)
        return placed + np.array(collider.get("center", [0, 0, 0])), triangles
    if kind == "sphere":
        center = collider.get("center", [0, 0, 0])
        return ball_of(collider.get("radius", 1), center, center)
    if kind == "capsule":
        return ball_of(collider.get("radius", 1), collider.get("a", [0, 0, 0]), collider.get("b", [0, 1, 0]))
    shape = next((part for part in data.colliders if part.collider == index), None)
    return None if shape is None else (np.asarray(shape.positions, float), np.asarray(shape.triangles, int))


class Picture:
    """Draws the frames of one mesh from where its scene is best looked at; `size` is rows and columns of pixels."""

    def __init__(self, mesh: Mesh, data: MeshData, size: tuple[int, int]):
        self._triangles, self._size = np.asarray(data.triangles, int), size
        solids = ((collider, solid_of(collider, k, data)) for k, collider in enumerate(mesh["colliders"]))
        self._solids = [(np.array(c["pivot"]), s) for c, s in solids]
        self._colours = np.zeros((2, len(self._triangles), 3))
        for cloth in mesh["cloths"]:
            look, first = cloth.get("look", {}), cloth["first_triangle"]
            part = slice(first, first + cloth["triangles"])
            self._colours[0, part] = colour_of(look.get("color"), CLOTH)
            self._colours[1, part] = colour_of(look.get("back"), BACK)
        rest = np.asarray(data.rest_positions, float)
        middle = (rest.max(axis=0) + rest.min(axis=0)) / 2
        view = mesh.get("view")
        target, towards = (view["target"], view["direction"]) if view else (middle, [0, 0.4, 1])
        radius = view["radius"] if view else float(np.ptp(rest, axis=0).max())
        self._look_from(np.array(target, float), np.array(towards, float), radius)

    def _look_from(self, target: Any, towards: Any, radius: float) -> None:
        back = towards / np.linalg.norm(towards)
        right = np.cross([0.0, 1, 0] if abs(back[1]) < 0.999 else [0.0, 0, 1], back)
        right /= np.linalg.norm(right)
        self._axes = np.stack([right, np.cross(back, right), back])
        self._eye = target + back * MARGIN * radius / np.sin(FIELD / 2)

    def of(self, frame: Frame) -> Any:
        """Rows of pixels, each red, green and blue as a byte."""
        image = np.full((*self._size, 3), BACKGROUND, np.uint8)
        depths = np.full(self._size, np.inf)
        for index, (pivot, solid) in enumerate(self._solids):
            if solid is not None:
                points, triangles = solid
                pose: Pose | None = frame.poses.get(index)
                if pose is not None:
                    points = rotated(pose.rotation, points - pivot) + np.array(pose.position)
                colours = np.broadcast_to(np.array(OBJECT, float), (2, len(triangles), 3))
                self._draw(image, depths, points, triangles, colours)
        self._draw(image, depths, np.asarray(frame.positions, float), self._triangles, self._colours)
        return image

    def _draw(self, image: Any, depths: Any, points: Any, triangles: Any, colours: Any) -> None:
        """Each triangle in its own colour, lit from both sides; the nearest at a pixel stays."""
        seen = (points - self._eye) @ self._axes.T
        depth = np.maximum(-seen[:, 2], NEAR)
        scale = self._size[0] / (2 * np.tan(FIELD / 2))
        screen = np.stack([self._size[1] / 2 + scale * seen[:, 0] / depth,
                           self._size[0] / 2 - scale * seen[:, 1] / depth], axis=1)
        corners = points[triangles]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
        behind = np.einsum("ij,ij->i", normals, self._eye - corners[:, 0]) < 0
        light = AMBIENT + (1 - AMBIENT) * np.abs(normals @ LIGHT)
        shaded = np.clip(colours[behind.astype(int), np.arange(len(triangles))] * light[:, None], 0, 255).astype(np.uint8)
        visible = (-seen[:, 2])[triangles].min(axis=1) > NEAR
        for k in np.flatnonzero(visible):
            self._fill(image, depths, screen[triangles[k]], depth[triangles[k]], shaded[k])

    def _fill(self, image: Any, depths: Any, corners: Any, depth: Any, colour: Any) -> None:
        rows, columns = self._size
        low = np.maximum(np.ceil(corners.min(axis=0) - 0.5).astype(int), 0)
        high = np.minimum(np.floor(corners.max(axis=0) - 0.5).astype(int) + 1, (columns, rows))
        if (high <= low).any():
            return
        (ax, ay), (bx, by), (cx, cy) = corners
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if area == 0:
            return
        x = np.arange(low[0], high[0]) + 0.5
        y = (np.arange(low[1], high[1]) + 0.5)[:, None]
        b = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / area
        c = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / area
        a = 1 - b - c
        near = 1 / (a / depth[0] + b / depth[1] + c / depth[2])  # depth is linear in its inverse on the screen
        part = np.s_[low[1] : high[1], low[0] : high[0]]
        shown = (a >= 0) & (b >= 0) & (c >= 0) & (near < depths[part])
        depths[part][shown] = near[shown]
        image[part][shown] = colour
