"""The plastic laws: runs a bar that is pulled and let go with each hardening, one that is pulled and pressed in turn
with backstresses and an overstress, and a square in simple shear to 500 %, leaves forces, plastic strains and their
references in a record, and prints the table; --print tables an existing record. The tests plastic_bar.py and
plastic_cyclic.py take their references from here.
    python scripts/plastic_law_table.py [--burnish BINARY] [--record FILE]"""
import math
import shutil
import subprocess

import numpy

from launch import ROOT, command, environment, read_records, read_steps, read_summary, table_parser, write_records

COLUMNS = ("case", "variant", "quantity", "value", "reference", "scale", "source", "status", "steps", "failed",
           "iterations")
E, NU, LENGTH = 200e3, 0.3, 2  # of the bar
TABLE = [(0, 451), (0.006, 476), (0.019, 525), (0.038, 583), (0.066, 642), (0.147, 710), (0.5, 777), (1, 831)]


def measured(a):
    for (a_0, y_0), (a_1, y_1) in zip(TABLE, TABLE[1:]):
        if a <= a_1:
            return y_0 + (y_1 - y_0) * (a - a_0) / (a_1 - a_0)
    raise ValueError(a)


HARDENING = {
    "none": ({"yield": 450}, lambda a: 450),
    "linear": ({"yield": 450, "hardening": "{linear: 261.2}"}, lambda a: 450 + 261.2 * a),
    "voce": ({"yield": 450, "hardening": "{linear: 129, voce: {saturation: 715, rate: 16.93}}"},
             lambda a: 450 + 129 * a + 265 * (1 - math.exp(-16.93 * a))),
    "swift": ({"yield": 450, "hardening": "{swift: {strength: 900, exponent: 0.2}}"},
              lambda a: 900 * (0.5**5 + a)**0.2),
    "table": ({"hardening": f"{{table: {[list(row) for row in TABLE]}}}"}, measured),
}
WAY = 0.04  # of the bar that is pulled and pressed in turn
HISTORY = [[0, 0], [0.2, 1], [0.4, -1], [0.6, 1], [0.8, -0.5], [1, 0.2]]
SUBSTEPS = 400  # of a load step, for the reference without an overstress


def chaboche(a):
    return 200 + 100 * (1 - math.exp(-12 * a))


LAWS = {  # material keys, yield stress over the plastic strain, backstresses, overstress
    "chaboche": ("yield: 200, hardening: {voce: {saturation: 300, rate: 12}}, kinematic: [{C: 40e3, gamma: 500}, "
                 "{C: 5e3, gamma: 40}, {C: 500}]", chaboche, [(40e3, 500), (5e3, 40), (500, 0)], None),
    "prager": ("yield: 250, kinematic: [{C: 3e3}]", lambda a: 250, [(3e3, 0)], None),
    "perzyna": ("yield: 200, hardening: {linear: 500}, perzyna: {overstress: 100, speed: 0.4, power: 3}",
                lambda a: 200 + 500 * a, [], (100, 0.4, 3)),
    "all": ("yield: 200, hardening: {linear: 500}, kinematic: [{C: 5e3}], "
            "perzyna: {overstress: 100, speed: 0.4, power: 1}", lambda a: 200 + 500 * a, [(5e3, 0)], (100, 0.4, 1)),
}
SHEAR, Y = 5, 450  # shear strain at the end; yield stress there
SHEARED = {  # keys, growth of the yield stress and backstress over the plastic strain
    "perfect": ("", lambda a: 0),
    "linear": (", hardening: {linear: 261.2}", lambda a: 261.2 * a),
    "voce": (", hardening: {linear: 129, voce: {saturation: 715, rate: 16.93}}",
             lambda a: 129 * a + 265 * (1 - math.exp(-16.93 * a))),
    "backstress that saturates": (", kinematic: [{C: 2e3, gamma: 10}]", lambda a: 200 * (1 - math.exp(-10 * a))),
    "two backstresses, linear": (", hardening: {linear: 100}, kinematic: [{C: 20e3, gamma: 200}, {C: 1e3, gamma: 10}]",
                                 lambda a: 100 * a + 100 * (1 - math.exp(-200 * a)) + 100 * (1 - math.exp(-10 * a))),
}


