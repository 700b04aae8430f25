"""Each Markdown page that a file of this repository names is there, and each source that a page names."""

import fnmatch
import os
import re
import subprocess
import unittest
from pathlib import Path, PurePosixPath
from posixpath import normpath

ROOT = Path(os.environ.get("WEFT_SOURCE_DIR", Path(__file__).resolve().parents[2]))

# A page's name with the folders before it.
NAME = re.compile(r"[^\s\"'`()\[\]<>|,;:=]*\w\.m" r"d\b")
# A source's path in a page: in back quotes, with a folder; "*" stands for any ending.
SOURCE = re.compile(r"`([^`\s]*/[^`\s/]*\.(?:h|cpp|py|ts|js|mjs|\*))`")
# A folder that only a run knows: "$into/" of the shell, "{self.tree}/" of a format string.
UNKNOWN_FOLDER = re.compile(r"^.*(?:\$\w+|\})/")


def is_there(name, named_in, pages):
    """Whether a page of this name is one of the pages.

    A name counts from the folder of the file that names it, or from a folder above that; one that
    begins with "/" from the root.
    """
    if "*" in name or name.startswith("//"):
        return True  # a pattern, or an address
    known = UNKNOWN_FOLDER.sub("", name)
    if known != name:
        return any(f"/{page}".endswith(f"/{known}") for page in pages)
    folders = ["."] if name.startswith("/") else PurePosixPath(named_in).parents
    return any(normpath(f"{folder}/{name}") in pages for folder in folders)


def missing_pages(texts):
    """Yields (file, line, name) of each page that is named and missing.

    texts -- the text of each file by its name from the root, pages among them
    """
    pages = {file for file in texts if file.endswith(".m" "d")}
    for file, text in texts.items():
        for found in NAME.finditer(text):
            if not is_there(found[0], file, pages):
                yield file, text.count("\n", 0, found.start()) + 1, found[0]


def missing_sources(texts):
    """Yields (page, line, path) of each source that a page names and that is missing.

    A path counts from the page's folder, or from the root.
    """
    for page, text in texts.items():
        if not page.endswith(".m" "d"):
            continue
        for found in SOURCE.finditer(text):
            names = {normpath(f"{folder}/{found[1]}") for folder in (PurePosixPath(page).parent, ".")}
            if not any(fnmatch.filter(texts, name) for name in names):
                yield page, text.count("\n", 0, found.start()) + 1, found[1]


def texts_of_this_repository():
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z", "-co", "--exclude-standard"],
                            capture_output=True, text=True, check=True)
    texts = {}
    for name in filter(None, listed.stdout.split("\0")):
        path = ROOT / name
        try:
            if path.is_file() and path.name != "package-lock.json":
                texts[name] = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            pass  # a picture, or golden bytes
    return texts


PAGES = {"README.m" "d": "", "core/README.m" "d": "", "tests/bench/REPORT.m" "d": ""}

# A file that names a page, and how.
NAMED_AND_THERE = [
    ("core/a.h", "/// See README.m" "d, section 2.\n"),
    ("server/a.h", "// core/README.m" "d section 4\n"),
    ("tests/README.m" "d", "the report, [bench](bench/REPORT.m" "d)\n"),
    ("core/world/a.cpp", "// as ../README.m" "d says\n"),
    ("tests/a.cpp", 'read(SOURCE_DIR + "/core/README.m' 'd")\n'),
    ("dev", 'say "see $into/REPORT.m' 'd"\n'),
    ("tests/a.py", 'f"{folder}/README.m' 'd"\n'),
    ("web/a.ts", "// https://example.org/NOTES.m" "d\n"),
    ("tests/a.py", 'glob("*.m' 'd")\n'),
    ("core/a.h", "// not of a page: a.mdx, x.m\n"),
]
NAMED_AND_MISSING = [
    ("core/a.h", "/// An equation (NOTES.m" "d section 2).\n"),
    ("core/a.h", "/// the recipe of NOTES.m" "d's author\n"),
    ("core/a.h", "// cycle (NOTES.m" "d\n// b)\n"),
    ("README.m" "d", "see [the page](docs/NOTES.m" "d)\n"),
    ("server/a.cpp", "// server/README.m" "d section 1\n"),
    ("tests/a.py", '"""As bench/REPORT' '2.m' 'd has it."""\n'),
    ("dev", 'say "see $into/NOTES.m' 'd"\n'),
    ("core/a.h", "// bench/REPORT.m" "d\n"),
    ("tests/bench/a.cpp", 'read(SOURCE_DIR + "/REPORT.m' 'd")\n'),
]


class Pages(unittest.TestCase):
    maxDiff = None

    def test_every_page_that_a_file_names_is_there(self):
        texts = texts_of_this_repository()
        self.assertIn("README.m" "d", texts)
        self.assertIn("core/world/world.cpp", texts)
        self.assertEqual(list(missing_pages(texts)), [])

    def test_every_source_that_a_page_names_is_there(self):
        self.assertEqual(list(missing_sources(texts_of_this_repository())), [])

    def test_a_planted_path_of_a_missing_source_is_found_and_no_other(self):
        page = "core/README.m" "d"
        sources = {"core/world/a.cpp": "", "core/world/a.h": "", "web/src/b.ts": ""}
        text = "`world/a.cpp` `world/a.*` `web/src/b.ts` `a.cpp` `f` in `world/c.cpp`\n`world/c.*`\n"
        self.assertEqual(list(missing_sources({**sources, page: text})),
                         [(page, 1, "world/c.cpp"), (page, 2, "world/c.*")])

    def test_each_planted_name_of_a_missing_page_is_found(self):
        for file, text in NAMED_AND_MISSING:
            with self.subTest(file=file, text=text):
                found = list(missing_pages({**PAGES, file: text}))
                self.assertEqual([(name, line) for name, line, _ in found], [(file, 1)])

    def test_pages_that_are_there_addresses_and_patterns_are_not_complained_about(self):
        for file, text in NAMED_AND_THERE:
            with self.subTest(file=file, text=text):
                self.assertEqual(list(missing_pages({**PAGES, file: text})), [])


if __name__ == "__main__":
    unittest.main()
