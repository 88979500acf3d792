"""Scenes of strangers: geometry that runs programs or writes files is refused with its file and line, does nothing,
and leaves no mesh. Decks that would read devices, take all memory or never end are refused by name. So is a scene that
names a library, which is not loaded. With -trust they are taken. A file that the geometry reads makes a new mesh when
it changes."""
import os
import pathlib
import re
import shutil
import subprocess

from harness import SCENES, Check, arguments, run

SQUARE = (SCENES.parent.parent / "meshes" / "square.geo").read_text()
args = arguments()
check = Check()
place = pathlib.Path(args.out).resolve() / "geometry"
shutil.rmtree(place, ignore_errors=True)
place.mkdir(parents=True)


def write(name, text):
    (place / name).write_text(text)
    return place / name


def scene(geometry, *options, overrides=()):
    return run(args, SCENES / "wrong_mesh.yaml", "-check", *options, out="check",
               overrides=[f"mesh.file={geometry}", *overrides], must=None)


def says(what, pattern, finished):
    check.holds(what, re.search(pattern, finished.text), finished.text.strip()[:250])


def mesh(geometry, *options):
    """Bytes of the mesh that a geometry gives."""
    finished = run(args, SCENES / "wrong_mesh.yaml", "-mesh", *options, out="check",
                   overrides=[f"mesh.file={geometry}"], must=None)
    found = re.search(r"(\S*mesh-\w+\.msh)", finished.text)
    return pathlib.Path(found[1]).read_bytes() if found else finished.text


def footprint():
    return sorted(path.name for path in place.iterdir())