def increase(strain, a, flow):
    """Plastic strain a after the bar is brought to a strain, stress there, by bisection."""
    plastic, least = a[0], 0
    stress = E * (strain - plastic)
    if abs(stress) <= flow(a[1]):
        return a, stress
    most = (abs(stress) - flow(a[1])) / E
    for _ in range(200):
        middle = (least + most) / 2
        if abs(stress) - E * middle > flow(a[1] + middle):
            least = middle
        else:
            most = middle
    sign = math.copysign(1, stress)
    return (plastic + sign * least, a[1] + least), stress - sign * E * least


def tension_path(finite, flow, steps):
    """Force per unit area of the undeformed section and equivalent plastic strain at every step."""
    a = (0, 0)
    for row in steps:
        t = row["t"]
        stretch = 0.6 / LENGTH * (2 * t if t <= 0.5 else 1 - 0.2 * (t - 0.5))
        a, stress = increase(math.log1p(stretch) if finite else stretch, a, flow)
        yield (stress / (1 + stretch) if finite else stress), a[1], stress


def rate(excess, overstress):
    bound, speed, power = overstress
    return speed * (excess / bound)**power if excess > 0 else 0


def cyclic_path(finite, law, times):
    """Stress, equivalent plastic strain and plastic work at the times, by the rate equations."""
    _, flow, terms, overstress = law
    backstress, plastic, a, work, before = [0.0] * len(terms), 0.0, 0.0, 0.0, 0.0
    substeps = 1 if overstress else SUBSTEPS
    for time in times:
        moments = numpy.linspace(before, time, substeps + 1)[1:]
        factors = numpy.interp(moments, *zip(*HISTORY))
        strains = WAY / LENGTH * factors
        strains = numpy.log1p(strains) if finite else strains
        for strain in strains:
            stress = E * (strain - plastic)
            sign = math.copysign(1, stress - sum(backstress))
            excess = sign * (stress - sum(backstress)) - flow(a)
            if excess <= 0:
                continue
            slope = E + (flow(a + 1e-6) - flow(a)) / 1e-6
            slope += sum(C - sign * g * x for (C, g), x in zip(terms, backstress))
            if overstress:  # implicit in the excess
                dt, least, most = (time - before) / substeps, 0.0, excess / slope
                for _ in range(100):
                    p = (least + most) / 2
                    least, most = (p, most) if rate(excess - slope * p, overstress) * dt > p else (least, p)
            p = (least + most) / 2 if overstress else excess / slope
            work += p * (sign * E * (strain - plastic - sign * p) - p * (slope - E) / 2)
            plastic, a = plastic + sign * p, a + p
            backstress = [x + p * (sign * C - g * x) for (C, g), x in zip(terms, backstress)]
        before = time
        yield E * (strain - plastic), a, work


def worst(forces, expected, source):
    at = int(numpy.argmax(numpy.abs(forces - expected)))
    return "force where it is furthest off", forces[at], expected[at], numpy.max(numpy.abs(expected)), source


def tension_rows(name, steps, summary, finite):
    expected = list(tension_path(finite, HARDENING[name][1], [{"t": t} for t in steps["t"]]))
    force = numpy.array([row[0] for row in expected])
    yield worst(steps["force"], force, "closed form")
    yield "plastic strain", summary["max_plastic_strain"], expected[-1][1], expected[-1][1], "closed form"


def cyclic_rows(name, steps, summary, finite):
    expected = list(cyclic_path(finite, LAWS[name], steps["t"]))
    stretch = 1 + WAY / LENGTH * numpy.interp(steps["t"], *zip(*HISTORY))
    force = numpy.array([row[0] for row in expected]) / (stretch if finite else 1)
    yield worst(steps["force"], force, "rate equations")
    yield "plastic strain", summary["max_plastic_strain"], expected[-1][1], expected[-1][1], "rate equations"


