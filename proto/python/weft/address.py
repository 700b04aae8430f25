"""Addresses of servers."""

from __future__ import annotations

import json
from http.client import HTTPException
from urllib.error import HTTPError
from urllib.parse import parse_qs, quote, unquote, urlencode, urlsplit
from urllib.request import urlopen

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


def page_address(socket: str, path: str = "", query: str = "") -> tuple[str, str]:
    """The address of a page or another resource beside a socket, and the room that the socket is of, if it names one."""
    parts = urlsplit(socket)
    folder, _, room = (parts.path + "/").partition("/ws/")
    scheme = {"ws": "http", "wss": "https"}[parts.scheme]
    address = parts._replace(scheme=scheme, path=f"{folder}/{path}", query=query, fragment="").geturl()
    return address, unquote(room.strip("/"))


def refusal_of(socket: str, seconds: float) -> str:
    """Why a server refuses a socket of this address now; empty if it does not, or does not tell."""
    _, room = page_address(socket)
    address, _ = page_address(socket, "api/v1/connect", urlencode({"room": room}) if room else "")
    try:
        with urlopen(address, timeout=seconds):
            return ""
    except HTTPError as answer:
        try:
            error = json.loads(answer.read(1 << 16))["error"]
            return "; ".join(str(error[name]) for name in ("message", "hint") if name in error)
        except (ValueError, KeyError, TypeError, OSError, HTTPException):
            return ""
    except (OSError, HTTPException):
        return ""
