"""A hollow ball of neo-Hookean rubber that a pressure blows up carries a limit pressure only. The run ends at it, says
that it is a limit load, and at which t. A ball that was turned inside out through its centre has no place in an
axisymmetric scene. Closed form: with the stretches a of the bore and b of the outside, p = mu (f(b) - f(a)), f(x) =
(4/x + 1/x^4)/2 and b^3 - 1 = (A/B)^3 (a^3 - 1)."""
import re

from harness import Check, arguments, run, SCENES

A, B, MU, PRESSURE = 10, 11, 1, 0.15
args = arguments()
check = Check()


def pressure(a):
    b = (1 + (A / B)**3 * (a**3 - 1))**(1 / 3)
    return MU * (2 / b + b**-4 / 2 - 2 / a - a**-4 / 2)


limit = max(pressure(1 + i / 1e4) for i in range(1, 10000)) / PRESSURE
ended = run(args, SCENES / "balloon.yaml", out="balloon", must=None)
check.holds("exit 2", ended.status == 2, str(ended.status))
check.near("t at the end", ended.summary()["t"], limit, 1e-3)
check.holds("has its code", "[B155]" in ended.text)
said = re.search(r"as before a limit load at t = ([0-9.]+)", ended.text)
check.holds("says that it is a limit load", said is not None)
if said:
    check.near("t that it says", float(said[1]), limit, 1e-3)
check.finish()
