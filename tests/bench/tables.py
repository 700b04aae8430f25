"""The figures of the report as tables of text, from the CSV files that weft_bench writes."""

import csv
import re
from pathlib import Path

FABRICS = ["soft", "stiff", "cotton"]
SCENES = ["swing", "static-rest", "cantilever", "hanging-strip", "flag", "drape"]
SQUARE_METRES = ["swing", "static-rest", "flag", "drape"]
SIZES = [32, 64, 128, 256]
BOUNDS = [(0.1, "10 %"), (0.01, "1 %"), (0.001, "0.1 %")]
SOLVERS = ["verlet", "xpbd", "relaxation"]
NAMES = {"verlet": "verlet", "xpbd": "XPBD", "relaxation": "seed"}
ERRORS = ["position", "strain", "energy", "momentum", "mean_shape"]


def read(directory, name):
    path = Path(directory, f"{name}.csv")
    if not path.exists():
        return []
    with open(path, encoding="utf-8", newline="") as file:
        return [judged({key: number(value) for key, value in row.items()})
                for row in csv.DictReader(file)]


def judged(row):
    """A run that ends farther off than the cloth has moved counts as failed, as one that blew up."""
    if row.get("outcome") == "ran" and row["position"] > 1:
        row["outcome"], row["reason"] = "failed", f"its positions are {percent(row['position'])} off"
    return row


def number(text):
    # A commit such as 5311e71 is no power of ten; the program writes the sign of an exponent.
    if re.search(r"e(?![+-])", text):
        return text
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text


def markdown(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows])


def unique(values):
    return list(dict.fromkeys(values))


def percent(value):
    return f"{100 * value:.2g} %" if value < 0.995 else f"{100 * value:.0f} %"


def seconds(value):
    return f"{value:.2g}" if value < 10 else f"{value:.0f}"


def setting_name(cell):
    if cell["solver"] == "verlet":
        return f"verlet {cell['setting']}"
    return f"{NAMES[cell['solver']]} {cell['setting'].replace('x', '×')}"


def of_case(cells, scene, fabric, n, solver=None):
    return [cell for cell in cells if (cell["scene"], cell["fabric"], cell["n"]) == (scene, fabric, n)
            and solver in (None, cell["solver"])]


def cheapest(cells, bound, error="position"):
    """The cheapest run whose error is at most `bound`, or None."""
    good = [cell for cell in cells if cell["outcome"] == "ran" and cell[error] <= bound]
    return min(good, key=lambda cell: cell["cpu_per_second"], default=None)


def why_not(cells):
    """Why a case has no figure: its most common reason."""
    reasons = [cell["reason"] for cell in cells if cell["outcome"] == "not run"]
    return max(set(reasons), key=reasons.count) if reasons else "no setting reaches it"


def cost_of_accuracy(cells, scene="swing"):
    """What 10 %, 1 % and 0.1 % cost at each N: the table of the README."""
    rows = []
    for n in unique(cell["n"] for cell in cells if cell["scene"] == scene):
        for fabric in FABRICS:
            case = of_case(cells, scene, fabric, n)
            if not case:
                continue
            row = [f"{n}²", fabric]
            for bound, _ in BOUNDS:
                best = cheapest(case, bound)
                row.append(f"{seconds(best['cpu_per_second'])} ({setting_name(best)})" if best
                           else why_not(case))
            rows.append(row)
    return markdown(["N", "fabric"] + [f"error {name}" for _, name in BOUNDS], rows)


def verlet_against_xpbd(cells):
    rows = []
    for scene in unique(cell["scene"] for cell in cells):
        for fabric in FABRICS:
            for n in unique(cell["n"] for cell in cells if cell["scene"] == scene):
                for error in ("position", "strain"):
                    ours = cheapest(of_case(cells, scene, fabric, n, "verlet"), 0.01, error)
                    rival = cheapest(of_case(cells, scene, fabric, n, "xpbd"), 0.01, error)
                    if not ours:
                        continue
                    row = [scene, fabric, f"{n}²", error,
                           f"{seconds(ours['cpu_per_second'])} ({ours['setting'].replace('x', '×')})"]
                    if rival:
                        ratio = rival["cpu_per_second"] / ours["cpu_per_second"]
                        row += [f"{seconds(rival['cpu_per_second'])} ({setting_name(rival)})",
                                f"{ratio:.1f}"]
                    else:
                        row += ["no setting that was run", "–"]
                    rows.append(row)
    return markdown(["scene", "fabric", "N", "error", "verlet [s]", "XPBD [s]", "XPBD / verlet"], rows)


