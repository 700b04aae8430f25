"""Makes the report of what weft_bench has measured: plots, REPORT.md and the README's table."""

import argparse
import csv
import shutil
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import contact_tables  # noqa: E402
import plots  # noqa: E402
import real_time_tables  # noqa: E402
import tables  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
CASES = ("accuracy", "references", "spatial")  # tables whose rows belong to cases
SCENES = {"swing": "Swing from the horizontal", "swing-free": "Swing without drag", "static-rest": "Static rest",
          "cantilever": "Cantilever", "hanging-strip": "Hanging strip", "flag": "Flag in wind",
          "drape": "Drape on a sphere", "drape-free": "Drape without drag"}
ABOUT = {
    "swing": "1 m × 1 m, held by one edge, let go when level.",
    "swing-free": "As above, without drag.",
    "static-rest": "1 m × 1 m between two opposite edges; compared where it has come to rest.",
    "cantilever": "A strip of 12 cm × 3 cm, of which two rows are held at one end, let go when level. Held row by "
                  "row, it bends as if it were clamped half a cell behind the second.",
    "hanging-strip": "1 m × 12 cm, upright, let go when not stretched yet: the way is the stretch "
                     "alone, so a solver with rigid springs is 100 % wrong.",
    "flag": "1 m × 1 m, held by one edge, in a wind of 6 m/s.",
    "drape": "1 m × 1 m, falls 5 mm on a sphere of 0.3 m radius, with friction.",
    "drape-free": "As above, without drag."}
# What else decides how large errors are: uniform drag, air, contact. As cases.cpp has them.
DRAG = {"swing": 0.2, "swing-free": 0, "static-rest": 10, "cantilever": 0.2, "hanging-strip": 0.2, "flag": 0,
        "drape": 0.5, "drape-free": 0}  # [1/s]
SURROUNDINGS = {"flag": "no contact", "drape": "no air, contact with the sphere alone",
                "drape-free": "no air, contact with the sphere alone"}


def conditions(scene):
    """Drag, air and contact of a scene in a few words."""
    drag = f"a uniform drag of {DRAG[scene]:g}/s" if DRAG[scene] else (
        "no drag but that of the air" if scene == "flag" else "no drag")
    return f"{drag}, {SURROUNDINGS.get(scene, 'no air, no contact')}"


def spans(references, scene):
    """Until when each quantity of a scene is compared, over all cases; and why no longer."""
    rows = [row for row in references if row["scene"] == scene and not row["missing"]]
    if not rows:
        return "not compared: no reference"
    told = []
    for quantity, name in (("positions", "positions"), ("strains", "strains"), ("energies", "energy")):
        ends = [row[f"{quantity}_to_s"] for row in rows if row[f"{quantity}_to_s"] >= row["compared_from_s"]]
        if not ends:
            continue
        low, high = f"{min(ends):.2g}", f"{max(ends):.2g}"
        told.append(f"{name} to {low if low == high else f'{low} to {high}'} s")
    horizon = max(row["horizon_s"] for row in rows)
    return (f"compared of {horizon:g} s are {', '.join(told)}: until 1 µm at the start changes them by a third of "
            "0.1 % (strains: of 1 %)")


def about(references, scene):
    return f"{ABOUT[scene]} Conditions: {conditions(scene)}; {spans(references, scene)}."


def machine_rows(machine):
    """Of the machine, what was measured: a run that was cut has no end and no sum."""
    cut = "not measured: the run was cut"
    return [[key, cut if value == 0 or value == "the run was cut" else value] for key, value in machine.items()]


def commits(*lists):
    """A sentence on the commits that the tables come from."""
    all_of = tables.unique(str(row["commit"]) for rows in lists for row in rows)
    if len(all_of) < 2:
        return ""
    return (f" The tables are **not of one commit** but of {len(all_of)}: {', '.join(all_of)}; each says of which, "
            "and figures of two tables are to be compared with care.")


COSTED = ("swing", "swing-free", "drape", "drape-free")  # scenes whose costs of each error are told


def cost_section(cells, references, scene):
    """What an error costs in one scene, and what the default is off by there."""
    if not any(cell["scene"] == scene for cell in cells):
        return []
    return [f"{SCENES[scene]}: {conditions(scene)}; {spans(references, scene)}.", "",
            tables.cost_of_accuracy(cells, scene), "",
            f"The default, verlet ×1, is off by {tables.default_errors(cells, scene)}.", ""]


