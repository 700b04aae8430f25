"""Messages of the server that are not among the generated ones: who is here, and what is simulated."""

from typing import Literal, NotRequired, TypedDict

from .messages import Grab, Pin, Viewer

Vec3 = list[float]  # of three


class Limits(TypedDict):
    """What a server allows."""

    message_bytes: int
    messages_per_second: float
    viewers: int
    drags_per_viewer: int
    drags: int
    pins: int
    step_ticks: int
    advance_ticks: int
    lease_seconds: float
    frames_in_flight: int


class Welcome(TypedDict):
    """The first message."""

    op: Literal["welcome"]
    protocol: str
    server: str
    version: str
    session: str  # new for each process of the server
    viewer: int  # own number
    name: str
    color: str
    role: Literal["viewer", "operator", "admin"]
    room: str
    scene: str
    tick_rate: float  # [Hz]
    clock: float  # the server's [s]
    codecs: list[str]
    limits: Limits
    capabilities: list[str]


class Look(TypedDict):
    """How the author of a cloth wants it drawn; colours are "#rrggbb"."""

    fabric: NotRequired[str]
    color: NotRequired[str]
    back: NotRequired[str]


class Cloth(TypedDict):
    """A range of vertices and triangles."""

    name: str
    first_vertex: int
    vertices: int
    first_triangle: int
    triangles: int
    rows: NotRequired[int]  # of a grid: particle (r, c) is vertex first_vertex + r * columns + c
    columns: NotRequired[int]
    thickness: float  # [m]
    look: NotRequired[Look]


class Collider(TypedDict):
    """An object that cloth meets; which of the others it has follows from its kind."""

    name: str
    kind: Literal["plane", "sphere", "capsule", "box", "mesh"]
    pivot: Vec3  # what a pose places and turns it about [m]
    point: NotRequired[Vec3]
    normal: NotRequired[Vec3]
    center: NotRequired[Vec3]
    radius: NotRequired[float]
    a: NotRequired[Vec3]
    b: NotRequired[Vec3]
    half_extents: NotRequired[Vec3]
    orientation: NotRequired[list[float]]  # x, y, z, w
    vertices: NotRequired[int]
    triangles: NotRequired[int]


class View(TypedDict):
    """A sphere that should fill the first picture, and the side that it is seen from."""

    target: Vec3
    direction: Vec3
    radius: float


class Mesh(TypedDict):
    """What is simulated and what it can touch."""

    op: Literal["mesh"]
    epoch: int
    scene: str
    hash: str
    url: str
    bytes: int
    vertices: int
    triangles: int
    cloths: list[Cloth]
    colliders: list[Collider]
    view: NotRequired[View]


class Roster(TypedDict):
    """The viewers."""

    op: Literal["roster"]
    viewers: list[Viewer]


class Pins(TypedDict):
    """All pins."""

    op: Literal["pins"]
    tick: int
    pins: list[Pin]


class Grabs(TypedDict):
    """All hands that hold the cloth."""

    op: Literal["grabs"]
    tick: int
    grabs: list[Grab]
