/* Crossings along straight motions, and planted violations: each state is moved by hand, and each is found. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>
#include "analytic.h"

enum { MOST = 512 };

/* One side of a planted state: faces of a plate. */
typedef struct {
  int   dim;
  Piece pieces[MOST];
  int   n;
} Plate;

/* Adds a piece that is moved from its reference place to two states. */
static void AddPiece(Plate *plate, const double X[3][3], const double start[3], const double end[3], long tag)
{
  Piece *piece = &plate->pieces[plate->n++];

  *piece = (Piece){.face = 100 + plate->n, .size = 1, .height = 1, .order = 1, .body = 1};
  for (int a = 0; a < plate->dim; a++) {
    piece->tag[a] = tag + a;
    for (int d = 0; d < 3; d++) {
      piece->X[a][d]    = X[a][d];
      piece->x[0][a][d] = X[a][d] + start[d];
      piece->x[1][a][d] = X[a][d] + end[d];
    }
  }
  PiecePlace(piece, plate->dim);
}

/* A plate in the plane whose top is y = 0 and whose bottom is y = -thickness; four faces of length 1 on each side. */
static void PlaneWall(Plate *plate, double thickness, const double start[3], const double end[3])
{
  *plate = (Plate){.dim = 2};
  for (int k = 0; k < 4; k++) {
    const double top[3][3]    = {{k - 1, 0, 0}, {k - 2, 0, 0}, {0}},
                 bottom[3][3] = {{k - 2, -thickness, 0}, {k - 1, -thickness, 0}, {0}};

    AddPiece(plate, top, start, end, 1000 + 10 * k);
    if (thickness > 0) AddPiece(plate, bottom, start, end, 2000 + 10 * k);
  }
}

/* The same in space: squares of two triangles each, top z = 0. */
static void SolidWall(Plate *plate, double thickness, const double start[3], const double end[3])
{
  *plate = (Plate){.dim = 3};
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      const double x = i - 1.5, y = j - 1.5, z = -thickness;
      const double top[2][3][3]    = {{{x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}},
                                      {{x, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0}}};
      const double bottom[2][3][3] = {{{x, y, z}, {x + 1, y + 1, z}, {x + 1, y, z}},
                                      {{x, y, z}, {x, y + 1, z}, {x + 1, y + 1, z}}};

      for (int k = 0; k < 2; k++) {
        AddPiece(plate, top[k], start, end, 10000 + 100 * (3 * i + j) + 10 * k);
        if (thickness > 0) AddPiece(plate, bottom[k], start, end, 20000 + 100 * (3 * i + j) + 10 * k);
      }
    }
  }
}

static const double still[3] = {0, 0, 0};

/* A point of another body that looks along `normal`. */
static Point MakePoint(const double from[3], const double to[3], const double normal[3])
{
  Point point = {.tag = 7, .size = 1, .height = 1, .body = 2, .number = 1, .side = 1, .order = 1};

  memcpy(point.X, from, sizeof(Place));
  memcpy(point.x[0], from, sizeof(Place));
  memcpy(point.x[1], to, sizeof(Place));
  for (int state = 0; state < 2; state++) memcpy(point.normal[state], normal, sizeof(Place));
  return point;
}

static Finding JudgePoint(Plate *plate, Point *point, int walls)
{
  const PieceList list  = {plate->n, plate->n, plate->pieces};
  Look            look  = {.penetration = 0.1, .walls = walls, .slave = {0, 1}, .apart = 1};
  Finding         worst = {.kind = FINDING_NONE};

  assert_true(LookBegin(plate->dim, &list, &look));
  PointFinding(&look, point, &worst);
  LookDestroy(&look);
  return worst;
}

static Finding MovePoint(Plate *plate, const double from[3], const double to[3])
{
  const double down[3] = {0, plate->dim == 2 ? -1 : 0, plate->dim == 3 ? -1 : 0};
  Point        point   = MakePoint(from, to, down);

  return JudgePoint(plate, &point, 0);
}

#define AT(...) ((const double[3]){__VA_ARGS__})

