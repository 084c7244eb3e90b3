# tier: long
"""Runs the Containerfile's commands one by one, each stage in a chroot of its own."""
import os
import re
import shutil
import unittest

import debian
import support


def stages():
    """Returns lists of (instruction, words)."""
    with open(os.path.join(support.SOURCE, "Containerfile"), encoding="utf-8") as file:
        text = re.sub(r"^#.*\n", "", file.read(), flags=re.M)
    for line in filter(None, text.splitlines()):
        instruction, words = line.split(" ", 1)
        if instruction == "FROM":
            stage = []
            yield words.split(" AS ")[-1], stage
        else:
            stage.append((instruction, words))


class Container(debian.Case):
    def test_its_commands(self):
        roots = {}
        for name, steps in list(stages()):
            chroot = roots[name] = self.fresh("bookworm", f"container-{len(roots)}")
            folder = "/"
            for instruction, words in steps:
                if instruction == "RUN":
                    self.ok(chroot, "sh", "-c", f"cd {folder} && {{ {words}; }} >/tmp/log 2>&1 || {{ tail -n 40 /tmp/log; exit 1; }}")
                elif instruction == "COPY" and words == ". /src":
                    chroot.copy_sources()
                elif instruction == "COPY":
                    stage, files, target = re.fullmatch(r"--from=(\S+) (\S+) (\S+)", words).groups()
                    os.makedirs(chroot.inside(target))
                    shutil.copy(debian.made(roots[stage].inside(os.path.dirname(files)), os.path.basename(files)), chroot.inside(target))
                elif instruction == "WORKDIR":
                    folder = words
                    os.makedirs(chroot.inside(words), exist_ok=True)
                else:
                    self.assertIn(instruction, ("ENTRYPOINT", "CMD"))
        self.assertIn("*  0", self.ok(chroot, "eclat", "devices"))
        self.assertTrue(self.ok(chroot, "eclat", "--help").startswith("Usage: eclat COMMAND"))
        self.assert_renders(chroot)


if __name__ == "__main__":
    unittest.main()
