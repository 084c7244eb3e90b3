"""Finds the OpenCL devices, each with an environment in which only its implementation is visible.

An implementation is an .icd file: those of the system, or of OCL_ICD_VENDORS if that is set, and those that
tools/test --all-devices has put into BUILD/opencl."""
import glob
import json
import os
import subprocess

SYSTEM = "/etc/OpenCL/vendors"
LONGEST_START = 120  # seconds: a driver that takes longer to list its devices is left out


def icd_files(build):
    chosen = os.environ.get("OCL_ICD_VENDORS", SYSTEM)
    files = glob.glob(os.path.join(chosen, "*.icd")) if os.path.isdir(chosen) else [chosen]
    return sorted(files) + sorted(glob.glob(os.path.join(build, "opencl", "*.icd")))


def environment_of(icd):
    """Returns an environment with only this implementation. It sets no LD_LIBRARY_PATH: Intel's packages contain a loader, which would replace the system's."""
    environment = dict(os.environ, OCL_ICD_VENDORS=icd)
    environment.pop("ECLAT_DEVICE", None)
    environment.setdefault("RUSTICL_ENABLE", "llvmpipe")  # without it rusticl offers nothing
    return environment


def devices_of(eclat, environment):
    """Returns the devices as `eclat devices --json` lists them, and why there are none."""
    try:
        run = subprocess.run([eclat, "devices", "--json"], env=environment, capture_output=True, encoding="utf-8",
                             timeout=LONGEST_START, check=False)
    except subprocess.TimeoutExpired:
        return [], f"no answer in {LONGEST_START} s"
    if run.returncode:
        return [], (run.stderr.splitlines() or [f"exit code {run.returncode}"])[-1]
    found = json.loads(run.stdout)["devices"]
    return [device for device in found if device["available"] and device["compiler_available"]], "no device is available"


def find(eclat, build, say=lambda text: None):
    """Returns a list of (device, environment that chooses it). Says which implementations have no device."""
    found, seen = [], set()
    for icd in icd_files(build):
        if not os.path.exists(icd):
            continue
        environment = environment_of(icd)
        devices, why = devices_of(eclat, environment)
        if not devices:
            say(f"{icd} is left out: {why}")
        for device in devices:
            identity = (device["platform_version"], device["driver"], device["name"], device["index"])
            if identity not in seen:  # two files may name the same library
                seen.add(identity)
                found.append((device, dict(environment, ECLAT_DEVICE=str(device["index"]))))
    return found


def title(device):
    return f"{device['name']}, {device['platform']}"
