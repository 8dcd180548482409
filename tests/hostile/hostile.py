"""Attacks springproof and prints a table of them: hostile.py PROGRAM [ROUNDS [SEED]]

Random damage in every file that it keeps or reads back, files of others in every folder that it cleans, streams closed
or full, paths that are no files, links planted where it writes, a limit on the size of files.  Of every attack: no
crash, no endless wait, an error is one sentence with status 2, and where nothing was lost the numbers of an undisturbed
run.
"""

import os
import pathlib
import random
import resource
import shutil
import signal
import stat
import subprocess
import sys
import tempfile

program = str(pathlib.Path(sys.argv[1]).resolve())
rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 2
chance = random.Random(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
patience, memory = 120, 3 << 30  # seconds, bytes

CASE = """[body]
geo = "block.geo"
size_m = [1, 1, 1]
cells = [2, 2, 2]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.3
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[[load]]
on = "z_max"
displacement_m = [0, 0, -0.01]
[compare]
models = [MODELS]
measures = ["reaction"]
[reference]
REFERENCE
EXPECTED"""
EXPECTED = """[[expect]]
model = "hybmss"
measure = "force.z_max.z"
source = "regression"
value = 0
within = 1e9
"""
TETRAHEDRON = """solid
facet normal 0 0 0 outer loop vertex 0 0 0 vertex 0 1 0 vertex 1 0 0 endloop endfacet
facet normal 0 0 0 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 0 1 endloop endfacet
facet normal 0 0 0 outer loop vertex 0 0 0 vertex 0 0 1 vertex 0 1 0 endloop endfacet
facet normal 0 0 0 outer loop vertex 1 0 0 vertex 0 1 0 vertex 0 0 1 endloop endfacet
endsolid
"""


def case(name, models='"hybmss"', more="", reference="elements = []", geo=None):
    text = CASE.replace("MODELS", models).replace("REFERENCE", reference) + more
    text = text.replace("EXPECTED", EXPECTED if "hybmss" in models else "")
    if geo:
        text = text.replace('"block.geo"', f'"{geo}"').replace("size_m = [1, 1, 1]\n", "")
        text = text.replace("cells = [2, 2, 2]", "voxels = 100")
    (work / name).write_text(text)
    return str(work / name)


class Ended:
    def __init__(self, status, out, err):
        self.status, self.out, self.err = status, out, err

    def wrong(self, *allowed):
        """Why this is no end that a program may have, or nothing."""
        if self.status not in allowed:
            return f"status {self.status} (allowed: {allowed}): {self.err.strip()[-300:]}"
        if self.status == 2 and sum(line.startswith("error: ") for line in self.err.splitlines()) != 1:
            return f"not one sentence: {self.err.strip()[-300:]}"
        if "\x1b" in self.err:
            return "colours in a message"
        return None


def run(*arguments, streams="", files=None):
    """Runs the program; `streams`: redirections of a shell; `files`: limit on their size [bytes]."""
    def limits():
        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if files is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (files, files))

    command = ["sh", "-c", f'exec "$@" {streams}', "sh", program, *map(str, arguments)]
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=work,
                          start_new_session=True, preexec_fn=limits, text=True, errors="replace") as child:
        try:
            out, err = child.communicate(timeout=patience)
        except subprocess.TimeoutExpired:
            os.killpg(child.pid, signal.SIGKILL)
            child.communicate()
            return Ended("endless", "", "")
        return Ended(child.returncode, out, err)


table = {}


def attack(kind, what, why):
    """Counts one attack; `why`: what went wrong, or nothing."""
    table.setdefault(kind, []).append(why)
    if why:
        print(f"FAILED: {kind}: {what}: {why}", flush=True)


