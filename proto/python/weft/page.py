"""The page of a server within a notebook."""

import html
from urllib.parse import urlencode

from .address import page_address, socket_address, token_of


class Page:
    """Shows a server's live page where the last value of a cell is displayed: see it and hold the cloth there.

    `url` is the server's address, that of its page or of a room's socket; the browser that shows the notebook opens it.
    """

    def __init__(self, url: str, *, height: int = 480):
        address, room = page_address(socket_address(url))
        told = {"token": token_of(url), "room": room}
        fragment = urlencode({name: value for name, value in told.items() if value})
        self.url = f"{address}#{fragment}" if fragment else address
        self.height = height  # [pixels]

    def _repr_html_(self) -> str:
        return f'<iframe src="{html.escape(self.url)}" width="100%" height="{self.height}" style="border: 0"></iframe>'