def report_text(data):
    cells = tables.read(data, "accuracy")
    machine = {row["key"]: row["value"] for row in tables.read(data, "machine")}
    references, spatial = tables.read(data, "references"), tables.read(data, "spatial")
    parts, kernels = tables.read(data, "parts"), tables.read(data, "kernels")
    threads, real_time = tables.read(data, "threads"), tables.read(data, "real_time")
    shaking = tables.read(data, "shaking")
    contact = tables.read(data, "contact"), tables.read(data, "contact_cases")
    out = ["# Speed against error", "",
           "Written by `./dev report`; not by hand. Times are CPU time of one thread where nothing else is "
           "said, and tell what one simulated second costs. They are medians of "
           f"{max((c['timed_runs'] for c in cells), default=0)} interleaved runs, all cases of a table in turn, but for these: "
           "a run that failed is timed once; of the largest N in real time each N on the way to it is timed "
           "five times in a row; of the cases of \"Is the solver implicit called for?\" those far from real time "
           "are run once, and those with twice the substeps or with implicit; figures with one run beside "
           "them, such as counts, memory and distances, are no times."
           + commits(cells, kernels, parts, real_time, threads, shaking, *contact)
           + " The machine and its load, with the measuring itself:", "",
           tables.markdown(["", ""], machine_rows(machine)), "",
           "The tables as CSV, with every setting and the commit: " + ", ".join(
               f"[{name}](data/{name}.csv)" for name in
               ("accuracy", "references", "spatial", "kernels", "parts", "real_time", "threads", "contact", "contact_cases",
                "shaking", "machine")) + ".",
           "", "## What an error costs", "",
           "The cheapest setting of any solver that stays within the error, of one quantity at a time, in CPU seconds "
           "a simulated second. The drag is that of most built-in scenes, which have 0 to 0.5/s, and none. "
           f"Measured: {tables.sizes_taken(cells)}", "",
           *(line for scene in COSTED for line in cost_section(cells, references, scene)),
           "## verlet against XPBD at 1 %", "", tables.summary_of_rivals(cells), "",
           "Both run the same springs, bending and drag in single precision, each with its own vector "
           "kernel. The error of strains is beside that of positions because lengths may be far off "
           "while the cloth is about where it should be. Conditions: "
           + "; ".join(f"{scene}: {conditions(scene)}" for scene in SCENES) + ".", "",
           tables.verlet_against_xpbd(cells), "",
           "## How errors are measured", "",
           "The reference solves the same springs and masses in double precision, without dashpots: "
           "these belong to verlet, and what they change counts as its error. Forces alone are "
           "integrated by the classical Runge-Kutta method, its substeps doubled, or, where that takes "
           "too long, by leapfrog at 1, 1.25, 1.5, 2 and 3 times the stable substeps, extrapolated to "
           "infinitely many; a test holds that both give the same errors. With contact or air it is "
           "verlet in double with its substeps doubled. This goes on until it changes the positions "
           "by less than 1e-8 or the budget is spent; what the last refinement changed is told. "
           "Cotton's own dashpots of bending are off: they act between ticks, in every solver alike. "
           "Beside the reference runs a start perturbed by 1 µm (rms, each particle by itself), and each quantity is "
           "compared until that has changed it by a third of the smallest error that is asked for: of 0.1 %, of "
           "strains of 1 %; where the reference is extrapolated, no longer than positions are. Position: L2 of the distance over the longest "
           "L2 way of the reference, the worst sample. Strain: L2 over all springs, over that of the "
           "reference. Energy: over m g L. Momentum: over m √(g L). Mean shape: as position, of the mean "
           "over the second half of the whole horizon, which is what can be compared where a "
           "perturbation grows. Penetration: the deepest at a sample, 0 where there is no object. A run whose "
           "positions, mean shape or energy are off by more than 100 % counts as failed, as one that blew up. "
           "verlet ×1 is the product; ×2 has twice the stable substeps; XPBD and the seed's relaxation are told "
           "as substeps × sweeps, by the substeps that a tick took: where bending or air needs more than were "
           "asked for, it takes these (the most of any tick), and settings that ran as another one are left "
           "out. The seed's relaxation has rigid springs. Where verlet has no dashpots it is as XPBD is, and takes fewer substeps. "
           "\"Best of\" counts the different settings that were run."]
    for scene in tables.unique(cell["scene"] for cell in cells):
        out += ["", f"## {SCENES[scene]}", "", about(references, scene), "",
                f"![Error against CPU time: {SCENES[scene]}](plots/{scene}.svg)", "",
                tables.references(references, spatial, scene), "",
                "The cheapest setting within 1 % in position, or the best one where none is:", "",
                tables.error_vectors(cells, scene)]
    out += ["", "## Kernels", "", tables.taken(kernels), "", tables.kernels(kernels), "",
            "The bytes of a particle are those of a scene without air and hands where nothing else is said: wind "
            "takes three numbers more for each particle, and the first shot of a sling as many; they are kept "
            "from then on.", "",
            "## What runs in real time", "",
            f"The largest square of particles whose swing ({conditions('swing')}) needs at most half of one core: with verlet, as "
            "scenes run it, the median of five runs of two ticks; with implicit the mean of the first second.", "", tables.real_time_sizes(kernels), "",
            "## Is the solver implicit called for?", "",
            "It is wanted as soon as verlet cannot hold a built-in scene, or cotton of 128 × 128 particles, in "
            "real time. All cases are compared for the same time and on one thread, hard cases too; what two "
            "threads take is beside it. Springs are springs, bending and integration, all that another "
            "solver could do cheaper; contact is all looking for contacts, certifying and solving them. \"With "
            "free springs\" is what the second would cost if these cost nothing. Contact is solved in "
            "substeps too: \"with free substeps\" is what would be left if nothing that is done each substep "
            "cost anything, from what the case costs with twice as many. \"With implicit\" is what it costs with "
            "that solver, in its own substeps, of which contact asks at least four a tick.", "",
            real_time_tables.need_of_implicit(real_time), "",
            "## What each part of the model costs", "",
            "Each built-in scene as it is and with one part switched off, over its first second or a "
            "part of it (the hard cases are left out); how "
            "far the particles end from where they were (rms).", "", tables.taken(parts), "", tables.parts(parts), "",
            "## Threads", "",
            "One thread against two, by wall time and by CPU time of the whole process. What runs in "
            "chunks is the search for contacts with objects and for pairs of cloth with cloth, the regions of "
            "many particles at once, where a cloth touches itself at some hundred places the sweeps over "
            "these, in slabs of space, and springs, bending, kick and drift of grids from 64² on, in bands of "
            "rows. These bands are not given wide halos, with which each could do several substeps alone: "
            "threads meet twice each substep. "
            f"{tables.bands(threads)} Air, meshes and the sweeps over contacts with objects are on one thread. Threads meet some "
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
            contact_tables.speed(contact[0]), "",
            "## Piles, hands and a model", "",
            "64 × 64 cotton, each tick the median of all runs, or each run of half a second. The sheet falls "
            "upright on the ground with drag 5/s and crumples there; nothing is put to sleep. The hand takes "
            "the pile at its rim and goes to and fro through its middle for a second, half a metre each way. "
            "A tick of 1/60 s is 16.7 ms. Crossings are counted exactly beside the timed ticks. "
            "`./dev report --contact` takes this section and the one before anew.", "",
            contact_tables.cases(contact[1]), "",
            "## Hard shaking", "",
            "Cloths of 1 m × 1 m that hang by one edge, in vacuum and without self-contact: every free particle is "
            "given a velocity of 20 m/s, its size, in a random direction; all free particles are put into a ball of "
            "1 mm; a pin is moved by 3 m for a tenth of a second and back. With drag 5/s, 5 s after the disturbance: "
            "rms distance from the solver's own rest, over 1 m; at most 1 % is wanted. Without drag, in 5 s "
            "after the disturbance and while the pin is away: what the energy rose above that of the start and the "
            "work of the disturbance, over these two less the energy of the rest; at most 1 % is wanted. The worst "
            "of all seeds. The rigidity of bending is chosen: B = 1e-5 m² times the stiffness of the structural "
            "springs, for which a flat sheet is the only rest. With a smaller one, as the test cloths of the "
            "other scenes have, a cloth that may pass through itself keeps tucks, which are equilibria too; "
            "their figures stand beside. Substeps are those that a tick takes.", "",
            tables.shaking(shaking), "",
            "## Cells with fewer settings", "",
            f"Wanted are {tables.WANTED_SETTINGS} different settings of each solver in each cell.", "",
            tables.few_settings(cells), "",
            "## Runs that failed", "", tables.without_figure(cells, "failed"), "",
            "## Cells that were not run", "", tables.without_figure(cells, "not run"), ""]
    return "\n".join(out)


