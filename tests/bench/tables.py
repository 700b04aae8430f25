"""The figures of the report as tables of text, from the CSV files that weft_bench writes."""

import csv
import re
import statistics
from pathlib import Path

FABRICS = ["soft", "stiff", "cotton"]
SCENES = ["swing", "swing-free", "static-rest", "cantilever", "hanging-strip", "flag", "drape", "drape-free"]
SIZES = [32, 64, 128, 256]
BOUNDS = [(0.1, "10 %"), (0.01, "1 %"), (0.001, "0.1 %")]
# What errors are asked for, each with the smallest error that noise lets be measured.
BOUNDED = {"position": 0.001, "strain": 0.01, "energy": 0.001}
SOLVERS = ["verlet", "implicit", "xpbd", "relaxation"]
NAMES = {"verlet": "verlet", "xpbd": "XPBD", "relaxation": "seed", "implicit": "implicit"}
WANTED_SETTINGS = 6
ERRORS = ["position", "strain", "energy", "momentum", "mean_shape"]


def read(directory, name):
    path = Path(directory, f"{name}.csv")
    if not path.exists():
        return []
    with open(path, encoding="utf-8", newline="") as file:
        rows = [{key: number(value) for key, value in row.items()} for row in csv.DictReader(file)]
    return distinct(rows) if name == "accuracy" else rows


def distinct(cells):
    """The cells without those that ran as another one: a world takes more substeps than it is asked for
    where its stability needs them. Their time is the median of all; `same` counts them."""
    groups = {}
    for place, cell in enumerate(cells):
        what = (cell["substeps"], cell["sweeps"], cell["damping_sweeps"])
        key = what if cell["outcome"] != "not run" else ("not run", place)
        groups.setdefault((cell["scene"], cell["fabric"], cell["n"], cell["solver"], key), []).append(cell)
    kept = []
    for group in groups.values():
        # Where wind changes the need from tick to tick, the one that was asked for the most is the truest.
        best = max(group, key=lambda cell: cell["least_substeps"])
        times = statistics.median(cell["cpu_per_second"] for cell in group)
        kept.append({**best, "cpu_per_second": times, "same": len(group)})
    return kept


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
    if value != value:
        return "–"
    return f"{100 * value:.2g} %" if value < 0.995 else f"{100 * value:.0f} %"


def seconds(value):
    return f"{value:.2g}" if value < 10 else f"{value:.0f}"


def setting_name(cell, short=False):
    """What ran, by its substeps; what was asked for where it did not run.
    @param short  without the solver's name"""
    if cell["solver"] == "verlet":
        name = "×" + cell["setting"].removeprefix("x").replace(" without dashpots", ", no dashpots")
    else:
        name = f"{cell['substeps'] or cell['least_substeps']}×{cell['sweeps']}"
    return name if short else f"{NAMES[cell['solver']]} {name}"


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
    return max(set(reasons), key=reasons.count)


def cost_of_accuracy(cells, scene="swing"):
    """What 10 %, 1 % and 0.1 % of each quantity cost at each N; the fabric is named if there are several."""
    mine = [cell for cell in cells if cell["scene"] == scene]
    fabrics = [fabric for fabric in FABRICS if fabric in {cell["fabric"] for cell in mine}]
    rows = []
    for n in unique(cell["n"] for cell in mine):
        for fabric in fabrics:
            case = of_case(mine, scene, fabric, n)
            for place, (bound, name) in enumerate(BOUNDS if case else ()):
                begin = [f"{n}²", fabric] if place == 0 else ["", ""]
                rows.append([*begin[:1 if len(fabrics) == 1 else 2], name,
                             *(cost_of(case, bound, error) for error in BOUNDED)])
    head = ["N", "fabric", "error"] if len(fabrics) != 1 else ["N", "error"]
    return markdown(head + list(BOUNDED), rows)


def cost_of(case, bound, error):
    """The cheapest run of a case within a bound, and what it costs."""
    if bound < BOUNDED[error]:
        return "–"
    best = cheapest(case, bound, error)
    if not best and all(cell[error] != cell[error] for cell in case if cell["outcome"] == "ran"):
        return "not compared" if any(cell["outcome"] == "ran" for cell in case) else why_not(case)
    if not best:
        return "none that was run" if any(cell["outcome"] != "not run" for cell in case) else why_not(case)
    return f"{seconds(best['cpu_per_second'])} ({setting_name(best)})"


def default_errors(cells, scene):
    """What the default, verlet x1, is off by, over all cases of a scene that were compared."""
    runs = [cell for cell in cells if (cell["scene"], cell["solver"], cell["setting"]) == (scene, "verlet", "x1")
            and cell["outcome"] == "ran"]
    told = []
    for error in BOUNDED:
        values = [cell[error] for cell in runs if cell[error] == cell[error]]
        if values:
            told.append(f"{span_of(values)} in {error}")
    return ", ".join(told)


def span_of(values):
    low, high = percent(min(values)), percent(max(values))
    return low if low == high else f"{low.removesuffix(' %')} to {high}"


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
                           f"{seconds(ours['cpu_per_second'])} ({setting_name(ours, short=True)})"]
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


def spatial_error(rows, spatial, row):
    """That of a case against twice its particles a side, or why there is none."""
    for s in spatial:
        if (s["scene"], s["fabric"], s["n"]) == (row["scene"], row["fabric"], row["n"]):
            return percent(s["position"])
    if row["missing"]:
        return "– (no reference)"
    twice = 2 * row["n"]
    fine = [r for r in rows if (r["scene"], r["fabric"], r["n"]) == (row["scene"], row["fabric"], twice)]
    if not fine:
        return f"– ({twice}² is not measured)"
    if fine[0]["missing"]:
        return f"– ({twice}² has no reference)"
    return f"– ({twice}² is measured in a run of its own, or compared at other times)"


