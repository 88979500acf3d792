"""A scene pays only for the effects it calls for: one that is off leaves no log event and allocates nothing, and keys
of effects that are off change no result bit and no allocation."""
import pathlib
import re

import h5py

from harness import Check, arguments, run, SCENES

SOURCE = SCENES.parent.parent / "src"
RINGS = SCENES.parent.parent / "runs" / "ring_in_ring.yaml"
PAIR = ("contact.0={name: fit, slave: inner_contact, master: outer_contact, symmetry: [symmetry_x, symmetry_y], "
        "smoother: facet, formulation: node_to_surface, initial_overlap: resolve, penalty: {scale: 100}}")
MESH = "mesh.parameters={n_inner: 8, n_outer: 10}"
BASE = [
    MESH, PAIR, "kinematics=finite", "loads=[{surface: outer_contact, pressure: 1}]",
    "stepping={control: fixed, initial: 0.5}", "output.every=0"
]
WINDOW = ["contact.0.penalty.g_min=1e-9", "contact.0.penalty.g_max=1e-5", "contact.0.penalty.unit=length"]
NO_CONTACT = ["contact=[]", "probes=[]"]
# An effect: what switches it on, what only it logs, whose functions only it lets allocate.
EFFECTS = {
    "contact":
    ([], "Contact",
     "contact.*|search|candidate|neighbourlists|neighbourhood|surface|slavepoints|facet.*|fit.*|offset|touchstep|"
     "anderson"),
    "diffuse": (["contact.0.smoother=diffuse"], "ContactFit", "fit.*"),
    "surface to surface": (["contact.0.smoother=diffuse",
                            "contact.0.formulation=surface_to_surface"], "ContactOffset", "offset|facequadrature"),
    "live offsets":
    (["contact.0.smoother=diffuse", "contact.0.formulation=surface_to_surface",
      "contact.0.offset=live"], "ContactOffset", "facemap"),
    "adjusted penalty": (["contact.0.penalty.adjust=true", *WINDOW], "ContactAdjust", ""),
    "augmented penalty": (["contact.0.penalty.augment=true", *WINDOW], "ContactAdjust", "contactpenalty|anderson"),
    "control by contact":
    (["stepping={control: contact, initial: 0.5, N_c: 5}"], "ContactTouch", "contacttouch|touchstep"),
    "errors of probes": (["output.error=true"], "ProbeError",
                         "adjoint|bodyerror|quantityerror|probeerrors|probevariation|cellpoints|recovery"),
    "follower load": (["loads.0.follower=true"], "LoadsFollower", ""),
}
# Keys that are there and off
OFF = [
    "contact.0.degree=2", "contact.0.support=3", "contact.0.weight=4", "contact.0.frame=global",
    "contact.0.derivatives=diffuse", "contact.0.offset=live", "contact.0.penalty.adjust=false",
    "contact.0.penalty.when=step", "contact.0.penalty.clamp=10", "contact.0.penalty.augment=false",
    "contact.0.penalty.max_updates=5", *WINDOW, "loads.0.follower=false", "stepping.N_c=5",
    "stepping.prediction=tangent", "output.checkpoint=0", "output.error=false"
]
# These files hold the text of the scene, the edits of it and its record. Their length follows the number of keys that
# are given, not the effects.
READERS = "document|schema|schemakeys|scene|sceneprobe|sceneread|commandline|burnish|gmsh|results|rundirectory"
PETSC_TEXT = ("PetscStrallocpy", "PetscStrreplace", "PetscFunctionListCreateNode_Private", "PetscOptions",
              "PetscLogView", "PetscViewer")


def definitions():
    """{function: file} of the functions that may allocate; kernels, which cannot, have some names in common with
    them."""
    return {
        name: path.stem
        for path in SOURCE.rglob("*.c")
        for name in re.findall(r"^(?:static )?PetscErrorCode (\w+)\([^;]*?\)\s*\{", path.read_text(), re.M)
    }


def trace(name, overrides):
    """A run with its log events {name: calls} and allocations {function: (count, bytes)}."""
    log = pathlib.Path(args.out) / f"{name}.log"
    finished = run(args, RINGS, "-quiet", "-log_view", f":{log}", "-malloc_view", out=name, overrides=overrides)
    events, blocks = {}, {}
    for event, calls in re.findall(r"^(\w+) +(\d+) \d\.\d", log.read_text(), re.M):
        events[event] = events.get(event, 0) + int(calls)
    for count, size, function in re.findall(r"^\[0\] (\d+) (\d+) (\w+)\(\)", finished.text, re.M):
        blocks[function] = (int(count), int(size))
    return finished, events, blocks


def files_of(blocks, pattern):
    return sorted(f for f in blocks if re.fullmatch(pattern, FILES.get(f, "-"))) if pattern else []


def contents(path):
    """Every dataset and attribute of a file, as bytes."""
    found = {}
    with h5py.File(path, "r") as file:
        file.visititems(lambda name, item: found.update({name: item[()].tobytes()}
                                                        if isinstance(item, h5py.Dataset) else {}))
    return found


args, check, FILES = arguments(), Check(), definitions()
(pathlib.Path(args.out)).mkdir(parents=True, exist_ok=True)
run(args, RINGS, "-quiet", out="first", overrides=BASE)  # makes the mesh
plain, plain_events, plain_blocks = trace("plain", BASE)
check.holds("events and allocations are seen",
            plain_events.get("ContactSearch", 0) > 0 and plain_blocks.get("ContactCreate", (0, 0))[0] > 0)
for effect, (keys, event, files) in EFFECTS.items():
    if effect == "contact":
        (_, off, off_blocks), (on, on_blocks) = trace("no_contact", [*BASE, *NO_CONTACT]), (plain_events, plain_blocks)
    else:
        (off, off_blocks), (_, on, on_blocks) = (plain_events, plain_blocks), trace(effect.replace(" ", "_"),
                                                                                    [*BASE, *keys])
    check.holds(f"{effect}: logs {event} when on", any(name.startswith(event) for name in on))
    check.holds(f"{effect}: logs nothing when off", not any(name.startswith(event) for name in off),
                str({
                    n: c
                    for n, c in off.items()
                    if n.startswith(event)
                }))
    check.holds(f"{effect}: allocates when on", not files or files_of(on_blocks, files))
    check.holds(f"{effect}: allocates nothing when off", not files_of(off_blocks, files),
                str(files_of(off_blocks, files)))

silent, silent_events, silent_blocks = trace("off", [*BASE, *OFF])
kept = [
    f for f in {
        **plain_blocks,
        **silent_blocks
    } if not re.fullmatch(READERS, FILES.get(f, "-")) and not f.startswith(PETSC_TEXT)
]
changed = {f: (plain_blocks.get(f), silent_blocks.get(f)) for f in kept if plain_blocks.get(f) != silent_blocks.get(f)}
check.holds("keys of effects that are off: the same log events", silent_events == plain_events,
            str(set(silent_events.items()) ^ set(plain_events.items())))
check.holds(f"the same allocations, {len(kept)} functions", not changed, str(changed))
check.holds("the same bits in results.h5",
            contents(silent.directory / "results.h5") == contents(plain.directory / "results.h5"))
rows = [[{
    name: value
    for name, value in row.items()
    if name != "wall_s"
}
         for row in r.steps()]
        for r in (plain, silent)]
check.holds("the same steps.csv", rows[0] == rows[1])
check.holds("the same probes", plain.summary()["probes"] == silent.summary()["probes"])
check.finish()
