"""The report's tables of what contact costs, from contact.csv and contact_cases.csv."""

import tables


def milliseconds(value):
    return f"{value:.2g}" if abs(value) < 10 else f"{value:.0f}"


def thousands(count):
    if count < 1000:
        return f"{count:g}"
    return f"{count / 1000:.3g} k" if count < 1e6 else f"{count / 1e6:.3g} M"


def speed(rows):
    """CPU milliseconds a tick of each phase, by size and state, and how the states were made."""
    if not rows:
        return "Not measured in this run."
    table, made = [], {}
    for row in rows:
        made.setdefault(row["state"], set()).add(row["how"])
        head = [f"{row['n']}²", row["state"]]
        if row["missing"]:
            table.append(head + [f"not measured: {row['missing']}"] + [""] * 9)
            continue
        phases = [milliseconds(row[key]) for key in (
            "broad_phase_ms", "pairs_ms", "regions_ms", "rows_ms", "repulsion_ms", "friction_ms",
            "elastic_ms", "tick_ms")]
        table.append(head + [thousands(row["pairs"]), thousands(row["rows"])] + phases)
    states = "; ".join(f"{state} {' or '.join(sorted(how))}" for state, how in made.items())
    crossings = sum(row["crossings"] for row in rows if not row["missing"])
    return "\n\n".join([
        f"How they are made: {states}. {crossings:g} crossings in all of them, counted at the end.",
        tables.taken(rows),
        tables.markdown(["N", "state", "pairs", "rows", "broad phase", "pairs", "regions", "rows",
                         "repulsion", "friction", "elastic", "the whole tick"], table)])


def verdict(row):
    if not row["wanted"]:
        return "–"
    held = row["value"] <= row["bar"] if row["wanted"] == "at most" else row["value"] >= row["bar"]
    return "held" if held else "**missed**"


def cases(rows):
    """Figures of whole cases beside their bars."""
    if not rows:
        return "Not measured in this run."
    table, last = [], None
    for row in rows:
        unit = f" {row['unit']}" if row["unit"] else ""
        wanted = f"{row['wanted']} {row['bar']:.3g}{unit}" if row["wanted"] else "–"
        scene = "" if row["scene"] == last else row["scene"]
        table.append([scene, row["figure"], f"{row['value']:.3g}{unit}", wanted, verdict(row), row["runs"]])
        last = row["scene"]
    missed = sum(verdict(row) == "**missed**" for row in rows)
    held = sum(verdict(row) == "held" for row in rows)
    return "\n\n".join([
        f"Of {held + missed} bars {held} are held and {missed} missed. {tables.taken(rows)}",
        tables.markdown(["case", "figure", "measured", "wanted", "", "runs"], table)])
