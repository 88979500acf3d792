"""Each message of the page troubleshooting.md that a scene can make: it is made here, ends with its code, and -explain
prints the page's entry for it. Every phrase by which a code is found stands in a source, and every code in the page."""
import pathlib
import re
import shutil
import signal
import subprocess
import time

from harness import SCENES, Check, arguments, run

ROOT = SCENES.parent.parent
STACK, SQUARE, BEAMS = SCENES / "stack.yaml", SCENES / "wrong_mesh.yaml", SCENES / "crossed_beams.yaml"
BAR = SCENES / "held_bar.yaml"
args = arguments()
check = Check()
out = pathlib.Path(args.out).resolve()
SVK = "material: {law: svk, E: 1000, nu: 0.3}"
UNJUDGED = "output.certificate=false"
FREE = "supports=[{surface: lower_bottom, ux: 0, uy: 0}]"
FLOOR = ("mesh.parameters={floor: 1.5, thickness: 0.1}",
         f"bodies=[{{volume: lower, {SVK}}}, {{volume: floor, {SVK}}}, {{volume: upper, {SVK}}}]",
         "supports=[{surface: lower_bottom, ux: 0, uy: 0}, {surface: floor_bottom, ux: 0, uy: 0}]",
         "contact.0.master=tops", "contact.0.penalty.scale=1e-4", "loads.0.uy=-1.5", "stepping.initial=0.1", UNJUDGED)
RUBBER = "bodies.0.material={law: mooney_rivlin, c10: 1, c01: -0.4, K: 100}"
# Code: scene, options, edits; those of exit status 2 and warnings are solved, the others checked
INPUT = {
    "B100": (STACK, (), ["contact.0.penalty={adjust: true, g_min: 2, g_max: 1, unit: length}"]),
    "B101": (STACK, (), ["bodies.0.material.young=1000"]),
    "B102": (STACK, (), ["bodies.0.material.E=steel"]),
    "B103": (STACK, (), ["loads.0={surface: upper_top, uy: -1"]),
    "B104": (STACK, (), ["mesh.file=nowhere.geo"]),
    "B105": (STACK, (), ["supports.0.surface=nowhere"]),
    "B106": (SQUARE, (), ["mesh.file={}/serendipity.msh", "mesh.order=2"]),
    "B107": (STACK, (), ["supports=[{surface: upper_top, ux: 0}]", "contact=[]", "probes=[]",
                         "loads=[{surface: upper_top, uy: -1}]"]),
    "B108": (STACK, (), ["mesh.parameters={gap: -0.1}"]),
    "B109": (STACK, (), ["mesh.parameters={gap: -0.9}"]),
    "B111": (SQUARE, (), ["mesh.parameters.invert=1"]),
    "B112": (SQUARE, (), ["mesh.file={}/broken.geo"]),
    "B113": (SQUARE, (), ["mesh.file={}/hostile.geo"]),
    "B115": (STACK, (), ["probes=[{name: u, displacement: [0.123, 9], component: y}]"]),
    "B117": (STACK, (), ["probes=[{name: u, reaction: upper_top}]"]),
    "B119": (STACK, (), ["loads.0.uy=\"3*q\""]),
    "B121": (STACK, (), ["loads.0.history={csv: \"{}/wrong.csv\"}"]),
    "B122": (STACK, (), ["loads.0.during=press"]),
    "B130": (BAR, (), ["bodies.0={volume: bar, material: {law: linear, mu: 1000, nu: 0.5}, formulation: mixed}",
                       "mesh.order=2", "supports.0.ux=0", "supports.4={surface: right, ux: 0}"]),
    "B131": (BAR, (), ["supports.2={surface: high, uy: 0, spring: [1, 0], during: pull}"]),
    "B132": (BAR, (), ["cyclic={surfaces: [left, right], axis: z}"]),
    "B137": (SQUARE, (), ["mesh.file={}/twice.geo"]),
    "B143": (STACK, (), ["sensitivity=[\"force:contact.0.name\"]"]),
    "B144": (SCENES / "uplift.yaml", (), ["sensitivity=[\"seal:loads.0.pressure\"]"]),
    "B145": (STACK, (), ["sensitivity=[\"force:mesh.parameters.n_lower\"]", "mesh.parameters.n_lower=6"]),
    "B123": (STACK, (), ["geometry=plane_stress", "bodies.0.formulation=fbar"]),
}
UNSOLVED = {
    "B201": (STACK, (), ["solver.max_iterations=1", "solver.tolerance=1e-14", "stepping={dt_min: 0.2, damping: none}"]),
    "B136": (BEAMS, (), []),
    "B202": (STACK, (), ["contact.0.penalty.scale=1e-4", "loads.0.uy=-3.5", "stepping.initial=0.1"]),
    "B203": (SQUARE, (), ["loads.0.ux=-1.5", "kinematics=finite", "bodies.0.material.law=svk", "stepping.dt_min=0.1"]),
    "B204": (STACK, (), [FREE, "loads=[{surface: upper_top, pressure: 10}]", "contact.0.stabilise=false"]),
    "B205": (STACK, (), list(FLOOR)),
}
WARNINGS = {
    "B501": (STACK, ("-check", ), [RUBBER]),
    "B502": (STACK, (), ["loads.0.uy=-300"]),
    "B503": (STACK, (), ["bodies.0.material.nu=0.499", "bodies.0.formulation=full"]),
    "B505": (STACK, ("-no_such_option", "1"), ["loads.0.uy=-0.01"]),
    "B506": (STACK, (), ["loads.0.uy=-0.01"]),
    "B507": (STACK, (), ["contact.0.penalty.scale=1e-4", "loads.0.uy=-3.5", "stepping.initial=0.1", UNJUDGED]),
}
SQUARE_GEO = (ROOT / "meshes/square.geo").read_text()
TWICE = """Point(1) = {0, 0, 0, 0.5}; Point(2) = {1, 0, 0, 0.5}; Point(3) = {1, 1, 0, 0.5}; Point(4) = {0, 1, 0, 0.5};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1}; Plane Surface(2) = {1};
Physical Surface("block") = {1, 2}; Physical Curve("y_min") = {1}; Physical Curve("x_max") = {2};
Physical Curve("y_max") = {3}; Physical Curve("x_min") = {4};
"""
FILES = {"wrong.csv": "0,0\n0.5,much\n", "twice.geo": TWICE, "broken.geo": "Point(1) = {0, 0, 0;\n", "hostile.geo": SQUARE_GEO + 'SystemCall "true";\n'}