def damage(data):
    """Other bytes, by a way that disks, networks and people have."""
    data = bytearray(data)
    at = chance.randrange(len(data))
    way = chance.randrange(8)
    if way < 4:
        data[at] ^= 1 << chance.randrange(8)
        return f"bit of byte {at}", bytes(data)
    if way == 4:
        data[at:at + 64] = bytes(len(data[at:at + 64]))
        return f"zeros from byte {at}", bytes(data) if any(data) else b""
    if way == 5:
        return f"cut at byte {at}", bytes(data[:at])
    if way == 6:
        return f"byte {at} doubled", bytes(data[:at + 1] + data[at:])
    return "a random end", bytes(data) + chance.randbytes(9)


def damaged(file):
    before = file.read_bytes()
    while True:
        what, after = damage(before)
        if after != before:
            break
    file.write_bytes(after)
    return f"{file.name}, {what}"


def numbers(folder):
    try:
        return (folder / "results.csv").read_text()
    except OSError:
        return None


def as_before(ended, folder, before, note=None):
    """Status and numbers of the undisturbed run, and a note if one is due."""
    return ended.wrong(0) or (numbers(folder) != before and "other numbers, unsaid") or \
        (note and note not in ended.err and f"unsaid: {ended.err}") or None


def kept_files():
    good, out, cache = case("good.toml"), work / "out", work / "cache"
    first = run("compare", good, "--out", out, "--no-vtu")
    before = numbers(out)
    attack("undisturbed runs", "compare", first.wrong(0) or (before is None and "no results") or None)
    whole = {f: f.read_bytes() for f in cache.iterdir()}
    for _ in range(3 * rounds):
        what = damaged(chance.choice(sorted(whole)))
        shutil.rmtree(out)
        ended = run("compare", good, "--out", out, "--no-vtu")
        attack("damaged meshes of the cache", what, as_before(ended, out, before, "damaged"))
    part = next((out / "parts").iterdir())
    for _ in range(3 * rounds):
        what = damaged(part)
        attack("damaged parts", what,
               as_before(run("compare", good, "--out", out, "--no-vtu", "--resume"), out, before, "damaged"))

    shard = ["compare", good, "--shard", "1/1", "--out", work / "sweep", "--no-vtu"]
    attack("undisturbed runs", "a shard", run(*shard).wrong(0))
    for file in ("sweep.cbor", "parts/good.case.cbor", "parts/" + part.name):
        for _ in range(rounds):
            what = damaged(work / "sweep" / file)
            report, again = run("report", work / "sweep"), run(*shard)
            why = report.wrong(2)
            if file == "sweep.cbor":
                why = why or again.wrong(2) or ("sweep.cbor is damaged" not in again.err and again.err) or None
                (work / "sweep" / file).unlink()
                again = run(*shard)
            attack("damaged sweeps", what, why or again.wrong(0) or
                   as_before(run("report", work / "sweep"), work / "sweep", before))


def read_back_files():
    """What belongs to the user may have been edited by intention: it is read, or refused by its name."""
    springs = work / "springs.json"
    attack("undisturbed runs", "export", run("export", case("good.toml"), "--to", "springs", "--out", springs).wrong(0))
    mine = case("mine.toml", '{ file = "springs.json", label = "mine" }')
    whole = springs.read_bytes()
    for _ in range(2 * rounds):
        springs.write_bytes(whole)
        what = damaged(springs)
        ended = run("compare", mine, "--out", work / "mine", "--no-vtu")
        attack("damaged springs files", what, ended.wrong(0, 1, 2) or
               (ended.status == 2 and "springs.json" not in ended.err and ended.err) or None)
    springs.write_bytes(whole)
    other = work / "other"
    shutil.copytree(work / "out", other)
    for name in ("results.json", "report.html"):
        whole = (other / name).read_bytes()
        for _ in range(2 * rounds):
            (other / name).write_bytes(whole)
            what = damaged(other / name)
            redone = ["reproduce", "golec_2019", "--figure", "5", "--from", other, "--out", work / "redone"]
            for command in (["diff", work / "out", other], redone):
                ended = run(*command)
                attack("damaged results", f"{what}, {command[0]}", ended.wrong(0, 1, 2))
        (other / name).write_bytes(whole)


