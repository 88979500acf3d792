"""A slave that goes on past the ends of its master has the same contact as with the two exchanged."""
from harness import Check, arguments, run, SCENES

LENGTHS = 6 / 8  # of the hub over that of the shaft's surface, over which pressures are averaged
EXCHANGED = ["contact.0.slave=bore", "contact.0.master=journal"]

args = arguments()
check = Check()
for order in 1, 2:
    probes = {}
    for name, overrides in ("shaft", []), ("hub", EXCHANGED):
        finished = run(args, SCENES / "long_shaft.yaml", out=f"{name}_{order}",
                       overrides=[f"mesh.order={order}", *overrides])
        probes[name] = finished.summary()["probes"]
        check.holds(f"order {order}, {name} as slave: no failed steps", finished.summary()["steps_failed"] == 0)
    check.near(f"order {order}: mean pressure", probes["shaft"]["mean"] / LENGTHS / probes["hub"]["mean"], 1, 0.01)
    check.near(f"order {order}: pull", probes["shaft"]["pull"] / probes["hub"]["pull"], 1, 0.02)
check.finish()
