#!/usr/bin/python3
"""Writes what follows from the descriptions of the messages (proto/messages, proto/frames): the declarations in
js/commands.d.ts, js/results.d.ts, js/parts.d.ts, js/events.d.ts and js/frame_parts.d.ts, the names in js/fields.js,
the reader of frames' parts in js/samples.js, the declarations of the Python client with its commands in both forms and
its parts of frames, the version of both packages, and the tables of README.md.

Usage: generate.py PROGRAM [--check]. PROGRAM is weft_messages, which prints the descriptions. With --check nothing is
written; it fails if a file is not what it would write.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

from descriptions import NUMBERS, described, objects_of, type_name, unit_text, value_text
from generate_blocking import blocking_commands
from generate_frames import flag_rows, python_parts, script_declarations, script_reader, section_rows
from generate_python import BARE, python_commands, python_messages, python_results, wrapped

PROTO = Path(__file__).parent
SUMMARIES = {  # of the commands whose methods in Python follow from their fields alone
    "camera": "Stores where this viewer looks from, so that others may follow.",
    "pause": "Stops the room's clock.",
    "resume": "Lets the room's clock run.",
    "step": "Lets ticks pass in a paused room.",
    "reset": "Back to the scene's start.",
    "save": "Keeps the present state in memory, in place of an earlier one of this name.",
    "restore": "Back to a state that was saved.",
    "speed": "Sets how fast time passes.",
    "gripper": "Opens, closes (opening=0) or moves a gripper; omitted values stay as they are.",
    "set": "Changes forces, settings and fabric of the room; omitted values stay as they are.",
    "create_room": "Opens a room beside this one; its address ends in `/ws/name`.",
    "list_rooms": "The rooms of the server.",
    "fork": "Opens a room that is like this one at this moment; its address ends in `/ws/name`.",
    "close_room": "Closes a room and the connections of its viewers; the default one stays.",
    "policy": "Says who may hold the cloth.",
    "mute": "Takes the right to hold from a viewer, whatever the policy.",
    "give_hand": "Gives a viewer the right to hold, whatever the policy.",
    "presence": "Tells others where this viewer points and looks.",
    "follow": "Sees by the camera of another viewer; 0: by its own again.",
    "lead": "Brings all viewers to this one's camera.",
    "invite": "Makes a token for a link; the result has it.",
}
TABLES = {  # that README.md has
    "hello", "camera", "gripper", "set", "advance", "view", "policy", "mute", "give_hand", "presence", "follow",
    "lead", "invite", "create_room", "fork",
}
SCRIPT = {
    **NUMBERS, "boolean": "boolean", "string": "string", "vector": "Vec3", "rotation": "number[]",
    "name_or_place": "string | number", "name_or_object": "string | object",
}
BARE_SCRIPT = {"tick: int": "tick: number", "paused: bool": "paused: boolean"}
HEAD = "// Written by proto/generate.py from the descriptions in proto/messages. Do not edit."

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


def part_declarations(messages):
    """Of what stands in messages."""
    yield from (HEAD, "", "import type { Vec3 } from './messages.js';")
    everything = [field for kind in messages.values() for m in kind for field in m["fields"]]
    everything += [{"type": part} for part in messages["parts"]]
    for name, fields in objects_of(everything).items():
        yield from ("", f"export interface {name} {{", *script_fields(fields), "}")


def event_declarations(messages):
    """Of what the server sends by itself."""
    body = []
    for event in messages["events"]:
        name = type_name(event["op"])
        body += ["", f"export interface {name} {{", f"  op: '{event['op']}';", *script_fields(event["fields"]), "}"]
    parts = objects_of([field for event in messages["events"] for field in event["fields"]])
    named = sorted(part for part in parts if any(re.search(rf": {part}\b", line) for line in body))
    yield from (HEAD, "", "import type { Vec3 } from './messages.js';")
    yield f"import type {{ {', '.join(named)} }} from './parts.js';"
    yield from body


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
    yield f"import type {{ {', '.join(sorted(parts & {'Hit', 'Fan', 'RoomInfo'}))} }} from './parts.js';"
    forms = {op: [f"{{ {'; '.join(BARE_SCRIPT[field] for field in fields)} }}"] for op, fields in BARE.items()}
    for op, alternatives in names.items():
        for number, fields in enumerate(alternatives, 1):
            name = type_name(op) + "Result" + (str(number) if len(alternatives) > 1 else "")
            forms.setdefault(op, []).append(name)
            yield from ("", f"/** What the answer to `{op}` has. */", f"export interface {name} {{")
            yield from (*script_fields(fields), "}")
    yield from ("", "/** What the answers have, by the command. */", "export interface Results {")
    yield from (f"  {op}: {' | '.join(results)};" for op, results in forms.items())
    yield "}"


def field_names(messages):
    """The names of fields, by command, and those of the parts that are fields of a command."""
    names = {}
    for command in messages["commands"]:
        for field in command["fields"]:
            names.setdefault(command["op"], {})[field["name"]] = True
            for fields in objects_of([field]).values():
                names[field["name"]] = dict.fromkeys(inner["name"] for inner in fields)
    yield from (HEAD, "", "/** @type {Record<string, string[]>} */", "export const FIELDS = {")
    for name, fields in names.items():
        line = f"  {name}: [" + ", ".join(f"'{field}'" for field in fields) + "],"
        if len(line) <= 120:
            yield line
        else:
            yield from (f"  {name}: [", *wrapped([f"'{field}'" for field in fields], "    "), "  ],")
    yield "};"


# --- tables ---


def table(fields):
    yield "| field | meaning | values | default |"
    yield "|---|---|---|---|"
    for field in fields:
        unit = unit_text(field)
        usual = field.get("default", "needed" if field.get("required") else "")
        usual = json.dumps(usual) if not isinstance(usual, str) else usual
        yield f"| `{field['name']}` | {field['meaning']}{unit} | {value_text(field)} | {usual} |"


def form_text(command):
    """A command with what tells this form of it from its others."""
    told = [f"`{f['name']}: {json.dumps(f['constant'])}`" for f in command["fields"] if "constant" in f]
    only = [f"`{f['name']}`" for f in command["fields"] if f.get("required") and "constant" not in f]
    return f"`{command['op']}`" + (" with " + ", ".join(told or only[:1]) if told or only else "")


def rights(messages):
    """Which right each command needs: a line for each right, and for parts that need more."""
    alternatives = {}
    for command in messages["commands"]:
        alternatives.setdefault(command["op"], []).append(command)
    needs = {}
    for op, forms in alternatives.items():
        one = len({form["right"] for form in forms}) == 1
        for form in forms[:1] if one else forms:
            needs.setdefault(form["right"], []).append(f"`{op}`" if one else form_text(form))
        for form in forms:
            if "further" in form:
                needs.setdefault(form["further"]["right"], []).append(f"`{op}` with {form['further']['what']}")
    yield "| right | commands |"
    yield "|---|---|"
    for right in ("look", "hold", "operate"):
        yield f"| `{right}` | {'; '.join(dict.fromkeys(needs[right]))} |"


def tables(messages):
    """All tables, by the name in their mark."""
    found = {"rights": rights(messages)}
    for command in messages["commands"]:
        if command["op"] in TABLES:
            found[command["op"]] = table(command["fields"])
            for name, fields in objects_of(command["fields"]).items():
                if name.lower() not in TABLES:  # a command of its own has the same fields
                    found[name] = table(fields)
    return {name: "\n".join(rows) for name, rows in found.items()}


# --- files ---


def between(text, start, end, inner):
    """The text with what stands between two marks replaced."""
    head, found, rest = text.partition(start)
    if not found or end not in rest:
        sys.exit(f"no {start!r} … {end!r}")
    return head + start + inner + end + rest.partition(end)[2]


def version():
    """The project's, of which the packages have theirs."""
    text = (PROTO.parent / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"^project\(weft VERSION ([\d.]+)", text, re.MULTILINE)[1]


