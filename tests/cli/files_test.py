"""What is written is whole or not there: full disks, limits of size, closed pipes, links, modes, names of any bytes."""
import gzip
import json
import os
import resource
import signal
import stat
import struct
import subprocess
import threading
import time
import unittest
import zlib
from pathlib import Path

import program
from program import SANITIZED, SCENE, SLOWNESS, ProgramTest, write_pfm

FAILED = 3  # what the program returns where a file cannot be written
SMALL = ["--resolution", "64x48", "--quiet"]


def limit_of_size(size):
    """For a process that is to find its disk full after that many bytes of a file."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


def limit_of_memory(size):
    """Options of subprocess.run() that end a process which takes more than that many bytes."""
    if not SANITIZED:
        return {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_AS, (size, size))}
    # Sanitizers reserve terabytes of address space, but limit memory themselves.
    limits = f"hard_rss_limit_mb={size >> 20}:max_allocation_size_mb={size >> 20}"
    names = "ASAN_OPTIONS", "TSAN_OPTIONS"
    return {"env": {**program.ENVIRONMENT, **{name: f"{os.environ.get(name, '')}:{limits}" for name in names}}}


class FilesTest(ProgramTest):
    def names(self):
        return sorted(path.name for path in self.folder.iterdir())

    def run_with(self, *arguments, status, **options):
        """Runs the program with options of subprocess.run(); returns what it said."""
        options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "env": program.ENVIRONMENT, **options}
        result = subprocess.run([program.PROGRAM, *map(os.fsencode, map(str, arguments))], cwd=self.folder,
                                timeout=120, check=False, **options)
        self.assertEqual(result.returncode, status, f"{arguments}\n{result}")
        return result

    def picture(self, name="in.pfm", side=48):
        """A picture that no codec makes small."""
        values = os.urandom(3 * side * side)
        data = struct.pack(f"<{3 * side * side}f", *(value / 255 for value in values))
        (self.folder / name).write_bytes(f"PF\n{side} {side}\n-1.0\n".encode() + data)
        return name

    def begin(self, *arguments, **options):
        process = self.start(*arguments, **options)
        for stream in process.stdout, process.stderr:
            if stream:
                self.addCleanup(stream.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def wait_for_handler(self, process):
        """Until the program is ready for signals, as far as the system tells."""
        while process.poll() is None:
            for line in Path(f"/proc/{process.pid}/status").read_text().splitlines():
                if line.startswith("SigCgt:") and int(line.split()[1], 16) & 1 << (signal.SIGINT - 1):
                    return
            time.sleep(0.002)


class FullDisk(FilesTest):
    def assert_old_file_stays(self, name, *arguments, limit=600, old="old"):
        (self.folder / name).write_text(old)
        before = self.names()
        result = self.run_with(*arguments, status=FAILED, preexec_fn=limit_of_size(limit))
        said = result.stderr.decode()
        self.assertEqual(said.count("cannot write"), 1, said)
        self.assertEqual(said.count("\n"), 1, said)
        self.assertIn(f"'{name}': File too large", said)
        self.assertEqual((self.folder / name).read_text(), old)
        self.assertEqual(self.names(), before)

    def test_every_format_of_a_render_is_checked(self):
        for kind in "png", "jpg", "exr", "hdr", "pfm":
            with self.subTest(kind=kind):
                self.assert_old_file_stays(f"a.{kind}", "render", SCENE, *SMALL, "--spp", "1", "-o", f"a.{kind}")

    def test_a_file_that_fails_does_not_keep_the_others_from_being_written(self):
        # Only the .pfm files are larger than the limit.
        self.run_program("render", SCENE, *SMALL, "--spp", "1", "-o", "whole.png", "-o", "whole.jpg")
        for name in "a.pfm", "b.png", "c.pfm", "d.jpg":
            (self.folder / name).write_text("old")
        before = self.names()
        result = self.run_with("render", SCENE, *SMALL, "--spp", "1", *(f"-o{n}" for n in ("a.pfm", "b.png", "c.pfm", "d.jpg")),
                               status=FAILED, preexec_fn=limit_of_size(30000))
        lines = result.stderr.decode().splitlines()
        self.assertEqual(len(lines), 2, lines)
        for line, name in zip(lines, ("a.pfm", "c.pfm")):
            self.assertIn(f"'{name}': File too large", line)
            self.assertEqual((self.folder / name).read_text(), "old")
        for name, whole in ("b.png", "whole.png"), ("d.jpg", "whole.jpg"):
            self.assertEqual((self.folder / name).read_bytes(), (self.folder / whole).read_bytes())
        self.assertEqual(self.names(), before)

    def test_the_files_of_other_verbs_are_checked(self):
        one, other = self.picture(), self.picture("other.pfm")
        self.assert_old_file_stays("a.png", "tonemap", one, "-o", "a.png")
        self.assert_old_file_stays("a.jpg", "tonemap", one, "-o", "a.jpg")
        self.assert_old_file_stays("map.png", "diff", one, other, "-o", "map.png")
        self.assert_old_file_stays("map.exr", "diff", one, other, "-o", "map.exr")
        integral = ["integrate", "x", "--over", "x=0:1", "--method", "uniform:passes=64", "--samples", "6400", "--quiet"]
        integrals, run = '{"format": "montelux integrals"', '{"format": "montelux comparison"'  # saved work replaces its like
        self.assert_old_file_stays("run.json", *integral, "--save", "run.json", old=integrals)
        for seed in 1, 2:
            self.run_program(*integral, "--seed", seed, "--save", f"{seed}.json")
        self.assert_old_file_stays("both.json", "merge", "1.json", "2.json", "--quiet", "-o", "both.json", old=integrals)
        comparison = ["compare", SCENE, *SMALL, "-a", "path", "-b", "naive", "--spp", "1", "--repeats", "2", "--no-cache",
                   "--no-slopes", "--no-attribution"]
        self.assert_old_file_stays("run.json", *comparison, "--save", "run.json", old=run)
        (self.folder / "own.pbrt").write_bytes(SCENE.read_bytes())
        for other in (["--save", "1.json"], ["--save", "a.exr"], ["-o", "other.pfm"], ["-o", "own.pbrt"]):
            self.assertIn("cannot write", self.run_program(*comparison, *other, status=2).stderr)
        for other in "run.json", "other.pfm", "own.pbrt":
            self.assertIn("cannot write", self.run_program(*integral, "--save", other, status=2).stderr)
        self.assertEqual((self.folder / "own.pbrt").read_bytes(), SCENE.read_bytes())

    def test_the_files_of_a_report_are_checked(self):
        # Its status was 2 as for input that cannot be used; a full disk is detected only after the work.
        result = self.run_with("lab", "run", "roulette", "-q", "-o", "out", status=FAILED, preexec_fn=limit_of_size(600))
        self.assertIn(b"cannot write", result.stderr)
        self.assertEqual([p for p in (self.folder / "out").rglob("*") if p.name.startswith(".")], [])

    def test_a_full_standard_output_is_an_error(self):
        self.picture("a.pfm")
        self.run_program("integrate", "x", "--over", "x=0:1", "--quiet", "--save", "a.json", "--samples", "1000")
        for arguments in (
            ["info", SCENE], ["list"], ["list", "materials"], ["lab", "list"], ["completion", "bash"], ["--help"],
            ["render", "--help"], ["--version"], ["integrate", "x", "--over", "x=0:1", "--samples", "1000"],
            ["merge", "a.json"], ["diff", "a.pfm", "a.pfm"], ["render", SCENE, *SMALL, "--spp", "1", "--json"],
            ["render", SCENE, *SMALL, "--spp", "1", "--frames", "0:2", "--json"],
        ):
            with self.subTest(arguments=arguments), open("/dev/full", "wb") as full:
                result = self.run_with(*arguments, status=FAILED, stdout=full)
                self.assertIn(b"cannot write the results to standard output", result.stderr)
        with self.subTest("closed"):
            result = self.run_with("list", status=FAILED, preexec_fn=lambda: os.close(1))
            self.assertIn(b"cannot write the results", result.stderr)
        self.assertTrue((self.folder / "first-light.exr").exists())

    def test_a_full_standard_error_changes_nothing(self):
        with open("/dev/full", "wb") as full:
            self.run_with("render", SCENE, "--resolution", "64x48", "--spp", "1", "-o", "a.png", status=0, stderr=full)
            self.run_with("render", "none.pbrt", status=2, stderr=full)
        self.assertEqual(self.names(), ["a.png"])


class Outputs(FilesTest):
    def mode(self, name):
        return stat.S_IMODE((self.folder / name).stat().st_mode)

    def test_new_files_have_the_mode_of_the_umask_and_replaced_ones_keep_theirs(self):
        picture = self.picture()
        for umask, mode in (0o022, 0o644), (0o077, 0o600), (0o002, 0o664):
            self.run_with("tonemap", picture, "-o", "a.png", status=0, preexec_fn=lambda: os.umask(umask))
            self.assertEqual(self.mode("a.png"), mode)
            (self.folder / "a.png").unlink()
        (self.folder / "a.png").write_text("old")
        (self.folder / "a.png").chmod(0o640)
        self.run_with("tonemap", picture, "-o", "a.png", status=0)
        self.assertEqual(self.mode("a.png"), 0o640)
        self.assertEqual((self.folder / "a.png").read_bytes()[:4], b"\x89PNG")

    def test_a_link_is_followed(self):
        picture = self.picture()
        (self.folder / "far").mkdir()
        for target in "far/a.png", "far/new.png":
            (self.folder / "far/a.png").write_text("old")
            link = self.folder / "link.png"
            link.symlink_to(target)
            self.run_program("tonemap", picture, "-o", "link.png")
            self.assertTrue(link.is_symlink())
            self.assertEqual((self.folder / target).read_bytes()[:4], b"\x89PNG")
            link.unlink()
        (self.folder / "round.png").symlink_to("round.png")
        self.assertIn("round.png", self.run_program("tonemap", picture, "-o", "round.png", status=2).stderr)
        self.assertEqual(sorted(p.name for p in (self.folder / "far").iterdir()), ["a.png", "new.png"])

    def test_a_fifo_and_a_device_are_written_to(self):
        picture = self.picture()
        fifo = self.folder / "fifo.png"
        os.mkfifo(fifo)
        read = []
        reader = threading.Thread(target=lambda: read.append(fifo.read_bytes()), daemon=True)
        reader.start()
        self.run_program("tonemap", picture, "-o", "fifo.png")
        reader.join(10)
        self.run_program("tonemap", picture, "-o", "file.png")
        self.assertEqual(read, [(self.folder / "file.png").read_bytes()])
        self.assertTrue(fifo.is_fifo())
        integral = ["integrate", "x", "--over", "x=0:1", "--samples", "1000", "--quiet", "--save"]
        self.run_program(*integral, "/dev/null")
        self.assertTrue(Path("/dev/null").is_char_device())
        saved, _ = json.JSONDecoder().raw_decode(self.run_program(*integral, "/dev/stdout").stdout)
        self.assertEqual(saved["format"], "montelux integrals")

    def test_names_as_long_as_the_system_takes_are_written(self):
        picture = self.picture()
        name = "n" * 251 + ".png"
        self.run_program("tonemap", picture, "-o", name)
        self.assertIn(name, self.names())
        long = "n" * 252 + ".png"
        self.assertIn("File name too long", self.run_program("tonemap", picture, "-o", long, status=2).stderr)

    def test_files_are_probed_before_the_work(self):
        folder = self.folder / "closed"
        folder.mkdir()
        (self.folder / "file").touch()
        names = ["none/a", "file/a", "n" * 256]
        if os.geteuid() != 0:
            folder.chmod(0o500)
            names.append("closed/a")
        long_integral = ["integrate", "x", "--over", "x=0:1", "--time", "1h", "--save"]
        comparison = ["compare", SCENE, "-a", "path", "-b", "naive", "--time", "1h", "--no-cache"]
        for name in names:
            with self.subTest(name=name):
                for arguments in (long_integral + [name], comparison + ["--save", name], comparison + ["-o", name],
                                  ["merge", "none.json", "-o", name], ["lab", "run", "all", "-o", name],
                                  ["render", SCENE, "--time", "1h", "-o", name + ".png"]):
                    if arguments[0] == "lab" and name == "none/a":
                        continue  # a folder that is made
                    said = self.run_program(*arguments, status=2).stderr
                    self.assertIn(name, said)
        self.assertEqual(self.names(), ["closed", "file"])


class Names(FilesTest):
    ODD = b"odd\xff\xe9.pbrt"

    def scene(self):
        path = os.path.join(os.fsencode(self.folder), self.ODD)
        with open(path, "wb") as file:
            file.write(SCENE.read_bytes())
        return os.fsdecode(self.ODD)

    def test_json_names_files_that_are_not_utf8(self):
        scene = self.scene()
        result = self.run_with("render", scene, *SMALL, "--spp", "1", "--json", "-o", os.fsdecode(b"\xfe.png"), status=0)
        stated = json.loads(result.stdout.decode("utf-8", errors="strict"))
        self.assertEqual(stated["scene"], "odd\\xff\\xe9.pbrt")
        self.assertEqual(stated["files"], ["\\xfe.png"])
        stated = json.loads(self.run_with("info", scene, "--json", status=0).stdout.decode())
        self.assertEqual(stated["scene"], "odd\\xff\\xe9.pbrt")
        self.picture("a.pfm")
        os.rename(self.folder / "a.pfm", os.path.join(os.fsencode(self.folder), b"\xff.pfm"))
        odd = os.fsdecode(b"\xff.pfm")
        self.assertEqual(json.loads(self.run_with("diff", odd, odd, "--json", status=0).stdout)["a"], "\\xff.pfm")

    def test_a_comparison_of_such_a_scene_is_saved_and_resumed(self):
        scene = self.scene()
        comparison = [*SMALL, "-a", "path", "-b", "naive", "--spp", "1", "--repeats", "2", "--no-cache", "--no-slopes",
                   "--no-attribution"]
        self.run_with("compare", scene, *comparison, "--save", "run.json", "-o", "page.html", "--json", status=0)
        result = self.run_with("compare", "--resume", "run.json", "--repeats", "1", "--quiet", "--json", status=0)
        self.assertEqual(json.loads(result.stdout)["methods"][0]["repeats"], 3)


class Bounds(FilesTest):
    def assert_quick(self, *arguments, word, status=2, seconds=4):
        seconds *= SLOWNESS
        def processor_time():
            usage = resource.getrusage(resource.RUSAGE_CHILDREN)
            return usage.ru_utime + usage.ru_stime
        begin = processor_time()
        # A program that needs more does not limit its input.
        result = self.run_with(*arguments, status=status, **limit_of_memory(3 << 30))
        self.assertLess(processor_time() - begin, seconds)
        said = result.stderr.decode()
        self.assertIn(word, said)
        self.assertNotIn("json.exception", said)
        self.assertNotIn("bad_alloc", said)
        return said

    def test_a_resolution_beyond_all_reason_is_refused(self):
        for size in "65536x65536", "46341x46341", "65537x1", "0x5", "99999999999x1":
            for verb in ["render", SCENE], ["compare", SCENE, "-a", "path", "-b", "naive"]:
                with self.subTest(size=size, verb=verb[0]):
                    self.assert_quick(*verb, "--resolution", size, word="--resolution")

    def test_what_never_ends_is_not_read(self):
        os.mkfifo(self.folder / "fifo")
        os.mkfifo(self.folder / "fifo.pbrt")
        (self.folder / "zero.pbrt").symlink_to("/dev/zero")
        for name in "/dev/zero", "fifo":
            with self.subTest(name=name):
                for arguments in (["merge", name], ["integrate", "--resume", name], ["compare", "--resume", name],
                                  ["tonemap", name, "-o", "a.png"], ["diff", name, name],
                                  ["compare", SCENE, "-a", "path", "-b", "naive", "--reference", name]):
                    self.assert_quick(*arguments, word="not a regular file")
        for name in "zero.pbrt", "fifo.pbrt":
            self.assert_quick("info", name, word="not a regular file")

    def test_a_packed_scene_that_fills_the_memory_is_refused(self):
        packer = zlib.compressobj(9, zlib.DEFLATED, 31)
        data = b"".join(packer.compress(b" " * (1 << 20)) for _ in range(1024)) + packer.flush()
        (self.folder / "bomb.pbrt.gz").write_bytes(data)
        self.assert_quick("info", "bomb.pbrt.gz", word="decompresses to more than")
        # A regular scene is packed as well as that of a real one: below the bound.
        lines = "".join(f'AttributeBegin Translate {i} 0 0 Shape "sphere" AttributeEnd\n' for i in range(20000))
        (self.folder / "many.pbrt.gz").write_bytes(gzip.compress(b"WorldBegin\n" + lines.encode(), 9))
        self.run_program("info", "many.pbrt.gz")

    def test_a_picture_that_promises_more_than_it_holds_is_refused(self):
        write_pfm(self.folder / "a.pfm", 64, 64, (1, 2, 3))
        self.run_program("render", SCENE, *SMALL, "--spp", "1", "-o", "a.exr")
        data = (self.folder / "a.exr").read_bytes()
        for window in b"dataWindow\0box2i\0\x10\0\0\0", b"displayWindow\0box2i\0\x10\0\0\0":
            at = data.index(window) + len(window)
            data = data[:at] + struct.pack("<4i", 0, 0, 5999, 4399) + data[at + 16:]
        (self.folder / "big.exr").write_bytes(data[:2000])
        self.assert_quick("tonemap", "big.exr", "-o", "a.png", word="big.exr")
        header = b"BM" + struct.pack("<IHHIIiiHHIIiiII", 1000, 0, 0, 54, 40, 0x7FFFFFF0, 0x7FFFFFF0, 1, 24, 0, 0, 1, 1, 0, 0)
        (self.folder / "big.bmp").write_bytes(header + b"\0" * 100)
        self.assert_quick("tonemap", "big.bmp", "-o", "a.png", word="big.bmp")

    def test_damaged_saved_files_are_explained_in_our_words(self):
        self.run_program("integrate", "x", "--over", "x=0:1", "--quiet", "--save", "a.json", "--samples", "1000")
        good = (self.folder / "a.json").read_text()
        for text, word in ((good[:len(good) // 2], "line"), ("{\n  5\n}", "line 2, column 3"), ("[]", "not a file that"),
                           ('{"format": "montelux integrals"}', '"version"'), ("", "line 1"),
                           ('{"format": "montelux integrals", "version": 3}', "checksum"), ("[" * 100000, "line 1"),
                           (good.replace('"seed": 0', '"seed": "x"', 1), "checksum")):
            (self.folder / "b.json").write_text(text)
            with self.subTest(word=word):
                for arguments in ["merge", "b.json"], ["integrate", "--resume", "b.json"]:
                    self.assertIn("b.json", self.assert_quick(*arguments, word=word))


class Signals(FilesTest):
    """Signals that end a program early: something is written where there is something, and the status is 128 + number."""

    def test_a_hangup_ends_a_render_with_its_picture(self):
        process = self.begin("render", SCENE, "--resolution", "64x48", "--time", "60s", "-o", "a.png")
        self.assertIn("samples/s", process.stderr.readline())
        process.send_signal(signal.SIGHUP)
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 129)
        self.assertIn("interrupted", errors)
        self.assertEqual((self.folder / "a.png").read_bytes()[:4], b"\x89PNG")

    def test_an_ignored_hangup_stays_ignored(self):
        process = self.begin("render", SCENE, "--resolution", "64x48", "--time", "6s", "--json", "-o", "a.png",
                             preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        self.assertIn("samples/s", process.stderr.readline())
        process.send_signal(signal.SIGHUP)
        output, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0)
        self.assertFalse(json.loads(output)["interrupted"])

    def test_a_render_whose_log_nobody_reads_writes_its_picture(self):
        process = self.begin("render", SCENE, "--resolution", "64x48", "--time", "60s", "-o", "a.png")
        process.stderr.close()
        self.assertEqual(process.wait(60), 141)
        self.assertEqual((self.folder / "a.png").read_bytes()[:4], b"\x89PNG")

    def test_a_sequence_whose_results_nobody_reads_ends_after_a_whole_frame(self):
        process = self.begin("render", SCENE, "--resolution", "64x48", "--spp", "1", "--frames", "0:99999", "--json",
                             "--quiet", "-o", "a.#.png")
        process.stdout.close()
        self.assertEqual(process.wait(60), 141)
        names = self.names()
        self.assertGreater(len(names), 0)
        for name in names:
            self.assertEqual((self.folder / name).read_bytes()[-8:-4], b"IEND")

    def test_results_that_nobody_reads_end_quietly(self):
        # Nobody reads from the start: else a fast program has written all of it before.
        end, stdout = os.pipe()
        os.close(end)
        process = self.begin("completion", "bash", stdout=stdout)
        os.close(stdout)
        self.assertEqual(process.wait(60), 141)
        self.assertEqual(process.stderr.read(), "")

    def test_a_signal_while_the_scene_loads_ends_at_once(self):
        lines = "".join(f'AttributeBegin Translate {i} 0 0 Shape "sphere" AttributeEnd\n' for i in range(1000000))
        (self.folder / "big.pbrt").write_text("WorldBegin\n" + lines)
        for number in signal.SIGINT, signal.SIGTERM, signal.SIGHUP:
            process = self.begin("render", "big.pbrt", "-o", "a.png")
            self.wait_for_handler(process)
            process.send_signal(number)
            _, errors = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 128 + number)
            self.assertIn("interrupted before anything was done", errors)
        self.assertEqual(self.names(), ["big.pbrt"])


def watched_disk(**variables):
    """Environment of a program whose calls to the disk are logged or slow: see disk_watch.cpp."""
    library = os.environ.get("MONTELUX_DISK_WATCH")
    if not library:
        raise unittest.SkipTest("MONTELUX_DISK_WATCH does not name the library that watches the disk (ctest sets it)")
    sanitizer = os.environ.get("ASAN_OPTIONS", "")
    return {**program.ENVIRONMENT, "LD_PRELOAD": library, "ASAN_OPTIONS": f"{sanitizer}:verify_asan_link_order=0",
            **variables}


class Disk(FilesTest):
    """The order in which a file gets to the disk, and signals while it does."""

    def wait_for_write(self, process):
        """Until the temporary file has its bytes."""
        def size(path):
            try:
                return path.stat().st_size
            except FileNotFoundError:  # the empty file of the check that the folder is writable
                return 0
        def is_written():
            return any(path.name.startswith(".") and size(path) > 0 for path in self.folder.iterdir())
        while not is_written():
            self.assertIsNone(process.poll())
            time.sleep(0.002)

    def test_the_bytes_are_on_the_disk_before_the_name_is_and_then_the_name(self):
        one, log = self.picture(), self.folder / "log"
        for name in "new.png", "old.png":
            (self.folder / "old.png").write_text("old")
            subprocess.run([program.PROGRAM, "tonemap", one, "-o", name], cwd=self.folder, check=True, timeout=60,
                           env=watched_disk(DISK_WATCH_LOG=str(log)))
            calls = [line.split() for line in log.read_text().splitlines()]
            log.unlink()
            self.assertEqual([call[0] for call in calls], ["fsync", "rename", "fsync"], calls)
            self.assertEqual(Path(calls[0][1]).name, Path(calls[1][1]).name)
            self.assertEqual(calls[1][2], name)
            self.assertEqual(Path(calls[2][1]), self.folder.resolve())

    def test_a_signal_during_a_write_leaves_no_temporary_file(self):
        one = self.picture()
        for number in signal.SIGINT, signal.SIGTERM, signal.SIGHUP:
            (self.folder / "a.png").write_text("old")
            process = self.begin("tonemap", one, "-o", "a.png", env=watched_disk(DISK_WATCH_DELAY="60000"))
            self.wait_for_write(process)
            process.send_signal(number)
            process.communicate(timeout=30)
            self.assertEqual(process.returncode, 128 + number)
            self.assertEqual(self.names(), ["a.png", "in.pfm"])
            self.assertEqual((self.folder / "a.png").read_text(), "old")

    def test_a_second_signal_during_the_write_of_a_render_leaves_no_temporary_file(self):
        (self.folder / "a.png").write_text("old")
        process = self.begin("render", SCENE, *SMALL, "--time", "60s", "-o", "a.png",
                             env=watched_disk(DISK_WATCH_DELAY="60000"))
        self.wait_for_handler(process)
        time.sleep(10 if SANITIZED else 0.5)  # until there is a picture to write
        process.send_signal(signal.SIGINT)
        self.wait_for_write(process)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=30)
        self.assertEqual(process.returncode, 130)
        self.assertEqual(self.names(), ["a.png"])
        self.assertEqual((self.folder / "a.png").read_text(), "old")


if __name__ == "__main__":
    unittest.main()
