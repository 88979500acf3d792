/* What the parts of an active set share: its data, and what the laws say of a component. */
#pragma once
#include "contact/activeset.h"

/* With friction so many sets follow each other undamped. Most steps have found theirs by then, and undamped sets that
   have not wander to where rounding leads them: of 5000 small bodies with large friction 121 found no set. */
#define ACTIVE_SET_UNDAMPED 12

struct _n_Pressing {
  PetscInt       n, parts, m, most;
  ActiveSetTerm *terms;
  PetscReal     *travel, *end;  /* parts*n; end: with the excess at hand */
  PetscBool     *pressed;       /* n: the set at hand */
  PetscInt      *column;        /* parts*n; -1: none */
  PetscInt      *term;          /* component of each column */
  PetscReal     *G, *excess;    /* m*parts*n, m */
  PetscReal     *change;        /* m: of the excess, by the last iteration */
  PetscReal      work, allowed; /* products that were computed, and how many may be */
  PetscReal      solves;        /* dense solves with all columns that may be computed, if that is more */
  PetscReal      enough;        /* friction's excess that is no matter, whatever terms can bear (force per area) */
  PetscBool      searches;      /* sets have repeated themselves: each step ends where the energy is least along it */
  PetscBool     *slipped;       /* n: the term slipped where friction was looked at last */
  PetscBool     *sticks;        /* n: its slip has turned round since, so that it is to stick in the next set */
  PetscReal     *slip;          /* 2*n: its slip there (length) */
  PetscBool      damped;    /* sets with friction have repeated themselves: changes are shortened from the first on */
  PetscBool      unrelaxed; /* sets with friction that repeat themselves are not relaxed */
  PetscBool      plain;     /* friction stays as residual and tangent have it */

  /* The way by parts of the step */
  PetscBool  partial;            /* the step may end at a part of itself */
  PetscBool  on_path, left_path; /* it is being gone; it led nowhere */
  PetscReal  part;               /* of the step at which `end` is */
  PetscReal  reached, stride;    /* parts: reached with a right set, and how far from there the next one is tried */
  PetscReal *whole, *kept;       /* travel of the whole step; excess at the part that was reached */
  PetscInt   m_kept, tries;      /* columns in kept; parts that were tried */
};

/* activesetfollow.c */
PetscBool      ActiveSetSpent(ActiveSet);
PetscBool      ActiveSetFollow(ActiveSet);
PetscErrorCode ActiveSetFollowSets(ActiveSet, PetscInt most, PetscInt *m, PetscInt *which, PetscBool *regular,
                                   PetscBool *changed);
PetscInt       ActiveSetMissing(ActiveSet, PetscInt *which);
PetscInt       ActiveSetMissingFriction(ActiveSet, PetscInt *which);
void           ActiveSetLookAtSlips(ActiveSet);
/* activesetpath.c */
PetscErrorCode ActiveSetFollowPath(ActiveSet, PetscInt *m, PetscInt *which, PetscBool *ended);
/* activesetlaw.c */
void      ActiveSetPressureExcess(const ActiveSetTerm *, PetscBool pressed, PetscReal *start, PetscReal *rate);
PetscReal ActiveSetExcess(ActiveSet, PetscInt component, PetscReal by[ACTIVE_SET_PARTS]);
PetscReal ActiveSetNegligible(ActiveSet);
/* activesetrelax.c */
PetscErrorCode ActiveSetRelax(ActiveSet, PetscInt sweeps, PetscBool *settled);