def summary_of_rivals(cells):
    """One sentence on the wanted factor of 2 at 64² and 128², soft and stiff."""
    parts, held = [], True
    for fabric in ("soft", "stiff"):
        for n in (64, 128):
            for error in ("position", "strain"):
                ours = cheapest(of_case(cells, "swing", fabric, n, "verlet"), 0.01, error)
                rival = cheapest(of_case(cells, "swing", fabric, n, "xpbd"), 0.01, error)
                if not ours or (not rival and error == "strain"):
                    continue
                ratio = rival["cpu_per_second"] / ours["cpu_per_second"] if rival else None
                held = held and error != "position" or (ratio is not None and ratio >= 2)
                shown = f"{ratio:.1f}" if ratio else "–"
                parts.append(f"{fabric} {n}² {shown} ({error})")
    verdict = ("verlet is at least 2 times cheaper in position everywhere" if held else
               "verlet is **not** everywhere 2 times cheaper in position")
    return f"Wanted is a factor of 2 at 1 % in the swing: {'; '.join(parts)}. So {verdict}."


def references(rows, spatial, scene):
    table = []
    for row in rows:
        if row["scene"] != scene:
            continue
        beside = [s for s in spatial if (s["scene"], s["fabric"], s["n"]) ==
                  (scene, row["fabric"], row["n"])]
        coarse = percent(beside[0]["position"]) if beside else "–"
        if row["missing"]:
            table.append([row["fabric"], f"{row['n']}²", "none: " + row["missing"], "–", "–", "–", "–", coarse])
            continue
        span = f"{row['compared_from_s']:g} to {row['compared_to_s']:g} s"
        if row["compared_from_s"] == row["compared_to_s"]:
            span = f"at {row['compared_to_s']:g} s"
        if row["compared_to_s"] < row["horizon_s"]:
            span += f" of {row['horizon_s']:g}: later a perturbation has grown 10 times"
        table.append([row["fabric"], f"{row['n']}²", row["how"], f"{row['self_error']:.1e}",
                      f"{row['growth_of_1um']:.2g}", percent(row["mean_shape_floor"]), span, coarse])
    return markdown(["fabric", "N", "reference", "its last refinement changed", "growth of 1 µm",
                     "1 µm changes the mean shape by", "compared", "spatial error, N against 2N"], table)


def error_vectors(cells, scene):
    contact = any(cell["penetration_m"] for cell in cells if cell["scene"] == scene)
    rows = []
    for fabric in FABRICS:
        for n in unique(cell["n"] for cell in cells if cell["scene"] == scene):
            for solver in SOLVERS:
                tried = of_case(cells, scene, fabric, n, solver)
                ran = [c for c in tried if c["outcome"] == "ran"]
                best = cheapest(ran, 0.01) or min(ran, key=lambda c: c["position"], default=None)
                if not best:
                    continue
                finished = sum(c["outcome"] != "not run" for c in tried)
                row = [fabric, f"{n}²", setting_name(best), finished, seconds(best["cpu_per_second"])]
                row += [percent(best[error]) for error in ERRORS]
                if contact:
                    row.append(f"{1e3 * best['penetration_m']:.2g} mm")
                rows.append(row)
    head = ["fabric", "N", "setting", "best of", "CPU s per s"] + [e.replace("_", " ") for e in ERRORS]
    return markdown(head + (["penetration"] if contact else []), rows)