def folders_of_others():
    """Everything in the folders that are cleaned or written into, by any name, stays as it is."""
    temporary, cache, out = work / "tmp", work / "cache", work / "full"
    names = {temporary: (".springproof-notes/list", ".springproof-photos/list",
                         "springproof-temporary-copy/results.csv",
                         "springproof-temporary-1-abcdef/results.csv", "springproof-temporary/x", "springproof-1.txt"),
             cache: ("thesis.txt", "mesh-1.cbor", "0123456789abcdef.cbor", "mesh-00112233445566778899aabbccddeeff.cbor",
                     "mesh-00112233445566778899aabbccddeeff.cbor.01234567.part"),
             out: ("thesis.txt", ".writable", "trial", "results.json.part", "report.html.part", "parts/notes.txt",
                   "parts/good-nu0.3.cbor.part", "vtu/good/mine.vtu", "results.csv.01234567.part")}
    files = {}
    for folder, inside in names.items():
        for name in inside:
            file = folder / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text("mine")
            os.utime(file, (1, 1))
            files[file] = "mine"
    large = cache / "photos.tar"
    large.touch()
    os.truncate(large, 1_100_000_000)  # sparse
    os.utime(large, (1, 1))
    fine = case("fine.toml")
    for i in range(min(rounds, 5)):
        text = (work / "good.toml").read_text().replace("[1, 1, 1]", f"[{i + 2}, {i + 2}, {i + 2}]")
        (work / "fine.toml").write_text(text)
        why = run("compare", fine, "--out", out, "--vtu").wrong(0)
        for file, text in files.items():
            there = file.is_file() and file.read_text() == text
            attack("files of others in our folders", str(file.relative_to(work)),
                   why or (not there and "gone or changed") or None)
        attack("files of others in our folders", "1.1 GB", (not large.exists() and "gone") or None)
    large.unlink(missing_ok=True)


def streams():
    """Status and results do not depend on a log; lost output is no success."""
    good, out = case("good.toml"), work / "streams"
    commands = [("compare", good, "--out", out, "--no-vtu"), ("diff", work / "out", work / "out"), ("list",),
                ("export", good, "--to", "springs", "--out", work / "x.json"),
                ("export", good, "--to", "calculix", "--out", work / "x.inp"),
                ("material", "-E", "1e4", "--nu", "0.3"), ("homogenise", "-E", "1e4", "--nu", "0.25", "--json"),
                ("report", work / "sweep"), ("describe", "man"), ("--version",), ("--help",),
                ("compare", "--help"), ("compare", work / "none.toml"), ("no_such_command",)]
    if rounds > 1:  # these measure or solve for long
        commands += [("advise", "--nu", "0.3"), ("frequencies", good)]
    for command in chance.sample(commands, min(len(commands), 4 * rounds)):
        usual = run(*command)
        for redirection in (">&-", ">/dev/full", "2>&-", "2>/dev/full", ">&- 2>&-", ">/dev/full 2>/dev/full"):
            shutil.rmtree(out, ignore_errors=True)
            ended = run(*command, streams=redirection)
            lost = usual.out and redirection != "2>&-" and redirection != "2>/dev/full"
            allowed = (usual.status, 1, 2) if lost else (usual.status,)
            why = None
            if ended.status not in allowed:
                why = f"status {ended.status}, usually {usual.status}: {ended.err[-300:]}"
            if lost and usual.status == 0 and ended.status == 0:
                why = "output was lost, and the status is 0"
            if out in command and numbers(out) is None:
                why = "no results"
            attack("streams closed or full", f"{command[0]} {redirection}", why or None)


