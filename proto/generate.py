#!/usr/bin/python3
"""Writes what follows from the descriptions of the messages (proto/messages): the declarations in js/commands.d.ts,
js/results.d.ts and js/parts.d.ts, python/weft/commands.py, and the tables of README.md.

Usage: generate.py PROGRAM [--check]. PROGRAM is weft_messages, which prints the descriptions. With --check nothing is
written; it fails if a file is not what it would write.
"""

import json
import subprocess
import sys
import textwrap
from pathlib import Path

PROTO = Path(__file__).parent
WIDTH = 118  # of a line of Python
SUMMARIES = {  # of the commands whose methods in Python follow from their fields alone
    "camera": "Stores where this viewer looks from, so that others may follow.",
    "pause": "Stops the room's clock.",
    "resume": "Lets the room's clock run.",
    "step": "Lets ticks pass in a paused room.",
    "reset": "Back to the scene's start.",
    "speed": "Sets how fast time passes.",
    "gripper": "Opens, closes (opening=0) or moves a gripper; omitted values stay as they are.",
    "set": "Changes forces, settings and fabric of the room; omitted values stay as they are.",
}
TABLES = {"hello", "camera", "gripper", "set", "advance", "view"}  # that README.md has
NUMBERS = {"number": "number", "integer": "number"}
SCRIPT = {
    **NUMBERS, "boolean": "boolean", "string": "string", "vector": "Vec3", "rotation": "number[]",
    "name_or_place": "string | number", "name_or_object": "string | object",
}
PYTHON = {
    "number": "float", "integer": "int", "boolean": "bool", "string": "str", "vector": "Iterable[float]",
    "rotation": "Iterable[float]", "name_or_place": "str | int", "name_or_object": "str | dict",
}


def number_text(value):
    return f"{value:.15g}" if abs(value) < 1e6 or value % 1e5 else f"{value:,.0f}".replace(",", " ")


def value_text(field):
    """The values that a field may have, in words."""
    kind = field.get("type")
    if isinstance(kind, dict) and "words" in kind:
        return " or ".join(f"`{word}`" for word in kind["words"])
    if isinstance(kind, dict) and "list" in kind and isinstance(kind["list"], dict) and "words" in kind["list"]:
        return "list of " + ", ".join(f"`{word}`" for word in kind["list"]["words"])
    if "range" not in field:
        return {"boolean": "`true` or `false`"}.get(kind, "") if isinstance(kind, str) else ""
    least, most = (number_text(end) for end in field["range"])
    if isinstance(kind, dict):
        return f"list of at most {most}"
    span = f"±{most}" if least == "-" + most else f"{least} to {most}"
    if kind in ("string", "name_or_object"):
        return f"{span} {field['unit']}"
    return {"vector": f"3 × {span}", "rotation": "unit quaternion"}.get(kind, span)


def unit_text(field):
    """The unit in brackets; that of a length stands with its values."""
    return f" [{field['unit']}]" if field.get("unit") and field["type"] not in ("string", "name_or_object") else ""


def wrapped(items, indent):
    """Lines of items with commas between them, none of which is broken."""
    lines = textwrap.wrap(", ".join(item.replace(" ", "\0") for item in items) + ",", WIDTH, initial_indent=indent,
                          subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)
    return [line.replace("\0", " ") for line in lines]


def described(field):
    """Meaning, unit and values of a field in one line."""
    unit = unit_text(field)
    values = value_text(field)
    return f"{field['meaning']}{unit}" + (f"; {values}" if values else "")


# --- declarations ---


def script_type(kind):
    if isinstance(kind, str):
        return SCRIPT[kind]
    if "words" in kind:
        return " | ".join(f"'{word}'" for word in kind["words"])
    if "list" in kind:
        inner = script_type(kind["list"])
        return f"({inner})[]" if " " in inner else inner + "[]"
    return kind["object"]


