"""Runs every command that README.md and the pages in doc/pages show, and compares the output that they show with the
output that comes.

Commands are the lines of blocks marked `sh`, the lines behind `$` in blocks marked `console`, whose output follows, and
inline code that begins with a program and has an argument. readme_commands.py lists those that run in the full set
only, with other settings, or not at all; every other command runs as it stands, in both sets. The test also fails on a
command in a block of another kind, on a command in the lists that no page shows, on a path that does not exist, and on
a block below `<!-- the file PATH -->` that differs from this file.

    readme.py ... --part quick        commands that take no more than a second or two
    readme.py ... --part full         all of them
    readme.py ... --update yes        writes the outputs of console blocks and the copies of files into the pages
"""
import json
import os
import pathlib
import re
import resource
import shutil
import subprocess

from harness import Check, arguments, SCENES
from readme_commands import CHECKED, FULL, LIKE, NOT_HERE

ROOT = SCENES.parent.parent
TUTORIAL = ROOT / "doc/pages/tutorial.md"
PAGES = [ROOT / "README.md", TUTORIAL, *sorted({*(ROOT / "doc/pages").glob("*.md")} - {TUTORIAL})]
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
INLINE = re.compile(r"`([^`]+)`")
FILE = re.compile(r"(?://|#) ([\w/]+\.(?:geo|yaml))\b")  # first line of a block that is a file of the user's
COPY = re.compile(r"(?<=<!-- the file )(\S+)( -->\n```\w+\n)(.*?)(?=^```$)", re.DOTALL | re.MULTILINE)
PROGRAM = re.compile(r"\s*(\$ )?(make|mpirun|burnish|build/\S+|scripts/\S+|\w*/?python3?|export|cmake|ctest|pkg-config"
                     r"|sbatch|qsub|module|spack|apt|apt-get|sudo|git|pip)\s+\S")
KINDS = ("sh", "console", "c", "python", "yaml", "text")
PATH = re.compile(r"(?:src|include|tests|scripts|runs|meshes|doc)/[\w/.-]*\w")
ROW = re.compile(r"^\| `(out/\w+)` \|(.*)\|$", re.MULTILINE)  # of a table with figures of that run
TOLERANCE = 5e-3  # of numbers: steps depend a little on rounding and on the version of gmsh
ROUNDING = 1e-12  # no number that is shown is so small and means something
LIMIT = 600  # s of one command
# What differs from machine to machine and run to run
MACHINE = [
    (r"(?m)^(BLAS|machine|time) .*$", r"\1"),
    (r"tangent [\d.e+-]+, factor and solve [\d.e+-]+", "TIMES"),
    (r"\d+:\d\d (min|h)|\d+(\.\d+)? (ms|s|min|h|kB|MB|GB)\b", "TIME"),
    (r"\d+(\.\d+)? (per cent|%)", "SHARE"),
]
NUMBER = re.compile(r"-?\d+\.?\d*(?:e[+-]?\d+)?")


def console(block):
    """Each command of a console block with the output shown below it."""
    for part in re.split(r"(?m)^\$ ", block)[1:]:
        line, _, output = part.partition("\n")
        yield line, output


def shell(block):
    """The commands of a block of shell lines, without their comments."""
    for line in re.sub(r"\\\n\s*", "", block).splitlines():
        line = re.sub(r"(^|\s+)# .*", "", line).strip()
        if line:
            yield line


def commands(text):
    """(command, output shown or None) of a page, in its order."""
    place, found = 0, []
    for match in FENCE.finditer(text):
        found += [(inline, None) for inline in inline_commands(text[place : match.start()])]
        if match[1] == "console":
            found += console(match[2])
        elif match[1] == "sh":
            found += [(line, None) for line in shell(match[2])]
        place = match.end()
    return found + [(inline, None) for inline in inline_commands(text[place:])]


def inline_commands(text):
    for code in INLINE.findall(text):
        code = " ".join(code.split())
        if PROGRAM.match(code):
            yield re.sub(r"^burnish", "build/burnish", code)


def hidden(text):
    """Lines that look like a command where none is looked for."""
    for kind, block in FENCE.findall(text):
        if kind not in KINDS:
            yield f"block of kind '{kind}'"
        elif kind not in ("sh", "console"):
            yield from (line for line in block.splitlines() if PROGRAM.match(line))
    yield from (line for line in FENCE.sub("", text).splitlines() if line.startswith("    ") and PROGRAM.match(line))


def neutral(text):
    for pattern, word in MACHINE:
        text = re.sub(pattern, word, text)
    lines = re.sub(r"[ \t]+", " ", text).strip().splitlines()
    return "\n".join(sorted(lines, key=lambda line: "warning:" in line))  # mpirun mixes the two streams in any order


def same(shown, came):
    """Whether words are equal, and numbers are equal to the tolerance; what is shown may be the end of what came."""
    shown, came = neutral(shown).splitlines(), neutral(came).splitlines()
    shown, came = "\n".join(shown), "\n".join(came[-len(shown) :] if shown else [])
    if NUMBER.sub("#", shown) != NUMBER.sub("#", came):
        return False
    pairs = zip(map(float, NUMBER.findall(shown)), map(float, NUMBER.findall(came)))
    return all(abs(a - b) <= TOLERANCE * max(abs(a), abs(b)) + ROUNDING for a, b in pairs)


