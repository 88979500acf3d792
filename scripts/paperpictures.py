"""Pictures that correspond to the paper's figures 1 to 5, from meshes, states and tables; each function returns a
matplotlib figure."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy
from matplotlib.collections import PolyCollection
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

EDGES = {"edgecolors": (0, 0, 0, 0.35), "linewidths": 0.3}


def deformed(mesh, state):
    """Coordinates and the colour of each face: of a state (t, displacement, von Mises stress), or of the mesh as it was
    made."""
    nodes, faces = mesh
    if state is None:
        return nodes, faces, ["lightsteelblue"] * len(faces), None
    _, displacement, stress = state
    return nodes + displacement, faces, plt.cm.viridis(
        stress[faces].mean(axis=1) / stress.max()), plt.cm.ScalarMappable(plt.Normalize(0, stress.max()), "viridis")


def solid(x, faces, colours):
    """Axes with faces in space, y upwards."""
    figure = plt.figure(figsize=(9, 6))
    axes = figure.add_subplot(projection="3d")
    axes.add_collection3d(Poly3DCollection(x[faces][:, :, [0, 2, 1]], facecolors=colours, **EDGES))
    lower, upper = x.min(axis=0)[[0, 2, 1]], x.max(axis=0)[[0, 2, 1]]
    axes.set(xlim=(lower[0], upper[0]), ylim=(lower[1], upper[1]), zlim=(lower[2], upper[2]), xlabel="x (mm)",
             ylabel="z (mm)", zlabel="y (mm)")
    axes.set_box_aspect(upper - lower)
    axes.view_init(elev=18, azim=-65)
    return figure, axes


def stress_bar(figure, axes, bar, **place):
    if bar is not None:
        figure.colorbar(bar, ax=axes, label="von Mises stress (MPa)", **place)


def pipe(mesh, state):
    """Figure 1: the pinched pipe, (a) as meshed, (b) deformed."""
    x, faces, colours, bar = deformed(mesh, state)
    figure, axes = solid(x, faces, colours)
    axes.set_title("Fig. 1(a) finite element model" if state is
                   None else f"Fig. 1(b) deformed configuration, t = {state[0]:g}")
    stress_bar(figure, axes, bar, shrink=0.6, pad=0.1)
    return figure


def plate_geometry():
    """Figure 2(a): plate, embedded face S_e, loaded face S_p and cylinder, as chosen where the paper's figure would
    have told."""
    figure, axes = plt.subplots(figsize=(10, 5))
    axes.add_patch(plt.Rectangle((0, 0), 70, 4, facecolor="lightsteelblue", edgecolor="k"))
    axes.add_patch(plt.Circle((50, -20), 20, facecolor="0.85", edgecolor="k"))
    axes.plot([0, 0], [-1.5, 5.5], "k", linewidth=3)
    axes.annotate("$S_e$", (0, 6), (-6, 8))
    for x in range(40, 61, 4):
        axes.annotate("", (x, 4), (x, 10), arrowprops={"arrowstyle": "->"})
    axes.plot([40, 60], [10, 10], "k")
    axes.annotate("$S_p$: P = 200 MPa, 40 to 60", (43, 11.5))
    for label, place in (("L = 70, e = 4,\nl = 20 (along z)", (5, -8)), ("E = 200 000 MPa,\nnu = 0.3", (5, -16)),
                         ("rigid cylinder, R = 20,\ntangent at x = 50", (41, -24))):
        axes.annotate(label, place)
    axes.set(xlim=(-8, 78), ylim=(-42, 16), aspect="equal", xlabel="x (mm)", ylabel="y (mm)",
             title="Fig. 2(a) geometry")
    return figure


def plate(mesh, state):
    """Figure 2(b): the mesh on the cylinder, deformed."""
    x, faces, colours, bar = deformed(mesh, state)
    figure, axes = solid(x, faces, colours)
    angle, z = numpy.meshgrid(numpy.linspace(0.25 * numpy.pi, 0.75 * numpy.pi, 60), [-1, 21])
    axes.plot_surface(50 + 20 * numpy.cos(angle), z, -20 + 20 * numpy.sin(angle), color="0.8", alpha=0.6, linewidth=0)
    axes.set(xlim=(0, 72), ylim=(-1, 21), zlim=(-8, 5),
             title=f"Fig. 2(b) finite element model, P = {200 * state[0]:g} MPa")
    axes.set_box_aspect((72, 22, 13))
    stress_bar(figure, axes, bar, shrink=0.6, pad=0.1)
    return figure


def penalties(cases, window, title):
    """Figure 3: penalty and penetration of the node that carries the largest force over the pressure, crosses:
    penalties with which a step failed. cases: label -> rows with P, penalty, penetration, and where steps failed scale,
    tried."""
    figure, (above, below) = plt.subplots(2, 1, figsize=(8, 8), sharex=True)
    for place, (label, rows) in enumerate(cases.items()):
        style = {
            "marker": "os^Dv<>*"[place % 8],
            "markersize": 5,
            "label": label,
            "linestyle": "-" if place % 2 else "--"
        }
        above.semilogy([row["P"] for row in rows], [row["penalty"] for row in rows], **style)
        below.semilogy([row["P"] for row in rows], [row["penetration"] for row in rows], **style)
        tried = [(row["P"], row["penalty"] * factor / row["scale"]) for row in rows for factor in row.get("tried", ())]
        above.semilogy([P for P, _ in tried], [eps for _, eps in tried], "kx", markersize=8)
    below.axhspan(*window, color="0.85", label="window")
    above.set(ylabel="penalty (N/mm per mm$^2$)", title="Fig. 3" + title)
    below.set(xlabel="P (MPa)", ylabel="penetration (mm)")
    below.legend(fontsize=8, loc="upper left", bbox_to_anchor=(1.01, 1))
    for axes in (above, below):
        axes.grid(alpha=0.3)
    return figure


def cup(mesh, state):
    """Figure 4: the spherical cup's section over the plane, (a) as meshed, (b) deformed."""
    x, faces, colours, bar = deformed(mesh, state)
    figure, axes = plt.subplots(figsize=(9, 4.5))
    axes.add_collection(PolyCollection(x[faces][:, :, :2], facecolors=colours, **EDGES))
    axes.axhline(-101.2, color="k")
    axes.axvline(0, color="k", linestyle="-.", linewidth=0.6)
    title = "Fig. 4(a) finite element model"
    if state is not None:
        title = f"Fig. 4(b) deformed configuration, P = {200 * state[0]:g} MPa"
    axes.set(xlim=(-2, 76), ylim=(-104, -66), aspect="equal", xlabel="r (mm)", ylabel="z (mm)", title=title)
    stress_bar(figure, axes, bar, shrink=0.7)
    return figure


def load_steps(rows):
    """Figure 5: the load step over the load. rows: order, label, P, dP, ..."""
    figure, axes = plt.subplots(figsize=(8, 5))
    for place, (order, label) in enumerate(dict.fromkeys((row[0], row[1]) for row in rows)):
        own = [row for row in rows if (row[0], row[1]) == (order, label)]
        if label != "single step":
            axes.plot([row[2] for row in own], [row[3] for row in own], marker="os^Dv<>*"[place % 8],
                      label=f"order {order}, {label}: {len(own)} steps")
    axes.ticklabel_format(useOffset=False)
    axes.set(xlabel="P (MPa)", ylabel="load step (MPa)", title="Fig. 5 evolution of the load step")
    axes.grid(alpha=0.3)
    axes.legend()
    return figure
