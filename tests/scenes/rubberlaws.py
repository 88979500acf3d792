"""Closed forms of the laws of rubber, for the tests that compare with them."""
import math

# The constants of each law in the scene, and the closed forms below are for these constants
LAWS = {
    "neo_hookean": "mu: 1", "isochoric_neo_hookean": "mu: 1", "mooney_rivlin": "c10: 0.45, c01: 0.05",
    "yeoh": "c10: 0.5, c20: -0.01, c30: 0.002", "ogden": "terms: [[1.3, 1.3], [0.01, 5], [-0.13, -2]]",
    "arruda_boyce": "mu: 0.9, lambda_m: 3"
}
SERIES = (1 / 2, 1 / 20, 11 / 1050, 19 / 7000, 519 / 673750)


def principal(law, stretch, bulk):
    """Kirchhoff's principal stresses, written with the stretches of the part that keeps the volume."""
    J = math.prod(stretch)
    if law == "neo_hookean":  # lambda = K - 2/3 mu
        return [l**2 - 1 + (bulk - 2 / 3) * math.log(J) for l in stretch]
    l = [value / J**(1 / 3) for value in stretch]
    if law == "ogden":
        shape = [sum(mu * value**alpha for mu, alpha in ((1.3, 1.3), (0.01, 5), (-0.13, -2))) for value in l]
    else:
        one, two = sum(value**2 for value in l), sum(value**-2 for value in l)
        first, second = {
            "isochoric_neo_hookean": (0.5, 0), "mooney_rivlin": (0.45, 0.05),
            "yeoh": (0.5 - 0.02 * (one - 3) + 0.006 * (one - 3)**2, 0),
            "arruda_boyce": (0.9 * sum(c * (k + 1) * one**k / 9**k for k, c in enumerate(SERIES)), 0)
        }[law]
        shape = [2 * first * value**2 + 2 * second * (one - value**2) * value**2 for value in l]
    return [value - sum(shape) / 3 + bulk * math.log(J) for value in shape]