def references(rows, spatial, scene):
    table = []
    for row in rows:
        if row["scene"] != scene:
            continue
        coarse = spatial_error(rows, spatial, row)
        if row["missing"]:
            table.append([row["fabric"], f"{row['n']}²", "none: " + row["missing"], *["–"] * 8, coarse])
            continue
        table.append([row["fabric"], f"{row['n']}²", row["how"], f"{row['self_error']:.1e}",
                      *(until(row, quantity) for quantity in ("positions", "strains", "energies")),
                      *(percent(row[f"noise_of_{what}"]) for what in ("position", "strain", "energy", "mean_shape")),
                      coarse])
    return markdown(["fabric", "N", "reference", "its last refinement changed", "positions compared", "strains",
                     "energy", "1 µm at the start changes positions by", "strains", "energy", "mean shape",
                     "spatial error, N against 2N"], table)


def until(row, quantity):
    """From when to when a quantity is compared."""
    first, last = row["compared_from_s"], row[f"{quantity}_to_s"]
    if last < first:
        return "–"
    return f"at {last:.2g} s" if last == first else f"{first:.2g} to {last:.3g} s"


def error_vectors(cells, scene):
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
                rows.append(row + [f"{1e3 * best['penetration_m']:.2g} mm"])
    head = ["fabric", "N", "setting", "best of", "CPU s per s"] + [e.replace("_", " ") for e in ERRORS]
    return markdown(head + ["penetration"], rows)


def few_settings(cells):
    """Cells of which fewer settings were run than are wanted, and why."""
    rows = []
    groups = {}
    for cell in cells:
        groups.setdefault((cell["scene"], cell["fabric"], cell["n"], cell["solver"]), []).append(cell)
    for (scene, fabric, n, solver), group in groups.items():
        ran = [cell for cell in group if cell["outcome"] != "not run"]
        if not ran or len(ran) >= WANTED_SETTINGS:
            continue
        reasons = []
        fewest, same = min(cell["substeps"] for cell in ran), sum(cell["same"] - 1 for cell in ran)
        if same:
            reasons.append(f"{same} that were asked for fewer than {fewest} substeps a tick ran with these, as "
                           "its stability needs")
        left = [cell for cell in group if cell["outcome"] == "not run"]
        if left:
            reasons.append(f"{len(left)} not run: {left[0]['reason']}")
        rows.append([scene, fabric, f"{n}²", NAMES[solver], len(ran), "; ".join(reasons)])
    return markdown(["scene", "fabric", "N", "solver", "settings", "why"], rows) if rows else "None."

def without_figure(cells, outcome):
    rows = []
    groups = {}
    for cell in cells:
        if cell["outcome"] == outcome:
            key = (cell["scene"], cell["fabric"], cell["n"], cell["solver"])
            groups.setdefault(key, []).append(cell)
    for (scene, fabric, n, solver), group in groups.items():
        names = ", ".join(setting_name(cell, short=True) for cell in group)
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
    if not rows:
        return ""
    where = f"Taken at commit {' and '.join(unique(str(row['commit']) for row in rows))}"
    if "vectors" not in rows[0]:
        return where + "."
    return f"{where} with {rows[0]['vectors']} kernels; load of the machine at the end {rows[-1]['load']}."


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
        times = "one run each" if runs[commit] == 1 else f"medians of up to {runs[commit]} runs"
        return f"{', '.join(f'{n}²' for n in sorted(sizes[commit]))}{of} at commit {commit}, {times}"

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


def bands(rows):
    """What bands of rows gain on two threads, in one sentence."""
    parts = [f"{1 / row['wall_ratio']:.2g} times at {row['scene'].split(' x ')[-1]}²" for row in rows
             if row["scene"].startswith("swing")]
    return f"Measured on the swing of cotton, two threads are faster {', '.join(parts)}." if parts else ""


def shaking(rows):
    if not rows:
        return "Not measured in this run."
    table = []
    for row in rows:
        missed = [" **missed**" if row[key] < row["seeds"] else "" for key in ("back", "bounded")]
        table.append([f"{NAMES[row['solver']]} {row['substeps']}" + (
                          "" if row["solver"] == "verlet" else f"×{row['sweeps']}"),
                      row["fabric"], f"{row['rigidity_n_m']:.2g}", f"{row['n']}²", row["insult"],
                      percent(row["from_rest"]), f"{row['back']} of {row['seeds']}{missed[0]}",
                      percent(row["gained_energy"]), f"{row['bounded']} of {row['seeds']}{missed[1]}",
                      row["rescues"]])
    return taken(rows) + "\n\n" + markdown(
        ["solver", "fabric", "B [N m]", "N", "disturbance", "from rest, 5 s later", "seeds within 1 %",
         "energy above start and work", "seeds within 1 %", "ticks taken back"], table)


def real_time_sizes(rows):
    """The largest squares of particles whose swing needs half of one core."""
    start, other = "largest N in real time on half a core, ", ", implicit"
    sizes = {row["figure"].removeprefix(start): f"{row['value']:g}²" for row in rows
             if row["figure"].startswith(start)}
    return markdown(["fabric", "largest N with verlet", "with implicit"], [
        [fabric, size, sizes.get(fabric + other, "not measured")]
        for fabric, size in sizes.items() if not fabric.endswith(other)])
