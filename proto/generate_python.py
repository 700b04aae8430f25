"""Writes the Python client's messages, results and commands from the descriptions of the messages."""

import textwrap

from descriptions import described, objects_of, type_name

WIDTH = 118  # of a line of Python
TAKEN = {
    "number": "float", "integer": "int", "boolean": "bool", "string": "str", "vector": "Iterable[float]",
    "rotation": "Iterable[float]", "name_or_place": "str | int", "name_or_object": "str | Mapping[str, Any]",
}  # as arguments
TOLD = TAKEN | {"vector": "Sequence[float]", "rotation": "Sequence[float]", "name_or_object": "str | dict[str, Any]"}
# Answers that several commands have in common are described by none of them.
BARE = {
    **dict.fromkeys(("pause", "resume"), ("tick: int", "paused: bool")),
    **dict.fromkeys(("camera", "set", "reset", "save", "restore", "policy", "mute", "give_hand", "presence", "follow",
                     "lead"), ("tick: int",)),
}


def python_type(kind, names=TOLD):
    if isinstance(kind, str):
        return names[kind]
    if "words" in kind:
        return "Literal[" + ", ".join(f'"{word}"' for word in kind["words"]) + "]"
    return f"list[{python_type(kind['list'], names)}]" if "list" in kind else kind["object"]


def wrapped(items, indent):
    """Lines of items with commas between them, none of which is broken."""
    lines = textwrap.wrap(", ".join(item.replace(" ", "\0") for item in items) + ",", WIDTH, initial_indent=indent,
                          subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)
    return [line.replace("\0", " ") for line in lines]


def head_of(start, arguments, end, indent=" " * 4):
    """The first lines of a function."""
    line = f"{indent}{start}({', '.join(arguments)}){end}"
    if len(line) <= WIDTH:
        return [line]
    return [f"{indent}{start}(", *wrapped(arguments, indent + " " * 4), f"{indent}){end}  # fmt: skip"]


# --- messages ---


def typed_field(field):
    if "constant" in field:
        return f'    {field["name"]}: Literal[{field["constant"]!r}]'.replace("'", '"')
    kind = python_type(field["type"]) + (" | None" if field.get("nullable") else "")
    line = f"    {field['name']}: " + (kind if field.get("required") else f"NotRequired[{kind}]")
    note = described(field).replace("`", "") if field["meaning"] else ""
    if not note:
        return line
    return f"{line}  # {note}" if len(line) + len(note) + 4 <= WIDTH else f"    # {note}\n{line}"


def typed(name, fields, doc, base="TypedDict"):
    """A class of typed fields, with a comment on each."""
    yield from ("", "", f"class {name}({base}):", f'    """{doc}"""')
    if fields:
        yield ""
    yield from (field if isinstance(field, str) else typed_field(field) for field in fields)


def python_messages(messages):
    """What stands in messages, and those of the server."""
    yield '"""Parts of messages, and messages of the server. Written by proto/generate.py from proto/messages."""'
    yield from ("", "from collections.abc import Sequence", "from typing import Any, Literal, NotRequired, TypedDict")
    everything = [field for kind in messages.values() for m in kind for field in m["fields"]]
    everything += [{"type": part} for part in messages["parts"]]
    for name, fields in objects_of(everything).items():
        yield from typed(name, fields, f"`{name}`, as part of a message.")
    for event in messages["events"]:
        fields = [f'    op: Literal["{event["op"]}"]', *event["fields"]]
        yield from typed(type_name(event["op"]), fields, f"The message `{event['op']}`.")


def python_results(messages):
    """The answers to commands."""
    names = {}
    for reply in messages["replies"]:
        names.setdefault(reply["op"], []).append(reply["fields"])
    parts = sorted({name for forms in names.values() for fields in forms for name in objects_of(fields)})
    yield '"""What commands answer. Written by proto/generate.py from the descriptions in proto/messages."""'
    yield from ("", "from collections.abc import Sequence", "from typing import Literal, NotRequired, TypedDict", "")
    yield f"from .messages import {', '.join(parts)}"
    answer = ('    op: Literal["result"]', "    id: int | str", "    command: str  # the `op` that it answers")
    yield from typed("Answer", answer, "What every answer has.")
    for op, fields in BARE.items():
        yield from typed(type_name(op) + "Result", [f"    {field}" for field in fields],
                         f"The answer to `{op}`.", "Answer")
    for op, forms in names.items():
        for number, fields in enumerate(forms, 1):
            name = type_name(op) + "Result" + (str(number) if len(forms) > 1 else "")
            yield from typed(name, fields, f"The answer to `{op}`.", "Answer")


# --- commands ---


def arguments_of(fields):
    placed, named = [], []
    for field in fields:
        kind = python_type(field["type"], TAKEN)
        if field.get("required"):
            placed.append(f"{field['name']}: {kind}")
        elif len(fields) == 1:
            placed.append(f"{field['name']}: {kind} = {field['default']!r}")
        else:
            named.append(f"{field['name']}: {kind} | None = None")
    return ["self", *placed, "*", *named, "timeout: float | None = CLIENTS"]


def value_of(field):
    """How an argument is sent."""
    name, kind = field["name"], field["type"]
    if kind in ("vector", "rotation"):
        return f"listed({name})"
    inner = kind["list"] if isinstance(kind, dict) and "list" in kind else kind
    if isinstance(inner, dict) and "object" in inner:
        return f'known({inner["object"]}, "{name}", {name})'
    return name


def python_method(command, summary):
    fields, op = command["fields"], command["op"]
    yield from head_of(f"async def {op}", arguments_of(fields), f" -> {type_name(op)}Result:")
    if not fields:
        yield f'        """{summary}"""'
        yield f'        return await self.request("{op}", timeout=timeout)'
        return
    lines = [f"{field['name']}: {described(field)}".replace("`", "") for field in fields]
    short = f'        """{summary} ({lines[0]})"""'
    if len(lines) == 1 and len(short) <= WIDTH:
        yield short
    else:
        yield f'        """{summary}'
        yield ""
        for line in lines:
            yield from textwrap.wrap(line, WIDTH, initial_indent=" " * 8, subsequent_indent=" " * 12)
        yield '        """'
    values = [f'"{field["name"]}": {value_of(field)}' for field in fields]
    body = "fields = {" + ", ".join(values) + "}"
    if len(body) + 8 <= WIDTH:
        yield "        " + body
    else:
        yield "        fields = {"
        yield from wrapped(values, " " * 12)
        yield "        }  # fmt: skip"
    yield f'        return await self.request("{op}", timeout=timeout, **without_none(fields))'


def python_commands(messages, summaries):
    """The commands whose methods follow from their fields, with what each does in one line."""
    chosen = [command for command in messages["commands"] if command["op"] in summaries]
    parts = sorted({name for command in chosen for name in objects_of(command["fields"])})
    results = sorted(type_name(command["op"]) + "Result" for command in chosen)
    body = [line for command in chosen for line in ("", *python_method(command, summaries[command["op"]]))]
    yield '"""Commands that follow from their fields. Written by proto/generate.py from proto/messages."""'
    yield from ("", "from __future__ import annotations", "", "from collections.abc import Iterable")
    if any("Literal[" in line for line in body):
        yield "from typing import Literal"
    yield from ("", "from .fields import known, listed, without_none")
    yield f"from .messages import {', '.join(parts)}"
    yield from ("from .results import (", *wrapped(results, " " * 4), ")  # fmt: skip")
    yield from ("from .session import Session", "from .timeouts import CLIENTS", "", "")
    yield from ("class Commands(Session):", '    """Commands that follow from their fields."""', *body)