static void CrossingsHaveClosedForms(void **context)
{
  const Place segment[2] = {{1, 0, 0}, {-1, 0, 0}}, lifted[2] = {{1, 1, 0}, {-1, 1, 0}};
  const Place triangle[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  Crossing    crossing[SWEEP_MAX];

  (void)context;
  assert_int_equal(SweepPoint(2, segment, segment, AT(0, 1, 0), AT(0, -3, 0), crossing), 1);
  assert_true(fabs(crossing[0].s - 0.25) < 1e-14 && crossing[0].inward);
  assert_int_equal(SweepPoint(2, segment, lifted, AT(0, 0.5, 0), AT(0, 0.5, 0), crossing), 1);
  assert_true(fabs(crossing[0].s - 0.5) < 1e-14);
  assert_int_equal(SweepPoint(2, segment, segment, AT(1.5, 1, 0), AT(1.5, -1, 0), crossing), 0);
  assert_int_equal(SweepPoint(3, triangle, triangle, AT(0.2, 0.2, -1), AT(0.2, 0.2, 3), crossing), 1);
  assert_true(fabs(crossing[0].s - 0.25) < 1e-14 && !crossing[0].inward);
  assert_int_equal(SweepPoint(3, triangle, triangle, AT(0.9, 0.9, 1), AT(0.9, 0.9, -1), crossing), 0);
}

/* A triangle that turns: the time of crossing is that of a fine sampling. */
static void TurningTriangleIsCrossed(void **context)
{
  const Place start[3] = {{-1, -1, 0}, {2, -1, 0}, {-1, 2, 0}}, end[3] = {{-1, -1, 0.3}, {2, 0, 1}, {-1, 1, -0.5}};
  const Place from = {0.1, 0.2, 0.8}, to = {-0.2, 0.1, -0.7};
  Crossing    crossing[SWEEP_MAX];
  double      before = 1, when = -1;

  (void)context;
  assert_int_equal(SweepPoint(3, start, end, from, to, crossing), 1);
  for (int k = 0; k <= 100000 && when < 0; k++) {
    const double s = k / 100000.0;
    double       x[3][3], p[3], front;

    for (int d = 0; d < 3; d++) {
      for (int a = 0; a < 3; a++) x[a][d] = (1 - s) * start[a][d] + s * end[a][d];
      p[d] = (1 - s) * from[d] + s * to[d];
    }
    front = PieceFront(3, (const Place *)x, p);
    if (before > 0 && front <= 0) when = s;
    before = front;
  }
  assert_true(fabs(crossing[0].s - when) < 2e-5);
}

static void EdgesCross(void **context)
{
  const Place a[2] = {{-1, 0, 1}, {1, 0, 1}}, below[2] = {{-1, 0, -0.5}, {1, 0, -0.5}}, b[2] = {{0, -1, 0}, {0, 1, 0}};
  const Place aside[2] = {{1, 0, -0.5}, {3, 0, -0.5}};
  EdgeEnd     end;

  (void)context;
  assert_int_equal(SweepEdges(a, below, b, b, &end), 1);
  assert_true(end.over && fabs(end.distance + 0.5) < 1e-14);
  assert_int_equal(SweepEdges(a, a, b, b, &end), 0);
  assert_int_equal(SweepEdges(a, aside, b, b, &end), 0); /* it left sideways before it came down */
}

static void FacesDivideWithTheirNormals(void **context)
{
  static const ElementType types[] = {ELEMENT_EDGE2, ELEMENT_EDGE3, ELEMENT_TRI3,
                                      ELEMENT_TRI6,  ELEMENT_QUAD4, ELEMENT_QUAD9};

  (void)context;
  for (size_t k = 0; k < sizeof(types) / sizeof(*types); k++) {
    const Element *element = ElementGet(types[k]);
    const int      dim     = element->dim + 1;
    int            node[PIECE_MAX][3], n = PieceDivide(types[k], node);
    double         area = 0;

    for (int i = 0; i < n; i++) {
      double x[3][3] = {{0}}, normal[3];

      for (int a = 0; a < dim; a++)
        for (int d = 0; d < element->dim; d++) x[a][d] = element->node[node[i][a]][d];
      PieceNormal(dim, (const Place *)x, normal);
      assert_true(fabs(normal[dim - 1] - (dim == 2 ? -1 : 1)) < 1e-14);
      area += dim == 2 ? x[1][0] - x[0][0]
                       : 0.5 * ((x[1][0] - x[0][0]) * (x[2][1] - x[0][1]) - (x[2][0] - x[0][0]) * (x[1][1] - x[0][1]));
    }
    assert_true(fabs(area - (dim == 2 ? 2 : element->corners == 3 ? 0.5 : 4)) < 1e-14);
  }
}

/* The sagitta of chords of a circle is h^2/8R to the second order. */
static void ChordsHaveTheirHeight(void **context)
{
  const double h = 0.1, R = 2, angle = asin(h / 2 / R);
  const Place  x[2] = {{h / 2, 0, 0}, {-h / 2, 0, 0}},
              n[2]  = {{sin(angle), cos(angle), 0}, {-sin(angle), cos(angle), 0}};

  (void)context;
  assert_true(fabs(PieceHeight(2, x, n, 0.9) / (h * h / 8 / R) - 1) < 1e-3);
}

static void HonestStatesHold(void **context)
{
  Plate plate;
  Point point;

  (void)context;
  PlaneWall(&plate, 0.2, still, still);
  assert_int_equal(MovePoint(&plate, AT(0.3, 1, 0), AT(0.3, 0.1, 0)).kind, FINDING_NONE);
  assert_int_equal(MovePoint(&plate, AT(0.3, 0.1, 0), AT(0.6, -0.05, 0)).kind, FINDING_NONE); /* shallow */
  assert_int_equal(MovePoint(&plate, AT(0.3, -0.05, 0), AT(0.6, 0.1, 0)).kind, FINDING_NONE);
  assert_int_equal(MovePoint(&plate, AT(3, 1, 0), AT(3, -1, 0)).kind, FINDING_NONE); /* beside the wall */
  point        = MakePoint(AT(0.3, 0.1, 0), AT(0.3, -0.3, 0), AT(0, -1, 0));
  point.closed = 1; /* a right-angled edge whose flanks rest on the points around */
  point.tip    = 1;
  PlaneWall(&plate, 0, still, still);
  assert_int_equal(JudgePoint(&plate, &point, 0).kind, FINDING_NONE);
  SolidWall(&plate, 0.2, still, still);
  assert_int_equal(MovePoint(&plate, AT(0.3, 0.1, 1), AT(0.3, 0.2, -0.05)).kind, FINDING_NONE);
  SolidWall(&plate, 0, still, still); /* beside the end of an open surface, at vertices of several pieces */
  assert_int_equal(MovePoint(&plate, AT(1.7, 0.5, 0.1), AT(1.6, 0.5, -0.15)).kind, FINDING_NONE);
  assert_int_equal(MovePoint(&plate, AT(1.7, 1.7, 0.1), AT(1.55, 1.55, -0.15)).kind, FINDING_NONE);
  PlaneWall(&plate, 1, still, still); /* the wall's own top is no partner of a point of its bottom */
  point      = MakePoint(AT(0.25, -1, 0), AT(0.25, -1, 0), AT(0, -1, 0));
  point.body = 1;
  assert_int_equal(JudgePoint(&plate, &point, 1).kind, FINDING_NONE);
}

/* Points: 1 to 8 of the planted violations. */
static void PlantedPointsAreFound(void **context)
{
  Plate   plate;
  Finding finding;
  Point   point;

  (void)context;
  PlaneWall(&plate, 0.05, still, still); /* 1: a thin wall is passed in one step */
  finding = MovePoint(&plate, AT(0.3, 1, 0), AT(0.3, -1, 0));
  assert_int_equal(finding.kind, FINDING_PASSED);
  assert_int_equal(finding.tag[0], 7);
  /* 2: a point that stood a little behind the top comes out at the bottom */
  assert_int_equal(MovePoint(&plate, AT(0.3, -0.01, 0), AT(0.3, -0.2, 0)).kind, FINDING_PASSED);
  /* 3: it goes so far that the bottom is nearer */
  PlaneWall(&plate, 0.3, still, still);
  point              = MakePoint(AT(0.3, 0.2, 0), AT(0.3, -0.25, 0), AT(0, -1, 0));
  point.normal[1][1] = 1;
  assert_int_equal(JudgePoint(&plate, &point, 0).kind, FINDING_PASSED);
  /* 4: too deep */
  assert_int_equal(MovePoint(&plate, AT(0.3, 0.1, 0), AT(0.3, -0.14, 0)).kind, FINDING_DEPTH);
  PlaneWall(&plate, 0.05, still, AT(0, 3, 0)); /* 5: the wall moves, the point does not */
  assert_int_equal(MovePoint(&plate, AT(0.3, 1, 0), AT(0.3, 1, 0)).kind, FINDING_PASSED);
  PlaneWall(&plate, 0, still, still); /* 6: a single sheet is passed, and nothing is behind it */
  assert_int_not_equal(MovePoint(&plate, AT(0.3, 1, 0), AT(0.3, -5, 0)).kind, FINDING_NONE);
  SolidWall(&plate, 0.05, still, still); /* 7: a wall in space */
  assert_int_equal(MovePoint(&plate, AT(0.3, 0.1, 1), AT(0.4, 0.2, -1)).kind, FINDING_PASSED);
  PlaneWall(&plate, 1, still, AT(0, -0.9, 0)); /* 8: a body's own other side, crushed to a tenth */
  for (int k = 0; k < plate.n; k++)
    if (plate.pieces[k].x[0][0][1] < -0.5) {
      memcpy(plate.pieces[k].x[1], plate.pieces[k].x[0], sizeof(Place[3]));
      PiecePlace(&plate.pieces[k], 2);
    }
  point      = MakePoint(AT(0.25, 0.5, 0), AT(0.25, -1.2, 0), AT(0, -1, 0));
  point.body = 1;
  assert_int_equal(JudgePoint(&plate, &point, 1).kind, FINDING_PASSED);
}

/* Points in space, and states that are rare: 15 to 19 of the planted violations. */
static void PlantedSolidsAreFound(void **context)
{
  static Plate plate;
  Finding      finding;
  Point        point;

  (void)context;
  SolidWall(&plate, 0, still, still); /* 15: too deep in a face */
  finding = MovePoint(&plate, AT(0.3, 0.1, 0.2), AT(0.4, 0.2, -0.14));
  assert_int_equal(finding.kind, FINDING_DEPTH);
  assert_true(fabs(finding.depth - 0.14) < 1e-12);
  SolidWall(&plate, 0.05, still, AT(0.2, 0, 2)); /* 16: a wall is drawn over a point that rests */
  assert_int_equal(MovePoint(&plate, AT(0.3, 0.1, 1), AT(0.3, 0.1, 1)).kind, FINDING_PASSED);
  SolidWall(&plate, 0, still, still); /* 17: what stood behind a face goes deeper without crossing anything */
  assert_int_not_equal(MovePoint(&plate, AT(0.3, 0.1, -0.3), AT(0.3, 0.1, -0.9)).kind, FINDING_NONE);
  SolidWall(&plate, 0.05, still, still); /* 18: another pair treats these faces, and none is this one's */
  point       = MakePoint(AT(0.3, 0.1, 1), AT(0.4, 0.2, -1), AT(0, 0, -1));
  point.marks = 1;
  for (int k = 0; k < plate.n; k++) plate.pieces[k].marks = 2;
  assert_int_equal(JudgePoint(&plate, &point, 0).kind, FINDING_NONE);
  for (int k = 0; k < plate.n; k++) plate.pieces[k].marks = 8; /* slave of the first, master of the second pair */
  assert_int_equal(JudgePoint(&plate, &point, 0).kind, FINDING_PASSED);
}

/* A round bar of radius 5 about the third axis that turns by an angle, from z = -2 to 2 in space. */
static void RoundBar(Plate *plate, int dim, double turn)
{
  enum { SIDES = 40 };

  *plate = (Plate){.dim = dim};
  for (int k = 0; k < SIDES; k++) {
    for (int t = 0; t < dim - 1; t++) {
      Piece *piece;

      AddPiece(plate, (const double[3][3]){{0}}, still, still, 1000 + 10 * (k + SIDES * t));
      piece = &plate->pieces[plate->n - 1];
      for (int a = 0; a < dim; a++) {
        const int    next  = dim == 2 ? a : (t ? a > 0 : a == 1);
        const double angle = 2 * M_PI * (k + next) / SIDES, z = dim == 2 ? 0 : (t ? a == 2 : a > 0) ? 2 : -2;

        memcpy(piece->X[a], AT(5 * cos(angle), 5 * sin(angle), z), sizeof(Place));
        memcpy(piece->x[0][a], piece->X[a], sizeof(Place));
        memcpy(piece->x[1][a], AT(5 * cos(angle + turn), 5 * sin(angle + turn), z), sizeof(Place));
      }
      PiecePlace(piece, dim);
    }
  }
}

static void LeapsOverRoundsAreFound(void **context)
{
  static Plate bar;

  (void)context;
  for (int dim = 2; dim <= 3; dim++) {
    const double z = dim == 2 ? 0 : 0.3, arc = 0.5;
    Point        point = MakePoint(AT(4.5, 4, z), AT(4.5, -4, z), AT(-1, 0, 0));

    RoundBar(&bar, dim, 0);
    assert_int_equal(JudgePoint(&bar, &point, 0).kind, FINDING_PASSED);
    point = MakePoint(AT(4.95, 4, z), AT(4.95, -4, z), AT(-1, 0, 0)); /* within what is allowed */
    assert_int_equal(JudgePoint(&bar, &point, 0).kind, FINDING_NONE);
    point = MakePoint(AT(5.05 * cos(arc), 5.05 * sin(arc), z), AT(5.05 * cos(arc), -5.05 * sin(arc), z),
                      AT(-cos(arc), -sin(arc), 0)); /* it turns around the bar with its body */
    memcpy(point.normal[1], AT(-cos(arc), sin(arc), 0), sizeof(Place));
    assert_int_equal(JudgePoint(&bar, &point, 0).kind, FINDING_NONE);
    RoundBar(&bar, dim, 2 * arc); /* the bar turns, on straight motions smaller in between */
    point = MakePoint(AT(5.05, 0, z), AT(5.05, 0, z), AT(-1, 0, 0));
    assert_int_equal(JudgePoint(&bar, &point, 0).kind, FINDING_NONE);
  }
}

/* A point crosses a hundred films that are thinner than round-off, and then a wall: 19. */
static void ManyCrossingsAreFollowed(void **context)
{
  static Plate plate = {.dim = 2};

  (void)context;
  for (int k = 0; k <= 100; k++) {
    const double y = -0.02 * k, thickness = k < 100 ? 1e-9 : 0.05;

    AddPiece(&plate, (const double[3][3]){{1, y, 0}, {-1, y, 0}, {0}}, still, still, 1000 + 10 * k);
    AddPiece(&plate, (const double[3][3]){{-1, y - thickness, 0}, {1, y - thickness, 0}, {0}}, still, still,
             5000 + 10 * k);
  }
  plate.n -= 2;
  assert_int_equal(MovePoint(&plate, AT(0, 1, 0), AT(0, -4, 0)).kind, FINDING_NONE);
  plate.n += 2;
  assert_int_equal(MovePoint(&plate, AT(0, 1, 0), AT(0, -4, 0)).kind, FINDING_PASSED);
}

/* An edge explains a depth by half a chord times its tip, and only where contact presses. */
static void EdgesExplainTheirChords(void **context)
{
  Plate plate;
  Point point;

  (void)context;
  PlaneWall(&plate, 0, still, still);
  for (int turn = 0; turn < 2; turn++) {
    for (int pressed = 0; pressed < 2; pressed++) {
      point        = MakePoint(AT(0.3, 0.1, 0), AT(0.3, -0.35, 0), AT(0, -1, 0));
      point.tip    = turn ? 0.6 : 0.4; /* 0.1 + 0.3 or 0.1 + 0.2 are allowed */
      point.closed = pressed;
      assert_int_equal(JudgePoint(&plate, &point, 0).kind, turn && pressed ? FINDING_NONE : FINDING_DEPTH);
    }
  }
}

/* Judges the edges of a piece of another body. */
static Finding JudgePiece(Plate *plate, const double from[3][3], const double to[3][3], int closed)
{
  const PieceList list      = {plate->n, plate->n, plate->pieces};
  Look            look      = {.penetration = 0.1, .slave = {1, 0}};
  Finding         worst     = {.kind = FINDING_NONE};
  Piece           piece     = {.size = 1, .height = 1, .order = 1, .body = 2, .closed = closed};
  Point           points[3] = {{.tag = 0}};
  double          normal[3];

  PieceNormal(plate->dim, to, normal);
  for (int a = 0; a < plate->dim; a++) {
    points[a]     = MakePoint(from[a], to[a], normal);
    points[a].tag = piece.tag[a] = 50 + a;
    memcpy(piece.X[a], from[a], sizeof(Place));
    memcpy(piece.x[0][a], from[a], sizeof(Place));
    memcpy(piece.x[1][a], to[a], sizeof(Place));
  }
  PiecePlace(&piece, plate->dim);
  assert_true(LookBegin(plate->dim, &list, &look));
  for (int e = 0; e < (plate->dim == 2 ? 1 : 3); e++)
    EdgeFinding(&look, &(Edge){{&points[e], &points[(e + 1) % plate->dim]}, {&piece}, e}, 1, &worst);
  LookDestroy(&look);
  return worst;
}

/* Faces and edges: 9 to 11. */
static void PlantedFacesAreFound(void **context)
{
  const double up[3][3]     = {{-2, 0.1, 0.5}, {0.2, 2, 0.5}, {2, 0.1, 0.5}},
               down[3][3]   = {{-2, 0.1, -0.3}, {0.2, 2, -0.3}, {2, 0.1, -0.3}};
  const double in[3][3]     = {{-2, 0.1, -1e-12}, {0.2, 2, -1e-12}, {2, 0.1, -1e-12}};
  const double above[3][3]  = {{-2, 0.5, 0}, {2, 0.5, 0}, {0}};
  const double across[3][3] = {{-2, -0.3, 0}, {2, -0.3, 0}, {0}};
  Plate        plate        = {.dim = 2};

  (void)context;
  AddPiece(&plate, (const double[3][3]){{0, 0, 0}, {-0.5, -1, 0}, {0}}, still, still, 1000); /* 9: a tip in a face */
  AddPiece(&plate, (const double[3][3]){{0.5, -1, 0}, {0, 0, 0}, {0}}, still, still, 1002);
  assert_int_equal(JudgePiece(&plate, above, above, 0).kind, FINDING_NONE);
  assert_int_equal(JudgePiece(&plate, above, across, 0).kind, FINDING_DEPTH);
  plate = (Plate){.dim = 3}; /* 10: two edges cross, and no corner is near */
  AddPiece(&plate, (const double[3][3]){{0, -2, 0}, {2, 0, 0}, {0, 2, 0}}, still, still, 1000);
  assert_int_equal(JudgePiece(&plate, up, up, 0).kind, FINDING_NONE);
  assert_int_equal(JudgePiece(&plate, up, down, 0).kind, FINDING_EDGES);
  assert_int_equal(JudgePiece(&plate, in, up, 0).kind, FINDING_NONE); /* it touched, and goes off */
  /* 11: the same where the other one moves */
  plate = (Plate){.dim = 3};
  AddPiece(&plate, (const double[3][3]){{0, -2, 0}, {2, 0, 0}, {0, 2, 0}}, still, AT(0, 0, 0.8), 1000);
  assert_int_equal(JudgePiece(&plate, up, up, 0).kind, FINDING_EDGES);
}

/* The normal across an edge of a roof, from the directions at its ends, on triangles of any shape. */
static void NormalsAcrossEdges(void **context)
{
  const Place  flank[3] = {{0, 0, 0}, {3, 0, 0}, {-1, 1, -1}};
  const double ridge[3] = {0, 0, 5}, slope = sqrt(0.5);
  double       across[3], angles           = 0;

  (void)context;
  for (int a = 0; a < 3; a++) angles += PieceAngle(flank, a);
  assert_true(fabs(angles - acos(-1)) < 1e-14);
  PieceAcross(flank, 0, ridge, ridge, across);
  assert_true(fabs(across[0]) < 1e-14 && fabs(across[1] + slope) < 1e-14 && fabs(across[2] - slope) < 1e-14);
  PieceAcross(flank, 0, AT(0, slope, slope), AT(0, slope, slope), across); /* the surface ends at the edge */
  assert_true(fabs(across[1] - slope) < 1e-14 && fabs(across[2] - slope) < 1e-14);
}

/* A bar of square section along x whose upper edge is at z = 0, with its edges as high and as low as `thickness`. */
static void Bar(Plate *plate, double thickness)
{
  *plate = (Plate){.dim = 3};
  for (int top = 0; top < 2; top++) {
    for (int flank = 0; flank < 2; flank++) {
      const double y = (flank - 0.5) * thickness, z = top ? 0 : -thickness, z_mid = -0.5 * thickness;
      const double turned[3][3] = {{-2, 0, z}, {2, 0, z}, {0, y, z_mid}},
                   plain[3][3]  = {{2, 0, z}, {-2, 0, z}, {0, y, z_mid}};

      AddPiece(plate, top == flank ? turned : plain, still, still, 1000 + 100 * top + 10 * flank);
    }
    for (int flank = 0; flank < 2; flank++)
      memcpy(plate->pieces[plate->n - 1 - flank].across[0], plate->pieces[plate->n - 2 + flank].normal[1],
             sizeof(Place));
  }
}

/* Judges the lower edge of a wedge along y that moves between two places, whose flanks are pressed. */
static Finding MoveWedge(Plate *plate, const double from[3], const double to[3])
{
  const PieceList list      = {plate->n, plate->n, plate->pieces};
  Look            look      = {.penetration = 0.1, .slave = {1, 0}};
  Finding         worst     = {.kind = FINDING_NONE};
  Piece           flanks[2] = {{.size = 1}, {.size = 1}};
  Point           ends[2];

  for (int i = 0; i < 2; i++) {
    const double y = i ? 2 : -2;

    ends[i]        = MakePoint(AT(from[0], from[1] + y, from[2]), AT(to[0], to[1] + y, to[2]), AT(0, 0, -1));
    ends[i].tag    = 50 + i;
    ends[i].tip    = 1;
    ends[i].closed = 1;
  }
  for (int k = 0; k < 2; k++) {
    flanks[k] = (Piece){.size = 1, .height = 1, .order = 1, .side = 1, .body = 2, .closed = 1, .tag = {50, 51, 52 + k}};
    for (int state = 0; state < 2; state++) {
      for (int i = 0; i < 2; i++) memcpy(flanks[k].x[state][k ? i : 1 - i], ends[i].x[state], sizeof(Place));
      for (int d = 0; d < 3; d++)
        flanks[k].x[state][2][d] = 0.5 * (ends[0].x[state][d] + ends[1].x[state][d]) + AT(2 * k - 1, 0, 1)[d];
    }
    PiecePlace(&flanks[k], 3);
  }
  for (int k = 0; k < 2; k++) memcpy(flanks[k].across[0], flanks[1 - k].normal[1], sizeof(Place));
  assert_true(flanks[0].normal[1][2] < 0 && flanks[1].normal[1][2] < 0);
  assert_true(LookBegin(3, &list, &look));
  EdgeFinding(&look, &(Edge){{&ends[0], &ends[1]}, {&flanks[0], &flanks[1]}, 0}, 1, &worst);
  LookDestroy(&look);
  return worst;
}

/* Edges across edges, in space: 20 to 22. What explains that an edge stands in a face between its points, a tip where
   contact presses, does not explain that it stands across an edge. */
static void EdgesAcrossEdgesAreFound(void **context)
{
  static Plate plate;
  Finding      finding;

  (void)context;
  Bar(&plate, 1);
  assert_int_equal(MoveWedge(&plate, AT(0, 0, 0.5), AT(0, 0, 0.01)).kind, FINDING_NONE);
  assert_int_equal(MoveWedge(&plate, AT(0, 0, 0.5), AT(0, 0, -0.05)).kind, FINDING_NONE);
  finding = MoveWedge(&plate, AT(0, 0, 0.5), AT(0, 0, -0.2)); /* 20: in one step */
  assert_int_equal(finding.kind, FINDING_EDGES);
  assert_true(fabs(finding.depth - 0.2) < 1e-12);
  assert_int_equal(MoveWedge(&plate, AT(0, 0, -0.09), AT(0, 0, -0.11)).kind, FINDING_EDGES); /* 21: by and by */
  assert_int_equal(MoveWedge(&plate, AT(3, 0, 0.5), AT(3, 0, -0.5)).kind, FINDING_NONE);     /* beside the bar */
  Bar(&plate, 0.05); /* 22: through a thin bar, and out beyond its end */
  assert_int_equal(MoveWedge(&plate, AT(0, 0, 1), AT(3.5, 0, -1)).kind, FINDING_PASSED);
  assert_int_equal(MoveWedge(&plate, AT(1.8, 0, 1), AT(3.5, 0, -1)).kind, FINDING_NONE);
}

/* Analytic tools: 12 to 14. The numbers go on with solids. */
static void PlantedToolsAreFound(void **context)
{
  AnalyticTool tool = {.dim = 2, .surface = {.shape = ANALYTIC_SPHERE, .radius = 0.1}, .penetration = 0.1};
  Point        point;
  Piece        piece = {.size = 1, .height = 1, .tag = {1, 2}};
  Finding      worst = {.kind = FINDING_NONE};

  (void)context;
  for (int state = 0; state < 2; state++) tool.axis[state][2] = 1;
  tool.surface = (AnalyticSurface){.shape = ANALYTIC_CYLINDER, .axis = {0, 0, 1}, .radius = 0.4};
  point        = MakePoint(AT(0, 1, 0), AT(0, -1, 0), AT(0, -1, 0));
  AnalyticPointFinding(&tool, &point, &worst); /* 12: a point passes a needle */
  assert_int_equal(worst.kind, FINDING_PASSED);
  worst = (Finding){.kind = FINDING_NONE};
  point = MakePoint(AT(0, 1, 0), AT(0, 0.2, 0), AT(0, -1, 0));
  AnalyticPointFinding(&tool, &point, &worst); /* 13: it stands in it */
  assert_int_equal(worst.kind, FINDING_DEPTH);
  worst               = (Finding){.kind = FINDING_NONE};
  tool.surface.radius = 0.05; /* 14: the needle passes between two points */
  for (int state = 0; state < 2; state++) {
    const double y = state ? -1 : 1;

    memcpy(piece.x[state][0], AT(-0.5, y, 0), sizeof(Place));
    memcpy(piece.x[state][1], AT(0.5, y, 0), sizeof(Place));
  }
  AnalyticPieceFinding(&tool, &piece, &worst);
  assert_int_equal(worst.kind, FINDING_PASSED);
}

/* A face of second order, cut from a reference face that is bent to a cylinder and turned as a whole. */
typedef struct {
  ElementType type;
  double      along;  /* angle of the direction in which it is bent, from the first axis of the face; in space */
  double      closes; /* curvature at which pieces on both sides of a middle node lie on each other */
} BentFace;

static void BendFace(const BentFace *face, double curvature, double turn, double x[FACE_MAX_NODES][3])
{
  const Element *element = ElementGet(face->type);
  const double   c = cos(face->along), s  = sin(face->along);
  double         u[FACE_MAX_NODES], least = INFINITY, most = -INFINITY;

  for (int a = 0; a < element->nodes; a++) {
    u[a]  = c * element->node[a][0] + s * element->node[a][1];
    least = fmin(least, u[a]);
    most  = fmax(most, u[a]);
  }
  for (int a = 0; a < element->nodes; a++) {
    const double r = u[a] - 0.5 * (least + most), v = c * element->node[a][1] - s * element->node[a][0];
    const double bent = curvature == 0 ? r : sin(curvature * r) / curvature,
                 up   = curvature == 0 ? 0 : (1 - cos(curvature * r)) / curvature;

    x[a][0] = cos(turn) * bent - sin(turn) * up;
    x[a][1] = element->dim == 1 ? sin(turn) * bent + cos(turn) * up : v;
    x[a][2] = element->dim == 1 ? 0 : sin(turn) * bent + cos(turn) * up;
  }
}

/* Judges a face that is bent from one curvature to another one while it turns as a whole. */
static Finding FoldFace(const BentFace *face, const double curvature[2], double turn)
{
  const int dim = ElementGet(face->type)->dim + 1;
  double    X[FACE_MAX_NODES][3], x[2][FACE_MAX_NODES][3];
  int       node[PIECE_MAX][3], n = PieceDivide(face->type, node);
  Piece     pieces[PIECE_MAX];
  Finding   worst = {.kind = FINDING_NONE};

  BendFace(face, 0, 0, X);
  for (int state = 0; state < 2; state++) BendFace(face, curvature[state], state * turn, x[state]);
  for (int k = 0; k < n; k++) {
    pieces[k] = (Piece){.face = 42};
    for (int a = 0; a < dim; a++) {
      pieces[k].tag[a] = 1 + node[k][a];
      memcpy(pieces[k].X[a], X[node[k][a]], sizeof(Place));
      for (int state = 0; state < 2; state++) memcpy(pieces[k].x[state][a], x[state][node[k][a]], sizeof(Place));
    }
  }
  FoldFinding(dim, n, pieces, &worst);
  return worst;
}

static const BentFace bent_faces[] = {
  {ELEMENT_EDGE3, 0, M_PI},           {ELEMENT_TRI6, 0, 2 * M_PI},
  {ELEMENT_TRI6, M_PI / 2, 2 * M_PI}, {ELEMENT_TRI6, M_PI / 4, 2 * M_PI / sqrt(0.5)},
  {ELEMENT_QUAD9, 0, M_PI},           {ELEMENT_QUAD9, M_PI / 2, M_PI}};
enum { BENT_FACES = sizeof(bent_faces) / sizeof(*bent_faces) };

static void FoldedFacesAreFound(void **context)
{
  (void)context;
  for (int k = 0; k < BENT_FACES; k++) {
    const BentFace *face = &bent_faces[k];

    for (int sign = -1; sign <= 1; sign += 2) {
      for (double turn = 0; turn < 3; turn += 0.5) {
        const double closing[2] = {sign * 0.8 * face->closes, sign * 1.02 * face->closes},
                     jump[2]    = {sign * 0.6 * face->closes, sign * 1.3 * face->closes};
        const Finding worst     = FoldFace(face, closing, turn);

        assert_int_equal(worst.kind, FINDING_FOLDED);
        assert_true(worst.face == 42 && worst.tag[0] > 0 && (worst.tag[1] > 0) == (face->type != ELEMENT_EDGE3));
        assert_int_equal(FoldFace(face, jump, 0).kind, FINDING_FOLDED);
      }
    }
  }
}

/* Faces that are bent nearly as far, in any direction, bent back, bent the other way, and turned at the same time. */
static void BentFacesAreNotFolded(void **context)
{
  (void)context;
  for (int k = 0; k < BENT_FACES; k++) {
    BentFace     face  = bent_faces[k];
    const double along = face.along;

    for (double part = -0.98; part < 1; part += 0.07) {
      for (double turn = 0; turn < 3; turn += 0.5) {
        const double more[2] = {0.6 * part * face.closes, part * face.closes}, less[2] = {more[1], more[0]},
                     other[2] = {part * face.closes, -part * face.closes};

        assert_int_equal(FoldFace(&face, more, turn).kind, FINDING_NONE);
        assert_int_equal(FoldFace(&face, less, turn).kind, FINDING_NONE);
        assert_int_equal(FoldFace(&face, other, 0).kind, FINDING_NONE);
        face.along = along + turn;
        assert_int_equal(FoldFace(&face, (double[2]){0.3 * more[1], 0.5 * more[1]}, turn).kind, FINDING_NONE);
        face.along = along;
      }
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(CrossingsHaveClosedForms),
    cmocka_unit_test(TurningTriangleIsCrossed),
    cmocka_unit_test(EdgesCross),
    cmocka_unit_test(FacesDivideWithTheirNormals),
    cmocka_unit_test(ChordsHaveTheirHeight),
    cmocka_unit_test(HonestStatesHold),
    cmocka_unit_test(PlantedPointsAreFound),
    cmocka_unit_test(PlantedSolidsAreFound),
    cmocka_unit_test(LeapsOverRoundsAreFound),
    cmocka_unit_test(ManyCrossingsAreFollowed),
    cmocka_unit_test(EdgesExplainTheirChords),
    cmocka_unit_test(PlantedFacesAreFound),
    cmocka_unit_test(NormalsAcrossEdges),
    cmocka_unit_test(EdgesAcrossEdgesAreFound),
    cmocka_unit_test(PlantedToolsAreFound),
    cmocka_unit_test(FoldedFacesAreFound),
    cmocka_unit_test(BentFacesAreNotFolded),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
