"""What the descriptions of messages say, in words: for declarations, methods and tables."""

NUMBERS = {"number": "number", "integer": "number"}


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


def described(field):
    """Meaning, unit and values of a field in one line."""
    unit = unit_text(field)
    values = value_text(field)
    return f"{field['meaning']}{unit}" + (f"; {values}" if values else "")


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
