"""Makes the report of what weft_bench has measured: plots, REPORT.md and the README's table."""

import argparse
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import contact_tables  # noqa: E402
import tables  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
BEGIN, END = "<!-- report: begin -->", "<!-- report: end -->"
COLOURS = {"verlet": "#1b6ca8", "xpbd": "#c4541b", "relaxation": "#5b8a3a"}
MARKS = {"verlet": 7, "xpbd": 5, "relaxation": 9}
SCENES = {"swing": "Swing from the horizontal", "static-rest": "Static rest",
          "cantilever": "Cantilever", "hanging-strip": "Hanging strip", "flag": "Flag in wind",
          "drape": "Drape on a sphere"}
ABOUT = {
    "swing": "1 m × 1 m, held by one edge, let go when level.",
    "static-rest": "1 m × 1 m between two opposite edges; compared where it has come to rest.",
    "cantilever": "A strip of 12 cm × 3 cm, clamped at one end, let go when level.",
    "hanging-strip": "1 m × 12 cm, upright, let go when not stretched yet: the way is the stretch "
                     "alone, so a solver with rigid springs is 100 % wrong.",
    "flag": "1 m × 1 m, held by one edge, in a wind of 6 m/s.",
    "drape": "1 m × 1 m, falls on a sphere of 0.3 m radius, with friction."}


def data_block(name, cells):
    """A gnuplot data block of runs, dearest last; failed ones apart."""
    lines = [f"${name} << EOD"]
    for cell in sorted(cells, key=lambda c: c["cpu_per_second"]):
        lines.append(f"{cell['cpu_per_second']} {max(100 * min(cell['position'], 3), 1e-5)}")
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
            blocks += data_block(f"failed{index}{solver}", [{**c, "position": 3} for c in failed])
            curves.append(f"$failed{index}{solver} with points pt 2 ps 0.9 lw 2 "
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
        "set mxtics 1", "set mytics 1",
        f"set yrange [{100 * max(least / 2, 1e-7)}:500]",
        "set xlabel 'CPU s a simulated s' offset 0,0.6", "set ylabel 'position error [%]' offset 1.5,0",
        f"set multiplot layout {len(sizes)},{len(fabrics)} margins {64 / width},{1 - 14 / width},"
        f"{52 / height},{1 - 48 / height} spacing {60 / width},{64 / height}"]
    for k, solver in enumerate(tables.SOLVERS):
        lines.append(f"set label {10 + k} '● {tables.NAMES[solver]}' at screen {(20 + 75 * k) / width},"
                     f"{1 - 14 / height} tc rgb '{COLOURS[solver]}' font ',11'")
    lines.append(f"set label 20 '×: failed' at screen {250 / width},"
                 f"{1 - 14 / height} tc rgb '#444444'")
    lines += ["set arrow 1 from graph 0,first 1 to graph 1,first 1 nohead lc rgb '#999999' dt 2"]
    for index, (n, fabric) in enumerate((n, f) for n in sizes for f in fabrics):
        lines += panel(index, cells, scene, fabric, n)
        if index == 0:
            lines += [f"unset label {k}" for k in (10, 11, 12, 20)]
    lines.append("unset multiplot")
    subprocess.run(["gnuplot"], input="\n".join(lines) + "\n", text=True, check=True)


