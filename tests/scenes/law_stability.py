"""What -check says of the stability of laws of rubber: the stretches at which it is lost, and nothing of laws that keep
it."""
import math

from harness import Check, arguments, run, SCENES

args = arguments()
check = Check()


def told(material, *more):
    overrides = [f"bodies.0.material={{{material}, nu: 0.49}}", *more]
    return run(args, SCENES / "rubber.yaml", "-check", overrides=overrides).text


# The shear across two directions ends where c10 + c01 l^2 = 0 with the third stretch l, here before all else.
text = told("law: mooney_rivlin, c10: 0.3, c01: -0.05")
check.holds("warning", text.count("warning:") == 1 and "mooney_rivlin loses its stability (Drucker)" in text)
check.holds("stretch", f"in uniaxial tension at the stretch {math.sqrt(6):.3g}" in text)
check.holds("place", "-set bodies.0.material: mooney_rivlin" in text)
check.holds("range", f"to {math.sqrt(6):.3g} (uniaxial)" in text)
text = told("law: ogden, terms: [[0.63, 1.3], [0.0012, 5], [-0.01, -2]]")
ranges = "0.1 to 10 (uniaxial), 0.1 to 10 (equibiaxial), 0.1 to 10 (planar)"
check.holds("stable", f"stable for stretches of {ranges}" in text)
check.holds("no warning", "warning:" not in text)
check.holds("small strains", "law " not in told("law: yeoh, c10: 0.2, c20: -0.1", "kinematics=small"))
check.holds("neo-Hooke", "law " not in told("law: neo_hookean, mu: 1"))
check.finish()
