/* Reference elements. The table below holds what a manual lists: corners, edges, faces and orders. Middle nodes, shape
   functions at quadrature points and fits are derived from it once, on first use. */
#include "kernels/element.h"
#include <math.h>
#include <stddef.h>
#include <string.h>

enum { MAX_CORNERS = 8 };

/* clang-format off */
#define CORNERS_EDGE {{-1, 0, 0}, {1, 0, 0}}
#define CORNERS_TRI  {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}
#define CORNERS_QUAD {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}
#define CORNERS_TET  {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}
#define CORNERS_HEX  {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, \
                      {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}
#define EDGES_EDGE   {{0, 1}}
#define EDGES_TRI    {{0, 1}, {1, 2}, {2, 0}}
#define EDGES_QUAD   {{0, 1}, {1, 2}, {2, 3}, {3, 0}}
#define EDGES_TET    {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}}
#define EDGES_HEX    {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 5}, {2, 3}, {2, 6}, {3, 7}, {4, 5}, {4, 7}, {5, 6}, {6, 7}}
#define FACES_TET    {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {3, 1, 2}}
#define FACES_HEX    {{0, 3, 2, 1}, {0, 1, 5, 4}, {0, 4, 7, 3}, {1, 2, 6, 5}, {2, 3, 7, 6}, {4, 5, 6, 7}}

/* The numbers and orders of XDMF are those of its reader in ParaView. The reader passes the connectivity on to VTK
   without a change. */
Element element_table[ELEMENT_TYPES] = {
  [ELEMENT_EDGE2] = {.type = ELEMENT_EDGE2, .name = "edge2", .gmsh = 1, .xdmf = 2,
                     .dim = 1, .order = 1, .nodes = 2, .corners = 2,
                     .edges = 1, .edge_corners = EDGES_EDGE,
                     .xdmf_order = {0, 1}, .node = CORNERS_EDGE},
  [ELEMENT_EDGE3] = {.type = ELEMENT_EDGE3, .name = "edge3", .gmsh = 8, .xdmf = 34,
                     .dim = 1, .order = 2, .nodes = 3, .corners = 2,
                     .edges = 1, .edge_corners = EDGES_EDGE,
                     .xdmf_order = {0, 1, 2}, .node = CORNERS_EDGE},
  [ELEMENT_TRI3]  = {.type = ELEMENT_TRI3, .name = "tri3", .gmsh = 2, .xdmf = 4,
                     .dim = 2, .order = 1, .nodes = 3, .corners = 3,
                     .faces = 3, .face_type = ELEMENT_EDGE2, .face_nodes = EDGES_TRI,
                     .edges = 3, .edge_corners = EDGES_TRI,
                     .xdmf_order = {0, 1, 2}, .node = CORNERS_TRI},
  [ELEMENT_TRI6]  = {.type = ELEMENT_TRI6, .name = "tri6", .gmsh = 9, .xdmf = 36,
                     .dim = 2, .order = 2, .nodes = 6, .corners = 3,
                     .faces = 3, .face_type = ELEMENT_EDGE3, .face_nodes = EDGES_TRI,
                     .edges = 3, .edge_corners = EDGES_TRI,
                     .xdmf_order = {0, 1, 2, 3, 4, 5}, .node = CORNERS_TRI},
  [ELEMENT_QUAD4] = {.type = ELEMENT_QUAD4, .name = "quad4", .gmsh = 3, .xdmf = 5,
                     .dim = 2, .order = 1, .nodes = 4, .corners = 4,
                     .faces = 4, .face_type = ELEMENT_EDGE2, .face_nodes = EDGES_QUAD,
                     .edges = 4, .edge_corners = EDGES_QUAD,
                     .xdmf_order = {0, 1, 2, 3}, .node = CORNERS_QUAD},
  [ELEMENT_QUAD9] = {.type = ELEMENT_QUAD9, .name = "quad9", .gmsh = 10, .xdmf = 35,
                     .dim = 2, .order = 2, .nodes = 9, .corners = 4,
                     .faces = 4, .face_type = ELEMENT_EDGE3, .face_nodes = EDGES_QUAD,
                     .edges = 4, .edge_corners = EDGES_QUAD,
                     .xdmf_order = {0, 1, 2, 3, 4, 5, 6, 7, 8}, .node = CORNERS_QUAD},
  [ELEMENT_TET4]  = {.type = ELEMENT_TET4, .name = "tet4", .gmsh = 4, .xdmf = 6,
                     .dim = 3, .order = 1, .nodes = 4, .corners = 4,
                     .faces = 4, .face_type = ELEMENT_TRI3, .face_nodes = FACES_TET,
                     .edges = 6, .edge_corners = EDGES_TET,
                     .xdmf_order = {0, 1, 2, 3}, .node = CORNERS_TET},
  [ELEMENT_TET10] = {.type = ELEMENT_TET10, .name = "tet10", .gmsh = 11, .xdmf = 38,
                     .dim = 3, .order = 2, .nodes = 10, .corners = 4,
                     .faces = 4, .face_type = ELEMENT_TRI6, .face_nodes = FACES_TET,
                     .edges = 6, .edge_corners = EDGES_TET,
                     .xdmf_order = {0, 1, 2, 3, 4, 5, 6, 7, 9, 8}, .node = CORNERS_TET},
  [ELEMENT_HEX8]  = {.type = ELEMENT_HEX8, .name = "hex8", .gmsh = 5, .xdmf = 9,
                     .dim = 3, .order = 1, .nodes = 8, .corners = 8,
                     .faces = 6, .face_type = ELEMENT_QUAD4, .face_nodes = FACES_HEX,
                     .edges = 12, .edge_corners = EDGES_HEX,
                     .xdmf_order = {0, 1, 2, 3, 4, 5, 6, 7}, .node = CORNERS_HEX},
  [ELEMENT_HEX27] = {.type = ELEMENT_HEX27, .name = "hex27", .gmsh = 12, .xdmf = 50,
                     .dim = 3, .order = 2, .nodes = 27, .corners = 8,
                     .faces = 6, .face_type = ELEMENT_QUAD9, .face_nodes = FACES_HEX,
                     .edges = 12, .edge_corners = EDGES_HEX,
                     .xdmf_order = {0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15, 22, 23, 21,
                                    24, 20, 25, 26},
                     .node = CORNERS_HEX},
};
/* clang-format on */
static Element face_tri3;    /* tri3 with the quadrature of a face */
static Element product_tet4; /* tet4 with that of tet10 */

