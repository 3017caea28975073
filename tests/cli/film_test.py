"""Saved films: montelux render --checkpoint, --resume and --passes, montelux merge."""
import itertools
import json
import os
import re
import shutil
import signal
import time
import unittest

from program import ROOT, SCENE, ProgramTest

# 8 passes of 2 samples, of 4 x 2 tiles.
PLAN = ["--resolution", "100x64", "--spp", "16"]


def resealed(film, old, new, after=b'"adaptive"'):
    """A saved film with another header from `after` on, and its checksum: 64-bit FNV-1a of the header without it, then of the rest."""
    header, rest = film.split(b"\n", 1)
    header, found = re.subn(rb',"checksum":"\d+"', b"", header)
    assert found == 1, header[-200:]
    place = header.index(after)
    changed, found = re.subn(old, new, header[place:], count=1)
    assert found == 1, (old, header)
    changed = header[:place] + changed
    value = 0xcbf29ce484222325
    for byte in changed + rest:
        value = (value ^ byte) * 0x100000001b3 & 0xffffffffffffffff
    return changed[:-1] + b',"checksum":"%d"}\n' % value + rest


class Films(ProgramTest):
    def bytes_of(self, name):
        return (self.folder / name).read_bytes()

    def picture(self, *arguments, name):
        """The bytes of the picture that a render writes."""
        self.run_program("render", *arguments, "-o", name)
        return self.bytes_of(name)

    def part(self, first, last, name, *options):
        self.run_program("render", SCENE, *PLAN, *options, "--passes", f"{first}:{last}", "--checkpoint", name)
        return name

    def refused(self, *arguments, saying, status=2):
        """A command that must say one thing and leave every file as it is."""
        before = {file.name: file.read_bytes() for file in self.folder.iterdir()}
        result = self.run_program(*arguments, status=status)
        self.assertEqual(result.stderr.count("error:"), 1, result.stderr)
        self.assertRegex(result.stderr, saying)
        self.assertEqual(before, {file.name: file.read_bytes() for file in self.folder.iterdir()})

    def interrupt(self, *arguments, by=signal.SIGINT, after):
        """Starts a render and ends it by a signal once `after` is true; returns its status."""
        with self.start("render", *arguments) as process:
            until = time.monotonic() + 60
            while not after() and process.poll() is None and time.monotonic() < until:
                time.sleep(0.01)
            process.send_signal(by)
            process.communicate()
            return process.returncode

    def test_parts_in_any_order_make_the_film_of_one_render(self):
        options = ["--layers", "bounces:1,errors"]
        whole = self.picture(SCENE, *PLAN, *options, "--threads", "1", name="whole.exr")
        parts = [self.part(0, 0, "a.film", *options, "--threads", "2"),
                 self.part(1, 4, "b.film", *options, "--threads", "1"),
                 self.part(5, 7, "c.film", *options, "--threads", "2")]
        for order in itertools.permutations(parts):
            self.run_program("merge", *order, "-o", "all.film", "-o", "all.exr")
            self.assertEqual(self.bytes_of("all.exr"), whole, order)
            self.assertEqual(self.picture("--resume", "all.film", name="again.exr"), whole, order)
        # Merged step by step, too; and a part is another picture.
        self.run_program("merge", "c.film", "a.film", "-o", "ac.film")
        stated = json.loads(self.run_program("merge", "b.film", "ac.film", "-o", "all.exr", "--json").stdout)
        self.assertEqual(self.bytes_of("all.exr"), whole)
        self.assertEqual((stated["passes"], stated["samples"]), (8, 100 * 64 * 16))
        self.assertNotEqual(self.picture("--resume", "b.film", name="b.exr"), whole)

    def test_parts_keep_the_bias_that_they_measured(self):
        plan = [SCENE, "--resolution", "40x32", "--spp", "16", "--integrator",
                "irradiance-cache:samples=20,pairs=0.2", "--samples-per-pass", "4"]
        whole = self.picture(*plan, "--threads", "1", name="whole.exr")
        self.assertIn(b"montelux:measuredBiasStandardErrorG\0double", whole)
        for passes in "2:3", "0:0", "1:1":
            self.run_program("render", *plan, "--passes", passes, "--checkpoint", passes[0] + ".film")
        self.run_program("merge", "2.film", "0.film", "1.film", "-o", "all.film", "-o", "all.exr")
        self.assertEqual(self.bytes_of("all.exr"), whole)
        self.run_program("render", *plan, "--passes", "0:1", "--checkpoint", "begin.film")
        stated = json.loads(self.run_program("render", "--resume", "begin.film", "--passes", "0:3", "-o", "all.exr",
                                           "--json").stdout)
        self.assertEqual(self.bytes_of("all.exr"), whole)
        self.assertEqual(stated["measured_bias"]["passes"], 4)
        self.assertEqual(len(stated["measured_bias"]["mean"]), 3)
        # One pass shows no spread, and other integrators measure nothing.
        for part in ["2.film", "--passes", "2:2"], ["0.film", "--passes", "0:0"]:
            stated = json.loads(self.run_program("render", *plan, *part[1:], "-o", "one.exr", "--json").stdout)
            self.assertNotIn("measured_bias", stated)
        stated = json.loads(self.run_program("render", *plan[:5], "--integrator", "path", "-o", "p.exr", "--json").stdout)
        self.assertNotIn("measured_bias", stated)

    def test_parts_keep_how_their_markov_chains_have_mixed(self):
        plan = [SCENE, "--resolution", "40x32", "--spp", "16", "--integrator", "metropolis", "--samples-per-pass", "4"]
        stated = lambda *arguments: json.loads(self.run_program(*arguments, "--json").stdout).get("mixing")
        whole = stated("render", *plan, "--threads", "1", "-o", "whole.exr")
        self.assertEqual(whole["steps"], 4 * 4 * 16 * (64 + 16))  # passes, frames, chains of a cell, their steps in it
        self.assertGreater(whole["effective_samples"], whole["chains"] / 2)
        for passes in "2:3", "0:0", "1:1":
            self.run_program("render", *plan, "--passes", passes, "--checkpoint", passes[0] + ".film")
        self.run_program("merge", "2.film", "0.film", "1.film", "-o", "all.film")
        self.assertEqual(stated("render", "--resume", "all.film", "-o", "all.exr"), whole)
        self.run_program("render", *plan, "--passes", "0:1", "--checkpoint", "begin.film")
        self.assertEqual(stated("render", "--resume", "begin.film", "--passes", "0:3", "-o", "all.exr"), whole)
        self.assertIsNone(stated("render", *plan[:5], "--integrator", "path", "-o", "p.exr"))

    def test_a_film_with_a_gap_is_filled_where_it_continues(self):
        whole = self.picture(SCENE, *PLAN, name="whole.exr")
        self.run_program("merge", self.part(6, 7, "end.film"), self.part(0, 2, "begin.film"), "-o", "gap.film")
        self.assertEqual(self.picture("--resume", "gap.film", name="all.exr"), whole)

    def test_an_interrupted_render_continues_to_the_same_bits(self):
        plan = ["--resolution", "100x64", "--spp", "64", "--samples-per-pass", "2"]
        whole = self.picture(SCENE, *plan, name="whole.exr")
        film = self.folder / "room.film"
        saving = ["--checkpoint", "room.film", "--checkpoint-every", "20ms", "-o", "part.exr"]
        for by, threads in (signal.SIGINT, 2), (signal.SIGTERM, 1), (signal.SIGKILL, 2):
            with self.subTest(by=by):
                film.unlink(missing_ok=True)
                status = self.interrupt(SCENE, *plan, *saving, "--threads", threads, by=by, after=film.exists)
                self.assertEqual(status, -by if by == signal.SIGKILL else 128 + by)
                # Twice, so that an interrupted film is itself what continues; the second time to its end.
                seen = film.stat().st_mtime_ns
                self.interrupt("--resume", "room.film", *saving, by=by,
                               after=lambda: film.stat().st_mtime_ns != seen)
                self.assertEqual(self.picture("--resume", "room.film", "--threads", 3 - threads, name="all.exr"), whole)
        self.assertFalse([name for name in os.listdir(self.folder) if name.startswith(".montelux-")
                          and by != signal.SIGKILL])

    def test_interrupted_renders_say_how_to_go_on(self):
        film = self.folder / "room.film"
        with self.start("render", SCENE, "--resolution", "60x40", "--spp", "1000000", "--samples-per-pass", "2",
                        "--checkpoint", film.name, "--checkpoint-every", "10ms", "--json") as process:
            while not film.exists():
                time.sleep(0.01)
            process.send_signal(signal.SIGINT)
            out, err = process.communicate()
        self.assertEqual(process.returncode, 130)
        self.assertIn("montelux render --resume room.film continues", err)
        stated = json.loads(out)
        self.assertEqual((stated["film"], stated["interrupted"]), ("room.film", True))
        # What was done is counted on: samples, rays and time.
        more = json.loads(self.run_program("render", "--resume", "room.film", "--spp", "2", "--json").stdout)
        self.assertGreaterEqual(more["samples"], stated["samples"])
        self.assertLessEqual(more["samples"], stated["samples"] + 60 * 40 * 2)
        self.assertGreaterEqual(more["rays"], stated["rays"])
        saved = json.loads(film.read_bytes().split(b"\n", 1)[0])
        self.assertGreaterEqual(more["seconds"], saved["seconds"])

    def test_a_film_continues_to_more_samples(self):
        plan = ["--resolution", "60x40", "--samples-per-pass", "2"]
        whole = self.picture(SCENE, *plan, "--spp", "32", name="whole.exr")
        self.run_program("render", SCENE, *plan, "--spp", "10", "--checkpoint", "room.film")
        self.assertEqual(self.picture("--resume", "room.film", "--spp", "32", name="more.exr"), whole)
        # The same settings may be given again; a time adds to what there is.
        for time in "200ms", "2s", "20s":  # a slow build takes longer than the first to load the scene
            stated = json.loads(self.run_program("render", SCENE, *plan, "--resume", "room.film", "--time", time,
                                               "--checkpoint", "longer.film", "--json").stdout)
            if stated["passes"] > 5:
                break
        self.assertGreater(stated["passes"], 5)
        self.refused("render", "--resume", "longer.film", saying="longer.film was rendered within a time; --time says")
        # As far as there are passes, they are those of the render that was not interrupted.
        self.run_program("render", "--resume", "longer.film", "--spp", "10", "-o", "done.exr")

    def test_an_adaptive_render_continues_to_the_same_bits(self):
        plan = ["--resolution", "60x40", "--spp", "256", "--samples-per-pass", "4", "--adaptive", "on"]
        whole = self.picture(SCENE, *plan, "--checkpoint", "whole.film", name="whole.exr")
        self.assertEqual(self.picture("--resume", "whole.film", name="again.exr"), whole)
        film = self.folder / "room.film"

        def shares():
            return json.loads(film.read_bytes().split(b"\n", 1)[0])["adaptive"]["shares"] if film.exists() else None

        # While the first passes are rendered, which decide the shares, and later.
        for name, after in ("undecided", film.exists), ("decided", shares):
            with self.subTest(name):
                film.unlink(missing_ok=True)
                self.interrupt(SCENE, *plan, "--checkpoint", "room.film", "--checkpoint-every", "5ms", "-o", "part.exr",
                               "--threads", 1, by=signal.SIGKILL, after=after)
                self.assertEqual(bool(shares()), name == "decided")
                if name == "undecided":
                    undecided = film.read_bytes()
                self.assertEqual(self.picture("--resume", "room.film", "--threads", 2, name="all.exr"), whole)
        # Until the shares are decided the film has the rays of each tile.
        for old, new in ((rb'"rays":\[\d+,', b'"rays":['), (rb'"rays":\[\d+,', b'"rays":[-1,'), (rb',"rays":\[[\d,]*\]', b"")):
            with self.subTest(old=old, new=new):
                (self.folder / "bad.film").write_bytes(resealed(undecided, old, new))
                self.refused("render", "--resume", "bad.film", "-o", "x.exr", saying="bad.film.*(rays of its tiles are damaged|-1 instead of)")
        (self.folder / "good.film").write_bytes(resealed(undecided, b'"rays"', b'"rays"'))
        self.assertEqual(self.picture("--resume", "good.film", name="all.exr"), whole)
        # To more samples, by the same shares.
        more = json.loads(self.run_program("render", "--resume", "whole.film", "--spp", "320", "--json").stdout)
        self.assertGreater(more["samples"], json.loads(
            self.run_program("render", "--resume", "whole.film", "--json").stdout)["samples"])
        self.refused("merge", "whole.film", "room.film", "-o", "all.film", saying="whole.film is adaptive")
        self.refused("render", "--resume", "whole.film", "--adaptive", "off", "-o", "x.exr", saying="is adaptive")
        self.part(0, 3, "even.film")
        self.refused("render", "--resume", "even.film", "--adaptive", "on", "-o", "x.exr", saying="not adaptive")

    def test_an_adaptive_render_to_an_error_continues_to_the_same_bits(self):
        for options in (["--target-error", "12%"], ["--target-error", "15%", "--unbiased"]):
            with self.subTest(options=options):
                plan = ["--resolution", "60x40", *options, "--adaptive", "on"]
                whole = self.picture(SCENE, *plan, name="whole.exr")
                film = self.folder / "room.film"
                film.unlink(missing_ok=True)
                self.interrupt(SCENE, *plan, "--checkpoint", "room.film", "--checkpoint-every", "5ms", "-o", "part.exr",
                               by=signal.SIGKILL, after=film.exists)
                self.assertEqual(self.picture("--resume", "room.film", name="all.exr"), whole)

    def test_points_that_are_fixed_are_one_pass(self):
        fixed = ["--resolution", "40x30", "--sampler", "uniform-grid", "--spp", "4"]
        whole = self.picture(SCENE, *fixed, "--checkpoint", "a.film", name="whole.exr")
        self.assertEqual(self.picture("--resume", "a.film", name="again.exr"), whole)
        self.refused("render", "--resume", "a.film", "--spp", "16", "-o", "x.exr",
                     saying="uniform-grid takes all its samples in one pass")

    def test_series_of_coupled_integrators_are_passes(self):
        diffuse = ROOT / "scenes" / "analytic" / "rectangle-light.pbrt"
        for scene, way in (SCENE, "restir-di:warm-up=1"), (diffuse, "radiosity:elementsize=1"):
            with self.subTest(way=way):
                plan = ["--resolution", "48x40", "--spp", "8", "--samples-per-pass", "2", "--integrator", way]
                whole = self.picture(scene, *plan, "--threads", "1", name="whole.exr")
                for first, last, name in (0, 0, "a.film"), (1, 3, "b.film"):
                    self.run_program("render", scene, *plan, "--passes", f"{first}:{last}", "--checkpoint", name)
                self.run_program("merge", "b.film", "a.film", "-o", "all.exr")
                self.assertEqual(self.bytes_of("all.exr"), whole)
                film = self.folder / "room.film"
                film.unlink(missing_ok=True)
                long = ["--resolution", "48x40", "--spp", "80", "--samples-per-pass", "2", "--integrator", way]
                self.interrupt(scene, *long, "--checkpoint", "room.film", "--checkpoint-every", "1ms", after=film.exists)
                self.assertEqual(self.picture("--resume", "room.film", "--threads", "2", name="all.exr"),
                                 self.picture(scene, *long, name="long.exr"))

    def test_films_that_do_not_fit_are_refused(self):
        self.part(0, 3, "a.film")
        self.part(3, 5, "b.film")
        self.part(4, 5, "seed.film", "--seed", "1")
        self.part(4, 5, "way.film", "--integrator", "naive")
        self.part(4, 5, "sampler.film", "--sampler", "sobol")
        self.part(4, 5, "crop.film", "--crop", "0,0,50,50")
        self.run_program("render", SCENE, "--resolution", "60x40", "--spp", "16", "--passes", "4:5", "--checkpoint",
                         "size.film")
        merged = ["-o", "all.film"]
        self.refused("merge", "a.film", "b.film", *merged, saying="a.film and b.film both have pass 3")
        for name, what in {"seed": "seed is 0 and 1", "way": "integrator is .* and .naive", "crop": "crop is",
                           "sampler": "sampler is .* and .sobol", "size": "resolution is"}.items():
            self.refused("merge", "a.film", f"{name}.film", *merged, saying=f"a.film and {name}.film .*{what}")
        for given, what in {"--seed=1": "seed is 0 and 1", "--sampler=sobol": "sampler is",
                            "--integrator=naive": "integrator is", "--crop=0,0,50,50": "crop is",
                            "--resolution=60x40": "resolution is", "--samples-per-pass=4": "samples_per_pass is 2 and 4",
                            "--layers=bounces": "layers is"}.items():
            self.refused("render", SCENE, "--resume", "a.film", given, "-o", "x.exr", saying=what)
        self.refused("render", SCENE, *PLAN, "--passes", "7:8", *merged[:0], "--checkpoint", "x.film",
                     saying="there is no pass 8: 16 samples per pixel are 8 passes of 2, from 0 to 7")
        self.refused("render", SCENE, *PLAN, "--passes", "1:2", saying="--passes renders a part: --checkpoint FILE")

    def test_another_scene_is_refused(self):
        scene = self.folder / "room.pbrt"
        shutil.copy(SCENE, scene)
        self.run_program("render", "room.pbrt", "--resolution", "40x30", "--spp", "8", "--passes", "0:3",
                         "--checkpoint", "a.film")
        self.run_program("render", SCENE, "--resume", "a.film", "-o", "x.exr")  # the same scene by another name
        scene.write_text(scene.read_text() + "\n# changed\n")
        self.refused("render", "--resume", "a.film", "-o", "x.exr", saying="room.pbrt is not the scene that the saved")
        self.run_program("render", "room.pbrt", "--resolution", "40x30", "--spp", "8", "--passes", "4:7",
                         "--checkpoint", "b.film")
        self.refused("merge", "a.film", "b.film", "-o", "c.film", saying="a.film and b.film are of different scenes")
        scene.unlink()
        self.refused("render", "--resume", "a.film", "-o", "x.exr", saying="room.pbrt")

    def test_the_picture_that_a_scene_names_is_none_of_its_files(self):
        shutil.copy(SCENE, self.folder / "room.pbrt")
        self.run_program("render", "room.pbrt", "--resolution", "40x30", "--spp", "8", "--checkpoint", "a.film")
        self.assertTrue((self.folder / "first-light.exr").is_file())
        self.run_program("render", "--resume", "a.film")

    def test_halves_of_older_versions_are_refused(self):
        self.part(0, 0, "room.film", "--layers", "bounces:1,halves")
        film = self.bytes_of("room.film")
        for key, missing in (("layers_have_halves", "layers of light have no halves"),
                             ("halves_have_emission", "halves have no emission")):
            (self.folder / "old.film").write_bytes(resealed(film, f',"{key}":true'.encode(), b"", after=b'"features"'))
            self.refused("render", "--resume", "old.film", "-o", "x.exr",
                         saying=f"old.film.*{missing}: an older version saved it")
        self.run_program("merge", "room.film", "-o", "x.exr")

    def test_damaged_and_foreign_files_are_refused(self):
        self.part(0, 0, "good.film", "--crop", "0,0,40,30")
        good = self.bytes_of("good.film")
        header = good.index(b"\n")
        damages = {
            "truncated": (good[:-100], "it is truncated"),
            "cut in its header": (good[:header // 2], "not a file that montelux render --checkpoint wrote"),
            "flipped": (good[:-500] + bytes([good[-500] ^ 4]) + good[-499:], "its checksum is another"),
            "longer": (good + b"x", "its checksum is another"),
            "of another seed": (re.sub(rb'"seed":0', b'"seed":1', good, count=1), "its checksum is another"),
            "of the future": (good.replace(b'"version":1', b'"version":9', 1), "its format has version 9"),
            "empty": (b"", "not a file that montelux render --checkpoint wrote"),
            "a scene": (SCENE.read_bytes(), "not a file that montelux render --checkpoint wrote"),
        }
        for name, (content, saying) in damages.items():
            with self.subTest(damage=name):
                (self.folder / "bad.film").write_bytes(content)
                self.refused("render", SCENE, "--resume", "bad.film", "-o", "x.exr", saying=f"bad.film.*{saying}")
                if b'"montelux film"' in content[:64]:
                    self.refused("merge", "bad.film", "-o", "x.film", saying=saying)
        self.refused("merge", "good.film", "bad.film", "-o", "x.film",
                     saying="bad.film' cannot be read: it is not a file that montelux render --checkpoint wrote")
        self.run_program("integrate", "4*x^3", "--over", "x=0:1", "--samples", "100", "--save", "i.json")
        again = self.run_program("render", "--resume", "good.film", "-o", "x.exr")
        self.assertIn("the saved film has all of this already: no pass was added", again.stderr)
        self.refused("merge", "good.film", "i.json", "-o", "x.film",
                     saying="good.film is a saved film, and i.json is a saved integral")
        self.refused("render", "--resume", "i.json", "-o", "x.exr", saying="not a file that montelux render --checkpoint")
        self.refused("render", "--resume", "none.film", "-o", "x.exr", saying="none.film")

    def test_a_film_replaces_nothing_but_a_film(self):
        self.run_program("render", SCENE, *PLAN, "--passes", "0:0", "--checkpoint", "a.film")
        scene = self.folder / "own.pbrt"
        scene.write_bytes(SCENE.read_bytes())
        (self.folder / "notes.txt").write_text("notes")
        (self.folder / "empty.film").touch()
        before = {p.name: p.read_bytes() for p in self.folder.iterdir()}
        for target, saying in (("own.pbrt", "needs another ending than a scene"), ("x.exr", "ending than a picture"),
                               ("notes.txt", "exists and is not a saved film, so it is not replaced")):
            with self.subTest(target=target):
                self.refused("render", scene, *PLAN, "--checkpoint", target, "-o", "y.exr",
                             saying=f"cannot write '{target}': .*{saying}")
        for target in "own.pbrt", "m.gif", "notes.txt", "m.json":
            with self.subTest(target=target):
                self.refused("merge", "a.film", "-o", target, saying=f"cannot write '{target}'.*-o takes a film")
        said = self.run_program("merge", "a.film", "none.film", "x.exr", "-o", "m.gif", status=2).stderr
        self.assertRegex(said, "there is no file none.film\n.*there is no file x.exr\n.*cannot write 'm.gif'")
        self.assertEqual({p.name: p.read_bytes() for p in self.folder.iterdir()}, before)
        for target in "empty.film", "a.film", "none":
            self.run_program("merge", "a.film", "-o", target)
            self.assertEqual((self.folder / target).read_bytes(), before["a.film"])

    def test_a_film_that_cannot_be_saved_is_an_error(self):
        self.refused("render", SCENE, *PLAN, "--checkpoint", "none/room.film", "-o", "x.exr", saying="none/room.film")


if __name__ == "__main__":
    unittest.main()
