"""A scene from a deck: materials, supports, loads, contact and steps of a keyword file in the words of a scene. Each
card is taken, said to be done in another way, said to be missing, or is known to ask for output alone."""
import dataclasses

import numpy

from meshfiles.deck import reading, resolve
from meshfiles.mesh import MeshError
from meshfiles.projection import put_on_surface
from meshfiles.shapes import SHAPES

AXES = "xyz"
# Cards that make the mesh, or that are read where they belong
TAKEN = {"NODE", "ELEMENT", "NSET", "ELSET", "SURFACE", "SOLID SECTION", "PART", "END PART", "ASSEMBLY", "END ASSEMBLY",
         "INSTANCE", "END INSTANCE", "MATERIAL", "ELASTIC", "HYPERELASTIC", "PLASTIC", "DENSITY", "BOUNDARY", "CLOAD",
         "DLOAD", "DSLOAD", "CONTACT PAIR", "SURFACE INTERACTION", "SURFACE BEHAVIOR", "FRICTION", "AMPLITUDE", "STEP",
         "END STEP", "STATIC", "ENDSTEP", "TIME POINTS", "CHANGE FRICTION"}
# Cards that ask for output, name things or steer another program's solver
SILENT = {"HEADING", "PREPRINT", "NODE PRINT", "NODE FILE", "NODE OUTPUT", "EL PRINT", "EL FILE", "ELEMENT OUTPUT",
          "CONTACT FILE", "CONTACT PRINT", "CONTACT OUTPUT", "OUTPUT", "RESTART", "CONTROLS", "PHYSICAL CONSTANTS",
          "SECTION PRINT", "ENERGY PRINT", "ENERGY FILE", "MONITOR", "NO PRINT", "SECTION CONTROLS", "SYSTEM"}
# Cards that have no effect unless a temperature is prescribed; velocities at the start have none on static steps
HEAT = {"EXPANSION", "INITIAL CONDITIONS", "CONDUCTIVITY", "SPECIFIC HEAT"}
STIFFEST = 1e3  # a slope above this many times E over the size of a face presses nothing out of round-off
SWITCH = 1e-3  # part of a step in which friction changes from its old value to its new one
LEAST_STEP = 1e-3  # of the load parameter, as the first step of the scene: many decks ask for tiny ones without need


@dataclasses.dataclass
class Action:
    """A prescribed value on a group, with its course over t: supports, displacements, forces, pressures, weights."""

    kind: str  # "displacement", "force", "pressure", "body_force"
    group: str
    axis: int  # of displacements and forces
    points: list  # (t, value)

    def last(self):
        return self.points[-1][1] if self.points else 0.0


def number(value):
    return f"{value:.12g}"


def name_of(text):
    """A name that YAML takes as it is."""
    return text if text.replace("_", "").replace(".", "").replace("-", "").isalnum() and not text[0].isdigit() else \
        '"' + text + '"'


