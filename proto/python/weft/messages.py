"""Parts of messages, and messages of the server. Written by proto/generate.py from proto/messages."""

from collections.abc import Sequence
from typing import Any, Literal, NotRequired, TypedDict


class Fan(TypedDict):
    """`Fan`, as part of a message."""

    position: Sequence[float]  # centre of the disc that its air leaves [m]; 3 × ±10000
    direction: Sequence[float]  # of the jet, any length but 0; 3 × ±10000
    speed: NotRequired[float]  # in the core of the jet [m/s]; 0 to 50
    radius: NotRequired[float]  # of the disc [m]; 0.01 to 10
    spread: NotRequired[float]  # growth of the jet's radius per distance; 0 to 2
    reach: NotRequired[float]  # length of the core [m]; 0.01 to 100


class Fabric(TypedDict):
    """`Fabric`, as part of a message."""

    preset: NotRequired[str]  # all values of this one; 1 to 64 bytes
    areal_density: NotRequired[float]  # mass per area [kg/m²]; 0.001 to 100
    stretch_warp: NotRequired[float]  # stiffness along u [N/m]; 0 to 1 000 000
    stretch_weft: NotRequired[float]  # stiffness along v [N/m]; 0 to 1 000 000
    shear: NotRequired[float]  # stiffness [N/m]; 0 to 1 000 000
    poisson: NotRequired[float]  # of a mesh: narrowing along v per strain along u; -1: as on a grid; -1 to 100
    bending_warp: NotRequired[float]  # rigidity along u [N m]; 0 to 10
    bending_weft: NotRequired[float]  # rigidity along v [N m]; 0 to 10
    locking_strain: NotRequired[float]  # from which a thread is stiffer; 0: none; 0 to 10
    locking_factor: NotRequired[float]  # how many times as stiff it then is; 1 to 1000
    damping_ratio: NotRequired[float]  # of the highest mode of stretch; 0 to 1
    stretch_damping: NotRequired[float]  # relaxation time [s]; 0 to 10
    shear_damping: NotRequired[float]  # relaxation time [s]; 0 to 10
    bending_damping: NotRequired[float]  # relaxation time [s]; 0 to 10
    thickness: NotRequired[float]  # distance from objects in contact [m]; 0.0001 to 0.1
    friction: NotRequired[float]  # Coulomb's coefficient; 0 to 10
    restitution: NotRequired[float]  # of the impact velocity; 0 to 0.999
    air_normal: NotRequired[float]  # drag coefficient across the wind; 0 to 100
    air_tangential: NotRequired[float]  # skin friction along the wind [kg/(m² s)]; 0 to 100


class Camera(TypedDict):
    """`Camera`, as part of a message."""

    position: Sequence[float]  # of the eye [m]; 3 × ±10000
    target: Sequence[float]  # what it looks at; not the same point [m]; 3 × ±10000
    up: NotRequired[Sequence[float]]  # a direction; 3 × ±10000
    fov: NotRequired[float]  # vertical angle of view [degrees]; 1 to 179


class Hit(TypedDict):
    """`Hit`, as part of a message."""

    triangle: int  # to hold it at a point of this triangle; 0 to 2147483647
    barycentric: Sequence[float]  # of that point; sum 1 within 0.001; 3 × 0 to 1
    position: Sequence[float]  # of the point [m]
    particle: int  # its nearest corner
    distance: float  # along the ray [m]


class RoomInfo(TypedDict):
    """`RoomInfo`, as part of a message."""

    name: str  # of the address /ws/name
    scene: str  # its name
    particles: int  # of all cloths
    viewers: int  # connected
    tick: int  # of its present state
    paused: bool  # whether it is; true or false
    real_time_factor: float  # simulated per real time; 0 while its time stands


class Sleeping(TypedDict):
    """`Sleeping`, as part of a message."""

    islands: int  # groups of touching cloths that sleep and wake together
    cloths: list[str]  # by name; no frames are sent while all of them rest


class Guarantee(TypedDict):
    """`Guarantee`, as part of a message."""

    # whether the promise of no crossings holds; held or bad_start or void or none
    state: Literal["held", "bad_start", "void", "none"]
    covers: list[str]  # objects, cloth or both
    pairs: int  # of features, without a promise
    reasons: list[str]  # in words; none if the promise holds


