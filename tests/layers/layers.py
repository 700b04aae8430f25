"""Rules on who may know whom, checked on the text of the sources.

core knows no socket, no JSON, no thread and no clock; proto knows no physics; server joins the two,
in its translate files alone; web knows the wire alone.
"""

import re
from pathlib import Path

CODE = {".h", ".cpp", ".ts", ".js", ".mjs", ".py"}
TOP_LEVEL = {"CMakeLists.txt", "server", "core", "web", "proto", "tests", "README.md", "dev", "LICENSE"}
LONGEST_FILE = 400
UNFINISHED = re.compile(r"\b(TO" r"DO|FIX" r"ME|XX" r"X|HA" r"CK)\b")
MACHINE_PATH = re.compile(r"[\"'(\s=](/work/|/root/|/home/|/farm/)")
CPP_INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.M)
JS_IMPORT = re.compile(r"(?:from|import)\s*\(?\s*[\"']([^\"']+)[\"']")

# Room -> (headers of ours that it may include, headers of others that it must not).
ROOMS = {
    "core": (("core/",), re.compile(
        r"^(boost/|nlohmann/|spdlog/|CLI/|thread$|mutex$|future$|atomic$|condition_variable$|"
        r"shared_mutex$|chrono$|ctime$|time\.h$|sys/|netinet/|arpa/|unistd\.h$|pthread\.h$)")),
    "proto": (("proto/",), re.compile(r"^(boost/|Eigen/|assimp/|spdlog/|CLI/|thread$|mutex$|sys/)")),
    "server": (("server/", "core/", "proto/"), re.compile(r"^(assimp/)")),
}


def cpp_problems(name, text):
    room = name.parts[0]
    for quote, header in CPP_INCLUDE.findall(text):
        if room in ROOMS:
            allowed, forbidden = ROOMS[room]
            if quote == '"' and "/" in header and not header.startswith(allowed):
                yield f"{room} must not include {header}"
            if quote == "<" and forbidden.match(header):
                yield f"{room} must not include <{header}>"
        if quote == '"' and not header.startswith(("core/", "proto/", "server/", "tests/")):
            yield f"{header} is not included from the root"
        if header.startswith("assimp/") and name.as_posix() != "core/geometry/mesh_file.cpp":
            yield "only core/geometry/mesh_file.cpp may include assimp"
    if room == "server" and not name.stem.startswith("translate"):
        headers = [header for _, header in CPP_INCLUDE.findall(text)]
        physics = [h for h in headers if h.startswith("core/")]
        wire = [h for h in headers if h.startswith("proto/")]
        if physics and wire and name.suffix == ".cpp":
            yield f"only server/translate joins core ({physics[0]}) and proto ({wire[0]})"


def web_problems(name, text):
    for target in JS_IMPORT.findall(text):
        if not target.startswith("."):
            continue
        resolved = Path(*_normal((name.parent / target).parts))
        if resolved.parts[0] != "web" and resolved.parts[:2] != ("proto", "js"):
            yield f"web must not import {resolved.as_posix()}"


def _normal(parts):
    result = []
    for part in parts:
        if part == "..":
            result.pop()
        elif part != ".":
            result.append(part)
    return result


def file_problems(name, text):
    if name.suffix in {".h", ".cpp"}:
        yield from cpp_problems(name, text)
    if name.parts[0] == "web" and name.suffix in {".ts", ".js", ".mjs"}:
        yield from web_problems(name, text)
    if name.suffix in CODE:
        if UNFINISHED.search(text):
            yield "unfinished business is left in the code"
        if MACHINE_PATH.search(text):
            yield "names a path of somebody's machine"
        if text.count("\n") > LONGEST_FILE:
            yield f"has {text.count(chr(10))} lines, more than {LONGEST_FILE}"


def problems(root, files):
    """Yields "file: what is wrong" for the files, given relative to root."""
    for name in sorted(map(Path, files)):
        top = name.parts[0]
        if top not in TOP_LEVEL and not top.startswith("."):
            yield f"{name}: {top} does not belong at the top level"
        path = root / name
        if name.suffix not in CODE or not path.is_file():
            continue
        for problem in file_problems(name, path.read_text(encoding="utf-8")):
            yield f"{name}: {problem}"
