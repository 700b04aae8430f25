"""The dev script in a tree and on a machine that are both made up.

Each tool that it calls is a recorder first on the path, so that nothing is installed or built.
"""

import os
import shutil
import signal
import socket
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ.get("WEFT_SOURCE_DIR", Path(__file__).resolve().parents[2]))

RECORD = '#!/bin/bash\necho "$(basename "$0") $*" >> "$MACHINE/calls"\n'
TOOLS = {
    # Everything asked for is installed but what the file `missing` names.
    "dpkg-query": r"""
for name in "${@:4}"; do
  grep -qx "$name" "$MACHINE/missing" || printf '<%s installed>' "$name"
done
""",
    "apt-get": '[[ " $* " != *" install "* ]] || : > "$MACHINE/missing"\n',
    "apt-cache": '[[ ! -e "$MACHINE/no-lists" ]]\n',
    "sudo": '[[ $1 != -* ]] || shift\nexec "$@"\n',
    "node": 'cat "$MACHINE/node-version"\n',
    "npm": "mkdir -p node_modules\n",
    "cmake": 'while [[ $1 != -B ]]; do shift; done; mkdir -p "$2"; touch "$2/build.ninja"\n'
             'printf "CMAKE_HOME_DIRECTORY:INTERNAL=%s\\n" "$TREE" > "$2/CMakeCache.txt"\n',
    "ninja": 'exit "$(cat "$MACHINE/ninja-status")"\n',
    "ctest": 'echo "100% tests passed, 0 tests failed out of 1"; exit "$(cat "$MACHINE/ctest-status")"\n',
    "dpkg-deb": "mkdir -p usr/sbin && printf '#!/bin/bash' > usr/sbin/nginx && chmod +x usr/sbin/nginx\n",
    "clang-format-14": "",
    "clang-tidy-14": "",
}
CHECKS = "tests/proto/types"
NGINX = "tests/web/support/nginx.sh"
SERVER = """
port="$*"
port="${port##*--port }"
port="${port%% *}"
trap 'echo stopped >&2; exit 0' INT TERM
echo '{"url":"http://127.0.0.1:'"$port"'/","port":'"$port"'}'
[[ " $* " == *" --serve-nothing "* ]] && exit 3
while :; do sleep 0.05; done
"""


def executable(path, text):
    path.write_text(text, encoding="utf-8")
    path.chmod(0o755)


