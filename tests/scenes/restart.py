"""A run that is killed, stopped or out of disk goes on from its checkpoint, on any number of ranks, and ends as if
nothing had happened; what is no checkpoint of it is refused and nothing is touched."""
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import time

import h5py
import numpy

from harness import Check, Run, arguments, run, SCENES

SLIDING = SCENES / "../../runs/slide_cylinder.yaml"
PUSHED = SCENES / "tool.yaml"
# A punch is pushed into a plastic block and let go: plastic states and unknowns of a tool are kept.
PUSHED_OVERRIDES = [
    "bodies.0.material={law: von_mises, E: 1000, nu: 0.3, yield: 30, hardening: {linear: 20}}",
    "contact.0.master={cylinder: {point: [4.2, 8.2], radius: 3, free: [uy], force: "
    "[0, -150], history: [[0, 0], [0.7, 1], [1, 0.2]]}}", "contact.0.penalty={scale: 100}",
    "stepping={control: fixed, initial: 0.04}"
]
# Elements that hold J within, each with a state of its own: fbar, mixed with pressures of nodes, mixed with its own
ELEMENTS = {"plastic": ["mesh.order=1"], "plastic_nodal": ["mesh.order=1", "mesh.parameters.tri=1"],
            "plastic_mixed": ["mesh.order=2"]}
BATCH = pathlib.Path(__file__).resolve().parents[2] / "runs/batch"
COUNTS = ("step", "newton", "attempts", "contact_nodes", "nodes_in", "nodes_out")
# What summary.json may say differently of a run in parts: time, memory, and how often it went on. On other ranks also
# their number, how the mesh lies on them, and the round-off of the linear solver.
OWN = ("wall_s", "cpu_s", "seconds", "peak_rss_mb", "restarts", "mesh_s")
CLOCK = ("writing took", "search took")
SHORT = ("stepping.initial=0.06", "output={every: 1, checkpoint: 1}")
OF_RANKS = ("ranks", "partition", "linear.largest_residual", "certificate.residual", "certificate.force_balance",
            "certificate.moment_balance")

args = arguments(("part", "what is shown", ("kills", "sliding", *ELEMENTS, "signals", "refusals", "flips",
                                            "states", "options", "iterative")),
                 ("count", "how many kills, or flipped bits"))
out = pathlib.Path(args.out)
SCENE = PUSHED if args.part in ELEMENTS else SLIDING
check = Check()


def start(directory, *options, ranks=1, restart=False, overrides=(), **more):
    """Starts a run or its next part and leaves it running."""
    what = ["-restart", str(directory)] if restart else [str(SCENE), "-o", str(directory)]
    command = ["mpirun", "-n", str(ranks), args.burnish, *what, *options]
    for override in overrides:
        command += ["-set", override]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **more)


def finish(process, directory):
    text = process.communicate()[0]
    return Run(process.returncode, text, directory)


def go_on(directory, *options, ranks=1, overrides=(), **more):
    return finish(start(directory, *options, ranks=ranks, restart=True, overrides=overrides, **more), directory)


def rank_ids(launcher):
    """Process ids of the ranks: the launcher's children."""
    children = pathlib.Path(f"/proc/{launcher}/task/{launcher}/children")
    return [int(child) for child in children.read_text().split()] if children.exists() else []


def rows(directory):
    """steps.csv as its own text without the wall clock."""
    lines = [line.split(",") for line in (directory / "steps.csv").read_text().splitlines()]
    clock = lines[0].index("wall_s")
    return [line[:clock] + line[clock + 1:] for line in lines]


def written(directory):
    """Every dataset of results.h5 but those put together from others, and the step numbers of the written states."""
    sets = {}
    with h5py.File(directory / "results.h5", "r") as file:
        file["steps"].visititems(lambda name, item: sets.update({name: item[()]})
                                 if isinstance(item, h5py.Dataset) and not item.is_virtual else None)
        file["mesh"].visititems(lambda name, item: sets.update({name: item[()]}))
        assert file["VTKHDF/Steps"].attrs["NSteps"] == len(file["steps"])
        return sets, [int(file["steps"][group].attrs["step"]) for group in sorted(file["steps"])]


