"""What a client of the last version sends and reads stays: within weft.v1 the wire only gains.

`last_version.json` is what that version's specification and golden commands had. It is written once for each version,
and not changed by a change of the wire.
"""

import json
import unittest
from pathlib import Path
from unittest.mock import patch

import golden
import weft

LAST = json.loads(Path(__file__).with_name("last_version.json").read_text(encoding="utf-8"))
OF_SERVER = {"welcome", "mesh", "state", "roster", "pins", "grabs", "notice", "bye", "result", "error"}


def name_of(message):
    """Of the kind of message: its op, and what a result answers."""
    parts = [message["op"], "of", message.get("command"), message.get("what")]
    return " ".join(part for part in parts if part) if message["op"] == "result" else message["op"]


def paths(value, path=""):
    """All fields of a message, as "cloths[].name"."""
    found = set()
    if isinstance(value, dict):
        for name, inner in value.items():
            found |= {path + name} | paths(inner, path + name + ".")
    elif isinstance(value, list):
        for inner in value:
            found |= paths(inner, path[:-1] + "[].") if isinstance(inner, (dict, list)) else set()
    return found


class LastVersion(unittest.TestCase):
    def test_no_message_of_the_server_has_lost_a_field(self):
        present = {}
        for message in golden.examples():
            if message.get("op") in OF_SERVER:
                present.setdefault(name_of(message), set()).update(paths(message))
        self.assertGreater(len(LAST["messages"]), 20)
        for name, fields in LAST["messages"].items():
            with self.subTest(name):
                self.assertLessEqual(set(fields), present.get(name, set()))

    def test_each_command_of_it_is_still_a_golden_one_and_means_the_same(self):
        present = {entry["text"]: entry["request"] for entry in golden.read_json("accepted_commands.json")}
        self.assertGreater(len(LAST["commands"]), 60)
        for text in LAST["commands"]:
            self.assertIn(text, present)
            self.assertEqual(present[text]["op"], json.loads(text)["op"])

    def test_a_decoder_that_knows_no_new_section_reads_all_others_of_the_frame(self):
        message = golden.read("frame_observed.bin")
        now = weft.decode_frame(message)
        # The kinds that the last version did not know.
        arrays = {"velocities": 60000}
        lists = {"grippers": (60001, *weft.frame_parts.LISTS["grippers"][1:])}
        with patch.dict(weft.frame_parts.ARRAYS, arrays), patch.dict(weft.frame_parts.LISTS, lists):
            then = weft.decode_frame(message)
        self.assertIsNone(then.velocities)
        self.assertEqual(then.grippers, ())
        for name in ("tick", "grabs", "contacts", "reactions", "applied"):
            self.assertEqual(getattr(then, name), getattr(now, name))
        self.assertEqual([list(row) for row in then.positions], [list(row) for row in now.positions])


if __name__ == "__main__":
    unittest.main()
