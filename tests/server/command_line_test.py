"""The command line: what is wrong is named in one line with exit code 2; what is right does what it says."""

import json
import os
import socket
import subprocess
import tempfile
import unittest

from foreign_client import PROGRAM, main


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=240)


class CommandLine(unittest.TestCase):
    def test_what_is_wrong_is_named_in_one_line_with_exit_code_2(self):
        table = [
            ([], "no command; allowed: serve, simulate"),
            (["fly"], "unknown command fly; allowed: serve, simulate"),
            (["--fly"], "unknown option --fly"),
            (["serve", "--prot", "3"], "--prot"),
            (["serve", "extra"], "unknown option extra; allowed: --help, --bind"),
            (["serve", "--port"], "--port has no value; allowed: Port"),
            (["serve", "--port", "1", "--port", "2"], "--port is given twice; allowed: once"),
            (["simulate", "--out", "a.obj", "--out", "b.obj"], "--out is given twice; allowed: once"),
            (["serve", "--paused=maybe"], "--paused takes no value"),
            (["serve", "--port", ""], "--port = (nothing): allowed is a whole number from 0 to 65535"),
            (["serve", "--port", "x"], "--port = x: allowed is a whole number from 0 to 65535"),
            (["serve", "--port", "1.5"], "--port = 1.5: allowed is a whole number"),
            (["serve", "--port", "99999999999"], "0 to 65535"),
            (["serve", "--port", "70000"], "0 to 65535"),
            (["serve", "--port", "-1"], "0 to 65535"),
            (["serve", "--rate", "0"], "--rate = 0: allowed is a number from 1 to 1000"),
            (["serve", "--rate", "0.1"], "1 to 1000"),
            (["serve", "--rate", "nan"], "1 to 1000"),
            (["serve", "--rate", "sixty"], "--rate = sixty: allowed is a number from 1 to 1000"),
            (["serve", "--max-seconds", "1e400"], "0 to 10000000"),
            (["serve", "--max-viewers", "0"], "1 to 10000"),
            (["serve", "--pong-seconds", "0"], "0.1 to 3600"),
            (["serve", "--web", "/nowhere"], "--web = /nowhere: allowed is a directory"),
            (["serve", "--allow-origin", "localhost"], "--allow-origin = localhost: allowed is an origin"),
            (["serve", "--allow-origin", "http://a/b"], "http://localhost:3000"),
            # an address kept for documentation, which no machine has
            (["serve", "--bind", "192.0.2.1", "--open", "--port", "0"], "--bind = 192.0.2.1: allowed is"),
            (["serve", "--bind", "0.0.0.0"], "--open"),
            (["serve", "--bind", "here"], "address"),
            (["serve", "--scene", "nowhere"], "drape-sphere"),
            (["serve", "--log-level", "loud"], "warning"),
            (["serve", "--set", "wind"], "key=value"),
            (["serve", "--port", "0", "--set", "environment.wnd=1,0,0"], "environment.wind"),
            (["simulate", "--scene", "../default"], "default"),
            (["simulate", "--scene", ""], "scene = (nothing): allowed is one of default"),
            (["simulate", "--scene", "two\nlines"], "scene = two?lines"),
            (["simulate", "--ticks", "1e3"], "--ticks = 1e3: allowed is a whole number"),
            (["simulate", "--json=3"], "--json takes no value"),
            (["simulate", "-x"], "unknown option -x"),
            (["fabric", "--decay-time", "1"], "--mode = (nothing): allowed is the mode that was measured"),
            (["fabric", "--mode", "twist"], "stretch, shear or bending"),
            # (1.8751 / 8 cm)^2 sqrt(9.81 (19 mm)^3) = 4.507/s; a strip of 100 m swings too slowly.
            (["fabric", "--set", "fabric=wool", "--mode", "bending", "--length", "0.08", "--decay-time", "0.12"],
             "--decay-time = 0.12: allowed is at least 0.222 s, that of critical damping"),
            (["fabric", "--set", "fabric=wool", "--mode", "bending", "--length", "100", "--loss-factor", "0.5"],
             "allowed is 0 to 10 s"),
            (["fabric", "--mode", "stretch", "--loss-factor", "10.5"],
             "--loss-factor = 10.5: allowed is a number from 0 to 10"),
            (["fabric", "--form", "net"], "grid or mesh"),
            (["fabric", "--form", "grid", "--set", "fabric.poisson=0.3"], "mesh for a fabric with a poisson"),
            # Diagonals with 100 N/m of the 400 along a thread give it 10 ms of their 40.
            (["fabric", "--mode", "stretch", "--loss-factor", "0", "--set", "fabric.shear=100", "--set", "cloth.rows=30",
              "--set", "cloth.height=1.2", "--set", "cloth.width=1.2", "--set", "fabric.shear_damping=0.04"],
             "--loss-factor = 0: allowed is at least"),
            (["fabric", "--length", "0"], "--length = 0: allowed is a number from 0.001 to 100"),
            (["simulate", "--out", "/nowhere/cloth.obj"], "--out = /nowhere/cloth.obj: allowed is"),
            (["simulate", "--set", "=3"], "key=value"),
            (["simulate", "--set", "fabric.shear="], "fabric.shear = (nothing)"),
            (["simulate", "--set", "environment.wind=1,2"], "three numbers"),
            (["simulate", "--set", "environment.still_air=2"], "true or false"),
            (["simulate", "--set", "tick_rate=0"], "1 to 1000"),
            (["simulate", "--ticks", "0"], "1 to 10000000"),
            (["simulate", "--threads", "65"], "1 to 64"),
            (["simulate", "--check-every", "0"], "1 to 10000000"),
            (["serve", "--count-crossings", "-1"], "0 to 1000000"),
            (["serve", "--count-crossings", "1000001"], "0 to 1000000"),
            (["serve", "--count-crossings", "1.5"], "--count-crossings"),
            (["serve", "--count-crossings", "nan"], "--count-crossings"),
            (["serve", "--count-crossings", ""], "--count-crossings"),
            (["serve", "--count-crossings"], "--count-crossings has no value"),
            (["simulate", "--set", "fabric.shear=1e9"], "0 to 1e+06"),
            (["simulate", "--set", "fabric.shear=nan"], "fabric.shear"),
            (["simulate", "--set", "cloth.rows=2.5"], "cloth.rows"),
            (["simulate", "--set", "nothing=1"], "nothing"),
            (["simulate", "--out", "cloth.stl"], ".obj or .ply"),
            (["simulate", "--out", ""], "--out = (nothing): allowed is a file that ends in .obj or .ply"),
            (["simulate", "--series", ""], "--series = (nothing): allowed is a file that ends in .npy"),
            (["simulate", "--start", ""], "--start = (nothing): allowed is a .npy file"),
            (["serve", "--tokens", ""], "--tokens = (nothing): allowed is a file with one line for each token"),
            (["scenes", "--xml"], "--xml"),
        ]
        for arguments, named in table:
            with self.subTest(arguments=arguments):
                result = run(*arguments)
                self.assertEqual(result.returncode, 2, result)
                self.assertEqual(result.stdout, "")
                self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
                self.assertIn(named, result.stderr)

    def test_a_port_that_is_taken_is_named(self):
        with socket.create_server(("127.0.0.1", 0)) as taken:
            port = str(taken.getsockname()[1])
            result = run("serve", "--port", port)
        self.assertEqual(result.returncode, 2)
        self.assertEqual(result.stdout, "")
        self.assertIn(f"--port = {port}: allowed is a port that is free", result.stderr)

    def test_help_and_version_succeed(self):
        self.assertIn("Examples:", run("--help").stdout)
        self.assertIn("--port", run("serve", "--help").stdout)
        version = run("--version")
        self.assertEqual(version.returncode, 0)
        self.assertRegex(version.stdout, r"^weft \d+\.\d+\.\d+ \(commit \w+, (GNU|Clang) .+, \w+.*\)\n$")

    def test_scenes_are_listed_for_people_and_programs(self):
        scenes = json.loads(run("scenes", "--json").stdout)["scenes"]
        self.assertEqual(scenes[0]["name"], "default")
        lines = run("scenes").stdout.splitlines()
        self.assertEqual([line.split()[0] for line in lines], [s["name"] for s in scenes])

    def test_simulate_sums_up_as_json(self):
        result = json.loads(run("simulate", "--ticks", "30", "--json").stdout)
        self.assertEqual((result["particles"], result["triangles"], result["ticks"]), (600, 1102, 30))
        self.assertAlmostEqual(result["simulated_seconds"], 0.5)
        for key in ("cpu_seconds", "wall_seconds", "real_time_factor", "tick_milliseconds", "stages",
                    "energy", "strain", "deepest_penetration", "hash", "solver", "substeps", "divergences"):
            self.assertIn(key, result)
        self.assertGreater(result["stages"]["stretch"]["work"], 0)

    def test_a_balance_is_told_on_request_adds_up_and_changes_no_bit(self):
        arguments = ("simulate", "--scene", "flag", "--ticks", "20", "--json")
        plain = json.loads(run(*arguments).stdout)
        self.assertEqual(plain["balance"], "not measured")
        told = json.loads(run(*arguments, "--balance").stdout)
        self.assertEqual(told["hash"], plain["hash"])
        balance = told["balance"]
        self.assertAlmostEqual(balance["now"], told["energy"]["total"], places=9)
        self.assertAlmostEqual(balance["start"] + sum(balance["work"].values()) - sum(balance["losses"].values()),
                               balance["now"], places=9)
        self.assertGreater(balance["work"]["wind"], 0)
        self.assertGreater(balance["losses"]["air"], 0)
        self.assertEqual(balance["work"]["hands"], 0)
        self.assertAlmostEqual(balance["losses"]["drag"], 0, delta=1e-6)  # but for rounding
        # What no cause explains is the solver's error, which is small beside the work of the wind.
        self.assertLess(abs(balance["losses"]["solver"]), 0.02 * balance["work"]["wind"])

    def test_a_measured_decay_is_converted_to_the_relaxation_time_that_has_it(self):
        strip = ("fabric", "--set", "fabric=wool", "--mode", "bending", "--length", "0.05", "--json")
        found = json.loads(run(*strip, "--decay-time", "0.5").stdout)["modes"][0]
        # (1.8751 / 5 cm)^2 sqrt(sigma g c^3 / sigma) with c = 19 mm
        omega = (1.8751040687 / 0.05) ** 2 * (9.81 * 0.019**3) ** 0.5
        self.assertAlmostEqual(found["frequency_hz"], omega / (2 * 3.14159265), delta=1e-4)
        self.assertAlmostEqual(found["relaxation_time_s"], 2 / (omega**2 * 0.5), delta=1e-5)
        back = ("--set", f"fabric.bending_damping={found['relaxation_time_s']!r}")
        again = json.loads(run(*strip, *back).stdout)["modes"][0]
        self.assertAlmostEqual(again["decay_time_s"], 0.5, delta=1e-6)
        loss = json.loads(run(*strip, "--loss-factor", repr(again["loss_factor"])).stdout)["modes"][0]
        self.assertAlmostEqual(loss["relaxation_time_s"], found["relaxation_time_s"], delta=1e-8)
        self.assertIn("fabric.bending_damping=0\n", run("fabric").stdout)

    def test_a_decay_that_a_strip_has_is_told_and_its_setting_is_accepted_and_gives_it(self):
        def told(*arguments):
            return json.loads(run("fabric", "--json", *arguments).stdout)["modes"][0]

        strip = ("--set", "fabric=wool", "--mode", "bending", "--length", "0.08")
        omega = (1.8751040687 / 0.08) ** 2 * (9.81 * 0.019**3) ** 0.5
        # Above a loss factor of 2 it creeps, as the slower root of its oscillator.
        slow = told(*strip, "--loss-factor", "4")
        self.assertTrue(slow["creeps"])
        self.assertAlmostEqual(slow["decay_time_s"], (2 + 3**0.5) / omega, delta=1e-5)
        self.assertIn("creeps", run("fabric", *strip, "--loss-factor", "4").stdout)
        self.assertFalse(told(*strip, "--decay-time", "0.3")["creeps"])
        undamped = told("--mode", "stretch", "--loss-factor", "0")
        self.assertEqual((undamped["setting"], undamped["decay_time_s"]), ({"fabric.stretch_damping": 0}, None))
        # A grid's diagonals damp its stretch by the time of shear: (tau Y (1 + n^2) - 2 n G tau_shear) / E.
        # The cells are square, so that 20 N/m of the 100 along each thread are the diagonals'.
        fabric = [part for key in ("fabric.stretch_warp=100", "fabric.stretch_weft=100", "fabric.shear=20",
                                   "fabric.stretch_damping=0.004", "fabric.shear_damping=0.01", "cloth.rows=30")
                  for part in ("--set", key)]
        self.assertAlmostEqual(told("--mode", "stretch", *fabric)["relaxation_time_s"], 0.0035, delta=1e-9)
        mesh = told("--mode", "stretch", "--form", "mesh", *fabric)
        self.assertAlmostEqual(mesh["relaxation_time_s"], 0.004, delta=1e-9)
        wanted = told("--mode", "stretch", *fabric, "--decay-time", "0.005")
        again = told("--mode", "stretch", *fabric,
                     "--set", f"fabric.stretch_damping={wanted['setting']['fabric.stretch_damping']!r}")
        self.assertAlmostEqual(again["decay_time_s"], 0.005, delta=1e-9)

    def test_a_drape_is_told_of_each_specimen_and_of_all_with_its_error(self):
        told = json.loads(run("drape", "--fabric", "denim", "--starts", "2", "--seconds", "0.1", "--threads", "2",
                              "--json").stdout)
        self.assertEqual((told["fabric"], told["published_percent"]), ("denim", [70, 90]))
        specimens = told["specimens"]
        self.assertEqual([s["runs"] for s in specimens], [2, 2, 2, 2])
        means = [s["coefficient_percent"]["mean"] for s in specimens]
        self.assertAlmostEqual(told["all"]["coefficient_percent"]["mean"], sum(means) / 4, delta=1e-9)
        for s in (*specimens, told["all"]):
            # No shadow is larger than the flat specimen's, and none smaller than the disc's.
            self.assertTrue(0 < s["least_percent"] <= s["coefficient_percent"]["mean"] <= s["most_percent"] < 100)
        for s in specimens:  # of two runs: half their distance
            self.assertAlmostEqual(s["coefficient_percent"]["standard_error"],
                                   (s["most_percent"] - s["least_percent"]) / 2, delta=1e-9)
        for wrong in (("--fabric", "tin"), ("--starts", "1"), ("--set", "cloth.rows=9")):
            refused = run("drape", *wrong)
            self.assertEqual(refused.returncode, 2)
            self.assertIn(wrong[1].split("=")[0], refused.stderr)

    def test_errors_of_a_run_are_told_on_request_and_change_no_bit_of_it(self):
        # So many that the difference of the energies is far above the rounding of their floats.
        arguments = ("simulate", "--scene", "cantilever-test", "--ticks", "12")
        plain = json.loads(run(*arguments, "--json").stdout)
        self.assertEqual(plain["error"], "not measured")
        asked = run(*arguments, "--json", "--error")
        self.assertRegex(asked.stderr, r"--error repeats the run: about [1-9][0-9.]+ times its cost besides")
        told = json.loads(asked.stdout)
        self.assertEqual(told["hash"], plain["hash"])
        positions = told["error"]["time"]["positions"]
        self.assertEqual((positions["unit"], positions["until"]), ("m", 0.2))
        self.assertIn(f"time: positions {positions['error']:.2g} m until 0.2 s", told["error"]["summary"])
        rows = (("--set", "cloth.rows=21"), ("--set", "cloth.columns=67"))
        finer = json.loads(run(*arguments, "--json", *rows[0], *rows[1]).stdout)
        # At least the difference at the end; that of the runs in float is off by their rounding.
        self.assertGreater(1.2 * told["error"]["space"]["energy"]["error"],
                           abs(finer["energy"]["total"] - told["energy"]["total"]))
        self.assertGreater(told["error"]["space"]["energy"]["error"], 0)
        self.assertRegex(run(*arguments, "--error").stdout, r"(?m)^error\.summary +time: positions ")

    def test_the_cantilever_test_measures_the_bending_length_of_its_fabric(self):
        result = json.loads(run("simulate", "--scene", "cantilever-test", "--set", "fabric=denim",
                                "--ticks", "180", "--json").stdout)
        self.assertAlmostEqual(result["measurements"]["bending_length_m"], 0.0267, delta=0.0003)
        self.assertIn("measurements.bending_length_m",
                      run("simulate", "--scene", "cantilever-test", "--ticks", "1").stdout)
        plain = json.loads(run("simulate", "--ticks", "1", "--json").stdout)
        self.assertEqual(plain["measurements"], {})

    def test_ten_seconds_of_the_default_scene_keep_out_of_ground_and_model(self):
        result = json.loads(run("simulate", "--scene", "default", "--ticks", "600", "--json").stdout)
        self.assertLessEqual(result["deepest_penetration"], 0.004)  # the thickness
        self.assertEqual(result["crossings"], {"cloth_with_cloth": 0, "cloth_with_object": 0,
                                               "ticks_looked_at": 600, "ticks_with_any": 0, "first_tick": None,
                                               "while_led_out": 0})
        self.assertEqual(result["divergences"], 0)
        self.assertGreater(result["stages"]["contact"]["work"], 0)  # it was blown against the model
        self.assertGreater(result["strain"]["largest"], result["strain"]["p99"])
        self.assertGreater(result["strain"]["p99"], 0)
        self.assertEqual(set(result["tick_milliseconds"]), {"median", "p95"})
        energy = result["energy"]
        self.assertAlmostEqual(sum(v for k, v in energy.items() if k != "total"), energy["total"], places=9)

    def test_crossings_of_cloth_and_objects_are_counted_each_tick_and_end_with_exit_code_3(self):
        # A fold that starts through itself takes longer to be led out; a slanting cloth starts through a wall.
        fold = ("simulate", "--scene", "hard-start-fold", "--set", "verdict.strain=0", "--ticks", "6", "--json")
        wall = ("simulate", "--scene", "wall", "--set", "cloth.v=0,-1,-1", "--ticks", "6", "--json")
        for command, kind, other in ((fold, "cloth_with_cloth", "cloth_with_object"),
                                     (wall, "cloth_with_object", "cloth_with_cloth")):
            for every, looked_at in (("1", 6), ("4", 2), ("1000", 1)):
                late = run(*command, "--set", "verdict.clear_after=0", "--check-every", every)
                told = json.loads(late.stdout)["crossings"]
                self.assertEqual(late.returncode, 3)
                self.assertEqual(told["ticks_looked_at"], looked_at)
                self.assertEqual(told["ticks_with_any"], looked_at)
                self.assertGreaterEqual(told[kind], looked_at)
                self.assertEqual(told[other], 0)
                self.assertEqual(told["first_tick"], min(int(every), 6))
                self.assertRegex(late.stderr, f"^weft: .* in {looked_at} of {looked_at} ticks, from tick "
                                              f"{told['first_tick']} on\n$")
            early = run(*command, "--set", "verdict.clear_after=1")
            self.assertEqual(early.returncode, 0)
            self.assertIn("none after the scene's grace time", early.stderr)
        out = run("simulate", "--scene", "hard-start-fold", "--set", "verdict.strain=0", "--set", "verdict.clear_after=0",
                  "--ticks", "240", "--json")
        told = json.loads(out.stdout)
        self.assertEqual((out.returncode, told["guarantee"]["state"]), (0, "held"))
        self.assertEqual(told["crossings"]["while_led_out"], told["crossings"]["cloth_with_cloth"])
        self.assertIn("of cloth that started or was gathered there and was led out", out.stderr)
        # So is cloth that the scene itself puts through itself.
        gathered = {"cloths": [{"rows": 5, "columns": 5, "width": 1.2, "height": 1.2, "fabric": {"preset": "silk"}}],
                    "insults": [{"time": 0.05, "gather": 0.001}]}
        with tempfile.TemporaryDirectory() as folder:
            scene = os.path.join(folder, "gathered.json")
            with open(scene, "w", encoding="utf-8") as file:
                json.dump(gathered, file)
            out = run("simulate", "--scene", scene, "--ticks", "120", "--json")
        told = json.loads(out.stdout)
        self.assertEqual((out.returncode, told["guarantee"]["state"]), (0, "held"))
        self.assertGreater(told["crossings"]["while_led_out"], 0)
        self.assertEqual(told["crossings"]["while_led_out"], told["crossings"]["cloth_with_cloth"])
        free = run(*fold, "--set", "verdict.clear_after=0", "--set", "contact.self=none")
        self.assertEqual(free.returncode, 0)
        self.assertIn("about which its contact promises nothing", free.stderr)
        clear = run("simulate", "--scene", "wall", "--ticks", "5")
        self.assertEqual((clear.returncode, clear.stderr), (0, ""))
        self.assertIn("crossings.ticks_looked_at", clear.stdout)

    def test_simulate_gives_the_same_hash_for_any_number_of_threads(self):
        hashes = {json.loads(run("simulate", "--ticks", "60", "--json", "--threads", n).stdout)["hash"]
                  for n in ("1", "2", "3")}
        self.assertEqual(len(hashes), 1)

    def test_settings_change_the_outcome(self):
        scene = ("simulate", "--scene", "drape-sphere", "--ticks", "20", "--json")
        plain = json.loads(run(*scene).stdout)
        other = json.loads(run(*scene, "--set", "cloth.rows=12", "--set", "cloth.columns=10",
                               "--set", "environment.wind=0,-3,0").stdout)
        self.assertNotEqual(plain["hash"], other["hash"])
        self.assertEqual(other["particles"], 120)

    def test_the_model_of_the_seed_is_chosen_by_name_and_its_parts_are_in_the_profile(self):
        scene = ("simulate", "--scene", "drape-sphere", "--ticks", "40", "--json")
        weft = json.loads(run(*scene).stdout)
        seed = json.loads(run(*scene, "--set", "model=seed",
                              "--set", "contact.self=triangles").stdout)
        self.assertEqual((weft["solver"], seed["solver"]), ("verlet", "relaxation"))
        for stage in ("relaxation", "self_contact"):
            self.assertEqual(weft["stages"][stage]["work"], 0)
            self.assertGreater(seed["stages"][stage]["work"], 0)
        self.assertEqual(seed["stages"]["stretch"]["work"], 0)  # its springs are no forces
        hard = json.loads(run("simulate", "--scene", "hard-start-through", "--ticks", "2", "--json",
                              "--set", "model=seed").stdout)
        self.assertEqual(hard["solver"], "relaxation")
        self.assertGreater(hard["stages"]["self_contact"]["work"], 0)  # its own, as the scene asks for one
        refused = run("simulate", "--set", "model=sed")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("weft or seed", refused.stderr)

    def test_an_output_that_is_a_folder_is_refused_before_the_run(self):
        with tempfile.TemporaryDirectory() as folder:
            for option, name in (("--out", "cloth.obj"), ("--series", "run.npy")):
                path = os.path.join(folder, name)
                os.mkdir(path)
                result = run("simulate", "--ticks", "2", option, path)
                self.assertEqual((result.returncode, result.stdout), (2, ""))
                self.assertIn(f"{option} = {path}: allowed is a file", result.stderr)

    def test_simulate_writes_the_cloth(self):
        with tempfile.TemporaryDirectory() as folder:
            for ending, first in ((".obj", None), (".ply", "ply")):
                path = os.path.join(folder, "cloth" + ending)
                self.assertEqual(run("simulate", "--ticks", "2", "--out", path).returncode, 0)
                with open(path, encoding="latin-1") as file:
                    text = file.read()
                if first:
                    self.assertTrue(text.startswith(first))
                else:
                    self.assertEqual(sum(line.startswith("v ") for line in text.splitlines()), 600)
                    self.assertEqual(sum(line.startswith("f ") for line in text.splitlines()), 1102)


if __name__ == "__main__":
    main()