static const double gauss2_point = 0.57735026918962576451; /* 1/sqrt(3) */
static const double gauss3_point = 0.77459666924148337704; /* sqrt(3/5) */

static int IsSimplex(const Element *e)
{
  return e->corners == e->dim + 1 && e->dim > 1;
}

static int IsTensor(const Element *e)
{
  return !IsSimplex(e);
}

/* Lagrange polynomial on the nodes -1 and 1 (order 2: -1, 0 and 1) that is 1 at node c, with two derivatives. */
static void ShapeLine(int order, double c, double x, double value[3])
{
  if (order == 1) {
    value[0] = (1 + c * x) / 2;
    value[1] = c / 2;
    value[2] = 0;
  } else if (c == 0) {
    value[0] = 1 - x * x;
    value[1] = -2 * x;
    value[2] = -2;
  } else {
    value[0] = x * (x + c) / 2;
    value[1] = x + c / 2;
    value[2] = 1;
  }
}

static void ShapeTensor(const Element *e, const double *xi, double *N, double *dN, double *d2N)
{
  const int dim = e->dim;

  for (int a = 0; a < e->nodes; a++) {
    double line[3][3] = {{1, 0, 0}, {1, 0, 0}, {1, 0, 0}};

    for (int k = 0; k < dim; k++) ShapeLine(e->order, e->node[a][k], xi[k], line[k]);
    if (N) N[a] = line[0][0] * line[1][0] * line[2][0];
    for (int k = 0; k < dim && dN; k++) dN[a * dim + k] = line[0][k == 0] * line[1][k == 1] * line[2][k == 2];
    for (int k = 0; k < dim && d2N; k++) {
      for (int l = 0; l < dim; l++)
        d2N[(a * dim + k) * dim + l] =
          line[0][(k == 0) + (l == 0)] * line[1][(k == 1) + (l == 1)] * line[2][(k == 2) + (l == 2)];
    }
  }
}

