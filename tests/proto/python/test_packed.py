"""Packed frames in Python, against the golden streams."""

import copy
import random
import unittest
from unittest import mock

import golden
import weft


def floats(frame):
    rows = frame.positions
    return rows.tobytes() if hasattr(rows, "tobytes") else rows.flat.tobytes()


def decoder_of(stream, count=0):
    """A decoder that has read so many frames of a stream."""
    _, cloths, mesh, pairs = stream
    decoder = weft.FrameDecoder(cloths, weft.decode_mesh(mesh))
    for packed, _ in pairs[:count]:
        decoder.decode(packed)
    return decoder


def read(decoder, message):
    """The frame, or None if it is refused; any other exception than ProtocolError fails the test."""
    try:
        return decoder.decode(message)
    except weft.ProtocolError:
        return None


def stream_named(name):
    return next(stream for stream in golden.packed_streams() if stream[0] == name)


class PackedTest(unittest.TestCase):
    def check_streams(self):
        for stream in golden.packed_streams():
            decoder = decoder_of(stream)
            for packed, plain in stream[3]:
                with self.subTest(stream[0]):
                    found, expected = decoder.decode(packed), weft.decode_frame(plain)
                    self.assertEqual(floats(found), floats(expected))
                    self.assertEqual((found.tick, found.grabs, found.applied),
                                     (expected.tick, expected.grabs, expected.applied))

    def test_golden_frames_are_read_bit_for_bit(self):
        self.check_streams()

    def test_golden_frames_are_read_without_numpy(self):
        with mock.patch.object(weft.packages, "numpy", None):
            self.check_streams()

    def test_each_frame_that_breaks_a_rule_is_refused_and_changes_nothing(self):
        stream = stream_named("packed_2x2")
        for case in golden.read_json("packed.json")["refused"]:
            with self.subTest(case["rule"]):
                decoder = decoder_of(stream, case["after"])
                self.assertIsNone(read(decoder, bytes.fromhex(case["hex"])))
                for packed, _ in stream[3][case["after"]:]:
                    self.assertIsNotNone(read(decoder, packed))

    def test_a_packed_frame_needs_a_decoder_that_keeps_frames(self):
        packed, _ = stream_named("packed_2x2")[3][0]
        with self.assertRaises(weft.ProtocolError):
            weft.decode_frame(packed)

    def test_a_frame_cut_anywhere_or_with_a_bit_flipped_is_refused(self):
        for name in ("packed_1x1", "packed_2x2"):
            stream = stream_named(name)
            for n, (packed, _) in enumerate(stream[3]):
                decoder = decoder_of(stream, n)
                for length in range(n % 3, len(packed), 3):
                    self.assertIsNone(read(decoder, packed[:length]))
                    self.assertIsNone(read(decoder, golden.sealed(packed[:length])))
                self.assertIsNone(read(decoder, packed + b"\0"))
                for bit in range(n, 8 * len(packed), 23):
                    changed = bytearray(packed)
                    changed[bit // 8] ^= 1 << bit % 8
                    self.assertIsNone(read(decoder, bytes(changed)))
                self.assertIsNotNone(read(decoder, packed))

    def test_bytes_changed_behind_a_right_checksum_are_survived(self):
        draw, refused = random.Random(5), 0
        for name in ("packed_1x9", "packed_2x2", "packed_meshes"):
            stream = stream_named(name)
            for n, (packed, _) in enumerate(stream[3]):
                before = decoder_of(stream, n)
                for _ in range(40):
                    decoder = copy.copy(before)  # what it holds is replaced and never changed
                    changed = bytearray(packed)
                    for _ in range(draw.randrange(1, 5)):
                        changed[draw.randrange(64, len(packed))] = draw.choice((255, draw.randrange(256)))
                    if draw.random() < 0.25:
                        del changed[draw.randrange(64, len(packed)):]
                    refused += read(decoder, golden.sealed(changed)) is None
        self.assertGreater(refused, 500)

    def test_an_order_that_is_none_is_refused_with_its_mesh(self):
        _, _, mesh, _ = stream_named("packed_meshes")
        order = weft.decode_mesh(mesh).order
        words = b"".join(int(word).to_bytes(4, "little") for row in order for word in row)
        for place, column, word in ((0, 0, 1000), (1, 0, int(order[0][0])), (10, 1, 10)):
            changed = bytearray(mesh)
            begin = changed.index(words) + 16 * place + 4 * column
            changed[begin : begin + 4] = word.to_bytes(4, "little")
            with self.assertRaises(weft.ProtocolError):
                weft.decode_mesh(golden.sealed(changed))


if __name__ == "__main__":
    unittest.main()
