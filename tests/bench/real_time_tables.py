"""What verlet holds in real time, and what the solver implicit could gain and gains where it does not."""

from tables import markdown, percent, seconds, span_of, taken


def held(row):
    return row["dearest_second"] <= 1


def with_free_springs(row):
    """CPU s of the dearest second if springs, bending and integration cost nothing."""
    return row["dearest_second"] * (1 - row["springs"])


def with_free_substeps(row):
    """The same if nothing that is done each substep cost anything, contact included; None if not
    measured. What a second costs is taken as a + b s with s substeps, and known at s and at 2 s."""
    if not row["twice_the_substeps"]:
        return None
    return max(0, 2 * row["dearest_second"] - row["twice_the_substeps"])


def at_best(row):
    """The least that a solver of fewer, dearer steps could take, were these free."""
    other = with_free_substeps(row)
    return with_free_springs(row) if other is None else min(with_free_springs(row), other)


def name_of(row):
    return row["case"]


def listed(rows):
    names = [name_of(row) for row in rows]
    return names[0] if len(names) == 1 else ", ".join(names[:-1]) + " and " + names[-1]


def told(row):
    two = f", {seconds(row['wall_two_threads'])} s by the clock on two" if row["wall_two_threads"] else ""
    return (f"{name_of(row)} ({seconds(row['dearest_second'])} CPU s a simulated second{two}; contact "
            f"{percent(row['contact'])}, springs {percent(row['springs'])}, air {percent(row['air'])})")


def with_implicit(slow):
    """What the solver implicit does with the cases that verlet does not hold; nothing if not measured."""
    measured = [row for row in slow if row["implicit"]]
    if not measured:
        return ""
    good = [row for row in measured if row["implicit"] <= 1]
    if not good:
        return " `implicit` holds none of them either."
    told_good = [f"{name_of(row)} ({seconds(row['implicit'])} CPU s a simulated second)" for row in good]
    return (f" `implicit` holds {len(good)} of them: " + ", ".join(told_good) + ".")


def summary(rows):
    """The verdict as the README tells it."""
    slow = [row for row in rows if not held(row)]
    if not rows:
        return "What verlet holds in real time was not measured."
    if not slow:
        return (f"By the report `verlet` holds each of {len(rows)} cases in real "
                "time on one thread, hard cases and cotton of 128 × 128 particles among them.")
    two = [row for row in slow if 0 < row["wall_two_threads"] <= 1]
    text = (f"On one thread `verlet` does not hold {listed(slow)} in real "
            f"time: {len(slow)} of {len(rows)} cases. ")
    if two:
        text += f"Two threads hold {listed(two)}. "
    gain = [row for row in slow if with_free_springs(row) <= 1]
    text += (f"Contact takes {span_of([row['contact'] for row in slow])} of their time, springs, bending and "
             f"integration {span_of([row['springs'] for row in slow])}; ")
    if gain:
        text += f"if these cost nothing, {listed(gain)} would be held"
        text += "." if len(gain) == len(slow) else ", the others not."
    else:
        text += "none of them would be held if these cost nothing."
    return text + with_implicit(slow)


def verdict(rows):
    slow = [row for row in rows if not held(row)]
    if not slow:
        return (f"**No**, by these figures: on one thread verlet holds each of {len(rows)} cases in real time, "
                "so none calls for the solver implicit.")
    text = (f"Verlet does **not** hold {len(slow)} of {len(rows)} cases in real time on one thread: "
            + "; ".join(map(told, slow)) + ". ")
    gain = [row for row in slow if with_free_springs(row) <= 1]
    rest = [row for row in slow if row not in gain]
    if gain:
        text += (f"**Called for** by {listed(gain)}: with springs, bending and integration that cost nothing, "
                 "which is more than any solver can do, it would be held.")
    else:
        text += ("**No** solver of the springs would change that: with springs, bending and integration that "
                 "cost nothing none would be held.")
    if gain and rest:
        text += f" Nothing that such a solver saves of springs would bring {listed(rest)} into real time."
    fewer = [row for row in rest if at_best(row) <= 1]
    if fewer:
        text += (" But contact is looked at in each substep too, and a solver of fewer steps would save of that: "
                 f"if substeps cost nothing at all, {listed(fewer)} would be held.")
    return text + with_implicit(slow)


def need_of_implicit(rows):
    if not rows:
        return "Not measured in this run."
    table = []
    for row in rows:
        wall, other = row["wall_two_threads"], with_free_substeps(row)
        table.append([
            name_of(row), row["kind"], seconds(row["dearest_second"]) + ("" if held(row) else " **not held**"),
            seconds(wall) if wall else "–", percent(row["springs"]), percent(row["contact"]), percent(row["air"]),
            percent(row["other"]), seconds(with_free_springs(row)), "–" if other is None else seconds(other),
            seconds(row["implicit"]) if row["implicit"] else "–", row["runs"]])
    looked = " or ".join(sorted({f"{row['seconds_looked_at']}" for row in rows}))
    return "\n\n".join([
        verdict(rows), f"Each case: the dearest of its first {looked} s. {taken(rows)}",
        markdown(["case", "", "CPU s per s, one thread", "s per s by the clock, two threads", "springs",
                  "contact", "air", "the rest", "with free springs", "with free substeps", "with implicit", "runs"], table)])
