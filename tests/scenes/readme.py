"""README's first own scene works as printed: its files, its commands one by one, and the output shown is the output that comes.

    readme.py ... --update yes    writes the output into README.md instead
"""
import os
import pathlib
import re
import shutil
import subprocess

from harness import Check, arguments, SCENES

ROOT = SCENES.parent.parent
HEADING = "## First own scene in 10 minutes\n"
BLOCK = re.compile(r"```(\w+)\n(.*?)```\n", re.DOTALL)
TOLERANCE = 5e-3  # of numbers: steps land where iterations say, which depend on rounding and gmsh's version a little
ROUNDING = 1e-12  # nothing shown is that small and means something
# What differs from machine to machine and run to run
MACHINE = [
    (r"(?m)^(BLAS|machine|time) .*$", r"\1"),
    (r"tangent [\d.e+-]+, factor and solve [\d.e+-]+", "TIMES"),
    (r"\d+:\d\d (min|h)|\d+(\.\d+)? (ms|s|min|h|kB|MB|GB)\b", "TIME"),
    (r"\d+(\.\d+)? (per cent|%)", "SHARE"),
]
NUMBER = re.compile(r"-?\d+\.?\d*(?:e[+-]?\d+)?")


def commands(block):
    """Each command of a console block with the output shown below it."""
    for part in re.split(r"(?m)^\$ ", block)[1:]:
        line, _, output = part.partition("\n")
        yield line, output


def neutral(text):
    for pattern, word in MACHINE:
        text = re.sub(pattern, word, text)
    lines = re.sub(r"[ \t]+", " ", text).strip().splitlines()
    return "\n".join(sorted(lines, key=lambda line: "warning:" in line))  # mpirun passes the two streams on in either order


def same(shown, came):
    """Equal words; numbers equal to the tolerance."""
    shown, came = neutral(shown), neutral(came)
    if NUMBER.sub("#", shown) != NUMBER.sub("#", came):
        return False
    pairs = zip(map(float, NUMBER.findall(shown)), map(float, NUMBER.findall(came)))
    return all(abs(a - b) <= TOLERANCE * max(abs(a), abs(b)) + ROUNDING for a, b in pairs)


def workplace(args):
    """A folder in which README's paths lead to this build."""
    folder = pathlib.Path(args.out).resolve() / "work"
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "build").mkdir(parents=True)
    (folder / "build" / "burnish").symlink_to(pathlib.Path(args.burnish).resolve())
    (folder / "build" / "venv").symlink_to(ROOT / "build" / "venv")
    (folder / "scripts").symlink_to(ROOT / "scripts")
    return folder


def main():
    args = arguments(("update", "write the output into README.md", ["yes", "no"]))
    check, folder = Check(), workplace(args)
    readme = (ROOT / "README.md").read_text()
    start = readme.index(HEADING)
    section = readme[start : readme.index("\n## ", start)]
    written = section
    for kind, block in BLOCK.findall(section):
        if kind != "console":
            name = block.split()[1].rstrip(":")
            (folder / name).write_text(block)
            continue
        anew = ""
        for command, shown in commands(block):
            finished = subprocess.run(command, shell=True, cwd=folder, env=os.environ, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            anew += f"$ {command}\n{finished.stdout}"
            check.holds(command, finished.returncode == 0, f"exit status {finished.returncode}\n{finished.stdout}" if finished.returncode else "")
            if args.update == "no" and not same(shown, finished.stdout):
                check.holds(f"output of {command}", False, f"is\n{finished.stdout}\nREADME.md shows\n{shown}\n(readme.py --update yes writes it anew)")
        written = written.replace(block, anew)
    for picture in re.findall(r"\]\((\S+\.png)\)", readme):
        check.holds(picture, (ROOT / picture).exists())
    if args.update == "yes" and not check.failed:
        (ROOT / "README.md").write_text(readme.replace(section, written))
    check.finish()


main()