def same_files(what, directory, reference):
    """To the last bit: what one rank leaves."""
    check.holds(f"{what}: steps.csv is that of the whole run", rows(directory) == rows(reference))
    ours, steps = written(directory)
    theirs, reference_steps = written(reference)
    check.holds(f"{what}: results.h5 has its steps", steps == reference_steps, f"{len(steps)}")
    equal = ours.keys() == theirs.keys() and all(
        numpy.array_equal(ours[name], theirs[name], equal_nan=ours[name].dtype.kind == "f") for name in ours)
    check.holds(f"{what}: results.h5 has its values, to the last bit", equal)


def same_results(what, directory, reference, tolerance=1e-9):
    """On any ranks: the same steps, values to a tolerance of the largest."""
    one, other = Run(0, "", reference).steps(), Run(0, "", directory).steps()
    for name in COUNTS:
        check.holds(f"{what}: {name}", [row[name] for row in one] == [row[name] for row in other])
    if len(one) != len(other):
        return
    for name in ("t", "max_penetration", "contact_force", *Run(0, "", reference).summary()["probes"]):
        a, b = (numpy.array([row[name] for row in part], dtype=float) for part in (one, other))
        check.near(f"{what}: {name}", b, a, tolerance * numpy.max(numpy.abs(a)))
    (ours, steps), (theirs, reference_steps) = written(directory), written(reference)
    check.holds(f"{what}: results.h5 has its steps", steps == reference_steps and ours.keys() == theirs.keys(),
                f"{len(steps)}")
    worst = max(
        numpy.max(numpy.abs(ours[name] - theirs[name])) / max(numpy.max(numpy.abs(theirs[name])), 1e-300)
        for name in theirs
        if name.endswith("displacement"))
    check.near(f"{what}: displacements", worst, 0, tolerance)


def flat(value, path=""):
    """Every value of summary.json by its path, with dots between keys and places in lists."""
    inside = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else None
    if inside is None:
        return {path: value}
    found = {path: type(value).__name__}
    for key, item in inside:
        found.update(flat(item, f"{path}.{key}" if path else str(key)))
    return found


def same_value(a, b, tolerance):
    if isinstance(a, float) or isinstance(b, float):
        return a == b or (None not in (a, b) and abs(a - b) <= tolerance * max(abs(a), abs(b)))
    return a == b


def unclocked(summary):
    """The summary without advice that the clock alone gives, which a busy machine gives here and there."""
    summary["advice"] = [text for text in summary["advice"] if not text.startswith(CLOCK)]
    return summary


def same_summary(what, directory, reference, tolerance=0, other=()):
    """Every key but the exceptions: equal, numbers with fractions to a relative tolerance where the ranks differ."""
    ours, theirs = (flat(unclocked(Run(0, "", part).summary())) for part in (directory, reference))
    ranks = ours["ranks"] != theirs["ranks"]
    exceptions = OWN + (OF_RANKS if ranks or tolerance else ()) + tuple(other)
    apart = [
        f"{key}: {ours.get(key, 'is not there')} instead of {theirs.get(key, 'nothing')}" for key in {
            **theirs,
            **ours
        } if not any(key == name or key.startswith(name + ".") for name in exceptions)
        and not (key in ours and key in theirs and same_value(ours[key], theirs[key], tolerance))
    ]
    check.holds(f"{what}: summary.json is that of the whole run", not apart, "; ".join(apart))


def wait_for_rows(process, directory, n):
    while process.poll() is None and not ((directory / "steps.csv").exists() and len(
        (directory / "steps.csv").read_text().splitlines()) > n):
        time.sleep(0.005)


def plastic():
    """Kills with plastic states and a tool that is pushed; every other one goes on on one rank, to the last bit."""
    kills([*PUSHED_OVERRIDES, *ELEMENTS[args.part], "output={every: 1, checkpoint: 1}"], one=2, estimates=1e-5)


