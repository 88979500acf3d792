"""Motions that neither contact nor a load acts along stay tied to the end and are named: whole crossed cylinders, which
only the unevenness of their meshes drives. A motion that contact
comes to hold is released: a block whose lower side is a little round tilts under a load that is off its middle."""
from harness import Check, arguments, run, SCENES

args = arguments()
check = Check()
SCENE = SCENES / "tied_motions.yaml"
BLOCK = ("mesh.parameters={kind: 1, fine: 0.1}", "geometry=plane_strain",
         "bodies=[{volume: body, material: {law: svk, E: 1000, nu: 0.3}}]", "supports=[]",
         "loads=[{surface: top, traction: [0, '-20*(1 + 0.03*x)']}]",
         "contact=[{name: contact, slave: skin, master: {plane: {point: [0, -0.01], normal: [0, 1]}}}]")

fine = run(args, SCENE, out="crossed")
crossed = fine.summary()
held = crossed["stabilisation"]
check.holds("crossed: no failed step", crossed["steps_failed"] == 0, str(crossed["steps_failed"]))
check.holds("crossed: iterations", crossed["newton_iterations"] <= 5 * crossed["steps"],
            f"{crossed['newton_iterations']} in {crossed['steps']} steps")
for motion in ("rotation about x", "rotation about y", "rotation about z"):
    check.holds(f"crossed: names {motion}", motion in held["held_by_springs"], held["held_by_springs"])
check.holds("crossed: names both translations", held["held_by_springs"].count("translation along") == 2,
            held["held_by_springs"])
check.holds("crossed: ties hold what unevenness asks for", held["held_force_share"] < 5e-3,
            str(held["held_force_share"]))
LOWER = "which finer faces where they touch lower"
check.holds("crossed: that is little", LOWER not in fine.text, str(held["held_force_share"]))
crossed = run(args, SCENE, out="coarse", overrides=("mesh.parameters.fine=0.6",))
held = crossed.summary()["stabilisation"]["held_force_share"]
check.holds("coarse: ties hold more, and the last screen says what lowers it", held > 1e-3 and LOWER in crossed.text,
            str(held))

block = run(args, SCENE, out="block", overrides=BLOCK).summary()
held = block["stabilisation"]
check.holds("block: no failed step", block["steps_failed"] == 0, str(block["steps_failed"]))
check.holds("block: iterations", block["newton_iterations"] <= 5 * block["steps"] + 2,
            f"{block['newton_iterations']} in {block['steps']} steps")
check.near("block: force", block["probes"]["force"], -40, 1e-3 * 40)
check.holds("block: contact holds the tilt", "rotation" not in held["held_by_springs"], held["held_by_springs"])
check.holds("block: names what stays free", "translation along x" in held["held_by_springs"], held["held_by_springs"])
check.holds("block: no tie bears a load", held["held_force_share"] < 1e-6, str(held["held_force_share"]))
check.finish()
