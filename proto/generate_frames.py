"""Writes the parts of frames in the clients, and the tables of them, from their descriptions in proto/frames."""

import re

from descriptions import unit_text
from generate_python import WIDTH

HEAD = "Written by proto/generate.py from proto/frames. Do not edit."
BESIDE = "What a frame has beside times and positions."

# --- words ---


def camel(name):
    return re.sub(r"_(\w)", lambda found: found[1].upper(), name)


def numbers(kind):
    """How many floats a field of this type has; 0: it is no vector."""
    return int(kind[4:]) if kind.startswith("f32x") else 0


def power_text(value):
    return "2³² − 1" if value == 2**32 - 1 else str(value)


def sentence(text):
    return text[:1].upper() + text[1:] + "." if text else ""


def with_unit(field):
    """What a field means in a client."""
    unknown = "; a number, if this client does not know its meaning" if field["type"] == "word" else ""
    return field["meaning"] + unknown + unit_text(field)


def field_text(field):
    """A field on the wire: its type, its name, and in brackets what is said of it."""
    kind, told = field["type"], [field["meaning"]] if field["meaning"] else []
    if kind == "truth":
        told.insert(0, "1 or 0")
    if kind == "word":
        words = ", ".join(f"{number} {word}" for number, word in enumerate(field["words"]))
        told = [words, *told, "skip others"]
    if kind == "collider_or_none":
        told.append(f"none: {power_text(field['none'])}")
    name = field["name"].replace("_", " ")
    wire = f"f32×{numbers(kind)}" if numbers(kind) else "f32" if kind == "f32" else "u32"
    return f"{wire} {name}" + (f" ({'; '.join(told)})" if told else "") + unit_text(field)


def section_rows(frame):
    """The table of a frame's sections."""
    rows = {}
    for part in frame["positions"] + frame["arrays"]:
        told = [f"vertices × 3 f32 [{part['unit']}]"] if "unit" in part else []
        rows[part["kind"]] = part["name"], "; ".join([*told, part["note"]])
    for part in frame["lists"]:
        sample = part["sample"]
        fields = ", ".join(map(field_text, sample["fields"]))
        note = f"; {part['note']}" if part["note"] else ""
        rows[part["kind"]] = part["name"], f"for each {sample['each']} {sample['bytes']} bytes: {fields}{note}"
    yield "| kind | index | payload |"
    yield "|---|---|---|"
    yield from (f"| {kind} {name} | 0 | {payload} |" for kind, (name, payload) in sorted(rows.items()))
    yield "| 16–21 | | mesh message, next section |"


def flag_rows(frame):
    yield "| bit | flag | |"
    yield "|---|---|---|"
    yield from (f"| {flag['bit']} | {flag['name']} | {flag['meaning']} |" for flag in frame["flags"])


# --- JavaScript ---

SCRIPT = {
    "u32": "number", "f32": "number", "truth": "boolean", "collider_or_none": "number | null",
}


def script_type(field):
    if field["type"] == "word":
        return " | ".join(f"'{word}'" for word in field["words"]) + " | number"
    return "number[]" if numbers(field["type"]) else SCRIPT[field["type"]]


def script_declarations(frame):
    def member(name, kind, note):
        if note:
            yield f"  /** {sentence(note)} */"
        yield f"  {name}: {kind};"

    yield f"// {HEAD}"
    for part in frame["lists"]:
        sample = part["sample"]
        yield from ("", f"/** One for each {sample['each']}. */", f"export interface {sample['name']} {{")
        for field in sample["fields"]:
            yield from member(camel(field["name"]), script_type(field), with_unit(field))
        yield "}"
    yield from ("", f"/** {BESIDE} */", "export interface FrameParts {", "  flags: number;")
    for flag in frame["flags"]:
        yield from member(flag["name"], "boolean", flag["meaning"])
    for part in frame["lists"]:
        yield from member(part["name"], part["sample"]["name"] + "[]", part["note"])
    for part in frame["arrays"]:
        note = f"three values per vertex [{part['unit']}], {part['note']}"
        yield from member(part["name"], "Float32Array | null", note)
    yield "}"


def script_value(field):
    at = "at" + (f" + {field['offset']}" if field["offset"] else "")
    kind = field["type"]
    if numbers(kind):
        return f"readVector(view, {at}, {numbers(kind)})"
    if kind == "f32":
        return f"readNumber(view, {at})"
    if kind == "word":
        return f"readWord(view, {at}, {field['words']!r})"
    if kind == "collider_or_none":
        return f"readPlace(view, {at}, {field['none']})"
    return f"view.getUint32({at}, true)" + (" !== 0" if kind == "truth" else "")


def script_reader(frame):
    yield f"// {HEAD}"
    helpers = ("readArray", "readList", "readNumber", "readPlace", "readVector", "readWord")
    yield from ("", f"import {{ {', '.join(helpers)} }} from './entries.js';")
    yield from ("", "/**", f" * {BESIDE}", " * @param {number} flags")
    yield from (" * @param {DataView} view", " * @param {import('./entries.js').Find} find  a section of this kind")
    yield from (" * @param {number} vertices", " * @returns {import('./frame_parts.js').FrameParts}", " */")
    yield from ("export function readParts(flags, view, find, vertices) {", "  return {", "    flags,")
    yield from (f"    {flag['name']}: (flags & {1 << flag['bit']}) !== 0," for flag in frame["flags"])
    for part in frame["lists"]:
        yield f"    {part['name']}: readList(find({part['kind']}), {part['sample']['bytes']}, (at) => ({{"
        yield from (f"      {camel(field['name'])}: {script_value(field)}," for field in part["sample"]["fields"])
        yield "    })),"
    for part in frame["arrays"]:
        yield f"    {part['name']}: readArray(view, find({part['kind']}), vertices * 3),"
    yield from ("  };", "}")