/* With barycentric coordinates L, a corner has L_a (2 L_a - 1) and an edge 4 L_a L_b. First order: a corner has L_a. */
static void ShapeSimplex(const Element *e, const double *xi, double *N, double *dN, double *d2N)
{
  const int dim  = e->dim;
  double    L[4] = {1, 0, 0, 0}, dL[4][3] = {{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

  for (int k = 0; k < dim; k++) {
    L[0] -= xi[k];
    L[k + 1] = xi[k];
  }
  for (int n = 0; n < e->nodes; n++) {
    const int edge = n >= e->corners, a = edge ? e->edge_corners[n - e->corners][0] : n,
              b         = edge ? e->edge_corners[n - e->corners][1] : n;
    const double factor = edge ? 4 : 2; /* of L_a L_b; a corner subtracts L_a */

    if (N) N[n] = e->order == 1 ? L[n] : factor * L[a] * L[b] - (edge ? 0 : L[n]);
    for (int k = 0; k < dim && dN; k++)
      dN[n * dim + k] = e->order == 1 ? dL[n][k] : factor * (dL[a][k] * L[b] + L[a] * dL[b][k]) - (edge ? 0 : dL[n][k]);
    for (int k = 0; k < dim && d2N; k++) {
      for (int l = 0; l < dim; l++)
        d2N[(n * dim + k) * dim + l] = e->order == 1 ? 0 : factor * (dL[a][k] * dL[b][l] + dL[a][l] * dL[b][k]);
    }
  }
}

static void ElementShapeOf(const Element *e, const double *xi, double *N, double *dN, double *d2N)
{
  if (IsTensor(e))
    ShapeTensor(e, xi, N, dN, d2N);
  else
    ShapeSimplex(e, xi, N, dN, d2N);
}

/* Nodes in the middle of edges, faces and the cell are means of the corners around them. */
static void CompleteNodes(Element *e)
{
  int n = e->corners;

  if (e->order == 1) return;
  for (int i = 0; i < e->edges; i++, n++) {
    for (int k = 0; k < 3; k++)
      e->node[n][k] = (e->node[e->edge_corners[i][0]][k] + e->node[e->edge_corners[i][1]][k]) / 2;
  }
  for (int f = 0; f < e->faces && e->type == ELEMENT_HEX27; f++, n++) {
    for (int k = 0; k < 3; k++) e->node[n][k] = (e->node[e->face_nodes[f][0]][k] + e->node[e->face_nodes[f][2]][k]) / 2;
  }
}

static int FindEdge(const Element *e, int a, int b)
{
  for (int i = 0; i < e->edges; i++) {
    if ((e->edge_corners[i][0] == a && e->edge_corners[i][1] == b) ||
        (e->edge_corners[i][0] == b && e->edge_corners[i][1] == a))
      return i;
  }
  return -1;
}

/* Middle nodes of the faces, in the order of the face's element. The table of that element may still be incomplete. */
static void CompleteFaces(Element *e)
{
  const Element *face = &element_table[e->face_type];

  if (e->order == 1) return;
  for (int f = 0; f < e->faces; f++) {
    int *nodes = e->face_nodes[f];

    for (int i = 0; i < face->edges; i++)
      nodes[face->corners + i] =
        e->corners + FindEdge(e, nodes[face->edge_corners[i][0]], nodes[face->edge_corners[i][1]]);
    if (face->type == ELEMENT_QUAD9) nodes[8] = e->corners + e->edges + f;
  }
}

static void SetPoint(Element *e, double x, double y, double z, double weight)
{
  e->point[e->points][0] = x;
  e->point[e->points][1] = y;
  e->point[e->points][2] = z;
  e->weight[e->points++] = weight;
}

static void QuadratureTensor(Element *e)
{
  const int    n    = e->order + 1;
  const double p2[] = {-gauss2_point, gauss2_point}, w2[] = {1, 1}, p3[] = {-gauss3_point, 0, gauss3_point},
               w3[] = {5. / 9, 8. / 9, 5. / 9};
  const double *p = n == 2 ? p2 : p3, *w = n == 2 ? w2 : w3;

  for (int k = 0; k < (e->dim > 2 ? n : 1); k++) {
    for (int j = 0; j < (e->dim > 1 ? n : 1); j++) {
      for (int i = 0; i < n; i++)
        SetPoint(e, p[i], e->dim > 1 ? p[j] : 0, e->dim > 2 ? p[k] : 0,
                 w[i] * (e->dim > 1 ? w[j] : 1) * (e->dim > 2 ? w[k] : 1));
    }
  }
}

/* One point in the middle, or one near each corner, which is exact to degree 2. Source: Zienkiewicz and Taylor, The
   Finite Element Method, tables 5.3 and 5.4. */
static void QuadratureSimplex(Element *e, int points)
{
  const double volume = e->dim == 2 ? 1. / 2 : 1. / 6;
  const double inner  = e->dim == 2 ? 1. / 6 : 0.13819660112501051518,
               outer  = 1 - e->dim * inner; /* tet: (5 - sqrt 5) / 20 */

  if (points == 1)
    SetPoint(e, 1. / (e->dim + 1), 1. / (e->dim + 1), e->dim == 3 ? 0.25 : 0, volume);
  else {
    for (int a = 0; a <= e->dim; a++)
      SetPoint(e, a == 1 ? outer : inner, a == 2 ? outer : inner,
               e->dim < 3 ? 0
               : a == 3   ? outer
                          : inner,
               volume / points);
  }
}

/* Solves the symmetric positive definite n x n system A X = B for m right-hand sides in place, without pivoting. */
static void SolveSmall(int n, double A[][MAX_CORNERS], int m, double B[][ELEMENT_MAX_POINTS])
{
  for (int k = 0; k < n; k++) {
    for (int i = 0; i < n; i++) {
      const double factor = i == k ? 0 : A[i][k] / A[k][k];

      for (int j = k; j < n && i != k; j++) A[i][j] -= factor * A[k][j];
      for (int j = 0; j < m; j++) B[i][j] -= factor * B[k][j];
    }
  }
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < m; j++) B[i][j] /= A[i][i];
  }
}

