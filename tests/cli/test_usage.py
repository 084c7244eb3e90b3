# tier: quick
"""The command line itself: help, versions, wrong options. Nothing here renders."""
import os
import re
import shutil
import subprocess
import unittest

from support import ECLAT, Case, eclat

COMMANDS = ["render", "cost", "info", "compare", "merge", "mix", "devices", "view", "selftest", "completion"]


class Help(Case):
    def test_no_arguments_is_a_usage_error_with_a_hint(self):
        run = eclat()
        self.assertEqual((run.returncode, run.stdout), (2, ""))
        self.assertIn("Usage: eclat render SCENE", run.stderr)

    def test_help_everywhere(self):
        for arguments in [["--help"], ["-h"], ["help"], ["help", "help"]]:
            run = self.assert_ok(eclat(*arguments))
            self.assertTrue(run.stdout.startswith("Usage: eclat COMMAND"), arguments)
            self.assertEqual(run.stderr, "")
        for command in COMMANDS:
            texts = {self.assert_ok(eclat(*arguments)).stdout
                     for arguments in [[command, "--help"], [command, "-h"], ["help", command]]}
            self.assertEqual(len(texts), 1)
            self.assertTrue(texts.pop().startswith(f"Usage: eclat {command}"))

    def test_help_wins_over_missing_operands_and_fits_a_wide_terminal(self):
        for command in ["", *COMMANDS]:
            text = self.assert_ok(eclat(*filter(None, [command]), "--help")).stdout
            self.assertLessEqual(max(map(len, text.splitlines())), 120)

    def test_version_everywhere(self):
        for arguments in [["--version"], *([command, "--version"] for command in COMMANDS)]:
            run = self.assert_ok(eclat(*arguments))
            self.assertRegex(run.stdout, r"\Aeclat \d+\.\d+\.\d+\n")

    def test_version_says_how_eclat_was_built(self):
        lines = dict(line.split(None, 1) for line in self.assert_ok(eclat("--version")).stdout.splitlines())
        build = os.path.dirname(os.path.abspath(ECLAT))
        with open(os.path.join(build, "CMakeCache.txt"), encoding="utf-8") as file:
            cache = dict(re.findall(r"^(\w+):\w+=(.*)$", file.read(), re.M))
        self.assertRegex(lines["compiler"], rf"^(GCC|Clang) \d+\.\d+.*, {cache['CMAKE_BUILD_TYPE'] or 'Release'} for \S")
        self.assertEqual(lines["OpenCL"], "1.2")
        found = [name for name in ("avif", "draco", "meshopt", "webp") if not cache[f"CODEC_{name}_LIBRARY"].endswith("NOTFOUND")]
        found += ["basisu"] if cache["BASISU_SOURCE"] else []
        self.assertEqual(lines["readers"], ", ".join(sorted(found)) or "none")
        there = [name for name in ("mpi", "view") if os.path.exists(os.path.join(build, f"eclat-{name}.so"))]
        self.assertEqual(lines["modules"], ", ".join(there) or "none")

    def test_groups_are_alphabetical(self):
        groups = re.split(r"\n\n", self.assert_ok(eclat("render", "--help")).stdout)
        for group in groups:
            names = re.findall(r"^ {2,6}(?:-\w, )?--([a-z-]+)", group, re.M)
            self.assertEqual(names, sorted(names))

    def test_every_option_of_the_help_is_known(self):
        for command in set(COMMANDS) - {"selftest"}:  # selftest needs no operand and would run
            text = eclat(command, "--help").stdout
            for name in re.findall(r"^ {2,6}(?:-\w, )?--([a-z-]+)", text, re.M):
                if name in ("help", "version"):
                    continue
                self.assertNotIn("unknown option", eclat(command, f"--{name}").stderr, name)


    def test_render_has_no_option_twice(self):
        names = self.options_of("render")
        self.assertEqual(len(names), len(set(names)))
        self.assertGreater(len(names), 50)

    def options_of(self, command):
        return re.findall(r"^ {2,6}(?:-\w, )?--([a-z-]+)", self.assert_ok(eclat(command, "--help")).stdout, re.M)

    def test_lists_of_what_others_take_of_render(self):
        of_render = set(self.options_of("render"))
        text = self.assert_ok(eclat("info", "--help")).stdout
        for name in re.findall(r"--([a-z-]+)", text.split("Options of eclat render")[1]):
            self.assertIn(name, of_render)
            self.assertNotIn("unknown option", eclat("info", f"--{name}").stderr, name)
        lacking = re.findall(r"--([a-z-]+)", self.assert_ok(eclat("view", "--help")).stdout.split("except\n")[1].split("\n\n")[0])
        self.assertIn("checkpoint", lacking)
        for name in of_render - {"help", "version"}:
            run = eclat("view", "none.gltf", f"--{name}=1")
            self.assertEqual(name in lacking, f"--{name} is for 'eclat render'" in run.stderr or name in ("json", "overwrite", "verbose"), name)