def frame_files(frame):
    yield PROTO / "js/frame_parts.d.ts", "\n".join(script_declarations(frame)) + "\n"
    yield PROTO / "js/samples.js", "\n".join(script_reader(frame)) + "\n"
    yield PROTO / "python/weft/frame_parts.py", "\n".join(python_parts(frame)) + "\n"


def python_files(messages):
    client = PROTO / "python/weft"
    commands = "\n".join(python_commands(messages, SUMMARIES)) + "\n"
    sources = {"commands": commands}
    sources |= {name: (client / f"{name}.py").read_text(encoding="utf-8") for name in ("session", "queries", "client")}
    yield client / "messages.py", "\n".join(python_messages(messages)) + "\n"
    yield client / "results.py", "\n".join(python_results(messages)) + "\n"
    yield client / "commands.py", commands
    yield client / "blocking_commands.py", "\n".join(blocking_commands(sources)) + "\n"
    about = '"""The project\'s version. Written by proto/generate.py from CMakeLists.txt."""'
    yield client / "version.py", f'{about}\n\n__version__ = "{version()}"\n'


def written(messages, frame):
    """All files that follow from the descriptions, with their content."""
    yield PROTO / "js/commands.d.ts", "\n".join(command_declarations(messages)) + "\n"
    yield PROTO / "js/results.d.ts", "\n".join(result_declarations(messages)) + "\n"
    yield PROTO / "js/parts.d.ts", "\n".join(part_declarations(messages)) + "\n"
    yield PROTO / "js/events.d.ts", "\n".join(event_declarations(messages)) + "\n"
    yield PROTO / "js/fields.js", "\n".join(field_names(messages)) + "\n"
    package = PROTO / "js/package.json"
    told = re.sub(r'("version": ")[^"]*', rf"\g<1>{version()}", package.read_text(encoding="utf-8"), count=1)
    yield package, told
    yield from python_files(messages)
    yield from frame_files(frame)
    page = PROTO / "README.md"
    text = page.read_text(encoding="utf-8")
    frames = {"flags": "\n".join(flag_rows(frame)), "sections": "\n".join(section_rows(frame))}
    for name, rows in (tables(messages) | frames).items():
        text = between(text, f"<!-- {name}: written by generate.py -->\n", "\n<!-- end -->", rows)
    yield page, text


def main():
    program, check = sys.argv[1], "--check" in sys.argv[2:]
    messages = json.loads(subprocess.run([program], check=True, capture_output=True, timeout=60).stdout)
    frame = messages.pop("frame")
    stale = []
    for path, content in written(messages, frame):
        if path.exists() and path.read_text(encoding="utf-8") == content:
            continue
        stale.append(path.relative_to(PROTO.parent).as_posix())
        if not check:
            path.write_text(content, encoding="utf-8")
    if check and stale:
        sys.exit("not what the descriptions say: " + ", ".join(stale) + "; run proto/generate.py")


if __name__ == "__main__":
    main()