TOUCH = f"touch {place}/done"
MAIN = {
    "system_call": (f'SystemCall "{TOUCH}";', "runs a program"),
    "system": (f'System Sprintf("{TOUCH}");', "runs a program"),
    "non_blocking": (f"NonBlockingSystemCall '{TOUCH}';", "runs a program"),
    "behind_comment": (f'// "\nIf (0)\nEndIf\nSystemCall "{TOUCH}"; /* " */', "runs a program"),
    "onelab": (f'OnelabRun("x", "{TOUCH}");', "runs a program"),
    "field": (f'Field[1] = ExternalProcess; Field[1].CommandLine = "{TOUCH}"; Background Field = 1;', "runs a program"),
    "made_name": (f'S2N[StrCat("System", "Call")] "{TOUCH}";', "makes a name"),
    "save": (f'Save "{place}/done.msh";', "writes a file"),
    "print": (f'name = "{place}/done.geo_unrolled"; Print Str(name);', "writes a file"),
    "printf": (f'Printf("%g", 1) >> "{place}/done";', "writes a file"),
    "folder": (f'CreateDir "{place}/done";', "makes a folder"),
    "long_text": (f'x = "{"x" * 1023}"; y = "{"y" * 1100}; SystemCall \'{TOUCH}\'; z = "; w = "";', "1023 characters"),
    "computed": ('For i In {1:1}\nInclude Sprintf("evil%g.geo", i);\nEndFor', "made while gmsh runs"),
    "included": ('Include "evil1.geo";', "evil1.geo:2: 'SystemCall' runs a program"),
    "merged": ('Merge "evil2.txt";', "evil2.txt:1: 'SystemCall' runs a program"),
    "variable": ('f = "evil1.geo"; Include StrCat(CurrentDirectory, f);', "evil1.geo:2: 'SystemCall' runs a program"),
    "late_value": ('Macro m\nInclude Str(f);\nReturn\nf = "good.geo"; Include "later.geo";', "made while gmsh runs"),
    "packed": ('Merge "x.geo.gz";', "another program"),
    "option": ('General.OptionsFileName = "x"; General.SaveOptions = 1;', "write files of its own"),
    "solver": ('Solver . Executable0 = "sh";', "programs that gmsh runs"),
    "index": ('General[0].SaveOptions = 1;', "write files of its own"),
    "data_first": ('a = FileExists("evil1.geo"); Include "evil1.geo";', "evil1.geo:2: 'SystemCall' runs a program"),
    "capitals": ('Merge "evil3.BREP";', "evil3.BREP:1: 'SystemCall' runs a program"),
    "swallowed": (f"If (0)\nx = I\"; EndIf SystemCall '{TOUCH}'; //\";\nEndIf", "a part of a text as commands"),
    "second_pass": (f'For i In {{1:2}} x = "\nSystemCall \'{TOUCH}\'; //";\nEndFor', "a part of a text as commands"),
    "comment_pass": (f"For i In {{1:2}} /*\nSystemCall '{TOUCH}'; */\nEndFor", "lines of the comment as commands"),
    "parameter": ('If (!Exists(f)) f = "good.geo"; EndIf Include Str(f);', "made while gmsh runs"),
    "index_of_name": ('f_1 = "good.geo"; f~{1} = "evil1.geo"; Include Str(f_1);', "made while gmsh runs"),
    "database": ('DefineConstant[f = {"good.geo", Name "P/f"}]; SetString("P/f", "evil1.geo"); Include Str(f);',
                 "made while gmsh runs"),
    "unfinished": ('Include StrCat(StrCat(StrCat(', "made while gmsh runs"),
    "linked": ('Include "link.geo";', "here.geo:1: 'SystemCall' runs a program"),
}
write("evil1.geo", f'\nSystemCall "{TOUCH}";\n')
write("evil2.txt", f'SystemCall "{TOUCH}";\n')
write("evil3.BREP", f'SystemCall "{TOUCH}";\n')
write("good.geo", "h = 1;\n")
(place / "sub").mkdir()
(place / "sub" / "real.geo").write_text('Include "here.geo";\n')
(place / "sub" / "here.geo").write_text("h = 1;\n")
(place / "link.geo").symlink_to("sub/real.geo")
write("here.geo", f'SystemCall "{TOUCH}";\n')
write("later.geo", 'f = "evil1.geo";\nCall m;\n')
for name, (command, pattern) in MAIN.items():
    geometry = write(f"{name}.geo", SQUARE + command + "\n")
    before = footprint()
    finished = scene(geometry, overrides=["mesh.parameters={f: evil1.geo}"] if name == "parameter" else [])
    says(f"{name}: refused", pattern, finished)
    check.holds(f"{name}: exit 1, nothing done", finished.status == 1 and footprint() == before,
                f"status {finished.status}, new: {set(footprint()) - set(before)}")
says("a last line that gmsh reads in part: refused", r"unended.geo:\d+: the last line has no line end",
     scene(write("unended.geo", SQUARE + "h = 1; Point(90) = {9, 9, 0};")))
geometry = write("beside.geo", SQUARE)
write("beside.geo.opt", f'SystemCall "{TOUCH}";\n')
says("options beside the .geo: refused", r"beside.geo.opt:1: 'SystemCall'", scene(geometry))
says("option as parameter: refused", "programs that gmsh runs",
     scene(write("plain.geo", SQUARE), overrides=["mesh.parameters={Solver.Executable0: sh}"]))
says("PETSc option with a file: refused", "petsc.*writes a file",
     scene(place / "plain.geo", overrides=[f"petsc={{snes_view: 'ascii:{place}/done'}}"]))
check.holds("nothing was done", not (place / "done").exists(), "no file")

# A library runs code when it is loaded.
write("library.c", f"""#include <stdlib.h>
__attribute__((constructor)) static void Load(void) {{ if (system("{TOUCH}")) exit(1); }}
void umat_(void) {{}}
""")
subprocess.run(["gcc", "-shared", "-fPIC", "-o", place / "library.so", place / "library.c"], check=True)
MATERIAL = [f"bodies.0.material={{law: umat, E: 1, nu: 0.3, library: {place}/library.so}}"]
for mode in ("-check", "-mesh", "-quiet"):
    finished = run(args, SCENES / "wrong_mesh.yaml", mode, out="check", must=None,
                   overrides=[f"mesh.file={place}/plain.geo", *MATERIAL])
    says(f"library, {mode}: refused", r"-set bodies.0.material: bodies.0.material.library: \S*library.so is a library",
         finished)
    check.holds(f"library, {mode}: exit 1, not loaded", finished.status == 1 and not (place / "done").exists(),
                f"status {finished.status}")
