"""Benchmarks of friction against closed forms and published figures: node to surface and surface to surface, the smooth
master and its facets. Runs the scenes, leaves one record per figure and prints the table; --print tables an existing
record.
    python scripts/friction_table.py [--burnish BINARY] [--record FILE] [--ranks N] [--mesh NAME]... [--print] [CASE ...]
A case that is named replaces its rows in the record, with --mesh those of these meshes only. Deviations are in per cent
of the reference, those of tractions in per cent of what BENCHMARKS says. Nodal tractions are forces over tributary areas. So they are compared with means of
the closed form over the nodes' hat functions."""
import json
import math
import re
import shutil
import subprocess

import h5py
import numpy

from launch import ROOT, command, environment, read_records, read_steps, read_summary, replace_records, table_parser

COLUMNS = ("case", "mesh", "formulation", "smoother", "figure", "value", "reference", "deviation", "allowed", "status",
           "iterations", "failed")
RUNS, SCENES = ROOT / "runs/friction", ROOT / "tests/scenes"
PLAIN = (("surface_to_surface", "diffuse"),)
BOTH = (("surface_to_surface", "diffuse"), ("node_to_surface", "diffuse"))
ALL = BOTH + (("surface_to_surface", "facet"), ("node_to_surface", "facet"))
MINDLIN_RADIUS = 500  # of the scenes of Cattaneo and Mindlin, in radii of the contact
ANALYTIC = (("surface_to_surface", "diffuse"), ("node_to_surface", "diffuse"))


class Result:
    """A finished run: probes, friction of the only pair, steps, and fields of its slave nodes in the last state."""

    def __init__(self, directory):
        self.summary, self.steps = read_summary(directory), read_steps(directory)
        self.probes, self.friction = self.summary["probes"], self.summary["contact"][0].get("friction")
        with h5py.File(directory / "results.h5", "r") as file:
            last = file["steps"][sorted(file["steps"])[-1]]
            pair = list(file["contact"])[0]
            self.pair = {name: item[()] for name, item in last["contact"][pair].items()}
            self.nodes, self.slaves = file["mesh/nodes"][()], file["contact"][pair]["nodes"][()]
            self.displacement = last["displacement"][()]
            self.stress = last["stress"][()] if "stress" in last else None

    def traction(self):
        return numpy.linalg.norm(self.pair["traction"], axis=1)

    def pressure(self):
        return self.pair["pressure"].ravel()


def deviation(name, value, reference, allowed):
    return name, value, reference, 100 * (value / reference - 1), allowed


def scatter(name, field, allowed):
    """Largest deviation of a field from its mean."""
    mean = field.mean()
    return name, mean, mean, 100 * abs(field / mean - 1).max(), allowed


def wedge(result, mu):
    return [deviation("force over weight", result.probes["F"] / 7.2, (0.1 + mu) / (1 - 0.1 * mu), 1e-4)]


def pad(result, angle):
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    along, across = (lambda x, y: x * c + y * s), (lambda x, y: y * c - x * s)
    spring = (result.probes["spring_x"], result.probes["spring_y"])
    plane = (result.probes["plane_x"], result.probes["plane_y"])
    held = numpy.interp(0.5, result.steps["t"], along(result.steps["plane_x"], result.steps["plane_y"]))
    held -= along(*(numpy.interp(0.5, result.steps["t"], result.steps[name]) for name in ("spring_x", "spring_y")))
    return [
        deviation("tangential force while it sticks, and in the springs", held, 3564, 1e-4),
        deviation("tangential force while it slips", along(*plane), -0.3 * across(*plane), 1e-4),
        deviation("mean slip over the springs", -along(*spring) / 4, (3636 + 0.3 * across(*plane)) / 4, 0.01)
    ]


def bar(result, _):
    exact = 2**2 / (2 * 1000 * 0.3)
    # Between half and the whole of the slipped length the slip of the release adds nothing, and the slip falls to its
    # end as the square of the distance.
    x, slid = 16 - result.nodes[result.slaves, 0], result.pair["slip"].ravel()
    slope, start = numpy.polyfit(x[(x > 4) & (x < 6)], numpy.sqrt(slid[(x > 4) & (x < 6)]), 1)
    pulled = result.steps["end"][numpy.argmin(abs(result.steps["t"] - 0.6))]
    return [
        deviation("end when pulled", pulled, exact, 1),
        deviation("end after release", result.probes["end"], exact / 2, 1),
        deviation("slipped length", -start / slope, 2 / 0.3, 1)
    ]