def kills(overrides=SHORT, one=0, estimates=1e-7, zeros=()):
    """kill -9 of all ranks, or of one, at a random moment; most of such a run is spent in writing. one: each kill of so
    many is of a run on one rank that goes on on one, 0: the first alone. estimates: tolerance of summary.json on other
    ranks, whose estimates of errors are differences of linear solves. zeros: its entries that are round-off."""
    generator = random.Random(4)
    reference = run(args, SCENE, out="reference", ranks=1, overrides=overrides).directory
    steps = len(rows(reference)) - 1
    begun, pace = 0, Run(0, "", reference).summary()["wall_s"] / steps
    for kill in range(int(args.count)):
        alone = kill == 0 or (one and kill % one == 0)
        ranks, others = (1, 1) if alone else (1 + kill % 3, 1 + (kill + 1) % 3)
        directory = out / f"killed_{kill}"
        shutil.rmtree(directory, ignore_errors=True)
        process = start(directory, ranks=ranks, overrides=overrides)
        wait_for_rows(process, directory, generator.randrange(1, steps - 4))
        time.sleep(generator.uniform(0, 2 * pace))
        victims = rank_ids(process.pid)
        for victim in victims if kill % 2 else victims[-1:]:
            os.kill(victim, signal.SIGKILL)
        killed = finish(process, directory)
        reached = len((directory / "steps.csv").read_text().splitlines()) - 1
        left = (directory / "checkpoint.h5").exists()
        part = (directory / "checkpoint.h5.tmp").exists()
        what = f"kill {kill}, on {ranks} after step {reached}{', while writing' if part else ''}, again on {others}"
        check.holds(f"{what}: the launcher tells", killed.status != 0, f"status {killed.status}")
        begun += not left
        again = go_on(directory, ranks=others) if left else finish(start(directory, ranks=others, overrides=overrides),
                                                                   directory)
        check.holds(f"{what}: goes on to the end", again.status == 0, again.text if again.status else "")
        if again.status == 0 and (ranks, others) == (1, 1):
            same_files(what, directory, reference)
        if again.status == 0:
            same_results(what, directory, reference)
            same_summary(what, directory, reference, 0 if (ranks, others) == (1, 1) else estimates, zeros)
    check.holds("most were killed after their first checkpoint", begun <= max(1,
                                                                              int(args.count) / 3), f"{begun} before")


def sliding():
    """The same with friction: what sticks and what has slipped goes on as if nothing had happened."""
    kills([*SHORT, "contact.0.friction.mu=0.3"], zeros=["contact.0.friction.force.2"])


def stopped(what, ended, reference, status=3):
    """Ended early with a checkpoint; goes on to the same end on two ranks, or on one."""
    check.holds(f"{what}: exit status 3", ended.status == status,
                f"{ended.status}\n{ended.text if ended.status != status else ''}")
    if ended.status != status:
        return
    summary = ended.summary()
    check.holds(f"{what}: status stopped, with its cause", summary["status"] == "stopped"
                and summary["steps"] < len(rows(reference)) - 1, summary["message"])
    again = go_on(ended.directory, ranks=2)
    check.holds(f"{what}: goes on to the end", again.status == 0, again.text if again.status else "")
    if again.status == 0:
        same_results(what, ended.directory, reference)
        same_summary(what, ended.directory, reference, 1e-7)