def without_figure(cells, outcome):
    rows = []
    groups = {}
    for cell in cells:
        if cell["outcome"] == outcome:
            key = (cell["scene"], cell["fabric"], cell["n"], cell["solver"])
            groups.setdefault(key, []).append(cell)
    for (scene, fabric, n, solver), group in groups.items():
        names = ", ".join(cell["setting"].replace("x", "×") for cell in group)
        reasons = unique(cell["reason"] for cell in group)
        more = f" (and {len(reasons) - 1} more like it)" if len(reasons) > 1 else ""
        rows.append([scene, fabric, f"{n}²", NAMES[solver], names, reasons[0] + more])
    if outcome == "not run":
        rows += cases_left_out(cells)
    if not rows:
        return "None."
    return markdown(["scene", "fabric", "N", "solver", "settings", "reason"], rows)


def cases_left_out(cells):
    """Cases of the report's whole grid that the run at hand was not asked for."""
    measured = {(cell["scene"], cell["fabric"], cell["n"]) for cell in cells}
    return [[scene, fabric, f"{n}²", "all", "all", "this run was cut before it, or not asked for it"]
            for scene in SCENES for fabric in FABRICS for n in SIZES
            if (scene, fabric, n) not in measured]


def taken(rows):
    """Where a table comes from, as one part of a report may be taken anew elsewhere."""
    if not rows or "vectors" not in rows[0]:
        return ""
    return (f"Taken at commit {rows[0]['commit']} with {rows[0]['vectors']} kernels; load of the machine at "
            f"the end {rows[0]['load']}.")


def sizes_taken(cells):
    """Where the cells of the accuracy come from, as some may be measured in a run of their own."""
    sizes, scenes, runs = {}, {}, {}
    for cell in cells:
        commit = cell["commit"]
        sizes.setdefault(commit, set()).add(cell["n"])
        scenes.setdefault(commit, set()).add(cell["scene"])
        runs[commit] = max(runs.get(commit, 0), cell["timed_runs"])

    def part(commit):
        all_there = {cell["scene"] for cell in cells if cell["n"] in sizes[commit]}
        of = "" if scenes[commit] == all_there else f" of {', '.join(sorted(scenes[commit]))}"
        return (f"{', '.join(f'{n}²' for n in sorted(sizes[commit]))}{of} at commit {commit}, medians of up to "
                f"{runs[commit]} runs")

    return "; ".join(part(commit) for commit in sorted(sizes, key=lambda c: min(sizes[c]))) + "."


def kernels(rows):
    table = []
    for row in rows:
        unit = row["unit"]
        if unit not in ("ns", "B"):
            continue
        bar = row["bar"]
        value = f"{row['value']:.3g} {unit}"
        held = "–" if not bar else ("held" if row["value"] <= bar else "**missed**")
        table.append([row["figure"], value, f"{bar:g} {unit}" if bar else "–", held])
    return markdown(["figure", "measured", "at most", ""], table)


def parts(rows):
    table = []
    for row in rows:
        whole = next(r for r in rows if r["scene"] == row["scene"] and r["off"] == "nothing")
        cost = seconds(row["cpu_per_second"])
        if row["off"] == "nothing":
            table.append([row["scene"], row["solver"], "–", cost, "", ""])
            continue
        change = row["cpu_per_second"] / whole["cpu_per_second"] - 1
        moved = "not a bit" if row["same_bits"] == "yes" else f"{100 * row['moved_m']:.2g} cm"
        table.append(["", "", row["off"], cost, f"{100 * change:+.0f} %", moved])
    return markdown(["scene", "solver", "switched off", "CPU s per s", "time", "moves the cloth by"], table)


def threads(rows):
    """One thread against two, and what that comes to."""
    if not rows:
        return "Not measured in this run."
    table = [[row["scene"].replace(" x ", " × "), row["ticks"], f"{100 * row['share_in_chunks']:.0f} %",
              f"{1000 * row['wall_s_one_thread'] / row['ticks']:.2g} ms", f"{row['wall_ratio']:.2f}",
              f"{row['cpu_ratio']:.2f}", "yes" if row["same_bits"] == "yes" else "**no**"] for row in rows]
    faster = [row["scene"] for row in rows if row["wall_ratio"] < 0.95]
    verdict = (f"Two threads are faster by a twentieth or more in {len(faster)} of {len(rows)}"
               + (f" ({', '.join(faster)})." if faster else ": one thread is the right choice here."))
    return verdict + "\n\n" + markdown(
        ["scene", "ticks", "runs in chunks", "wall time a tick", "wall time of two / one",
         "CPU time of two / one", "same bits"], table)