def shear(result, allowed):
    return [scatter("traction in stick", result.traction(), allowed)]


def balance(result):
    """Outer forces and moments out of balance, over the sums of their amounts: in a ring that is turned these moments
    are those of friction."""
    found = result.summary["certificate"]
    return [(f"{name}s out of balance", found[f"{name}_balance"], found[f"{name}_balance"],
             100 * found[f"{name}_balance"], allowed) for name, allowed in (("force", 1e-10), ("moment", 1e-4))]


def lame(held):
    """Pressure between the rings of press_fit.yaml, whose bore and rim keep their radii or are free (Lame 1852)."""
    E, nu, fit, overlap = 200000, 0.3, 20, 0.0025

    def give(c):
        """Radial displacement at the fit under a unit pressure of a ring whose other radius is c."""
        q = (c / fit)**2
        if held:
            return fit * (1 + nu) / E * abs(1 - q) / (1 / (1 - 2 * nu) + q)
        return fit * (1 + nu) / E * ((1 - 2 * nu) + q) / abs(1 - q)

    return overlap / (give(10) + give(30))


def rings(result, state):
    bound, slips = {"stick": 1.5, "jitter": 4, "held": 1, "free": 1}[state], state in ("held", "free")
    traction, closed, exact, found = result.traction(), result.pressure() > 0, 0.2 * lame(state == "held"), []
    if slips:
        found.append(deviation("traction at the worst node", traction[numpy.argmax(abs(traction - exact))], exact,
                               bound))
    if not closed.any():  # facets whose sagittas are larger than the interference
        return found
    found.append(scatter("traction", traction, bound))
    if slips:
        ratio = traction[closed] / result.pressure()[closed] / 0.2 - 1
        found.append(("traction over 0.2 times the pressure", 1 + ratio.mean(), 1, 100 * abs(ratio).max(), 1))
        work = numpy.diff(result.steps["dissipated"])[4:]
        found.append(("torque, swing", work.mean(), work.mean(), 100 * (work.max() - work.min()) / work.mean(), 0.5))
    return found + balance(result)


def belt(result, _):
    ratio = result.probes["high"] / result.probes["low"]
    return [
        deviation("ratio of the forces", max(ratio, 1 / ratio), math.exp(0.3 * math.pi * 10 / 10.05),
                  1.5 if len(result.slaves) < 90 else 0.6)
    ]


def hat_means(x, function):
    """Means of a function over the hat functions of nodes at ascending x."""
    share = (numpy.arange(200) + 0.5) / 200
    total, area = numpy.zeros_like(x), numpy.zeros_like(x)
    for i in range(len(x)):
        for j in (i - 1, i + 1):
            if not 0 <= j < len(x):
                continue
            weight = (1 - share) * abs(x[j] - x[i])
            total[i] += (weight * function(x[i] + (x[j] - x[i]) * share)).sum()
            area[i] += weight.sum()
    return total / area


def lattice_means(x, z, face, function):
    """Means of a function over the hat functions of the nodes of a lattice."""
    s = numpy.linspace(-1, 1, 41)[1:-1]
    along, across = numpy.meshgrid(s, s)
    weight = (1 - abs(along)) * (1 - abs(across))
    return numpy.array([(weight * function(numpy.hypot(a + face * along, b + face * across))).sum()
                        for a, b in zip(x, z)]) / weight.sum()


def part(x, a):
    return numpy.sqrt(numpy.maximum(0, 1 - (x / a)**2))


def stick_edge(x, traction, bound, sticks):
    """Where sticking ends along x >= 0: near it, the square of 1 - traction / bound falls linearly."""
    at = numpy.argsort(x)
    at = at[sticks[at]][-2:]
    near, far = ((1 - traction[k] / bound[k])**2 for k in at)
    return x[at[1]] + (x[at[1]] - x[at[0]]) * far / (near - far)


def stick_moment(square, lacks, zone, of_hat, dimension):
    """How far sticking goes, by the second moment of what the traction lacks to its bound: that is a half circle or a half
    ball over the zone that sticks, for which this is exact. lacks are nodal forces, so the nodes' hat functions add
    their own second moment. Unlike stick_edge() it does not hang on the last two nodes, next to the kink."""
    return math.sqrt((1 + 3 / dimension) * ((square * lacks)[zone].sum() / lacks[zone].sum() - of_hat))


