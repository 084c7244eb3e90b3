"""Debian in a folder: tools/release builds in it, and tests/packages tries packages in it. Only the folder is changed: mounts and binary formats
are private to each command. Needs root, debootstrap and Debian's archive."""
import os
import shutil
import subprocess

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
BUILD = os.environ.get("ECLAT_BUILD", os.path.join(ROOT, "build"))
FOLDER = os.environ.get("ECLAT_CHROOTS", os.path.join(BUILD, "chroots"))

# Everything is private to the command: its mounts end with it.
ENTER = 'mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" && mount --rbind /sys "$0/sys" && exec chroot "$0" "$@"'
# Runs as root of a user namespace with its own binary formats (Linux 6.7): only there does QEMU run programs of AArch64.
ENTER_EMULATED = r"""mount -t binfmt_misc binfmt_misc /proc/sys/fs/binfmt_misc || exit 77
printf '%s' ':eclat-aarch64:M::\x7fELF\x02\x01\x01\x00\x00\x00\x00\x00\x00\x00\x00\x00\x02\x00\xb7\x00:"""\
    r"""\xff\xff\xff\xff\xff\xff\xff\x00\xff\xff\xff\xff\xff\xff\xff\xff\xfe\xff\xff\xff:/usr/bin/qemu-aarch64-static:FP' \
    >/proc/sys/fs/binfmt_misc/register || exit 77
mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" && mount --rbind /sys "$0/sys" && exec chroot "$0" "$@"
"""


class Unavailable(Exception):
    """The reason why there is no Debian to work in."""


def check(*programs):
    if os.geteuid() != 0:
        raise Unavailable("making a chroot needs root")
    for program in ("debootstrap", "unshare", *programs):
        if not shutil.which(program):
            raise Unavailable(f"{program} is not installed; run tools/install-dependencies chroots")
    if subprocess.run(["unshare", "-m", "true"], capture_output=True).returncode:
        raise Unavailable("mounts are forbidden here")


def base(suite, *options, name=None):
    """Returns a tar of a minimal Debian, which is made once."""
    check()
    name = name or suite
    tar, new = (os.path.join(FOLDER, name + end) for end in (".tar", ".new"))
    if os.path.exists(tar):
        return tar
    shutil.rmtree(new, ignore_errors=True)
    os.makedirs(FOLDER, exist_ok=True)
    run = subprocess.run(["debootstrap", "--variant=minbase", *options, suite, new], capture_output=True, text=True)
    if run.returncode:
        shutil.rmtree(new, ignore_errors=True)
        raise Unavailable(f"debootstrap cannot make a {suite}: {(run.stdout + run.stderr).strip().splitlines()[-1]}")
    subprocess.run(["tar", "-C", new, "-cf", tar + ".part", "."], check=True)
    os.rename(tar + ".part", tar)
    shutil.rmtree(new)
    return tar


class Chroot:
    """The folder `name`, unpacked from a tar of base() unless it exists."""

    def __init__(self, name, tar, emulated=False):
        self.path = os.path.join(FOLDER, name)
        self.emulated = emulated
        if not os.path.exists(self.path):
            os.makedirs(self.path)
            subprocess.run(["tar", "-C", self.path, "-xf", tar], check=True)
        os.makedirs(self.inside("etc/apt/apt.conf.d"), exist_ok=True)
        with open(self.inside("etc/apt/apt.conf.d/90eclat"), "w", encoding="utf-8") as file:  # a mirror may be out of date; signatures are still checked
            file.write('Acquire::Check-Valid-Until "false";\n')
        for name in ("resolv.conf", "hosts"):
            if os.path.exists("/etc/" + name):
                shutil.copyfile("/etc/" + name, self.inside("etc", name))

    def inside(self, *names):
        return os.path.join(self.path, *(name.lstrip("/") for name in names))

    def command(self, *words, env=None):
        variables = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root", "LC_ALL": "C.UTF-8", "DEBIAN_FRONTEND": "noninteractive", **(env or {})}
        # The emulator passes its own environment on.
        names = ["unshare", "-m", "-p", "-f", "--kill-child", *(["-r", "--mount-proc"] if self.emulated else [])]
        return ["env", "-i", *(f"{key}={value}" for key, value in variables.items()), *names,
                "sh", "-c", ENTER_EMULATED if self.emulated else ENTER, self.path, *words]

    def run(self, *words, env=None, **options):
        """Runs one command. Returns its stdout and stderr as text; raises nothing if it fails."""
        options.setdefault("capture_output", True)
        return subprocess.run(self.command(*words, env=env), text=True, stdin=subprocess.DEVNULL, **options)

    def do(self, *words, env=None):
        """Runs a command that must succeed, as a step of making something."""
        run = self.run(*words, env=env, capture_output=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if run.returncode:
            raise SystemExit("\n".join(run.stdout.splitlines()[-40:]) + f"\nin a chroot: {' '.join(words)}: exit code {run.returncode}")
        return run.stdout

    def install(self, *packages):
        if self.run("apt-get", "-q", "update").returncode:
            raise Unavailable("apt-get update finds no archive")
        return self.do("apt-get", "-q", "install", "-y", "--no-install-recommends", *packages)

    def copy_sources(self, to="/src"):
        """Copies what git would commit. Deleted files are deleted there too; build folders stay."""
        os.makedirs(self.inside(to), exist_ok=True)
        files = subprocess.run(["git", "-C", ROOT, "ls-files", "-co", "--exclude-standard", "-z"], capture_output=True, check=True).stdout
        names = [name for name in files.split(b"\0") if name and os.path.lexists(os.path.join(ROOT.encode(), name))]
        keep = {os.path.join(self.inside(to).encode(), name) for name in names}
        for folder, folders, present in os.walk(self.inside(to).encode()):
            folders[:] = [name for name in folders if not name.startswith(b"build")]
            for name in present:
                if os.path.join(folder, name) not in keep:
                    os.remove(os.path.join(folder, name))
        tar = subprocess.Popen(["tar", "-C", ROOT, "--null", "--no-recursion", "-T", "-", "-cf", "-"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        unpack = subprocess.Popen(["tar", "-C", self.inside(to), "--no-same-owner", "-xf", "-"], stdin=tar.stdout)
        tar.stdout.close()
        tar.stdin.write(b"\0".join(names))
        tar.stdin.close()
        if tar.wait() or unpack.wait():
            raise SystemExit(f"the sources could not be copied to {self.inside(to)}")

    def remove(self):
        shutil.rmtree(self.path, ignore_errors=True)
