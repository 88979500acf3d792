"""Facets that serve past the end of a tool that has turned are lifted to its surface as it is then: a pin with play in
a bore that has made a quarter of a turn is pressed as one in a bore that has not."""
from harness import Check, arguments, run, SCENES

args = arguments()
check = Check()
runs = [
    run(args, SCENES / "turned_bore.yaml", out=f"by_{turn}", overrides=[f"bodies.1.rigid.motion.0.rz={turn}"]).steps()
    for turn in (0, 90)
]
free = [row["force"] for steps in runs for row in steps if row["t"] <= 0.5]
check.holds("the pin is free while the bore turns", len(free) > 2 and not any(free), str(free))
still, turned = runs[0][-1], runs[1][-1]
check.holds("it is pressed in the end", still["contact_nodes"] > 0)
check.near("force after a quarter of a turn", turned["force"], still["force"], 1e-6 * abs(still["force"]))
check.holds("nodes in contact", turned["contact_nodes"] == still["contact_nodes"])
check.finish()
