#!/usr/bin/env python3
"""usage: tools/test --all-devices [options of ctest]

Runs tests on every OpenCL device: those of the system's drivers, and, on the CPU, PoCL, Intel's runtime and Mesa's
rusticl/llvmpipe, which it installs if they are missing and can be had. Without options it runs the kernel tests, the robustness tests
and some renders. On llvmpipe, whose compiler may take hours, it runs a small fixed set of tests, whatever the options. It ends with a
table, and exits with 1 if any test failed."""
import os
import re
import subprocess
import sys
import time
import xml.etree.ElementTree

import opencl_devices

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
BUILD = os.environ.get("ECLAT_BUILD", os.path.join(ROOT, "build"))
OWN = os.path.join(BUILD, "opencl")
INTEL = ["intel-opencl-rt", "intel-cmplr-lib-rt", "tbb"]

TOGETHER = "^robust/test_devices_agree$"  # runs on all devices by itself
USUAL = ["-R", "^(kernel/|robust/|stat/test_(same_bits|furnace|whitted)(\\.full)?$|image/test_cornell$|cli/test_devices$)",
         "-E", "oclgrind|test_devices_agree", "-LE", "^long$"]
# For llvmpipe. Without robust/selftest: its kernels have every effect, and compiling them takes many minutes. Without kernel/test_cl_cache: it gives
# the driver a broken binary, which ends the process in rusticl 22.3.6.
SLOW = ["-R", "^(kernel/test_(cl|cl_devices|cl_embed|rounding|layouts|texture|ray|kernels)|cli/test_devices)$"]


def say(text):
    print(f"tools/test: {text}", file=sys.stderr, flush=True)


def last_line(text):
    lines = [line for line in text.splitlines() if line.strip()]
    return lines[-1].strip() if lines else "no message"


def install_packages():
    run = subprocess.run([os.path.join(ROOT, "tools", "install-dependencies"), "devices"],
                         env=dict(os.environ, ECLAT_TOOL="tools/test"), check=False)
    if run.returncode:
        say("continuing with the drivers that are present")


def install_intel():
    """Installs Intel's runtime from PyPI into a virtual environment in the build folder, and writes an .icd file that names it."""
    icd, folder = os.path.join(OWN, "intel.icd"), os.path.join(OWN, "intel")
    if os.path.exists(icd):
        return
    if os.environ.get("ECLAT_SKIP_INSTALL"):
        say("ECLAT_SKIP_INSTALL is set; not installing: Intel's runtime (" + " ".join(INTEL) + ")")
        return
    say(f"installing with pip into {folder}: " + " ".join(INTEL))
    for command in ([sys.executable, "-m", "venv", folder], [os.path.join(folder, "bin", "pip"), "install", "-q", *INTEL]):
        run = subprocess.run(command, capture_output=True, encoding="utf-8", errors="replace", check=False)
        if run.returncode:
            say("continuing without Intel's runtime: " + last_line(run.stderr or run.stdout))
            return
    library = os.path.join(folder, "lib", "libintelocl.so")
    if not os.path.exists(library):
        say(f"continuing without Intel's runtime: the package has no {library}")
        return
    with open(icd + ".new", "w", encoding="utf-8") as file:
        file.write(library + "\n")
    os.rename(icd + ".new", icd)


def run_tests(name, environment, options):
    """Returns ctest's counts (passed, failed, skipped, minutes); None if it did not get that far."""
    report = os.path.join(OWN, name + ".xml")
    if os.path.exists(report):
        os.remove(report)
    jobs = str(min(os.cpu_count() or 1, 4))
    start = time.monotonic()
    subprocess.run(["ctest", "--test-dir", BUILD, "--output-on-failure", "--no-tests=error", "-j", jobs, "--output-junit", report,
                    "--output-log", os.path.join(OWN, name + ".log"), *options], env=environment, check=False)
    minutes = (time.monotonic() - start) / 60
    if not os.path.exists(report):
        return None
    suite = xml.etree.ElementTree.parse(report).getroot()
    total, failed, skipped = (int(suite.get(key)) for key in ("tests", "failures", "skipped"))
    return total - failed - skipped, failed, skipped, minutes


def print_table(rows):
    heads = ["device", "driver", "passed", "failed", "skipped", "minutes"]
    cells = [heads] + [[name, driver, *(("-",) * 4 if not r else (str(r[0]), str(r[1]), str(r[2]), f"{r[3]:.1f}"))]
                       for name, driver, r in rows]
    widths = [max(len(row[i]) for row in cells) for i in range(len(heads))]
    print()
    for row in cells:
        print("  ".join(cell.ljust(width) if i < 2 else cell.rjust(width)
                        for i, (cell, width) in enumerate(zip(row, widths))))


def main():
    options = sys.argv[1:]
    os.makedirs(OWN, exist_ok=True)
    install_packages()
    install_intel()
    found = opencl_devices.find(os.path.join(BUILD, "eclat"), BUILD, say)
    if not found:
        say("there is no OpenCL device")
    rows = []
    for device, environment in found:
        title = opencl_devices.title(device)
        say(f"on {title}")
        name = re.sub("[^A-Za-z0-9]+", "-", title).strip("-")
        slow = "llvmpipe" in device["name"]
        chosen = SLOW if slow else options or USUAL
        if slow and options:
            say("its small set of tests only, not " + " ".join(options))
        rows.append((title, device["driver"], run_tests(name, environment, chosen)))
    if not options and found:
        say("devices side by side")
        rows.append(("devices side by side", "", run_tests("together", dict(os.environ, ECLAT_SLOW_DEVICES="1"), ["-R", TOGETHER])))
    if rows:
        print_table(rows)
    say(f"logs and reports are in {OWN}")
    return 0 if rows and all(r and not r[1] for _, _, r in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
