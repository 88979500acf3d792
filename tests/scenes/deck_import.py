"""burnish -import turns a deck into a scene: two blocks that a pressure, forces and a weight press on each other over two
steps, against the closed form of bars in series; cards that are not available are named; no file is overwritten."""
import pathlib
import shutil
import subprocess

from harness import SCENES, Check, arguments, run

args = arguments()
check = Check()
place = pathlib.Path(args.out).resolve() / "deck"
shutil.rmtree(place, ignore_errors=True)
place.mkdir(parents=True)


def imported(deck, *scene):
    return subprocess.run([pathlib.Path(args.burnish).resolve(), "-import", deck, *scene], cwd=place,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def variant(name, *changes):
    """A deck with some texts changed."""
    text = (SCENES / "deck_stack.inp").read_text()
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    (place / name).write_text(text)
    return place / name


made = imported(SCENES / "deck_stack.inp")
scene = place / "deck_stack.yaml"
check.holds("the deck is taken", made.returncode == 0 and scene.exists(), made.stdout)
check.holds("what is missing is named", "*TEMPERATURE: not available" in made.stdout, made.stdout)
text = scene.read_text()
check.holds("incompatible modes", "formulation: enhanced" in text and "formulation: full" in text)
check.holds("hardening", "hardening: {table: [[0, 50], [0.1, 60]]}" in text)
finished = run(args, scene, out="stack")
rows = finished.steps()
middle = min(rows, key=lambda row: abs(row["t"] - 0.5))
check.near("a step of the scene ends where the deck's does", middle["t"], 0.5, 1e-12)
check.near("contact after the first step", middle["contact_1_z"], -2, 1e-6)
check.near("contact after the second step", finished.summary()["probes"]["contact_1_z"], -4, 1e-6)
# 4 on all of it, half of the weight 2 of the lower block as a mean; pressure over penalty in the contact
fields = finished.fields()
check.near("way of the lid", fields["displacement"][fields["nodes"][:, 2] > 1.5, 2],
           -(4 / 2000 + 4 / 1000 + 1 / 1000 + 4 / 1000), 1e-6)

again = imported(SCENES / "deck_stack.inp")
check.holds("nothing is overwritten", again.returncode == 1 and "is there already" in again.stdout, again.stdout)
other = imported(SCENES / "deck_stack.inp", "other.yaml")
check.holds("another name", other.returncode == 0 and (place / "other.msh").exists(), other.stdout)
for what, changes, said in (
    ("no contact surface", [("*SURFACE, NAME=over", "*SURFACE, NAME=above")], "there is no surface 'over'"),
    ("no material", [("MATERIAL=soft", "MATERIAL=hard")], "there is no material 'HARD'"),
    ("no deck", [("*NODE, NSET=all", "*NODES, NSET=all")], "no nodes"),
):
    refused = imported(variant("wrong.inp", *changes), "wrong.yaml")
    check.holds(f"{what}: exit 1 and a message", refused.returncode == 1 and said in refused.stdout and
                not (place / "wrong.yaml").exists(), refused.stdout.strip()[-300:])
rubber = (("*ELASTIC\n1000., 0.", "*HYPERELASTIC, NEO HOOKE\n0.5, 0.02"), ("*STEP\n", "*STEP, NLGEOM\n"))
imported(variant("rubber.inp", *rubber))
text = (place / "rubber.yaml").read_text()
check.holds("rubber at finite strains", "{law: isochoric_neo_hookean, mu: 1, K: 100}" in text and "kinematics: finite" in text)
check.finish()
