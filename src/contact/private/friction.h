/* What a pair with friction holds besides its state. Nothing of it is state: FrictionBegin() makes it at the accepted
   displacements, when a step begins.

   The anchor of a slave point is where it was on the master then, a place on a face or in an analytic tool. The slave
   point is off the face by penetration and by the sagitta of the faces. This distance turns with the face. The slip of
   a node is the weighted sum over its points of their other distances to their anchors, so that it is 0 then, and stays
   so where slave and master turn together, whatever the fit makes of the normal. Anchors stay in a step, also through
   new lists, in which their faces are found by tags. What the accepted tractions say besides is kept as lengths, see
   FrictionInput. So the accepted state of friction is the tractions and their multipliers alone, and a step that is
   taken back, or goes on after a restart on other ranks, begins with the same anchors. */
#pragma once
#include "base/petsccompat.h"
#include "frictionfoot.h"
#include "frictionframe.h"
#include "contact/frictionlaw.h"

typedef struct {
  PetscReal automatic; /* penalty of what sticks, where the scene names no elastic slip (force per length and area) */
  PetscReal stiffness; /* traction over elastic slip in this step (force per length and area) */
  /* Of each slave point: its anchor. */
  long      *face;  /* tag; -1: it has none */
  PetscReal *xi;    /* 2: on that face */
  PetscReal *off;   /* 3: from there to the slave point, in the face's frame (length) */
  PetscReal *place; /* 3: in an analytic tool, at its first position (length, in the scene's coordinates) */
  PetscInt  *at;    /* number of the face in the lists in force; -1: not in them */
  /* Of each slave point: its foot and its lever at the last projection. */
  FrictionFoot  *foot;
  FrictionLever *lever;
  PetscInt      *lever_node; /* contact nodes of the levers, as in SlavePoints; -1: not known yet */
  int           *facet;      /* in the point's list; -1: not known yet */
  PetscBool     *known;
  /* Of each slave point: derivatives of its own N over the nodes of its first variation, dim*dim for each node, at the
     last projection. first: -1: not known yet. */
  PetscInt  *first, turns_used, turns_room;
  PetscReal *turns;
  /* Of each slave point, while a tangent is made of terms that share their points: whether a term takes it, and the
     sum of its forces in all terms. */
  PetscBool *taken;
  PetscReal *held; /* 3 */
  /* Of each term, since the step began. */
  PetscBool *anchored;  /* some of its points have anchors */
  PetscReal *kept;      /* 2 lengths */
  PetscReal *grip;      /* 2 components of the multiplier (force per area) */
  PetscReal *heading;   /* 2 components of the slip's direction then; 0 where the node did not slip */
  PetscReal *began;     /* its opening, where it was open (length) */
  PetscReal *pressed;   /* its normal force then */
  PetscInt  *guide;     /* the slave point whose anchor gives the tangents; -1: none */
  int       *axis;      /* of an analytic tool: that which gives the tangents */
  PetscReal *force;     /* 3 for each slave point, in the last residual */
  PetscReal  moment[3]; /* about the origin, of these forces on the master at their feet; of this rank's slave points */
  PetscReal *nodal;     /* 3 for each term: force on the slave node, that of its neighbours on shared faces included */
  PetscReal *elastic;   /* of each term: elastic slip (length) */
  PetscBool *footless;  /* of each term: it presses, and some of its points have no foot or no anchor on the master */
  PetscReal *traction, *status; /* 3 and 1 for each term: what ContactGetNodes() shows */
} *Friction;
