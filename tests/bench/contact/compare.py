#!/usr/bin/env python3
"""Times the contact of two versions on the same recorded states and hands, tick by tick.

    tests/bench/contact/compare.py --old c06d683 [--cases flag,hand] [--runs 5]

The old version is a commit: its core is built in a work tree of its own under build/contact/, and
the cases of this one are compiled against it. It also records the states. Both then run in turn,
on one thread, without a limit for a tick. Of each tick the median of all runs counts. The new
version is build/weft_contact_bench.

With --path, the new version alone: what two threads would take of one's time, by the critical path
(the busiest thread's time between barriers; see dealt_chunks.h), and how much more work there is.
"""

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
HERE = Path(__file__).resolve().parent
FLAGS = ["-std=c++20", "-O2", "-DNDEBUG", "-DEIGEN_DONT_VECTORIZE", "-DEIGEN_MPL2_ONLY",
         "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math"]
ALONE = "-alone"  # ends the name of a case without contact with itself


def run(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, text=True, **options)


def program_of(commit, scratch):
    """The cases, compiled against the core of a commit."""
    name = run("git", "rev-parse", "--short", commit, cwd=ROOT, capture_output=True).stdout.strip()
    tree, build, program = (scratch / f"{name}{end}" for end in ("", "-build", "-bench"))
    if not tree.exists():
        run("git", "worktree", "add", "--detach", tree, commit, cwd=ROOT)
        # An old commit configures its page too, with packages that no work tree has by itself.
        (tree / "web/node_modules").symlink_to(ROOT / "web/node_modules")
    if not (build / "core/libweft_core.a").exists():
        run("cmake", "-S", tree, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
            "-DWEFT_TESTS=OFF", stdout=subprocess.DEVNULL)
        run("ninja", "-C", build, "weft_core", stdout=subprocess.DEVNULL)
    run(os.environ.get("CXX", "c++"), *FLAGS, f"-I{tree}", f"-I{ROOT}", "-isystem",
        "/usr/include/eigen3", HERE / "cases.cpp", HERE / "main.cpp",
        build / "core/libweft_core.a", "-lhwy", "-lassimp", "-o", program)
    return program


def median(values):
    values = sorted(values)
    middle = len(values) // 2
    return values[middle] if len(values) % 2 else (values[middle - 1] + values[middle]) / 2


def figures(runs):
    """Mean, p50, p99 and worst of the ticks [ms], each the median of all runs."""
    ticks = sorted(median(same) for same in zip(*(one["milliseconds"] for one in runs), strict=True))
    return {"mean": sum(ticks) / len(ticks), "p50": ticks[len(ticks) // 2],
            "p99": ticks[int(0.99 * (len(ticks) - 1))], "worst": ticks[-1]}


def truncated(one):
    """Part of the motion that was wanted near others and not allowed."""
    return one["truncated"] / one["wanted"] if one["wanted"] > 0 else 0.0


def measure(programs, case, states, runs):
    """Runs of each program, in turn; the first of each counts crossings too."""
    run(programs[0], "record", case, states)
    found = [[], []]
    for number in range(runs):
        for kind, program in enumerate(programs):
            verb = "count" if number == 0 else "time"
            text = run(program, verb, case, states, capture_output=True).stdout
            found[kind].append(json.loads(text))
    return found


def line(case, found):
    """A row of the table."""
    old, new = map(figures, found)
    cells = [case]
    for key in ("mean", "p50", "p99", "worst"):
        cells.append(f"{new[key]:.2f} / {old[key]:.2f} = **{new[key] / old[key]:.2f}**")
    cells.append(" / ".join(str(runs[0]["crossings"]) for runs in reversed(found)))
    cells.append(" / ".join(f"{truncated(runs[0]):.1e}" for runs in reversed(found)))
    return "| " + " | ".join(cells) + " |"


def over(case, means):
    """What contact with itself takes beside the same run without it."""
    one, alone = means[case], means[case + ALONE]
    return (f"{case}: contact with itself takes {100 * (one[1] / alone[1] - 1):.0f} % more, "
            f"before {100 * (one[0] / alone[0] - 1):.0f} %")


def paths(program, case, states, runs):
    """A row: the critical path of two threads and the work of both, over the time of one."""
    ones, twos = [], []
    for _ in range(runs):
        for verb, found in (("time", ones), ("path", twos)):
            text = run(program, verb, case, states, capture_output=True).stdout
            found.append(json.loads(text))
    def sums(key, of):
        return sum(median(same) for same in zip(*(one[key] for one in of), strict=True))
    one, work, path = sums("milliseconds", ones), sums("milliseconds", twos), sums("path", twos)
    return f"| {case} | {path / one:.2f} | {work / one:.2f} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--old", help="a commit, or a program made for one")
    parser.add_argument("--path", action="store_true", help="what two threads would take")
    parser.add_argument("--new", default=str(ROOT / "build/weft_contact_bench"), help="a program")
    parser.add_argument("--cases", help="names, separated by commas; default: all")
    parser.add_argument("--runs", type=int, default=5, help="of each version (5)")
    parser.add_argument("--scratch", default=str(ROOT / "build/contact"), help="for what is made")
    options = parser.parse_args()
    scratch = Path(options.scratch)
    scratch.mkdir(parents=True, exist_ok=True)
    if not options.old and not options.path:
        parser.error("--old or --path is needed")
    if options.path:
        print("critical path of two threads, and their work, over the time of one\n")
        print("| case | path | work |\n|---|---|---|")
        for case in (options.cases or "pile,form,sphere").split(","):
            states = scratch / f"{case}.states"
            run(options.new, "record", case, states)
            print(paths(options.new, case, states, options.runs), flush=True)
        return
    old = options.old if Path(options.old).is_file() else program_of(options.old, scratch)
    programs = old, options.new
    known = [row.split("\t")[0] for row in
             run(options.new, "list", capture_output=True).stdout.splitlines()]
    wanted = options.cases.split(",") if options.cases else known
    for case in wanted:
        if case not in known:
            sys.exit(f"there is no case {case}; there are {', '.join(known)}")
    print("CPU milliseconds of a tick, new / old = ratio; crossings and truncated motion likewise\n")
    print("| case | mean | p50 | p99 | worst | crossings | truncated |\n" + "|---" * 7 + "|")
    means = {}
    for case in wanted:
        found = measure(programs, case, scratch / f"{case}.states", options.runs)
        means[case] = [figures(runs)["mean"] for runs in found]
        print(line(case, found), flush=True)
    print()
    for case in wanted:
        if case + ALONE in means:
            print(over(case, means))


if __name__ == "__main__":
    main()
