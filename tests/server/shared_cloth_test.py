"""Several viewers share one cloth: what one does the others see. A foreign client on real sockets."""

import asyncio
import struct

from foreign_client import SocketTest, main


class SharedCloth(SocketTest):
    options = ("--scene", "curtain")

    async def test_the_order_on_joining_is_as_specified(self):
        viewer = await self.viewer()
        await viewer.wait_frame(lambda f: True)
        self.assertEqual(viewer.order[:7], ["welcome", "mesh", "mesh data", "state", "roster", "pins",
                                            "grabs"])
        # A state that is due and what the scene has to tell may come before the first frame.
        self.assertEqual([name for name in viewer.order[7:] if name not in ("state", "notice")][0], "frame")

    async def test_two_viewers_get_the_same_checksum_for_the_same_tick(self):
        a, b = await self.viewer(), await self.viewer()
        await a.wait_frame(lambda f: f.tick >= b.frames[0].tick + 60 if b.frames else False)
        await b.wait_frame(lambda f: f.tick >= a.frames[-1].tick)
        sums = {f.sequence: (f.tick, f.sums) for f in a.frames}
        shared = [f for f in b.frames if f.sequence in sums]
        self.assertGreater(len({f.tick for f in shared}), 10)
        for frame in shared:
            self.assertEqual((frame.tick, frame.sums), sums[frame.sequence])
        # And what the checksums stand for: the positions of a tick, in whatever frame they come.
        places = {f.tick: f.position_bytes for f in a.frames}
        for frame in b.frames:
            self.assertEqual(frame.position_bytes, places.get(frame.tick, frame.position_bytes))

    async def test_a_drag_by_one_moves_the_cloth_for_both(self):
        a, b = await self.viewer(), await self.viewer()
        particle = 40 * 33 + 16  # middle of the hem
        answer = await a.ask("drag", phase="start", drag=1, particle=particle)
        self.assertEqual(answer["op"], "result")
        start = answer["target"]
        for viewer in (a, b):
            lifted = None
            while not lifted:  # the target is repeated, as the lease wants
                seen = len(viewer.frames)
                await a.tell("drag", phase="move", drag=1,
                             target=[start[0], start[1] + 0.5, start[2] + 0.5])
                frame = await viewer.wait_frame(lambda f: f.grabs, seen)
                lifted = frame if frame.positions[particle][1] > start[1] + 0.3 else None
            self.assertEqual(lifted.grabs[0][:2], (answer["grab"], a.id))
        seen = await b.wait_text(lambda m: m["op"] == "grabs" and m["grabs"])
        self.assertEqual(seen["grabs"][0]["viewer"], a.id)
        self.assertEqual(seen["grabs"][0]["drag"], 1)

    async def test_pins_and_releases_of_one_are_seen_by_the_other(self):
        a, b = await self.viewer(), await self.viewer()
        answer = await a.ask("pin", particle=700, radius=0.06)
        seen = await b.wait_text(lambda m: m["op"] == "pins" and len(m["pins"]) == 10)
        pin = seen["pins"][-1]
        self.assertEqual((pin["id"], pin["viewer"], pin["particle"], pin["count"]),
                         (answer["pin"], a.id, 700, answer["count"]))
        where = (await b.positions())[700]
        first = len(b.frames)
        later = await b.wait_frame(lambda f: f.tick > b.frames[first - 1].tick + 30, first)
        for i in range(3):
            self.assertAlmostEqual(later.positions[700][i], where[i], places=5)
        released = await b.ask("release", pin=answer["pin"])
        self.assertEqual(released["released"], [answer["pin"]])
        seen = len(a.texts)
        await a.wait_text(lambda m: m["op"] == "pins" and len(m["pins"]) == 9, 0)
        self.assertEqual((await a.ask("release", pin=answer["pin"]))["code"], "unknown_pin")

    async def test_pause_reset_and_speed_of_one_hold_for_the_other(self):
        a, b = await self.viewer(), await self.viewer()
        paused = await a.ask("pause")
        await b.wait_text(lambda m: m["op"] == "state" and m["paused"])
        self.assertEqual((await b.ask("hash"))["tick"], paused["tick"])
        await asyncio.sleep(0.3)
        self.assertEqual((await b.ask("hash"))["tick"], paused["tick"])
        step = await b.ask("step", n=5)
        self.assertEqual(step["until"], paused["tick"] + 5)
        await a.wait_frame(lambda f: f.tick == step["until"])
        await a.ask("reset")
        await b.wait_frame(lambda f: f.tick == 0 and f.flags & 2)
        await b.ask("speed", speed=0.5)
        await a.wait_text(lambda m: m["op"] == "state" and m["speed"] == 0.5)

    async def test_the_camera_of_one_is_readable_by_the_other(self):
        a, b = await self.viewer(), await self.viewer()
        camera = {"position": [0.5, 1.25, 3], "target": [0, 1, 0], "up": [0, 1, 0], "fov": 40}
        self.assertEqual((await a.ask("camera", **camera))["op"], "result")
        seen = (await b.ask("query", what="camera", viewer=a.id))["data"]
        self.assertEqual(seen, [{"viewer": a.id, **camera}])
        self.assertEqual((await b.ask("query", what="camera", viewer=b.id))["data"], [])

    async def test_names_and_colours_are_told(self):
        a, b = await self.viewer(), await self.viewer()
        await a.ask("hello", name="Ada ✓", color="#123abc")
        roster = await b.wait_text(
            lambda m: m["op"] == "roster" and any(v["name"] == "Ada ✓" for v in m["viewers"]))
        self.assertEqual([v["id"] for v in roster["viewers"]], [a.id, b.id])

    async def test_a_viewer_that_leaves_lets_go(self):
        a, b = await self.viewer(), await self.viewer()
        await a.ask("drag", phase="start", drag=1, particle=700)
        await a.ask("drag", phase="start", drag=2, particle=900)
        self.assertEqual((await b.ask("drag", phase="start", drag=1, particle=700))["code"], "held")
        seen = len(b.texts)
        a.socket.transport.abort()  # without a goodbye
        await b.wait_text(lambda m: m["op"] == "grabs" and not m["grabs"], seen)
        await b.wait_text(lambda m: m["op"] == "roster" and len(m["viewers"]) == 1, seen)
        self.assertEqual((await b.ask("drag", phase="start", drag=1, particle=700))["op"], "result")

    async def test_a_drag_without_messages_ends_by_its_lease(self):
        a = await self.viewer()
        await a.ask("drag", phase="start", drag=3, particle=700)
        notice = await a.wait_text(lambda m: m["op"] == "notice" and m["code"] == "lease_expired")
        self.assertEqual((notice["drag"], notice["viewer"]), (3, a.id))
        move = await a.ask("drag", phase="move", drag=3, target=[0, 0, 0])
        self.assertEqual(move["code"], "unknown_drag")

    async def test_frames_tell_the_number_of_the_message_that_they_include(self):
        a = await self.viewer()
        for _ in range(4):
            await a.ask("ping", t=1)
        await a.ask("pin", particle=5)
        frame = await a.wait_frame(lambda f: f.applied.get(a.id, 0) >= 5)
        self.assertEqual(frame.applied[a.id], 5)

    async def test_load_replaces_mesh_and_epoch_for_everybody(self):
        a, b = await self.viewer(), await self.viewer()
        answer = await a.ask("load", scene="drape-sphere")
        self.assertEqual(answer["epoch"], 2)
        frame = await b.wait_frame(lambda f: f.epoch == 2)
        self.assertEqual(frame.vertices, 49 * 49)
        order = b.order[b.order.index("mesh", 5):]
        self.assertEqual(order[1], "mesh data")
        first_new = next(i for i, f in enumerate(b.frames) if f.epoch == 2)
        self.assertTrue(all(f.epoch == 2 for f in b.frames[first_new:]))
        self.assertEqual((await a.ask("load", scene="nowhere"))["code"], "unknown_scene")