/* Least-squares fit by the shape functions C of the first-order element: c = (C^T C)^-1 C^T v. The nodal values are
   C(node) c. */
static void Fit(Element *e)
{
  Element linear = *e;
  double  C[ELEMENT_MAX_POINTS][MAX_CORNERS], A[MAX_CORNERS][MAX_CORNERS], B[MAX_CORNERS][ELEMENT_MAX_POINTS];

  memset(e->fit, 0, sizeof(e->fit));
  if (e->points == 1) {
    for (int a = 0; a < e->nodes; a++) e->fit[a][0] = 1;
    return;
  }
  linear.order = 1;
  linear.nodes = e->corners;
  for (int p = 0; p < e->points; p++) ElementShapeOf(&linear, e->point[p], C[p], NULL, NULL);
  for (int i = 0; i < e->corners; i++) {
    for (int p = 0; p < e->points; p++) B[i][p] = C[p][i];
    for (int j = 0; j < e->corners; j++) {
      A[i][j] = 0;
      for (int p = 0; p < e->points; p++) A[i][j] += C[p][i] * C[p][j];
    }
  }
  SolveSmall(e->corners, A, e->points, B);
  for (int a = 0; a < e->nodes; a++) {
    double N[MAX_CORNERS];

    ElementShapeOf(&linear, e->node[a], N, NULL, NULL);
    for (int p = 0; p < e->points; p++) {
      for (int i = 0; i < e->corners; i++) e->fit[a][p] += N[i] * B[i][p];
    }
  }
}

static void Tabulate(Element *e)
{
  for (int p = 0; p < e->points; p++) {
    double dN[ELEMENT_MAX_NODES * 3];

    ElementShapeOf(e, e->point[p], e->N[p], dN, NULL);
    for (int a = 0; a < e->nodes; a++) {
      for (int k = 0; k < e->dim; k++) e->dN[p][a][k] = dN[a * e->dim + k];
    }
  }
  Fit(e);
}

int element_table_complete = 0;

