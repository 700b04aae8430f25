"""A standard error that nobody reads stops nothing, and one fault is not told ten times a second."""

import fcntl
import json
import os
import resource
import select
import signal
import socket
import subprocess
import time
import unittest
import urllib.request

from foreign_client import PATIENCE, PROGRAM, main


class Started:
    """A server with a standard error of the test's choice; it ends by itself after a minute."""

    def __init__(self, stderr, *options, **more):
        self.process = subprocess.Popen([PROGRAM, "serve", "--port", "0", "--max-seconds", "60", *options],
                                        stdout=subprocess.PIPE, stderr=stderr, text=True, **more)
        self.addresses = {}

    def read_addresses(self):
        if select.select([self.process.stdout], [], [], PATIENCE)[0]:
            self.addresses = json.loads(self.process.stdout.readline())
        else:
            self.end()
            raise TimeoutError("the server does not start")

    def ticks(self):
        with urllib.request.urlopen(self.addresses["url"] + "metrics", timeout=PATIENCE) as answer:
            text = answer.read().decode()
        return next(int(line.split()[1]) for line in text.splitlines() if line.startswith("weft_ticks_total "))

    def end(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        try:
            return self.process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            return None
        finally:
            self.process.stdout.close()


class Unread(unittest.TestCase):
    def setUp(self):
        self.reader, self.writer = os.pipe()
        self.addCleanup(os.close, self.reader)
        self.addCleanup(os.close, self.writer)
        os.set_blocking(self.writer, False)
        self.fill()
        # That belongs to the pipe's end and not to its number: the server would inherit it.
        os.set_blocking(self.writer, True)

    def fill(self):
        fcntl.fcntl(self.writer, fcntl.F_SETPIPE_SZ, 4 * 4096)
        try:
            while True:
                os.write(self.writer, b"." * 4096)
        except BlockingIOError:
            pass

    def read_all(self):
        os.set_blocking(self.reader, False)
        text = b""
        try:
            while part := os.read(self.reader, 65536):
                text += part
        except BlockingIOError:
            pass
        return text.decode().lstrip(".")

    def test_the_cloth_moves_while_a_full_pipe_takes_no_line_and_the_loss_is_told_later(self):
        # The scene is told before the first tick already.
        server = Started(self.writer)
        server.read_addresses()
        try:
            first = server.ticks()
            end = time.monotonic() + PATIENCE
            while server.ticks() < first + 20 and time.monotonic() < end:
                time.sleep(0.05)
            self.assertGreaterEqual(server.ticks(), first + 20)
            self.assertEqual(self.read_all(), "")
        finally:
            code = server.end()
        self.assertEqual(code, 0)
        told = self.read_all()
        self.assertRegex(told, r"\[warning\] \d+ lines were lost, because standard error took none\n")
        self.assertTrue(told.rstrip().endswith("stopping: asked to stop"), told)

    def test_a_server_whose_lines_nobody_ever_reads_ends_when_it_is_asked_to(self):
        server = Started(self.writer)
        server.read_addresses()
        self.assertEqual(server.end(), 0)
        self.assertEqual(self.read_all(), "")


class TooManyFiles(unittest.TestCase):
    def test_a_lack_of_file_descriptors_is_told_once_and_not_at_each_attempt(self):
        limit = lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (32, 32))
        server = Started(subprocess.PIPE, "--log-level", "warning", preexec_fn=limit)
        connections = []
        try:
            server.read_addresses()
            address = (server.addresses["host"], server.addresses["port"])
            # The system takes them into its queue; the server has no descriptors for all of them.
            connections = [socket.create_connection(address, PATIENCE) for _ in range(60)]
            time.sleep(2)  # twenty attempts to accept
        finally:
            for connection in connections:
                connection.close()
            self.assertEqual(server.end(), 0)
        lines = server.process.stderr.read().splitlines()
        server.process.stderr.close()
        told = [line for line in lines if "Too many open files" in line]
        self.assertEqual(len(told), 1, lines)


if __name__ == "__main__":
    main()