def cpu():
    """CPU seconds of all commands so far."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class Workplace:
    """A folder in which the paths of the pages lead to this build; runs each command once."""

    def __init__(self, args, check):
        self.check, self.args, self.done = check, args, {}
        self.folder = pathlib.Path(args.out).resolve() / "work"
        shutil.rmtree(self.folder, ignore_errors=True)
        (self.folder / "build").mkdir(parents=True)
        build = pathlib.Path(args.burnish).resolve().parent
        for path in build.iterdir():
            if path.name in ("burnish", "bench", "tests", "obj", "libburnish.a"):
                (self.folder / "build" / path.name).symlink_to(path)
        (self.folder / "build/venv").symlink_to(ROOT / "build/venv")
        for name in ("Makefile", "README.md", "doc", "include", "meshes", "scripts", "src", "tests"):
            if (ROOT / name).exists():
                (self.folder / name).symlink_to(ROOT / name)
        shutil.copytree(ROOT / "runs", self.folder / "runs")

    def plan(self, command):
        """What is run for a command, or None where it waits for the full set."""
        if command in LIKE:
            return LIKE[command]
        if command not in FULL and command not in NOT_HERE:
            if "--record runs/records" in command:  # it would run for minutes
                self.check.holds(f"{command}: readme_commands.py lists it", False)
                return None
            more = [words for start, words in CHECKED.items() if command.startswith(start)]
            return " ".join([command, *more]) if self.args.part == "quick" else command
        if self.args.part == "quick":
            return None
        return NOT_HERE[command][1] if command in NOT_HERE else FULL[command] or command

    def run(self, command):
        """The output of a command, or None where it is not run in this set."""
        if command in self.done:
            return self.done[command]
        line = self.plan(command)
        if line is None:
            return None
        environment = {**os.environ, "WORK": str(self.folder)}
        before = cpu()
        finished = subprocess.run(["timeout", str(LIMIT), "bash", "-c", line], cwd=self.folder, env=environment,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        good = finished.returncode == 0
        failure = f"{line}\nexit status {finished.returncode}\n{finished.stdout}"
        self.check.holds(command, good, f"({cpu() - before:.1f} CPU s)" if good else failure)
        self.done[command] = finished.stdout
        return finished.stdout


def write_files(text, folder, check, files):
    """Files that a page shows; the same name has the same text on every page."""
    for kind, block in FENCE.findall(text):
        name = FILE.match(block)
        if kind in ("c", "yaml") and name:
            check.holds(f"{name[1]} is the same on every page", files.setdefault(name[1], block) == block)
            (folder / name[1]).write_text(block)


def check_tables(text, folder, check):
    """Rows `out/NAME` of a table whose head names keys of summary.json."""
    for name, row in ROW.findall(text):
        if not (folder / name / "summary.json").exists():
            check.holds(f"figures of {name}", False, "the page does not run it")
            continue
        summary = json.loads((folder / name / "summary.json").read_text())
        above = text[: text.index(f"| `{name}` |")].rsplit("\n\n", 1)[1]
        keys = INLINE.findall(above.splitlines()[0])
        for key, cell in zip(keys, row.split("|")):
            value = {**summary, **summary["probes"]}[key]
            check.near(f"{name}: {key}", float(cell), value, TOLERANCE * abs(value))


def check_paths(path, text, work):
    """Files that a page names in code are in the repository, or are files of the user's that the page shows."""
    for code in sorted({*INLINE.findall(FENCE.sub("", text))}):
        for name in PATH.findall(code) if PATH.match(code) else ():
            work.check.holds(f"{path.name}: {name}", (work.folder / name).exists())
        if re.fullmatch(r"\w+\.py", code):
            there = any((work.folder / folder / code).exists() for folder in ("tests/scenes", "tests/hard", "scripts"))
            work.check.holds(f"{path.name}: {code}", there)


def run_page(path, work, files):
    """Runs the commands of a page; its text with the outputs that came."""
    text, check = path.read_text(), work.check
    written = COPY.sub(lambda copy: copy[1] + copy[2] + (ROOT / copy[1]).read_text(), text)
    check.holds(f"{path.name} shows files as they are", work.args.update == "yes" or written == text)
    write_files(text, work.folder, check, files)
    for line in hidden(text):
        check.holds(f"{path.name}: a command in a block marked sh or console", False, line)
    for command, shown in commands(text):
        came = work.run(command)
        if came and " --table " in command:
            missing = [row for row in came.splitlines() if row.startswith("| ") and row not in text]
            check.holds(f"{path.name} has the rows of {command}", not missing, "\n".join(missing))
        if shown is None or came is None:
            continue
        whole = not shown or shown.split()[0] == came.split()[0]
        lines = came.splitlines()[0 if whole else -len(shown.splitlines()) :]
        written = written.replace(f"$ {command}\n{shown}", f"$ {command}\n" + "".join(f"{line}\n" for line in lines))
        if work.args.update == "no" and not same(shown, came):
            note = f"is\n{came}\n{path.name} shows\n{shown}\n(--update yes writes it anew)"
            check.holds(f"output of {command}", False, note)
    if work.args.part == "full":
        check_tables(text, work.folder, check)
    check_paths(path, text, work)
    return written


def main():
    part = ("part", "which commands", ["quick", "full"])
    args, check = arguments(part, ("update", "write outputs into the pages", ["yes", "no"])), Check()
    work, files = Workplace(args, check), {}
    pages = {path: run_page(path, work, files) for path in PAGES}
    shown = {command for path in PAGES for command, _ in commands(path.read_text())}
    for command in sorted({*FULL, *LIKE, *NOT_HERE} - shown):
        check.holds(f"{command}: a page shows it", False)
    for path in PAGES:
        for picture in re.findall(r"\]\((\S+\.png)\)", path.read_text()):
            check.holds(f"{path.name}: {picture}", (path.parent / picture).exists())
    if args.update == "yes" and not check.failed:
        for path, text in pages.items():
            path.write_text(text)
    check.finish()


if __name__ == "__main__":
    main()
