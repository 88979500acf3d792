/* The search finds the facets near a slave point, from whatever rank, in the order of their tags, and says how far
 * lists reach. Free edges are the ends of a surface that no symmetry continues. Offsets of a circle's chords are the
 * heights of its arcs, and are damped where solutions turn them to and fro. All answers are the same on 1, 2 and 3
 * ranks, as they are found by hand. */
#include "../parts.h"
#include "contactimpl.h"
#include "search/freeedge.h"

/* A long block with 16 facets of 0.5 on top, and a short one above it with two faces of 0.5. */
enum { LOWER, UPPER, FACETS = 16 };
static const double     Size = 0.5, Apart = 0.1;
static const PartsBlock Blocks[] = {{"lower", FACETS, 1, {0, 8}, {0, 1}}, {"upper", 2, 1, {3.3, 4.3}, {1.1, 1.6}}};

static Parts parts;

static void Create(PartsMap map, const char *supports, const char *pair)
{
  static char text[1024];

  snprintf(text, sizeof(text),
           "geometry: plane_strain\nkinematics: finite\nbodies:\n"
           "  - {volume: lower, material: {law: svk, E: 1000, nu: 0}}\n"
           "  - {volume: upper, material: {law: svk, E: 1000, nu: 0}}\n%s"
           "contact: [{name: joint, slave: upper_bottom, master: lower_top, penalty: {initial: 1000}%s%s%s}]\n",
           supports, strstr(pair, "smoother") ? "" : ", smoother: facet",
           strstr(pair, "formulation") ? "" : ", formulation: node_to_surface", pair);
  PartsCreate(2, Blocks, map, text, &parts);
}

static ContactPair *Pair(void)
{
  return &parts.problem->contact->pairs[0];
}

static void Evaluate(void)
{
  OK(PetscArrayzero(parts.f, parts.mesh->n_nodes * 2));
  OK(ContactResidual(parts.problem->contact, parts.u, 0, parts.f, NULL, NULL));
}

/* Shifts the upper block. */
static void ShiftUpper(double x, double y)
{
  for (int i = 0; i <= 2; i++)
    for (int j = 0; j <= 1; j++) PartsMoveNode(&parts, PartsTag(&parts, UPPER, i, j), x, y);
}

/* Tag of the facet from x = k/2 to (k + 1)/2: bottom and right side of the block have 17 faces before, and the top runs
   backwards. */
static long FacetTag(int k)
{
  return FACETS + 1 + FACETS - k;
}

/* Facets of a slave node at x: nearest first and last of the list, by number, as the distances say. */
static void CheckLists(NeighbourLists lists, double x, double reach, int nearest, PetscInt q)
{
  const int first = (int)PetscMax(0, ceil((x - reach) / Size) - 1),
            last  = (int)PetscMin(FACETS - 1, (x + reach) / Size);
  PetscInt i      = lists->facet_ptr[q];

  assert_int_equal(lists->facet_ptr[q + 1] - i, last - first + 1);
  assert_int_equal(lists->facet[i + lists->nearest[q]].tag / SURFACE_MAX_IMAGES, FacetTag(nearest));
  for (int k = last; k >= first; k--, i++) {
    assert_int_equal(lists->facet[i].tag / SURFACE_MAX_IMAGES, FacetTag(k));
    assert_near(lists->facet_size[i], Size, 1e-14);
  }
}

