"""Laws of the load client: what it counts is what the server sent. No verdict depends on how long anything took."""

import json
import os
import subprocess
import unittest

BUILD = os.environ["WEFT_BUILD_DIR"]
SIDE = 17
FLOAT_BYTES = 12 * SIDE * SIDE  # of the positions in a frame


def load(port, *options):
    return subprocess.run([BUILD + "/weft_load", "--port", str(port), "--seconds", "1", *options],
                          capture_output=True, text=True, timeout=100)


class Load(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        side = [word for name in ("rows", "columns") for word in ("--set", f"cloths[0].{name}={SIDE}")]
        cls.server = subprocess.Popen([BUILD + "/weft", "serve", "--port", "0", "--scene", "curtain", "--max-seconds", "120",
                                       "--log-level", "error", *side], stdout=subprocess.PIPE, text=True)
        cls.port = json.loads(cls.server.stdout.readline())["port"]

    @classmethod
    def tearDownClass(cls):
        cls.server.terminate()
        cls.server.wait(10)
        cls.server.stdout.close()

    def test_each_viewer_gets_frames_of_the_codec_that_it_asked_for(self):
        sizes = {}
        for codec in ("f32", "packed"):
            done = load(self.port, "--viewers", "3", "--codec", codec)
            self.assertEqual(done.returncode, 0, done.stderr)
            result = json.loads(done.stdout)
            self.assertEqual((result["viewers"], result["lost"]), (3, []))
            self.assertGreater(result["frames"], 0)
            self.assertGreater(result["delivered_to_worst"], 0)
            self.assertLessEqual(result["delivered"], 1)
            sizes[codec] = result["bytes_a_frame"]
        self.assertTrue(FLOAT_BYTES < sizes["f32"] < FLOAT_BYTES + 400, sizes)
        self.assertLess(sizes["packed"], 0.7 * sizes["f32"])

    def test_viewers_that_stop_reading_are_not_counted(self):
        done = load(self.port, "--viewers", "3", "--stalled", "2")
        self.assertEqual(done.returncode, 0, done.stderr)
        result = json.loads(done.stdout)
        self.assertLessEqual(result["frames"], result["frames_made"])
        self.assertGreater(result["frames"], 0)

    def test_it_says_why_nobody_joined(self):
        done = load(self.port, "--viewers", "1", "--rooms", "1")
        self.assertEqual(done.returncode, 1)
        self.assertIn("handshake", done.stderr)


if __name__ == "__main__":
    unittest.main()
