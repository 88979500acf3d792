"""Contact without naming pairs (`surfaces: all`) against the same scenes with slave and master, in both roles: answers,
noise of the pressure, Newton iterations, CPU time. Runs runs/pipe_pinch.yaml and runs/plate_cylinder_meshed.yaml on
coarse meshes, and runs/ring_in_ring.yaml and runs/spheres.yaml with nodes moved by up to a quarter of a face; leaves
one record per run and prints the table; --print tables an existing record.
    python scripts/all_table.py [--burnish BINARY] [--record FILE]"""
import shutil
import subprocess

from launch import ROOT, command, environment, fill_table, read_summary, table_parser

FORMULATIONS = ("node_to_surface", "surface_to_surface")
# listed: the two surfaces of the pair by name. The pressure of `all` has the noise of faces that meet nothing in it.
WAYS = ("named", "swapped", "all", "listed")
# The automatic penalty is that of all faces of a surface in the mean, so that named pairs and lists have different ones.
# With 1000 of them what this changes is below 1e-4.
HOW = "smoother: diffuse, formulation: {}, penalty: {{initial: auto, scale: 1000}}"
# The answer is a probe of the scene that no way of contact changes the meaning of.
FORCE = "{name: answer, reaction: plate_top, component: y, absolute: true}"
TIP = "{name: answer, displacement: [70, 4, 10], component: y}"
RIM = "{name: answer, displacement: [30, 0], component: x}"
POLE = "{name: answer, displacement: [30, 0, 0], component: x}"
# name: (scene, overrides, slave, master, more of the entry, probe of the answer, whether its pressure is uniform)
SCENES = {
    "pipe": ("pipe_pinch", ("mesh.parameters={n_arc: 20, n_wall: 1, n_len: 8}", ), "plate_bottom", "pipe_outer", "",
             FORCE, False),
    "plate": ("plate_cylinder_meshed",
              ("mesh.parameters={h_contact: 0.5, h_far: 7, n_thick: 2, n_width: 2, cylinder: 1, facet: 1, "
               "n_cylinder_z: 4}", ), "plate_bottom", "cylinder", "", TIP, False),
    "rings": ("ring_in_ring", ("mesh.parameters.jitter=0.25", ), "inner_contact", "outer_contact",
              ", initial_overlap: resolve", RIM, True),
    "spheres": ("spheres", ("mesh.parameters.jitter=0.25", ), "inner_contact", "outer_contact",
                ", initial_overlap: resolve", POLE, True),
}
COLUMNS = ("scene", "formulation", "way", "status", "iterations", "answer", "noise_rms", "cpu_s")


def cases():
    """A rigid tool is no slave, and the noise is that of fitted rings and spheres."""
    return [(scene, formulation, way) for scene in SCENES for formulation in FORMULATIONS for way in WAYS
            if (scene, way) != ("plate", "swapped") and (way != "listed" or SCENES[scene][-1])]


def overrides(scene, formulation, way):
    _, more, slave, master, extra, answer, noisy = SCENES[scene]
    if way == "swapped":
        slave, master = master, slave
    sides = {"all": "surfaces: all", "listed": f"surfaces: [{slave}, {master}]"}.get(
        way, f"slave: {slave}, master: {master}")
    probes = [answer]
    if noisy and way != "all":
        pairs = (f"c.{slave}.{master}", f"c.{master}.{slave}") if way == "listed" else ("c", )
        probes += [f"{{name: noise{k}, pressure_deviation: {pair}, measure: rms}}" for k, pair in enumerate(pairs)]
    return (*more, f"contact=[{{name: c, {sides}, {HOW.format(formulation)}{extra}}}]", f"probes=[{', '.join(probes)}]",
            "output.every=0")


def solve(case, args):
    out = args.out / "-".join(case)
    shutil.rmtree(out, ignore_errors=True)
    scene = ROOT / "runs" / f"{SCENES[case[0]][0]}.yaml"
    line = command(args.burnish, 1, scene, out, overrides(*case), "-quiet")
    subprocess.run(line, env=environment(args.burnish), capture_output=True, check=False)
    summary = read_summary(out)
    probes = summary["probes"]
    noise = [value for name, value in probes.items() if name.startswith("noise")]
    return dict(zip(COLUMNS, (*case, summary["status"], summary["newton_iterations"], f"{probes['answer']:.8g}",
                              f"{max(noise):.3g}" if noise else "", f"{summary['cpu_s']:.2f}")))


def compare(rows, scene, formulation):
    """The rows of the ways; the spread of the two roles and the difference of `all` from their mean, in per cent."""
    found = {row["way"]: row for row in rows if (row["scene"], row["formulation"]) == (scene, formulation)}
    named = [float(found[way]["answer"]) for way in ("named", "swapped") if way in found]
    mean = sum(named) / len(named)
    return found, 100 * (max(named) - min(named)) / abs(mean), 100 * (float(found["all"]["answer"]) / mean - 1)


def table(rows):
    print("| scene | formulation | spread of the roles (%) | all against their mean (%) | "
          "iterations: named, swapped, all, listed | noise of the pressure (rms, %) | CPU s |")
    print("| --- " * 7 + "|")
    for scene in SCENES:
        for formulation in FORMULATIONS:
            found, spread, difference = compare(rows, scene, formulation)

            def cells(key):
                return ", ".join(found[way][key] or "-" if way in found else "-" for way in WAYS)

            spread = f"{spread:.2g}" if "swapped" in found else "-"
            noise = cells("noise_rms") if found["named"]["noise_rms"] else "-"
            print(f"| {scene} | {formulation.replace('_', ' ')} | {spread} | {difference:+.2g} | "
                  f"{cells('iterations')} | {noise} | {cells('cpu_s')} |")


def main():
    parser = table_parser(__doc__, "all")
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time")
    fill_table(parser.parse_args(), COLUMNS, solve, cases(), table)


if __name__ == "__main__":
    main()
