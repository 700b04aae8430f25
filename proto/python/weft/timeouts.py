"""How long calls wait for their answers."""

import math

CALL_SECONDS = 30.0  # for an answer or a frame
# For an answer to what builds a scene.
SCENE_SECONDS: dict[str, float] = dict.fromkeys(("load", "create_room", "fork"), 300.0)
REFUSAL_SECONDS = 2.0  # for why a server refuses a connection
GOODBYE_SECONDS = 0.1  # for each part of a goodbye to a server that did not begin
CLOSE_SECONDS = 1.0  # for each of the three parts of a goodbye, at most: a server that hangs answers none
ADVANCE_SECONDS, ADVANCE_TICK_SECONDS = 60.0, 1.0  # for an answer to `advance`, and more for each tick

# This very object as the timeout of a call means the client's `call_timeout`; so a checker sees a number there.
CLIENTS: float = -math.inf