class DevScript(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="dev test ")
        self.addCleanup(folder.cleanup)
        self.machine = Path(folder.name, "machine")
        self.tree = Path(folder.name, "a tree")
        for path in (self.machine / "bin", self.tree / "web", self.tree / "build"):
            path.mkdir(parents=True)
        for name, text in TOOLS.items():
            executable(self.machine / "bin" / name, RECORD + text)
        executable(self.tree / "build" / "weft", RECORD + SERVER)
        self.nginx = self.tree / ".tools" / "nginx" / "usr" / "sbin" / "nginx"
        self.nginx.parent.mkdir(parents=True)
        executable(self.nginx, "#!/bin/bash")
        shutil.copy(ROOT / "dev", self.tree / "dev")
        (self.tree / NGINX).parent.mkdir(parents=True)
        shutil.copy(ROOT / NGINX, self.tree / NGINX)
        for folder in ("web", CHECKS):
            (self.tree / folder).mkdir(parents=True, exist_ok=True)
            (self.tree / folder / "package-lock.json").write_text("{}")
        for name, text in (("calls", ""), ("missing", ""), ("node-version", "v18.20.4\n"),
                           ("ninja-status", "0"), ("ctest-status", "0")):
            (self.machine / name).write_text(text)

    def start(self, *arguments, script=None):
        process = subprocess.Popen(
            [script or self.tree / "dev", *arguments], cwd=self.machine, text=True,
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            start_new_session=True,
            env={**os.environ, "MACHINE": str(self.machine), "TREE": str(self.tree),
                 "PATH": f"{self.machine / 'bin'}:/usr/bin:/bin"})
        self.addCleanup(self.end, process)
        return process

    @staticmethod
    def end(process):
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        process.stdout.close()
        process.stderr.close()

    def dev(self, *arguments, script=None):
        process = self.start(*arguments, script=script)
        out, error = process.communicate(timeout=60)
        return process.returncode, out, error

    def calls(self, tool):
        """What the tool was called with, one string a call; forgets all calls so far."""
        lines = (self.machine / "calls").read_text().splitlines()
        (self.machine / "calls").write_text("")
        return [line[len(tool) + 1:] for line in lines if line.split(" ")[0] == tool]

    def test_what_is_missing_is_installed_in_one_go_and_nothing_removed(self):
        (self.machine / "missing").write_text("ninja-build\nlibeigen3-dev\n")
        self.assertEqual(self.dev("setup")[0], 0)
        (call,) = self.calls("apt-get")
        self.assertIn("--no-remove", call)
        self.assertIn("--no-install-recommends", call)
        self.assertTrue(call.endswith(" ninja-build libeigen3-dev"), call)

    def test_where_nothing_is_missing_no_package_tool_is_called(self):
        self.dev("setup")
        self.calls("apt-get")
        self.assertEqual(self.dev("setup")[0], 0)
        recorded = (self.machine / "calls").read_text()
        self.assertNotIn("apt-get", recorded)
        self.assertNotIn("npm", recorded)

    def test_lists_are_fetched_where_there_are_none(self):
        (self.machine / "missing").write_text("ccache\n")
        (self.machine / "no-lists").touch()
        self.dev("setup")
        update, install = self.calls("apt-get")
        self.assertTrue(update.endswith(" update"), update)
        self.assertTrue(install.endswith(" ccache"), install)

    def test_an_old_node_is_replaced_by_debians(self):
        (self.machine / "missing").write_text("nodejs\nnpm\n")
        (self.machine / "node-version").write_text("v16.3.0\n")
        self.dev("setup")
        (call,) = self.calls("apt-get")
        self.assertTrue(call.endswith(" nodejs npm"), call)

    def test_running_needs_neither_browser_nor_test_library(self):
        (self.machine / "missing").write_text("chromium\ncatch2\n")
        process = self.start("run")
        process.stdout.readline()
        process.terminate()
        process.communicate(timeout=60)
        self.assertEqual(self.calls("apt-get"), [])

    def test_testing_installs_browser_and_test_library(self):
        (self.machine / "missing").write_text("chromium\ncatch2\n")
        self.assertEqual(self.dev("test")[0], 0)
        (call,) = self.calls("apt-get")
        self.assertTrue(call.endswith(" catch2 chromium"), call)

    def test_testing_unpacks_a_proxy_and_installs_none_and_running_needs_none(self):
        self.nginx.unlink()
        self.dev("setup")
        self.assertEqual(self.calls("apt-get"), [])
        self.assertEqual(self.dev("test")[0], 0)
        (call,) = self.calls("apt-get")
        self.assertTrue(call.endswith(" download nginx"), call)
        self.assertTrue(os.access(self.nginx, os.X_OK))
        self.assertEqual(self.dev("test")[0], 0)
        self.assertEqual(self.calls("apt-get"), [])

    def test_the_pages_packages_follow_the_lock_file(self):
        self.dev("setup")
        self.assertEqual(len(self.calls("npm")), 1)
        self.dev("setup")
        self.assertEqual(len(self.calls("npm")), 0)
        (self.tree / "web" / "package-lock.json").write_text('{"new": 1}')
        self.dev("setup")
        self.assertEqual(len(self.calls("npm")), 1)

    def test_testing_installs_the_type_checker_and_running_does_not(self):
        self.dev("setup")
        self.assertFalse((self.tree / CHECKS / "node_modules").exists())
        self.calls("npm")
        self.dev("test")
        self.assertEqual(len(self.calls("npm")), 1)
        self.assertTrue((self.tree / CHECKS / "node_modules").is_dir())
        self.dev("test")
        self.assertEqual(len(self.calls("npm")), 0)

    def test_run_prints_one_line_and_ends_with_the_server(self):
        process = self.start("run", "--scene", "flag", "--port", "4321")
        self.assertEqual(process.stdout.readline(), "Weft is at http://127.0.0.1:4321/\n")
        process.send_signal(signal.SIGTERM)
        out, error = process.communicate(timeout=60)
        self.assertEqual((process.returncode, out), (0, ""))
        self.assertIn("stopped", error)
        self.assertEqual(self.calls("weft"), ["serve --scene flag --port 4321"])

    def test_control_c_stops_the_server(self):
        process = self.start("run", "--port", "4321")
        process.stdout.readline()
        os.killpg(process.pid, signal.SIGINT)
        self.assertIn("stopped", process.communicate(timeout=60)[1])
        self.assertEqual(process.returncode, 0)

    def test_run_takes_another_port_where_the_usual_one_is_taken(self):
        with socket.socket() as taken:
            taken.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                taken.bind(("127.0.0.1", 8080))
                taken.listen()
            except OSError:
                pass  # somebody else has it, which is as good
            process = self.start("run")
            self.assertEqual(process.stdout.readline(), "Weft is at http://127.0.0.1:0/\n")
            process.terminate()
            process.communicate(timeout=60)

    def test_the_servers_failure_is_the_scripts(self):
        self.assertEqual(self.dev("run", "--port", "1", "--serve-nothing")[0], 3)

    def test_a_failed_build_runs_no_test_and_a_failed_test_fails(self):
        (self.machine / "ctest-status").write_text("8")
        self.assertEqual(self.dev("test")[0], 8)
        self.calls("ctest")
        (self.machine / "ninja-status").write_text("1")
        self.assertEqual(self.dev("test")[0], 1)
        self.assertEqual(self.calls("ctest"), [])

    def test_the_filter_reaches_the_runner_and_its_summary_is_last(self):
        _, out, _ = self.dev("test", "^laws$")
        self.assertEqual(out.splitlines()[-1], "100% tests passed, 0 tests failed out of 1")
        self.assertTrue(self.calls("ctest")[0].endswith(" --tests-regex ^laws$"))

    def test_long_tests_run_in_the_full_tier_and_when_asked_for_by_name_alone(self):
        (self.machine / "bin" / "git").symlink_to("/bin/true")
        for arguments, excluded in ((["test"], True), (["test", "seed"], False), (["test", "--full"], False)):
            self.dev(*arguments)
            self.assertEqual("--label-exclude ^long$" in self.calls("ctest")[0], excluded, arguments)

    def test_the_full_tier_goes_on_after_a_failure_and_tells_of_it(self):
        (self.machine / "ctest-status").write_text("8")
        (self.machine / "bin" / "git").symlink_to("/bin/true")
        status, out, _ = self.dev("test", "--full")
        self.assertEqual(status, 1)
        self.assertEqual(len(self.calls("ctest")), 6)
        self.assertEqual(out.splitlines()[-1], "steps: 2 passed, 6 failed")

    def test_the_fuzz_has_sanitizers_unless_told_not_to_and_its_status_is_the_scripts(self):
        for options, folder in ((["90", "--seed", "3"], "build-sanitize"), (["--no-sanitize"], "build")):
            (self.tree / folder).mkdir(exist_ok=True)
            executable(self.tree / folder / "weft_fuzz", RECORD + "exit 5\n")
            status, _, error = self.dev("fuzz", *options)
            self.assertEqual(status, 5, error)
            lines = (self.machine / "calls").read_text().splitlines()
            self.assertEqual([line for line in lines if "-DWEFT_SANITIZE=address,undefined" in line] != [],
                             folder == "build-sanitize")
            (call,) = self.calls("weft_fuzz")
            self.assertTrue(call.endswith(" " + " ".join(options)), call)

    def test_a_second_build_is_not_configured_again_unless_the_tree_moved(self):
        self.dev("build")
        self.assertEqual(len(self.calls("cmake")), 1)
        self.dev("build")
        self.assertEqual(len(self.calls("cmake")), 0)
        (self.tree / "build" / "CMakeCache.txt").write_text("CMAKE_HOME_DIRECTORY:INTERNAL=/old\n")
        self.dev("build")
        self.assertEqual(len(self.calls("cmake")), 1)

    def test_it_is_found_through_a_link(self):
        link = self.machine / "link"
        link.symlink_to(self.tree / "dev")
        self.dev("build", script=link)
        self.assertIn(f"-C {self.tree}/build", self.calls("ninja")[0])

    def test_the_report_measures_and_then_draws_and_the_short_one_leaves_the_tree_alone(self):
        folder = self.tree / "tests" / "bench"
        folder.mkdir(parents=True)
        (folder / "report.py").write_text(
            "import os, sys\n"
            "open(os.environ['MACHINE'] + '/calls', 'a').write('report ' + ' '.join(sys.argv[1:]) + '\\n')\n")
        executable(self.tree / "build" / "weft_bench", RECORD)
        (self.machine / "missing").write_text("gnuplot-nox\n")
        status, _, error = self.dev("report")
        self.assertEqual(status, 0, error)
        lines = (self.machine / "calls").read_text().splitlines()
        order = [line for line in lines if line.split(" ")[0] in ("apt-get", "ninja", "weft_bench", "report")]
        self.assertEqual([line.split(" ")[0] for line in order], ["apt-get", "ninja", "weft_bench", "report"])
        self.assertTrue(order[0].endswith(" gnuplot-nox"))
        self.assertIn(f"--out {folder}/data", order[2])
        self.assertEqual(order[3], f"report --readme {self.tree}/README.md {folder}")
        (self.machine / "calls").write_text("")
        status, _, error = self.dev("report", "--short")
        self.assertEqual(status, 0, error)
        lines = (self.machine / "calls").read_text().splitlines()
        self.assertIn(f"report {self.tree}/build/report", lines)
        self.assertTrue(any(f"--out {self.tree}/build/report/data --quick" in line for line in lines))
        (self.machine / "calls").write_text("")
        status, _, error = self.dev("report", "--contact")
        self.assertEqual(status, 0, error)
        lines = (self.machine / "calls").read_text().splitlines()
        self.assertTrue(any(f"--out {folder}/data --parts contact-cases contact" in line for line in lines))

    def test_a_part_of_the_report_is_measured_apart_and_taken_in(self):
        folder = self.tree / "tests" / "bench"
        folder.mkdir(parents=True)
        (folder / "report.py").write_text(
            "import os, sys\n"
            "open(os.environ['MACHINE'] + '/calls', 'a').write('report ' + ' '.join(sys.argv[1:]) + '\\n')\n")
        executable(self.tree / "build" / "weft_bench", RECORD)
        status, _, error = self.dev("report", "--only", "--parts", "accuracy", "--sizes", "32")
        self.assertEqual(status, 0, error)
        part = f"{self.tree}/build/report/part"
        lines = (self.machine / "calls").read_text().splitlines()
        self.assertTrue(any(f"--out {part} --parts accuracy --sizes 32" in line for line in lines))
        self.assertIn(f"report --readme {self.tree}/README.md --measured {part} {folder}", lines)
        status, _, error = self.dev("report", "--only")
        self.assertNotEqual(status, 0)
        self.assertIn("options of bench", error)

    def test_unknown_words_are_refused_with_what_is_allowed(self):
        for words, allowed in (("deploy",), "usage"), (("build", "--fast"), "--sanitize"), \
                (("test", "--fast"), "--full"), (("setup", "x"), "--test"), \
                (("report", "x"), "--short"), (("format", "x"), "--check"), (("tidy", "x"), "--all"):
            status, _, error = self.dev(*words)
            self.assertNotEqual(status, 0, words)
            self.assertIn(allowed, error)


if __name__ == "__main__":
    unittest.main()
