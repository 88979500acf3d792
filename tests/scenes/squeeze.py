"""A block of distorted elements squeezed by 20 and by 50 per cent: uniformly between smooth plates, without
hourglasses, and with the force of second-order elements where its ends are held."""
import numpy

from harness import Check, arguments, run, SCENES

E, NU = 100, 0.3
LAMBDA, MU = E * NU / (1 + NU) / (1 - 2 * NU), E / 2 / (1 + NU)
SQUEEZE = {"svk": 0.2, "neo_hookean": 0.5}
HELD = 0.03  # of the force of second-order elements with the same nodes


def free_stretch(law, squeezed, dim):
    """Stretch across that leaves no stress there, by bisection."""
    low, high = 0.5, 3
    while high - low > 1e-14:
        across = (low + high) / 2
        stretch = numpy.array([across, 1 - squeezed, across if dim == 3 else 1])
        if law == "svk":
            green = (stretch**2 - 1) / 2
            stress = LAMBDA * green.sum() + 2 * MU * green[0]
        else:
            stress = MU * (across**2 - 1) + LAMBDA * numpy.log(stretch.prod())
        low, high = (low, across) if stress > 0 else (across, high)
    return low


def squeeze(law, order, formulation, held):
    overrides = [
        f"mesh.order={order}",
        f"bodies=[{{volume: block, formulation: {formulation}, material: {{law: {law}, E: {E}, nu: {NU}}}}}]"
    ]
    overrides += [
        f"geometry={args.geometry}", f"loads=[{{surface: y_max, uy: {-SQUEEZE[law]}{', ux: 0' + uz if held else ''}}}]",
        f"mesh.parameters={{{counts(order)}}}"
    ]
    low = f"[{{surface: y_min, uy: 0, ux: 0{uz}}}]" if held else \
        f"[{', '.join(f'{{surface: {a}_min, u{a}: 0}}' for a in axes)}]"
    overrides += [
        f"supports={low}", "stepping={control: fixed, initial: 0.1}",
        "probes=[{name: force, reaction: y_max, component: y}]"
    ]
    return run(args, scene, out=f"{law}_{order}_{formulation}_{held}", overrides=overrides)


def counts(order):
    return ", ".join(f"n{a}: {4 // order}" for a in axes)


args = arguments(("geometry", "of the scene", ["solid", "plane_strain"]),
                 ("formulation", "of the elements", ["enhanced", "fbar"]))
axes, uz = ("xyz", ", uz: 0") if args.geometry == "solid" else ("xy", "")
scene = SCENES / ("patch.yaml" if args.geometry == "solid" else "patch_plane.yaml")
check = Check()
for law, squeezed in SQUEEZE.items():
    finished = squeeze(law, 1, args.formulation, 0)
    fields = finished.fields()
    across = free_stretch(law, squeezed, len(axes)) - 1
    exact = numpy.stack([fields["nodes"][:, i] * (-squeezed if a == "y" else across) for i, a in enumerate(axes)],
                        axis=1)
    check.near(f"{law}: uniform", fields["displacement"][:, : len(axes)], exact, 1e-8)
    check.holds(f"{law}: no failed step", finished.summary()["steps_failed"] == 0)
    held, second = (squeeze(law, order, formulation, 1).summary()
                    for order, formulation in ((1, args.formulation), (2, "full")))
    off = held["probes"]["force"] / second["probes"]["force"] - 1
    check.holds(f"{law}: ends held",
                abs(off) < HELD, f"force {100 * off:+.2f} % off second order, allowed {100 * HELD} %")
    check.holds(f"{law}: ends held: no failed step", held["steps_failed"] == 0)
check.finish()
