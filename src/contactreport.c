#include "contactreport.h"

static PetscErrorCode ReportFits(MPI_Comm comm, const ContactFits *fits, FILE *file)
{
  PetscFunctionBeginUser;
  PetscCall(
    PetscFPrintf(comm, file, "           facet error %.3g, smoothing error %.3g (lengths)\n", (double)fits->facet_error, (double)fits->smoothing_error));
  PetscCall(PetscFPrintf(comm, file,
                         "           neighbours %" PetscInt_FMT " to %" PetscInt_FMT ", mean %.1f; smallest pivot %.3g, largest amplification %.3g\n",
                         fits->neighbours_min, fits->neighbours_max, (double)fits->neighbours_mean, (double)fits->pivot, (double)fits->amplified));
  PetscCall(PetscFPrintf(comm, file,
                         "           fits of %" PetscInt_FMT " slave points: plain %" PetscInt_FMT ", wider %" PetscInt_FMT ", degree 2 %" PetscInt_FMT
                         ", linear %" PetscInt_FMT ", facets %" PetscInt_FMT "\n",
                         fits->points, fits->plain, fits->wider, fits->degree_2, fits->linear, fits->facets));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReportWindow(MPI_Comm comm, const SceneContact *scene, FILE *file)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFPrintf(comm, file, "           adjusted %s to penetrations of %.3g to %.3g %s\n",
                         scene->adjust_converged ? "within the step" : "from step to step", scene->g_min, scene->g_max,
                         scene->window_in_spacings ? "face sizes of the slave node" : "(lengths)"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactReport(Contact contact, FILE *file)
{
  const MPI_Comm comm = ContactComm(contact);

  PetscFunctionBeginUser;
  for (int p = 0; p < ContactPairs(contact); p++) {
    PetscReal   least, most, gap[2];
    ContactFits fits;

    PetscCall(ContactPairPenalty(contact, p, &least, &most));
    PetscCall(ContactPairGaps(contact, p, &gap[0], &gap[1]));
    PetscCall(ContactPairFits(contact, p, &fits));
    PetscCall(PetscFPrintf(comm, file, "contact  %s: %s\n", ContactPairName(contact, p), ContactPairText(contact, p)));
    PetscCall(PetscFPrintf(comm, file, "           penalty %.6g (force per length and area); gaps before any load %.3g to %.3g\n", (double)most, (double)gap[0],
                           (double)gap[1]));
    if (ContactPairScene(contact, p)->adjust) PetscCall(ReportWindow(comm, ContactPairScene(contact, p), file));
    if (fits.points) PetscCall(ReportFits(comm, &fits, file));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
