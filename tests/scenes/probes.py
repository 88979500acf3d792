"""Every kind of probe in two dimensions: on two blocks against exact values, on an arc pressed on a block against Hertz
and against the fields."""
import math

import numpy

from harness import Check, arguments, run, SCENES

TOLERANCE = 1e-9  # of the largest force, length or pressure
P, E, PENALTY, WIDTH, HEIGHT = 10, 1000, 1e5, 2, 1
ARC_E, ARC_NU, R, N_ARC = 1000, 0.3, 10, 24


def stretch():
    """Of St. Venant-Kirchhoff's law without lateral strain under a pressure on the reference area: -P = E s (s^2 - 1) /
    2, by Newton."""
    s = 1.0
    for _ in range(50):
        s -= (E * s * (s * s - 1) / 2 + P) / (E * (3 * s * s - 1) / 2)
    return s


def blocks(args, check, order):
    """nu = 0 and matching meshes: every line along y is in the same uniaxial state, and nothing moves along x."""
    axisymmetric = args.geometry == "axisymmetric"
    overrides = ["geometry=axisymmetric", "contact.0.symmetry=[]"] if axisymmetric else []
    finished = run(args, SCENES / "probes.yaml", out=f"order_{order}", overrides=[f"mesh.order={order}", *overrides])
    probes = finished.summary()["probes"]
    force = P * (math.pi * WIDTH**2 if axisymmetric else WIDTH)  # over 360 degrees
    squeeze = (1 - stretch()) * HEIGHT  # of one block
    gap = P / PENALTY  # penetration that carries the pressure
    diagonal = math.hypot(2, 2)
    deformed = math.hypot(2, 2 - 2 * squeeze - gap)
    expected = {
        "support": force,  # the support holds the lower block up
        "free": 0,  # nothing is prescribed there
        "push": -force,  # on the master, which is below
        "push_absolute": 2 * force,
        "push_x": 0,
        "lower_uy": -squeeze,
        "upper_uy": -squeeze - gap,  # the node of the other body at the same point
        "top_uy": -2 * squeeze - gap,
        "diagonal": deformed,
        "diagonal_change": deformed - diagonal,
        "joint_height": squeeze,  # factor -1 of a shortening
        "gap": -gap,
        "edge_max": WIDTH,  # in contact up to the end, which has not moved
        "edge_min": 0,  # the plane of symmetry, or the axis
        "peak": P,
        "peak_at": P,
        "mean": P,
        "deviation": 0,  # per cent
        "deviation_rms": 0,
        "deviation_excluding": 0,
        "deviation_only": 0,
    }
    check.holds("names of the probes", list(probes) == list(expected))
    for name, value in expected.items():
        scale = force if name in ("support", "free", "push", "push_absolute",
                                  "push_x") else 100 if "deviation" in name else P if name in ("peak", "peak_at",
                                                                                               "mean") else WIDTH
        check.near(name, probes[name], value, TOLERANCE * scale)
    last = finished.steps()[-1]
    check.holds("steps.csv has the summary's values",
                all(abs(last[name] - probes[name]) <= 1e-12 * max(1, abs(probes[name])) for name in probes))


def hertz(force, axisymmetric):
    """Half width, or radius, of contact and largest pressure of two bodies of one material, one flat (Johnson, Contact
    Mechanics, ch. 4)."""
    modulus = ARC_E / (2 * (1 - ARC_NU**2))
    if axisymmetric:
        a = (3 * force * R / (4 * modulus)) ** (1 / 3)
        return a, 3 * force / (2 * math.pi * a**2)
    a = math.sqrt(4 * 2 * force * R / (math.pi * modulus))  # the model is one half
    return a, 2 * 2 * force / (math.pi * a)


def edge(x, p):
    """End of the root with the moments of the nodal forces about the second node before the last loaded one and another
    two before; between that and the next one."""
    last = max(i for i in range(len(p)) if p[i] > 0)
    force = p[: last + 1] * (x[1 : last + 2] - numpy.concatenate(([x[0]], x[:last]))) / 2
    near, far = (numpy.sum(force * numpy.maximum(x[: last + 1] - x[k], 0)) ** 0.4 for k in (last - 2, last - 4))
    return min(max((far * x[last - 2] - near * x[last - 4]) / (far - near), x[last]), x[last + 1])


