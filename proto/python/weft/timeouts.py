"""How long calls wait for their answers."""

CALL_SECONDS = 30.0  # for an answer or a frame
LOAD_SECONDS = 300.0  # for an answer to `load`
ADVANCE_SECONDS, ADVANCE_TICK_SECONDS = 60.0, 1.0  # for an answer to `advance`, and more for each tick


CLIENTS = object()  # timeout of a call that means the client's