def cost_in_readme(data):
    """What an error costs for cotton, and under which conditions this was measured."""
    everything = tables.read(data, "accuracy")
    cells = [cell for cell in everything if cell["scene"] == "swing" and cell["fabric"] == "cotton" and cell["n"] >= 64]
    references = [row for row in tables.read(data, "references") if row["fabric"] == "cotton"]
    machine = {row["key"]: row["value"] for row in tables.read(data, "machine")}
    free = [cell for cell in everything if cell["scene"] == "swing-free" and cell["fabric"] == "cotton"]
    drape = [cell for cell in everything if cell["scene"] == "drape" and cell["fabric"] == "cotton"]
    return (tables.cost_of_accuracy(cells) + "\n\n"
            "CPU seconds a simulated second of the cheapest setting of any solver within each error; a square metre of "
            f"cotton, N particles,\nis held by one edge and swings down from the level: {conditions('swing')}; "
            f"{spans(references, 'swing')}.\n"
            f"verlet ×1, what a scene runs, is off by {tables.default_errors(cells, 'swing')}; without drag by "
            f"{tables.default_errors(free, 'swing-free')}; draped on a sphere, until {drape_end(references)} s, by "
            f"{tables.default_errors(drape, 'drape')}.\nXPBD is named by substeps × sweeps, implicit by substeps × "
            f"iterations. One thread of {machine['processor']}, {machine['compiler']}, {machine['kernels']} kernels; "
            f"{tables.sizes_taken(cells)}")