def signals():
    overrides = ["stepping.initial=0.004", "output.every=50"]
    reference = run(args, SCENE, out="reference", ranks=1, overrides=overrides).directory

    def begin(name, *options, ranks=2):
        directory = out / name
        shutil.rmtree(directory, ignore_errors=True)
        process = start(directory, *options, ranks=ranks, overrides=overrides)
        wait_for_rows(process, directory, 3)
        return process, directory

    process, directory = begin("usr1")
    process.send_signal(signal.SIGUSR1)
    stopped("USR1 to mpirun", finish(process, directory), reference)
    process, directory = begin("term")
    os.kill(rank_ids(process.pid)[-1], signal.SIGTERM)
    stopped("TERM to the last rank", finish(process, directory), reference)
    time_limit(begin, reference)

    process, directory = begin("one", ranks=1)
    process.send_signal(signal.SIGUSR1)
    ended = finish(process, directory)
    again = go_on(directory)
    check.holds("one rank: stopped and done", (ended.status, again.status) == (3, 0))
    same_files("one rank", directory, reference)
    failed(reference, overrides)
    batch(reference, overrides)


def time_limit(begin, reference):
    """Half of what the whole run took; less where the machine has become faster since, so that the run ends before its
    limit."""
    limit = Run(0, "", reference).summary()["wall_s"]
    for _ in range(6):
        limit *= 0.5
        process, directory = begin("limit", "-time_limit", f"{limit:.3g}", ranks=1)
        ended = finish(process, directory)
        if ended.status != 0:
            break
    stopped(f"-time_limit {limit:.3g}", ended, reference)


def failed(reference, overrides):
    """A run that did not converge goes on from its last good step once the solver may try harder."""
    ended = run(args, SCENE, out="failed", ranks=1,
                overrides=[*overrides, "stepping.dt_min=0.003", "stepping.damping=none", "solver.max_iterations=2"],
                must=2)
    steps = ended.summary()["steps"]
    again = go_on(ended.directory, overrides=["solver.max_iterations=30"])
    check.holds("not converged, then with more iterations: goes on to the end", again.status == 0, f"from step {steps}")
    last, whole = Run(0, "", ended.directory).steps()[-1], Run(0, "", reference).steps()[-1]
    check.near("not converged, then with more iterations: force at the end", last["contact_force"],
               whole["contact_force"], 1e-6 * whole["contact_force"])


def batch(reference, overrides):
    """The job script with no queue around it: its way back into it is a program that only notes that it was called."""
    directory, scratch = out / "batch", out / "queue"
    for each in (directory, scratch):
        shutil.rmtree(each, ignore_errors=True)
    scratch.mkdir(parents=True)
    for name in ("build", "runs", "meshes"):
        (scratch / name).symlink_to(BATCH.parents[1] /
                                    name if name != "build" else pathlib.Path(args.burnish).resolve().parent)
    (scratch / "scontrol").write_text(f'#!/bin/sh\necho "$@" >>{scratch}/queue\n')
    (scratch / "scontrol").chmod(0o755)
    options = [word for override in overrides for word in ("-set", override)]
    environment = dict(os.environ, SLURM_SUBMIT_DIR=str(scratch), SLURM_JOB_ID="7", SLURM_NTASKS="2",
                       PATH=f"{scratch}:{os.environ['PATH']}", LAUNCH="mpirun -n 2")
    command = [str(scratch / "runs/batch/slurm.sh"), "runs/slide_cylinder.yaml", str(directory.resolve()), *options]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment)
    wait_for_rows(process, directory, 3)
    process.send_signal(signal.SIGTERM)
    ended = finish(process, directory)
    check.holds("job script: TERM ends it, and it is queued again", ended.status == 0
                and (scratch / "queue").read_text() == "requeue 7\n", ended.text)
    check.holds("job script: stopped", ended.summary()["status"] == "stopped", ended.summary()["message"] or "")
    again = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment,
                           check=False)
    check.holds("job script: the second time it ends the run", again.returncode == 0,
                again.stdout if again.returncode else "")
    same_results("job script", directory, reference)


def refused(what, directory, expected, *options, overrides=(), ranks=1, **more):
    """Exit status 1, one message that says so, and every file as it was."""
    before = {file.name: file.read_bytes() for file in directory.iterdir()}
    again = go_on(directory, *options, ranks=ranks, overrides=overrides, **more)
    told = [line for line in again.text.splitlines() if line.startswith("burnish: ")]
    check.holds(f"{what}: refused", again.status == 1 and len(told) == 1 and expected in told[0],
                told[0] if told else again.text)
    check.holds(f"{what}: nothing is touched", before == {file.name: file.read_bytes() for file in directory.iterdir()})


