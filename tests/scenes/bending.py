"""A beam in pure bending, with elements of first order: the part of its energy in strains that vary within elements is
that of the closed form, and advice is given where that is much."""
import re

from harness import Check, arguments, run, SCENES

WIDTH = 8  # over its height
SHEAR = 0.5  # shear that square elements store, over what they store by bending in one element across

args = arguments()
check = Check()


def bend(name, m, *overrides):
    """Advised part in per cent of a beam of m elements across, None without advice."""
    done = run(args, SCENES / "bending.yaml", out=name,
               overrides=(f"mesh.parameters.m={m}", f"mesh.parameters.n={WIDTH * m}", "output.every=0", *overrides))
    found = re.search(r"body 'plate' stores (\d+) % of its energy in strains that vary", done.text)
    return int(found.group(1)) if found else None


for m in (1, 2, 4):
    part = bend(f"m_{m}", m)
    share = 100 * (1 + SHEAR) / (m**2 + SHEAR)
    if share > 20:
        check.holds(f"{m} across: advised", part == round(share), f"{part}, {share:.1f} %")
    else:
        check.holds(f"{m} across: not advised", part is None, str(part))
part = bend("finite", 2, "kinematics=finite", "bodies.0.material.law=svk")
check.holds("large strains: advised", part == 33, str(part))
part = bend("order_2", 2, "mesh.order=2")
check.holds("order 2: not advised", part is None, str(part))
part = bend("enhanced", 2, "bodies.0.formulation=enhanced")
check.holds("enhanced: not advised", part is None, str(part))
part = bend("stretched", 2, "loads.0.ux=1e-4*t")
check.holds("stretched: not advised", part is None, str(part))
check.finish()