# --- Python ---

PYTHON = {
    "u32": "int", "f32": "float", "truth": "bool", "collider_or_none": "int | None", "word": "str | int",
}


def python_type(field):
    count = numbers(field["type"])
    return f"tuple[{', '.join(['float'] * count)}]" if count else PYTHON[field["type"]]


def python_line(name, kind, note):
    note = note.replace("`", "")
    line = f"    {name}: {kind}"
    if len(line) + len(note) + 4 > WIDTH:
        return f"    # {note}\n{line}"
    return line + (f"  # {note}" if note else "")


def class_and_fields(part):
    """The class of a list's entries and their fields: without the key, by which a dict has them."""
    sample, keyed = part["sample"], part.get("keyed", False)
    name = sample["name"].removesuffix("Sample") if keyed else sample["name"]
    return name, sample["fields"][1 if keyed else 0:]


def held_type(part):
    name, fields = class_and_fields(part)
    if not part.get("keyed"):
        return f"tuple[{name}, ...]"
    return f"dict[int, {python_type(fields[0]) if len(fields) == 1 else name}]"


def python_value(field, place):
    """A field, of the numbers of an entry."""
    count, kind = numbers(field["type"]), field["type"]
    if count:
        return f"e[{place}:{place + count}]"
    if kind == "word":
        words = ", ".join(f'"{word}"' for word in field["words"])
        return f"({words})[e[{place}]] if e[{place}] < {len(field['words'])} else e[{place}]"
    value = f"e[{place}]"
    if kind == "collider_or_none":
        return f"None if {value} == {field['none']} else {value}"
    return f"bool({value})" if kind == "truth" else value


def python_entry(part):
    """The expression that makes an entry of its numbers."""
    places, place = {}, 0
    for field in part["sample"]["fields"]:
        places[field["name"]] = place
        place += numbers(field["type"]) or 1
    name, fields = class_and_fields(part)
    values = [python_value(field, places[field["name"]]) for field in fields]
    if not part.get("keyed"):
        return f"{name}({', '.join(values)})"
    return f"(e[0], {values[0]})" if len(values) == 1 else f"(e[0], {name}({', '.join(values)}))"


def struct_format(part):
    """The format of an entry for `struct`."""
    kinds = "".join("f" * (numbers(f["type"]) or 1) if f["type"][0] == "f" else "I" for f in part["sample"]["fields"])
    return "<" + re.sub(r"(.)\1+", lambda found: f"{len(found[0])}{found[1]}", kinds)


def python_parts(frame):
    yield from (f'"""{BESIDE} {HEAD}"""', "", "from __future__ import annotations", "")
    yield from ("from dataclasses import dataclass, field", "from struct import Struct")
    yield "from typing import TYPE_CHECKING, Any"
    yield from ("", "if TYPE_CHECKING:", "    from .samples import Floats")
    for part in frame["lists"]:
        name, fields = class_and_fields(part)
        if len(fields) == 1:
            continue
        yield from ("", "", "@dataclass(frozen=True)", f"class {name}:")
        yield from (f'    """One for each {part["sample"]["each"]}."""', "")
        yield from (python_line(field["name"], python_type(field), with_unit(field)) for field in fields)
    yield from ("", "", "@dataclass(frozen=True, kw_only=True)", "class FrameParts:", f'    """{BESIDE}"""')
    yield from ("", "    flags: int")
    for part in frame["lists"]:
        key = part["sample"]["fields"][0]
        keyed = ["by " + ", ".join(filter(None, (key["name"], key["meaning"])))] if part.get("keyed") else []
        usual = "field(default_factory=dict)" if part.get("keyed") else "()"
        note = "; ".join(filter(None, [*keyed, part["note"]]))
        yield python_line(part["name"], f"{held_type(part)} = {usual}", note)
    for part in frame["arrays"]:
        note = f"one row of 3 per vertex [{part['unit']}], {part['note']}"
        yield python_line(part["name"], "Floats | None = None", note)
    for flag in frame["flags"]:
        yield from ("", "    @property", f"    def {flag['name']}(self) -> bool:")
        yield f'        """{sentence(flag["meaning"])}"""'
        yield f"        return bool(self.flags & {1 << flag['bit']})"
    yield from ("", "", "# Of each list: its section, the form of its entries, how one is made, what collects them.")
    yield "LISTS: dict[str, tuple[int, Struct, Any, Any]] = {"
    for part in frame["lists"]:
        kind = "dict" if part.get("keyed") else "tuple"
        parts = [str(part["kind"]), f'Struct("{struct_format(part)}")', f"lambda e: {python_entry(part)}", kind]
        line = f'    "{part["name"]}": ({", ".join(parts)}),'
        if len(line) <= WIDTH:
            yield line
        else:
            yield from (f'    "{part["name"]}": (', *(f"        {item}," for item in parts), "    ),")
    arrays = ", ".join(f'"{part["name"]}": {part["kind"]}' for part in frame["arrays"])
    yield from ("}  # fmt: skip", f"ARRAYS = {{{arrays}}}")