class Crossings(TypedDict):
    """`Crossings`, as part of a message."""

    count: int  # edges of cloth that pass through something
    tick: int  # of the count
    smallest_gap: float | None  # least contact distance then, negative inside an object; null: nothing is near [m]


class Strain(TypedDict):
    """`Strain`, as part of a message."""

    largest: float  # of an edge, relative
    p99: float  # which one edge in a hundred exceeds


class Energy(TypedDict):
    """`Energy`, as part of a message."""

    kinetic: float
    stretch: float  # of the membrane [J]
    bending: float
    gravity: float  # above the height 0 [J]
    total: float


class EnergyWork(TypedDict):
    """`EnergyWork`, as part of a message."""

    hands: float
    slings: float
    pins: float  # moving ones, and pins that stop what they take hold of [J]
    objects: float  # moving ones [J]
    grippers: float  # their jaws [J]
    wind: float  # force of the air times the speed of the air [J]
    push_out: float  # contact: positions corrected without a velocity [J]
    disturbances: float  # of the scene [J]
    commands: float  # other gravity, softness or fabric, pins that stop [J]


class EnergyLosses(TypedDict):
    """`EnergyLosses`, as part of a message."""

    damping: float  # of the fabric [J]
    drag: float  # of the scene [J]
    air: float  # its resistance [J]
    friction: float  # of objects [J]
    impacts: float  # on objects [J]
    self_contact: float  # of cloth with cloth, with friction [J]
    sleep: float  # motion of cloth that fell asleep [J]
    recovery: float  # of cloth that was stopped, as it diverged [J]
    solver: float  # what no cause explains; negative: brought by it [J]


class EnergyBalance(TypedDict):
    """`EnergyBalance`, as part of a message."""

    since: int  # tick at whose end measuring began
    start: float  # total then [J]
    work: EnergyWork  # of what acts on the cloth
    losses: EnergyLosses  # to what takes energy from it
    now: float  # total [J]


class PinForce(TypedDict):
    """`PinForce`, as part of a message."""

    pin: int  # its id
    force: Sequence[float]  # on the cloth [N]


class GrabForce(TypedDict):
    """`GrabForce`, as part of a message."""

    grab: int  # its number
    viewer: int  # its owner
    force: Sequence[float]  # on the cloth [N]


class ColliderForce(TypedDict):
    """`ColliderForce`, as part of a message."""

    collider: str  # its name
    force: Sequence[float]  # of the cloth on it [N]


class Viewer(TypedDict):
    """`Viewer`, as part of a message."""

    id: int  # its number
    name: str
    color: str  # #rrggbb
    role: Literal["viewer", "operator", "admin"]  # what it may do; viewer or operator or admin
    hand: bool  # whether it may hold the cloth; true or false
    camera: Camera | None  # where it looks from, as last told


class Presence(TypedDict):
    """`Presence`, as part of a message."""

    viewer: int  # of which something is new
    cursor: NotRequired[Sequence[float]]  # what it points at [m]
    away: NotRequired[bool]  # it points at nothing any more; true or false
    camera: NotRequired[Camera]  # where it looks from; only while others see by it
    follows: NotRequired[int]  # by whose camera it sees now; 0: its own


class Pin(TypedDict):
    """`Pin`, as part of a message."""

    id: int
    viewer: int  # its owner; 0: the scene
    particle: int  # the centre of its disc
    radius: float  # of the disc [m]
    position: Sequence[float]  # of its particle [m]
    count: int  # particles that it holds
    target: NotRequired[Sequence[float]]  # of a moving pin [m]
    behind: NotRequired[bool]  # whether its particles lag behind; true or false


class Grab(TypedDict):
    """`Grab`, as part of a message."""

    id: int  # the room's number
    viewer: int  # its owner; 0: the scene
    drag: int  # the owner's number
    triangle: int  # to hold it at a point of this triangle; 0 to 2147483647
    barycentric: Sequence[float]  # of that point; sum 1 within 0.001; 3 × 0 to 1
    radius: float  # of the held disc [m]
    stiffness: float
    max_force: float
    held: Sequence[float]  # the point of the cloth [m]
    target: Sequence[float]  # where it is pulled to [m]
    mode: Literal["live", "sling"]
    force: NotRequired[Sequence[float]]  # on the cloth; in answers to query [N]


