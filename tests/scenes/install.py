"""make install puts program, library, man page, completion and examples where they run from, and the pages where their
links and pictures are found; a program outside of the source tree links the library; the Python package is installed
and used; the man page is well formed and
lists every option."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

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

scripts, site = prefix / "share/burnish/scripts", work / "site"
finished = run(sys.executable, "-m", "pip", "install", "--no-index", "--no-deps", "--no-build-isolation", "--target",
               site, scripts, cwd=work)
check.holds("pip installs the Python package", finished.returncode == 0, finished.stdout if finished.returncode else "")
(work / "use.py").write_text(f"""
import burnish, numpy
scene = {{"mesh": {{"file": "{SCENES.parent.parent / 'meshes/block.geo'}", "parameters": {{"lx": 2, "ly": 1, "lz": 1.5}}}},
         "bodies": [{{"volume": "block", "material": {{"law": "linear", "E": 1000, "nu": 0}}}}], "kinematics": "small",
         "supports": [{{"surface": "y_min", "ux": 0, "uy": 0, "uz": 0}}],
         "loads": [{{"surface": "y_max", "traction": [0, 5, 0]}}],
         "contact": [{{"name": "pad", "slave": "x_max", "master": {{"plane": {{"point": [2.001, 0, 0], "normal": [-1, 0, 0]}}}}}}],
         "probes": [{{"name": "top", "displacement": [0, 1, 0], "component": "y"}}]}}
results = burnish.run(scene, "out/stretched", ranks={args.ranks}, overrides={{"mesh.order": 2}})
exact = 5 / 1000 * results.nodes[:, 1]
assert numpy.allclose(results.field("displacement")[:, 1], exact, atol=1e-9), "displacement"
assert abs(results.probes["top"] - 0.005) < 1e-9 and abs(results.steps["top"][-1] - 0.005) < 1e-9, "probe"
assert list(results.cells) == ["hex27"] and results.times[-1] == 1, "cells"
nodes, gap = results.contact("pad", "gap")
assert len(nodes) and len(gap), "contact"
print(results.plot(), *results.draw("von_mises", view=(30, 20)))
try:
    burnish.run(scene, "out/wrong", overrides={{"mesh.order": 7}})
except burnish.Failed as failed:
    assert failed.status == 1 and "mesh.order" in failed.text, "refusal"
else:
    raise SystemExit("nothing was refused")
""")
finished = run(sys.executable, "-I", "-c", f"import sys; sys.path.insert(0, {str(site)!r}); exec(open('use.py').read())",
               cwd=work, env={**os.environ, "BURNISH": str(prefix / "bin/burnish")})
check.holds("it runs scenes and reads and draws their results", finished.returncode == 0 and
            (work / "out/stretched/steps.png").exists() and (work / "out/stretched/von_mises.png").exists(),
            finished.stdout if finished.returncode else "")

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
