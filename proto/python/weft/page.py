"""The page of a server within a notebook."""

import html
from urllib.parse import unquote, urlencode, urlsplit

from .address import socket_address, token_of


class Page:
    """Shows a server's live page where the last value of a cell is displayed: see it and hold the cloth there.

    `url` is the server's address, that of its page or of a room's socket; the browser that shows the notebook opens it.
    """

    def __init__(self, url: str, *, height: int = 480):
        parts = urlsplit(socket_address(url))
        scheme = {"ws": "http", "wss": "https"}[parts.scheme]
        folder, _, room = (parts.path + "/").partition("/ws/")
        told = {"token": token_of(url), "room": unquote(room.strip("/"))}
        fragment = urlencode({name: value for name, value in told.items() if value})
        self.url = parts._replace(scheme=scheme, path=folder + "/", query="", fragment=fragment).geturl()
        self.height = height  # [pixels]

    def _repr_html_(self) -> str:
        return f'<iframe src="{html.escape(self.url)}" width="100%" height="{self.height}" style="border: 0"></iframe>'
