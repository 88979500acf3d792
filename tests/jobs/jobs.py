"""The ordinary jobs as data: what is run, and what must come of it. Each is NAME.geo and NAME.yaml beside this file, as
a user would write them: the scenes have no keys of the numerics. Each geometry has a parameter `refine` that divides
all its element sizes; at 1 it is the mesh of the job."""
from dataclasses import dataclass, field


@dataclass
class Answer:
    """A probe at the end of the run and its reference."""
    probe: str
    reference: float
    error: float  # of the reference, per cent
    source: str  # closed form, CalculiX, or limit: Richardson's of refined meshes and a stiff penalty
    tolerance: float = 2.0  # per cent


@dataclass
class Job:
    name: str
    what: str
    answers: list
    steps: int  # at most so many
    pairs: int = 1  # contact pairs of the scene
    shown: str = "von_mises"  # field of the picture
    picture: list = field(default_factory=list)  # options of scripts/render.py
    levels: tuple = (1, 1.5, 2.25)  # values of `refine` whose answers run.py --limit extrapolates
    stiff: list = field(default_factory=list)  # overrides of those runs
    ranks: float = 1e-6  # by how much answers may depend on the number of ranks, of themselves


FAILED = 0.1  # largest part of the attempted steps that may fail

JOBS = [
    # Rubber
    Job("lip_seal", "lip seal on a shaft", [
        Answer("radial_force", 36.575, 0.01, "limit"),
        Answer("lip_up", 0.46007, 0.02, "limit"),
    ], steps=12),
    Job("seal_leak", "gasket pressed by oil until it leaks", [
        Answer("tight_to", 2.602, 0.1, "limit"),
    ], steps=14),
    Job("wheel_on_edge", "rubber wheel on an edge", [
        Answer("down", 36.44, 0.02, "limit"),
        Answer("sideways", 5.161, 0.1, "limit"),
    ], steps=12),
    Job("rollers_in_nip", "rubber-covered rollers in a nip", [
        Answer("force", 5.578, 0.02, "limit"),
        Answer("half_width", 7.843, 0.1, "limit"),
        Answer("peak_pressure", 0.9326, 0.05, "limit"),
    ], steps=12, picture=["--mirror", "x"]),
    Job("tube_on_barb", "tube pushed over a barbed nipple", [
        Answer("grip", 60.8, 0.3, "limit"),
    ], steps=50, picture=["--mirror", "x"]),
    Job("bush_turned", "bush turned and pushed", [
        Answer("force_x", -20.11, 0.07, "limit"),
        Answer("force_y", -31.23, 0.04, "limit"),
    ], steps=15, pairs=2, stiff=["contact.1.smoother=facet"]),
    Job("boot_on_mandrel", "boot closed onto a mandrel", [
        Answer("radial_force", 47.55, 0.3, "limit"),
        Answer("push", 39.62, 0.05, "limit"),
    ], steps=12, picture=["--mirror", "x"]),
    # Rubber that keeps its volume
    Job("bush_bonded", "bush bonded to pin and sleeve, pushed sideways", [
        Answer("force", 310.08, 0.01, "limit"),
    ], steps=12, pairs=0),
    Job("tube_pinched", "rubber tube pinched to half of its height", [
        Answer("force", 0.28832, 0.01, "limit"),
    ], steps=12, picture=["--mirror", "x"]),
    Job("tube_flattened", "rubber tube flattened until it touches itself", [
        Answer("force", 12.545, 0.13, "limit"),
    ], steps=12, pairs=3, picture=["--mirror", "x"], stiff=["contact.2.formulation=node_to_surface"]),
    Job("hose_squeezed", "hose squeezed flat until its inside creases", [
        Answer("force", 6.904, 0.4, "limit"),
    ], steps=12, pairs=3, picture=["--mirror", "x"], stiff=["contact.2.formulation=node_to_surface"]),
    Job("hose_creased", "the same hose in few elements of second order", [
        Answer("force", 6.904, 0.4, "limit"),
    ], steps=16, pairs=3, picture=["--mirror", "x"]),
    Job("stacked_rings", "three loose rings pressed on each other", [
        Answer("push", 0.51247, 0.1, "limit"),
        Answer("foot", 0.51247, 0.1, "limit"),
    ], steps=12, pairs=11),
    Job("ball_squashed", "rubber ball squashed by 30 %", [
        Answer("force", 83.935, 0.05, "limit"),
    ], steps=12, picture=["--mirror", "x"]),
    Job("plunger", "plunger's head pushed into a syringe", [
        Answer("push", 12.865, 0.7, "limit"),
        Answer("grip", 64.386, 0.7, "limit"),
    ], steps=12, picture=["--mirror", "x"]),
    Job("x_ring", "X-ring in a groove under a lid", [
        Answer("force", 239.11, 0.1, "limit"),
    ], steps=10, pairs=2),
    Job("d_ring", "D-ring in a groove, pressed by a fluid", [
        Answer("tight_to", 7.766, 0.2, "limit"),
        Answer("top", 0.3279, 1.2, "limit"),
    ], steps=14, pairs=2),
    Job("u_cup", "U-cup between rod and bore, pressed by oil", [
        Answer("floor", -0.23298, 0.08, "limit"),
    ], steps=14, pairs=3),
    Job("buffer_rough", "buffer with a hole between rough plates", [
        Answer("force", 863.8, 0.42, "limit"),
    ], steps=10, pairs=2, picture=["--mirror", "x"]),
    Job("mount_turned", "bonded mount turned and pushed aside, in space", [
        Answer("side", 482.0, 0.3, "limit"),
    ], steps=10, pairs=0, levels=(1, 1.33, 1.67)),
    Job("keypad_pressed", "key of a keypad snapped through onto its board", [
        Answer("force", 10.02, 0.73, "limit"),
    ], steps=12, pairs=2, picture=["--mirror", "x"], levels=(1.69, 2.25, 3)),
    Job("dovetail_ring", "square seal in a dovetail groove", [
        Answer("force", 13.400, 0.14, "limit"),
    ], steps=12, pairs=2),
    Job("band_drawn", "rubber band drawn out by two pins, in space", [
        Answer("pull", 4.0585, 0.03, "limit"),
    ], steps=10, levels=(1, 1.33, 1.67)),
    Job("diaphragm", "diaphragm bulged onto a plate and into its hole", [
        Answer("held", 730.4, 1, "limit"),
        Answer("bulge", 6.917, 1, "limit"),
    ], steps=14, picture=["--mirror", "x"]),
    # Balls
    Job("ball_in_cone", "ball in a cone by force", [
        Answer("peak_pressure", 83.00, 0.1, "limit"),  # Hertz, for a ring of infinite radius: 84.42
        Answer("ball_down", -0.03191, 0.1, "CalculiX"),
    ], steps=12, picture=["--mirror", "x"]),
    # Its limit is of a quarter, whose spin is held, and which starts with an overlap of 0.005: the ball goes down by
    # 0.025 sqrt(2) less.
    Job("ball_in_vee", "ball in a vee groove", [
        Answer("peak_pressure", 154.9, 1.1, "limit"),
        Answer("ball_down", -0.08347, 0.1, "limit"),
    ], steps=15, picture=["--view=160,15"], levels=(1, 1.4, 1.96), stiff=[
        "mesh.parameters={quarter: 1, gap: -0.005}", "contact.0.initial_overlap=resolve",
        "contact.0.symmetry=[symmetry, side]",
        "supports=[{surface: symmetry, uz: 0}, {surface: side, ux: 0}, {surface: groove_bottom, ux: 0, uy: 0, uz: 0}]"
    ]),
    # Tips on the axis and on planes of symmetry
    Job("cone_pressed", "blunt cone pressed into rubber", [
        Answer("force", 24.095, 0.1, "Sneddon"),
    ], steps=8, picture=["--mirror", "x"]),
    Job("cone_dent", "diamond cone pressed into steel", [
        Answer("force", 440.0, 1, "limit"),
    ], steps=45, picture=["--mirror", "x"]),
    Job("wedge_pressed", "half of a wedge pressed into rubber", [
        Answer("force", 0.8027, 0.7, "limit"),
    ], steps=8, picture=["--mirror", "x"]),
    Job("pyramid_quarter", "quarter of a pyramid pressed into rubber", [
        Answer("force", 13.176, 0.1, "limit"),
    ], steps=8),
    # Machine parts
    Job("three_spheres", "three rubber balls in a column", [
        Answer("peak_south", 0.7953, 0.1, "limit"),
        Answer("peak_north", 0.7953, 0.1, "limit"),  # Hertz, small strain: 0.7983
    ], steps=10, pairs=2, picture=["--mirror", "x"]),
    Job("pin_lug", "pin in a lug by force", [
        Answer("pin_rise", 0.11317, 0.2, "CalculiX"),
        Answer("head", 0.05555, 0.2, "CalculiX"),
        Answer("waist", -0.014086, 0.3, "CalculiX"),
    ], steps=10, picture=["--mirror", "x"]),
    Job("shrink_fit", "hub shrunk on a shaft, 0.1 %", [
        Answer("pressure", 75.72, 0.1, "Lame"),
        Answer("peak", 75.72, 0.1, "Lame"),
        Answer("rim", 0.010938, 0.1, "Lame"),
    ], steps=10, picture=["--mirror", "xy"]),
    Job("belleville", "disc spring flattened", [
        Answer("force", 6970, 0.3, "limit"),
    ], steps=10, pairs=2, picture=["--mirror", "x"]),
    Job("snap_hook", "snap hook over a catch", [
        Answer("lift", 0.2765, 0.3, "limit"),
        Answer("tip", -0.4018, 0.2, "limit"),
    ], steps=25),
    Job("pipe_joint", "gasket between flanges, with oil between them", [
        Answer("seat_force", 45986, 0.6, "limit"),  # the front stands at nodes: the answers of 2.25 and 3.4 differ by it
        Answer("bulge", 0.20745, 0.35, "limit"),
    ], steps=9, levels=(1.5, 2.25, 3.4)),
    Job("flange_gasket", "flange on a soft gasket", [
        Answer("rim", -0.13223, 0.1, "CalculiX"),
        Answer("inner_edge", 0.06433, 0.1, "CalculiX"),
    ], steps=10),
    Job("tyre_kerb", "tyre section on a kerb", [
        Answer("force", 127.3, 0.3, "limit"),
        Answer("side_force", -10.51, 0.1, "limit"),
        Answer("peak", 4.365, 0.4, "limit"),
    ], steps=10),
    Job("crossed_cylinders", "crossed cylinders by force", [
        Answer("peak", 113.7, 0.5, "Hertz"),
        Answer("radius", 1.0, 0.5, "Hertz"),
    ], steps=10),
    # Large sliding
    Job("ironing", "tool drawn over a slab", [
        Answer("fy", -64.63, 0.03, "limit"),
    ], steps=40),
    Job("two_arches", "arch drawn over an arch", [
        Answer("fy", -13.811, 0.16, "limit"),
        Answer("fx", -2.919, 0.08, "limit"),
    ], steps=20),
    # Seals, gears and rollers
    Job("o_ring", "O-ring in a groove under a lid", [
        Answer("force", 537.89, 0.1, "limit"),
        Answer("peak", 1.9612, 0.1, "limit"),
    ], steps=10, pairs=2),
    Job("gear_teeth", "two gear teeth by a turn", [
        Answer("peak", 1424.9, 1.0, "Hertz"),
    ], steps=8),
    Job("roller_plates", "roller between plates by force", [
        Answer("peak_low", 1714.1, 0.1, "Hertz"),
        Answer("half_width", 0.2971, 0.1, "Hertz"),
    ], steps=10, pairs=2, picture=["--mirror", "x"]),
    Job("door_seal", "hollow door seal under a blade", [
        Answer("force", 0.13719, 0.1, "limit"),
        Answer("sideways", -0.09268, 0.1, "limit"),
    ], steps=20),
    Job("wheel_rail", "crowned wheel on a rail by force", [
        Answer("peak", 796.2, 0.5, "Hertz"),
    ], steps=8),
    # Stacks, rings and clamps
    Job("leaf_spring", "three leaves of a spring by force", [
        Answer("down", -5.65, 0.53, "limit"),
    ], steps=12, pairs=2, levels=(1, 1.4, 1.96)),
    Job("piston_ring", "piston ring under gas pressure", [
        Answer("on_wall", 2100.5, 0.01, "limit"),
        Answer("on_land", -3194.6, 0.01, "limit"),
    ], steps=10, pairs=2),
    Job("hose_clamp", "band clamp tightened around a hose", [
        Answer("pull", -18.017, 0.3, "limit"),
    ], steps=12, pairs=2, picture=["--mirror", "x"]),
    Job("lip_inverted", "wiper lip turned inside out", [
        Answer("radial", -12.044, 0.8, "limit"),
        Answer("tip", 7.828, 0.08, "limit"),
    ], steps=12, picture=["--mirror", "x"]),
    Job("plug_orifice", "plug pushed into an orifice", [
        Answer("radial", 90.89, 0.2, "limit"),
    ], steps=14, picture=["--mirror", "x"]),
    # Contact without naming pairs
    Job("comb_fingers", "two combs of leaves pushed against each other", [
        Answer("side_force", 53.399, 0.59, "limit"),
    ], steps=8),
    Job("serpentine_spring", "serpentine spring closed until its arms touch", [
        Answer("force", 68.07, 0.34, "limit"),
    ], steps=8),
    Job("washers_in_series", "spring washers in series pressed nearly flat", [
        Answer("force", 750.6, 0.36, "limit"),
    ], steps=8, pairs=3, levels=(2.25, 3.375, 5.0625)),
    # A tool of few faces
    Job("punch_extruded", "punch extruded in one layer, pressed into a block", [
        Answer("force", 5257.4, 0.04, "limit"),
    ], steps=8),
    # Friction
    Job("band_over_pins", "rubber band drawn over two pins", [
        Answer("pull", 5.052, 0.05, "limit"),
    ], steps=12, pairs=2, levels=(1, 1.25, 1.5)),
    Job("strip_in_rollers", "rubber strip drawn between rollers", [
        Answer("pull", 5.33, 0.8, "limit"),  # it varies by that as nodes come and go
    ], steps=15, pairs=2, stiff=["contact.*.formulation=node_to_surface"]),
    Job("belt_on_pulley", "belt pulled over a pulley, with a weight", [
        Answer("pull", -3.8368, 0.03, "limit"),
        Answer("torque", 46.88, 0.03, "limit"),
    ], steps=15),
    Job("wedge_in_slot", "wedge pressed into a slot and left there", [
        Answer("apart", 0.1492, 0.5, "limit"),
    ], steps=12),
    Job("rope_on_bollard", "rope pulled over a bollard, mu 0.8", [
        Answer("pull", -16.612, 0.02, "limit"),
        Answer("torque", 311.2, 0.03, "limit"),
    ], steps=12),
    Job("shaft_pressed", "shaft pressed into a hub", [
        Answer("push", -28056, 0.6, "limit"),
    ], steps=10, picture=["--mirror", "x"]),
    Job("clip_on_rod", "clip pushed over a rod and pulled back", [
        Answer("push", 2.098, 2.1, "limit"),  # it varies by that with the mesh
    ], steps=12),
    Job("brake_band", "brake band around a drum that turns", [
        Answer("torque", 1658.7, 0.02, "limit"),
    ], steps=10, stiff=["contact.0.penalty={scale: 100}"]),
    Job("cork", "cork pushed into the neck of a bottle", [
        Answer("push", 185.1, 1, "limit"),  # it varies by that with the mesh
    ], steps=12, picture=["--mirror", "x"]),
    Job("brake_block", "brake block on a drum that turns", [
        Answer("torque", -7178.4, 0.05, "limit"),
    ], steps=12),
    Job("brake_shoe", "brake shoe with a lining on a drum that turns", [
        Answer("torque", -17402.9, 0.001, "limit"),
    ], steps=10),
    Job("sheet_over_edge", "rubber sheet drawn around the edge of a table", [
        Answer("pull", 1.877, 0.1, "limit"),
    ], steps=14, stiff=["contact.0.penalty={scale: 30}"]),
    Job("wedge_clamp", "wedge driven between two clamped blocks, in space", [
        Answer("push", 1092.13, 0.2, "closed form"),
    ], steps=10),
    Job("cone_clutch", "ring pressed on a cone that turns, in space", [
        Answer("torque", -561830, 0.5, "closed form"),
    ], steps=12),
    Job("wedge_lock", "wedge driven in, let go and pulled", [
        Answer("grip", 1979, 0.05, "limit"),
        Answer("hold", 228, 0.3, "limit"),
    ], steps=14, pairs=2),
    Job("vee_jaws", "rod drawn out of two jaws with vees, in space", [
        Answer("pull", 381.84, 0.2, "closed form"),
    ], steps=14),
    Job("pin_in_hole", "pin with play in a coarse plate, in space", [
        Answer("down", 4000, 0.001, "closed form"),
        Answer("aside", 1500, 0.001, "closed form"),
    ], steps=10),
    Job("journal", "journal with play in a bush by force", [
        Answer("drop", 0.05838, 0.02, "limit"),
        Answer("down", 2000, 0.001, "closed form"),
        Answer("aside", 1000, 0.001, "closed form"),
    ], steps=10),
    Job("bolt_thread", "five turns of a bolt's thread in their nut", [
        Answer("pulled_out", -0.04551, 0.14, "limit"),
        Answer("widened", 0.003235, 0.5, "limit"),
    ], steps=10),
    Job("blocks_pushed", "upper one of two loose blocks pushed off", [
        Answer("push", 2.0, 0.01, "closed form"),
    ], steps=12),
    Job("wedge_brake", "shoe between a slope and a rail that moves", [
        Answer("brake", 149.776, 0.05, "closed form"),
    ], steps=10, pairs=2),
    Job("taper_pin", "taper pin driven in and pulled", [
        Answer("pull", 5142.6, 0.1, "limit"),
    ], steps=10),
    Job("disc_brake", "pad on a brake disc that turns, in space", [
        Answer("torque", -61994, 0.1, "closed form"),
    ], steps=10),
    Job("gasket_bead", "beads of a gasket between rough flanges", [
        Answer("force", 2.5112, 0.02, "limit"),
    ], steps=12, pairs=2),
    Job("disc_blown", "rubber disc blown into a mould", [
        Answer("pole", 12.7998, 0.01, "limit"),
        Answer("push", -722.1, 0.12, "limit"),
    ], steps=12, picture=["--mirror", "x"]),
    Job("foam_ball", "rough ball pressed into foam, in space", [
        Answer("force", 10.27, 0.2, "limit"),
    ], steps=12),
    Job("cam_follower", "cam lifts a follower", [
        Answer("lift", 3.344, 0.06, "limit"),
        Answer("torque", -161.8, 0.05, "limit"),
    ], steps=14),
    # Steel that yields
    Job("autofrettage", "hollow ball yields under pressure and is released", [
        Answer("grown", 0.00220375, 0.001, "Hill"),
    ], steps=10, pairs=0, picture=["--mirror", "x"]),
    Job("ball_dent", "ball pressed into steel by force and lifted", [
        Answer("dent", -0.1560, 0.6, "limit"),
    ], steps=20, picture=["--mirror", "x"]),
    Job("bulge", "sheet blown against a die and released", [
        Answer("height", 7.719, 0.1, "limit"),
    ], steps=25, picture=["--mirror", "x"]),
    Job("ferrule", "ferrule crimped onto a rod and released", [
        Answer("crimp", -0.25909, 0.02, "limit"),
        Answer("pressure", 34.376, 0.3, "limit"),
    ], steps=12, picture=["--mirror", "x"]),
    Job("vee_bracket", "strip in a vee die, punch comes and leaves", [
        Answer("end_x", -4.904, 0.21, "limit"),
        Answer("end_y", 3.6454, 0.15, "limit"),
    ], steps=30, pairs=2, picture=["--mirror", "x"]),
    Job("coin", "disc coined in a collar", [
        Answer("relief", 0.12704, 0.16, "limit"),
    ], steps=35, pairs=3, picture=["--mirror", "x"], stiff=["stepping.dt_max=0.04"]),
    Job("die_pressed", "plate pressed by a flat die with rounded edges", [
        Answer("force", 717.1, 0.1, "limit"),
    ], steps=20, pairs=2, picture=["--mirror", "x"], levels=(2, 3, 4.5), stiff=["stepping.dt_max=0.04"]),
    Job("bead_pressed", "bead pressed into a strip over a groove", [
        Answer("draw", -5.444, 0.05, "limit"),
    ], steps=25, pairs=2, picture=["--mirror", "x"], stiff=["mesh.order=1", "stepping.dt_max=0.02"]),
    Job("plate_bent", "plate with a hole bent over rolls and released", [
        Answer("end_z", 1.066, 0.2, "limit"),
    ], steps=12, pairs=2, stiff=["stepping.plastic_strain=0.03"]),
    Job("pipe_flared", "pipe end flared on a cone", [
        Answer("rim", 3.940, 0.07, "limit"),
    ], steps=35, picture=["--mirror", "x"], stiff=["stepping.dt_max=0.02"]),
    Job("hole_expanded", "hole in a sheet expanded by a cone", [
        Answer("hole", 3.111, 0.7, "limit"),
    ], steps=15, picture=["--mirror", "x"], stiff=["stepping.dt_max=0.02"]),
    Job("flange_wiped", "flange wiped at an aluminium sheet, with friction", [
        Answer("end_x", -14.253, 0.1, "limit"),
        Answer("end_y", -14.840, 0.06, "limit"),
    ], steps=40, pairs=2, levels=(1, 1.33, 1.77), stiff=["stepping.dt_max=0.03"]),
    Job("rivet", "rivet headed by force and let go", [
        Answer("height", -1.738, 1, "limit"),
    ], steps=30, pairs=2, picture=["--mirror", "x"], levels=(0.5, 0.75, 1.125)),
    Job("hem", "flange folded over as before hemming", [
        Answer("tip_x", -4.1137, 0.04, "limit"),
    ], steps=20, pairs=2, stiff=["contact.0.initial_overlap=resolve", "stepping.dt_max=0.04"]),
    # Sixteen faces around the wire have 95 % of its stiffness in torsion.
    Job("coil_spring", "coil spring whose coils come together", [Answer("force", 457.4, 1, "limit", tolerance=4)],
        steps=12, levels=(1, 1.5, 2)),
    Job("circlip", "circlip closing on its groove with friction", [
        Answer("spread", 224.101, 0.01, "limit"),
        Answer("opening", 1.65514, 0.1, "limit"),
    ], steps=12),
    Job("tyre_road", "tyre blown up and pressed on the road", [
        Answer("load", 18.175, 0.8, "limit"),
        Answer("bulge", 1.9238, 0.15, "limit"),
    ], steps=12, levels=(1, 1.5, 2)),
    Job("c_ring", "metal C-ring squeezed and pressed from inside", [Answer("seat", 42443, 0.3, "limit")], steps=20, pairs=3,
        stiff=["stepping.dt_max=0.04"]),
    Job("wire_bent", "wire bent about a pin and let go", [
        Answer("end_x", -37.93, 0.2, "limit"),
        Answer("end_y", -54.02, 0.1, "limit"),
    ], steps=50, pairs=2, stiff=["stepping.dt_max=0.015"], levels=(1, 1.5, 2)),
    # Rubber and plastic with friction
    Job("ball_hollow", "hollow rubber ball pressed between plates", [
        Answer("force", 130.736, 0.02, "limit"),
        Answer("bulge", 3.60036, 0.02, "limit"),
    ], steps=12, picture=["--mirror", "x"]),
    Job("clip_snapped", "rod snapped into a plastic clip", [
        Answer("tip_x", 0.754905, 0.08, "limit"),
    ], steps=12, picture=["--mirror", "x"]),
    Job("packer", "packer set between mandrel and casing", [
        Answer("grip", 4667, 2.6, "limit"),  # it varies by that with the mesh
        Answer("set", 7985.5, 0.26, "limit"),
    ], steps=12, pairs=2, picture=["--mirror", "x"]),
    Job("wave_spring", "wave spring pressed flat", [Answer("force", 42.034, 0.01, "limit")], steps=12, pairs=2),
    Job("sheet_in_nip", "sheet pulled through a nip", [
        Answer("pull", 4.36, 0.05, "limit"),
        Answer("nip", 10.73, 0.01, "limit"),
    ], steps=20, pairs=2),
    Job("roller_on_pad", "roller on a bonded pad", [
        Answer("force", 20.18, 0.02, "limit"),
    ], steps=12, stiff=["stepping.dt_max=0.05", "contact.0.friction.stick={slip: 0.001}"]),
    Job("bottle_cap", "cap snapped over a neck", [Answer("force", 198.1, 0.05, "limit")], steps=8,
        picture=["--mirror", "x"]),
    Job("suction_cup", "suction cup on a pane", [Answer("pull", 3.3407, 0.06, "limit")], steps=12,
        picture=["--mirror", "x"]),
    Job("valve_disc", "rubber disc of a valve on its seat", [
        Answer("seat", -282.2, 0.04, "limit"),
        Answer("centre", -5.8175, 0.01, "limit"),
    ], steps=12, picture=["--mirror", "x"]),
    # Friction on rubber, and springback
    Job("quad_ring", "quad ring squeezed in its groove", [Answer("force", 41.684, 0.03, "limit")], steps=12, pairs=2,
        stiff=["contact.*.friction.stick.slip=0.001"]),
    # Its meshes have no order: the reference is the finest one
    Job("stud_sheared", "rubber stud pressed and sheared to and fro", [
        Answer("press", 133.2, 0.6, "limit"),
        Answer("shear", 40.5, 0.8, "limit"),
    ], steps=16, levels=(1, 1.4, 1.96), stiff=["contact.*.friction.stick.slip=0.001"], picture=["--mirror", "y"]),
    Job("vee_bend", "sheet bent in a die, with springback", [Answer("end", -3.26, 0.7, "limit")], steps=20, pairs=2,
        stiff=["contact.*.friction.stick.slip=0.001"], picture=["--mirror", "x"]),
    Job("springs_nested", "two disc springs in one another, with friction", [
        Answer("force", 1357.6, 0.62, "limit"),
        Answer("spread", 0.06136, 0.27, "limit"),
    ], steps=12, stiff=["contact.*.friction.stick.slip=0.001"], picture=["--mirror", "x"]),
    # Bodies that lie flush on each other, and no pairs named
    Job("keystone", "stone flush between two walls, no pairs named", [Answer("thrust", 86.212, 0.01, "limit")], steps=12),
    # Square edges; the stamp's own faces are coarse for them
    Job("stamp_on_pad", "steel stamp pressed into a rubber pad", [
        Answer("force", 25.85, 0.4, "limit", tolerance=3.0),
    ], steps=12),
    Job("tube_in_box", "rubber tube blown up in a box", [Answer("corner", 4.1137, 0.06, "limit")], steps=12),
    Job("ball_joint", "ball stud pressed into a plastic socket", [
        Answer("force", 1138.7, 0.82, "limit"),
        Answer("bead", 0.2889, 0.13, "limit"),
    ], steps=8, stiff=["contact.*.friction.stick.slip=0.001"], picture=["--mirror", "x"]),
]
