#!/usr/bin/python3
"""Many viewers of one server: which share of the frames reaches them, how old, and at what cost.

    ./dev build && /usr/bin/python3 tests/bench/load/measure.py [--build build] [--viewers 200 1000]
                                     [--seconds 10] [--runs 3] [--side 128] [--link]

The viewers live in one process of their own (weft_load) and acknowledge each frame without decoding it;
the server simulates meanwhile. Each row is the best of the runs by the age that 99 of 100 frames keep to.
Then 20 of 100 viewers stop reading, beside 80 that go on alone. --link has one viewer more, behind a link with 60 %
of the bandwidth that its frames need: two network namespaces and a token bucket, which needs root; it is
skipped with a message where these are not allowed. The page that explains the terms is proto/README.md,
section 8.
"""

import argparse
import contextlib
import json
import os
import subprocess
import sys
from pathlib import Path

TICK_MS = 1000 / 60
NAMES = ("weft-load-a", "weft-load-b")
ADDRESSES = ("10.213.77.1", "10.213.77.2")
NEEDED_SHARE = 0.6
MTU = 1500


class Server:
    """A server of a waving curtain, side x side particles at 60 Hz."""

    def __init__(self, build, side, seconds, prefix=(), options=()):
        cloth = [f"cloths[0].{name}={side}" for name in ("rows", "columns")]
        settings = [*cloth, "contact.self=none", "environment.gust_speed=1"]
        self.process = subprocess.Popen(
            [*prefix, build / "weft", "serve", "--port", "0", "--scene", "curtain", "--threads", "1",
             "--count-crossings", "0", "--max-viewers", "2000", "--max-connections", "4000",
             "--max-connections-per-address", "4000", "--max-seconds", str(seconds), "--log-level", "error",
             *options, *(word for setting in settings for word in ("--set", setting))],
            stdout=subprocess.PIPE, text=True)
        self.addresses = json.loads(self.process.stdout.readline())
        self.port = int(self.addresses["port"])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait(10)

    def cpu(self):
        """CPU time of each thread [s], by number of the thread."""
        times = {}
        folder = Path(f"/proc/{self.process.pid}/task")
        for task in folder.iterdir():
            with contextlib.suppress(OSError):
                fields = (task / "stat").read_text().rsplit(")", 1)[1].split()
                times[task.name] = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
        return times

    def memory(self):
        """Resident memory [KiB]."""
        for line in Path(f"/proc/{self.process.pid}/status").read_text().splitlines():
            if line.startswith("VmRSS"):
                return int(line.split()[1])
        return 0


def load(build, port, seconds, viewers, stalled=0, prefix=(), address="127.0.0.1", codec="packed"):
    done = subprocess.run(
        [*prefix, build / "weft_load", "--address", address, "--port", str(port), "--viewers", str(viewers),
         "--stalled", str(stalled), "--seconds", str(seconds), "--codec", codec],
        stdout=subprocess.PIPE, text=True, timeout=seconds + 120)
    if done.returncode != 0:
        raise SystemExit(f"weft_load ended with {done.returncode}")
    return json.loads(done.stdout)


def measured(build, side, seconds, viewers, stalled=0):
    """One run: a server of its own, so that memory can be told by viewer."""
    with Server(build, side, int(seconds) + 150) as server:
        load(build, server.port, 0.5, 1)
        memory, before = server.memory(), server.cpu()
        client = subprocess.Popen(
            [build / "weft_load", "--port", str(server.port), "--viewers", str(viewers), "--stalled",
             str(stalled), "--seconds", str(seconds)], stdout=subprocess.PIPE, text=True)
        largest = memory
        while client.poll() is None:
            largest = max(largest, server.memory())
            with contextlib.suppress(subprocess.TimeoutExpired):
                client.wait(0.2)
        row = json.loads(client.stdout.read() or "{}")
        if client.returncode != 0 or not row:
            raise SystemExit(f"weft_load ended with {client.returncode}")
        after = server.cpu()
    # The busiest thread beside the room's is the network's: the first one of the process.
    main = str(server.process.pid)
    row["cpu_us_a_frame"] = 1e6 * (after.get(main, 0) - before.get(main, 0)) / max(1, row["frames"])
    row["kib_a_viewer"] = (largest - memory) / viewers
    return row