class LockStep(SocketTest):
    options = ("--paused",)

    async def test_advance_twice_gives_the_same_hash(self):
        a = await self.viewer()
        hashes = []
        for _ in range(2):
            await a.ask("reset")
            await a.ask("advance", n=30)
            await a.ask("drag", phase="start", particle=590, target=[0.2, 1, 0.5])
            await a.ask("advance", n=60)
            await a.ask("drag", phase="end")
            answer = await a.ask("advance", n=30)
            self.assertEqual(answer["tick"], 120)
            hashes.append(answer["hash"])
        # The second run numbers its pins and hands anew, which is part of the state.
        self.assertEqual(hashes[0], hashes[1])

    async def test_positions_come_alike_as_json_f32_f64_and_in_the_frame(self):
        a = await self.viewer()
        await a.ask("advance", n=10)
        text = await a.positions()
        frame = await a.wait_frame(lambda f: f.tick == 10)
        # Text has as many digits as a float32 needs.
        self.assertEqual([struct.unpack("<3f", struct.pack("<3f", *p)) for p in text], frame.positions)
        for count, (name, letter) in enumerate((("f32", "f"), ("f64", "d")), 2):
            answer = await a.ask("query", what="positions", format=name)
            data = await a.wait_binary(count)
            self.assertEqual(len(data), answer["binary"]["bytes"])
            tick, transfer, rows, columns = struct.unpack_from("<QIII", data, 16)
            self.assertEqual((tick, transfer, rows, columns),
                             (10, answer["binary"]["transfer"], 600, 3))
            values = list(struct.iter_unpack("<3" + letter, data[40:40 + rows * struct.calcsize("3" + letter)]))
            self.assertEqual(values, frame.positions)

    async def test_no_command_moves_a_vertex_while_ticks_stand_still(self):
        a, b = await self.viewer(), await self.viewer()
        await a.ask("advance", n=30)
        before = await b.positions()
        commands = [
            ("drag", dict(phase="start", drag=1, particle=590, target=[9, 9, 9], radius=0.2,
                          stiffness=100000, max_force=1000000)),
            ("drag", dict(phase="move", drag=1, target=[-9, 0, 100])),
            ("pin", dict(particle=300, radius=0.2)),
            ("pick", dict(origin=[0, 1, 5], direction=[0, 0, -1])),
            ("camera", dict(position=[0, 0, 1], target=[0, 0, 0])),
            ("set", dict(gravity=[0, 1000, 0], wind=[100, 0, 0], drag=0)),
            ("speed", dict(speed=10)),
            ("release", dict(all=True)),
            ("drag", dict(phase="end", drag=1)),
            ("hello", dict(name="mover")),
            ("view", dict(hz=60)),
            ("pause", {}),
        ]
        for op, fields in commands:
            self.assertEqual((await a.ask(op, **fields))["op"], "result", op)
            self.assertEqual(await b.positions(), before, op)
        await a.ask("advance", n=1)
        self.assertNotEqual(await b.positions(), before)

    async def test_energies_are_told_before_the_first_tick_and_after_each_change(self):
        a = await self.viewer()
        state = await a.wait_text(lambda m: m["op"] == "state")
        self.assertEqual(state["tick"], 0)
        energy = state["energy"]
        self.assertGreater(energy["gravity"], 1)  # 0.2 kg more than a metre above the ground
        self.assertEqual(energy["kinetic"], 0)
        self.assertAlmostEqual(energy["total"], energy["gravity"], delta=1e-3)
        self.assertEqual((await a.ask("query", what="energies"))["data"], energy)
        await a.ask("set", gravity=[0, -19.62, 0])
        doubled = (await a.ask("query", what="energies"))["data"]
        self.assertAlmostEqual(doubled["gravity"] / energy["gravity"], 2, places=6)

    async def test_every_query_answers(self):
        a = await self.viewer()
        await a.ask("advance", n=5)
        for what in ("energies", "strain", "pins", "grabs", "camera", "roster", "state", "work",
                     "trees", "measurements"):
            answer = await a.ask("query", what=what)
            self.assertEqual((answer["op"], answer["what"], answer["tick"]), ("result", what, 5))

    async def test_boxes_of_each_level_hold_the_cloth_and_halve_in_number(self):
        a = await self.viewer()
        await a.ask("advance", n=30)
        trees = (await a.ask("query", what="trees"))["data"]
        self.assertEqual([t["tree"] for t in trees], ["particles", "edges", "triangles", "object:form"])
        positions = await a.positions()
        around = [f(p[k] for p in positions) for f in (min, max) for k in range(3)]
        self.assertEqual((await self.boxes(a, "particles", 0)), [around])
        for tree in trees:
            levels = [await self.boxes(a, tree["tree"], k) for k in range(tree["levels"])]
            for upper, lower in zip(levels, levels[1:]):
                self.assertLess(len(upper), len(lower))
                self.assertLessEqual(len(lower), 2 * len(upper))
                for box in lower:
                    self.assertTrue(any(self.within(box, b) for b in upper))
            self.assertEqual(await self.boxes(a, tree["tree"], 255), levels[-1])
        self.assertEqual(len(levels[-1]), 1418)
        last = await self.boxes(a, "particles", 255)
        self.assertEqual(sorted(last), sorted(p + p for p in positions))

    async def boxes(self, viewer, tree, level):
        return (await viewer.ask("query", what="boxes", tree=tree, level=level))["data"]

    @staticmethod
    def within(box, other):
        return all(other[k] <= box[k] and box[k + 3] <= other[k + 3] for k in range(3))

    async def test_an_unknown_tree_is_refused_with_the_names_of_those_there_are(self):
        a = await self.viewer()
        error = await a.ask("query", what="boxes", tree="object:nobody")
        self.assertEqual((error["op"], error["code"], error["field"]), ("error", "out_of_range", "tree"))
        self.assertIn("object:form", error["message"])

    async def test_a_pick_hits_the_cloth_where_the_positions_say(self):
        a = await self.viewer()
        p = (await a.positions())[310]
        hit = (await a.ask("pick", origin=[p[0] + 1e-3, p[1] + 1e-3, p[2] + 2], direction=[0, 0, -9]))["hit"]
        self.assertEqual(hit["particle"], 310)
        self.assertAlmostEqual(hit["distance"], 2, places=2)
        self.assertIsNone((await a.ask("pick", origin=[0, 50, 0], direction=[0, 1, 0]))["hit"])


