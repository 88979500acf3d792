"""Rigid motions that supports leave are found before solving and named by body and direction: in the plane,
axisymmetric and solid, held by contact only or by nothing."""
import pathlib
import re

from harness import Check, arguments, run, SCENES

PLANE, SOLID, BLOCKS = SCENES / "patch_plane.yaml", SCENES / "patch.yaml", SCENES / "contact_patch.yaml"
X, Y, Z = r"x, \(1, 0, 0\)", r"y, \(0, 1, 0\)", r"z, \(0, 0, 1\)"
NOTHING, NO_PAIR, NO_WAY = "NOTHING holds it, ", "and no contact pair knows the body", "contact does not act that way"
CASES = {  # scene, overrides, what the lines say, exit status
    "plane, free": (
        PLANE,
        [],
        [
            r"block: rotation in the plane about \(1, 0.5\): " + NOTHING + NO_PAIR,
            r"block: translation along x, \(1, 0\): ",
            r"block: translation along y, \(0, 1\): ",
        ],
        1,
    ),
    "plane, on a line": (
        PLANE,
        ["supports=[{surface: y_min, uy: 0}]"],
        [r"block: translation along x, \(1, 0\): " + NOTHING],
        1,
    ),
    "plane, at a point": (
        PLANE,
        ["supports=[{surface: origin, ux: 0, uy: 0}]"],
        [r"block: rotation in the plane about \(0, 0\): " + NOTHING],
        1,
    ),
    "axisymmetric": (PLANE, ["geometry=axisymmetric"], [r"block: translation along y, \(0, 1\): " + NOTHING], 1),
    "solid, free": (
        SOLID,
        [],
        [rf"block: rotation about {axis}, through \(1, 0.5, 0.75\): " for axis in (X, Y, Z)]
        + [f"block: translation along {axis}: " for axis in (X, Y, Z)],
        1,
    ),
    "solid, at a point": (
        SOLID,
        ["supports=[{surface: origin, ux: 0, uy: 0, uz: 0}]"],
        [
            rf"block: rotation about {axis}, through \({point}\): "
            for axis, point in ((X, "1, 0, 0"), (Y, "0, 0.5, 0"), (Z, "0, 0, 0.75"))
        ],
        1,
    ),
    "solid, on a plane that moves": (
        SOLID,
        ["loads=[{surface: y_min, uy: 1}]"],
        [
            rf"block: rotation about {Y}, through \(1, 0.5, 0.75\): ",
            f"block: translation along {X}: ",
            f"block: translation along {Z}: ",
        ],
        1,
    ),
    "held by contact only": (
        BLOCKS,
        [],
        [
            "held by supports and imposed displacements: lower",
            rf"upper: translation along {Y}: held by contact only \(joint\)",
        ],
        0,
    ),
    "contact in the plane": (
        BLOCKS,
        [
            "mesh.parameters.solid=0",
            "geometry=plane_strain",
            "supports=[{surface: lower_bottom, uy: 0}, {surface: symmetry_x, ux: 0}]",
        ],
        ["held by .*: lower", r"upper: translation along y, \(0, 1\): held by contact only"],
        0,
    ),
    "along the contact": (
        BLOCKS,
        ["supports=[{surface: lower_bottom, ux: 0, uy: 0, uz: 0}, {surface: symmetry_z, uz: " "0}]"],
        [
            "held by .*: lower",
            rf"upper: rotation about {Z}, through .*: held by contact only",
            rf"upper: translation along {Y}: held by contact only",
            rf"upper: translation along {X}: {NOTHING}{NO_WAY}",
        ],
        0,
    ),
    "both together": (
        BLOCKS,
        ["supports=[{surface: symmetry_x, ux: 0}, {surface: symmetry_z, uz: 0}]"],
        [
            rf"lower: translation along {Y}: held by contact only",
            rf"upper: translation along {Y}: held " r"by contact only",
            rf"lower: translation along {Y}; with " rf"it upper: translation along {Y}: " rf"{NOTHING}{NO_WAY}",
        ],
        0,
    ),
}

FEW = ("axisymmetric", "solid, at a point", "both together")

args = arguments(("cases", "all of them, or a few", ("all", "few")))
check = Check()
for name, (scene, overrides, expected, status) in CASES.items():
    if args.cases == "few" and name not in FEW:
        continue
    finished = run(args, scene, "-check", out=re.sub(r"\W+", "_", name), overrides=overrides, must=status)
    lines = re.findall(r"^motion   (.*)$", finished.text, re.MULTILINE)
    check.holds(name,
                len(lines) == len(expected) and all(re.match(pattern, line) for pattern, line in zip(expected, lines)),
                " | ".join(lines))

# A body of two parts that hang together by nothing: each is a body of its own to the supports.
parts = pathlib.Path(args.out).resolve() / "parts.geo"
parts.parent.mkdir(parents=True, exist_ok=True)
parts.write_text("""SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 1, 1};
Rectangle(2) = {3, 0, 0, 1, 1};
MeshSize{:} = 0.5;
Physical Surface("block") = {1, 2};
Physical Curve("held") = {4};
""")
text = run(args, PLANE, "-check", out="parts",
           overrides=[f"mesh={{file: {parts}}}", "supports=[{surface: held, ux: 0, uy: 0}]"], must=1).text
lines = re.findall(r"^motion   (.*)$", text, re.MULTILINE)
check.holds(
    "a body of two parts",
    len(lines) == 4 and re.match(r"held by .*: block \(its part with node 1\)", lines[0])
    and all(re.match(r"block \(its part with node 5\): (rotation|translation)", line) for line in lines[1:]),
    " | ".join(lines))

refused = run(args, PLANE, out="refused", overrides=["supports=[{surface: y_min, uy: 0}]"], must=1)
check.holds(
    "a run is refused",
    re.search(
        r"patch_plane.yaml:\d+: bodies.0.volume: body 'block' is free to move: translation along x, \(1, 0\); no "
        r"support",
        refused.text) is not None, refused.text.strip())
check.holds("nothing solved", not (refused.directory / "steps.csv").exists())
check.finish()