def mindlin_line(result, _):
    force, push, modulus = result.probes["P"], result.probes["Q"], 210000 / (2 * (1 - 0.3**2))
    a = math.sqrt(4 * force * MINDLIN_RADIUS / (math.pi * modulus))
    c, peak = a * math.sqrt(1 - push / (0.3 * force)), 2 * force / (math.pi * a)
    order = numpy.argsort(result.nodes[result.slaves, 0])
    x = result.nodes[result.slaves, 0][order]
    pressure, traction, status = (field[order] for field in (result.pressure(), result.traction(),
                                                             result.pair["friction"].ravel()))
    error = traction / (0.3 * peak) - hat_means(x, lambda s: part(s, a) - c / a * part(s, c))
    noise = pressure / peak - hat_means(x, lambda s: part(s, a))
    face = numpy.diff(x[abs(x) < 1]).max()
    zone = abs(x) < a + face
    own = error - numpy.where(status == 2, noise, 0)  # what slips has the pressure's error
    inner = zone & (abs(abs(x) - a) > 2 * face) & (abs(abs(x) - c) > 2 * face)
    lacks = numpy.gradient(x) * (0.3 * pressure - traction)
    edge = numpy.mean(
        [stick_edge(side * x, traction, 0.3 * pressure, (status == 1) & (side * x > 0)) for side in (1, -1)])
    return [
        ("traction, rms", peak, peak, 100 * math.sqrt((error[zone]**2).mean()), 2),
        ("traction without the pressure's error, rms", peak, peak, 100 * math.sqrt((own[zone]**2).mean()), 2),
        ("traction, largest beyond two faces from the edges", peak, peak, 100 * abs(error[inner]).max(), 2),
        ("pressure, largest beyond two faces from the edges", peak, peak, 100 * abs(noise[inner]).max(), 2),
        deviation("half-width that sticks", edge, c, 2),
        deviation("half-width that sticks, by moments", stick_moment(x**2, lacks, zone, face**2 / 6, 1), c, 2)
    ]


