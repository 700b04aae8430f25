"""The layers hold in this repository, and a planted violation of each rule is found."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import layers

ROOT = Path(os.environ.get("WEFT_SOURCE_DIR", Path(__file__).resolve().parents[2]))

# A file that breaks one rule, and a word of the complaint.
VIOLATIONS = [
    ("core/a.cpp", '#include "server/room/room.h"\n', "core must not include server/room/room.h"),
    ("core/a.cpp", '#include "proto/types.h"\n', "core must not include proto/types.h"),
    ("core/a.cpp", '  #  include "proto/types.h"\n', "core must not include proto/types.h"),
    ("core/a.cpp", '#include "tests/support/worlds.h"\n', "core must not include tests/"),
    ("core/a.cpp", "#include <nlohmann/json.hpp>\n", "<nlohmann/json.hpp>"),
    ("core/a.cpp", "#include <boost/asio.hpp>\n", "<boost/asio.hpp>"),
    ("core/a.cpp", "#include <thread>\n", "<thread>"),
    ("core/a.cpp", "#include <mutex>\n", "<mutex>"),
    ("core/a.cpp", "#include <future>\n", "<future>"),
    ("core/a.cpp", "#include <condition_variable>\n", "<condition_variable>"),
    ("core/a.cpp", "#include <sys/socket.h>\n", "<sys/socket.h>"),
    ("core/a.cpp", "#include <netinet/in.h>\n", "<netinet/in.h>"),
    ("core/a.cpp", "#include <chrono>\n", "<chrono>"),
    ("core/a.cpp", "#include <ctime>\n", "<ctime>"),
    ("core/a.cpp", "auto t = std::chrono::steady_clock::now();\n", "clock"),
    ("core/a.cpp", "#include <assimp/scene.h>\n", "assimp"),
    ("server/a.cpp", "#include <assimp/scene.h>\n", "assimp"),
    ("tests/core/a.cpp", "#include <assimp/scene.h>\n", "assimp"),
    ("core/a.cpp", '#include "types.h"\n', "from the root"),
    ("core/a.h", "int x();\n", "#pragma once"),
    ("core/a.cpp", "namespace weft {\n\n/// Twice x.\nint f(int x);\n\n}  // namespace weft\n", "what it does"),
    ("core/a.cpp", '#include "core/math/angle.h"\n', "floor above"),
    ("core/math/a.cpp", '#include "core/cloth/cloth_def.h"\n', "floor above"),
    ("core/contact/objects/a.h", '#pragma once\n#include "core/attachments/pins.h"\n', "floor above"),
    ("core/solver/implicit/a.cpp", '#include "core/world/world.h"\n', "floor above"),
    ("core/stuff/a.cpp", "\n", "floor"),
    ("server/a.cpp", '#include "server/room/room.h"\n', "floor above"),
    ("server/room/a.cpp", '#include "server/net/hub.h"\n', "floor above"),
    ("server/room/a.cpp", '#include "server/rooms/rooms.h"\n', "floor above"),
    ("server/rooms/a.cpp", '#include "server/net/hub.h"\n', "floor above"),
    ("server/translate/a.cpp", '#include "server/room/room.h"\n', "floor above"),
    ("server/stuff/a.cpp", "\n", "floor"),
    ("proto/a.cpp", '#include "proto/frames/frame.h"\n', "floor above"),
    ("proto/codec/a.cpp", '#include "proto/frames/frame.h"\n', "floor above"),
    ("proto/frames/a.cpp", '#include "proto/messages/replies.h"\n', "floor above"),
    ("proto/stuff/a.cpp", "\n", "floor"),
    ("proto/a.cpp", '#include "core/types.h"\n', "proto must not include core/types.h"),
    ("tests/proto/a.cpp", '#include "core/ranges.h"\n', "must not include core/ranges.h"),
    ("proto/a.cpp", '#include "server/room/room.h"\n', "proto must not include server/room/room.h"),
    ("proto/a.cpp", "#include <Eigen/Core>\n", "<Eigen/Core>"),
    ("proto/a.cpp", "#include <boost/asio.hpp>\n", "<boost/asio.hpp>"),
    ("server/room/room.cpp", '#include "core/types.h"\n#include "proto/types.h"\n', "translate"),
    ("server/room/room.cpp", '#include "web/page.h"\n', "from the root"),
    ("tests/proto/a.cpp", '#include "core/types.h"\n', "tests/proto must not include core/types.h"),
    ("tests/laws/a.cpp", '#include "server/room/room.h"\n', "tests/laws must not include server/room/room.h"),
    ("web/src/a.ts", 'import { x } from "../../core/x.js";\n', "web/src must not import core/x.js"),
    ("web/src/a.ts", 'import {\n  x,\n} from "../../proto/x.js";\n', "must not import proto/x.js"),
    ("web/src/a.ts", 'export * from "../../server/x.js";\n', "must not import server/x.js"),
    ("web/src/a.ts", 'import "../../tests/x.js";\n', "must not import tests/x.js"),
    ("web/src/a.ts", 'const x = await import("lodash");\n', "must not import lodash"),
    ("web/src/view/a.ts", 'import { x } from "../panel/x.js";\n', "on a floor above"),
    ("web/src/hold/a.ts", 'import { x } from "../page.js";\n', "on a floor above"),
    ("proto/js/a.js", 'import { x } from "../../web/src/x.js";\n', "must not import web/src/x.js"),
    ("proto/js/a.js", 'import * as three from "three";\n', "must not import three"),
    ("web/src/a.ts", "// TO" "DO later\n", "unfinished"),
    ("core/CMakeLists.txt", "# FIX" "ME\n", "unfinished"),
    ("README.md", "TO" "DO: write this\n", "unfinished"),
    ("core/a.cpp", 'const char* path = "/ro' 'ot/x";\n', "machine"),
    ("README.md", "cd /ho" "me/me/weft\n", "machine"),
    ("dev", "cp x /t" "mp/y\n", "machine"),
    ("core/a.cpp", "\n" * 401, "401 lines"),
    ("dev", "\n" * 401, "401 lines"),
    ("stuff/a.cpp", "\n", "top level"),
    ("notes.m" "d", "\n", "top level"),
    ("web/package-lock.json", '"resolved": "https://registry.invalid/x.tgz"\n', "download"),
]

ALLOWED = [
    ("core/a.cpp", '#include "core/types.h"\n#include <Eigen/Core>\n'),
    ("core/a.h", "#pragma once\n"),
    ("core/a.cpp", "\n" * 400),
    ("core/a.h", "#pragma once\n\nnamespace weft {\n\n// Doubling.\n\n/// 2 x.\nint f(int x);\n\n}  // namespace weft\n"),
    ("core/solver/a.cpp", '#include "core/solver/implicit/implicit.h"\n#include "core/types.h"\n'),
    ("core/scenes/a.cpp", '#include "core/world/world.h"\n'),
    ("proto/limits.h", '#pragma once\n#include "core/ranges.h"\n'),
    (layers.ONLY_WITH_ASSIMP, "#include <assimp/scene.h>\n"),
    ("server/room/room.cpp", '#include "core/types.h"\n#include "server/clock.h"\n#include <chrono>\n'),
    ("server/commands/a.cpp", '#include "server/net/hub.h"\n#include "server/clock.h"\n'),
    ("server/translate/frame.cpp", '#include "core/types.h"\n#include "proto/types.h"\n'),
    ("web/src/a.ts", 'import { y } from "../../proto/js/client.js";\nimport * as z from "three";\n'),
    ("web/src/a.ts", '// What comes from "the wire" is drawn.\nimport { b } from "./b";\n'),
    ("tests/core/a.cpp", '#include "core/types.h"\n#include "tests/support/worlds.h"\n'),
    ("tests/proto/golden/a.json", "\n" * 5000),
    (".ci/run", "./dev test\n"),
]


def complaints(name, text):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return list(layers.problems(folder, [name]))


class Layers(unittest.TestCase):
    maxDiff = None

    def test_this_repository_keeps_to_its_layers(self):
        listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z", "-co", "--exclude-standard"],
                                capture_output=True, text=True, check=True)
        files = [name for name in listed.stdout.split("\0") if name]
        self.assertIn("core/world/world.cpp", files)
        self.assertEqual(list(layers.problems(ROOT, files)), [])

    def test_every_planted_violation_is_found_and_no_other(self):
        for name, text, word in VIOLATIONS:
            with self.subTest(name=name, text=text[:60]):
                found = complaints(name, text)
                self.assertEqual(len(found), 1, found)
                self.assertIn(word, found[0])

    def test_what_is_allowed_is_not_complained_about(self):
        for name, text in ALLOWED:
            with self.subTest(name=name, text=text[:60]):
                self.assertEqual(complaints(name, text), [])


if __name__ == "__main__":
    unittest.main()
