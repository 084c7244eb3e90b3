# tier: full
"""The wheel of tools/python as others get it: its contents, the libraries that it loads, its command, its types; tests/python tests its
functions."""
import importlib.util
import json
import os
import re
import sys
import types
import unittest
import zipfile
from unittest import mock

import denoiser
import support
import wheel
from support import CORNELL, SOURCE

# Libraries that every Linux of the wheel's tag has: PEP 600, and auditwheel's list.
EVERYWHERE = r"(ld-linux-x86-64|libc|libm|libdl|libpthread|librt|libgcc_s|libstdc\+\+|libz)\.so[.\d]*"

TYPED = """import eclat
from pathlib import Path

def show(progress: eclat.Progress) -> None:
    print(progress.samples + 1)

scene = eclat.load(Path("a.gltf"))
picture = scene.render(error=0.02, size=(4, 3), adaptive=True, eye=(1, 2, 3), lanes=4, without=["emission"], progress=show)
picture.radiance.mean()
print((picture.bound or 1) + eclat.compare(picture, "b.png", fit_exposure=True).flip, eclat.cost("a.gltf", budget=3, scene=1)["rungs"])
"""


def debian():
    """Debian's version, "12.5"; empty on another system."""
    try:
        with open("/etc/debian_version", encoding="utf-8") as file:
            return file.read()
    except OSError:
        return ""


C_TYPES = {"double": "c_double", "int": "c_int", "uint32_t": "c_uint", "size_t": "c_ulong", "char": "c_char", "const char *": "c_char_p"}


class Declarations(unittest.TestCase):
    """The package's ctypes declarations match eclat.h."""

    @classmethod
    def setUpClass(cls):
        with open(os.path.join(SOURCE, "host", "include", "eclat", "eclat.h"), encoding="utf-8") as file:
            cls.header = re.sub(r"/\*.*?\*/", "", file.read(), flags=re.DOTALL)
        spec = importlib.util.spec_from_file_location("eclat._library", os.path.join(wheel.PROJECT, "eclat", "_library.py"))
        stub = types.ModuleType("eclat")
        stub.__path__ = [os.path.join(wheel.PROJECT, "eclat")]
        with mock.patch.dict(sys.modules, {"eclat": stub}):
            cls.library = importlib.util.module_from_spec(spec)
            spec.loader.exec_module(cls.library)

    def fields(self, struct):
        """Returns [(name, type)] of the header's struct; other types by their last word."""
        found = []
        for declaration in re.search(rf"typedef struct {struct} {{(.*?)}} {struct};", self.header, re.DOTALL)[1].split(";"):
            if pointer := re.search(r"\(\*(\w+)\)\(", declaration):
                found.append((pointer[1], "function"))
            elif words := re.match(r"\s*(const \w+ \*(?:const \*)?|\w+ \*?)\s*(.*)", declaration, re.DOTALL):
                found += [(name.strip(" *\n").split("[")[0], words[1].strip()) for name in words[2].split(",")]
        return found

    def test_structures(self):
        for name in ("eclat_error", "eclat_option", "eclat_progress", "eclat_listener", "eclat_picture_error", "eclat_stated_error", "eclat_denoised", "eclat_channel", "eclat_attribute"):
            mine, theirs = getattr(self.library, name)._fields_, self.fields(name)
            self.assertEqual([field for field, _ in mine], [field for field, _ in theirs], name)
            for (field, kind), (_, declared) in zip(mine, theirs):
                if declared in C_TYPES and field != "text":
                    self.assertEqual(kind.__name__, C_TYPES[declared], f"{name}.{field}")

    def test_functions(self):
        for name, (_, *arguments) in self.library._FUNCTIONS.items():
            declared = re.search(rf"\b{name}\((.*?)\);", self.header, re.DOTALL)[1]
            self.assertEqual(len(arguments), len(declared.split(",")), name)

    def test_numbers(self):
        for enum, names in (("eclat_result", ("OK", "FAILED", "USAGE")), ("eclat_severity", ("STATUS", "NOTE", "WARNING", "FAILURE"))):
            declared = re.search(rf"typedef enum {enum} {{(.*?)}}", self.header, re.DOTALL)[1]
            self.assertEqual([word.split("=")[0].strip() for word in declared.split(",")], ["ECLAT_" + name for name in names])
            self.assertEqual([getattr(self.library, name) for name in names], list(range(len(names))))
        kinds = re.search(r"typedef enum eclat_error_kind {(.*?)}", self.header, re.DOTALL)[1].split(",")
        self.assertEqual([kind.strip()[12:].lower().replace("_", " ") for kind in kinds], list(self.library.ERROR_KINDS))