class Shells(Case):
    """The man page and the completion scripts are made from the table of options."""

    def script(self, *arguments):
        path = self.path("script")
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.assert_ok(eclat(*arguments)).stdout)
        return path

    def complete(self, *words):
        lines = f'source {self.script("completion", "bash")}; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _eclat; printf "%s\\n" "${{COMPREPLY[@]}}"'
        run = subprocess.run(["bash", "-c", lines, "bash", *words], capture_output=True, text=True, check=True, cwd=self.folder)
        self.assertEqual(run.stderr, "")
        return run.stdout.split()

    def test_every_option_is_in_man_page_and_completion(self):
        text = self.assert_ok(eclat("render", "--help")).stdout
        names = re.findall(r"^ {2,6}(?:-\w, )?--([a-z-]+)", text, re.M)
        page = self.assert_ok(eclat("help", "--man")).stdout.replace("\\-", "-")
        render = page.split('.SH "ECLAT RENDER"')[1].split(".SH ")[0]
        for name in names:
            self.assertRegex(render, rf"\\fB--{name}(\[=[A-Z]+\])?,?\\fR", name)
        self.assertEqual(sorted(word.rstrip("=") for word in self.complete("eclat", "render", "--")), sorted(f"--{name}" for name in names))
        zsh, fish = (self.assert_ok(eclat("completion", shell)).stdout for shell in ("zsh", "fish"))
        for name in names:
            self.assertRegex(zsh, rf"'\*?--{name}(=-?)?\[", name)
            self.assertRegex(fish, rf"(?m)^complete -c eclat -n '__eclat_is render' -l {name} .*-d '.+'$")

    def test_bash_completes(self):
        subprocess.run(["bash", "-n", self.script("completion", "bash")], check=True)
        self.assertEqual(self.complete("eclat", "ren"), ["render"])
        self.assertEqual(self.complete("eclat", "render", "--integ"), ["--integrator"])
        self.assertEqual(self.complete("eclat", "render", "--integrator", ""), ["path", "whitted", "raster", "light"])
        self.assertEqual(self.complete("eclat", "render", "--integrator", "=", "w"), ["whitted"])
        self.assertEqual(self.complete("eclat", "render", "--adaptive", "="), ["auto", "on", "off"])
        self.assertEqual(self.complete("eclat", "render", "--spp", "1"), [])
        self.assertEqual(self.complete("eclat", "info", "s.gltf", "--accel", "bvh"), ["bvh2", "bvh8"])
        self.assertEqual(self.complete("eclat", "view", "--js"), [])
        with open(self.path("room.gltf"), "w", encoding="utf-8"):
            self.assertEqual(self.complete("eclat", "render", "ro"), ["room.gltf"])

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not there")
    def test_zsh_reads_its_script(self):
        subprocess.run(["zsh", "-n", self.script("completion", "zsh")], check=True)

    @unittest.skipUnless(shutil.which("fish"), "fish is not there")
    def test_fish_completes(self):
        script = self.script("completion", "fish")
        with open(self.path("room.gltf"), "w", encoding="utf-8"):
            pass

        def complete(line):
            run = subprocess.run(["fish", "--no-config", "-c", f"source {script}; complete -C '{line}'"], capture_output=True, text=True, check=True,
                                 cwd=self.folder, env=dict(os.environ, HOME=self.folder))
            self.assertEqual(run.stderr, "")
            return [choice.split("\t")[0] for choice in run.stdout.splitlines()]

        self.assertEqual(complete("eclat ren"), ["render"])
        self.assertEqual(complete("eclat render --integ"), ["--integrator"])
        self.assertEqual(sorted(complete("eclat render --integrator ")), ["path", "raster", "whitted"])
        self.assertEqual(complete("eclat render --integrator=w"), ["--integrator=whitted"])
        self.assertEqual(sorted(complete("eclat render --adaptive=")), ["--adaptive=auto", "--adaptive=off", "--adaptive=on"])
        self.assertEqual(complete("eclat render --spp "), [])
        self.assertEqual(complete("eclat render ro"), ["room.gltf"])
        self.assertEqual(complete("eclat view --js"), [])
        self.assertEqual(sorted(complete("eclat completion ")), ["bash", "fish", "zsh"])
        self.assertNotIn("--integrator", complete("eclat help render --"))

    @unittest.skipUnless(shutil.which("groff"), "groff is not there")
    def test_the_man_page_is_set_without_a_warning(self):
        run = subprocess.run(["groff", "-man", "-ww", "-Tutf8", self.script("help", "--man")], capture_output=True, text=True, check=True)
        self.assertEqual(run.stderr, "")
        self.assertIn("--integrator", run.stdout.replace("\b", ""))

    def test_a_shell_without_completion_is_refused(self):
        for arguments, says in [([], "bash, fish or zsh"), (["tcsh"], "'tcsh'"), (["bash", "zsh"], "bash, fish or zsh")]:
            self.assertIn(says, self.assert_one_error(eclat("completion", *arguments), 2))


