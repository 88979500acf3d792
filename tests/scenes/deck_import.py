"""burnish -import turns a deck into a scene: two blocks that a pressure, forces and a weight press on each other over
two steps, against the closed form of bars in series; a plate in plane stress against its closed form; friction that
changes from step to step; nodes that are moved onto the other surface; cards that are not available are named; no file is overwritten."""
import pathlib
import shutil
import subprocess

import numpy
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

head, _, rest = (SCENES / "deck_stack.inp").read_text().partition("*NODE, NSET=all\n")
nodes, _, rest = rest.partition("*")
(place / "nodes.txt").write_text(nodes)
(place / "split.inp").write_text(f"{head}*NODE, NSET=all\n*INCLUDE, INPUT=nodes.txt\n*{rest}")
made = imported(place / "split.inp")
check.holds("lines of data in a file of their own", made.returncode == 0 and
            (place / "split.msh").read_text() == (place / "deck_stack.msh").read_text(), made.stdout)
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


def scene_of(name, *changes):
    """Lines that the import prints, and the scene, of a deck with some texts changed."""
    return imported(variant(f"{name}.inp", *changes)).stdout, (place / f"{name}.yaml").read_text()


said, text = scene_of("rubbing", ("=LINEAR\n1000.\n", "=LINEAR\n1000.\n*FRICTION\n0.1, 500.\n"),
                      ("*TEMPERATURE\nall, 20.", "*CHANGE FRICTION, INTERACTION=touch\n*FRICTION\n0.4, 500."))
check.holds("friction that changes with the second step", "friction: {mu: 0.4, stick: {penalty: 500}, history: "
            "[[0, 0.25], [0.5, 0.25], [0.5005, 1], [1, 1]]}" in text and "missing:" not in said, text)
check.holds("contact as the deck has it", "smoother: facet, formulation: surface_to_surface" in text)
said, text = scene_of("apart", ("11, 0., 0., 1.\n12, 1., 0., 1.", "11, 0., 0., 1.3\n12, 1., 0., 1.2"),
                      ("*CONTACT PAIR, INTERACTION=touch, TYPE=SURFACE TO SURFACE",
                       "*NSET, NSET=near\n11\n*CONTACT PAIR, INTERACTION=touch, ADJUST=near, TYPE=NODE TO SURFACE"))
check.holds("ADJUST with a set moves its nodes alone", "ADJUST moved 1 nodes by up to 0.3" in said, said)
check.holds("nodes against faces", "formulation: node_to_surface" in text)
said, _ = scene_of("lonely", ("18, 0., 1., 2.\n", "18, 0., 1., 2.\n99, 5., 5., 5.\n"),
                   ("lid, 3, -0.5", "lid, 3, -0.5\n99, 3, 1."))
check.holds("nodes without elements are named", "'99' has 1 nodes that belong to no element" in said, said)
(place / "plane.inp").write_text("""*NODE
1, 0., 0.
2, 2., 0.
3, 2., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=plate
1, 1, 2, 3, 4
*MATERIAL, NAME=steel
*ELASTIC
1000., 0.3
*EXPANSION
1e-5
*SOLID SECTION, ELSET=plate, MATERIAL=steel
0.5
*BOUNDARY
1, 1, 2
4, 1, 1
*STEP
*STATIC
*CLOAD
2, 1, 2.5
3, 1, 2.5
*END STEP
""")
said = imported(place / "plane.inp").stdout
text = (place / "plane.yaml").read_text()
check.holds("plane stress with its thickness", "geometry: plane_stress\nthickness: 0.5\n" in text and "plane stress" not in said,
            said)
again = imported(place / "plane.inp")
check.holds("a scene that is there is kept, with a code", again.returncode == 1 and again.stdout.rstrip().endswith("[B147]"),
            again.stdout)
fields = run(args, place / "plane.yaml", out="plane", ranks=1).fields()
check.near("a plate that is pulled grows as in plane stress", fields["displacement"][fields["nodes"][:, 0] > 1, 0],
           2 * 10 / 1000, 1e-9)
check.near("and thins as in plane stress", numpy.ptp(fields["displacement"][:, 1]), 0.3 * 10 / 1000, 1e-9)
rubber = (("*ELASTIC\n1000., 0.", "*HYPERELASTIC, NEO HOOKE\n0.5, 0.02"), ("*STEP\n", "*STEP, NLGEOM\n"))
imported(variant("rubber.inp", *rubber))
text = (place / "rubber.yaml").read_text()
check.holds("rubber at finite strains", "{law: isochoric_neo_hookean, mu: 1, K: 100}" in text and "kinematics: finite" in text)
check.finish()
