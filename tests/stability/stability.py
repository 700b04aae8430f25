#!/usr/bin/python3
"""Runs the hard cases and writes README.md of this folder.

Usage: WEFT_PROGRAM=build/weft stability.py [--ticks N] [--write]
"""

import argparse
import concurrent.futures
import json
import os
import subprocess
from pathlib import Path

HERE = Path(__file__).resolve().parent
TICKS = 600
HEAD = """# Hard cases

Each is a scene by name (`weft simulate --scene NAME`, or on the page) that says itself what it must keep
to, under `verdict` in its file. Counted are edges that pass through triangles, of the cloths with themselves
and each other and with boxes and meshes, exactly and at each of {ticks} ticks, of 1/60 s where the name
tells no other; how deep the cloth is inside an object; the smallest gap of any contact; the largest strain; which part of the wanted
motion the guard took; how much more energy there was at any time than at the start and by work and insults,
as a part of all energy at play (1 % is allowed); and, where a cloth has one rest to come back to, how far it
is off 5 s later (1 % of its extent is allowed), or by how much its mean height is. Milliseconds a tick are CPU time on one thread of {machine}, the mean of the run.
Written by `tests/stability/stability.py --write`.

| case | particles | verdict | crossings | inside [mm] | smallest gap [mm] | strain | lost motion | energy excess | off its rest | ms a tick |
|---|---|---|---|---|---|---|---|---|---|---|
"""
TAIL = """
What is allowed, by case: {allowed}.

What failed: {failed}

Not among the cases: degenerate rest shapes (no area, no length, coincident particles), which are refused
when a scene is loaded (`tests/core/cloth/mesh_cloth_test.cpp`); a hand of 1e5 N/m that jumps by metres in a
tenth of a second, under which a tick takes a sixth of a second; a reef knot; an hour's soak.
"""


def program():
    return os.environ["WEFT_PROGRAM"]


def output(*arguments):
    result = subprocess.run(
        [program(), *arguments], capture_output=True, text=True, timeout=3000, check=True
    )
    return json.loads(result.stdout)


def cases():
    names = [scene["name"] for scene in output("scenes", "--json")["scenes"]]
    return [name for name in names if name.startswith("hard-")]


def run(name, ticks):
    """What `weft simulate` tells of a case."""
    return output("simulate", "--scene", name, "--ticks", str(ticks), "--json")


def machine():
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.partition(":")[2].strip()
    return "an unnamed machine"


def off_rest(verdict):
    if verdict["allowed"]["heights"] > 0 and verdict["height_error"] is not None:
        return f"{verdict['height_error'] * 1000:.2g} mm high"
    return "–" if verdict["rest_error"] is None else f"{verdict['rest_error'] * 100:.2g} %"


def row(name, result):
    verdict = result["verdict"]
    gap = verdict["smallest_gap"]
    cells = [
        name,
        result["particles"],
        "passes" if verdict["passed"] else "**fails**",
        verdict["crossings"],
        f"{verdict['deepest_penetration'] * 1000:.3g}",
        "–" if gap is None else f"{gap * 1000:.3g}",
        f"{verdict['largest_strain']:.3g}",
        f"{verdict['lost_motion'] * 100:.2g} %",
        f"{verdict['energy_excess'] * 100:.2g} %",
        off_rest(verdict),
        f"{result['cpu_seconds'] / result['ticks'] * 1000:.2g}",
    ]
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def allowed_text(name, verdict):
    allowed = verdict["allowed"]
    text = f"{name} strain {allowed['strain']:g}, lost motion {allowed['lost_motion'] * 100:g} %"
    if allowed["clear_after"] > 0:
        text += f", clear after {allowed['clear_after']:g} s"
    if allowed["heights"] > 0:
        text += f", mean heights off by {allowed['heights'] * 1000:g} mm"
    if allowed["hands_lag"] > 0:
        text += f", hands {allowed['hands_lag'] * 1000:g} mm behind"
    return text


def report(results, ticks):
    rows = "\n".join(row(name, result) for name, result in results.items())
    allowed = "; ".join(allowed_text(name, result["verdict"]) for name, result in results.items())
    failed = [
        f"- {name}: " + "; ".join(result["verdict"]["failures"])
        for name, result in results.items()
        if not result["verdict"]["passed"]
    ]
    told = "\n\n" + "\n".join(failed) if failed else "nothing."
    head = HEAD.format(ticks=ticks, machine=machine())
    return head + rows + "\n" + TAIL.format(allowed=allowed, failed=told)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ticks", type=int, default=TICKS)
    parser.add_argument("--jobs", type=int, default=1, help="cases at the same time")
    parser.add_argument("--write", action="store_true", help="write README.md")
    options = parser.parse_args()
    results = {}
    names = cases()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        runs = pool.map(lambda name: run(name, options.ticks), names)
        for name, result in zip(names, runs):
            results[name] = result
            print(row(name, result), flush=True)
    if options.write:
        (HERE / "README.md").write_text(report(results, options.ticks), encoding="utf-8")


if __name__ == "__main__":
    main()
