"""Network namespaces that act as hosts for MPI. Each has a name, an address and shared memory of its own. Only the first sees `hidden`, a
folder."""
import os
import shutil
import subprocess


class Hosts:
    """`count` hosts on a bridge; use it in a `with`. OSError where namespaces are not permitted."""

    def __init__(self, count, folder, hidden):
        self.tag, self.count, self.folder, self.hidden, self.made = f"eclat{os.getpid()}", count, folder, hidden, []

    def ip(self, *arguments):
        run = subprocess.run(["ip", *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="utf-8")
        if run.returncode:
            raise OSError(f"ip {' '.join(arguments)}: {run.stdout.strip()}")

    def add(self, name):
        self.ip("netns", "add", name)
        self.made.append(name)
        self.ip("-n", name, "link", "set", "lo", "up")

    def address(self, i):
        return f"10.213.77.{i + 1}"

    def __enter__(self):
        if not shutil.which("ip") or not shutil.which("unshare"):
            raise OSError("no ip or unshare")
        try:
            switch = self.tag + "s"
            self.add(switch)
            self.ip("-n", switch, "link", "add", "bridge", "type", "bridge")
            self.ip("-n", switch, "link", "set", "bridge", "up")
            for i in range(self.count):
                host = f"{self.tag}h{i}"
                self.add(host)
                self.ip("-n", switch, "link", "add", f"port{i}", "type", "veth", "peer", "name", "net", "netns", host)
                self.ip("-n", switch, "link", "set", f"port{i}", "master", "bridge", "up")
                self.ip("-n", host, "address", "add", self.address(i) + "/24", "dev", "net")
                self.ip("-n", host, "link", "set", "net", "up")
            subprocess.run(["ip", "netns", "exec", host, "unshare", "--uts", "--ipc", "--mount", "true"], check=True)
        except (OSError, subprocess.CalledProcessError) as error:
            self.__exit__()
            raise OSError(str(error)) from error
        return self

    def __exit__(self, *_):
        for name in reversed(self.made):
            subprocess.run(["ip", "netns", "del", name], stderr=subprocess.DEVNULL)

    def on(self, i, hides):
        """The words that run a command on host i."""
        hide = f"mount -t tmpfs none {self.hidden} && " if hides else ""
        return ["ip", "netns", "exec", f"{self.tag}h{i}", "unshare", "--uts", "--ipc", "--mount", "sh", "-c", f'{hide}hostname host{i} && exec "$@"', "sh"]

    def mpirun(self, *arguments):
        """The command that starts mpirun on the first host, with one process on each. An agent in place of ssh reaches the others."""
        agent = os.path.join(self.folder, "agent")
        with open(agent, "w", encoding="utf-8") as file:
            file.write("#!/bin/sh\nhost=$1\nshift\ncase $host in\n")
            for i in range(1, self.count):
                words = " ".join("'" + word + "'" for word in self.on(i, True))
                file.write(f'{self.address(i)}) exec {words} sh -c "$*" ;;\n')
            file.write("esac\necho no host $host >&2\nexit 1\n")
        os.chmod(agent, 0o755)
        network = self.address(0).rsplit(".", 1)[0] + ".0/24"
        return [*self.on(0, False), "mpirun", "--host", ",".join(self.address(i) for i in range(self.count)), "-n", str(self.count), "--bind-to", "none",
                "--mca", "plm_rsh_agent", agent, "--mca", "oob_tcp_if_include", network, "--mca", "btl_tcp_if_include", network, "--mca", "btl", "tcp,self",
                "--mca", "pml", "ob1", "-x", "XDG_CACHE_HOME", *arguments]
