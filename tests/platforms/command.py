#!/usr/bin/env python3
"""Tests of the command on a platform that an emulator runs: what differs between systems, which is files and streams.

    command.py [--emulator PROGRAM] COMMAND

What it computes is compared with this system's bytes by scripts/fingerprint.py.
"""
import argparse
import contextlib
import os
import pathlib
import pty
import signal
import subprocess
import tempfile
import time
import unittest

POINTS = "0 0\n4 0\n4 3\n0 4\n1 1\n"
NAMES = ["plain", "with space", "José", "Дніпро", "三角形", "a" * 200]


class Files(unittest.TestCase):
    command = []

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        self.write("points.xy", POINTS)

    def tearDown(self):
        self.temporary.cleanup()

    def write(self, name, text):
        path = self.folder / name
        path.write_bytes(text.encode() if isinstance(text, str) else text)
        return path

    def run_command(self, *arguments, code=0, data=b"", **how):
        done = subprocess.run([*self.command, *map(str, arguments)], input=data, capture_output=True,
                              cwd=self.folder, timeout=120, **how)
        self.assertEqual(done.returncode, code, done.stderr.decode(errors="replace"))
        return done

    def names(self):
        return sorted(path.name for path in self.folder.iterdir())

    def test_names_in_any_script(self):
        plain = self.folder / "plain.off"
        self.run_command("triangulate", "points.xy", "-o", "plain.off")
        for name in NAMES:
            points, mesh = self.write(f"{name}.xy", POINTS), self.folder / f"{name}.off"
            self.run_command("triangulate", points, "-o", mesh)
            self.assertEqual(mesh.read_bytes(), plain.read_bytes(), name)
            self.run_command("verify", points, mesh)
            (self.folder / f"in {name}").mkdir()
            self.run_command("triangulate", points.name, "-o", f"in {name}/mesh.off")
            self.assertEqual((self.folder / f"in {name}" / "mesh.off").read_bytes(), plain.read_bytes(), name)

    def test_messages_name_files(self):
        done = self.run_command("triangulate", "Дніпро.xy", code=3)
        self.assertIn("Дніпро.xy: cannot be opened: No such file or directory", done.stderr.decode())
        self.assertIn("Is a directory", self.run_command("verify", ".", ".", code=2).stderr.decode() +
                      self.run_command("triangulate", self.make_folder("a.xy"), code=3).stderr.decode())
        done = self.run_command("triangulate", "points.xy", "-o", "nowhere/mesh.off", code=3)
        self.assertIn("No such file or directory", done.stderr.decode())
        self.assertEqual(self.names(), ["a.xy", "points.xy"])

    def make_folder(self, name):
        (self.folder / name).mkdir()
        return name

    def test_bytes_of_pipes(self):
        """Lines end with \\n in both directions, and \\x1a ends nothing."""
        printed = self.run_command("generate", "uniform", 2000, "-o", "-").stdout
        self.run_command("generate", "uniform", 2000, "-o", "generated.xy")
        self.assertEqual(printed, (self.folder / "generated.xy").read_bytes())
        self.assertNotIn(b"\r", printed)
        self.run_command("triangulate", "-", "-o", "from pipe.off", data=printed)
        self.run_command("triangulate", "generated.xy", "-o", "from file.off")
        self.assertEqual((self.folder / "from pipe.off").read_bytes(), (self.folder / "from file.off").read_bytes())
        done = self.run_command("triangulate", "-", data=b"0 0\n1 0\n0 1\n\x1a\n", code=3)
        self.assertIn("line 4", done.stderr.decode())
        # An array has bytes of all values.
        self.run_command("generate", "uniform", 2000, "-o", "generated.npy")
        self.run_command("triangulate", "generated.npy", "-o", "from array.off")
        self.assertEqual((self.folder / "from array.off").read_bytes(), (self.folder / "from file.off").read_bytes())

    def test_old_files_are_replaced_or_stay(self):
        mesh = self.write("mesh.off", "old")
        self.write("bad.xy", "0 0\nx 1\n")
        self.run_command("triangulate", "bad.xy", "-o", "mesh.off", code=3)
        self.assertEqual(mesh.read_text(), "old")
        self.run_command("triangulate", "points.xy", "-o", "mesh.off", "--triangles", "t.npy")
        self.assertTrue(mesh.read_bytes().startswith(b"OFF\n"))
        self.run_command("triangulate", "points.xy", "-o", "mesh.off", "--hull", "./mesh.off", code=2)
        self.run_command("triangulate", "points.xy", "-o", "points.xy", code=2)
        self.assertEqual(self.names(), ["bad.xy", "mesh.off", "points.xy", "t.npy"])

    def test_partitions(self):
        self.run_command("generate", "uniform", 3000, "-o", "points.npy")
        for more in [], ["--force"]:
            self.run_command("partition", "points.npy", "--levels=3", "-o", "розбиття", *more)
        self.run_command("assemble", "points.npy", "розбиття", "--solve", "--triangles", "assembled.npy")
        self.run_command("verify", "points.npy", "assembled.npy")

    def test_chunks_use_a_scratch_file(self):
        self.run_command("generate", "uniform", 30000, "-o", "points.xy")
        self.run_command("triangulate", "points.xy", "--triangles", "whole.npy")
        self.run_command("triangulate", "points.xy", "--chunk-points", "10000", "--triangles", "chunks.npy",
                         "--scratch", ".")
        self.run_command("verify", "points.xy", "chunks.npy")
        self.assertEqual(self.names(), ["chunks.npy", "points.xy", "whole.npy"])

    def test_what_is_interrupted_leaves_nothing(self):
        """Ctrl-C in a terminal. Wine does not pass the exit code on."""
        process, terminal = pty.fork()
        if process == 0:
            os.chdir(self.folder)
            signal.signal(signal.SIGINT, signal.SIG_DFL)  # which programs in the background ignore
            os.execvp(self.command[0], [*self.command, "generate", "uniform", "100000000", "-o", "many.npy"])
        deadline = time.monotonic() + 60
        while len(self.names()) == 1 and time.monotonic() < deadline:
            time.sleep(0.1)
        self.assertIn("many.npy.", "".join(self.names()))
        os.write(terminal, b"\x03")
        with contextlib.suppress(OSError):  # the terminal closes
            while os.read(terminal, 1000):
                pass
        os.close(terminal)
        os.waitpid(process, 0)
        self.assertEqual(self.names(), ["points.xy"])


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--emulator", default="")
    parser.add_argument("command", type=pathlib.Path)
    arguments, rest = parser.parse_known_args()
    Files.command = [*arguments.emulator.split(), str(arguments.command.resolve())]
    os.environ |= {"FLAUNAY_CACHE_DIR": "", "LC_ALL": "C.UTF-8", "TERM": "xterm"}
    unittest.main(argv=["command.py", *rest])
