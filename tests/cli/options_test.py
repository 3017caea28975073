"""The command line says what it can do, and what is wrong with what it was given."""
import json
import shutil
import subprocess
import unittest

from program import ENVIRONMENT, SCENE, ProgramTest

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

    def test_a_mistake_in_a_scene_is_told_with_its_place(self):
        (self.folder / "bad.pbrt").write_text('WorldBegin\nMaterial "difuse"\nShape "sphere"\n')
        for verb in "render", "info":
            self.assert_refused([verb, "bad.pbrt"], "bad.pbrt:2:", "error:", "diffuse")
        self.assertFalse((self.folder / "bad.exr").exists())
        self.assert_refused(["render", "none.pbrt"], "none.pbrt")

    def test_info_tells_what_is_in_the_scene(self):
        info = json.loads(self.run_program("info", SCENE, "--json", "--resolution", "80x60").stdout)
        self.assertEqual((info["triangles"], info["quadrics"]), (14, 3))
        self.assertEqual((info["width"], info["height"]), (80, 60))
        self.assertIn("14 triangles", self.run_program("info", SCENE).stdout)

    def test_list_knows_topics_names_and_parameters(self):
        topics = [line.split()[0] for line in self.run_program("list").stdout.splitlines()]
        for topic, name in [("integrators", "path"), ("samplers", "sobol"), ("materials", "diffuse"),
                            ("lights", "infinite"), ("shapes", "sphere"), ("textures", "checkerboard"), ("methods", "vegas"),
                            ("domains", "simplex"), ("functions", "heaviside")]:
            self.assertIn(topic, topics)
            self.assertIn(name, self.run_program("list", topic).stdout)
        self.assertIn("roughness", self.run_program("list", "materials", "conductor").stdout)


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
                                (["render", "--camera", ""], set())]:
            line = " ".join(f"'{word}'" for word in ["montelux", *words])
            code = (f"source ./completion; COMP_WORDS=({line}); COMP_CWORD={len(words)}; _montelux; "
                    "printf '%s\\n' \"${COMPREPLY[@]}\"")
            result = subprocess.run(["bash", "-c", code], cwd=self.folder, env=ENVIRONMENT, text=True,
                                    capture_output=True, check=True)
            self.assertEqual(set(result.stdout.split()), expected, words)


if __name__ == "__main__":
    unittest.main()