/* All facets whose distance is within 1.5 sizes and the motion of that of the nearest one, 0.1 */
static void test_lists(void **state)
{
  const double motion[] = {0, 0.8};
  PetscInt     n;

  (void)state;
  Create(NULL, "", "");
  n = Pair()->n;
  OK(MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  assert_int_equal(n, 3);
  for (int m = 0; m < 2; m++) {
    NeighbourLists lists;
    const double   distance = Apart + 1.5 * Size + motion[m], reach = sqrt(distance * distance - Apart * Apart);

    OK(SearchLists(Pair()->search, parts.u, 0, motion[m], &lists));
    assert_int_equal(lists->n_slaves, Pair()->n);
    for (PetscInt c = 0; c < Pair()->n; c++) {
      double X[2];

      PartsPlace(&parts, Pair()->node[c], X);
      CheckLists(lists, X[0], reach, (int)(X[0] / Size), Pair()->term_point[Pair()->term_ptr[c]]);
    }
    OK(NeighbourListsDestroy(&lists));
  }
  PartsDestroy(&parts);
}

/* Of two facets that are equally near the one of lower tag is the nearest; 2.0 sizes and the motion are the reach. */
static void test_nearest(void **state)
{
  NeighbourLists lists;

  (void)state;
  Create(NULL, "", "");
  ShiftUpper(0.2, 0); /* to x = 3.5, 4 and 4.5, where facets meet */
  OK(SearchLists(Pair()->search, parts.u, 0, 0, &lists));
  for (PetscInt c = 0; c < Pair()->n; c++) {
    const PetscInt q = Pair()->term_point[Pair()->term_ptr[c]];
    double         X[2];

    PartsPlace(&parts, Pair()->node[c], X);
    assert_int_equal(lists->facet[lists->facet_ptr[q] + lists->nearest[q]].tag / SURFACE_MAX_IMAGES,
                     FacetTag((int)lround((X[0] + 0.2) / Size)));
  }
  OK(NeighbourListsDestroy(&lists));
  for (int far = 0; far < 2; far++) {
    ShiftUpper(0, 2 * Size - Apart + (far ? 0.3 + 1e-6 : 0.3 - 1e-6));
    OK(SearchLists(Pair()->search, parts.u, 0, 0.3, &lists));
    for (PetscInt q = 0; q < lists->n_slaves; q++)
      assert_true((lists->facet_ptr[q] == lists->facet_ptr[q + 1]) == far && (lists->nearest[q] < 0) == far);
    OK(NeighbourListsDestroy(&lists));
  }
  PartsDestroy(&parts);
}

/* Where both bodies moved together, lists hold no more than without motion. Where the slave moved against the master,
   they hold what is as far along the way as it may go on. A way that is too short tells nothing, and a motion that is
   less than the reach counts in full. So does by how much prescribed displacements leave the way. */
static void test_way(void **state)
{
  static const struct {
    double motion, lower, upper, aside, more; /* more: by so much the lists are longer than without motion */
  } cases[] = {{1.2, 0.6, 0.6, 0, 0},   {1.2, 0.6, 0.6, 0.3, 0.6}, {1.2, 1.2, 1, 0, 0.4},
               {1.2, 0, 1.2, 0.3, 1.2}, {1.2, 0.1, 0.1, 0, 1.2},   {0.8, 0.4, 0.4, 0, 0.8}};

  (void)state;
  for (int k = 0; k < 6; k++) {
    const double   distance = Apart + 1.5 * Size + cases[k].more, reach = sqrt(distance * distance - Apart * Apart);
    NeighbourLists lists;
    PetscReal     *before;

    Create(NULL, "", "");
    OK(PetscCalloc1(parts.mesh->n_nodes * 2, &before));
    for (PetscInt i = 0; i < parts.mesh->n_nodes; i++) {
      double X[2];

      PartsPlace(&parts, i, X);
      before[2 * i] = -(X[1] > 1.05 ? cases[k].upper : cases[k].lower);
    }
    SearchSetBefore(Pair()->search, before, 0, PetscMax(cases[k].lower, cases[k].upper), cases[k].aside);
    OK(SearchLists(Pair()->search, parts.u, 0, cases[k].motion, &lists));
    for (PetscInt c = 0; c < Pair()->n; c++) {
      double X[2];

      PartsPlace(&parts, Pair()->node[c], X);
      CheckLists(lists, X[0], reach, (int)(X[0] / Size), Pair()->term_point[Pair()->term_ptr[c]]);
    }
    OK(NeighbourListsDestroy(&lists));
    OK(PetscFree(before));
    PartsDestroy(&parts);
  }
}

/* The signed distance of any point to the whole master, that no list is needed for. */
static void test_distance(void **state)
{
  const double at[][3] = {{1.2, 1.7, 0.7}, {7.9, 0.6, -0.4}, {0.1, 9, 8}};

  (void)state;
  Create(NULL, "", "");
  for (int k = 0; k < 3; k++) {
    const PetscReal x[3] = {at[k][0] - parts.mesh->centre[0], at[k][1] - parts.mesh->centre[1], 0};
    PetscReal       gap  = 0;

    OK(SearchDistance(Pair()->search, parts.u, 0, x, &gap));
    assert_near(gap, at[k][2], 1e-14);
  }
  PartsDestroy(&parts);
}

/* Lists of facets that a slide of 2.5 leaves: the node over the raised end of the master was measured to what was near
   before. Fresh lists replace them, find the right gaps, and hold. */
static void Raise(const double X[2], double x[2])
{
  x[0] = X[0];
  x[1] = X[1] + (X[1] > 0.5 && X[1] < 1.05 && X[0] > 5.9 ? 0.3 : 0);
}

static void test_hold(void **state)
{
  PetscBool hold;

  (void)state;
  Create(Raise, "", "");
  OK(ContactGather(parts.problem->contact, parts.u, 0, 0, 0));
  ShiftUpper(0.3, -0.15);
  Evaluate();
  OK(ContactListsHold(parts.problem->contact, parts.u, 0, 0.4, 0, 1, PETSC_FALSE, &hold));
  assert_true(hold);
  ShiftUpper(2.5, 0.15); /* to x = 5.8, 6.3 and 6.8: 0.05 below the raised end */
  Evaluate();
  OK(ContactListsHold(parts.problem->contact, parts.u, 0, 2.6, 0, 1, PETSC_FALSE, &hold));
  assert_false(hold);
  Evaluate();
  for (PetscInt c = 0; c < Pair()->n; c++)
    if (parts.mesh->node_tag[Pair()->node[c]] != PartsTag(&parts, UPPER, 0, 0))
      assert_near(Pair()->now.gap[c], -0.05, 1e-13);
  OK(ContactListsHold(parts.problem->contact, parts.u, 0, 2.6, 0, 1, PETSC_FALSE, &hold));
  assert_true(hold);
  PartsDestroy(&parts);
}

/* Lists with fits reach as far as a slide of 0.3 supports; the support has 4.5 spacings of the master's nodes. */
static void test_reach(void **state)
{
  const double support = 4.5 * Size;
  PetscBool    within;

  (void)state;
  Create(NULL, "", ", smoother: diffuse, support: 4.5");
  ShiftUpper(0, -Apart - 0.01);
  OK(ContactGather(parts.problem->contact, parts.u, 0, 0, 1));
  for (int far = 0; far < 2; far++) {
    const double slide = (NEIGHBOUR_LISTS_MARGIN + (far ? 0.02 : -0.02)) * support;

    ShiftUpper(slide, -Apart - 0.01);
    Evaluate();
    for (PetscInt q = 0; q < Pair()->lists->n_slaves; q++) {
      assert_int_equal(Pair()->lists->rung[q], RUNG_PLAIN);
      assert_near(NeighbourListsSlip(Pair()->lists, q), slide / support, 1e-6);
    }
    OK(ContactListsReach(parts.problem->contact, &within));
    assert_true(within == !far);
  }
  PartsDestroy(&parts);
}

/* Points that are a little more than a facet's size from the master, before it or in it, are fitted where they overlap
   it, or the scene has them press before they meet it. */
static void test_far(void **state)
{
  const char *pairs[] = {", smoother: diffuse", ", smoother: diffuse, initial_overlap: {add: 0.6}"};

  (void)state;
  for (int add = 0; add < 2; add++)
    for (int side = -1; side <= 1; side += 2) {
      Create(NULL, "", pairs[add]);
      ShiftUpper(0, side * 1.1 * Size - Apart);
      OK(ContactGather(parts.problem->contact, parts.u, 0, 0, 0));
      for (PetscInt q = 0; q < Pair()->lists->n_slaves; q++)
        assert_int_equal(Pair()->lists->rung[q], add || side < 0 ? RUNG_PLAIN : RUNG_UNASKED);
      PartsDestroy(&parts);
    }
}

/* The ends of the slave at x = 3.3 and 4.3, and those of the master, whose end facets know them. */
static void test_free_edges(void **state)
{
  static const char *const symmetry[] = {"", ", symmetry: [upper_left]"};
  const double             at[] = {3.4, 3.8, 4.5}, distance[2][3] = {{0.1, 0.5, 0.2}, {0.9, 0.5, 0.2}};

  (void)state;
  for (int s = 0; s < 2; s++) {
    FreeEdges edges;
    int       ends = 0, found = 0;

    Create(NULL, "supports: [{surface: upper_left, ux: 0}]\n", symmetry[s]);
    OK(FreeEdgesCreate(parts.mesh, parts.scene, &parts.scene->contacts[0], Pair()->slave->group, &edges));
    for (int k = 0; k < 3; k++)
      assert_near(FreeEdgesDistance(edges, (PetscReal[3]){at[k], 1.1, 0}), distance[s][k], 1e-13);
    OK(FreeEdgesDestroy(&edges));
    for (PetscInt f = 0; f < Pair()->master->n_faces; f++) {
      const Facet *face = &Pair()->master->faces[f];
      const int    end  = face->tag == FacetTag(0) || face->tag == FacetTag(FACETS - 1);

      assert_true((face->free_edges != 0) == end && face->free_edges != 3);
      found++, ends += end;
    }
    OK(MPI_Allreduce(MPI_IN_PLACE, &ends, 1, MPI_INT, MPI_SUM, PETSC_COMM_WORLD));
    OK(MPI_Allreduce(MPI_IN_PLACE, &found, 1, MPI_INT, MPI_SUM, PETSC_COMM_WORLD));
    assert_true(ends == 2 && found == FACETS);
    PartsDestroy(&parts);
  }
}

/* The lower block's top becomes a circle through (4, 1), which is its highest point; its facets are chords. */
#define RADIUS 10.
static double radius = RADIUS;
static void   ToCircle(const double X[2], double x[2])
{
  x[0] = X[0], x[1] = X[1];
  if (X[1] > 1.05) return;
  x[0] = 4 + (radius + X[1] - 1) * sin((X[0] - 4) / radius);
  x[1] = 1 - radius + (radius + X[1] - 1) * cos((X[0] - 4) / radius);
}

/* The height of the arc over its chord, (h^2/4 - s^2) / (2 R) to second order, along the chord's normal. The next
   order is (h / R)^2 / 16 of it, 2e-4, and the fit's own error is smaller. */
static void test_offsets(void **state)
{
  const FaceRule  *rule = FaceRuleGet(ELEMENT_EDGE2, 0);
  const PetscReal *offset;

  (void)state;
  Create(ToCircle, "", ", smoother: diffuse, formulation: surface_to_surface, offset: held");
  OK(ContactGather(parts.problem->contact, parts.u, 0, 0, 0));
  offset = OffsetsGet(Pair()->master_offsets);
  for (PetscInt f = 0; f < Pair()->master->n_faces; f++) {
    const Facet *face = &Pair()->master->faces[f];
    double       X[2][2], h;

    for (int a = 0; a < 2; a++) PartsPlace(&parts, face->nodes[a], X[a]);
    h = hypot(X[1][0] - X[0][0], X[1][1] - X[0][1]);
    assert_near(h, 2 * RADIUS * sin(Size / RADIUS / 2), 1e-13);
    for (int q = 0; q < rule->n; q++) {
      const PetscReal *b         = &offset[(f * FACE_RULE_POINTS + q) * 2];
      const double     height    = (h * h / 4 - PetscSqr(rule->xi[q][0] * h / 2)) / (2 * RADIUS);
      const double     middle[2] = {(X[0][0] + X[1][0]) / 2 - 4, (X[0][1] + X[1][1]) / 2 + 9};

      assert_near(hypot(b[0], b[1]), height, 1e-3 * height);
      assert_near((b[0] * middle[0] + b[1] * middle[1]) / hypot(middle[0], middle[1]), height, 1e-3 * height);
    }
  }
  offset = OffsetsGet(Pair()->slave_offsets); /* the slave is flat */
  for (PetscInt k = 0; k < Pair()->slave->n_faces * FACE_RULE_POINTS * 2; k++) assert_near(offset[k], 0, 1e-13);
  PartsDestroy(&parts);
}

/* Sum of the offsets of the facet left of the highest point of a circle of radius r. */
static double OffsetsAtTop(double r)
{
  const PetscReal *offset;
  double           sum = 0;

  radius = r;
  Create(ToCircle, "", ", smoother: diffuse, formulation: surface_to_surface, offset: held, friction: {mu: 0.1}");
  OK(ContactGather(parts.problem->contact, parts.u, 0, 0, 0));
  offset = OffsetsGet(Pair()->master_offsets);
  for (PetscInt f = 0; f < Pair()->master->n_faces; f++) {
    const Facet *face = &Pair()->master->faces[f];
    double       X[2][2], x;

    for (int a = 0; a < 2; a++) PartsPlace(&parts, face->nodes[a], X[a]);
    x = (X[0][0] + X[1][0]) / 2;
    for (int q = 0; q < FaceRuleGet(ELEMENT_EDGE2, 0)->n && x > 4 - Size && x < 4 && X[0][1] > 0.8; q++)
      sum += hypot(offset[(f * FACE_RULE_POINTS + q) * 2], offset[(f * FACE_RULE_POINTS + q) * 2 + 1]);
  }
  OK(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
  PartsDestroy(&parts);
  radius = RADIUS;
  return sum;
}

/* Offsets of a coarse bend do not jump where points come to look away from the facet by more than 60 degrees, as the
   fifth nodes on either side do here. */
static void test_flank(void **state)
{
  const double r = 4.5 * Size / (PETSC_PI / 3), part = 1e-6, less = OffsetsAtTop(r * (1 - part)),
               more = OffsetsAtTop(r * (1 + part));

  (void)state;
  assert_true(less > 0);
  assert_near(more, less, 10 * part * less);
}

/* The lower block's circle bends on, to a curvature of 1 + bend times its own. */
static double bend;
static void   Bend(const double X[2], double x[2])
{
  x[0] = X[0], x[1] = X[1];
  if (X[1] < 1.05) x[1] -= bend * PetscSqr(X[0] - 4) / (2 * RADIUS);
}

/* Has a list of a slave point this facet? */
static PetscBool ListHas(NeighbourLists lists, PetscInt q, long tag)
{
  for (PetscInt i = lists->facet_ptr[q]; i < lists->facet_ptr[q + 1]; i++)
    if (lists->facet[i].tag == tag) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The way that both bodies go together: the lower one bends up and turns, the upper one slides down on it. */
static void Go(const double X[2], double part, double x[2])
{
  const double turn = 0.05 * part, sine = sin(turn), cosine = cos(turn), up = 1 + 0.01 * PetscSqr(X[0] - 4) * part;

  x[0] = X[0] * cosine - X[1] * up * sine + 8 * part;
  x[1] = X[0] * sine + X[1] * up * cosine;
  if (X[1] < 1.05) return;
  x[0] -= 1.2 * part;
  x[1] -= 0.2 * part;
}

/* Displacements of a part of the way, or beyond it in its direction. */
static void Place(double part, PetscReal *u)
{
  for (PetscInt i = 0; i < parts.mesh->n_nodes; i++) {
    double X[2], x[2], y[2];

    PartsPlace(&parts, i, X);
    Go(X, 1, x);
    Go(X, 0, y);
    for (int d = 0; d < 2; d++) u[2 * i + d] = (1 - part) * y[d] + part * x[d] - X[d];
  }
}

/* Whatever a full search finds nearest on the way ahead is in the lists that follow from the way before, which are
   shorter than full ones. */
static void test_ahead(void **state)
{
  NeighbourLists lists, full;
  PetscReal     *before, *u, size = 0;
  PetscInt       count[2] = {0, 0};

  (void)state;
  Create(NULL, "", "");
  OK(PetscMalloc2(parts.mesh->n_nodes * 2, &before, parts.mesh->n_nodes * 2, &u));
  Place(0, before);
  Place(1, parts.u);
  for (PetscInt i = 0; i < parts.mesh->n_nodes; i++)
    size = PetscMax(size, hypot(parts.u[2 * i] - before[2 * i], parts.u[2 * i + 1] - before[2 * i + 1]));
  OK(MPI_Allreduce(MPI_IN_PLACE, &size, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  OK(SearchLists(Pair()->search, parts.u, 0, 1.5 * size, &full));
  SearchSetBefore(Pair()->search, before, 0, size, 0);
  OK(SearchLists(Pair()->search, parts.u, 0, 1.5 * size, &lists));
  SearchSetBefore(Pair()->search, NULL, 0, 0, 0);
  for (PetscInt q = 0; q < lists->n_slaves; q++) {
    count[0] += lists->facet_ptr[q + 1] - lists->facet_ptr[q];
    count[1] += full->facet_ptr[q + 1] - full->facet_ptr[q];
  }
  OK(MPI_Allreduce(MPI_IN_PLACE, count, 2, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  assert_true(count[0] > 0 && count[0] < count[1]);
  OK(NeighbourListsDestroy(&full));
  for (int k = -10; k <= 15; k++) {
    Place(1 + k / 10., u);
    OK(SearchLists(Pair()->search, u, 0, 0, &full));
    for (PetscInt q = 0; q < full->n_slaves; q++)
      assert_true(full->nearest[q] < 0 || ListHas(lists, q, full->facet[full->facet_ptr[q] + full->nearest[q]].tag));
    OK(NeighbourListsDestroy(&full));
  }
  OK(NeighbourListsDestroy(&lists));
  OK(PetscFree2(before, u));
  PartsDestroy(&parts);
}

/* Lists that were made at a state take offsets that are extrapolated from there: they stay, and their points are where
   those of a new search are. */
static void test_extrapolated(void **state)
{
  NeighbourLists lists;
  PetscReal     *before, *X, most = 0;
  PetscInt       n, m;

  (void)state;
  Create(ToCircle, "", ", smoother: diffuse, formulation: surface_to_surface, offset: held");
  OK(ContactGather(parts.problem->contact, parts.u, 0, 0, 0));
  bend = 0.1;
  PartsMove(&parts, Bend);
  OK(ContactGather(parts.problem->contact, parts.u, 0.25, 0.25, 0));
  lists = Pair()->lists;
  n     = lists->n_points * 2;
  m     = lists->n_slaves * 2;
  OK(PetscMalloc2(n, &before, n + m, &X));
  OK(PetscArraycpy(before, lists->point_X, n));
  OK(ContactGather(parts.problem->contact, parts.u, 0.25, 0.5, 0));
  assert_ptr_equal(Pair()->lists, lists);
  OK(PetscArraycpy(X, lists->point_X, n));
  OK(PetscArraycpy(X + n, lists->slave_X, m));
  for (PetscInt i = 0; i < n; i++) most = PetscMax(most, PetscAbsReal(X[i] - before[i]));
  OK(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  assert_true(most > 1e-4 * PetscSqr(Size) / RADIUS);
  OK(ContactListsRenew(parts.problem->contact, parts.u, 0.25, 0));
  assert_ptr_not_equal(Pair()->lists, lists);
  assert_int_equal(Pair()->lists->n_points * 2, n);
  for (PetscInt i = 0; i < n; i++) assert_near(Pair()->lists->point_X[i], X[i], 1e-14);
  for (PetscInt i = 0; i < m; i++) assert_near(Pair()->lists->slave_X[i], X[n + i], 1e-14);
  OK(PetscFree2(before, X));
  PartsDestroy(&parts);
}

/* Sum of the master's offsets over all ranks, along y. */
static double OffsetsSum(void)
{
  const PetscReal *offset = OffsetsGet(Pair()->master_offsets);
  double           sum    = 0;

  for (PetscInt k = 0; k < Pair()->master->n_faces * FACE_RULE_POINTS; k++) sum += offset[2 * k + 1];
  OK(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
  return sum;
}

/* A body under a load that bends it by 0.1 answers to a change of its offsets by `gain` times as much the other way.
   Returns by how much its bend after some solutions differs from the next one; damped: how many of them had damped
   offsets. */
static double Answer(double gain, int solutions, int *damped)
{
  double rest, end;

  Create(ToCircle, "", ", smoother: diffuse, formulation: surface_to_surface, offset: held");
  OK(ContactGather(parts.problem->contact, parts.u, 0, 0, 0));
  rest    = OffsetsSum();
  bend    = 0.1;
  *damped = 0;
  for (int k = 0; k < solutions; k++) {
    PetscBool changed;

    PartsMove(&parts, Bend);
    OK(OffsetsTake(Pair()->master_offsets, parts.u, k + 1));
    OK(OffsetsDamp(Pair()->master_offsets, &changed));
    *damped += changed;
    bend = 0.1 - gain * (OffsetsSum() / rest - 1);
  }
  PartsMove(&parts, Bend);
  OK(OffsetsTake(Pair()->master_offsets, parts.u, solutions + 1));
  end = 0.1 - gain * (OffsetsSum() / rest - 1);
  PartsDestroy(&parts);
  return bend - end;
}

/* A body that would turn its offsets to and fro without end settles; one that settles by itself is left alone. */
static void test_damped(void **state)
{
  int damped;

  (void)state;
  assert_near(Answer(2, 8, &damped), 0, 1e-6);
  assert_true(damped >= 2);
  assert_near(Answer(0.05, 3, &damped), 0, 1e-4);
  assert_int_equal(damped, 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_lists),   cmocka_unit_test(test_nearest), cmocka_unit_test(test_distance),
    cmocka_unit_test(test_hold),    cmocka_unit_test(test_reach),   cmocka_unit_test(test_free_edges),
    cmocka_unit_test(test_offsets), cmocka_unit_test(test_flank),   cmocka_unit_test(test_extrapolated),
    cmocka_unit_test(test_damped),  cmocka_unit_test(test_way),     cmocka_unit_test(test_ahead),
    cmocka_unit_test(test_far)};

  if (PartsStart(&argc, &argv)) return 1;
  return PartsEnd(cmocka_run_group_tests(tests, NULL, NULL));
}