def mindlin_sphere(result, _):
    force, push = 2 * result.probes["P"], 2 * result.probes["Q"]
    a = (3 * force * MINDLIN_RADIUS / (4 * 210000 / (2 * (1 - 0.3**2))))**(1 / 3)
    c, peak = a * (1 - push / (0.3 * force))**(1 / 3), 1.5 * force / (math.pi * a**2)
    place = result.nodes[result.slaves]
    r = numpy.hypot(place[:, 0], place[:, 2])
    pressure, traction, status = result.pressure(), result.traction(), result.pair["friction"].ravel()
    face = numpy.diff(numpy.unique(numpy.round(place[place[:, 2] < 1e-9, 0], 9)))
    face = face[len(face) // 2]
    zone = r < a + face
    error = numpy.zeros_like(r)
    error[zone] = traction[zone] / (0.3 * peak) - lattice_means(place[zone, 0], place[zone, 2], face,
                                                                lambda s: part(s, a) - c / a * part(s, c))
    inner = zone & (abs(r - a) > 2 * face) & (abs(r - c) > 2 * face)
    lacks = numpy.where(place[:, 2] < 1e-9, 0.5, 1) * (0.3 * pressure - traction)  # of half a lattice
    edges = [
        stick_edge(r[line], traction[line], 0.3 * pressure[line], status[line] == 1)
        for line in (abs(place[:, 0]) < 1e-9, (place[:, 2] < 1e-9) & (place[:, 0] > 0), (place[:, 2] < 1e-9) &
                     (place[:, 0] < 0)) if (status[line] == 1).sum() > 1
    ]
    # The cut's motion is the shift and what the bodies give beside the contact, in proportion to the force. The first
    # step along, in which next to nothing slips, tells that part.
    motion = 0.00042 * 2 * (result.steps["t"] - 0.5)
    along, pushes = motion > 1e-9, 2 * abs(result.steps["Q"])
    shear = 210000 / 2.6
    law = lambda q: 3 * 0.3 * force / (8 * a) * 1.7 / shear * (1 - (1 - q / (0.3 * force))**(2 / 3))
    first, last = motion[along][0], motion[along][-1]
    bulk = (first - law(pushes[along][0])) / pushes[along][0]
    found = [
        ("traction, rms", peak, peak, 100 * math.sqrt((error[zone]**2).mean()), 2),
        ("traction, largest beyond two faces from the edges", peak, peak, 100 * abs(error[inner]).max(initial=0), 2),
        ("traction, largest within 0.4 of the radius", peak, peak, 100 * abs(error[r < 0.4]).max(), 2),
        deviation("radius that sticks, by moments", stick_moment(r**2, lacks, zone, face**2 / 3, 2), c, 2),
        deviation("shift", last - bulk * pushes[along][-1], law(pushes[along][-1]), 1)
    ]
    return found + ([deviation("radius that sticks", numpy.mean(edges), c, 2)] if edges else [])


def mindlin_loop(result, _):
    """The motion of the cut is the shift and what the bodies give beside the contact, as in mindlin_sphere()."""
    t, mu = result.steps["t"], 0.3
    first, turned = (numpy.argmin(abs(t - at)) for at in (0.22, 0.4))
    force, push = 2 * result.probes["P"], 2 * result.steps["Q"] * numpy.sign(result.steps["Q"][turned])
    motion = 0.00042 * numpy.interp(t, (0.2, 0.4, 0.7, 1), (0, 1, -1, 1))
    a = (3 * force * MINDLIN_RADIUS / (4 * 210000 / (2 * (1 - 0.3**2))))**(1 / 3)
    scale = 3 * mu * force / (8 * a) * 1.7 / (210000 / 2.6)
    way = lambda q, times: times * scale * (1 - (1 - q / (times * mu * force))**(2 / 3))
    motion = motion - push / push[first] * (motion[first] - way(push[first], 1))
    most = push[turned]
    back = lambda q: way(most, 1) - way(most - numpy.clip(q, -most, most), 2)
    after, sign = t > 0.4 + 1e-9, numpy.where(t > 0.7 + 1e-9, -1, 1)
    error = (motion - sign * back(sign * push))[after]
    q = numpy.linspace(-most, most, 20001)
    area = numpy.trapezoid(-back(-q) - back(q), q)
    shift, worst = way(most, 1), error[numpy.argmax(abs(error))]
    return [
        deviation("shift at the turn", motion[turned], shift, 1),
        ("shift on the ways back, largest of all steps", shift, shift, 100 * worst / shift, 1),
        deviation("force where the loop closes, over that at the turn", push[-1] / most, 1, 0.1),
        deviation("energy of the loop", 2 * (result.steps["dissipated"][-1] - result.steps["dissipated"][turned]),
                  abs(area), 2)
    ]


def shallow_ironing(result, _):
    """Against the limit of the two finest meshes, which differ by 0.4 % in V and 0.2 % in H in the middle of the slide.
    There a cubic over t takes away the trend."""
    t, middle = result.steps["t"], (result.steps["t"] > 0.65) & (result.steps["t"] < 0.85)
    found = []
    for name, limits in (("V", {0.5: 442.1, 0.75: 530.2}), ("H", {0.5: 78.2, 0.75: 192.2})):
        force = result.steps[name]
        found += [deviation(f"{name} at t = {at}", numpy.interp(at, t, force), limit, 1) for at, limit in limits.items()]
        rest = force[middle] - numpy.polyval(numpy.polyfit(t[middle], force[middle], 3), t[middle])
        found.append((f"{name}, rms of its swing", force[middle].mean(), force[middle].mean(),
                      100 * rest.std() / force[middle].mean(), 0.5))
    return found


def twisted_hemisphere(result, _):
    """Against the mean of two published moments at each angle, with half their difference and 2 % as the bound. The
    digitised curves do not begin at 0, where there is no moment: what they have there is taken off."""
    angle = 150 * (result.steps["t"] - 0.25) / 0.75
    moment, force = (numpy.interp((0, 15, 30, 45, 60, 90, 120, 150), angle, result.steps[name])
                     for name in ("moment", "force"))
    found = [deviation("normal force before the twist", force[0], 1.2295, 2)]
    for k, (at, one, other) in enumerate(
        ((15, 0.1113, 0.1081), (30, 0.2087, 0.2117), (45, 0.2926, 0.2968), (60, 0.3545, 0.3578), (90, 0.3991, 0.4017),
         (120, 0.4026, 0.4098), (150, 0.4061, 0.4073))):
        one, other = one - 0.0011, other - 0.0009
        mean = (one + other) / 2
        found.append(deviation(f"moment at {at} degrees", moment[k + 1], mean,
                               round(100 * abs(one - other) / (2 * mean) + 2, 1)))
    return found


def plate_greco(result, _):
    reference = {"u_0": 2.86e-2, "u_1": 2.72e-2, "u_5": 2.28e-2, "u_7": 1.98e-2, "u_11": 1.50e-2}
    return [deviation(f"displacement {name}", result.probes[name], value, 5) for name, value in reference.items()]


def punch_rounded(result, mu):
    """The published stress is a contact pressure that was extrapolated from the inside, the mean of two programs. The own
    limit is that of surface to surface with elements of 1, 0.5 and 0.25, which the contact pressure there meets."""
    node = numpy.flatnonzero(numpy.linalg.norm(result.nodes, axis=1) < 1e-9)
    node = node[numpy.argmin(abs(result.displacement[node, 1] - result.probes["u"]))]
    return [
        deviation("displacement under the axis", result.probes["u"], {0: -0.132941, 0.1: -0.130794}[mu], 1),
        deviation("stress under the axis", result.stress[node, 1], {0: -94.12, 0.1: -95.47}[mu], None),
        deviation("stress under the axis, own limit", result.stress[node, 1], {0: -87.17, 0.1: -88.61}[mu], None)
    ]


def turned_rings(angle, bore=0, rim=0):
    """Overrides by which the bore of press_fit.yaml is turned, and both radii change by these parts in the first step."""
    radius = f"(1+{bore}*min(1,t/0.04))"
    return [
        "supports=[]", "loads=[]",
        f"loads.0={{surface: bore, ux: 'x*({radius}*cos({angle}*t)-1)-y*{radius}*sin({angle}*t)', "
        f"uy: 'x*{radius}*sin({angle}*t)+y*({radius}*cos({angle}*t)-1)'}}",
        f"loads.1={{surface: rim, ux: 'x*{rim}*min(1,t/0.04)', uy: 'y*{rim}*min(1,t/0.04)'}}"
    ]


def tool(surface, own=""):
    """Overrides that put a meshed rigid surface in the place of the analytic master of a scene with one body."""
    return [f"bodies.1={{surface: {surface}, rigid: {{{own}}}}}", f"contact.0.master={surface}"]


# name -> scene, what measures a run, and its meshes: (name, argument of the measure, overrides, formulations)
BENCHMARKS = {
    "wedge": (RUNS / "wedge.yaml", wedge, [
        *((f"mu {mu}", mu, [f"contact.0.friction.mu={mu}"], ALL) for mu in (0.1, 0.3)),
        ("mu 0.3, analytic slope", 0.3, [
            "mesh.parameters.base=0", "bodies=[{volume: wedge, material: {law: svk, E: 1000000, nu: 0.3}}]",
            "supports=[]", "contact.0.master={plane: {point: [0, 0], normal: [-0.1, 1]}}"
        ], ANALYTIC)
    ]),
    "pad": (RUNS / "pad.yaml", pad, [("flat", 0, [], ANALYTIC),
                                     ("inclined by 30 degrees", 30, [
                                         "mesh.parameters.angle=30", "supports.0.spring=[0.2, 0.2]",
                                         "contact.0.master.plane.normal=[-0.5, 0.866025403784439]"
                                     ], ANALYTIC),
                                     ("inclined, meshed plane", 30, [
                                         "mesh.parameters={angle: 30, bed: 25}", "supports.0.spring=[0.2, 0.2]",
                                         *tool("bed")
                                     ], ALL)]),
    "bar": (SCENES / "bar.yaml", bar, [("160 elements", None, [], BOTH),
                                          ("160 elements, meshed bed", None, [
                                              "mesh.parameters.bed=225", *tool("bed")
                                          ], ALL)]),
    "shear": (SCENES / "shear.yaml", shear,
              [(f"3D, jitter {jitter}", 4, [f"mesh.parameters.jitter={jitter}", "solver.tolerance=1e-8"], ALL)
               for jitter in (0, 0.25)]),
    "shear_plane": (RUNS / "shear_plane.yaml", shear,
                    [(f"jitter {jitter}, {lower} on {upper} faces", 3, [
                        f"mesh.parameters={{jitter: {jitter}, n_lower: {lower}, n_upper: {upper}}}"
                    ], ALL) for jitter in (0, 0.25) for lower, upper in ((12, 15), (15, 12))]),
    "rings": (RUNS / "press_fit.yaml", rings, [
        (name, state, [f"mesh.parameters.jitter={jitter}", f"stepping.initial={step}", *turned_rings(angle, *gives)],
         ALL) for name, state, jitter, angle, step, gives in (
             ("stick", "stick", 0, 0.0001, 0.5, ()),
             ("stick, jitter 0.25", "jitter", 0.25, 0.0001, 0.5, ()),
             ("slip over five faces", "held", 0, 0.26, 0.04, ()),
             ("slip over five faces, radii of free bore and rim", "free", 0, 0.26, 0.04, (-7.8125e-5, 4.6875e-5)))
    ]),
    "belt": (SCENES / "belt.yaml", belt, [
        *((f"{n} elements", None, [f"mesh.parameters.n={n}"], ANALYTIC) for n in (12, 24, 48, 96)),
        *((f"{n} elements, meshed drum", None, [
            f"mesh.parameters={{n: {n}, drum: 1.25}}",
            *tool("drum", "motion: [{rz: -2, history: [[0, 0], [0.2, 0], [1, 1]]}]")
        ], ALL) for n in (12, 24, 48, 96))
    ]),
    "mindlin_line": (RUNS / "mindlin_line.yaml", mindlin_line, [
        *((f"{n} elements", None, [f"mesh.parameters.n={n}"], ALL) for n in (8, 16, 32)),
        *((f"{n} elements, mean of four meshes", None, [[f"mesh.parameters.n={n}", f"mesh.parameters.zone={zone}"]
                                                        for zone in (1.3, 1.35, 1.4, 1.45)], BOTH)
          for n in (8, 16, 32)),
        *((f"{n} elements, hundredth of the elastic slip", None, [
            f"mesh.parameters.n={n}", "contact.0.friction.stick.penalty=3e8"
        ], BOTH) for n in (8, 16, 32))
    ]),
    "mindlin_sphere": (RUNS / "mindlin_sphere.yaml", mindlin_sphere,
                       [("4 elements", None, [], BOTH), ("8 elements", None, ["mesh.parameters.n=8"], PLAIN),
                        ("16 elements", None, ["mesh.parameters.n=15"], PLAIN)]),
    "mindlin_loop": (RUNS / "mindlin_loop.yaml", mindlin_loop,
                     [(f"{n} elements", None, [f"mesh.parameters.n={n}"], PLAIN) for n in (4, 8)]),
    "shallow_ironing": (RUNS / "shallow_ironing.yaml", shallow_ironing, [
        (f"order {order}, {n} per length", None, [f"mesh.order={order}", f"mesh.parameters.n={n}"], PLAIN)
        for order, n in ((1, 4), (2, 4), (2, 6), (2, 8), (1, 8))
    ] + [("order 1, 4 per length, foundation as the slave", None, [
        "contact.0.slave=foundation_top", "contact.0.master=punch_skin", "stepping.dt_max=0.005"
    ], (("surface_to_surface", "facet"),))]),
    "twisted_hemisphere": (RUNS / "twisted_hemisphere.yaml", twisted_hemisphere, [
        (f"order {order}, {m} along the cube", None, [
            f"mesh.order={order}", f"mesh.parameters={{n: {n}, n_side: {n_side}, m: {m}, m_depth: {m_depth}}}"
        ], ways) for order, n, n_side, m, m_depth, ways in ((1, 4, 3, 8, 5, ALL), (1, 6, 4, 12, 7, PLAIN),
                                                            (2, 4, 3, 8, 5, PLAIN))
    ] + [
        ("order 2, 10 along the cube, tenth of the elastic slip", None, [
            "mesh.order=2", "mesh.parameters={n: 5, n_side: 4, m: 10, m_depth: 6}",
            "contact.0.friction.stick.penalty=3000"
        ], PLAIN)
    ]),
    "plate_greco": (RUNS / "plate_greco.yaml", plate_greco, [
        *((f"{n} elements", None, [f"mesh.parameters={{n: {n}, m: {n}}}"], ANALYTIC) for n in (32, 64)),
        ("64 elements, meshed floor", None, ["mesh.parameters={n: 64, m: 64, floor: 75}", *tool("floor")], ALL)
    ]),
    "punch_rounded": (RUNS / "punch_rounded.yaml", punch_rounded,
                      [(f"mu {mu}, elements of {h}", mu, [f"mesh.parameters.h={h}", f"contact.0.friction.mu={mu}"],
                        ALL if mu and h > 0.25 else BOTH) for mu in (0, 0.1) for h in (1, 0.5, 0.25)]),
}


def solve_once(args, case, mesh, argument, overrides, formulation, smoother):
    """Exit status, iterations, failed steps and figures of one run."""
    scene, measure, _ = BENCHMARKS[case]
    directory = args.out / re.sub(r"\W+", "_", f"{case}_{mesh}_{formulation}_{smoother}")
    shutil.rmtree(directory, ignore_errors=True)
    line = command(args.burnish, args.ranks, scene, directory, [
        *overrides, f"contact.0.formulation={formulation}", f"contact.0.smoother={smoother}"
    ], "-quiet")
    finished = subprocess.run(line, env=environment(args.burnish), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True)
    if finished.returncode:
        print(" ".join(line), finished.stdout[-500:], sep="\n")
        return finished.returncode, 0, 0, []
    result = Result(directory)
    shutil.rmtree(directory, ignore_errors=True)
    return 0, result.summary["newton_iterations"], result.summary["steps_failed"], measure(result, argument)


def solve(args, case, mesh, argument, overrides, formulation, smoother):
    """The records of one run. Of several ones, if there is a list of overrides for each: the first one's values, and
    the means of all deviations without their signs."""
    several = overrides and isinstance(overrides[0], list)
    record = {"case": case, "mesh": mesh, "formulation": formulation, "smoother": smoother}
    runs = [
        solve_once(args, case, mesh, argument, each, formulation, smoother)
        for each in (overrides if several else [overrides])
    ]
    status = max(run[0] for run in runs)
    if status:
        return [{**record, "figure": "not converged", "status": status}]
    record.update(status=0, iterations=sum(run[1] for run in runs), failed=sum(run[2] for run in runs))
    mean = [numpy.mean([abs(error) for error in errors]) for errors in zip(*([f[3] for f in run[3]] for run in runs))]
    return [{
        **record, "figure": figure, "value": f"{value:.7g}", "reference": f"{reference:.7g}",
        "deviation": f"{mean[k] if several else error:.3g}", "allowed": allowed
    } for k, (figure, value, reference, error, allowed) in enumerate(runs[0][3])]


def run(args, case):
    """Rows of meshes that are not asked for stay as they are, and where they are."""
    records = []
    for mesh, argument, overrides, formulations in BENCHMARKS[case][2]:
        if args.mesh and mesh not in args.mesh:
            records += [row for row in read_records(args.record) if (row["case"], row["mesh"]) == (case, mesh)]
            continue
        for formulation, smoother in formulations:
            records += solve(args, case, mesh, argument, overrides, formulation, smoother)
    replace_records(args.record, COLUMNS, case, records)


def cell(record):
    return "{:.2g}".format(abs(float(record["deviation"]))) if record and record["deviation"] else "-"


def print_table(records):
    print("Deviations in per cent; s2s: surface to surface, n2s: node to surface.\n")
    print("| benchmark | mesh | figure | reference | asked | s2s | n2s | s2s, facets | n2s, facets |\n|" + " --- |" * 9)
    records = sorted(records, key=lambda r: list(BENCHMARKS).index(r["case"]))
    for key in dict.fromkeys(tuple(r[name] for name in ("case", "mesh", "figure")) for r in records if r["deviation"]):
        rows = [r for r in records if tuple(r[name] for name in ("case", "mesh", "figure")) == key]
        found = {(r["formulation"], r["smoother"]): r for r in rows}
        relative = rows[0]["value"] == rows[0]["reference"]
        print("| {} | {} | {} | {} | {} | {} |".format(*key, "-" if relative else rows[0]["reference"],
                                                       rows[0]["allowed"] or "-",
                                                       " | ".join(cell(found.get(k)) for k in ALL)))


def main():
    parser = table_parser(__doc__, "friction")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--mesh", action="append", metavar="NAME", help="only this one of a case; repeatable")
    parser.add_argument("cases", nargs="*", metavar="CASE", choices=[[], *BENCHMARKS], default=[])
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    for case in [] if args.only_print else args.cases or BENCHMARKS:
        run(args, case)
    print_table(read_records(args.record))


if __name__ == "__main__":
    main()
