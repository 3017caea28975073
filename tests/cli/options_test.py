"""The command line says what it can do, and what is wrong with what it was given."""
import json
import re
import shutil
import subprocess
import unittest

from program import ENVIRONMENT, ROOT, SCENE, ProgramTest, write_pfm

VERBS = ["render", "integrate", "merge", "info", "diff", "tonemap", "list", "completion"]


class Options(ProgramTest):
    def test_help_names_every_verb_and_every_verb_has_examples(self):
        text = self.run_program("--help").stdout
        for verb in VERBS:
            self.assertIn(verb, text)
            self.assertIn("Examples:", self.run_program(verb, "--help").stdout)

    def test_version_is_a_number(self):
        self.assertRegex(self.run_program("--version").stdout, r"^montelux \d+\.\d+\.\d+\n$")

    def assert_refused(self, arguments, *words):
        result = self.run_program(*arguments, status=2)
        self.assertEqual(result.stdout, "")
        for word in words:
            self.assertIn(word, result.stderr)
        return result.stderr

    def test_a_wrong_word_is_answered_with_the_nearest(self):
        self.assert_refused(["rendr"], 'unknown verb "rendr"', 'did you mean "render"')
        self.assert_refused(["render", SCENE, "--sed", "3"], 'unknown option "--sed"', "--spp", 'did you mean "--seed"')
        self.assert_refused(["render", SCENE, "--tone", "acs"], "--tone", "clip", 'did you mean "aces"')
        self.assert_refused(["render", SCENE, "--sampler", "sobl"], "--sampler", 'did you mean "sobol"')
        self.assert_refused(["render", SCENE, "--integrator", "pth"], "--integrator", 'did you mean "path"')
        self.assert_refused(["render", SCENE, "--set", "maxdpth=3"], "maxdpth", 'did you mean "maxdepth"')
        self.assert_refused(["list", "materials", "conducter"], 'did you mean "conductor"')

    def test_help_of_an_unknown_verb_is_no_help(self):
        for arguments in (["vew", "--help"], ["--help", "vew"], ["rendr", "-h"], ["rendr", "--version"]):
            with self.subTest(arguments=arguments):
                self.assert_refused(arguments, "unknown verb", "verbs: render")
        self.assert_refused(["rendr", "--help"], 'did you mean "render"')

    def test_a_value_out_of_range_is_refused(self):
        for option, value in [("--spp", "0"), ("--spp", "many"), ("--time", "3 weeks"), ("--resolution", "64"),
                              ("--crop", "1,2,3"), ("--crop", "9,0,3,4"), ("--seed", "-1"), ("--threads", "0"),
                              ("--exposure", "bright"), ("--set", "maxdepth")]:
            with self.subTest(option=option, value=value):
                self.assert_refused(["render", SCENE, f"{option}={value}"], f"{option}: takes", f'found "{value}"')

    def test_what_is_missing_or_too_much_is_named(self):
        self.assert_refused([], "verb is missing")
        self.assert_refused(["render"], "SCENE is required")
        self.assert_refused(["render", SCENE, "more"], 'unexpected argument "more"')
        self.assert_refused(["render", SCENE, "--spp", "4", "--time", "1s"], "--spp", "--time")
        self.assert_refused(["render", SCENE, "--crop", "0,0,9999,5"], "crop")

    def test_a_mistake_in_a_scene_is_reported_with_its_place(self):
        (self.folder / "bad.pbrt").write_text('WorldBegin\nMaterial "difuse"\nShape "sphere"\n')
        for verb in "render", "info":
            self.assert_refused([verb, "bad.pbrt"], "bad.pbrt:2:", "error:", "diffuse")
        self.assertFalse((self.folder / "bad.exr").exists())
        self.assert_refused(["render", "none.pbrt"], "none.pbrt")

    def test_info_states_what_is_in_the_scene(self):
        info = json.loads(self.run_program("info", SCENE, "--json", "--resolution", "80x60").stdout)
        self.assertEqual((info["triangles"], info["quadrics"]), (14, 3))
        self.assertEqual((info["width"], info["height"]), (80, 60))
        self.assertIn("14 triangles", self.run_program("info", SCENE).stdout)

    def test_a_scene_of_nothing_has_no_bounds(self):
        (self.folder / "empty.pbrt").write_text("WorldBegin\n")
        self.assertIn("bounds    none", self.run_program("info", "empty.pbrt").stdout)
        self.assertIsNone(json.loads(self.run_program("info", "empty.pbrt", "--json").stdout)["bounds"])

    def test_a_mark_of_utf8_before_a_text_is_taken(self):
        mark = b"\xef\xbb\xbf"
        (self.folder / "a.ply").write_bytes(mark + b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                                            b"property float y\nproperty float z\nelement face 1\n"
                                            b"property list uchar int vertex_indices\nend_header\n"
                                            b"0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        (self.folder / "grey.spd").write_bytes(mark + b"400 0.5\n700 0.5\n")
        (self.folder / "more.pbrt").write_bytes(mark + b'Shape "sphere"\n')
        (self.folder / "a.pbrt").write_bytes(
            mark + b'WorldBegin Material "diffuse" "spectrum reflectance" "grey.spd"\n'
            b'Shape "plymesh" "string filename" "a.ply"\nInclude "more.pbrt"\nLightSource "infinite"\n')
        (self.folder / "a.gltf").write_bytes(mark + b'{"asset": {"version": "2.0"}}')
        for scene, triangles in ("a.pbrt", 1), ("a.gltf", 0):
            info = json.loads(self.run_program("info", scene, "--json").stdout)
            self.assertEqual(info["triangles"], triangles)
        (self.folder / "bad.pbrt").write_bytes(mark + b"WorldBgin\n")
        self.assertIn("bad.pbrt:1:1: error", self.assert_refused(["info", "bad.pbrt"], "    WorldBgin\n    ^\n"))

    def test_notes_of_a_kind_are_one_line_and_all_are_listed_if_requested(self):
        face = '"point3 P" [ 0 0 0 1 0 0 0 1 0 ] "integer indices" [ 0 1 2  0 1 1  0 0 2 ]'
        (self.folder / "many.pbrt").write_text("WorldBegin LightSource \"infinite\"\n" +
                                               f'Shape "trianglemesh" {face}\n' * 60)
        short = self.run_program("info", "many.pbrt").stderr
        self.assertEqual(short.count("warning"), 1)
        self.assertIn("many.pbrt:2:1: warning: 60 meshes have faces without area, 120 in all", short)
        self.assertEqual(self.run_program("info", "many.pbrt", "--verbose").stderr.count("2 faces have no area"), 60)

    def test_an_environment_that_cannot_be_used_is_refused(self):
        scene = self.folder / "a.pbrt"
        scene.write_text('WorldBegin Shape "sphere"\n')
        self.assert_refused(["info", scene, "--environment", "none.exr"], "none.exr: error: there is no file")
        self.assert_refused(["info", scene, "--environment", "a.exr:rotaton=3"], 'did you mean "rotation"')
        self.assert_refused(["info", scene, "--environment", "a.exr:scale=-3"], "scale takes a number from 0")
        (self.folder / "sky:1.pfm").write_bytes(b"PF\n2 1\n-1.0\n" + bytes(24))
        lights = json.loads(self.run_program("info", scene, "--json", "--environment",
                                             "sky:1.pfm:rotation=-30,scale=2").stdout)["lights"]
        self.assertEqual(sum(lights.values()), 1)

    def test_volpath_of_a_scene_without_media_is_no_news(self):
        (self.folder / "a.pbrt").write_text('Integrator "volpath"\nWorldBegin\nLightSource "infinite"\n')
        self.assertEqual(self.run_program("info", "a.pbrt").stderr, "")

    def test_list_knows_topics_names_and_parameters(self):
        topics = [line.split()[0] for line in self.run_program("list").stdout.splitlines()]
        for topic, name in [("integrators", "path"), ("samplers", "sobol"), ("materials", "diffuse"),
                            ("lights", "infinite"), ("shapes", "sphere"), ("textures", "checkerboard"), ("methods", "vegas"),
                            ("domains", "simplex"), ("functions", "heaviside")]:
            self.assertIn(topic, topics)
            self.assertIn(name, self.run_program("list", topic).stdout)
        self.assertIn("roughness", self.run_program("list", "materials", "conductor").stdout)


class EveryVerb(ProgramTest):
    """What holds for all verbs of the program, as docs/command-line.md states it."""

    def verbs(self):
        text = self.run_program("--help").stdout
        verbs = re.findall(r"^  (\w+) ", text[text.index("Verbs:"):text.index("Examples:")], re.MULTILINE)
        self.assertIn("render", verbs)
        return sorted(verbs)

    def rows(self, head):
        """The first cells of the table with that head: the verbs that each names."""
        text = (ROOT / "docs" / "command-line.md").read_text()
        table = text[text.index(head):].split("\n\n")[0].splitlines()[2:]
        return [sorted(set(re.findall(r"`(\w+)", line.split("|")[1]))) for line in table]

    def test_the_document_names_every_verb_once(self):
        self.assertEqual(sorted(self.rows("| verb | does |")), [[verb] for verb in self.verbs()])
        common = [verb for verb in self.verbs() if verb != "completion"]
        self.assertEqual(sorted(self.rows("| with | `--json` prints |")), [[verb] for verb in common])

    # The command line of each verb, and of those with notes of several kinds one that has them.
    COMMANDS = {
        "render": ["render", "dark.pbrt", "--resolution", "32x24", "--spp", "2", "-o", "a.png"],
        "info": ["info", "flat.pbrt"],
        "trace": ["trace", "dark.pbrt", "--resolution", "32x24", "--pixel", "16,12", "--spp", "2"],
        "compare": ["compare", SCENE, "--resolution", "32x24", "-a", "path", "-b", "naive", "--spp", "1", "--repeats", "2",
                    "--no-cache", "--no-slopes", "--no-attribution"],
        "integrate": ["integrate", "x^-0.9", "--over", "x=0:1", "--method", "uniform", "--samples", "1e5", "--save", "c.json"],
        "merge": ["merge", "a.json", "b.json"],
        "denoise": ["denoise", "halves.exr", "-o", "clean.exr"],
        "diff": ["diff", "one.pfm", "two.pfm"],
        "tonemap": ["tonemap", "one.pfm", "-o", "b.png", "--range", "auto"],
        "list": ["list", "materials"],
        "lab": ["lab", "run", "roulette", "-o", "out"],
    }
    SILENT = {"denoise", "diff", "list"}  # that have no notes
    BRIEF = {"integrate", "merge"}  # whose results are shorter, too
    STATUS = {"diff": 1}  # the pictures differ

    def prepare(self):
        (self.folder / "dark.pbrt").write_text('WorldBegin Shape "sphere"\n')
        (self.folder / "flat.pbrt").write_text(
            'WorldBegin LightSource "infinite" Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 ] '
            '"integer indices" [ 0 1 2  0 1 1 ]\n')
        write_pfm(self.folder / "one.pfm", 4, 4, (1, 2, 3))
        write_pfm(self.folder / "two.pfm", 4, 4, (1, 2, 4))
        self.render("--spp", 2, "--layers", "halves", "--quiet", "-o", "halves.exr")
        for seed, name in enumerate(("a.json", "b.json")):
            self.run_program("integrate", "x^-0.9", "--over", "x=0:1", "--method", "uniform", "--samples", "1e5", "--seed",
                             seed, "--save", name, "--quiet")

    def test_quiet_leaves_out_notes_and_json_is_json(self):
        self.assertEqual(sorted([*self.COMMANDS, "completion"]), self.verbs())
        self.prepare()
        for verb, command in self.COMMANDS.items():
            with self.subTest(verb):
                status = self.STATUS.get(verb, 0)
                loud, quiet, loud_json, quiet_json = (
                    self.run_program(*command, *options, status=status)
                    for options in ([], ["--quiet"], ["--json"], ["--json", "--quiet"]))
                for result in quiet, quiet_json:
                    self.assertEqual(result.stderr, "")
                for result in loud, loud_json:
                    self.assertEqual(result.stderr == "", verb in self.SILENT, result.stderr)
                # Results stay, except for times and speeds; all results of compare depend on times.
                figures = re.compile(r"^time .*$|[\d.e+-]+( m?s\b)?| +", re.MULTILINE)
                shown, left = (figures.sub("", result.stdout) for result in (loud, quiet))
                if verb in self.BRIEF:
                    self.assertEqual(quiet.stdout, loud.stdout.splitlines(keepends=True)[0])
                elif verb == "compare":
                    self.assertEqual(left.splitlines()[0], shown.splitlines()[0])
                else:
                    self.assertEqual(left, shown)
                one, other = json.loads(loud_json.stdout), json.loads(quiet_json.stdout)
                self.assertEqual(type(one), type(other))
                if isinstance(one, dict):
                    self.assertEqual(one.keys(), other.keys())

    def test_errors_are_reported_in_spite_of_quiet(self):
        for command in (["render", "none.pbrt"], ["info", "none.pbrt"], ["diff", "none.exr", "none.exr"], ["list", "things"],
                        ["list", "materials", "things"], ["tonemap", "none.exr", "-o", "a.png"], ["merge", "none.json"],
                        ["integrate", "x"], ["lab", "list", "things"], ["compare", "none.pbrt", "-a", "path", "-b", "naive"]):
            with self.subTest(command=command):
                self.assertNotEqual(self.run_program(*command, "--quiet", status=2).stderr, "")

    def test_completion_prints_a_script_and_nothing_else(self):
        for option in "--json", "--quiet":
            self.assertIn("unknown option", self.run_program("completion", "bash", option, status=2).stderr)

    def test_lists_as_json_say_what_the_text_says(self):
        topics = json.loads(self.run_program("list", "--json").stdout)
        self.assertEqual([f"{t['name']} {t['meaning']}" for t in topics],
                         [" ".join(line.split()) for line in self.run_program("list").stdout.splitlines()])
        for command in ["list", "materials"], ["lab", "list"]:
            entries = json.loads(self.run_program(*command, "--json").stdout)
            text = self.run_program(*command).stdout
            for entry in entries:
                self.assertIn(entry["name"], text)
                self.assertEqual(json.loads(self.run_program(*command, entry["name"], "--json").stdout), entry)
        one = json.loads(self.run_program("list", "materials", "conductor", "--json").stdout)
        self.assertIn("roughness", [p["name"] for p in one["parameters"]])
        hair = json.loads(self.run_program("list", "materials", "hair", "--json").stdout)
        self.assertEqual((hair["instead"], hair["later"]), ("diffuse", True))


class Completion(ProgramTest):
    def script(self, shell):
        return self.run_program("completion", shell).stdout

    def test_scripts_name_verbs_options_and_choices(self):
        for shell in "bash", "zsh", "fish":
            text = self.script(shell)
            for word in [*VERBS, "exposure", "clip hable aces"]:
                self.assertIn(word, text)

    def check_syntax(self, shell):
        if not shutil.which(shell):
            self.skipTest(f"no {shell}")
        subprocess.run([shell, "-n"], input=self.script(shell), text=True, check=True)

    def test_zsh_can_read_its_script(self):
        self.check_syntax("zsh")

    def test_fish_can_read_its_script(self):
        self.check_syntax("fish")

    @unittest.skipUnless(shutil.which("bash"), "no bash")
    def test_bash_completes_verbs_options_choices_and_files(self):
        (self.folder / "room.exr").touch()
        (self.folder / "completion").write_text(self.script("bash"))
        for words, expected in [(["re"], {"render"}), (["render", "--tone", ""], {"clip", "hable", "aces"}),
                                (["diff", "--stderr"], {"--stderr-a", "--stderr-b"}), (["list", "mat"], {"materials"}),
                                (["tonemap", "ro"], {"room.exr"}), (["render", "-o", "roo"], {"room.exr"}),
                                (["completion", ""], {"bash", "zsh", "fish"}), (["integrate", "--tar"], {"--target", "--target-error"}),
                                (["integrate", "--method", "v"], {"vegas"}), (["merge", "ro"], {"room.exr"}),
                                (["render", "--camera", ""], set()), (["list", "--js"], {"--json"}),
                                (["diff", "--q"], {"--quiet"}), (["list", "--q"], {"--quiet"})]:
            line = " ".join(f"'{word}'" for word in ["montelux", *words])
            code = (f"source ./completion; COMP_WORDS=({line}); COMP_CWORD={len(words)}; _montelux; "
                    "printf '%s\\n' \"${COMPREPLY[@]}\"")
            result = subprocess.run(["bash", "-c", code], cwd=self.folder, env=ENVIRONMENT, text=True,
                                    capture_output=True, check=True)
            self.assertEqual(set(result.stdout.split()), expected, words)



class Extremes(ProgramTest):
    """Numbers that no ray-tracing kernel takes: one message at most, and a picture."""

    SCENE = """LookAt {eye} 0 -5 0 0 0 0 1 0
Camera "perspective"  PixelFilter "box"
WorldBegin
LightSource "infinite"
Material "diffuse" "rgb reflectance" [ 0 0 0 ]
ObjectBegin "pair"
Shape "sphere"
Shape "trianglemesh" "integer indices" [ 0 1 2 ] "point3 P" [ 0 0 0  1 0 0  0 1 0 ]
ObjectEnd
Shape "sphere"
{place}
"""

    def mean(self, eye="0", place=""):
        (self.folder / "a.pbrt").write_text(self.SCENE.format(eye=eye, place=place))
        result = self.run_program("render", "a.pbrt", "--resolution", "16x16", "--spp", "4", "--json", "-o", "a.pfm")
        return json.loads(result.stdout)["mean"][0], result.stderr

    def test_a_camera_beyond_all_space_sees_the_sky(self):
        mean, _ = self.mean(eye="9223372036854775808")
        self.assertEqual(mean, 1)

    def test_an_object_that_no_ray_can_see_is_left_out_with_a_warning(self):
        alone, _ = self.mean()
        self.assertLess(alone, 0.99)
        for place in "Scale 1e-30 1 1", "Scale 1e-18 1e-18 1e-18", "Scale 1 1 1e-10", "Translate 1e30 0 0":
            mean, errors = self.mean(place=f'AttributeBegin {place} ObjectInstance "pair" AttributeEnd')
            self.assertEqual(mean, alone, place)
            self.assertIn("a.pbrt:11:", errors)
            self.assertIn("cannot be seen", errors)

    def test_objects_far_off_and_huge_hide_nothing_else(self):
        alone, _ = self.mean()
        for place in "Translate 1e17 0 0", "Translate 0 0 1e17 Scale 1e12 1e12 1e12":
            mean, _ = self.mean(place=f'AttributeBegin {place} ObjectInstance "pair" AttributeEnd')
            self.assertEqual(mean, alone, place)


if __name__ == "__main__":
    unittest.main()
