"""A run with backstresses, an overstress, a routine of a user or a pushed tool that rolls by friction, that is killed,
goes on from its checkpoint: on one rank with the same steps.csv bit for bit, on several within round-off, as the
parallel factorisation adds up in an order of its own."""
import pathlib
import shutil
import signal
import subprocess
import time

import numpy

from harness import SCENES, Check, Run, arguments, run

ROOT = pathlib.Path(__file__).resolve().parents[2]
args = arguments()
check = Check()
out = pathlib.Path(args.out).resolve()
out.mkdir(parents=True, exist_ok=True)
library = out / f"j2_{args.ranks}.so"
subprocess.run([ROOT / "scripts/build_umat.sh", ROOT / "tests/umat/j2.f", library], check=True)
LAWS = {
    "backstresses": "{law: von_mises, E: 200e3, nu: 0.3, yield: 200, kinematic: [{C: 40e3, gamma: 500}, {C: 5e3}], "
                    "perzyna: {overstress: 100, speed: 0.4, power: 3}}",
    "routine": f"{{law: umat, E: 200e3, nu: 0.3, library: {library}, constants: [200e3, 0.3, 450, 2000], states: 1}}",
}
STEPS = 40


def table(directory):
    rows = [line.split(",") for line in (directory / "steps.csv").read_text().splitlines()]
    clock = rows[0].index("wall_s")
    return [row[:clock] + row[clock + 1:] for row in rows]


def kill_and_restart(scene, directory, overrides, ranks, after):
    command = ["mpirun", "-n", str(args.ranks), args.burnish, str(SCENES / scene), "-quiet", "-trust", "-o",
               str(directory)]
    for override in overrides:
        command += ["-set", override]
    launcher = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while launcher.poll() is None:  # until so many steps are done
        steps = directory / "steps.csv"
        if steps.exists() and steps.read_text().count("\n") > after:
            children = pathlib.Path(f"/proc/{launcher.pid}/task/{launcher.pid}/children").read_text().split()
            for child in children:
                subprocess.run(["kill", f"-{signal.SIGKILL.value}", child], check=False)
            break
        time.sleep(0.01)
    launcher.wait()
    command = ["mpirun", "-n", str(ranks), args.burnish, "-restart", str(directory), "-quiet", "-trust"]
    finished = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    return Run(finished.returncode, finished.stdout, directory)


CASES = {}
for name, material in LAWS.items():
    CASES[name] = "plastic_bar.yaml", STEPS // 3, [
        f"bodies.0.material={material}", "mesh.parameters={lx: 2, ly: 1, lz: 1, nx: 4, ny: 3, nz: 3, tet: 0}",
        "bodies.0.formulation=fbar", "supports.1={surface: x_min, uy: 0}",
        "loads.0={surface: x_max, ux: 0.1, uy: 0.05, history: [[0, 0], [0.5, 1], [1, -1]]}",
        f"stepping={{control: fixed, initial: {1 / STEPS}}}", "output={checkpoint: 1, every: 0}"
    ]
CASES["rolling"] = "tool.yaml", 3, [
    "mesh.order=1", "contact.0.friction.mu=0.3", "output={checkpoint: 1, every: 0}",
    "bodies.0.material={law: von_mises, E: 1000, nu: 0.3, yield: 15, hardening: {linear: 50}, "
    "kinematic: [{C: 100, gamma: 10}]}", "contact.0.master={cylinder: {point: [5, 8.2], radius: 3, free: [uy, rz], "
    "force: [0, -30], history: [[0, 0], [0.3, 1], [1, 1]], motion: [{ux: 2, history: [[0, 0], [0.3, 0], [1, 1]]}]}}"
]
for name, (scene, after, overrides) in CASES.items():
    whole = run(args, SCENES / scene, "-quiet", "-trust", out=f"{name}_whole", overrides=overrides)
    for ranks in (args.ranks, args.ranks + 1):
        directory = out / f"{name}_parts_{ranks}"
        shutil.rmtree(directory, ignore_errors=True)
        parts = kill_and_restart(scene, directory, overrides, ranks, after)
        check.holds(f"{name}: {ranks} ranks go on", parts.status == 0 and parts.summary()["restarts"] == 1)
        if ranks == args.ranks == 1:
            check.holds(f"{name}: the same steps, bit for bit", table(directory) == table(whole.directory))
        else:
            forces = [[row["force"] for row in finished.steps()] for finished in (parts, whole)]
            size = numpy.max(numpy.abs(forces[1]))
            check.near(f"{name}: other ranks", numpy.array(forces[0]) / size, numpy.array(forces[1]) / size, 1e-9)
check.finish()
