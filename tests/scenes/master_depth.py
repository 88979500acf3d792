"""Penetration is reported from both sides: a ridge under the middle of a slave face stands in the slave while no slave
node stands in the ridge. Rigid and deformable ridges, plane and 3D, both orders; the same on 1, 2 and 3 ranks. Nodes past
the slave's ends and what chords of curved faces explain do not count."""
import re

import numpy
from harness import Check, arguments, run, SCENES

args = arguments()
check = Check()
RUNS = SCENES.parent.parent / "runs"
RIGID = ("mesh.parameters.rigid=1", "supports=[]",
         "bodies=[{volume: block, material: {law: neo_hookean, E: 100, nu: 0.3}}, {surface: ridge, rigid: {}}]")
SOLID = ("geometry=solid", "loads.0.uz=0")


def ridge(name, *overrides, ranks=1):
    return run(args, SCENES / "ridge.yaml", out=f"{name}-np{ranks}", ranks=ranks,
               overrides=("output.certificate=false", *overrides))


def depths(done):
    pair = done.summary()["contact"][0]
    return [pair[key] for key in ("master_depth", "master_depth_over_h", "master_depth_largest")]


def expected(done):
    """Distance of the ridge's edge, which stays at the origin, from the chord of the slave face over it."""
    fields = done.fields()
    x = fields["nodes"][:, :2] + fields["displacement"][:, :2]
    left, right = (x[numpy.argmin(numpy.linalg.norm(fields["nodes"][:, :2] - [at, 0], axis=1))] for at in (-0.4, 0.4))
    along = (right - left) / numpy.linalg.norm(right - left)
    return along[1] * left[0] - along[0] * left[1]


for name, overrides in (("plane, rigid", RIGID), ("plane", ()), ("solid, rigid", (
        "mesh.parameters={solid: 1, rigid: 1}", *RIGID[1:], *SOLID)), ("solid", (
            "mesh.parameters={solid: 1}", *SOLID, "supports.0.uz=0")), ("order 2, rigid", (*RIGID, "mesh.order=2"))):
    counts = (1, 2, 3) if name == "plane" else (1, 3)
    runs = [ridge(name.replace(", ", "_").replace(" ", "_"), *overrides, ranks=ranks) for ranks in counts]
    pair = runs[0].summary()["contact"][0]
    if name == "plane, rigid":
        check.near(f"{name}: depth of the edge", pair["master_depth"], expected(runs[0]), 1e-12)
        check.near(f"{name}: over the face", pair["master_depth_over_h"], pair["master_depth"] / 0.8, 1e-12)
    for ranks, other in zip(counts[1:], runs[1:]):
        check.near(f"{name}: {ranks} ranks alike", depths(other), depths(runs[0]), 1e-9)
        check.holds(f"{name}: {ranks} ranks, the same node",
                    other.summary()["contact"][0]["master_depth_node"] == pair["master_depth_node"])
    check.holds(f"{name}: the master's side is ten times the slave's", pair["master_depth"] > 10 * pair["max_penetration"],
                f"{pair['master_depth']:.3g}, {pair['max_penetration']:.3g}")
    line = re.search(r"^sides    edge: the master's side is the larger: its node (\d+) .* stands (\S+) ", runs[0].text,
                     re.MULTILINE)
    check.holds(f"{name}: the last screen names the larger", line and line[2] == f"{pair['master_depth']:.3g}"
                and int(line[1]) == pair["master_depth_node"])

# No slave point sees the ridge. The certificate does, and names it.
for ranks in (1, 3):
    refused = run(args, SCENES / "ridge.yaml", out=f"refused-np{ranks}", ranks=ranks, must=2)
    check.holds(f"the certificate refuses the ridge, {ranks} ranks",
                re.search(r"cannot be certified; contact 'edge': node \d+ \(0, 0, 0\) of 'ridge' stands ", refused.text))

# A master wider than the slave: seven nodes on it, five of them under the slave.
wide = run(args, SCENES / "stack.yaml", out="wide",
           overrides=("contact.0.penalty.scale=0.1", "contact.0.master=lower_all")).summary()["contact"][0]
check.holds("wide: no node past the slave's ends, none of the other sides", 3 <= wide["master_depth_nodes"] <= 5,
            str(wide["master_depth_nodes"]))
check.near("wide: both sides alike", wide["master_depth"], wide["max_penetration"], 0.1 * wide["max_penetration"])
# A concave slave: its chords stand in the master by far more than anything presses.
concave = run(args, RUNS / "ring_in_ring.yaml", out="concave", overrides=(
    "contact.0.slave=outer_contact", "contact.0.master=inner_contact")).summary()["contact"][0]
check.holds("concave: chords do not count", concave["master_depth"] < 1e-3 * concave["facet_error"],
            f"{concave['master_depth']:.3g}, {concave['facet_error']:.3g}")
# An overlap that the scene adds is one that both sides see.
added = run(args, SCENES / "stack.yaml", out="added", overrides=(
    "mesh.parameters.gap=0", "loads.0.uy=0", "contact.0.smoother=diffuse",
    "contact.0.formulation=surface_to_surface", "contact.0.initial_overlap={add: 0.02}")).summary()["contact"][0]
check.near("added: both sides alike", added["master_depth"], added["max_penetration"], 0.2 * added["max_penetration"])
check.holds("added: some of it is left", added["max_penetration"] > 1e-6)
analytic = run(args, SCENES / "ridge.yaml", out="analytic", overrides=(
    "contact.0.master={plane: {point: [0, 0], normal: [0, 1]}}", "mesh.parameters.rigid=1", "supports=[]",
    "bodies=[{volume: block, material: {law: neo_hookean, E: 100, nu: 0.3}}]"))
check.holds("analytic: there are no nodes", analytic.summary()["contact"][0]["master_depth"] is None)
check.finish()
