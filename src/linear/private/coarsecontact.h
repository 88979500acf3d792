/* Contact on the coarse levels of multigrid whose coarse spaces are those of the bodies without contact.

   Aggregates of both bodies of a contact would hold them together where they slide: softest of all are motions in which
   the bodies slide, and multigrid would find them last. With aggregates of their own, bodies move together only against
   contact that is as stiff on a coarse level as the bodies are there; as stiff as on the finest level it would lock
   them the more, the larger aggregates are.

   CoarseContactAdd() adds contact to copies of the coarse matrices or to these themselves. Before multigrid is made for
   another operator, CoarseContactRemove() puts the coarse matrices of the bodies back, of which PETSc makes the next
   ones without their symbolic products. */
#pragma once
#include "base/petsccompat.h"

PetscErrorCode CoarseContactAdd(PC, Mat contact, IS rows, PetscReal softness, int dim, PetscBool keep);
PetscErrorCode CoarseContactRemove(PC);