def report_text(data):
    cells = tables.read(data, "accuracy")
    machine = {row["key"]: row["value"] for row in tables.read(data, "machine")}
    references, spatial = tables.read(data, "references"), tables.read(data, "spatial")
    parts, kernels = tables.read(data, "parts"), tables.read(data, "kernels")
    threads = tables.read(data, "threads")
    out = ["# Speed against error", "",
           "Written by `./dev report`; not by hand. All times are CPU time of one thread, medians of "
           f"{max((c['timed_runs'] for c in cells), default=0)} interleaved runs, and tell what one "
           "simulated second costs. They were taken on the machine below; its load, with the "
           "measuring itself, is told.", "",
           tables.markdown(["", ""], [[k, v] for k, v in machine.items()]), "",
           "The tables as CSV, with every setting and the commit: " + ", ".join(
               f"[{name}](data/{name}.csv)" for name in
               ("accuracy", "references", "spatial", "kernels", "parts", "threads", "contact", "contact_cases",
                "shaking", "machine")) + ".",
           "", "## What an error costs", "",
           "The cheapest setting of any solver whose positions stay within the error all the way of "
           "the swing, in CPU seconds a simulated second. "
           f"Measured: {tables.sizes_taken(cells)}", "",
           tables.cost_of_accuracy(cells), "",
           "## verlet against XPBD at 1 %", "", tables.summary_of_rivals(cells), "",
           "Both run the same springs, bending and drag in single precision, each with its own vector "
           "kernel. The error of strains is beside that of positions because lengths may be far off "
           "while the cloth is about where it should be.", "",
           tables.verlet_against_xpbd(cells), "",
           "## How errors are measured", "",
           "The reference solves the same springs and masses in double precision, without dashpots: "
           "these belong to verlet, and what they change counts as its error. Forces alone are "
           "integrated by the classical Runge-Kutta method, its substeps doubled, or, where that takes "
           "too long, by leapfrog at 1, 1.25, 1.5, 2 and 3 times the stable substeps, extrapolated to "
           "infinitely many; a test holds that both give the same errors. With contact or air it is "
           "verlet in double with its substeps doubled. This goes on until it changes the positions "
           "by less than 1e-8 or the budget is spent; what the last refinement changed is told. "
           "Beside it runs a start perturbed by 1 µm (rms): where that has "
           "grown 10 times, nothing later is compared. Position: L2 of the distance over the longest "
           "L2 way of the reference, the worst sample. Strain: L2 over all springs, over that of the "
           "reference. Energy: over m g L. Momentum: over m √(g L). Mean shape: as position, of the mean "
           "over the second half of the whole horizon, which is what can be compared where a "
           "perturbation grows. Penetration: the deepest at a sample. A run whose positions end more "
           "than 100 % off counts as failed. verlet ×1 is the product; ×2 has twice the "
           "stable substeps; XPBD and the seed's relaxation are given as substeps × sweeps; relaxation "
           "has rigid springs. Where verlet has no dashpots it is as XPBD is, and takes fewer substeps. "
           "\"Best of\" counts the settings that were run."]
    for scene in tables.unique(cell["scene"] for cell in cells):
        out += ["", f"## {SCENES[scene]}", "", ABOUT[scene], "",
                f"![Error against CPU time: {SCENES[scene]}](plots/{scene}.svg)", "",
                tables.references(references, spatial, scene), "",
                "The cheapest setting within 1 % in position, or the best one where none is:", "",
                tables.error_vectors(cells, scene)]
    out += ["", "## Kernels", "", tables.taken(kernels), "", tables.kernels(kernels), "",
            "## What runs in real time", "",
            "The largest square of particles whose swing, with verlet as scenes run it, needs at most "
            "half of one core.", "", tables.real_time_sizes(kernels), "",
            "## Is an implicit solver called for?", "",
            "It is built as soon as verlet cannot hold a built-in scene, or cotton at 128², in real time: on "
            "one thread, or by the clock on the two that a server has here. Each of Weft's own scenes, but no "
            "hard cases: all it costs with contact and air, and the share of springs, bending and "
            "integration, which is what another solver could save.", "", tables.need_of_implicit(parts, cells, threads), "",
            "## What each part of the model costs", "",
            "Each built-in scene as it is and with one part switched off, over its first second or a "
            "part of it (the hard cases are left out); how "
            "far the particles end from where they were (rms).", "", tables.parts(parts), "",
            "## Threads", "",
            "One thread against two, by wall time and by CPU time of the whole process. What runs in "
            "chunks is the search for contacts with objects and for pairs of cloth with cloth, the regions of "
            "many particles at once, where a cloth touches itself at some hundred places the sweeps over "
            "these, in slabs of space, and springs, bending, kick and drift of grids from 64² on, in bands of "
            "rows. Air, meshes and the sweeps over contacts with objects are on one thread. Threads meet some "
            "hundred times a tick for a few microseconds of work, and who waits looks out for the next time "
            "instead of sleeping, which is CPU time too. On a machine that does nothing else the time falls by "
            "half of the share at best; where another process takes the other core, it may rise by a tenth or "
            "two.", "",
            tables.taken(threads), "", tables.threads(threads), "",
            "## Contact of a cloth with itself", "",
            "What each phase costs, in CPU milliseconds a tick of 1/60 s, for a square metre of cotton with a "
            "thickness of a quarter of its edge length. Pairs are those of features that are looked at, rows "
            "the contacts that are solved. Broad phase: boxes of patches; pairs: their features against each "
            "other; regions: certified room; rows: closest points; repulsion: solving without friction; "
            "friction: what solving takes more than the same state does at μ = 0, measured in turn; elastic: "
            "springs, bending, integration. Folded and crumpled sheets lie on the ground, whose contact "
            "is booked with theirs. Sheets of 257² are measured in tenths of a tick.", "",
            contact_tables.speed(tables.read(data, "contact")), "",
            "## Piles, hands and a model", "",
            "64 × 64 cotton, each tick the median of all runs, or each run of half a second. The sheet falls "
            "upright on the ground with drag 5/s and crumples there; nothing is put to sleep. The hand takes "
            "the pile at its rim and goes to and fro through its middle for a second, half a metre each way. "
            "A tick of 1/60 s is 16.7 ms. Crossings are counted exactly beside the timed ticks. "
            "`./dev report --contact` takes this section and the one before anew.", "",
            contact_tables.cases(tables.read(data, "contact_cases")), "",
            "## Hard shaking", "",
            "Cloths of 1 m × 1 m that hang by one edge. With drag 5/s, 5 s after the insult: rms "
            "distance from the solver's own rest, over 1 m; at most 1 % is wanted. Without drag: what "
            "the energy rose above that after the insult, over that start; at most 1 % is wanted.", "",
            tables.shaking(tables.read(data, "shaking")), "",
            "## Runs that failed", "", tables.without_figure(cells, "failed"), "",
            "## Cells that were not run", "", tables.without_figure(cells, "not run"), ""]
    return "\n".join(out)


def readme_block(data):
    return "\n".join([BEGIN, tables.cost_of_accuracy(tables.read(data, "accuracy")), END])


def with_block(readme, data):
    """The README with its table from the given data."""
    before, rest = readme.split(BEGIN)
    after = rest.split(END)[1]
    return before + readme_block(data) + after


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", type=Path, help="holds data/; gets plots/ and REPORT.md")
    parser.add_argument("--readme", type=Path, help="its table is written anew")
    options = parser.parse_args()
    data, plots = options.directory / "data", options.directory / "plots"
    plots.mkdir(exist_ok=True)
    cells = tables.read(data, "accuracy")
    for scene in tables.unique(cell["scene"] for cell in cells):
        plot_scene(cells, scene, plots / f"{scene}.svg")
    (options.directory / "REPORT.md").write_text(report_text(data), encoding="utf-8")
    if options.readme:
        text = options.readme.read_text(encoding="utf-8")
        options.readme.write_text(with_block(text, data), encoding="utf-8")


if __name__ == "__main__":
    main()