HEAD, BLOCK, WORD = 512, 1 << 20, (1 << 64) - 1  # bytes of the file's head, bytes of a block of its checksum, 64 bits


def checksum(content):
    """That of a checkpoint: CRC-64 (ECMA-182, as in xz) of each block behind the head, mixed and added up."""
    table = []
    for code in range(256):
        for _ in range(8):
            code = code >> 1 ^ (0xC96C5795D7870F42 if code & 1 else 0)
        table.append(code)
    total = 0
    for number, start in enumerate(range(HEAD, len(content), BLOCK)):
        code = WORD
        for byte in content[start : start + BLOCK]:
            code = code >> 8 ^ table[code & 255 ^ byte]
        code = ((code ^ WORD) + number) & WORD
        for factor in (0xFF51AFD7ED558CCD, 0xC4CEB9FE1A85EC53):
            code = (code ^ code >> 33) * factor & WORD
        total += code ^ code >> 33
    return total & WORD


def with_head(path):
    """Gives a changed checkpoint the head that belongs to it."""
    content = path.read_bytes()
    version = re.match(rb"burnish checkpoint\nversion (\d+)\n", content)[1].decode()
    head = f"burnish checkpoint\nversion {version}\nbytes {len(content)}\nchecksum {checksum(content):016x}\n"
    path.write_bytes(head.encode().ljust(HEAD, b"\0") + content[HEAD:])