class Wheel(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.venv = wheel.Environment(cls)
        cls.wheel = wheel.make(cls.venv)
        cls.venv.pip("install", "-q", cls.wheel, "mypy", "tqdm")
        cls.package = os.path.join(cls.venv.packages(), "eclat")
        with zipfile.ZipFile(cls.wheel) as archive:
            cls.names = archive.namelist()

    def run_here(self, *words, **env):
        return wheel.run(*words, cwd=self.venv.folder, env=wheel.outside(**env))

    def test_it_is_for_any_python_3_on_linux(self):
        self.assertRegex(os.path.basename(self.wheel), r"^eclat-[\d.]+-py3-none-manylinux_2_\d+_x86_64\.whl$")
        version = self.run_here(self.venv.program("eclat"), "--version").stdout.split()[1]
        self.assertEqual(os.path.basename(self.wheel).split("-")[1], version)

    @unittest.skipUnless(debian().startswith("12."), "not built on Debian 12")
    def test_it_asks_for_no_newer_glibc_than_it_has_to(self):
        self.assertIn("manylinux_2_34_", self.wheel)  # the manual states this

    def test_everything_is_inside(self):
        """The linker finds everything that the programs and the library need in the environment, or in what every Linux has."""
        for file in ("libeclat.so.0", "eclat", "eclat-compile"):
            needs = self.run_here("ldd", os.path.join(self.package, file)).stdout
            self.assertNotIn("not found", needs, file)
            found = dict(re.findall(r"(\S+) => (/\S+)", needs))
            self.assertIn("libc.so.6", found)
            for name, path in found.items():
                if not re.fullmatch(EVERYWHERE, name):
                    self.assertTrue(os.path.realpath(path).startswith(os.path.realpath(self.venv.folder)), f"{file} takes {path}")

    def test_licences_go_along(self):
        licences = {os.path.basename(name) for name in self.names if "/licenses/" in name}
        for library in (name for name in self.names if name.startswith("eclat.libs/")):
            stem = re.match(r"eclat\.libs/lib(\w+?)(16|Core)?(-3_1)?-[0-9a-f]{8}\.so", library)[1].lower()
            stem = {"iex": "openexr", "ilmthread": "openexr", "opencl": "ocl-icd"}.get(stem, stem)
            self.assertTrue([name for name in licences if stem in name], f"{library} has no licence among {licences}")
        self.assertIn("LICENSE", licences)

    def test_nothing_of_the_build_is_in_use(self):
        code = f"import eclat; eclat.load({CORNELL!r}).render(spp=8, size=(8, 8)); print(open('/proc/self/maps').read())"
        done = self.run_here(self.venv.python, "-c", code)
        self.assertEqual(done.returncode, 0, done.stderr)
        files = {line.split(None, 5)[5] for line in done.stdout.splitlines() if line.count(" /")}
        self.assertTrue([name for name in files if name.endswith("eclat/libeclat.so.0")])
        kernels = support.ENVIRONMENT["XDG_CACHE_HOME"]  # the driver maps these files
        build = os.path.realpath(wheel.BUILD) + os.sep
        self.assertEqual([name for name in files if name.startswith(build) and not name.startswith(os.path.realpath(kernels))], [])

    def test_the_command_is_the_program(self):
        for words in (["--help"], ["render", "--help"], ["help", "--man"], ["info", CORNELL, "--json"]):
            mine, built = self.run_here(self.venv.program("eclat"), *words), support.eclat(*words)
            strip = re.compile(r'"(?:load|build|total)\w*seconds":[\d.e-]+|"\w*seconds":[\d.e-]+|"\w*peak\w*":\d+')
            self.assertEqual((mine.returncode, strip.sub("", mine.stdout)), (built.returncode, strip.sub("", built.stdout)), words)
        refused = self.run_here(self.venv.program("eclat"), "render", "nothing.gltf")
        self.assertEqual((refused.returncode, refused.stderr.count("\n")), (1, 1), refused.stderr)

    def test_the_command_compiles_beside_as_well(self):
        """eclat-compile is where the library looks for it."""
        self.assertTrue(os.access(os.path.join(self.package, "eclat-compile"), os.X_OK))
        cache = os.path.join(self.venv.folder, "cache")
        done = self.run_here(self.venv.program("eclat"), "render", CORNELL, "--size", "16x16", "--spp", "8", "--json", "-o", "a.exr", XDG_CACHE_HOME=cache,
                             POCL_CACHE_DIR=os.path.join(cache, "pocl"), ECLAT_COMPILE="beside", ECLAT_KERNELS="")
        self.assertEqual(done.returncode, 0, done.stderr)
        report = json.loads(done.stdout)
        if "Portable Computing Language" not in report["device"]["platform"]:
            self.skipTest("this driver does not compile at the first launch")
        self.assertEqual(report["first_kernels"], "narrow")

    def test_types(self):
        for name, code, wrong in (("good.py", TYPED, None), ("bad.py", TYPED.replace("adaptive", "adaptve"), "adaptve"),
                                  ("worse.py", TYPED.replace("eye=(1, 2, 3)", "eye=object()"), "eye")):
            with open(os.path.join(self.venv.folder, name), "w", encoding="utf-8") as file:
                file.write(code)
            done = self.run_here(self.venv.program("mypy"), "--strict", name)
            self.assertEqual(done.returncode, 1 if wrong else 0, done.stdout)
            self.assertIn(wrong or "Success", done.stdout)
        package = self.run_here(self.venv.program("mypy"), "--strict", "-p", "eclat")
        self.assertEqual(package.returncode, 0, package.stdout)

    def test_public_names_are_documented(self):
        code = ("import eclat, inspect\nfor name in eclat.__all__:\n    one = getattr(eclat, name)\n    assert inspect.getdoc(one), name\n"
                "    for part, member in vars(one).items() if inspect.isclass(one) else ():\n"
                "        assert part.startswith('_') or not (callable(member) or isinstance(member, property)) or inspect.getdoc(member), (name, part)\n")
        done = self.run_here(self.venv.python, "-c", code)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_importing_it_does_nothing_yet(self):
        """Importing loads no library and no driver, and sets no variable."""
        code = "import eclat, os\nprint(eclat.__version__, 'libeclat' in open('/proc/self/maps').read(), os.environ.get('OCL_ICD_VENDORS'))\n" \
               "eclat.devices()\nprint(os.environ.get('OCL_ICD_VENDORS'))"
        version = re.search(r"eclat-([\d.]+)-", self.wheel)[1]
        self.assertEqual(self.run_here(self.venv.python, "-c", code).stdout.split(), [version, "False", "None", "None"])

    def test_pictures(self):
        wheel.run_tests(self, self.venv, "pictures.py", **denoiser.environment_or_none())

    def test_jobs(self):
        wheel.run_tests(self, self.venv, "jobs.py")


if __name__ == "__main__":
    unittest.main()
