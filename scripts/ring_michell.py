"""Contact pressure between two rings under an outer pressure p0 + p2 cos 2 theta (runs/ring_under_pressure.yaml), without
friction, in plane strain: Lame's solution for p0 and Michell's for p2. Source: Barber, Elasticity, tables 8.1 and 9.1."""
import numpy


def stress(r):
    """sigma_rr and tau of the stress functions (r^2, r^4, r^-2, 1) cos 2 theta, over cos and sin 2 theta."""
    return (numpy.array([-2, 0, -6 * r**-4.0, -4 * r**-2.0]), numpy.array([2, 6 * r**2, -6 * r**-4.0, -2 * r**-2.0]))


def radial(r, nu):
    """2 mu u_r of the same functions, over cos 2 theta."""
    kappa = 3 - 4 * nu
    return numpy.array([-2 * r, (kappa - 3) * r**3, 2 * r**-3.0, (kappa + 1) / r])


def contact_pressure(bore, interface, rim, nu, p0, p2):
    """Mean and amplitude of the pressure at the interface of rings of one material."""
    mean = p0 * (1 - (bore / interface) ** 2) / (1 - (bore / rim) ** 2)  # Lame: as in one ring
    none, row, right = numpy.zeros(4), [], numpy.zeros(8)
    for r, inner in ((bore, True), (rim, False)):
        for part in stress(r):
            row.append(numpy.concatenate((part, none) if inner else (none, part)))
    right[2] = -p2
    normal, shear = stress(interface)
    row += [numpy.concatenate((shear, none)), numpy.concatenate((none, shear)), numpy.concatenate((normal, -normal)),
            numpy.concatenate((radial(interface, nu), -radial(interface, nu)))]
    return mean, -normal @ numpy.linalg.solve(numpy.array(row), right)[:4]
