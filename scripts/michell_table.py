"""Two rings, one in the other without friction, under the pressure 1e7 + 1e6 cos(2 theta) on the outer one
(runs/ring_in_ring.yaml), against the solutions of Lame and Michell: largest errors of the contact pressures at the
nodes over their mean, and of the displacements over the largest one. Runs meshes, orders and roles, leaves one record
per run and prints the table; --print tables an existing record.
    python scripts/michell_table.py [--burnish BINARY] [--jobs N] [--record FILE]"""
import h5py
import numpy

from launch import ROOT, fill_table, run_case, table_parser

SCENE = ROOT / "runs/ring_in_ring.yaml"
PAIRS = ((24, 30), (48, 60))  # elements around a quarter, inner/outer ring
SIDES = ("inner", "outer")
COLUMNS = ("order", "inner", "outer", "slave", "formulation", "status", "iterations", "pressure", "displacement")
E, NU, RADII, P_0, P_2 = 1e12, 0.3, (10.0, 20.0, 30.0), 1e7, 1e6
KAPPA, DOUBLE_MU = 3 - 4 * NU, E / (1 + NU)


def sigma_rr(r):
    """Of the stress function (A r^2 + B r^4 + C r^-2 + D) cos(2 theta), over cos(2 theta), by A to D (Barber,
    Elasticity, table 8.1)."""
    return [-2, 0, -6 / r**4, -4 / r**2]


def sigma_rt(r):
    return [2, 6 * r**2, -6 / r**4, -2 / r**2]


def u_r(r):
    """Barber, table 9.1."""
    return numpy.array([-2 * r, (KAPPA - 3) * r**3, 2 / r**3, (KAPPA + 1) / r]) / DOUBLE_MU


def u_t(r):
    return numpy.array([2 * r, (KAPPA + 3) * r**3, 2 / r**3, -(KAPPA - 1) / r]) / DOUBLE_MU


def michell():
    """A to D of both rings and the amplitude of the contact pressure."""
    a, b, c = RADII
    rows, right = numpy.zeros((9, 9)), numpy.zeros(9)
    conditions = ((0, sigma_rr(a), 0), (0, sigma_rt(a), 0), (0, sigma_rr(b), 1), (0, sigma_rt(b), 0),
                  (4, sigma_rr(b), 1), (4, sigma_rt(b), 0), (4, sigma_rr(c), 0), (4, sigma_rt(c), 0))
    for k, (ring, row, contact) in enumerate(conditions):
        rows[k, ring:ring + 4] = row
        rows[k, 8] = contact
    right[6] = -P_2
    rows[8, :4], rows[8, 4:8] = u_r(b) * DOUBLE_MU, -u_r(b) * DOUBLE_MU
    scale = numpy.abs(rows).max(axis=0)
    solution = numpy.linalg.solve(rows / scale, right) / scale
    return solution[:4], solution[4:8], solution[8]


def exact(r, theta, coefficients):
    """Displacement: that of a single ring under a uniform pressure, and Michell's."""
    a, _, c = RADII
    uniform = -(1 + NU) / E * P_0 * c**2 / (c**2 - a**2) * ((1 - 2 * NU) * r + a**2 / r)
    along = uniform + coefficients @ u_r(r) * numpy.cos(2 * theta)
    around = coefficients @ u_t(r) * numpy.sin(2 * theta)
    return numpy.array([along * numpy.cos(theta) - around * numpy.sin(theta),
                        along * numpy.sin(theta) + around * numpy.cos(theta)])


def overrides(order, inner, outer, slave, formulation):
    master = SIDES[1 - SIDES.index(slave)]
    return [
        f"mesh={{file: ../meshes/ring_in_ring.geo, order: {order}, parameters: {{n_inner: {inner}, n_outer: {outer}, "
        "interference: 0}}", f"bodies.0.material.E={E}", f"bodies.1.material.E={E}",
        f"contact.0={{name: fit, slave: {slave}_contact, master: {master}_contact, symmetry: [symmetry_x, symmetry_y], "
        f"smoother: diffuse, formulation: {formulation}}}",
        f'loads=[{{surface: rim, pressure: "{P_0} + {P_2}*cos(2*theta)"}}]'
    ]


def errors(directory):
    """Largest errors of pressures at nodes over their mean, and of displacements over the largest one."""
    ring, outer_ring, amplitude = michell()
    a, b, c = RADII
    mean = P_0 * c**2 / (c**2 - a**2) * (1 - a**2 / b**2)
    with h5py.File(directory / "results.h5", "r") as file:
        step = file["steps"][sorted(file["steps"])[-1]]
        nodes, at = file["mesh/nodes"][()], file["contact/fit/nodes"][()]
        pressure, displacement = step["contact/fit/pressure"][()], step["displacement"][()]
    r, theta = numpy.hypot(nodes[:, 0], nodes[:, 1]), numpy.arctan2(nodes[:, 1], nodes[:, 0])
    u = displacement[:, :2].T
    far = max(
        numpy.abs(u[:, inside] - exact(r[inside], theta[inside], of)).max()
        for inside, of in ((r < b * (1 - 1e-6), ring), (r > b * (1 + 1e-6), outer_ring)))
    return (numpy.abs(pressure - mean - amplitude * numpy.cos(2 * theta[at])).max() / mean,
            far / numpy.abs(displacement).max())


def solve(case, args):
    return run_case(case, COLUMNS, SCENE, overrides(*case), per_cent, args)


def per_cent(directory):
    return {name: 100 * error for name, error in zip(COLUMNS[-2:], errors(directory))}


def print_table(records):
    print("| order | elements, inner/outer | slave | formulation | error of the pressure, % "
          "| of the displacement, % |\n|" + " --- |" * 6)
    for r in records:
        print(f"| {r['order']} | {r['inner']}/{r['outer']} | {r['slave']} | {r['formulation'].replace('_', ' ')} | "
              f"{float(r['pressure']):.2f} | {float(r['displacement']):.2f} |")


def main():
    parser = table_parser(__doc__, "michell")
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time")
    cases = [(order, *pair, slave, formulation)
             for formulation in ("surface_to_surface", "node_to_surface")
             for order in (1, 2)
             for pair in PAIRS
             for slave in SIDES]
    fill_table(parser.parse_args(), COLUMNS, solve, cases, print_table)


if __name__ == "__main__":
    main()
