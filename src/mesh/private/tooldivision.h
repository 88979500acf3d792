/* Divides long faces of a rigid tool that lie beside short ones in one curved surface.

   A tool is drawn with few faces where it is flat and with many in its fillets: a wall of one line, a profile that is
   extruded in one layer. As a surface of facets that is exact, but no smooth surface can be fitted through such nodes.
   A division moves no point of the facets. It gives the fit nodes of even distances. */
#pragma once
#include "mesh/meshdata.h"

PetscErrorCode ToolDivide(int dim, MeshRigid *, PetscInt *node_tag, PetscInt *face_tag);
