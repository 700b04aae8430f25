"""Prints for each room of the C++ sources its size, comments, functions, asserts and largest class.

    ./dev house [folder of another checkout]

A room is a folder of core, or another folder at the top. Functions and classes are those that
universal-ctags finds; a function is as long as the lines from its name to its closing brace.
A line of code is neither blank nor a comment nor part of an assert; a comment is a line that holds
one. Upward includes are those that the floors of core and server forbid (layers.py).
"""

import json
import re
import subprocess
import sys
from collections import Counter, defaultdict
from pathlib import Path, PurePosixPath

import layers

# Rooms that are to be rebuilt, and that the third sum leaves out.
REBUILT = ("core/contact/guard", "core/contact/objects")
TOPS = ("core", "proto", "server")
COMMENT = re.compile(r"(^|[ \t])//")
ASSERT = re.compile(r"\bassert\(")
COLUMNS = ("room", "files", "lines", "code", "comments", "functions", "median", "p90", "longest", "asserts",
           "per 1000", "largest class", "members", "upward")


def sources(root):
    """The C++ sources, with their text."""
    listed = subprocess.run(["git", "-C", root, "ls-files", "-z", "-co", "--exclude-standard", "--", *TOPS],
                            capture_output=True, text=True, check=True).stdout
    names = [PurePosixPath(name) for name in listed.split("\0") if name]
    return {name: Path(root, name).read_text(encoding="utf-8") for name in sorted(names)
            if name.suffix in layers.CPP and Path(root, name).is_file()}


def rooms_of(name):
    """The rooms that a file counts in: its own and the whole."""
    top = name.parts[0]
    if top != "core":
        return [top]
    own = "core/" + name.parts[1] if len(name.parts) > 2 else "core/*"
    if own == "core/contact":
        inner = name.parts[2] if len(name.parts) > 3 else "*"
        own = f"core/contact/{inner}"
    return [own, "core"] + ([] if own in REBUILT else ["core without guard and objects"])


def tags_of(root, names):
    """What ctags finds in the files: functions with their ends, and members with their classes."""
    command = ["ctags", "--languages=C++", "--kinds-C++=fm", "--fields=+neKs", "--output-format=json",
               "--langmap=C++:+.h", "-f", "-", "-L", "-"]
    found = subprocess.run(command, cwd=root, input="\n".join(map(str, names)), capture_output=True, text=True,
                           check=True).stdout
    return [json.loads(line) for line in found.splitlines()]


def code_lines(lines):
    """The number of lines that are neither blank, nor a comment, nor of an assert."""
    count = depth = 0
    for line in map(str.strip, lines):
        if depth > 0 or line.startswith("assert("):
            depth += line.count("(") - line.count(")")
        elif line and not line.startswith("//"):
            count += 1
    return count


def share(values, part):
    """The value below which so large a part of them lies."""
    return sorted(values)[min(len(values) - 1, int(part * len(values)))] if values else 0


def table(root):
    files = sources(root)
    counts, lengths, members = defaultdict(Counter), defaultdict(list), defaultdict(Counter)
    for name, text in files.items():
        lines = text.splitlines()
        upward = sum(layers.floor_of(header) > layers.floor_of(name)
                     for quote, header in layers.INCLUDE.findall(text)
                     if quote == '"' and header.startswith(name.parts[0] + "/"))
        for room in rooms_of(name):
            counts[room].update(files=1, lines=len(lines), code=code_lines(lines), upward=upward,
                                comments=sum(bool(COMMENT.search(line)) for line in lines),
                                asserts=len(ASSERT.findall(text)))
    for tag in tags_of(root, files):
        for room in rooms_of(PurePosixPath(tag["path"])):
            if tag["kind"] == "function" and "end" in tag:
                lengths[room].append(tag["end"] - tag["line"] + 1)
            elif tag["kind"] == "member" and tag.get("scopeKind") in ("class", "struct"):
                members[room][tag["scope"]] += 1
    for room in sorted(counts):
        count, lines = counts[room], counts[room]["lines"]
        biggest, most = members[room].most_common(1)[0] if members[room] else ("", 0)
        yield (room, count["files"], lines, count["code"], f"{100 * count['comments'] / lines:.1f} %", len(lengths[room]),
               share(lengths[room], 0.5), share(lengths[room], 0.9), max(lengths[room], default=0),
               count["asserts"], f"{1000 * count['asserts'] / lines:.1f}", biggest.split("::")[-1], most,
               count["upward"])


def main():
    root = sys.argv[1] if len(sys.argv) > 1 else str(Path(__file__).resolve().parents[2])
    rows = [COLUMNS, *table(root)]
    widths = [max(len(str(row[k])) for row in rows) for k in range(len(COLUMNS))]
    for row in rows:
        print("  ".join(str(cell).ljust(width) if k in (0, 11) else str(cell).rjust(width)
                        for k, (cell, width) in enumerate(zip(row, widths))).rstrip())


if __name__ == "__main__":
    main()
