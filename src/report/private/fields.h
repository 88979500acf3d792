/* results.vtkhdf and results.xdmf: the states of a run, for ParaView and scripts. Does not know how values were
   computed.

   FieldsCreate() touches no file. The first FieldsWrite() makes the file with the mesh; each one adds a step and writes
   the XDMF text anew, so that the results of a killed run can be opened. FieldsArchive() and FieldsResume() take the
   files back to a checkpoint. Rows are ordered by mesh->node_id, cells by body and cell_id: the same on any number of
   ranks.

     /mesh/nodes             N x 3, reference coordinates (not relative to the mesh's centre)
     /mesh/cells_TYPE        n x nodes of the element, 0-based node ids, in XDMF's node order; TYPE: tri3 ... hex27
     /tools/NAME/            of each rigid tool, analytic ones as PAIR_plane, PAIR_cylinder, PAIR_sphere
       nodes, cells          n x 3; m x nodes of the element; grid_cells: the same, for /VTKHDF
     /mesh/cells_TYPE_body   n, index into the scene's bodies
     /mesh/block_0           the same cells again, a table for each body and type: for ParaView, two of whose three
                             readers cannot read a part of a table
     /contact/PAIR/nodes     n, ids of the slave nodes that carry area, ascending
     /steps/0000             one group per written step, attributes t and step
       displacement          N x 3 (third component 0 in 2D)
       stress, von_mises     N x 6 (xx yy zz xy yz xz, Cauchy), N
       stress_xx ... _xz     N, the columns of stress, as virtual datasets; of other tensors too
       tools/NAME/displacement
                             n x 3, rows as /tools/NAME/nodes
       plastic_strain        N, equivalent; where a body is plastic
       plastic_strain_tensor N x 6, as stress
       contact/PAIR/         gap, penetration, penalty, pressure: n; normal: n x 3; rows as /contact/PAIR/nodes;
                             attribute plane (point, normal), cylinder (point, axis, radius) or sphere (centre, radius)
                             where the master is one
       gap, penetration, penalty, pressure, normal
                             the same for all pairs over the whole mesh, for ParaView: off the slave surfaces gap and
                             penalty are NaN, the others 0
     /VTKHDF, /by_field      the same once more for VTK, without values of its own (vtkhdf.h); results.h5 is a link to
                             results.vtkhdf */
#pragma once
#include "files/archive.h"
#include "solve/model.h"

typedef struct _n_Fields *Fields;

PetscErrorCode FieldsCreate(Model, Scene, const char *directory, Fields *);
PetscErrorCode FieldsDestroy(Fields *);
PetscErrorCode FieldsWrite(Fields, PetscInt step, PetscReal t);
PetscErrorCode FieldsArchive(Fields, Archive);
PetscErrorCode FieldsResume(Fields, PetscBool *lost);