class StageWork(TypedDict):
    """`StageWork`, as part of a message."""

    stage: str  # of the tick
    milliseconds: float
    work: int  # items done


class Tree(TypedDict):
    """`Tree`, as part of a message."""

    tree: str  # its name
    levels: int  # of boxes


class ColliderPose(TypedDict):
    """`ColliderPose`, as part of a message."""

    name: str
    position: Sequence[float]  # of the pivot [m]
    rotation: Sequence[float]  # relative to the mesh message
    force: Sequence[float]  # of the cloth on it while it moves [N]
    blocked: bool  # held back in the last tick; true or false
    voided: bool  # has moved on through cloth; true or false


class Contact(TypedDict):
    """`Contact`, as part of a message."""

    collider: NotRequired[str]  # absent: the other side is cloth too
    particles: list[int]  # of the cloth
    weights: list[float]  # sum 1; negative on the other side
    point: Sequence[float]  # on the mid-surface [m]
    normal: Sequence[float]  # unit, out of the other side
    gap: float  # from the mid-surface [m]
    normal_force: float  # on the cloth [N]
    friction: Sequence[float]  # on the cloth [N]


class Reactions(TypedDict):
    """`Reactions`, as part of a message."""

    pins: NotRequired[list[PinForce]]  # absent if the solver does not know them
    grabs: list[GrabForce]  # of hands
    colliders: list[ColliderForce]


class GripperState(TypedDict):
    """`GripperState`, as part of a message."""

    name: str
    position: Sequence[float]  # of its middle [m]
    rotation: Sequence[float]  # from its definition
    opening: float  # between its jaws [m]
    force: float  # most that each jaw presses with [N]
    gripping: bool  # it presses something; true or false
    reaction: Sequence[float]  # of the cloth on both jaws [N]
    torque: Sequence[float]  # the same about its middle [N m]


class State(TypedDict):
    """The message `state`."""

    op: Literal["state"]
    tick: int
    time: float  # simulated [s]
    paused: bool
    policy: Literal["watch", "one_hand", "everybody"]  # who may hold the cloth; watch or one_hand or everybody
    speed: float  # simulated time per real time that was asked for
    pace: float  # fraction of speed at which time passes
    softness: float  # fraction of their stiffness that the springs have
    budget_ms: float  # for each tick that is due; 0: no bound [ms]
    over_budget: Literal["slow", "soften"]  # what gives way beyond it; slow or soften
    scene: str  # its name
    tick_rate: float
    gravity: Sequence[float]  # acceleration [m/s²]
    wind: Sequence[float]  # mean velocity [m/s]
    gust_speed: float  # bound of each component of the gusts [m/s]
    gust_length: float  # size of an eddy [m]
    air_density: float
    still_air: bool  # air resists without wind too; true or false
    drag: float  # uniform damping of velocities [1/s]
    fans: list[Fan]  # all local winds
    fabric: str  # names of all cloths' fabrics
    fabrics: list[Fabric]  # of each cloth, every value; without preset if it is of none
    solver: str  # its name
    substeps: int  # of the last tick
    particles: int  # of all cloths
    step_ms: float  # median time of a tick [ms]
    real_time_factor: float  # simulated per real time that is reached
    sleeping: Sleeping  # cloths at rest, which are not stepped
    guarantee: Guarantee  # whether the promise holds that cloth passes through nothing
    crossings: Crossings | None  # as last counted; null before the first count
    strain: Strain  # of the springs
    energy: Energy
    balance: NotRequired[EnergyBalance]  # of energy; while it is measured: see the query balance


class Notice(TypedDict):
    """The message `notice`."""

    op: Literal["notice"]
    level: Literal["info", "warning", "error"]
    code: str  # what has happened
    message: str  # for people
    tick: NotRequired[int]  # when
    viewer: NotRequired[int]  # that caused it
    drag: NotRequired[int]  # of lease_expired
    count: NotRequired[int]  # of frames_dropped
    value: NotRequired[float]  # that holds now


class Bye(TypedDict):
    """The message `bye`."""

    op: Literal["bye"]
    code: int  # the close code that follows
    reason: str  # for people