def drape_end(references):
    """Until when positions of draped cotton are compared: later noise decides where folds fall."""
    ends = [row["positions_to_s"] for row in references
            if (row["scene"], row["fabric"]) == ("drape", "cotton") and not row["missing"]]
    return f"{max(ends):.2g}"


def readme_blocks(data):
    """The parts of the README that tell measured figures, by the names of their marks."""
    real_time = tables.read(data, "real_time")
    return {"cost of accuracy": cost_in_readme(data),
            "implicit": f"{real_time_tables.summary(real_time)} {tables.taken(real_time)}"}


def with_blocks(readme, data):
    """The README with those parts from the given data."""
    for name, text in readme_blocks(data).items():
        begin, end = f"<!-- report: {name} -->", "<!-- report: end -->"
        before, rest = readme.split(begin)
        readme = f"{before}{begin}\n{text}\n{end}{rest.split(end, 1)[1]}"
    return readme


def case_of(row):
    return row["scene"], row["fabric"], row["n"]


def take_in(measured, data):
    """Puts the tables of a run that was asked for a part alone among those of the whole report: cases that
    were measured take the places of theirs, every other table that of the old one. What the whole
    report says of the machine stays."""
    for new in sorted(measured.glob("*.csv")):
        old = data / new.name
        if new.stem == "machine":
            continue
        if new.stem not in CASES or not old.exists():
            shutil.copy(new, old)
            continue
        with open(old, encoding="utf-8", newline="") as file:
            kept = list(csv.DictReader(file))
        with open(new, encoding="utf-8", newline="") as file:
            reader = csv.DictReader(file)
            rows, columns = list(reader), reader.fieldnames
        replaced = {case_of(row) for row in rows}
        with open(old, "w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, columns, lineterminator="\n")
            writer.writeheader()
            writer.writerows([row for row in kept if case_of(row) not in replaced] + rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", type=Path, help="holds data/; gets plots/ and REPORT.md")
    parser.add_argument("--readme", type=Path, help="its tables are written anew")
    parser.add_argument("--measured", type=Path, help="tables of a part, to take into data/ first")
    options = parser.parse_args()
    data, pictures = options.directory / "data", options.directory / "plots"
    if options.measured:
        take_in(options.measured, data)
    pictures.mkdir(exist_ok=True)
    cells = tables.read(data, "accuracy")
    for scene in tables.unique(cell["scene"] for cell in cells):
        plots.plot_scene(cells, scene, pictures / f"{scene}.svg")
    (options.directory / "REPORT.md").write_text(report_text(data), encoding="utf-8")
    if options.readme:
        text = options.readme.read_text(encoding="utf-8")
        options.readme.write_text(with_blocks(text, data), encoding="utf-8")


if __name__ == "__main__":
    main()