def script_fields(fields, loose=False):
    for field in fields:
        if "constant" in field:
            yield f"  {field['name']}: {json.dumps(field['constant'])};".replace('"', "'")
            continue
        if field["meaning"]:
            yield f"  /** {described(field)} */"
        null = " | null" if field.get("nullable") else ""
        mark = "" if field.get("required") and not loose else "?"
        yield f"  {field['name']}{mark}: {script_type(field['type'])}{null};"


def objects_of(fields):
    """All types of objects in some fields, by name."""
    found = {}
    for field in fields:
        kind = field.get("type")
        while isinstance(kind, dict) and "list" in kind:
            kind = kind["list"]
        if isinstance(kind, dict) and "object" in kind:
            found |= objects_of(kind["fields"])
            found[kind["object"]] = kind["fields"]
    return found


def type_name(op):
    return "".join(part.capitalize() for part in op.split("_"))


HEAD = "// Written by proto/generate.py from the descriptions in proto/messages. Do not edit."


def part_declarations(messages):
    """Of what stands in messages, and of those of the server."""
    yield from (HEAD, "", "import type { Vec3 } from './messages.js';")
    everything = [field for kind in messages.values() for m in kind for field in m["fields"]]
    everything += [{"type": part} for part in messages["parts"]]
    for name, fields in objects_of(everything).items():
        yield from ("", f"export interface {name} {{", *script_fields(fields), "}")
    for event in messages["events"]:
        name = type_name(event["op"])
        yield from ("", f"export interface {name} {{", f"  op: '{event['op']}';", *script_fields(event["fields"]), "}")


def command_declarations(messages):
    forms, parts = {}, {}
    for command in messages["commands"]:
        forms.setdefault(command["op"], []).append(command["fields"])
        parts |= objects_of(command["fields"])
    yield from (HEAD, "", "import type { Vec3 } from './messages.js';")
    yield f"import type {{ {', '.join(sorted(parts))} }} from './parts.js';"
    for op, alternatives in forms.items():
        names = []
        for number, fields in enumerate(alternatives, 1):
            names.append(type_name(op) + "Command" + (str(number) if len(alternatives) > 1 else ""))
            yield from ("", f"/** The fields of `{op}`. */", f"export interface {names[-1]} {{")
            yield from (*script_fields(fields), "}")
        if len(names) > 1:
            yield from ("", f"export type {type_name(op)}Command = {' | '.join(names)};")


def result_declarations(messages):
    """Of the answers to commands, without what all have."""
    names = {}
    for reply in messages["replies"]:
        names.setdefault(reply["op"], []).append(reply["fields"])
    parts = {name for reply in messages["replies"] for name in objects_of(reply["fields"])}
    yield from (HEAD, "", "import type { Vec3 } from './messages.js';")
    yield f"import type {{ {', '.join(sorted(parts & {'Hit', 'Fan'}))} }} from './parts.js';"
    for op, alternatives in names.items():
        for number, fields in enumerate(alternatives, 1):
            name = type_name(op) + "Result" + (str(number) if len(alternatives) > 1 else "")
            yield from ("", f"/** What the answer to `{op}` has. */", f"export interface {name} {{")
            yield from (*script_fields(fields), "}")


# --- the Python client ---


def python_type(kind):
    if isinstance(kind, str):
        return PYTHON[kind]
    if "words" in kind:
        return "str"
    return f"list[{python_type(kind['list'])}]" if "list" in kind else "dict"


