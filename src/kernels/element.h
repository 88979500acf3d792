/* Reference elements: nodes, faces, shape functions, quadrature. Plain C. Node order is gmsh's (its manual, "Node
   ordering"), for every element and face; faces are listed with their nodes so that the face's own normal (from its
   node order, right-hand rule; in 2D (t_y, -t_x) for tangent t: to the right of the direction of travel) points out of
   the cell. */
#pragma once

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
  int         faces, face_type; /* facets of dimension dim - 1 (0 for edges' end points: faces = 0) */
  int         face_nodes[6][FACE_MAX_NODES];
  int         edges, edge_corners[12][2];    /* order 2: node corners + e is the middle of edge e, as in gmsh */
  int         xdmf_order[ELEMENT_MAX_NODES]; /* node i of XDMF is our node xdmf_order[i] */
  double      node[ELEMENT_MAX_NODES][3];    /* reference coordinates of the nodes: [-1, 1]^d, or the unit simplex */
  int points; /* quadrature: full integration of the element stiffness (tri3 1, tri6 3, quad4 4, quad9 9, tet4 1, tet10
                 4, hex8 8, hex27 27; edges and faces as the element of that name, tri3 as a face 3 points) */
  double point[ELEMENT_MAX_POINTS][3], weight[ELEMENT_MAX_POINTS];
  double N[ELEMENT_MAX_POINTS][ELEMENT_MAX_NODES];     /* at the quadrature points */
  double dN[ELEMENT_MAX_POINTS][ELEMENT_MAX_NODES][3]; /* d/d(reference coordinate) */
  double fit[ELEMENT_MAX_NODES][ELEMENT_MAX_POINTS]; /* nodal value of the least-squares fit to values at the quadrature
                                                        points, by the corner shape functions (one point: a constant) */
} Element;

const Element *ElementGet(ElementType);
const Element *ElementGetFace(
  ElementType); /* the same with the quadrature of a face: tri3 with 3 points instead of 1 */
const Element *ElementFromGmsh(int gmsh_type); /* NULL: not one of ours */

/* Shape functions at any reference point. N[nodes], dN[nodes*dim] (node major) and d2N[nodes*dim*dim] may each be NULL.
 */
void ElementShape(ElementType, const double *xi, double *N, double *dN, double *d2N);