trusted = scene(place / "plain.geo", "-trust", overrides=MATERIAL)
check.holds("library, -trust: loaded", trusted.status == 0 and (place / "done").exists(), trusted.text.strip()[-200:])
(place / "done").unlink()

# Decks: each begins with these lines and goes on with a whole deck.
DECKS = {
    "circle": ("*INCLUDE, INPUT=circle.inp", "include each other"),
    "device": ("*INCLUDE, INPUT=/dev/zero", "/dev/zero is no file"),
    "pipe": ("*INCLUDE, INPUT=pipe", "pipe is no file"),
    "folder": ("*INCLUDE, INPUT=sub", "sub is no file"),
    "no_deck": ("*INCLUDE, INPUT=numbers.txt", r"numbers.txt:1: data stand before any card"),
    "memory": ("*NSET, NSET=many, GENERATE\n1, 2000000000", r"memory.inp:1: \*NSET, GENERATE: 1, 2000000000; allowed"),
    "no_step": ("*NSET, NSET=many, GENERATE\n1, 9, 0", r"no_step.inp:1: \*NSET, GENERATE: 1, 9, 0; allowed"),
    "in_itself": ("*SOLID SECTION, ELSET=a, MATERIAL=soft\n*ELSET, ELSET=a\nb\n*ELSET, ELSET=b\na", "contains itself"),
    "word": ("*NODE\n1, zero, 0, 0", r"word.inp:1: \*NODE: what is no number"),
    "short": ("*NODE\n1\n*ELASTIC\n", r"short.inp:\d+: \*ELASTIC"),
}
os.mkfifo(place / "pipe")
write("numbers.txt", "1\n")
for name, (lines, pattern) in DECKS.items():
    write(f"{name}.inp", f"{lines}\n" + (SCENES / "deck_stack.inp").read_text())
    before = footprint()
    finished = subprocess.run([pathlib.Path(args.burnish).resolve(), "-import", f"{name}.inp"], cwd=place, timeout=60,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    check.holds(f"deck {name}: refused", finished.returncode == 1 and re.search(pattern, finished.stdout) and
                footprint() == before, finished.stdout.strip()[-300:])

# With -trust the same commands run, and files of names that are made while gmsh runs make a new mesh when they change.
trusted = scene(place / "printf.geo", "-trust")
check.holds("-trust: taken", trusted.status == 0 and (place / "done").exists(), trusted.text.strip()[-200:])
READS = {
    "include": ('Include "number.geo";', ()),
    "variable_of_a_name": ('DefineConstant[f = {"number.geo", Name "x"}]; Merge Str(f);', ()),
    "list_from_file": ('l() = ListFromFile("numbers.txt"); lx = l(0);', ()),
    "made_name_trusted": ('Include Sprintf("numbe%gr.geo", 1);', ("-trust",)),
}
for name, (command, options) in READS.items():
    write("number.geo", "lx = 1;\n")
    write("numbe1r.geo", "lx = 1;\n")
    write("numbers.txt", "1\n")
    geometry = write(f"reads_{name}.geo", SQUARE.replace("middle = invert", f"{command}\nmiddle = invert"))
    first, again = mesh(geometry, *options), mesh(geometry, *options)
    write("number.geo", "lx = 2;\n")
    write("numbe1r.geo", "lx = 2;\n")
    write("numbers.txt", "2\n")
    other = mesh(geometry, *options)
    check.holds(f"{name}: a changed file makes a new mesh", isinstance(first, bytes) and first == again != other,
                first[:200] if isinstance(first, str) else "")
check.finish()
