"""make install puts program, library, man page, completion and examples where they run from, and the pages where their
links and pictures are found; a program outside of the source tree links the library; the man page is well formed and
lists every option."""
import os
import pathlib
import re
import shutil
import subprocess

from harness import Check, arguments, SCENES

ROOT = SCENES.parent.parent


def run(*words, **options):
    return subprocess.run([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          **options)


args = arguments()
check = Check()
burnish = pathlib.Path(args.burnish).resolve()
out = pathlib.Path(args.out).resolve()
shutil.rmtree(out, ignore_errors=True)
prefix, work = out / "prefix", out / "work"
work.mkdir(parents=True)
# -o: what the tests run is installed, not built anew with other flags
finished = run("make", "-C", ROOT, "-o", burnish, f"BUILD={burnish.parent}", f"PREFIX={prefix}", "install")
check.holds("make install", finished.returncode == 0, finished.stdout if finished.returncode else "")
example = prefix / "share/burnish/runs/cup_flattening.yaml"
finished = run("mpirun", "-n", args.ranks, prefix / "bin/burnish", example, "-set", "mesh.parameters.n_arc=30", "-set",
               "loads.0.pressure=20", cwd=work)
good = finished.returncode == 0 and (work / "out/cup_flattening/summary.json").exists()
check.holds("an example runs from there", good, "" if good else finished.stdout[-1000:])

check.holds("public headers", [header.name for header in (prefix / "include").iterdir()] == ["burnish.h"])
environment = {**os.environ, "PKG_CONFIG_PATH": str(prefix / "lib/pkgconfig")}
flags = run("pkg-config", "--cflags", "--libs", "burnish", env=environment, cwd=work).stdout.split()
finished = run("mpicc", ROOT / "tests/library/library.c", *flags, "-o", "library", cwd=work)
check.holds("a program links the library", finished.returncode == 0, finished.stdout if finished.returncode else "")
finished = run("mpirun", "-n", args.ranks, work / "library", SCENES / "probes.yaml", cwd=work)
check.holds("and runs", finished.returncode == 0, finished.stdout[-1000:] if finished.returncode else "")

documents = prefix / "share/doc/burnish"
broken = [f"{path.name}: {link}" for path in [documents / "README.md", *(documents / "doc/pages").glob("*.md")]
          for link in re.findall(r"\]\(([\w/.]+\.(?:md|png))", path.read_text()) if not (path.parent / link).exists()]
check.holds("links of the pages", (documents / "doc/pages/theory.md").exists() and not broken, " ".join(broken))

page = prefix / "share/man/man1/burnish.1"
text = page.read_text()
told = set(re.findall(r"Fl (\w+)", text)) | set(re.findall(r"\| (\w+)", text))
usage = [
    line for line in run(prefix / "bin/burnish", "-help").stdout.split("Scene file (YAML")[0].splitlines()
    if "not available yet" not in line
]
untold = set(re.findall(r"(?:^|\s|\|)-([a-z]\w*)", "\n".join(usage))) - told
check.holds("options of the man page", not untold, f"not told: {untold}" if untold else "")
for line in (("mandoc", "-Tlint", "-Wwarning", page), ("man", "--warnings", "-l", page)):
    if shutil.which(line[0]):
        finished = subprocess.run(list(map(str, line)), env={
            **os.environ, "LC_ALL": "C.UTF-8"
        }, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        said = finished.stderr if line[0] == "man" else finished.stdout  # man writes the page itself
        check.holds(" ".join(map(str, line[:-1])), finished.returncode == 0 and not said, said)
    else:
        print(f"     {line[0]} is not here")

complete = (
    f"cd {work}; source {prefix}/share/bash-completion/completions/burnish; COMP_WORDS=({prefix}/bin/burnish %s); "
    "COMP_CWORD=%d; "
    '_burnish 2>/dev/null; echo "${COMPREPLY[@]}"')
for words, place, expected in (("-set stepping.in", 2, "stepping.initial="), ("-ov", 1, "-overwrite")):
    check.holds(f"completion of {words}", run("bash", "-c", complete % (words, place)).stdout.split() == [expected])
check.finish()