def paths():
    """What is no file is refused by its name, and soon."""
    (work / "body.stl").write_text(TETRAHEDRON)
    sources = work / "sources"
    sources.mkdir()
    os.mkfifo(sources / "pipe")
    (sources / "folder").mkdir()
    (sources / "loop").symlink_to("loop")
    (sources / "dangling").symlink_to("nowhere")
    (sources / "large").touch()
    os.truncate(sources / "large", 10_000_000_000)
    system = map(pathlib.Path, ("/dev/zero", "/dev/full", "/proc/self/mem"))
    kinds = [*sorted(sources.iterdir()), work / "none", *system]
    for kind in kinds:
        for name in ("n.toml", "n.stl", "n.STEP", "n.csv", "n.json", "results.json", "n.vtu"):
            (work / "h" / name).unlink(missing_ok=True)
            (work / "h" / name).parent.mkdir(exist_ok=True)
            (work / "h" / name).symlink_to(kind)
        to = ["--out", work / "refused"]
        springs = ["--to", "springs", "-E", "1e4", "--nu", "0.3", "--out", work / "refused.json"]
        table_case = case("h/table.toml", "", '[[external]]\nname = "e"\nfile = "n.csv"\n', "cells = [4, 4, 4]")
        readers = {
            "n.toml": ["compare", work / "h" / "n.toml", *to],
            "n.stl": ["export", work / "h" / "n.stl", *springs],
            "n.STEP": ["compare", case("h/body.toml", geo="n.STEP"), *to],
            "n.csv": ["compare", table_case, *to],
            "n.json": ["compare", case("h/springs.toml", '{ file = "n.json", label = "e" }'), *to],
            "results.json": ["diff", work / "h", work / "out"],
        }
        for name, command in chance.sample(sorted(readers.items()), min(len(readers), 2 * rounds)):
            ended = run(*command)
            why = ended.wrong(2) or (name not in ended.err and f"no name: {ended.err}") or \
                ((work / "refused").exists() and "a folder of results") or None
            attack("paths that are no files, read", f"{name} is {kind}", why)


def written():
    """Links that others planted in the folder of results are replaced; what the user named is written through."""
    good, victim = case("good.toml"), work / "victim"
    for name in ("results.json", "results.csv", "report.html", "parts/good-nu0.3.cbor", ".writable",
                 "results.json.part", "report.html.part", "trial"):
        out = work / "planted"
        shutil.rmtree(out, ignore_errors=True)
        (out / "parts").mkdir(parents=True)
        victim.write_text("theirs")
        (out / name).symlink_to(victim)
        ended = run("compare", good, "--out", out, "--no-vtu")
        attack("links planted where we write", name,
               ended.wrong(0) or (victim.read_text() != "theirs" and "written through") or None)
    named = work / "named.json"
    named.symlink_to(victim)
    ended = run("export", good, "--to", "springs", "--out", named)
    attack("links planted where we write", "a link that was named", ended.wrong(0) or
           (not (named.is_symlink() and victim.read_text().startswith("{")) and "not written through") or None)
    for name in ("/dev/full", "/dev/null", work, work / "none" / "x"):
        ended = run("export", good, "--to", "calculix", "--out", name)
        attack("paths that are no files, written", str(name), ended.wrong(0 if name == "/dev/null" else 1, 2))
    attack("paths that are no files, written", "what /dev/null is now",
           None if stat.S_ISCHR(os.stat("/dev/null").st_mode) else "a file")
    for size in (0, 1000, 100_000):
        for command in (["compare", good, "--out", work / "limited", "--no-vtu"],
                        ["export", good, "--to", "springs", "--out", work / "limited.json"]):
            ended = run(*command, files=size)
            whole = ended.status == 0 or ended.err.count("\n") >= 1
            attack("limits on the size of files", f"{size} bytes, {command[0]}",
                   ended.wrong(0, 1, 2) or (not whole and "unsaid") or None)


def main():
    os.environ.update(SPRINGPROOF_MESH_CACHE=str(work / "cache"), TMPDIR=str(work / "tmp"))
    (work / "tmp").mkdir()
    for attacks in (kept_files, read_back_files, folders_of_others, streams, paths, written):
        attacks()
    width = max(map(len, table))
    print(f"\n{'attack':<{width}}  tried  failed")
    for kind, results in table.items():
        print(f"{kind:<{width}}  {len(results):5}  {sum(why is not None for why in results):6}")
    return 1 if any(why for results in table.values() for why in results) else 0


with tempfile.TemporaryDirectory() as folder:
    work = pathlib.Path(folder)
    sys.exit(main())