class DeckScene:
    """The scene of a deck. mesh has the groups that it names."""

    def __init__(self, deck):
        self.deck, self.part = deck, deck.whole
        self.missing, self.changed = [], []
        self.axisymmetric = any(kind.startswith("CAX") for kind in self.part.types)
        self.dim = 2 if any(kind[:3] in ("CAX", "CPE", "CPS") for kind in self.part.types) else 3
        self.plane_stress = any(kind.startswith("CPS") for kind in self.part.types)
        if self.plane_stress and any(kind[:3] in ("CAX", "CPE") for kind in self.part.types):
            raise MeshError("elements of plane stress (CPS) stand beside those of another geometry; allowed: one "
                            "geometry")
        self.mesh = deck.mesh(self.dim)
        self._used = numpy.zeros(len(self.mesh.nodes), bool)  # by the elements of bodies
        for shape, cells in self.mesh.elements.items():
            if SHAPES[shape].dim == self.dim:
                self._used[cells] = True
        self.materials, self.sections, self.thicknesses = {}, [], set()
        self.interactions, self.pairs, self.amplitudes = {}, [], {}
        self.actions, self._made = {}, {}
        self.nlgeom, self.first, self.period = False, None, 1.0
        self._read()
        self._adjust()
        self.mesh.complete()
        self.mesh.merge_faces()
        self.mesh.choose_bodies([body for body, _ in self.sections])
        self.mesh.check()

    # Cards

    def _read(self):
        self.count = max(1, sum(card.name == "STEP" for card in self.deck.cards))
        self.step = -1  # before the first step
        self._material_now = self._interaction_now = None  # those that the next cards belong to
        readers = {"BOUNDARY": self._boundary, "CLOAD": self._cload, "DLOAD": self._dload, "DSLOAD": self._dsload,
                   "CONTACT PAIR": self._contact_pair, "STATIC": self._static}
        for card in self.deck.cards:
            with reading(card):
                self._read_card(card, readers)
        for kind, count in self.deck.left_out.items():
            self.missing.append(f"{count} elements of type {kind}: not available")

    def _read_card(self, card, readers):
        if card.name == "MATERIAL":
            self._material_now = self.materials.setdefault(card.parameters.get("NAME", "").upper(), {})
        elif card.name in ("ELASTIC", "HYPERELASTIC", "PLASTIC", "DENSITY"):
            self._material(self._material_now, card)
        elif card.name == "SOLID SECTION":
            self._section(card)
        elif card.name == "SURFACE INTERACTION":
            self._interaction_now = self.interactions.setdefault(card.parameters.get("NAME", "").upper(), {})
        elif card.name == "CHANGE FRICTION":
            self._interaction_now = self.interactions.setdefault(card.parameters.get("INTERACTION", "").upper(), {})
        elif card.name in ("SURFACE BEHAVIOR", "FRICTION"):
            self._behaviour(self._interaction_now, card)
        elif card.name == "AMPLITUDE":
            self._amplitude(card)
        elif card.name == "STEP":
            self.step += 1
            self.nlgeom = self.nlgeom or ("NLGEOM" in card.parameters and
                                          card.parameters["NLGEOM"].upper() != "NO")
        elif card.name in ("END STEP", "ENDSTEP"):
            self._close_step()
        elif card.name in readers:
            readers[card.name](card)
        elif card.name in HEAT and not any(card.name == "TEMPERATURE" for card in self.deck.cards):
            return
        elif card.name not in TAKEN | SILENT:
            self.missing.append(f"{card.where}: not available")

    def _material(self, material, card):
        if material is None:
            raise MeshError(f"{card.where} stands before any *MATERIAL")
        values = [[float(text) for text in line if text] for line in card.lines if any(line)]
        if len(values) > 1 and card.name in ("ELASTIC", "HYPERELASTIC", "DENSITY"):
            values = self._one_temperature(card, values)
        if card.name == "ELASTIC" and card.parameters.get("TYPE", "ISO").upper() not in ("ISO", "ISOTROPIC"):
            self.missing.append(f"{card.where}: only isotropic elasticity is available")
            values = [[1.0, 0.3]]
        material[card.name] = (card, values)

    def _one_temperature(self, card, values):
        if card.name == "HYPERELASTIC":
            return [sum(values, [])]
        self.missing.append(f"{card.where}: only the first line, properties do not depend on temperature")
        return values[:1]

    def _section(self, card):
        part = self.part
        if self.dim == 2 and not self.axisymmetric and card.lines and card.lines[0][0]:
            self.thicknesses.add(float(card.lines[0][0]))
        for name in part.sections:
            if name.split(".")[-1].upper() == card.parameters.get("ELSET", "").upper():
                entry = (name, card.parameters.get("MATERIAL", "").upper())
                if entry not in self.sections:
                    self.sections.append(entry)

    def _behaviour(self, interaction, card):
        if interaction is None:
            raise MeshError(f"{card.where} stands before any *SURFACE INTERACTION")
        values = [float(text) for line in card.lines[:1] for text in line if text]
        if card.name == "FRICTION" and self.step >= 0:
            interaction.setdefault("CHANGES", []).append((self._span()[0], values[0]))
        elif self.step < 0:  # *CHANGE SURFACE BEHAVIOR, which comes later, is named as missing
            interaction[card.name] = (card, values)

    def _amplitude(self, card):
        values = [float(text) for line in card.lines for text in line if text]
        self.amplitudes[card.parameters.get("NAME", "").upper()] = list(zip(values[::2], values[1::2]))

    def _static(self, card):
        values = [float(text) for line in card.lines[:1] for text in line if text]
        self.period = values[1] if len(values) > 1 else 1.0
        if values and self.first is None:
            self.first = values[0] / self.period

    def _contact_pair(self, card):
        for line in card.lines:
            self.pairs.append((line[0], line[1], card))

    def _adjust(self):
        """ADJUST=d of a contact pair moves slave nodes that are nearer than d onto the master, ADJUST=SET those of a
        set, without strain."""
        for slave, master, card in self.pairs:
            value = card.parameters.get("ADJUST", "")
            if not value:
                continue
            try:
                tolerance, chosen = float(value), None
            except ValueError:
                tolerance, chosen = numpy.inf, self._nodes(value, card.where)
            moved, most = put_on_surface(self.mesh, self._surface(slave), self._surface(master), tolerance, chosen)
            if moved:
                self.changed.append(f"{card.where}: ADJUST moved {moved} nodes by up to {number(most)}, in the mesh")

    # Courses over t

    def _span(self):
        return max(self.step, 0) / self.count, (max(self.step, 0) + 1) / self.count

    def _prescribe(self, kind, group, axis, value, card):
        """Sets a value at the end of this step, or from the start where no step has begun."""
        action = self.actions.setdefault((kind, group, axis), Action(kind, group, axis, [(0.0, 0.0)]))
        if self.step < 0:
            action.points = [(0.0, value)]
            return
        start, end = self._span()
        amplitude = card.parameters.get("AMPLITUDE", "").upper()
        if amplitude:
            if amplitude not in self.amplitudes:
                raise MeshError(f"{card.where}: there is no *AMPLITUDE '{card.parameters['AMPLITUDE']}'")
            points = [(start + (end - start) * t / self.period, value * factor)
                      for t, factor in self.amplitudes[amplitude] if t <= self.period * (1 + 1e-12)]
        else:
            points = [(start, action.last()), (end, value)]
        action.points = [point for point in action.points if point[0] < points[0][0] - 1e-12] + points

    def _close_step(self):
        """What this step did not change keeps its value."""
        _, end = self._span()
        for action in self.actions.values():
            if action.points[-1][0] < end - 1e-12:
                action.points.append((end, action.last()))

    # Groups

    def _nodes(self, text, where):
        numbers = [int(text)] if text.isdigit() else resolve(self.part.nsets, text, where)
        rows = [self.deck.row(node) for node in numbers if self.deck.has_row(node)]
        held = [row for row in rows if self._used[row]]
        if len(held) < len(rows):
            self.missing.append(f"{where}: '{text}' has {len(rows) - len(held)} nodes that belong to no element")
        return held

    def _point_group(self, label, rows):
        """A group of points of these nodes; the same nodes have one group."""
        key = tuple(sorted(set(rows)))
        if key not in self._made:
            taken = {group.name for group in self.mesh.groups}
            name, k = label, 1
            while name in taken:
                k += 1
                name = f"{label}_{k}"
            self.mesh.group(name, 0).add("point", self.mesh.add_elements("point", numpy.array(key)))
            self._made[key] = name
        return self._made[key]

    def _targets(self, card, width):
        """Lines of a card by what they say, so that single nodes with one value make one group."""
        found = {}
        for line in card.lines:
            line = line + [""] * (width - len(line))
            label = "nodes" if line[0].isdigit() else f"{line[0]}.nodes"
            found.setdefault((label, *line[1:width]), []).extend(self._nodes(line[0], card.where))
        return [(label, rest, rows) for (label, *rest), rows in found.items() if rows]

    # Supports and loads

    def _boundary(self, card):
        if card.parameters.get("OP", "").upper() == "NEW":
            self._reset("displacement", card)
        for label, (first, last, value), rows in self._targets(card, 4):
            if first.upper() in ("ENCASTRE", "PINNED"):
                first, last, value = "1", str(self.dim), ""
            if not first.isdigit():
                self.missing.append(f"{card.where}: '{first}' is not available")
                continue
            for dof in range(int(first), (int(last) if last else int(first)) + 1):
                if dof <= self.dim:
                    self._prescribe("displacement", self._point_group(label, rows), dof - 1, float(value or 0), card)

    def _cload(self, card):
        if card.parameters.get("OP", "").upper() == "NEW":
            self._reset("force", card)
        for label, (dof, value), rows in self._targets(card, 3):
            if not dof.isdigit() or int(dof) > self.dim:
                self.missing.append(f"{card.where}: a load on degree of freedom {dof} is not available")
                continue
            group = self._point_group(label, rows)
            self._prescribe("force", group, int(dof) - 1, float(value or 0) * len(set(rows)), card)

    def _reset(self, kind, card):
        for action in list(self.actions.values()):
            if action.kind == kind and action.last() != 0:
                self._prescribe(kind, action.group, action.axis, 0.0, card)
                if kind == "displacement":
                    self.missing.append(f"{card.where}: OP=NEW takes values back to 0, and does not let nodes go")

    def _dload(self, card):
        for line in card.lines:
            label = line[1].upper() if len(line) > 1 else ""
            if label == "GRAV":
                self._gravity(line, card)
            elif label.startswith("P") and label[1:].isdigit():
                self._face_pressure(line[0], int(label[1:]), float(line[2]), card)
            else:
                self.missing.append(f"{card.where}: a load '{label}' is not available")

    def _face_pressure(self, cells, label, value, card):
        numbers = [int(cells)] if cells.isdigit() else resolve(self.part.elsets, cells, card.where)
        key = ("pressure", cells, label)
        if key not in self._made:
            self._made[key] = f"pressure_{cells}_P{label}"
            group = self.mesh.group(self._made[key], self.dim - 1)
            self.deck.add_labelled(self.mesh, group, numbers, f"S{label}", self._made[key])
        self._prescribe("pressure", self._made[key], 0, value, card)

    def _dsload(self, card):
        for line in card.lines:
            if line[1].upper() == "P":
                self._prescribe("pressure", line[0], 0, float(line[2]), card)
            else:
                self.missing.append(f"{card.where}: a load '{line[1]}' is not available")

    def _gravity(self, line, card):
        """Weight of the bodies that the set is made of."""
        size, direction = float(line[2]), [float(text) for text in line[3:6]]
        numbers = set([int(line[0])] if line[0].isdigit() else resolve(self.part.elsets, line[0], card.where))
        for body, material in self.sections:
            cells = {n for n in resolve(self.part.elsets, body, card.where) if n in self.part.elements}
            if not cells <= numbers:
                if cells & numbers:
                    self.missing.append(f"{card.where}: a weight on a part of the body '{body}' is not available")
                continue
            density = self.materials.get(material, {}).get("DENSITY")
            if density is None:
                self.missing.append(f"{card.where}: the material of '{body}' has no density")
                continue
            for axis in range(self.dim):
                if direction[axis]:
                    self._prescribe("body_force", body, axis, density[1][0][0] * size * direction[axis], card)

    # The text

    def _formulation(self, body):
        """The elements as the deck wants them: full integration, or incompatible modes, which are enhanced strains
        here."""
        numbers = set(resolve(self.part.elsets, body, "*SOLID SECTION"))
        kinds = {kind for kind, members in self.part.types.items() if numbers.intersection(members)}
        first_order = {kind for kind in kinds if kind.rstrip("RHIMT") in ("C3D8", "CPE4", "CPS4", "CAX4")}
        if not first_order:
            return ""
        if any("R" in kind[3:] for kind in first_order):
            self.changed.append(f"body '{body}': reduced integration is not available; the formulation is chosen here")
            return ""
        if any("H" in kind[4:] for kind in first_order):
            return ", formulation: mixed"
        return ", formulation: enhanced" if any("I" in kind[4:] for kind in first_order) else ", formulation: full"

    def _law(self, name):
        """The material in the words of a scene."""
        cards = self.materials.get(name)
        if cards is None:
            raise MeshError(f"*SOLID SECTION: there is no material '{name}'")
        if "HYPERELASTIC" in cards:
            return self._rubber(*cards["HYPERELASTIC"])
        if "ELASTIC" not in cards:
            raise MeshError(f"material '{name}' has neither *ELASTIC nor *HYPERELASTIC")
        young, nu = cards["ELASTIC"][1][0][:2]
        if "PLASTIC" in cards:
            card, rows = cards["PLASTIC"]
            if card.parameters.get("HARDENING", "ISOTROPIC").upper() != "ISOTROPIC":
                self.missing.append(f"{card.where}: only isotropic hardening is taken over")
            table = [[row[1], row[0]] for row in rows]
            if len(table) == 1:
                return f"{{law: von_mises, E: {number(young)}, nu: {number(nu)}, yield: {number(table[0][1])}}}"
            pairs = ", ".join(f"[{number(a)}, {number(b)}]" for a, b in table)
            return f"{{law: von_mises, E: {number(young)}, nu: {number(nu)}, hardening: {{table: [{pairs}]}}}}"
        return f"{{law: {'svk' if self.nlgeom else 'linear'}, E: {number(young)}, nu: {number(nu)}}}"

    def _geometry(self, laws):
        """The geometry of the scene. Laws that flow or keep their volume exactly have no plane stress there."""
        if self.dim == 3 or self.axisymmetric:
            return "solid" if self.dim == 3 else "axisymmetric"
        if self.plane_stress and any("von_mises" in law or "incompressible" in law for law in laws):
            self.missing.append("plane stress of plastic and of incompressible bodies: the scene has plane strain")
            return "plane_strain"
        return "plane_stress" if self.plane_stress else "plane_strain"

    def _thickness(self):
        """The line with the thickness, which a scene has once."""
        if len(self.thicknesses) > 1:
            self.missing.append("*SOLID SECTION: bodies of different thickness; the scene has the largest one")
        return [f"thickness: {number(max(self.thicknesses))}\n"] if self.thicknesses else []

    def _rubber(self, card, values):
        """Constants of Abaqus: W of the isochoric strains plus (J - 1)^2 / D1."""
        constants, kinds = values[0], card.parameters
        terms = int(kinds.get("N", 1) or 1)

        def bulk(place):
            d = constants[place] if len(constants) > place else 0.0
            return f"K: {number(2 / d)}" if d else "incompressible: true"

        if "NEO HOOKE" in kinds:
            return f"{{law: isochoric_neo_hookean, mu: {number(2 * constants[0])}, {bulk(1)}}}"
        if "MOONEY-RIVLIN" in kinds:
            return f"{{law: mooney_rivlin, c10: {number(constants[0])}, c01: {number(constants[1])}, {bulk(2)}}}"
        if "YEOH" in kinds:
            c = [number(value) for value in constants[:3]]
            return f"{{law: yeoh, c10: {c[0]}, c20: {c[1]}, c30: {c[2]}, {bulk(3)}}}"
        if "ARRUDA-BOYCE" in kinds:
            return f"{{law: arruda_boyce, mu: {number(constants[0])}, lambda_m: {number(constants[1])}, {bulk(2)}}}"
        if "OGDEN" in kinds:  # 2 mu / alpha^2 there is mu / alpha here
            pairs = ", ".join(f"[{number(2 * constants[2 * k] / constants[2 * k + 1])}, "
                              f"{number(constants[2 * k + 1])}]" for k in range(terms))
            return f"{{law: ogden, terms: [{pairs}], {bulk(2 * terms)}}}"
        raise MeshError(f"{card.where}: this law is not available; there are NEO HOOKE, MOONEY-RIVLIN, YEOH, OGDEN and "
                        "ARRUDA-BOYCE")

    def _interaction(self, card):
        """The interaction that the card of a pair names; an empty one where there is none."""
        return self.interactions.get(card.parameters.get("INTERACTION", "").upper(), {})

    def _pair(self, k, slave, master, card):
        interaction = self._interaction(card)
        entries = [f"name: pair_{k + 1}", f"slave: {name_of(self._surface(slave))}",
                   f"master: {name_of(self._surface(master))}", "smoother: facet", *self._where_measured(card),
                   "initial_overlap: resolve"]
        behaviour, values = interaction.get("SURFACE BEHAVIOR", (None, []))
        law = (behaviour.parameters.get("PRESSURE-OVERCLOSURE", "HARD") if behaviour else "HARD").upper()
        if law == "LINEAR" and values and values[0] <= STIFFEST * self._stiffest() / self._face_size(slave):
            entries.append(f"penalty: {{initial: {number(values[0])}, scale: 1}}")
        elif law == "LINEAR":
            self.changed.append(f"{behaviour.where}: the slope is far beyond the stiffness of the bodies; here the penalty "
                                "is chosen by the error that it leaves")
        elif law == "TIED":
            self.missing.append(f"{behaviour.where}: tied contact is not available")
        elif law != "HARD":
            self.changed.append(f"{behaviour.where}: {law.lower()} pressure over the gap; here the penalty is chosen by "
                                "the error that it leaves")
        return "  - {" + ", ".join(entries + self._friction(interaction)) + "}\n"

    def _friction(self, interaction):
        """Friction of an interaction as an entry of a pair; none where it has none in any step."""
        _, values = interaction.get("FRICTION", (None, []))
        course = [(0.0, values[0] if values else 0.0)]
        for start, mu in interaction.get("CHANGES", []):
            course += [(start, course[-1][1]), (start + SWITCH / self.count, mu)] if start else [(0.0, mu)]
        most = max(mu for _, mu in course)
        if most <= 0:
            return []
        stick = f", stick: {{penalty: {number(values[1])}}}" if len(values) > 1 else ""
        points = sorted(dict([*course, (1.0, course[-1][1])]).items())
        history = "" if len(course) == 1 else \
            f", history: [{', '.join(f'[{number(t)}, {number(mu / most)}]' for t, mu in points)}]"
        return [f"friction: {{mu: {number(most)}{stick}{history}}}"]

    @staticmethod
    def _where_measured(card):
        """The word for the card's TYPE; the scene chooses where the deck does not."""
        words = {"NODE TO SURFACE": "node_to_surface", "SURFACE TO SURFACE": "surface_to_surface"}
        kind = " ".join(card.parameters.get("TYPE", "").upper().split())
        return [f"formulation: {words[kind]}"] if kind in words else []

    def _stiffest(self):
        """Largest Young's modulus of the deck's elastic materials."""
        return max((cards["ELASTIC"][1][0][0] for cards in self.materials.values() if "ELASTIC" in cards), default=0.0)

    def _face_size(self, name):
        """Mean length of the faces of a surface."""
        wanted = self._surface(name)
        group = next(group for group in self.mesh.groups if group.name == wanted and group.dim == self.dim - 1)
        spans = [numpy.ptp(self.mesh.nodes[self.mesh.elements[shape][indices]], axis=1).max(axis=1)
                 for shape, indices in group.members.items()]
        return float(numpy.concatenate(spans).mean())

    def _surface(self, name):
        for group in self.mesh.groups:
            if group.name.upper() == name.upper() and group.dim == self.dim - 1 and group.size:
                return group.name
        kinds = {key.upper(): kind for key, (kind, _) in self.part.surfaces.items()}
        if kinds.get(name.upper()) == "NODE":
            raise MeshError(f"*CONTACT PAIR: the nodes of the surface '{name}' have no outer face of a body between them; "
                            "allowed: surfaces with faces")
        raise MeshError(f"*CONTACT PAIR: there is no surface '{name}' with faces of bodies")

    def _history(self, action):
        """The largest value and the course as factors on it; None for a course that is 0."""
        largest = max((value for _, value in action.points), key=abs)
        if largest == 0:
            return 0.0, None
        points = action.points
        if points[0][0] > 0:
            points = [(0.0, 0.0), *points]
        if len(points) == 1:  # from the start, before any step: it grows in the first step
            points = [(0.0, 0.0), (1.0 / self.count, points[0][1])]
        if points[-1][0] < 1:
            points.append((1.0, points[-1][1]))
        text = ", ".join(f"[{number(t)}, {number(value / largest)}]" for t, value in points)
        return largest, None if text == "[0, 0], [1, 1]" else f"[{text}]"

    def _loads(self):
        supports, loads = [], []
        for action in self.actions.values():
            value, history = self._history(action)
            tail = f", history: {history}" if history else ""
            if action.kind == "displacement":
                key = f"u{AXES[action.axis]}: {number(value)}"
                (loads if value else supports).append(f"  - {{surface: {name_of(action.group)}, {key}{tail}}}\n")
            elif action.kind == "pressure" and value:
                loads.append(f"  - {{surface: {name_of(action.group)}, pressure: {number(value)}, "
                             f"follower: {str(self.nlgeom).lower()}{tail}}}\n")
            elif value:
                vector = ", ".join(number(value) if k == action.axis else "0" for k in range(self.dim))
                where = "volume" if action.kind == "body_force" else "surface"
                loads.append(f"  - {{{where}: {name_of(action.group)}, {action.kind}: [{vector}]{tail}}}\n")
        return supports, loads

    def _rubs(self, k):
        return bool(self._friction(self._interaction(self.pairs[k][2])))

    def _probes(self):
        lines = []
        for action in self.actions.values():
            if action.kind == "displacement" and self._history(action)[0]:
                axis = AXES[action.axis]
                label = "".join(c if c.isalnum() else "_" for c in action.group)
                lines.append(f"  - {{name: reaction_{label}_{axis}, reaction: {name_of(action.group)}, "
                             f"component: {axis}}}\n")
        for k in range(len(self.pairs)):
            kinds = ("contact", "friction") if self._rubs(k) else ("contact", )
            lines += [f"  - {{name: {kind}_{k + 1}_{axis}, {kind}_force: pair_{k + 1}, component: {axis}}}\n"
                      for kind in kinds for axis in AXES[:self.dim]]
        return lines

    def text(self, mesh_file):
        """The scene as YAML."""
        if not self.sections:
            raise MeshError("the deck has no *SOLID SECTION, so that no body has a material")
        bodies = [(body, self._law(material)) for body, material in self.sections if self._has_cells(body)]
        supports, loads = self._loads()
        lines = [f"mesh: {{file: {mesh_file}}}\n", f"geometry: {self._geometry([law for _, law in bodies])}\n",
                  *self._thickness(), f"kinematics: {'finite' if self.nlgeom else 'small'}\n", "bodies:\n"]
        lines += [f"  - {{volume: {name_of(body)}, material: {law}{self._formulation(body)}}}\n" for body, law in bodies]
        for title, part in (("supports", supports), ("loads", loads)):
            lines += [f"{title}:\n", *part] if part else []
        if self.pairs:
            lines += ["contact:\n", *(self._pair(k, *pair) for k, pair in enumerate(self.pairs))]
        first = min(max((self.first or 0.1) / self.count, LEAST_STEP), 1.0)
        at = ", ".join(number(k / self.count) for k in range(1, self.count))
        lines.append(f"stepping: {{initial: {number(first)}{f', at: [{at}]' if at else ''}}}\n")
        probes = self._probes()
        lines += ["probes:\n", *probes] if probes else []
        head = [f"# Made from {self.deck.file.name}. Units are those of the deck.\n"]
        return "".join(head + [f"# {line}\n" for line in self.remarks()] + lines)

    def _has_cells(self, body):
        return any(group.name == body and group.dim == self.dim and group.size for group in self.mesh.groups)

    def remarks(self):
        """What is missing and what is changed, each once."""
        lines = [f"missing: {text}" for text in self.missing] + [f"changed: {text}" for text in self.changed]
        return list(dict.fromkeys(lines + [f"note: {note}" for note in self.mesh.notes]))

