"""Plots of error against CPU time, drawn by gnuplot."""

import subprocess

import tables

COLOURS = {"verlet": "#1b6ca8", "xpbd": "#c4541b", "relaxation": "#5b8a3a", "implicit": "#7a3e9d"}
MARKS = {"verlet": 7, "xpbd": 5, "relaxation": 9, "implicit": 13}
HIGHEST = 3  # failed runs that are farther off, or that left no error, are drawn there


def height_of(cell):
    """Where a run is drawn [%]; a failed one without error at the highest place."""
    error = cell["position"]
    if cell["outcome"] == "failed" and not 0 < error < HIGHEST:
        error = HIGHEST
    return 100 * error


def data_block(name, cells):
    """A gnuplot data block of runs, dearest last."""
    lines = [f"${name} << EOD"]
    for cell in sorted(cells, key=lambda c: c["cpu_per_second"]):
        lines.append(f"{cell['cpu_per_second']} {height_of(cell)}")
    return lines + ["EOD"]


def panel(index, cells, scene, fabric, n):
    """One diagram: error against CPU time, a line for each solver."""
    blocks, curves = [], []
    for solver in tables.SOLVERS:
        mine = tables.of_case(cells, scene, fabric, n, solver)
        ran = [cell for cell in mine if cell["outcome"] == "ran"]
        failed = [cell for cell in mine if cell["outcome"] == "failed"]
        style = f"lc rgb '{COLOURS[solver]}' lw 1.3"
        if ran:
            blocks += data_block(f"ran{index}{solver}", ran)
            curves.append(f"$ran{index}{solver} with points pt {MARKS[solver]} ps 0.45 {style} notitle")
            front = [c for c in ran if not any(
                o["cpu_per_second"] < c["cpu_per_second"] and o["position"] <= c["position"] for o in ran)]
            blocks += data_block(f"front{index}{solver}", front)
            curves.append(f"$front{index}{solver} with lines {style} notitle")
        if failed:
            blocks += data_block(f"failed{index}{solver}", failed)
            curves.append(f"$failed{index}{solver} with points pt 2 ps 0.6 lw 1.6 "
                          f"lc rgb '{COLOURS[solver]}' notitle")
    lines = blocks + [f"set title '{fabric}, {n} × {n}' offset 0,-0.7"]
    if curves:
        return lines + ["plot " + ", ".join(curves)]
    case = tables.of_case(cells, scene, fabric, n)
    reason = tables.why_not(case) if case else "this run was cut before it, or not asked for it"
    words, wrapped = reason.split(), [""]
    for word in words:
        if len(wrapped[-1]) + len(word) > 34:
            wrapped.append("")
        wrapped[-1] = (wrapped[-1] + " " + word).strip()
    text = "\\n".join(["not run:"] + wrapped)
    return lines + [f'set label 1 "{text}" at graph 0.5,0.45 center font ",9"',
                    "plot [0.001:10][1e-4:300] NaN notitle", "unset label 1"]


def legend(width, height):
    """Each solver's mark and name, and that of failed runs, above the first diagram."""
    lines, top = [], 1 - 14 / height
    for k, solver in enumerate(tables.SOLVERS):
        lines.append(f"set label {10 + k} '{tables.NAMES[solver]}' at screen {(24 + 68 * k) / width},{top} "
                     f"point pt {MARKS[solver]} ps 0.7 lc rgb '{COLOURS[solver]}' offset 0.7,0 "
                     f"tc rgb '{COLOURS[solver]}' font ',11'")
    lines.append(f"set label 13 'failed; at {100 * HIGHEST} % if farther off or blown up' "
                 f"at screen {228 / width},{top} point pt 2 ps 0.6 lw 1.6 lc rgb '#444444' offset 0.7,0 "
                 "tc rgb '#444444'")
    return lines


def plot_scene(cells, scene, path):
    sizes = tables.unique(cell["n"] for cell in cells if cell["scene"] == scene)
    fabrics = [f for f in tables.FABRICS if any(
        c["fabric"] == f for c in cells if c["scene"] == scene)]
    mine = [c for c in cells if c["scene"] == scene and c["outcome"] != "not run"]
    least = min([c["position"] for c in mine if c["position"] > 0], default=1e-4)
    width, height = 300 * len(fabrics) + 20, 205 * len(sizes) + 60
    lines = [
        f"set terminal svg size {width},{height} enhanced font 'sans,10' background rgb 'white'",
        f"set output '{path}'", "set encoding utf8", "set logscale xy",
        "set format x '%g'", "set format y '%g'", "set grid lc rgb '#dddddd'", "set tics scale 0.5 nomirror",
        "set mxtics 1", "set mytics 1", f"set yrange [{100 * least / 2}:{200 * HIGHEST}]",
        "set xlabel 'CPU s a simulated s' offset 0,0.6", "set ylabel 'position error [%]' offset 1.5,0",
        f"set multiplot layout {len(sizes)},{len(fabrics)} margins {64 / width},{1 - 14 / width},"
        f"{52 / height},{1 - 48 / height} spacing {60 / width},{64 / height}"]
    lines += legend(width, height)
    lines += ["set arrow 1 from graph 0,first 1 to graph 1,first 1 nohead lc rgb '#999999' dt 2"]
    for index, (n, fabric) in enumerate((n, f) for n in sizes for f in fabrics):
        lines += panel(index, cells, scene, fabric, n)
        if index == 0:
            lines += [f"unset label {k}" for k in (10, 11, 12, 13)]
    lines.append("unset multiplot")
    subprocess.run(["gnuplot"], input="\n".join(lines) + "\n", text=True, check=True)