def shear_rows(name, steps, summary, finite):
    """The shear stress by von Mises' condition, if elastic strains are small and backstresses do not turn."""
    strain, stress = SHEAR * steps["t"], steps["force"]
    for at in (1, 3, 5):
        value = numpy.interp(at, strain, stress)
        plastic = (at - value * 2 * (1 + NU) / E) / math.sqrt(3)
        expected = (Y + SHEARED[name][1](plastic)) / math.sqrt(3)
        yield f"shear stress at {100 * at} %", value, expected, expected, "von Mises"
    fall = numpy.max(numpy.maximum.accumulate(stress) - stress)
    yield "largest fall of the shear stress", fall, 0, numpy.max(stress), "no oscillation"


CASES = {}
for finite_, kinematics in ((False, "small"), (True, "finite")):
    for name_, (material, _) in HARDENING.items():
        keys = ", ".join(f"{key}: {value}" for key, value in {"law": "von_mises", "E": E, "nu": NU, **material}.items())
        CASES["one element, tension", f"{name_}, {kinematics} strains"] = (
            [f"kinematics={kinematics}", f"bodies.0.material={{{keys}}}"], tension_rows, name_, finite_)
    for name_, law_ in LAWS.items():
        CASES["one element, tension and compression", f"{name_}, {kinematics} strains"] = (
            [f"kinematics={kinematics}", f"loads.0={{surface: x_max, ux: {WAY}, history: {HISTORY}}}",
             f"bodies.0.material={{law: von_mises, E: {E}, nu: {NU}, {law_[0]}}}",
             f"stepping={{control: fixed, initial: {0.01 if law_[3] else 0.02}}}"], cyclic_rows, name_, finite_)
SIDES = ", ".join(f'{{surface: {side}, ux: "{SHEAR}*t*y", uy: 0}}' for side in ("x_min", "x_max", "y_min", "y_max"))
for name_, (keys, _) in SHEARED.items():
    CASES["simple shear to 500 %", name_] = (
        ["mesh={file: ../../meshes/square.geo, order: 1, parameters: {lx: 1, ly: 1, nx: 2, ny: 2}}",
         "geometry=plane_strain", "supports=[]", f"loads=[{SIDES}]",
         f"bodies.0.material={{law: von_mises, E: {E}, nu: {NU}, yield: {Y}{keys}}}",
         "probes.0={name: force, reaction: y_max, component: x}", "stepping={control: fixed, initial: 1e-3}"],
        shear_rows, name_, True)


def solve(case, args):
    overrides, rows, name, finite = CASES[case]
    directory = args.out / "_".join(case).replace(" ", "_").replace(",", "")
    shutil.rmtree(directory, ignore_errors=True)
    line = command(args.burnish, 1, ROOT / "tests/scenes/plastic_bar.yaml", directory, [*overrides, "output.every=0"],
                   "-quiet")
    status = subprocess.run(line, env=environment(args.burnish), stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL).returncode
    summary = read_summary(directory)
    counts = {"status": status, "steps": summary["steps"], "failed": summary["steps_failed"],
              "iterations": summary["newton_iterations"]}
    return [{"case": case[0], "variant": case[1], "quantity": quantity, "value": f"{value:.8g}",
             "reference": f"{reference:.8g}", "scale": f"{scale:.6g}", "source": source, **counts}
            for quantity, value, reference, scale, source in rows(name, read_steps(directory), summary, finite)]


def print_table(records):
    print("| law | quantity | value | reference | error, % |\n|" + " --- |" * 5)
    for record in records:
        error = 100 * abs(float(record["value"]) - float(record["reference"])) / float(record["scale"])
        print(f"| {record['case']}: {record['variant']} | {record['quantity']} | {float(record['value']):.6g} | "
              f"{float(record['reference']):.6g} | {error:.2g} |")


def main():
    args = table_parser(__doc__, "plastic_laws").parse_args()
    if not args.only_print:
        args.out.mkdir(parents=True, exist_ok=True)
        write_records(args.record, COLUMNS, lambda case: solve(case, args), list(CASES), 1)
    print_table(read_records(args.record))


if __name__ == "__main__":
    main()