def shaking(rows):
    table = []
    for row in rows:
        back = row["from_rest"] <= 0.01
        bounded = row["gained_energy"] <= 0.01
        table.append([NAMES[row["solver"]] + " " + row["setting"].replace("x", "×"), row["fabric"],
                      f"{row['n']}²", row["insult"],
                      percent(row["from_rest"]) + ("" if back else " **missed**"),
                      percent(row["gained_energy"]) + ("" if bounded else " **missed**"),
                      row["rescues"]])
    return markdown(["solver", "fabric", "N", "insult", "from rest, 5 s later",
                     "energy above the start", "ticks taken back"], table)


def real_time_sizes(rows):
    """The largest squares of particles whose swing needs half of one core."""
    start = "largest N in real time on half a core, "
    return markdown(["fabric", "largest N", "runs"], [
        [row["figure"].removeprefix(start), f"{row['value']:g}²", row["runs"]]
        for row in rows if row["figure"].startswith(start)])


def wall_on_two_threads(thread_rows, name):
    """Seconds a simulated second, if the case was run on two threads; ticks are of 1/60 s."""
    for row in thread_rows:
        if row["scene"] == name:
            return row["wall_s_one_thread"] * row["wall_ratio"] * 60 / row["ticks"]
    return None


def need_of_implicit(part_rows, cells, thread_rows):
    """Which built-in scenes or cotton at 128² verlet cannot hold in real time, by the figures."""
    rows, slow, not_its_fault, on_two = [], [], [], []
    for row in part_rows:
        if row["off"] != "nothing" or row["solver"] != "verlet":
            continue
        slowest, share = row["slowest_second"], row["share_of_solver"]
        rows.append([row["scene"], seconds(row["cpu_per_second"]), seconds(slowest),
                     f"first {row['seconds_looked_at']} s", f"{100 * share:.0f} %"])
        if slowest * share > 1:
            slow.append(f"{row['scene']} ({seconds(slowest)} CPU s per s)")
        elif slowest > 1:
            not_its_fault.append(f"{row['scene']} ({seconds(slowest)} CPU s in its dearest second, of "
                                 f"which verlet itself takes {seconds(slowest * share)})")
    for scene in SQUARE_METRES:
        for cell in of_case(cells, scene, "cotton", 128, "verlet"):
            if cell["setting"] != "x1" or cell["outcome"] != "ran":
                continue
            cost = seconds(cell["cpu_per_second"])
            rows.append([f"cotton at 128², {scene}", cost, "–", "the whole run", "–"])
            if cell["cpu_per_second"] <= 1:
                continue
            what, wall = f"cotton at 128² in the scene {scene}", wall_on_two_threads(
                thread_rows, f"{scene}, cotton, 128 x 128")
            if wall is not None and wall <= 1:
                on_two.append(f"{what} ({cost} CPU s per s on one thread, {seconds(wall)} s per s by the clock on two)")
            else:
                slow.append(f"{what} ({cost} CPU s per s"
                            + (")" if wall is None else f", {seconds(wall)} s by the clock on two threads)"))
    if slow:
        verdict = ("**Yes**, by these figures: on this machine verlet does not hold "
                   + ", ".join(slow) + " in real time.")
    else:
        verdict = ("**No**, by these figures: on this machine verlet itself needs less than a second for "
                   "each of them, so no implicit solver is built.")
    if on_two:
        verdict += " It takes both cores for " + ", ".join(on_two) + "."
    if not_its_fault:
        verdict += (" Not in real time, but for reasons that another solver would not change: "
                    + ", ".join(not_its_fault) + ".")
    return verdict + "\n\n" + markdown(
        ["scene", "CPU s per s", "CPU s of its dearest second", "looked at",
         "springs, bending and integration"], rows)
