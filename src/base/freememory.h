/* Memory that is free in the process and not in the system.

   Libraries that PETSc may come with (SuperLU_DIST) switch off, for all of a program, that large arrays which are freed
   go back to the system. To switch it on again costs a direct solver 6 % of its time in fresh pages, because its fronts
   come and go all the time. FreeMemoryReturn() is therefore called where much has been freed for long. The iterative
   solver, whose large arrays are few, switches it on with FreeMemoryAtOnce(): arrays of the elements and of the contact
   interface come and go once in each iteration of Newton's method, and smaller ones would creep into the holes. */
#pragma once

void FreeMemoryReturn(void);
void FreeMemoryAtOnce(void);
