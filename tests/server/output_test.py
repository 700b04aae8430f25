"""Output that cannot be written ends with exit code 5 and says where and why; a file is whole or as it was."""

import json
import os
import resource
import signal
import stat
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

from foreign_client import PROGRAM, main

LINE = "weft: {}: cannot be written ({})\n"
SIMULATE = ("simulate", "--scene", "flag", "--ticks", "1")


def run(*arguments, **options):
    return subprocess.run([PROGRAM, *arguments], stderr=subprocess.PIPE, text=True, timeout=240, **options)


def small_files():
    """As on a full disk, for whoever has no disk to fill: no file may grow beyond 4,000 bytes."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (4000, 4000))


class StandardOutput(unittest.TestCase):
    COMMANDS = (("--help",), ("--version",), ("serve", "--help"), ("scenes",), ("scenes", "--json"),
                ("scenes", "--schema"), ("scenes", "--json", "flag"), SIMULATE, (*SIMULATE, "--json"))

    def test_a_full_disk_is_told_by_every_command(self):
        for command in self.COMMANDS:
            with self.subTest(command=command), open("/dev/full", "w", encoding="utf-8") as full:
                result = run(*command, stdout=full)
                self.assertEqual(result.returncode, 5)
                self.assertEqual(result.stderr, LINE.format("standard output", "No space left on device"))

    def test_a_reader_that_is_gone_is_told_by_every_command(self):
        for command in self.COMMANDS:
            with self.subTest(command=command):
                reader, writer = os.pipe()
                os.close(reader)
                try:
                    result = run(*command, stdout=writer)
                finally:
                    os.close(writer)
                self.assertEqual(result.returncode, 5)
                self.assertEqual(result.stderr, LINE.format("standard output", "Broken pipe"))

    def test_a_closed_standard_output_is_told_and_no_file_is_written_in_its_place(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "cloth.ply")
            result = run(*SIMULATE, "--out", path, preexec_fn=lambda: os.close(1))
            self.assertEqual(result.returncode, 5)
            self.assertEqual(result.stderr, LINE.format("standard output", "Bad file descriptor"))
            self.assertTrue(path.read_bytes().startswith(b"ply\n"))
            self.assertNotIn(b"particles", path.read_bytes())

    def test_a_server_that_cannot_tell_its_address_says_so_and_serves(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            result = run("serve", "--port", "0", "--max-seconds", "0.5", stdout=full)
        self.assertEqual(result.returncode, 0)
        self.assertRegex(result.stderr, r"the addresses could not be printed: standard output: cannot be written "
                                        r"\(No space left on device\); port \d+")


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.path = self.folder / "cloth.obj"

    def simulate(self, path=None, **options):
        return run(*SIMULATE, "--json", "--out", str(path or self.path), stdout=subprocess.PIPE, **options)

    def names(self):
        return sorted(os.listdir(self.folder))

    def test_a_full_disk_leaves_no_half_file_and_the_summary_is_told(self):
        result = self.simulate(preexec_fn=small_files)
        self.assertEqual(result.returncode, 5)
        self.assertEqual(result.stderr, LINE.format(self.path, "File too large"))
        self.assertEqual(self.names(), [])
        self.assertEqual(json.loads(result.stdout)["ticks"], 1)

    def test_a_full_disk_leaves_the_file_that_was_there(self):
        self.path.write_text("what was there")
        self.assertEqual(self.simulate(preexec_fn=small_files).returncode, 5)
        self.assertEqual(self.path.read_text(), "what was there")
        self.assertEqual(self.names(), ["cloth.obj"])

    def test_a_file_is_replaced_whole_with_its_mode_and_behind_its_link(self):
        target = self.folder / "target"
        target.write_text("what was there")
        target.chmod(0o640)
        self.path.symlink_to(target)
        result = self.simulate()
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertTrue(self.path.is_symlink())
        self.assertEqual(stat.S_IMODE(target.stat().st_mode), 0o640)
        self.assertEqual(sum(line.startswith("v ") for line in target.read_text().splitlines()),
                         json.loads(result.stdout)["particles"])
        self.assertEqual(self.names(), ["cloth.obj", "target"])

    def test_a_named_pipe_is_written_and_stays_a_pipe(self):
        os.mkfifo(self.path)
        received = []
        reader = threading.Thread(target=lambda: received.append(self.path.read_text()), daemon=True)
        reader.start()
        self.assertEqual(self.simulate().returncode, 0)
        reader.join(60)
        self.assertIn("\nv ", received[0])
        self.assertTrue(stat.S_ISFIFO(self.path.stat().st_mode))

    def test_a_run_ended_by_a_signal_leaves_no_half_file(self):
        series = self.folder / "run.npy"
        for ending in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            for there in (False, True):
                with self.subTest(ending=ending, there=there):
                    if there:
                        series.write_text("what was there")
                    process = subprocess.Popen([PROGRAM, *SIMULATE[:-1], "1000000", "--series", str(series)],
                                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
                    try:
                        while process.poll() is None and not any(".part" in name for name in self.names()):
                            time.sleep(0.01)
                        process.send_signal(ending)
                        self.assertEqual(process.wait(timeout=240), -ending)
                    finally:
                        process.kill()
                        process.wait()
                        process.stderr.close()
                    self.assertEqual(self.names(), ["run.npy"] if there else [])
                    if there:
                        self.assertEqual(series.read_text(), "what was there")
                        series.unlink()

    def test_a_signal_that_is_ignored_ends_no_run(self):
        process = subprocess.Popen([PROGRAM, *SIMULATE[:-1], "400", "--series", str(self.folder / "run.npy")],
                                   stdout=subprocess.DEVNULL,
                                   preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        while process.poll() is None and not any(".part" in name for name in self.names()):
            time.sleep(0.01)
        process.send_signal(signal.SIGHUP)
        self.assertEqual(process.wait(timeout=240), 0)
        self.assertEqual(self.names(), ["run.npy"])


if __name__ == "__main__":
    main()