def deviation(p, area, keep, rms):
    p, area = p[keep], area[keep]
    mean = numpy.sum(p * area) / numpy.sum(area)
    off = p - mean
    return 100 * (numpy.sqrt(numpy.sum(off**2 * area) / numpy.sum(area)) if rms else numpy.max(numpy.abs(off))) / mean


def arc(args, check):
    axisymmetric = args.geometry == "axisymmetric"
    overrides = ["geometry=axisymmetric", "contact.0.symmetry=[]"] if axisymmetric else []
    finished = run(args, SCENES / "probes_arc.yaml", overrides=overrides)
    probes, fields = finished.summary()["probes"], finished.fields()

    slaves = fields["contact/foot/nodes"]
    order = numpy.argsort(fields["nodes"][slaves, 0])
    X, u = fields["nodes"][slaves[order]], fields["displacement"][slaves[order]]
    p, gaps = fields["contact/foot/pressure"][order], fields["contact/foot/gap"][order]
    check.holds("nodes on the foot", len(X) == N_ARC + 1)
    # Tributary areas of two-node faces: half of each face; turned about the axis int N_a 2 pi r ds = 2 pi L (2 r_a +
    # r_b) / 6
    length = numpy.linalg.norm(numpy.diff(X, axis=0), axis=1)
    low, high = X[:-1, 0], X[1:, 0]
    area = numpy.zeros(len(X))
    area[:-1] += 2 * math.pi * length * (2 * low + high) / 6 if axisymmetric else length / 2
    area[1:] += 2 * math.pi * length * (low + 2 * high) / 6 if axisymmetric else length / 2
    # The end on the axis or plane of symmetry is not free: the other one counts.
    faces = numpy.linalg.norm(X - X[-1], axis=1) / numpy.mean(length)
    everywhere = faces >= 0

    force = -probes["push"]
    a, peak = hertz(force, axisymmetric)
    half_width = numpy.max(numpy.diff(X[:, 0]))
    check.near("edge against Hertz", probes["edge_max"], a, half_width)
    check.near("largest pressure against Hertz", probes["peak"], peak, 0.1 * peak)
    # The stationarity of the accepted state is 1e-8 of the forces.
    check.near("bottom holds what the cut presses", probes["bottom"], -probes["cut"], 1e-7 * force)
    check.near("contact carries it", probes["push"], probes["cut"], 1e-7 * force)
    check.near("edge_max", probes["edge_max"], edge(X[:, 0] + u[:, 0], p), TOLERANCE * R)
    check.near("edge_min: symmetry", probes["edge_min"], 0, TOLERANCE * R)
    check.near("gap", probes["gap"], gaps[0], TOLERANCE * R)
    check.near("foot_uy", probes["foot_uy"], u[0, 1], TOLERANCE * R)
    check.near("peak", probes["peak"], numpy.max(p), TOLERANCE * peak)
    check.near("peak_at", probes["peak_at"], p[0], TOLERANCE * peak)
    check.near("mean", probes["mean"], numpy.sum(p * area) / numpy.sum(area), TOLERANCE * peak)
    for name, keep, rms in (("deviation", everywhere, False), ("deviation_rms", everywhere, True),
                            ("deviation_excluding", faces > 16 + 1e-6, True), ("deviation_only", faces
                                                                               <= 19 + 1e-6, False)):
        check.near(f"{name}: {numpy.sum(keep)} nodes", probes[name], deviation(p, area, keep, rms), TOLERANCE * 1000)
    print(
        f"     contact edge {probes['edge_max']:.4f}, Hertz {a:.4f}; largest pressure {probes['peak']:.2f}, Hertz "
        f"{peak:.2f}"
    )
    # the contact of the first step ends before the nodes that deviation_only keeps: no mean, no value
    if not axisymmetric:
        first = finished.steps()[0]
        check.holds("no value without contact there",
                    [name for name in probes if first[name] is None] == ["deviation_only"])


args = arguments(("form", "blocks or arc", ["blocks", "arc"]),
                 ("geometry", "of the scene", ["plane_strain", "axisymmetric"]))
check = Check()
if args.form == "blocks":
    for order in (1, 2):
        blocks(args, check, order)
else:
    arc(args, check)
check.finish()
