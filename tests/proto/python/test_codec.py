"""The Python decoders against the golden files, with numpy and without."""

import dataclasses
import random
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import golden
import weft

try:
    import numpy
except ImportError:
    numpy = None

DECODERS = {"frame": weft.decode_frame, "mesh": weft.decode_mesh, "data": weft.decode_data}


def accepts(type_, message):
    """Whether it is accepted; any other exception than ProtocolError fails the test."""
    try:
        DECODERS[type_](message)
    except weft.ProtocolError:
        return False
    return True


def flat(rows):
    return [number for row in rows for number in row]


def float_bits(values):
    return struct.pack(f"<{len(values)}f", *values)


def as_told(sample):
    """A sample as the golden files have it."""
    return {
        name: list(value) if isinstance(value, tuple) else value
        for name, value in dataclasses.asdict(sample).items()
    }


class WithoutNumpy(unittest.TestCase):
    numpy = None

    def setUp(self):
        weft.packages.numpy = self.numpy

    def tearDown(self):
        weft.packages.numpy = numpy

    def each(self, type_=None):
        for name, content, message in golden.messages():
            if type_ in (None, content["type"]):
                with self.subTest(name):
                    yield content, message

    def test_golden_frames_are_read_bit_for_bit(self):
        for content, message in self.each("frame"):
            frame = weft.decode_frame(message)
            for name, value in content["header"].items():
                self.assertEqual(getattr(frame, name), value, name)
            self.assertEqual(frame.jump, bool(content["header"]["flags"] & 2))
            self.assertEqual(frame.paused, bool(content["header"]["flags"] & 4))
            self.assertEqual(float_bits(flat(frame.positions)), float_bits(content["positions"]))
            self.assertEqual(len(frame.grabs), len(content["grabs"]))
            for grab, expected in zip(frame.grabs, content["grabs"]):
                self.assertEqual((grab.id, grab.viewer), (expected["id"], expected["viewer"]))
                self.assertEqual(list(grab.held), expected["held"])
                self.assertEqual(list(grab.target), expected["target"])
                self.assertEqual(grab.force, expected["force"])
            applied = {a["viewer"]: a["number"] for a in content["applied"]}
            self.assertEqual(frame.applied, applied)
            for told in content["poses"]:
                pose = frame.poses[told["collider"]]
                self.assertEqual(pose, weft.Pose(tuple(told["position"]), tuple(told["rotation"])))
            self.assertEqual(len(frame.poses), len(content["poses"]))
            contacts = [as_told(contact) for contact in frame.contacts]
            self.assertEqual(contacts, content["contacts"])
            reactions = [as_told(reaction) for reaction in frame.reactions]
            self.assertEqual(reactions, content["reactions"])
            velocities = [] if frame.velocities is None else flat(frame.velocities)
            self.assertEqual(float_bits(velocities), float_bits(content["velocities"]))
            self.assertEqual([as_told(gripper) for gripper in frame.grippers], content["grippers"])
            self.assertEqual(frame.observed, bool(content["header"]["flags"] & 8))

    def test_golden_meshes_are_read(self):
        for content, message in self.each("mesh"):
            mesh = weft.decode_mesh(message)
            self.assertEqual(float_bits(flat(mesh.rest_positions)), float_bits(content["rest_positions"]))
            self.assertEqual(flat(mesh.triangles), content["triangles"])
            self.assertEqual(float_bits(flat(mesh.uv)), float_bits(content["uv"]))
            self.assertEqual(len(mesh.colliders), len(content["colliders"]))
            for collider, expected in zip(mesh.colliders, content["colliders"]):
                self.assertEqual(collider.collider, expected["collider"])
                self.assertEqual(flat(collider.positions), expected["positions"])
                self.assertEqual(flat(collider.triangles), expected["triangles"])

    def test_golden_data_is_read(self):
        for content, message in self.each("data"):
            data = weft.decode_data(message)
            for name in ("tick", "transfer", "components"):
                self.assertEqual(getattr(data, name), content[name])
            self.assertEqual(flat(data.values), content["values"])

    def test_the_type_is_told_by_the_message_itself(self):
        types = {"frame": weft.Frame, "mesh": weft.MeshData, "data": weft.Data}
        for content, message in self.each():
            self.assertIsInstance(weft.decode_binary(message), types[content["type"]])
            for other in DECODERS:
                self.assertEqual(accepts(other, message), other == content["type"])

    def test_each_message_that_breaks_a_rule_is_refused_though_its_checksum_is_right(self):
        for case in golden.read_json("refused_binary.json"):
            with self.subTest(f"{case['type']}: {case['rule']}"):
                self.assertFalse(accepts(case["type"], bytes.fromhex(case["hex"])))

    def test_a_message_cut_anywhere_or_with_a_byte_more_is_refused(self):
        for content, message in self.each():
            for length in range(len(message)):
                self.assertFalse(accepts(content["type"], message[:length]), length)
            self.assertFalse(accepts(content["type"], message + b"\0"))

    def test_a_message_with_any_one_bit_flipped_is_refused(self):
        for content, message in self.each():
            for bit in range(8 * len(message)):
                changed = bytearray(message)
                changed[bit // 8] ^= 1 << bit % 8
                self.assertFalse(accepts(content["type"], bytes(changed)), bit)

    def test_bytes_cut_or_changed_behind_a_right_checksum_are_survived(self):
        # Whether it accepts is its business; it must raise nothing but ProtocolError.
        chance, count = random.Random(7), {True: 0, False: 0}
        for content, message in self.each():
            changed = [message[:length] for length in range(len(message) + 1)]
            for _ in range(300):
                other = bytearray(message)
                for _ in range(4):
                    other[chance.randrange(len(other))] = chance.choice((255, chance.randrange(256)))
                changed.append(other)
            for other in changed:
                count[accepts(content["type"], golden.sealed(other))] += 1
        self.assertGreater(min(count.values()), 100)


@unittest.skipIf(numpy is None, "numpy is not installed")
class WithNumpy(WithoutNumpy):
    numpy = numpy

    def test_rows_are_arrays(self):
        mesh = weft.decode_mesh(golden.read("mesh_grid.bin"))
        for rows, kind, width in (
            (mesh.rest_positions, "float32", 3),
            (mesh.triangles, "uint32", 3),
            (mesh.uv, "float32", 2),
        ):
            self.assertIsInstance(rows, numpy.ndarray)
            self.assertEqual((rows.dtype, rows.ndim, rows.shape[1]), (kind, 2, width))

    def test_arrays_share_the_memory_of_their_message(self):
        for content, message in self.each("frame"):
            frame, content_of_it = weft.decode_frame(message), numpy.frombuffer(message, numpy.uint8)
            if len(frame.positions):
                self.assertTrue(numpy.shares_memory(frame.positions, content_of_it))


class RowsAreASequence(unittest.TestCase):
    def test_of_tuples(self):
        rows = weft.Rows(memoryview(bytes(range(12))), 3)
        self.assertEqual(len(rows), 4)
        self.assertEqual(rows[1], (3, 4, 5))
        self.assertEqual(rows[-1], (9, 10, 11))
        self.assertEqual(rows[2:], [(6, 7, 8), (9, 10, 11)])
        self.assertEqual(sum(row[0] for row in rows), 0 + 3 + 6 + 9)
        for index in (4, -5):
            with self.assertRaises(IndexError):
                rows[index]


class Ack(unittest.TestCase):
    def test_is_the_golden_one(self):
        self.assertEqual(weft.encode_ack(2**32 - 2), golden.read("ack.bin"))


class Golden(unittest.TestCase):
    def test_files_are_what_the_generator_writes(self):
        with tempfile.TemporaryDirectory() as folder:
            generator = golden.GOLDEN / "generate.py"
            subprocess.run([sys.executable, "-B", generator, folder], check=True, timeout=60)
            written = {path.name: path.read_bytes() for path in Path(folder).iterdir()}
        names = {path.name for path in golden.GOLDEN.iterdir() if path.suffix in (".bin", ".json")}
        self.assertEqual(set(written), names)
        for name, content in written.items():
            self.assertEqual(content, golden.read(name), name)


if __name__ == "__main__":
    unittest.main()
