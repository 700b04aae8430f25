"""What this package raises."""

from __future__ import annotations

from typing import Any


class WeftError(Exception):
    """Anything that this module raises."""


class ProtocolError(WeftError):
    """Bytes that do not form a message of weft.v1."""


class ConnectionLost(WeftError):
    """The connection ended before the answer arrived, or there is none."""

    def __init__(self, code: int, reason: str):
        super().__init__(f"{code} {reason}".strip())
        self.code, self.reason = code, reason


class CallTimeout(WeftError, TimeoutError):
    """An answer did not arrive in time. The command may have been executed, or may still be."""

    def __init__(self, command: str, seconds: float):
        super().__init__(f"{command}: no answer within {seconds:g} s")
        self.command, self.seconds = command, seconds


def _limit_text(limit: dict) -> str:
    """The allowed values, in words."""
    least, most = limit.get("minimum"), limit.get("maximum")
    if "allowed" in limit:
        return "allowed: " + ", ".join(limit["allowed"])
    if "length" in limit:
        return f"allowed: {limit['length']} elements"
    if least is not None and most is not None:
        return f"allowed: {least:g} to {most:g}"
    return f"allowed: at most {most:g}" if most is not None else ""


class CommandError(WeftError):
    """The server refused a command; the fields are those of its `error` message."""

    def __init__(self, message: dict):
        details = [f"field: {message['field']}" if message.get("field") else ""]
        text = message.get("message", "")
        told = " must be " in text or " must have " in text  # and what is allowed stands behind it
        details += ["" if told else _limit_text(message.get("limit") or {}), message.get("hint") or ""]
        super().__init__("; ".join(part for part in (message.get("message", ""), *details) if part))
        self.code: str = message.get("code", "internal")
        self.command: str | None = message.get("command")
        self.field: str | None = message.get("field")
        self.value: Any = message.get("value")
        self.limit: dict | None = message.get("limit")
        self.hint: str | None = message.get("hint")
