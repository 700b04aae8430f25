"""The Python client as a package: installed as its page says, typed, and misspelt calls found by a checker."""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import venv
from pathlib import Path

ROOT = Path(os.environ.get("WEFT_SOURCE_DIR", Path(__file__).resolve().parents[2]))
TYPES = ROOT / "tests/proto/types"
FOLLOWS = "reportUnknown"  # from an error
CHECKER = TYPES / "node_modules/pyright/index.js"


def run(*command, **options):
    """What it prints; fails with all of it."""
    done = subprocess.run(command, capture_output=True, text=True, timeout=200, check=False, **options)
    if done.returncode:
        raise AssertionError(f"{command[0]} ended with {done.returncode}:\n{done.stdout}\n{done.stderr}")
    return done.stdout


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="weft package ")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        # A copy, because building leaves files beside the sources.
        shutil.copytree(ROOT / "proto/python", cls.folder / "client", ignore=shutil.ignore_patterns("__pycache__"))
        venv.create(cls.folder / "env", system_site_packages=True, symlinks=True)
        cls.python = cls.folder / "env/bin/python"
        run(cls.python, "-m", "pip", "install", "--quiet", "--no-index", "--no-build-isolation",
            "--disable-pip-version-check", cls.folder / "client")

    def python_says(self, script):
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        return run(self.python, "-c", script, cwd=self.folder, env=environment).strip()

    def test_it_is_installed_as_its_page_says_with_the_projects_version(self):
        place = self.python_says("import weft; print(weft.__file__)")
        self.assertTrue(Path(place).is_relative_to(self.folder / "env"), place)
        project = re.search(r"^project\(weft VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE)
        told = "import weft, importlib.metadata as m; print(weft.__version__, m.version('weft-client'))"
        self.assertEqual(self.python_says(told).split(), [project[1]] * 2)
        self.assertTrue((Path(place).parent / "py.typed").exists())

    def test_every_module_of_it_is_installed(self):
        script = "import weft, pathlib; p = pathlib.Path(weft.__file__).parent; " \
                 "print(*sorted(f.relative_to(p).as_posix() for f in p.rglob('*.py')))"
        source = ROOT / "proto/python/weft"
        ours = sorted(path.relative_to(source).as_posix() for path in source.rglob("*.py"))
        self.assertEqual(self.python_says(script).split(), ours)

    def test_both_forms_have_the_same_commands_with_the_same_arguments(self):
        script = """
import inspect, weft
for name, call in inspect.getmembers(weft.Client, inspect.iscoroutinefunction):
    if name[0] != "_":
        other = getattr(weft.SyncClient, name)
        assert inspect.signature(call) == inspect.signature(other), name
        assert inspect.getdoc(call) and inspect.getdoc(call) == inspect.getdoc(other) or name == "close", name
        print(name)
"""
        self.assertGreater(len(self.python_says(script).split()), 20)

    @unittest.skipUnless(CHECKER.exists(), "pyright is not installed: ./dev setup --test does it")
    def test_a_checker_finds_each_misspelt_call_and_nothing_else(self):
        for name in ("python_good.py", "python_bad.py"):
            shutil.copy(TYPES / name, self.folder)
        config = {"include": ["python_*.py", "client/weft"], "strict": ["python_*.py"]}
        (self.folder / "pyrightconfig.json").write_text(json.dumps(config), encoding="utf-8")
        done = subprocess.run(
            ["node", CHECKER, "--outputjson", "--pythonpath", self.python, "-p", self.folder],
            capture_output=True, text=True, timeout=200, check=False)
        report = json.loads(done.stdout)
        self.assertGreater(report["summary"]["filesAnalyzed"], 30)  # with the package itself
        found = {(Path(d["file"]).name, d["range"]["start"]["line"]): d["message"]
                 for d in report["generalDiagnostics"] if not d["rule"].startswith(FOLLOWS)}
        lines = (TYPES / "python_bad.py").read_text(encoding="utf-8").splitlines()
        wrong = {("python_bad.py", number) for number, line in enumerate(lines) if line.endswith("# wrong")}
        self.assertGreater(len(wrong), 15)
        self.assertEqual(set(found), wrong, found)


if __name__ == "__main__":
    if sys.executable != "/usr/bin/python3":
        print(f"with {sys.executable}, which needs pip, setuptools and wheel")
    unittest.main(verbosity=2)
