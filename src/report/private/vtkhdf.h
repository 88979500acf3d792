/* The VTKHDF part of results.vtkhdf, through which VTK, ParaView and PyVista read the file: the groups /VTKHDF and
   /by_field.

   VtkHdfUpdate() adds the last step. The part holds no values of its own: its arrays are virtual datasets, which HDF5
   puts together from the datasets of the steps. All bodies and tools are one unstructured grid; the cell array `body`
   tells them apart. Nodes of tools have displacements, and NaN in the other arrays. A symmetric tensor is there as an
   array of six columns in VTK's order and as six arrays of one column.

   Format: VTKHDF 2.0, UnstructuredGrid with a mesh that does not change and data over time (VTK's documentation,
   "VTKHDF File Format"). */
#pragma once
#include "fieldsindex.h"

PetscErrorCode VtkHdfUpdate(const FieldsIndex *, const char *file);
