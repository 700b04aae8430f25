"""The decoder that was written from the specification alone, against the golden streams."""

import sys
import unittest
from pathlib import Path

import golden
import plain_decoder

HERE = Path(__file__).parent


class PlainDecoderTest(unittest.TestCase):
    def test_every_golden_stream_is_read_bit_for_bit(self):
        for name, cloths, mesh, pairs in golden.packed_streams():
            decoder = plain_decoder.Decoder(cloths, mesh)
            for packed, plain in pairs:
                with self.subTest(name):
                    found, expected = decoder.decode(packed), decoder.decode(plain)
                    self.assertEqual(found.positions.tobytes(), expected.positions.tobytes())
                    self.assertEqual(found.tick, expected.tick)

    def test_each_frame_that_breaks_a_rule_is_refused(self):
        _, cloths, mesh, pairs = next(s for s in golden.packed_streams() if s[0] == "packed_2x2")
        for case in golden.read_json("packed.json")["refused"]:
            decoder = plain_decoder.Decoder(cloths, mesh)
            for packed, _ in pairs[: case["after"]]:
                decoder.decode(packed)
            with self.subTest(case["rule"]), self.assertRaises(plain_decoder.Refused):
                decoder.decode(bytes.fromhex(case["hex"]))

    def test_it_is_short_and_imports_nothing_of_weft(self):
        text = (HERE / "plain_decoder.py").read_text(encoding="utf-8")
        self.assertLessEqual(len(text.splitlines()), 250)
        imports = [line.split()[1] for line in text.splitlines() if line.startswith(("import", "from"))]
        self.assertTrue(imports)
        for name in imports:
            self.assertIn(name, sys.stdlib_module_names)


if __name__ == "__main__":
    unittest.main()
