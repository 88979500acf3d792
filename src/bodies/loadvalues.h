/* The values of a load of the scene at nodes and at quadrature points, where they are expressions.

   LoadNodeValue() gives a component of an imposed displacement at a node, LoadPointValues() a pressure, a traction or a
   body force at the quadrature points of a face or a cell. LoadHasExpression() and LoadVaries() tell how often a load
   must be evaluated: once, or at every load parameter t. */
#pragma once
#include "base/complaint.h"
#include "mesh/mesh.h"

/* Room for the values at the quadrature points of one cell or face */
enum { LOAD_MAX_VALUES = 3 * ELEMENT_MAX_POINTS };

PetscBool LoadHasExpression(const SceneLoad *);
PetscBool LoadVaries(const SceneLoad *);
PetscReal LoadNodeValue(Mesh, Scene, const SceneLoad *, int component, PetscInt node, PetscReal t, Complaint *);
int LoadPointValues(Mesh, Scene, const SceneLoad *, const Element *, const PetscInt *nodes, PetscReal t, double *value,
                    Complaint *);
