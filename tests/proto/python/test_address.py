"""Which socket and which page an address leads to."""

import asyncio
import unittest

import golden  # noqa: F401  (finds the package beside the tests)
import weft
from played_server import PlayedServer


class AddressTest(unittest.IsolatedAsyncioTestCase):
    async def test_the_address_of_the_page_leads_to_the_socket(self):
        async with PlayedServer() as server:
            page = server.url.replace("ws://", "http://").removesuffix("/ws")
            for url in (page, page + "/", page.replace("http", "ws"), server.url):
                async with weft.connect(url):
                    self.assertEqual(server.socket.path, "/ws", url)
            for url in (page + "/#room=ada", page + "/#token=x&room=ada", server.url + "#room=ada", server.url + "/ada"):
                async with weft.connect(url):
                    self.assertEqual(server.socket.path, "/ws/ada", url)

    def test_the_page_of_a_notebook_is_that_of_the_room_with_its_token(self):
        pages = {
            "ws://host:1/ws": "http://host:1/",
            "http://host:1": "http://host:1/",
            "ws://host:1/ws/ada": "http://host:1/#room=ada",
            "wss://host/weft/ws": "https://host/weft/",
            "https://host/#token=abc&room=ada": "https://host/#token=abc&room=ada",
        }
        for url, page in pages.items():
            self.assertEqual(weft.Page(url).url, page)

    async def test_what_is_no_address_is_told_with_one_that_is(self):
        for url in ("127.0.0.1:8080", "ftp://127.0.0.1/ws", "ws://", "ws://127.0.0.1:x/ws", "ws://127.0.0.1:99999/ws", ""):
            with self.assertRaisesRegex(weft.WeftError, "ws://127.0.0.1:8080/ws"):
                await weft.connect(url, timeout=1)

    async def test_a_server_that_speaks_no_http_is_a_lost_connection(self):
        async def babble(_, writer):
            writer.write(b"nonsense\r\n\r\n")
            await writer.drain()
            writer.close()

        server = await asyncio.start_server(babble, "127.0.0.1", 0)
        async with server:
            port = server.sockets[0].getsockname()[1]
            with self.assertRaises(weft.ConnectionLost):
                await weft.connect(f"ws://127.0.0.1:{port}/ws", timeout=5)


if __name__ == "__main__":
    unittest.main()