def places(path, count, generator):
    """Bytes of a checkpoint: in its head, in HDF5's first block, in datasets in turn, anywhere, and the last."""
    data = []
    with h5py.File(path, "r") as file:
        file.visititems(lambda _, item: data.append((item.id.get_offset(), item.nbytes)) if isinstance(
            item, h5py.Dataset) and item.nbytes else None)
    length = path.stat().st_size
    found = [0, 19, 27, 40, 60, HEAD - 1, HEAD, HEAD + 8, HEAD + 20, HEAD + 40, HEAD + 96, length - 1]
    for first, size in generator.sample(data, min(len(data), count // 2)):
        found.append(generator.randrange(first, first + size))
    return found + [generator.randrange(HEAD, length) for _ in range(count - len(found))]


def flips():
    """One bit of the checkpoint is another one: exit status 1 and one message that names the file, at once and with no
    file touched."""
    overrides = ["stepping.initial=0.08", "output={every: 1, checkpoint: 4}"]
    directory = run(args, SCENE, out="flips", ranks=1, overrides=overrides).directory
    path = directory / "checkpoint.h5"
    whole, before = path.read_bytes(), sorted(directory.iterdir())
    generator = random.Random(7)
    for place in places(path, int(args.count), generator):
        changed = bytearray(whole)
        changed[place] ^= 1 << generator.randrange(8)
        path.write_bytes(changed)
        try:
            ended = subprocess.run([args.burnish, "-restart", str(directory)], stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True, timeout=60, check=False)
            status, text = ended.returncode, ended.stdout
        except subprocess.TimeoutExpired:
            status, text = "none: it hangs", ""
        told = [line for line in text.splitlines() if line.startswith("burnish: ")]
        check.holds(f"byte {place}: refused", status == 1 and len(told) == 1 and str(path) in told[0],
                    f"status {status}: {told[0] if told else text}")
        check.holds(f"byte {place}: nothing is touched",
                    path.read_bytes() == changed and sorted(directory.iterdir()) == before)
    path.write_bytes(whole)
    again = go_on(directory)
    check.holds("all bits as they were: goes on", again.status == 0, again.text if again.status else "")


def options():
    """PETSc's options of both parts of a run, from the scene, the command line and the environment."""
    overrides = [
        "petsc={ksp_type: preonly, snes_max_it: 40}", "stepping.initial=0.08", "output={every: 0, checkpoint: 4}"
    ]
    directory = run(args, SCENE, "-snes_divergence_tolerance", "-1", out="options", ranks=1,
                    overrides=overrides).directory
    kept = (directory / "checkpoint.h5").read_bytes()
    check.holds("a run without a restart: none changed", Run(0, "", directory).summary()["options"]["changed"] == [])
    same = go_on(directory, "-snes_divergence_tolerance", "-1")
    told = [line for line in same.text.splitlines() if line.startswith("options")]
    check.holds("the same options: none changed", same.status == 0 and not told
                and same.summary()["options"]["changed"] == [], "; ".join(told))
    (directory / "checkpoint.h5").write_bytes(kept)
    other = go_on(directory, "-snes_max_it", "50", env=dict(os.environ, PETSC_OPTIONS="-snes_stol 0"))
    expected = [
        "-snes_max_it 50 instead of 40", "-snes_stol 0 is new", "-snes_divergence_tolerance -1 is no longer set"
    ]
    changed, text = other.summary()["options"]["changed"], [
        line for line in other.text.splitlines() if line.startswith("options")
    ]
    for line in expected:
        check.holds(f"other options: {line}",
                    any(line in each for each in changed) and any(line in each for each in text))
    check.holds("other options: no others", len(changed) == len(text) == len(expected), "; ".join(changed))


def refusals():
    overrides = ["stepping.initial=0.08", "output={every: 1, checkpoint: 4}"]
    reference = run(args, SCENE, out="reference", ranks=1, overrides=overrides).directory
    kept = reference / "checkpoint.h5"

    def copy(name, content):
        shutil.rmtree(out / name, ignore_errors=True)
        shutil.copytree(reference, out / name)
        (out / name / "checkpoint.h5").write_bytes(content)
        return out / name

    whole = kept.read_bytes()
    for part in (0.999, 0.5, 0.01):
        refused(f"{100 * part:g} % of the file", copy("truncated", whole[:int(part * len(whole))]),
                "a part of it is missing")
    refused("on two ranks", copy("truncated", whole[: len(whole) // 2]), "a part of it is missing", ranks=2)
    refused("another file", copy("foreign", b"name: a scene\n"), "not written by burnish")
    refused("the end of another file behind it", copy("foreign", whole + b"more"), "do not match its checksum")
    refused("another HDF5 file", copy("foreign", (reference / "results.h5").read_bytes()), "not written by burnish")
    other = run(args, SCENE, out="other", ranks=1, overrides=[*overrides, "loads.0.uy=-0.1"]).directory
    refused("another scene's", copy("foreign", (other / "checkpoint.h5").read_bytes()), "another scene")
    refused("another version", copy("version", re.sub(rb"version \d+", b"version 99", whole, count=1)), "version 99")
    with h5py.File(copy("damaged", whole) / "checkpoint.h5", "a") as file:
        del file["stepper/size"]
    refused("changed by other programs", out / "damaged", "do not match its checksum")
    with_head(out / "damaged/checkpoint.h5")
    refused("a value is gone", out / "damaged", "/stepper/size")
    with_head(copy("whole", whole) / "checkpoint.h5")
    check.holds("the checksum is the one that is documented", (out / "whole/checkpoint.h5").read_bytes() == whole)
    (copy("none", whole) / "checkpoint.h5").unlink()
    refused("no checkpoint", out / "none", "No such file")
    for override in ("mesh.order=2", "contact.0.smoother=diffuse", "loads=[]", "petsc={snes_monitor: ''}"):
        refused(f"-set {override}", copy("set", whole), "output, solver and stepping", overrides=[override])
    refused("-o", reference, "leave -o out", "-o", "elsewhere")

    changed = go_on(copy("changed", whole),
                    overrides=["stepping.initial=0.02", "mesh.order=1", "solver.tolerance=1e-9", "output.checkpoint=0"])
    check.holds("-set stepping, solver, output, and what the scene has: goes on", changed.status == 0,
                changed.text if changed.status else "")
    check.near("-set stepping.initial: the next step's dt", changed.steps()[12]["dt"], 0.02, 1e-12)

    fields = copy("fields", whole)
    less = go_on(fields, overrides=["output={every: 1, fields: [displacement]}"])
    with h5py.File(fields / "results.h5", "r") as file:
        held = [sorted(file["steps"][group]) for group in sorted(file["steps"])]
    check.holds("-set output.fields: from here on", less.status == 0 and set(held[-1]) - {"tools"} == {"displacement"}
                and "stress" in held[0] and len(held) == 13)
    text = (fields / "results.xdmf").read_text()
    of_bodies = len(re.findall(r"/steps/\d+/displacement<", text))
    check.holds("-set output.fields: results.xdmf knows", of_bodies == 13 and text.count("Name=\"von_mises\"") == 12)
    no_room(whole, reference)


def no_room(whole, reference):
    """A disk with room for one checkpoint and no second one beside it, where such a disk can be made: as root, seen by
    this run only."""
    disk = out / "disk"
    shutil.rmtree(disk, ignore_errors=True)
    disk.mkdir()
    size = sum(file.lstat().st_size for file in reference.iterdir()) + len(whole) // 2
    script = """mount -t tmpfs -o size=$1 none "$2" || exit 77
        cp -P "$3"/* "$2"
        mpirun -n 2 "$4" -restart "$2" -set output.every=0 -set output.checkpoint=1 -quiet
        echo "status $?"
        mpirun -n 1 "$4" -restart "$2" -set output.checkpoint=0 -quiet &&
          rm -f "$2"/checkpoint.h5.tmp && cp -P "$2"/* "$3" """
    full = out / "full"
    shutil.rmtree(full, ignore_errors=True)
    shutil.copytree(reference, full, symlinks=True)
    command = ["unshare", "-m", "sh", "-c", script, "sh", str(size), str(disk), str(full), args.burnish]
    ended = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if ended.returncode in (1, 77) and "status" not in ended.stdout:
        print(f"no disk of its own can be made here, so a full one is not tried: {ended.stdout.strip()}")
        return
    told = [line for line in ended.stdout.splitlines() if "No space left on device" in line]
    check.holds("full disk: exit status 4, told once", "status 4" in ended.stdout and len(told) == 1
                and "is intact" in told[0], told[0] if told else ended.stdout)
    check.holds("full disk: goes on from the old checkpoint once there is room", ended.returncode == 0,
                ended.stdout if ended.returncode else "")
    check.holds("full disk: the old checkpoint is intact", (full / "checkpoint.h5").read_bytes() == whole)
    same_files("full disk", full, reference)


FOLLOWING = 1e-7  # penalties follow the penetration: round-off of a displacement is more of a penetration that small
STATES = {  # scene and what makes it short; a checkpoint lies before the last steps
    "forecast": ("cup_flattening", 3, ["stepping={control: contact, initial: 0.025, N_c: 5, prediction: tangent}"]),
    "steps by contact": ("cup_flattening", 4, ["stepping={control: contact, initial: 0.025, N_c: 5, prediction: "
                                               "converged}"]),
    "penalties": ("plate_cylinder", 4, ["mesh.parameters={h_contact: 0.5, h_far: 8, n_thick: 3, n_width: 1}"]),
    "penalties by step": ("plate_cylinder", 4, ["mesh.parameters={h_contact: 0.5, h_far: 8, n_thick: 3, n_width: 1}",
                                                "contact.0.penalty.when=step"]),
    "multipliers": ("cup_flattening", 3, ["stepping={control: fixed, initial: 0.125}",
                                          "contact.0.penalty={scale: 1, augment: true, g_max: 1e-4, unit: length}"]),
    "multipliers of friction": ("cup_flattening", 3, [
        "stepping={control: fixed, initial: 0.125}", "contact.0.friction.mu=0.2",
        "contact.0.penalty={scale: 1, augment: true, g_max: 1e-3, unit: length}"]),
    "offsets": ("slide_facets", 4, ["stepping.initial=0.1", "contact.0.smoother=diffuse",
                                    "contact.0.formulation=surface_to_surface",
                                    "probes=[{name: force, contact_force: sole, component: y}]"]),
    "live offsets": ("pipe_pinch", 3, ["mesh.order=1", "mesh.parameters={n_arc: 8, n_wall: 1, n_len: 3}",
                                       "contact.0.smoother=diffuse", "contact.0.formulation=surface_to_surface",
                                       "contact.0.offset=live", "loads.0.uy=-20",
                                       "stepping={control: fixed, initial: 0.25}",
                                       "probes=[{name: force, reaction: plate_top, component: y}]"]),
    "plastic states": ("pipe_pinch", 3, ["mesh.order=1", "mesh.parameters={n_arc: 8, n_wall: 2, n_len: 3}",
                                         "bodies.0.material={law: von_mises, E: 20000, nu: 0.3, yield: 100, "
                                         "hardening: {linear: 200}}", "loads.0.uy=-20", "contact.0.penalty={scale: 1}",
                                         "stepping={control: fixed, initial: 0.125}",
                                         "probes=[{name: force, reaction: plate_top, component: y}]"]),
    "factors with a border": ("pipe_pinch", 3, ["mesh.parameters={n_arc: 18, n_wall: 1, n_len: 8}",
                                                "contact.0.smoother=diffuse", "contact.0.degree=2", "loads.0.uy=-20",
                                                "stepping={control: fixed, initial: 0.25}",
                                                "probes=[{name: force, reaction: plate_top, component: y}]"]),
    "kept pattern": ("slide_flat", 7, ["contact.0.smoother=diffuse", "probes=[{name: force, contact_force: sole, "
                                                                     "component: y}]"]),
}


def states():
    """All that the next steps depend on is in the checkpoint: what is remembered differs from scene to scene."""
    for what, (scene, every, overrides) in STATES.items():
        path = SCENES / f"../../runs/{scene}.yaml"
        reference = run(args, path, out=f"whole {what}", ranks=1, overrides=overrides).directory
        for ranks in (1, 2):
            directory = run(args, path, out=f"part {what}", ranks=1,
                            overrides=[*overrides, f"output.checkpoint={every}"]).directory
            again = go_on(directory, ranks=ranks)
            check.holds(f"{what}, on {ranks}: goes on", again.status == 0 and "restart  after step" in again.text,
                        again.text if again.status else "")
            if ranks == 1:
                same_files(what, directory, reference)
            same_results(f"{what}, on {ranks}", directory, reference,
                         FOLLOWING if "adjust: true" in path.read_text() else 1e-9)
            same_summary(f"{what}, on {ranks}", directory, reference, 0 if ranks == 1 else 1e-5)


def iterative():
    """Multigrid keeps its coarse spaces, which a restart makes anew: equal to the tolerance of the linear solves."""
    path = SCENES / "../../runs/ring_in_ring_3d.yaml"
    overrides = ["mesh.parameters={n_inner: 10, n_outer: 12, n_len: 4}", "solver.type=iterative",
                 "stepping={control: fixed, initial: 0.125}"]
    reference = run(args, path, out="whole", ranks=1, overrides=overrides).directory
    for ranks in (1, 2):
        directory = run(args, path, out=f"part on {ranks}", ranks=1,
                        overrides=[*overrides, "output.checkpoint=5"]).directory
        again = go_on(directory, ranks=ranks)
        check.holds(f"on {ranks}: goes on", again.status == 0 and "restart  after step" in again.text,
                    again.text if again.status else "")
        same_results(f"on {ranks}", directory, reference, 1e-8)


{
    "kills": kills,
    "sliding": sliding,
    **dict.fromkeys(ELEMENTS, plastic),
    "signals": signals,
    "refusals": refusals,
    "flips": flips,
    "states": states,
    "options": options,
    "iterative": iterative
}[args.part]()
check.finish()