def python_method(command):
    fields, op = command["fields"], command["op"]
    placed, named = [], []
    for field in fields:
        if field.get("required"):
            placed.append(f"{field['name']}: {python_type(field['type'])}")
        elif len(fields) == 1:
            placed.append(f"{field['name']}: {python_type(field['type'])} = {field['default']!r}")
        else:
            named.append(f"{field['name']}: {python_type(field['type'])} | None = None")
    arguments = ["self", *placed, "*", *named, "timeout=CLIENTS"]
    head = f"    async def {op}({', '.join(arguments)}) -> dict:"
    if len(head) <= WIDTH:
        yield head
    else:
        yield f"    async def {op}("
        yield from wrapped(arguments, " " * 8)
        yield "    ) -> dict:  # fmt: skip"
    if fields:
        yield f'        """{SUMMARIES[op]}'
        yield ""
        for field in fields:
            line = f"{field['name']}: {described(field)}".replace("`", "")
            yield from textwrap.wrap(line, WIDTH, initial_indent=" " * 8, subsequent_indent=" " * 12)
        yield '        """'
    else:
        yield f'        """{SUMMARIES[op]}"""'
    if not fields:
        yield f'        return await self.request("{op}", timeout=timeout)'
        return
    listed = ("vector", "rotation")
    values = [f'"{f["name"]}": ' + (f"listed({f['name']})" if f["type"] in listed else f["name"]) for f in fields]
    body = "fields = {" + ", ".join(values) + "}"
    if len(body) + 8 <= WIDTH:
        yield "        " + body
    else:
        yield "        fields = {"
        yield from wrapped(values, " " * 12)
        yield "        }  # fmt: skip"
    yield f'        return await self.request("{op}", timeout=timeout, **without_none(fields))'


PYTHON_HEAD = '''"""Commands that follow from their fields. Written by proto/generate.py from the descriptions in proto/messages."""

from __future__ import annotations

from collections.abc import Iterable

from .fields import listed, without_none
from .session import Session
from .timeouts import CLIENTS


class Commands(Session):
    """Commands that follow from their fields."""'''


def python_commands(messages):
    yield PYTHON_HEAD
    for command in messages["commands"]:
        if command["op"] in SUMMARIES:
            yield from ("", *python_method(command))


# --- tables ---


def table(fields):
    yield "| field | meaning | values | default |"
    yield "|---|---|---|---|"
    for field in fields:
        unit = unit_text(field)
        usual = field.get("default", "needed" if field.get("required") else "")
        usual = json.dumps(usual) if not isinstance(usual, str) else usual
        yield f"| `{field['name']}` | {field['meaning']}{unit} | {value_text(field)} | {usual} |"


def tables(messages):
    """All tables, by the name in their mark."""
    found = {}
    for command in messages["commands"]:
        if command["op"] in TABLES:
            found[command["op"]] = table(command["fields"])
            for name, fields in objects_of(command["fields"]).items():
                found[name] = table(fields)
    return {name: "\n".join(rows) for name, rows in found.items()}


# --- files ---


def between(text, start, end, inner):
    """The text with what stands between two marks replaced."""
    head, found, rest = text.partition(start)
    if not found or end not in rest:
        sys.exit(f"no {start!r} … {end!r}")
    return head + start + inner + end + rest.partition(end)[2]


def written(messages):
    """All files that follow from the descriptions, with their content."""
    yield PROTO / "js/commands.d.ts", "\n".join(command_declarations(messages)) + "\n"
    yield PROTO / "js/results.d.ts", "\n".join(result_declarations(messages)) + "\n"
    yield PROTO / "js/parts.d.ts", "\n".join(part_declarations(messages)) + "\n"
    yield PROTO / "python/weft/commands.py", "\n".join(python_commands(messages)) + "\n"
    page = PROTO / "README.md"
    text = page.read_text(encoding="utf-8")
    for name, rows in tables(messages).items():
        text = between(text, f"<!-- {name}: written by generate.py -->\n", "\n<!-- end -->", rows)
    yield page, text


def main():
    program, check = sys.argv[1], "--check" in sys.argv[2:]
    messages = json.loads(subprocess.run([program], check=True, capture_output=True, timeout=60).stdout)
    stale = []
    for path, content in written(messages):
        if path.exists() and path.read_text(encoding="utf-8") == content:
            continue
        stale.append(path.relative_to(PROTO.parent).as_posix())
        if not check:
            path.write_text(content, encoding="utf-8")
    if check and stale:
        sys.exit("not what the descriptions say: " + ", ".join(stale) + "; run proto/generate.py")


if __name__ == "__main__":
    main()