/*@
  ElementCompleteTable - fills in what the tables of reference elements have besides nodes: faces, quadrature, shape
  functions.

  Not collective

  Note:
  ElementGet() calls it. Plain C.
@*/
void ElementCompleteTable(void)
{
  if (element_table_complete) return;
  element_table_complete = 1;
  for (int type = 0; type < ELEMENT_TYPES; type++) {
    Element *e = &element_table[type];

    CompleteNodes(e);
    CompleteFaces(e);
    if (IsTensor(e))
      QuadratureTensor(e);
    else
      QuadratureSimplex(e, e->order == 1 ? 1 : e->dim + 1);
    Tabulate(e);
  }
  face_tri3           = element_table[ELEMENT_TRI3];
  face_tri3.points    = 0;
  product_tet4        = element_table[ELEMENT_TET4];
  product_tet4.points = 0;
  QuadratureSimplex(&face_tri3, 3);
  QuadratureSimplex(&product_tet4, 4);
  Tabulate(&face_tri3);
  Tabulate(&product_tet4);
}

/*@
  ElementGetFace - returns the table of a reference element that is the face of a cell.

  Not collective

  Input Parameter:
. type - an element of dimension 1 or 2

  Output Parameter:
. element - its table, as ElementGet() gives it; tri3 has three quadrature points instead of one

  Note:
  Integrals over faces have products of two shape functions, which one point does not integrate.
@*/
const Element *ElementGetFace(ElementType type)
{
  ElementCompleteTable();
  return type == ELEMENT_TRI3 ? &face_tri3 : &element_table[type];
}

/*@
  ElementGetProducts - returns the table of a reference element with points for products of two fields of which each
  varies as displacements do.

  Not collective

  Input Parameter:
. type - the element type of a cell

  Output Parameter:
. element - its table, as ElementGet() gives it; tri3 has three quadrature points and tet4 four, with equal weights,
            instead of one

  Note:
  One point sees the mean of a field alone.
@*/
const Element *ElementGetProducts(ElementType type)
{
  ElementCompleteTable();
  return type == ELEMENT_TRI3 ? &face_tri3 : type == ELEMENT_TET4 ? &product_tet4 : &element_table[type];
}

/*@
  ElementFromGmsh - returns the reference element of one of gmsh's element types.

  Not collective

  Input Parameter:
. gmsh_type - gmsh's number in its mesh files

  Output Parameter:
. element - the table, or NULL if the type is not supported
@*/
const Element *ElementFromGmsh(int gmsh_type)
{
  ElementCompleteTable();
  for (int type = 0; type < ELEMENT_TYPES; type++) {
    if (element_table[type].gmsh == gmsh_type) return &element_table[type];
  }
  return NULL;
}

/*@
  ElementShape - evaluates shape functions and derivatives at any reference point, inside or outside the element.

  Not collective

  Input Parameters:
+ type - the element type
- xi   - reference coordinates [dim]

  Output Parameters (each may be NULL):
+ N   - values [nodes]
. dN  - derivatives by the reference coordinates [nodes][dim]
- d2N - second derivatives [nodes][dim][dim]
@*/
void ElementShape(ElementType type, const double *xi, double *N, double *dN, double *d2N)
{
  ElementShapeOf(ElementGet(type), xi, N, dN, d2N);
}

/*@
  ElementCornerType - returns the first-order type of a cell or a face, whose nodes are its corners.

  Not collective

  Input Parameters:
+ dim     - of the cell or face, 1 to 3
- corners - it has
@*/
ElementType ElementCornerType(int dim, int corners)
{
  if (dim == 1) return ELEMENT_EDGE2;
  if (dim == 2) return corners == 3 ? ELEMENT_TRI3 : ELEMENT_QUAD4;
  return corners == 4 ? ELEMENT_TET4 : ELEMENT_HEX8;
}

/*@
  ElementRegularSize - returns the length of an edge of the regular element of a measure.

  Not collective

  Input Parameters:
+ dim     - of the element, 1 to 3
. corners - of the element
- measure - its length, area or volume
@*/
double ElementRegularSize(int dim, int corners, double measure)
{
  if (dim == 1) return measure;
  if (dim == 2) return sqrt(corners == 3 ? 4 * measure / sqrt(3) : measure);
  return pow(corners == 4 ? 6 * sqrt(2) * measure : measure, 1 / 3.0);
}
