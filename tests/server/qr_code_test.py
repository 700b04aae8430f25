"""The QR code in the terminal of a server that others may open, read as ISO/IEC 18004 says."""

import json
import os
import pty
import re
import subprocess
import unittest
import urllib.request

from foreign_client import PATIENCE, PROGRAM, main

FORMAT_MASK = 0x5412
FORMAT_GENERATOR = 0x537
MASKS = [
    lambda x, y: (x + y) % 2,
    lambda x, y: y % 2,
    lambda x, y: x % 3,
    lambda x, y: (x + y) % 3,
    lambda x, y: (x // 3 + y // 2) % 2,
    lambda x, y: x * y % 2 + x * y % 3,
    lambda x, y: (x * y % 2 + x * y % 3) % 2,
    lambda x, y: ((x + y) % 2 + x * y % 3) % 2,
]
CORRECTION = {21: 7, 25: 10, 29: 15, 33: 20, 37: 26}  # codewords at level L, by size
QUIET = 4
FINDER = ["1111111", "1000001", "1011101", "1011101", "1011101", "1000001", "1111111"]


def shown_by(*options):
    """What a server prints first, and its standard error, which is a terminal."""
    ours, its = pty.openpty()
    command = [PROGRAM, "serve", "--port", "0", "--max-seconds", "20", "--log-level", "off", *options]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=its, text=True) as server:
        os.close(its)
        line = json.loads(server.stdout.readline())
        with urllib.request.urlopen(f"http://127.0.0.1:{line['port']}/api/v1/scenes", timeout=PATIENCE):
            pass  # it serves, so that it has shown what it shows
        server.terminate()
        server.wait(timeout=30)
    shown = b""
    try:
        while more := os.read(ours, 65536):
            shown += more
    except OSError:  # all is read
        pass
    os.close(ours)
    return line, shown.decode()


def modules_in(text):
    """Rows of a code that is drawn two rows a line, without its border; 1 is dark."""
    rows = []
    for line in re.findall(r"\x1b\[30;107m(.*?)\x1b\[0m", text):
        rows.append([int(c in "▀█") for c in line])
        rows.append([int(c in "▄█") for c in line])
    width = len(rows[0])
    border = [row[x] for y, row in enumerate(rows[:width]) for x in range(width)
              if min(x, y, width - 1 - x, width - 1 - y) < QUIET]
    assert not any(border), "the border is light"
    return [row[QUIET:width - QUIET] for row in rows[QUIET:width - QUIET]]


def format_of(bits):
    """Level and mask, from 15 bits, highest first."""
    value = int("".join(map(str, bits)), 2) ^ FORMAT_MASK
    rest = value
    for k in range(14, 9, -1):
        if rest >> k & 1:
            rest ^= FORMAT_GENERATOR << (k - 10)
    assert rest == 0, "the format is damaged"
    return value >> 13, value >> 10 & 7


def is_data(x, y, size):
    """Whether a module is neither finder, format, timing nor alignment."""
    corner = (x < 9 and y < 9) or (x >= size - 8 and y < 9) or (x < 9 and y >= size - 8)
    alignment = size > 21 and abs(x - (size - 7)) <= 2 and abs(y - (size - 7)) <= 2
    return not (corner or alignment or x == 6 or y == 6)


def codewords_in(rows, mask):
    size = len(rows)
    columns = [x for x in range(size - 1, 0, -2) if x > 6] + [5, 3, 1]
    bits = []
    for k, right in enumerate(columns):
        for step in range(size):
            y = step if k % 2 else size - 1 - step
            bits += [rows[y][x] ^ (MASKS[mask](x, y) == 0) for x in (right, right - 1) if is_data(x, y, size)]
    return [int("".join(map(str, bits[k:k + 8])), 2) for k in range(0, len(bits) - 7, 8)]


def product(a, b):
    total = 0
    for k in range(8):
        if b >> k & 1:
            total ^= a << k
    for k in range(14, 7, -1):
        if total >> k & 1:
            total ^= 0x11D << (k - 8)
    return total


def syndromes(words, count):
    """Values of the words' polynomial at the roots of its generator: all 0 if nothing is damaged."""
    root, found = 1, []
    for _ in range(count):
        value = 0
        for word in words:
            value = product(value, root) ^ word
        found.append(value)
        root = product(root, 2)
    return found


def text_of(rows):
    size = len(rows)
    for x, y in [(0, 0), (size - 7, 0), (0, size - 7)]:
        assert ["".join(map(str, row[x:x + 7])) for row in rows[y:y + 7]] == FINDER
    assert all(rows[6][k] == rows[k][6] == 1 - k % 2 for k in range(8, size - 8)), "timing"
    assert rows[size - 8][8] == 1
    first = [rows[8][x] for x in (0, 1, 2, 3, 4, 5, 7, 8)] + [rows[y][8] for y in (7, 5, 4, 3, 2, 1, 0)]
    second = [rows[y][8] for y in range(size - 1, size - 8, -1)] + [rows[8][x] for x in range(size - 8, size)]
    assert first == second, "the format stands there twice"
    level, mask = format_of(first)
    assert level == 1, "level L"
    words = codewords_in(rows, mask)
    assert not any(syndromes(words, CORRECTION[size]))
    bits = "".join(f"{word:08b}" for word in words)
    assert bits[:4] == "0100", "bytes"
    count = int(bits[4:12], 2)
    return bytes(int(bits[12 + 8 * k:20 + 8 * k], 2) for k in range(count)).decode()


class QrCode(unittest.TestCase):
    def test_the_code_in_an_open_servers_terminal_reads_as_its_address(self):
        for address in ["0.0.0.0", "127.0.0.1"]:
            line, shown = shown_by("--bind", address, "--open")
            self.assertEqual(text_of(modules_in(shown)), line["urls"][0])
            self.assertIn(line["urls"][0], shown)

    def test_no_code_is_shown_by_a_server_that_lets_nobody_in(self):
        self.assertEqual(shown_by()[1], "")


if __name__ == "__main__":
    main()
