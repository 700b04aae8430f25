"""The layers hold in this repository, and a planted violation of each rule is found."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import layers

ROOT = Path(sys.argv.pop(1)) if len(sys.argv) > 1 else Path(__file__).resolve().parents[2]

# One file that breaks one rule, and a word of the complaint.
VIOLATIONS = [
    ("core/a.cpp", '#include "server/room.h"\n', "server/room.h"),
    ("core/a.cpp", '#include "proto/types.h"\n', "proto/types.h"),
    ("core/a.cpp", "#include <nlohmann/json.hpp>\n", "nlohmann"),
    ("core/a.cpp", "#include <boost/asio.hpp>\n", "boost"),
    ("core/a.cpp", "#include <thread>\n", "thread"),
    ("core/a.cpp", "#include <chrono>\n", "chrono"),
    ("core/a.cpp", "#include <assimp/scene.h>\n", "assimp"),
    ("core/a.cpp", '#include "types.h"\n', "from the root"),
    ("proto/a.cpp", '#include "core/types.h"\n', "core/types.h"),
    ("proto/a.h", "#include <Eigen/Core>\n", "Eigen"),
    ("server/room.cpp", '#include "core/world/world.h"\n#include "proto/types.h"\n', "translate"),
    ("web/src/a.ts", 'import { x } from "../../core/x.js";\n', "core/x.js"),
    ("web/src/a.ts", "// TO" "DO later\n", "unfinished"),
    ("core/a.h", 'const char* path = "/ro' 'ot/x";\n', "machine"),
    ("core/a.cpp", "\n" * 500, "500 lines"),
    ("stuff/a.cpp", "\n", "top level"),
]

ALLOWED = [
    ("core/a.cpp", '#include "core/types.h"\n#include <Eigen/Core>\n'),
    ("core/geometry/mesh_file.cpp", "#include <assimp/scene.h>\n"),
    ("server/translate_frame.cpp", '#include "core/types.h"\n#include "proto/types.h"\n'),
    ("web/src/a.ts", 'import { y } from "../../proto/js/client.js";\nimport * as z from "three";\n'),
    ("tests/core/a.cpp", '#include "core/types.h"\n#include "tests/support/worlds.h"\n'),
]


def complaints(name, text):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        path.parent.mkdir(parents=True)
        path.write_text(text, encoding="utf-8")
        return list(layers.problems(Path(folder), [name]))


class Layers(unittest.TestCase):
    def test_this_repository_keeps_to_its_layers(self):
        listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-co", "--exclude-standard"],
                                capture_output=True, text=True, check=True)
        files = [line for line in listed.stdout.splitlines() if not line.startswith("tests/layers/")]
        self.assertGreater(len(files), 20)
        self.assertEqual(list(layers.problems(ROOT, files)), [])

    def test_every_planted_violation_is_found(self):
        for name, text, word in VIOLATIONS:
            with self.subTest(name=name, word=word):
                found = complaints(name, text)
                self.assertEqual(len(found), 1, found)
                self.assertIn(word, found[0])

    def test_what_is_allowed_is_not_complained_about(self):
        for name, text in ALLOWED:
            with self.subTest(name=name):
                self.assertEqual(complaints(name, text), [])


if __name__ == "__main__":
    unittest.main()
