/* Reference elements: nodes, faces, shape functions and quadrature. Plain C.

   ElementGet() gives the table of a cell, ElementGetFace() that of a face, ElementGetProducts() that of a cell with
   points for products of fields, ElementFromGmsh() translates gmsh's number of an element type. ElementShape()
   evaluates shape functions at any point. ElementCornerType() and ElementRegularSize() know elements by their corners.

   The order of nodes is gmsh's for every element and face (gmsh's manual, "Node ordering"). The nodes of a face are
   listed so that its normal points out of the cell. The normal follows from the order of the nodes by the right-hand
   rule. In 2D the normal of an edge with tangent t is (t_y, -t_x), which is to the right of the direction of travel. */
#pragma once

/* The largest numbers of nodes and quadrature points: hex27 as a cell, quad9 as a face. */
enum { ELEMENT_MAX_NODES = 27, FACE_MAX_NODES = 9, ELEMENT_MAX_POINTS = 27, FACE_MAX_POINTS = 9 };

typedef enum {
  ELEMENT_EDGE2,
  ELEMENT_EDGE3,
  ELEMENT_TRI3,
  ELEMENT_TRI6,
  ELEMENT_QUAD4,
  ELEMENT_QUAD9,
  ELEMENT_TET4,
  ELEMENT_TET10,
  ELEMENT_HEX8,
  ELEMENT_HEX27,
  ELEMENT_TYPES
} ElementType;

typedef struct {
  ElementType type;
  const char *name;
  int         gmsh; /* gmsh's element type number */
  int         xdmf; /* XDMF's topology number */
  int         dim, order, nodes, corners;
  int         faces, face_type; /* faces have the dimension dim - 1; edges have no faces */
  int         face_nodes[6][FACE_MAX_NODES];
  int         edges, edge_corners[12][2];    /* for order 2, node corners + e is the middle of edge e, as in gmsh */
  int         xdmf_order[ELEMENT_MAX_NODES]; /* node i of XDMF is node xdmf_order[i] of this table */
  double      node[ELEMENT_MAX_NODES][3];    /* reference coordinates of the nodes: [-1, 1]^d, or the unit simplex */
  /* Quadrature points for the full integration of the stiffness: tri3 1, tri6 3, quad4 4, quad9 9, tet4 1, tet10 4,
     hex8 8, hex27 27. Edges and faces have the points of the element of that name, but tri3 as a face has 3. */
  int    points;
  double point[ELEMENT_MAX_POINTS][3], weight[ELEMENT_MAX_POINTS];
  double N[ELEMENT_MAX_POINTS][ELEMENT_MAX_NODES];     /* shape functions at the quadrature points */
  double dN[ELEMENT_MAX_POINTS][ELEMENT_MAX_NODES][3]; /* their derivatives by the reference coordinates */
  /* Values at the quadrature points times this matrix are nodal values: a least-squares fit by the shape functions of
     the corners. With one point the fit is a constant. */
  double fit[ELEMENT_MAX_NODES][ELEMENT_MAX_POINTS];
} Element;

/* For ElementGet() alone. */
extern Element element_table[ELEMENT_TYPES];
extern int     element_table_complete;
void           ElementCompleteTable(void);

/*@
  ElementGet - returns the table of a reference element.

  Not collective

  Input Parameter:
. type - the element type

  Output Parameter:
. element - its table, which the caller must not free

  Source:
  gmsh reference manual, "Node ordering"
@*/
static inline const Element *ElementGet(ElementType type)
{
  if (!element_table_complete) ElementCompleteTable();
  return &element_table[type];
}

const Element *ElementGetFace(ElementType);
const Element *ElementGetProducts(ElementType);
const Element *ElementFromGmsh(int gmsh_type);
void           ElementShape(ElementType, const double *xi, double *N, double *dN, double *d2N);
ElementType    ElementCornerType(int dim, int corners);
double         ElementRegularSize(int dim, int corners, double measure);
