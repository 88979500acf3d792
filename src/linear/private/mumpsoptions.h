/* MUMPS's parameters as the user gives them: -mat_mumps_icntl_<number> and -mat_mumps_cntl_<number>, the names of
   PETSc's interface.

   A value outside the range that MUMPS documents is an error, and so is a parameter that this program sets itself or
   that has no effect here. MUMPS would replace the first by its default without a word; some of the others would have
   it read arrays that it was not given. Call MumpsOptionsRead() after MUMPS's start, which sets its defaults. */
#pragma once
#include "base/petsccompat.h"
#include <dmumps_c.h>

/* How many parameters MUMPS has: integers and reals. */
enum { MUMPS_ICNTL = 60, MUMPS_CNTL = 15 };

PetscErrorCode MumpsOptionsRead(MUMPS_INT icntl[MUMPS_ICNTL], DMUMPS_REAL cntl[MUMPS_CNTL]);