class DrapeTest(SocketTest):
    options = ("--scene", "drape-test", "--paused")

    async def test_a_flat_specimen_has_a_drape_coefficient_of_100_percent(self):
        a = await self.viewer()
        measured = (await a.ask("query", what="measurements"))["data"]
        self.assertEqual(set(measured),
                         {"drape_coefficient_percent", "folds", "droop_m", "largest_speed_m_s",
                          "published_low_percent", "published_high_percent"})
        self.assertEqual((measured["published_low_percent"], measured["published_high_percent"]), (60, 76))
        self.assertAlmostEqual(measured["drape_coefficient_percent"], 100, delta=1)
        self.assertEqual((measured["folds"], measured["largest_speed_m_s"]), (0, 0))
        await a.ask("advance", n=6)
        fallen = (await a.ask("query", what="measurements"))["data"]
        self.assertLess(fallen["drape_coefficient_percent"], 99)
        self.assertGreater(fallen["droop_m"], 0.005)


class Wall(SocketTest):
    options = ("--scene", "wall", "--paused")

    async def test_a_drag_of_50_n_through_a_wall_leaves_the_cloth_on_its_side(self):
        a = await self.viewer()
        particle = 15 * 25 + 12
        answer = await a.ask("drag", phase="start", particle=particle, max_force=50)
        x, y, _ = answer["target"]
        for target in ([x, y, -1], [x, y - 0.3, -3], [x + 0.5, y, -0.6]):
            await a.ask("drag", phase="move", target=target)
            await a.ask("advance", n=120)
            grab = (await a.ask("query", what="grabs"))["data"][0]
            force = sum(c * c for c in grab["force"]) ** 0.5
            self.assertGreater(force, 20, "the hand pulls hard")
            self.assertLessEqual(force, 50.01)
            # The wall is the box z <= 0, |x| <= 1.2, y <= 1.8; the cloth starts at z > 0.
            behind = [p for p in await a.positions()
                      if p[2] < 0 and abs(p[0]) <= 1.2 and p[1] <= 1.8]
            self.assertEqual(behind, [])


if __name__ == "__main__":
    main()