class WrongOptions(Case):
    def usage(self, *arguments, says):
        line = self.assert_one_error(eclat(*arguments, cwd=self.folder), 2)
        self.assertIn(says, line)
        self.assertEqual(os.listdir(self.folder), [])

    def test_commands(self):
        self.usage("rendr", says="did you mean 'eclat render'")
        self.usage("device", says="did you mean 'eclat devices'")
        self.usage("scene.gltf", says="eclat render scene.gltf")
        self.usage("--frobnicate", says="unknown option")
        self.usage("help", "nothing", says="unknown command 'nothing'")
        self.usage("xyzzy", says="see 'eclat --help'")

    def test_operands(self):
        self.usage("render", says="needs a SCENE")
        self.usage("info", says="needs a SCENE")
        self.usage("info", "a.gltf", "b.gltf", says="one scene at a time: 'b.gltf'")
        self.usage("devices", "extra", says="no operand")
        self.usage("compare", says="needs two pictures")
        self.usage("compare", "a.exr", says="needs two pictures")
        self.usage("compare", "a.exr", "", says="the name of a picture is empty")
        for name in ["map.exr", "map", ".png", "folder/.png"]:
            self.usage("compare", "a.exr", "b.exr", "--diff", name, says="must be named NAME.png")

    def test_unknown_options_suggest_the_nearest(self):
        self.usage("render", "s.gltf", "--erorr", "2", says="did you mean '--error'")
        self.usage("render", "s.gltf", "--maxdepth=3", says="did you mean '--max-depth'")
        self.usage("compare", "a.exr", "b.exr", "--dif=x", "--jso", says="must be named NAME.png")
        self.usage("info", "s.gltf", "--jsn", says="did you mean '--json'")
        self.usage("render", "s.gltf", "--frobnicate", says="see 'eclat render --help'")
        self.usage("render", "s.gltf", "-z", says="unknown option '-z'")

    def test_ambiguous_missing_and_superfluous_values(self):
        self.usage("render", "s.gltf", "--s", "1", says="ambiguous: --sample, --sampler, --samples, --scattering, --scenarios, --scene, --screen-window, --seed, --shard, --sheet, --shutter, --size, --snapshot, --spp")
        self.usage("render", "s.gltf", "--spp", says="'--spp' needs a value")
        self.usage("render", "s.gltf", "-o", says="needs a value")
        self.usage("render", "s.gltf", "--quiet=yes", says="takes no value")

    def test_numbers_are_strict(self):
        for option, values in {
            "--spp": ["0", "-1", "0x10", "+5", "1e3", "12x", " 4", "", "nan", "16777217", "99999999999999999999"],
            "--time": ["0", "-3", "nan", "inf", "3x", "s", "1e99", "0x2", "0x2s", ""],
            "--error": ["0", "-1%", "nan%", "2%%", "101", "%", "0x2%"],
            "--size": ["512", "512x", "x512", "0x10", "-1x5", "5x5x5", "512X512 ", "100000x100000", "60000x60000"],
            "--max-depth": ["0", "-1", "infinite", "1.5"],
            "--seed": ["-1", "18446744073709551616", "0x", "ten"],
            "--exposure": ["nan", "inf", "1e9", "1ev", "Auto", "0x1", "0x1p3", ""],
            "--lanes": ["0", "2", "32", "all"],
            "--replicates": ["0", "17", "1.5", "many", ""],
            "--adaptive": ["yes", "", "1"],
            "--wave": ["0", "-5"],
            "--sampler": ["halton", ""],
            "--tonemap": ["reinhard", ""],
            "--terminator": ["soft", ""],
            "--sample": ["all", "nee", ""],
            "--accel": ["octree"],
            "--instancing": ["yes", ""],
            "--grid-density": ["0", "-1", "0.009", "10001", "inf", "nan", "27x", ""],
            "--integrator": ["raytrace", ""],
            "--env-rotate": ["nan", "inf", "90d", ""],
            "--env-strength": ["-1", "nan", "inf", "2x", ""],
            "--light-choice": ["bvh", ""],
            "--filter": ["gaussian", ""],
            "--filter-width": ["0", "11", "nan", ""],
            "--eye": ["1,2", "1,2,nan", "0x1,0,0", "1, 2,3"],
            "--fstop": ["0", "-2", "nan", "f/2", ""],
            "--screen-window": ["1", "0,1,0", "1,0,0,1", "0,1,1,0", "0,0,0,1", "0,1e5,0,1", "nan,1,0,1", "0,1,0,1,", ""],
            "--focus": ["0", "-1", "nan", "inf", "2m", ""],
            "--clamp": ["0", "-1", "off", "nan", "inf", "1e7", "10x", ""],
            "--cutoff": ["-0.1", "1.5", "nan", "1%", ""],
            "--rr": ["0", "-0.5", "1.5", "on", "nan", "inf", "50%", ""],
        }.items():
            for value in values:
                with self.subTest(option=option, value=value):
                    self.usage("render", "s.gltf", f"{option}={value}", says=option)

    def test_a_camera_has_one_lens(self):
        for lenses in [["--fov", "30", "--parallel", "2"], ["--parallel", "2", "--fov", "30"]]:
            self.usage("render", "s.gltf", *lenses, says="--fov and --parallel do not go together")

    def test_a_path_must_end_somewhere(self):
        for end in [["--rr", "off"], ["--rr", "off", "--max-depth", "inf"], ["--max-depth", "inf", "--rr=1"]]:
            with self.subTest(end=end):
                self.usage("render", "s.gltf", *end, says="--rr off belongs with a finite --max-depth")

    def test_options_of_another_integrator(self):
        for integrator, option, says in [("raster", ["--rr", "0.5"], "path or light"), ("raster", ["--sample", "light"], "path"), ("whitted", ["--light-choice", "tree"], "path"),
                                         ("raster", ["--max-depth", "3"], "path, whitted or light"), ("raster", ["--accel", "bvh8"], "path, whitted or light"),
                                         ("whitted", ["--rr", "0.5"], "path or light"), ("whitted", ["--terminator", "smooth"], "path"), ("whitted", ["--sample", "mis"], "path"),
                                         ("whitted", ["--clamp", "1"], "path"), ("raster", ["--clamp", "1"], "path"),
                                         ("path", ["--cutoff", "0"], "whitted"), ("light", ["--fog", "1,1,0"], "path"), ("raster", ["--cutoff", "0"], "whitted")]:
            with self.subTest(integrator=integrator, option=option):
                self.usage("render", "s.gltf", "--integrator", integrator, *option, says=f"{option[0]} belongs to --integrator {says};")

    def test_a_lens_has_an_opening_and_a_focus(self):
        self.usage("render", "s.gltf", "--fstop", "2", says="--fstop and --focus go together: how wide the lens is, and how far away it is sharp; give --focus too")
        self.usage("render", "s.gltf", "--focus", "2", says="give --fstop too")
        self.usage("render", "s.gltf", "--fstop", "2", "--focus", "1", "--integrator", "raster", says="belongs to --integrator path, whitted or light;")

    def test_a_plan_is_of_one_whole_picture(self):
        for option, value in [("--frames", "0:1"), ("--samples", "0:16")]:
            self.usage("render", "s.gltf", "--plan", "3", option, value, says=f"--plan and {option}: ")

    def test_a_box_has_one_width(self):
        for rest in [[], ["--filter", "box"]]:
            self.usage("render", "s.gltf", "--filter-width", "2", *rest, says="--filter-width belongs to --filter blackman-harris;")

    def test_a_ray_tree_is_finite(self):
        for depth in ["inf", "65"]:
            with self.subTest(depth=depth):
                self.usage("render", "s.gltf", "--integrator", "whitted", "--max-depth", depth, says="64")

    def test_a_density_needs_a_grid(self):
        for rest in [[], ["--accel", "bvh8"], ["--accel", "auto"]]:
            with self.subTest(rest=rest):
                self.usage("render", "s.gltf", "--grid-density", "8", *rest, says="--grid-density belongs to --accel grid;")
        for rest in [[], ["--accel", "kdtree"]]:
            with self.subTest(rest=rest):
                self.usage("info", "s.gltf", "--grid-density", "8", *rest, says="--grid-density belongs to --accel grid or all;")
        for value in ["0", "1e5", "many"]:
            self.usage("info", "s.gltf", "--accel", "grid", f"--grid-density={value}", says="--grid-density")
        self.usage("render", "s.gltf", "--integrator", "raster", "--grid-density", "8", says="belongs to --integrator path")

    def test_outputs(self):
        for name in ["a.gif", "a", ".png", "a.exr.txt", "folder.png/"]:
            with self.subTest(name=name):
                self.usage("render", "s.gltf", "-o", name, says="use .exr (all data), .png")
        self.usage("render", "s.gltf", "-o", "a.png", "-o", "a.png", says="twice")


class Streams(Case):
    def test_a_result_that_cannot_be_written_is_a_failure(self):
        with open("/dev/full", "w") as full:
            run = eclat("help", stdout=full)
        self.assertEqual(run.returncode, 1)
        self.assertIn("standard output", run.stderr)

    def test_a_closed_standard_output_is_a_failure(self):
        run = eclat("help", stdout=None, preexec_fn=lambda: os.close(1))
        self.assertEqual(run.returncode, 1)
        self.assertIn("standard output", run.stderr)

    def test_a_closed_pipe_is_a_failure_and_no_signal(self):
        reader, writer = os.pipe()
        os.close(reader)
        run = eclat("help", stdout=writer)
        os.close(writer)
        self.assertEqual(run.returncode, 1)

    def test_messages_hold_no_control_characters(self):
        run = eclat("info", self.path("a\x1b[31m.gltf"))
        self.assertEqual(run.returncode, 1)
        self.assertNotIn("\x1b", run.stderr)


if __name__ == "__main__":
    unittest.main()