def show(title, row):
    print(f"{title:42} {row['delivered']:9.4f} {row['delivered_to_worst']:9.4f} {row['age_p50_ms']:8.2f} "
          f"{row['age_p99_ms']:8.2f} {row['bytes_a_frame']:9.0f} {row.get('cpu_us_a_frame', float('nan')):8.1f} "
          f"{row.get('kib_a_viewer', float('nan')):8.1f}", flush=True)


def best(rows):
    return min(rows, key=lambda row: (row["delivered"] < 0.95, row["age_p99_ms"]))


def run(*words, check=True):
    return subprocess.run(words, check=check, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


@contextlib.contextmanager
def link(bits_a_second):
    """Two namespaces joined by a link of this rate; yields the words that run a command in each."""
    inside = [("ip", "netns", "exec", name) for name in NAMES]
    try:
        for name in NAMES:
            run("ip", "netns", "add", name)
        run("ip", "link", "add", "weft-a", "netns", NAMES[0], "type", "veth", "peer", "name", "weft-b",
            "netns", NAMES[1])
        for (name, address, device, words) in zip(NAMES, ADDRESSES, ("weft-a", "weft-b"), inside):
            run(*words, "ip", "address", "add", f"{address}/24", "dev", device)
            run(*words, "ip", "link", "set", device, "mtu", str(MTU), "up")
            run(*words, "ip", "link", "set", "lo", "up")
            run(*words, "ethtool", "-K", device, "tso", "off", "gso", "off", "gro", "off", check=False)
        run(*inside[0], "tc", "qdisc", "add", "dev", "weft-a", "root", "tbf", "rate", f"{int(bits_a_second)}bit",
            "burst", str(4 * MTU), "limit", "1000000")
        yield inside
    finally:
        for name in NAMES:
            run("ip", "netns", "del", name, check=False)


def slow_link(build, side, seconds, needed):
    rate = NEEDED_SHARE * needed
    try:
        with link(rate) as (at_server, at_viewer):
            options = ("--bind", ADDRESSES[0], "--open")
            with Server(build, side, int(seconds) + 60, at_server, options) as server:
                row = load(build, server.port, seconds, 1, prefix=at_viewer, address=ADDRESSES[0])
            show(f"1 viewer, {rate / 1e6:.2f} of {needed / 1e6:.2f} Mbit/s", row)
    except (OSError, subprocess.CalledProcessError) as error:
        print(f"the slow link was not measured: {getattr(error, 'stderr', '') or error}".strip())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=Path(__file__).resolve().parents[3] / "build")
    parser.add_argument("--viewers", type=int, nargs="*", default=[200, 1000])
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--side", type=int, default=128)
    parser.add_argument("--link", action="store_true", help="a slow link too; needs root")
    o = parser.parse_args()
    print(f"{'':42} {'delivered':>9} {'to worst':>9} {'p50 ms':>8} {'p99 ms':>8} {'bytes':>9} {'us/frame':>8} "
          f"{'KiB each':>8}")
    for viewers in o.viewers:
        rows = [measured(o.build, o.side, o.seconds, viewers) for _ in range(o.runs)]
        show(f"{viewers} viewers", best(rows))
    if o.viewers:
        alone = best([measured(o.build, o.side, o.seconds, 80) for _ in range(o.runs)])
        show("80 viewers alone", alone)
        beside = best([measured(o.build, o.side, o.seconds, 100, 20) for _ in range(o.runs)])
        show("80 viewers beside 20 that stopped to read", beside)
        print(f"p99 changes by {100 * (beside['age_p99_ms'] / alone['age_p99_ms'] - 1):+.0f} %")
    if o.link:
        with Server(o.build, o.side, 60) as server:
            free = load(o.build, server.port, o.seconds, 1)
        show("1 viewer", free)
        slow_link(o.build, o.side, o.seconds, 8 * 60 * free["bytes_a_frame"])
    return 0


if __name__ == "__main__":
    sys.exit(main())
