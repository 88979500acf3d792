"""contact.frame: global fits the whole master over one reference plane. On a flat master that plane is the local one
of every slave point, so that all fields agree. On the cap of a sphere, which turns by 19 degrees, the two frames
fit the same surface with other polynomials: pressure and radius of the contact agree to a small part of what the
mesh leaves to Hertz's answer."""
import math

import numpy

from harness import Check, arguments, run, SCENES

DIFFUSE = ["contact.0.smoother=diffuse"]
# Hertz, a quarter of the whole: a^3 = 3 F R / (4 E*), p_0 = 3 F / (2 pi a^2) with 1 / E* = (1 - nu^2) (1 / E_1 + 1 /
# E_2).
FORCE, RADIUS, STIFFNESS = 4 * 1.5024 * 16**2, 50.0, 1 / ((1 - 0.3**2) * (1 / 210000 + 1 / 70000))
A = (3 * FORCE * RADIUS / (4 * STIFFNESS)) ** (1 / 3)
PEAK = 3 * FORCE / (2 * math.pi * A**2)
# Relative errors: measured 0.05 for two elements on the contact's radius, and 1e-5 of one frame against the other.
OF_MESH, OF_FRAME = 0.06, 1e-4

args = arguments()
check = Check()
flat = {
    frame:
    run(args, SCENES / "contact_patch.yaml", out=f"flat_{frame}",
        overrides=[*DIFFUSE, "contact.0.degree=2", f"contact.0.frame={frame}"])
    for frame in ("local", "global")
}
check.holds("flat: every slave point has a fit",
            all(each.summary()["contact"][0]["fall_backs"] == 0 for each in flat.values()))
ours, theirs = (flat[frame].fields() for frame in ("global", "local"))
for name in ("displacement", "stress", "contact/joint/pressure", "contact/joint/normal"):
    check.near(f"flat: {name}", ours[name], theirs[name], 1e-9 * numpy.max(numpy.abs(theirs[name])))
caps = {
    frame:
    run(args, SCENES / "../../runs/hertz_sphere.yaml", out=f"cap_{frame}",
        overrides=[*DIFFUSE, f"contact.0.frame={frame}", "mesh.parameters.n=3"])
    for frame in ("local", "global")
}
ours, theirs = (caps[frame].summary()["probes"] for frame in ("global", "local"))
for name, exact in (("radius", A), ("peak_pressure", PEAK)):
    check.near(f"cap: {name}, global against local", ours[name], theirs[name], OF_FRAME * exact)
    check.near(f"cap: {name} against Hertz", ours[name], exact, OF_MESH * exact)
check.near("cap: force", ours["force"], FORCE / 4, 1e-6 * FORCE)
check.holds(
    "cap: the frames are two", caps["global"].summary()["contact"][0]["smoothing_error"]
    != caps["local"].summary()["contact"][0]["smoothing_error"])
check.finish()
