"""Addresses of servers."""

from urllib.parse import parse_qs, quote, urlsplit

from .errors import WeftError


def token_of(link: str) -> str | None:
    """The token that a link to the page tells in its fragment, #token=…"""
    try:
        return parse_qs(urlsplit(link).fragment).get("token", [None])[0]
    except ValueError:  # no link at all, which `socket_address` tells
        return None


def socket_address(url: str) -> str:
    """The address of a server's socket; the argument may be that of its page, with #room=… for a room."""
    scheme = {"http": "ws", "https": "wss"}
    try:
        parts = urlsplit(url)
        known = parts.scheme in ("ws", "wss", *scheme) and parts.hostname and parts.port != 0
    except ValueError:  # an invalid port
        parts, known = urlsplit(""), False
    if not known:
        raise WeftError(f"{url!r} is no address of a server: give one as ws://127.0.0.1:8080/ws, or that of its page")
    path = parts.path if parts.path not in ("", "/") else "/ws"
    room = parse_qs(parts.fragment).get("room", [""])[0]
    if room and path == "/ws":
        path += "/" + quote(room, safe="")
    return parts._replace(scheme=scheme.get(parts.scheme, parts.scheme), path=path, fragment="").geturl()