def explained(code):
    return subprocess.run([args.burnish, "-explain", code], capture_output=True, text=True)


def made(code, scene, options, edits, status, *command):
    finished = run(args, scene, *command, *options, out=code, must=None,
                   overrides=[edit.replace("{}", str(out)) for edit in edits])
    ends = [line for line in finished.text.splitlines() if line.rstrip().endswith(f"[{code}]")]
    check.holds(f"{code}: made, with its code at the end", ends and finished.status in status,
                "" if ends else f"exit {finished.status}: {finished.text.strip()[-400:]}")


def table():
    """Codes and phrases of the program's table."""
    text = (ROOT / "src/base/explanation.c").read_text()
    for code, phrases in re.findall(r'\{"(B\d+)",\s*\{((?:"(?:[^"\\]|\\.)*"(?:,\s*)?)+)\}', text):
        yield code, re.findall(r'"((?:[^"\\]|\\.)*)"', phrases)


shutil.rmtree(out, ignore_errors=True)  # B300 waits for a file of its run
out.mkdir(parents=True)
for name, text in FILES.items():
    (out / name).write_text(text)
subprocess.run(["gmsh", str(ROOT / "meshes/square.geo"), "-2", "-nt", "1", "-format", "msh41", "-order", "2",
                "-setnumber", "Mesh.SecondOrderIncomplete", "1", "-o", str(out / "serendipity.msh")], check=True,
               stdout=subprocess.DEVNULL)

for code, case in INPUT.items():
    made(code, *case, (1, ), "-check")
for code, case in UNSOLVED.items():
    made(code, *case, (2, ))
for code, case in WARNINGS.items():
    made(code, *case, (0, 2))

first = run(args, STACK, out="B110", overrides=["loads.0.uy=-0.01"])
again = run(args, STACK, out="B110", overrides=["loads.0.uy=-0.02"], keep=True, must=None)
check.holds("B110: another scene's results", again.status == 1 and again.text.rstrip().endswith("[B110]"), again.text)
many = run(args, SQUARE, out="B114", ranks=5, must=None)
check.holds("B114: more ranks than elements", many.status == 1 and "[B114]" in many.text, many.text[-400:])
usage = subprocess.run([args.burnish, "-wrong"], capture_output=True, text=True)
check.holds("B120: the command line", usage.returncode == 1 and "[B120]\nusage" in usage.stderr, usage.stderr)
short = run(args, ROOT / "runs/cook.yaml", "-to", "1", "-probe", "tip_uy", out="B153", overrides=["accuracy.meshes=1"], must=5)
check.holds("B153: an accuracy that is not reached", short.text.rstrip().endswith("[B153]"), short.text[-400:])
slow = subprocess.Popen([args.burnish, str(STACK), "-o", str(out / "B300"), "-set", "stepping.initial=1e-4", "-set",
                         "stepping.control=fixed"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
while not (out / "B300/steps.csv").exists() and slow.poll() is None:
    time.sleep(0.05)
slow.send_signal(signal.SIGTERM)
check.holds("B300: a signal", "[B300]" in slow.communicate()[1] and slow.returncode == 3, f"exit {slow.returncode}")

sources = " ".join(re.sub(r'"\s*"', "", path.read_text()) for path in (*(ROOT / "src").glob("*/*.c"), *(ROOT / "scripts").glob("*.py"))
                   if path.name != "explanation.c")
entries = dict(table())
stale = [f"{code}: {phrase}" for code, phrases in entries.items() for phrase in phrases if phrase not in sources]
check.holds(f"{len(entries)} entries: their phrases stand in the sources", len(entries) > 20 and not stale, str(stale))
page = (ROOT / "doc/pages/troubleshooting.md").read_text()
said = explained("all").stdout
codes = re.findall(r"^(B\d+)  ", said, re.M)
check.holds("the codes are different ones", len(codes) == len(set(codes)), str(codes))
for code in codes:
    entry = explained(code)
    check.holds(f"{code}: -explain and page", entry.returncode == 0 and entry.stdout in said and f"| {code} |" in page)
unknown = explained("B999")
check.holds("no such code", unknown.returncode == 1 and unknown.stderr.count("\n") == 1, unknown.stderr)
check.finish()
