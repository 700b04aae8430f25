"""What `./dev house` tells of a small tree is what stands there."""

import subprocess
import tempfile
import unittest
from pathlib import Path

import house

FILES = {
    "core/math/a.h": """#pragma once
// One.
struct Small {
  int x = 0;  ///< two
  int y = 0;
};
inline int twice(int x) {
  assert(x > 0);
  return 2 * x;
}
""",
    "core/world/b.cpp": """#include "core/math/a.h"
int one() { return 1; }
int long_one() {
  int sum = 0;

  sum += 1;
  return sum;
}
""",
    "core/cloth/c.cpp": '#include "core/world/b.h"\n#include "core/math/a.h"\n',
    "server/d.cpp": "int d() { return 0; }\n",
}


class House(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in FILES.items():
                path = Path(folder, name)
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
            subprocess.run(["git", "init", "-q", folder], check=True)
            cls.rows = {row[0]: dict(zip(house.COLUMNS, row)) for row in house.table(folder)}

    def check(self, room, **expected):
        row = self.rows[room]
        self.assertEqual({key: row[key.replace("_", " ")] for key in expected}, expected)

    def test_files_lines_code_comments_and_asserts_are_counted(self):
        self.check("core/math", files=1, lines=10, code=8, comments="20.0 %", asserts=1, per_1000="100.0")
        self.check("core", files=3, lines=20, code=17, comments="10.0 %", asserts=1)
        self.check("server", files=1, lines=1)

    def test_functions_are_as_long_as_their_lines(self):
        self.check("core/math", functions=1, median=4, longest=4)
        self.check("core/world", functions=2, median=6, longest=6)

    def test_the_largest_class_is_that_of_most_members(self):
        self.check("core", largest_class="Small", members=2)

    def test_includes_of_a_higher_floor_are_counted(self):
        self.check("core/cloth", upward=1)
        self.check("core/world", upward=0)
        self.check("core", upward=1)


if __name__ == "__main__":
    unittest.main()
