# tiers: quick, full
"""Checkpoints when things go wrong: processes killed at any moment, disks that fail, files that were changed."""
import hashlib
import json
import os
import random
import re
import resource
import signal
import unittest

from faults import FaultCase, at_once, spread
from support import SOURCE, eclat, read_exr
from tiers import full

KILLS = 100
CHAINS = 2
AGAIN_AND_AGAIN = ["clEnqueueNDRangeKernel", "clEnqueueReadBuffer", "pwrite", "fsync", "rename"]
MARK = b"eclat: sealed by SHA-256\n"
CORPUS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "corpus", "checkpoint")
STRAY = r"^\.eclat-\d+-[0-9a-f]{8}\.tmp$"


class CheckpointFaults(FaultCase):
    def setUp(self):
        super().setUp()
        self.job = ["--spp", "1000000"]

    def samples(self, path):
        """Returns the samples of the checkpoint's picture, which eclat must be able to read; 0 where there is none yet."""
        if not os.path.exists(path):
            return 0
        run = self.assert_ok(eclat("merge", path, "--partial", "-q", "--json", "-o", path + ".merged.exr"))
        return json.loads(run.stdout)["samples_per_pixel"]

    def finish(self, kept, samples):
        """Returns image_sha256 of the resumed job, and of one without a break."""
        render = ["--json", "-q", "--spp", str(samples)]
        again = eclat("render", "--resume", kept, *render, "-o", kept + ".a.exr")
        whole = eclat("render", self.scene, "--size", "8x8", "--max-depth", "3", *render, "-o", kept + ".b.exr")
        return [json.loads(self.assert_ok(run).stdout)["image_sha256"] for run in [again, whole]]

    def chain(self, seed):
        """Kills one job and resumes it, again and again."""
        dice, done, kept, kills = random.Random(seed), 0, None, 0
        folder = self.new_folder(f"chain{seed}", old=False)
        kept = os.path.join(folder, "kept.exr")
        everywhere = {"FAULT_FOLDER": self.folder + "/"}
        _, counted = self.run_with(f"counted{seed}", "--checkpoint", kept, "--every", "0.001s", spp=32, env=everywhere)
        counts = {call: count for call, count in self.counts(counted).items() if call in AGAIN_AND_AGAIN}
        os.remove(kept)
        while kills < KILLS // CHAINS:
            call, = dice.choices(list(counts), list(counts.values()))
            run, _ = self.run_with(f"run{seed}-{kills}", "--resume" if done else "--checkpoint", kept, "--every", "0.001s", spp=1000000,
                                   env=everywhere, call=call, at=dice.randint(1, counts[call]), signal=int(signal.SIGKILL))
            self.assertEqual((run.returncode, run.stderr), (-signal.SIGKILL, ""))
            for name in os.listdir(folder):  # left when killed while the new file replaces the old one
                self.assertRegex(name, rf"kept\.exr|{STRAY}")
            now = self.samples(kept)
            self.assertGreaterEqual(now, done)
            if now:
                os.remove(kept + ".merged.exr")
            done, kills = now, kills + 1
        self.assertGreater(done, 32)
        again, whole = self.finish(kept, done + 5)
        self.assertEqual(again, whole)
        return done

    @full
    def test_killed_a_hundred_times(self):
        at_once(self.chain, [(seed,) for seed in range(CHAINS)])

    @full
    def test_killed_at_any_call(self):
        """With a checkpoint after every batch, the previous one survives: at most one batch is lost."""
        kept = os.path.join(self.path("counted"), "kept.exr")
        _, folder = self.run_with("counted", "--checkpoint", kept, "--every", "0.0000001s", spp=6)
        counts = self.counts(folder)
        self.assertGreaterEqual(counts["fsync"], 6)

        def kill(call, n):
            name = f"{call}{n}"
            path = os.path.join(self.path(name), "kept.exr")
            run, _ = self.run_with(name, "--checkpoint", path, "--every", "0.0000001s", spp=6, call=call, at=n, signal=signal.SIGKILL)
            self.assertEqual(run.returncode, -signal.SIGKILL)
            whole = {"rename": n, "fsync": n - 1}.get(call, 0)  # the first file replaces no other
            with self.subTest(call=call, n=n):
                self.assertGreaterEqual(self.samples(path), min(whole, 6))
                if self.samples(path):
                    self.assertEqual(*self.finish(path, 6))
        at_once(kill, [(call, n) for call in ["pwrite", "fsync", "rename", "linkat"] for n in spread(counts[call], 5)])

    def test_a_disk_that_fails_once(self):
        """The render continues, and the next checkpoint is written."""
        for call, code in [("pwrite", 28), ("fsync", 5), ("rename", 5)]:
            path = os.path.join(self.path(call), "kept.exr")
            run, folder = self.run_with(call, "--checkpoint", path, "--every", "0.0000001s", spp=5, quiet=False, call=call, at=3, code=code)
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertRegex(run.stderr, rf"warning: cannot write '{path}': .*; the render goes on, and the checkpoint will be tried again")
            self.assertEqual(self.samples(path), 5)

    def test_a_full_disk(self):
        """The previous checkpoint stays. The picture is written if there is room, and the exit code tells that something is missing."""
        kept, image = self.path("kept.exr"), self.path("a.png")
        begun = ["render", self.scene, "--size", "256x256", "--max-depth", "3", "-q", "-o", image]
        self.assert_ok(eclat(*begun, "--spp", "2", "--checkpoint", kept))
        with open(kept, "rb") as file:
            before = file.read()
        run = eclat("render", "--resume", kept, "--spp", "4", "-q", "-o", image,
                    preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (2 << 20, 2 << 20)))
        self.assertEqual(run.returncode, 1)
        self.assertRegex(run.stderr.splitlines()[-1], rf"error: cannot write '{kept}': File too large; raise .*; the picture is written")
        with open(kept, "rb") as file:
            self.assertEqual(before, file.read())

    def make(self):
        kept = self.path("kept.exr")
        self.assert_ok(eclat("render", self.scene, "--size", "8x8", "--max-depth", "3", "--spp", "18", "-q", "--checkpoint", kept,
                             "-o", self.path("a.png")))
        with open(kept, "rb") as file:
            return kept, file.read()

    def refused(self, kept, data):
        with open(kept, "wb") as file:
            file.write(data)
        for arguments in [["render", "--resume", kept, "--spp", "20", "-q", "-o", self.path("b.png")], ["merge", kept, "-q", "-o", self.path("b.exr")]]:
            error = self.check_error(eclat(*arguments))
            self.assertIn(f"cannot read '{kept}': ", error)
        self.assertFalse(os.path.exists(self.path("b.exr")) or os.path.exists(self.path("b.png")))

    def test_cut_short_or_with_a_bit_turned(self):
        kept, data = self.make()
        dice = random.Random(4)
        for length in [0, 1, 100, len(data) // 2, len(data) - 1, *(dice.randrange(len(data)) for _ in range(10))]:
            self.refused(kept, data[:length])
        for place in [0, 4, len(data) - 1, len(data) - 40, *(dice.randrange(len(data)) for _ in range(20))]:
            self.refused(kept, data[:place] + bytes([data[place] ^ 1 << dice.randrange(8)]) + data[place + 1:])
        self.refused(kept, data + b"\0")
        self.refused(kept, self.path("a.png").encode())

    def test_of_another_version(self):
        """A checkpoint of independent batches, from before there were replicates."""
        with open(os.path.join(CORPUS, "format-1"), "rb") as file:
            data = file.read()
        kept = self.path("kept.exr")
        self.refused(kept, data + MARK + hashlib.sha256(data).digest())
        error = self.check_error(eclat("render", "--resume", kept, "-q", "-o", self.path("b.png")))
        form = json.loads(read_exr(self.make()[0])[0]["eclat.state"])["format"]
        self.assertIn(f"it was written by another version of eclat (format 1, this one reads {form}); use that version, or render it again", error)

    def test_seeds_are_of_this_version(self):
        """Seeds of an older version would be refused before anything in them is read."""
        form = json.loads(read_exr(self.make()[0])[0]["eclat.state"])["format"]
        for name in os.listdir(CORPUS):
            if name.endswith("-state") and name != "format-1-state":
                with open(os.path.join(CORPUS, name)) as file:
                    self.assertEqual(json.load(file)["format"], form, f"{name}: make them anew by seed_checkpoints.py")

    def test_forged(self):
        """A file that was changed and sealed again is read as it is, or refused; it never causes a crash."""
        kept, data = self.make()
        body, dice = data[:-len(MARK) - 32], random.Random(5)
        header = body.index(b"eclat.state")
        state = header, body.index(b"}", header + 1500)

        def forge(i, place, byte):
            forged = bytearray(body)
            forged[place] = byte
            path = self.path(f"{i}.exr")
            with open(path, "wb") as file:
                file.write(bytes(forged) + MARK + hashlib.sha256(forged).digest())
            run = eclat("merge", path, "--partial", "-q", "-o", self.path(f"{i}.out.exr"))
            with self.subTest(place=place, byte=byte):
                self.assertIn(run.returncode, [0, 1], run.stderr)
                if run.returncode:
                    self.check_error(run)
        places = [dice.randrange(len(body) // 4) for _ in range(60)] + [dice.randrange(*state) for _ in range(60)]
        at_once(forge, [(i, place, dice.choice([0, 255, 57, dice.randrange(256)])) for i, place in enumerate(places)])

    def test_forged_light(self):
        """The film of light paths in an adaptive render. A changed one is read as it is, or refused; missing samples are taken again."""
        kept = self.path("kept.exr")
        job = [os.path.join(SOURCE, "scenes", "ring", "ring.gltf"), "--size", "8x8", "--adaptive", "--light-paths", "0.0625"]
        self.assert_ok(eclat("render", *job, "--spp", "64", "-q", "--checkpoint", kept, "-o", self.path("a.png")))
        with open(kept, "rb") as file:
            body = file.read()[:-len(MARK) - 32]
        first, end = re.search(rb'"lightParts":(\[\[\d,\d\d\]\])', body).span(1)
        for parts in [b"[[0,00]]", b"[[0,99]]", b"[[1,31]]", b"[[9,32]]", b"[]      ", b"[[0,1]] ", b"[[0,16]]", b"[[0,,2]]", b'[["","]]']:
            forged = body[:first] + parts + body[end:]
            with open(kept, "wb") as file:
                file.write(forged + MARK + hashlib.sha256(forged).digest())
            run = eclat("render", "--resume", kept, "--spp", "80", "-q", "-o", self.path("b.png"))
            with self.subTest(parts=parts):
                if parts in (b"[]      ", b"[[0,1]] ", b"[[0,16]]"):
                    self.assert_ok(run)
                elif run.returncode:
                    self.assertIn(f"cannot read '{kept}': ", self.check_error(run))


if __name__ == "__main__":
    unittest.main()
