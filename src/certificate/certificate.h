/* The certificate of a run: between two accepted states, along the straight motion of all points, and on the faces that
   the results show, nothing passed through anything unseen.

   For each contact pair, and from both of its sides:
   - no point has passed a face of the other side without a contact term having carried it
   - no two faces cross deeper than `certificate.penetration`, less what the shape of faces explains
   - in space, no edge has crossed an edge
   - no face folds over itself

   CertificateCheck() judges a converged solution against the accepted state before it. CertificateGetFigures() gives
   what was found over the run. The certificate only reads; a run with it has the same solution as one without it, but
   where a step was cut. */
#pragma once
#include "contact/contact.h"

typedef struct _n_Certificate *Certificate;

typedef struct {
  PetscInt  steps, refused; /* steps that were judged; of these, those that did not hold */
  PetscReal over_h;         /* largest depth, less what geometry explains, over the size of the smaller face */
  PetscReal ratio;          /* largest depth of a step that holds, over what is allowed */
  PetscReal force, moment;  /* largest parts of the outer forces and moments that are out of balance, forcebalance.h */
} CertificateFigures;

PetscErrorCode CertificateCreate(Mesh, Scene, Loads, Contact, Certificate *);
PetscErrorCode CertificateDestroy(Certificate *);
PetscErrorCode CertificateCheck(Certificate, const PetscReal *u_0, PetscReal t_0, const PetscReal *u, PetscReal t,
                                PetscBool *holds, PetscReal *excess, char *text, size_t size);
void           CertificateBalance(Certificate, PetscReal force, PetscReal moment);
void           CertificateGetFigures(Certificate, CertificateFigures *);
PetscErrorCode CertificateArchive(Certificate, Archive);
