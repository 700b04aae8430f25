"""Rules on who may know whom and on what a source file may hold, checked on its text.

core knows no socket, no JSON, no thread and no clock; proto knows no physics; server joins the two,
in its translate files alone; web knows the wire alone.
"""

import re
from pathlib import Path, PurePosixPath
from posixpath import normpath

TOP_LEVEL = {"CMakeLists.txt", "server", "core", "web", "proto", "tests", "README.md", "dev", "LICENSE"}
CPP = {".h", ".cpp"}
SCRIPT = {".ts", ".js", ".mjs"}
CODE = CPP | SCRIPT | {".py", ".cmake", ".css", ".html"}
LONGEST_FILE = 400
# Files that people copy into their own work as one piece.
ONE_PIECE = {"tests/server/hostile_client_test.py", "tests/proto/js/client.test.mjs"}
ONLY_WITH_ASSIMP = "core/geometry/mesh_file.cpp"

# The flag by which whoever owns a thread ends the work on it.
RAISED_FROM_OTHER_THREADS = "core/stop_signal.h"

# Ranges, numbers alone: core checks its definitions against them, and the wire its messages.
SHARED_NUMBERS = "core/ranges.h"

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(["<])([^">]+)[">]', re.M)
THREADS = (r"thread|mutex|shared_mutex|future|condition_variable|semaphore|barrier|latch|stop_token|"
           r"atomic|pthread\.h")
SOCKETS = r"sys/.*|netinet/.*|arpa/.*|netdb\.h|unistd\.h|poll\.h"
CLOCKS = r"chrono|ctime|time\.h"
# Room -> (where its own headers may come from, headers of others that it must not include).
ROOMS = {
    "core": (("core",), re.compile(
        rf"(boost/.*|nlohmann/.*|spdlog/.*|CLI/.*|{THREADS}|{SOCKETS}|{CLOCKS})$")),
    "proto": (("proto",), re.compile(
        rf"(boost/.*|Eigen/.*|assimp/.*|hwy/.*|spdlog/.*|CLI/.*|{THREADS}|{SOCKETS}|{CLOCKS})$")),
    "server": (("server", "core", "proto"), re.compile(r"(assimp/.*|hwy/.*)$")),
    "tests/core": (("core", "tests"), re.compile(r"(boost/.*|nlohmann/.*)$")),
    "tests/laws": (("core", "tests"), re.compile(r"(boost/.*|nlohmann/.*)$")),
    "tests/proto": (("proto", "tests"), re.compile(r"(boost/.*|Eigen/.*)$")),
}
# Folders of core, the lowest first; files beside the folders are below all of them.
FLOORS = ("math", "geometry", "cloth", "forces", "contact", "attachments", "diagnostics", "solver", "world",
          "scenes")
# Folders of the server, the same.
SERVER_FLOORS = ("scene", "translate", "room", "rooms", "net", "commands")
# Folders of proto, the same.
PROTO_FLOORS = ("codec", "frames", "messages")
FLOORS_OF = {"core": FLOORS, "proto": PROTO_FLOORS, "server": SERVER_FLOORS}
# Folders of the page, the lowest first; files beside the folders join them and are above all.
PAGE_FLOORS = ("wire", "view", "hold", "panel")
CLOCK_USE = re.compile(r"std::chrono|\b(clock_gettime|gettimeofday|random_device)\b")

IMPORT = re.compile(
    r"""^[ \t]*(?:import|export)\b[^;'"]*?\bfrom\s*['"]([^'"]+)['"]"""
    r"""|^[ \t]*import\s*['"]([^'"]+)['"]|\bimport\(\s*['"]([^'"]+)['"]""", re.M)
# Folder -> (what of ours it may import, packages it may import).
SCRIPT_ROOMS = {
    "web/src": (("web/", "proto/js/"), re.compile(r"(three(/.*)?|uqr)$")),
    "proto/js": (("proto/js/",), re.compile(r"(ws|node:.*)$")),
}

# The first line of a source that is neither empty nor scaffolding.
FIRST_WORDS = re.compile(r"^(?!\s*$|#|namespace\b|HWY_)\s*(.*)$", re.MULTILINE)
UNFINISHED = re.compile(r"\b(TO" r"DO|FIX" r"ME|XX" r"X|HA" r"CK)\b")
MACHINE_PATH = re.compile(r"(?<![\w./-])/(?:work|root|home|Users|farm)/\w|/tmp/\w")
DOWNLOAD_ADDRESS = re.compile(r'"resolved"\s*:')


def room_of(name, rooms):
    """The entry of `rooms` for the folder that the file lies in, or None."""
    return next((room for room in rooms if name.as_posix().startswith(room + "/")), None)


def cpp_problems(name, text):
    headers = INCLUDE.findall(text)
    room = room_of(name, ROOMS)
    if room:
        own, forbidden = ROOMS[room]
        for quote, header in headers:
            shared = room == "proto" and header == SHARED_NUMBERS
            if quote == '"' and header.split("/")[0] not in own and is_from_root(header) and not shared:
                yield f"{room} must not include {header}"
            flag = header == "atomic" and str(name) == RAISED_FROM_OTHER_THREADS
            if forbidden.match(header) and not flag:
                yield f"{room} must not include <{header}>"
    if room in FLOORS_OF:
        if len(name.parts) > 2 and name.parts[1] not in FLOORS_OF[room]:
            yield f"{room}/{name.parts[1]} is no floor of {room}"
        for quote, header in headers:
            if quote == '"' and header.startswith(room + "/") and floor_of(header) > floor_of(name):
                yield f"{header} is on a floor above this file"
    for quote, header in headers:
        if quote == '"' and not is_from_root(header):
            yield f"{header} is not included from the root"
        if header.startswith("assimp/") and room != "server" and str(name) != ONLY_WITH_ASSIMP:
            yield f"only {ONLY_WITH_ASSIMP} may include assimp"
    if room == "core" and "namespace weft" in text and not opens_with_its_purpose(text):
        yield "does not open with a line on what it does"
    if room == "core" and CLOCK_USE.search(text):
        yield "core must not read a clock"
    if room == "server" and name.parts[1] != "translate":
        sides = {header.split("/")[0] for _, header in headers}
        if {"core", "proto"} <= sides:
            yield "only server/translate joins core and proto"
    if name.suffix == ".h" and not name.stem.endswith("-inl") and "#pragma once" not in text:
        yield "has no #pragma once"


def opens_with_its_purpose(text):
    """Whether a comment on the whole file, not on its first entity, stands before all code."""
    return FIRST_WORDS.search(text)[1].startswith("// ")


def floor_of(name):
    """The height of a file of core, proto or server; -1 beside the folders."""
    top, *folders = PurePosixPath(name).parts[:-1]
    floors = FLOORS_OF.get(top, ())
    return floors.index(folders[0]) if folders and folders[0] in floors else -1


def is_from_root(header):
    return header.startswith(("core/", "proto/", "server/", "tests/"))


def script_problems(name, text):
    room = room_of(name, SCRIPT_ROOMS)
    if not room:
        return
    own, packages = SCRIPT_ROOMS[room]
    for target in (next(filter(None, found)) for found in IMPORT.findall(text)):
        path = normpath((name.parent / target).as_posix()) if target.startswith(".") else target
        if not path.startswith(own) and not packages.match(path):
            yield f"{room} must not import {path}"
        if path.startswith("web/src/") and page_floor_of(path) > page_floor_of(name):
            yield f"{path} is on a floor above this file"


def page_floor_of(name):
    """The height of a file of the page; above all folders beside them."""
    folder = PurePosixPath(name).parts[2]
    return PAGE_FLOORS.index(folder) if folder in PAGE_FLOORS else len(PAGE_FLOORS)


def text_problems(name, text):
    if UNFINISHED.search(text):
        yield "unfinished business is left in it"
    if MACHINE_PATH.search(text):
        yield "names a path of somebody's machine"
    lines = text.count("\n")
    code = name.suffix in CODE or name.name in {"dev", "CMakeLists.txt"}
    if code and lines > LONGEST_FILE and name.as_posix() not in ONE_PIECE:
        yield f"has {lines} lines, more than {LONGEST_FILE}"


def file_problems(name, text):
    if name.name == "package-lock.json":
        if DOWNLOAD_ADDRESS.search(text):
            yield "names the address of a download"
        return
    yield from text_problems(name, text)
    if name.suffix in CPP:
        yield from cpp_problems(name, text)
    if name.suffix in SCRIPT:
        yield from script_problems(name, text)


def problems(root, files):
    """Yields "file: what is wrong" for the files, whose names are relative to root."""
    for name in sorted(map(PurePosixPath, files)):
        top = name.parts[0]
        if top not in TOP_LEVEL and not top.startswith("."):
            yield f"{name}: {top} does not belong at the top level"
        path = Path(root, name)
        if not path.is_file():
            continue
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue  # a picture, or golden bytes
        for problem in file_problems(name, text):
            yield f"{name}: {problem}"
