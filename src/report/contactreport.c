/* What -check says of the contact pairs, see contactreport.h. */
#include "contactreport.h"

/* Errors below this part of a face size are round-off. */
#define REPORT_ROUND_OFF 1e-9

static double PrintableGap(PetscReal value, PetscReal size)
{
  return PetscAbsReal(value) <= REPORT_ROUND_OFF * size ? 0 : (double)value;
}

static void PrintFits(const ContactFits *fits, PetscReal size, FILE *file)
{
  fprintf(file, "           facet error %.3g, smoothing error %.3g (lengths)\n", PrintableGap(fits->facet_error, size),
          PrintableGap(fits->smoothing_error, size));
  fprintf(file,
          "           neighbours %" PetscInt_FMT " to %" PetscInt_FMT
          ", mean %.1f; smallest pivot %.3g, largest amplification %.3g\n",
          fits->neighbours_min, fits->neighbours_max, (double)fits->neighbours_mean, (double)fits->pivot,
          (double)fits->amplified);
  fprintf(file,
          "           fits of %" PetscInt_FMT " slave points: plain %" PetscInt_FMT ", wider %" PetscInt_FMT
          ", degree 2 %" PetscInt_FMT ", linear %" PetscInt_FMT ", facets %" PetscInt_FMT "\n",
          fits->points, fits->plain, fits->wider, fits->degree_2, fits->linear, fits->facets);
}

static void PrintGaps(const ContactGaps *gaps, FILE *file)
{
  fprintf(file, "           before any load: %" PetscInt_FMT " of %" PetscInt_FMT " slave nodes near the master",
          gaps->near, gaps->nodes);
  if (!gaps->near) {
    fprintf(file, " (contact must come by motion)\n");
    return;
  }
  fprintf(file, ", gaps %.3g to %.3g, nearest node %" PetscInt_FMT " (%.6g, %.6g, %.6g)\n", (double)gaps->least,
          (double)gaps->most, gaps->deepest.tag, (double)gaps->deepest.X[0], (double)gaps->deepest.X[1],
          (double)gaps->deepest.X[2]);
  if (gaps->overlapping)
    fprintf(file,
            "           overlap: %" PetscInt_FMT
            " nodes, area %.4g; deeper than the facets' own shape explains: %" PetscInt_FMT " nodes\n",
            gaps->overlapping, (double)gaps->area, gaps->refused);
}

static void PrintSides(const ContactQuality *quality, FILE *file)
{
  if (quality->turned)
    fprintf(file, "           the normals of %" PetscInt_FMT " faces of the rigid master were turned\n",
            quality->turned);
  if (quality->averse)
    fprintf(file,
            "           %" PetscInt_FMT " of %" PetscInt_FMT
            " slave points near the master do not face it and take no part\n",
            quality->averse, quality->near);
}

static void PrintJoined(PetscInt nodes, const ContactPlace *place, FILE *file)
{
  if (!nodes) return;
  fprintf(file,
          "           slave and master have %" PetscInt_FMT " node%s in common, as node %" PetscInt_FMT
          " (%.6g, %.6g, %.6g): there they never part\n",
          nodes, nodes > 1 ? "s" : "", place->tag, (double)place->X[0], (double)place->X[1], (double)place->X[2]);
}

static void PrintPenalty(const SceneContact *scene, PetscReal penalty, FILE *file)
{
  fprintf(file, "           penalty %.6g (force per length and area), %s times %g\n", (double)penalty,
          scene->penalty_auto ? "automatic" : "as given", scene->penalty_scale);
  if (scene->adjust)
    fprintf(file, "           adjusted %s to penetrations of %.3g to %.3g %s\n",
            scene->adjust_converged ? "within the step" : "from step to step", scene->g_min, scene->g_max,
            scene->window_in_spacings ? "face sizes of the slave node" : "(lengths)");
  if (scene->augment)
    fprintf(file, "           augmented to penetrations of %.3g %s, up to %d times in a step\n", scene->g_max,
            scene->window_in_spacings ? "face sizes of the slave node" : "(lengths)", scene->max_updates);
}

/*@
  ContactReport - prints one block of lines for each pair: surfaces, penalty, gaps and overlaps, errors of the master's
  surface, fits.

  Collective

  Input Parameters:
+ contact - in the state before any load
- file    - of rank 0, which prints
@*/
PetscErrorCode ContactReport(Contact contact, FILE *file)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < ContactPairs(contact); p++) {
    PetscReal        least, most, size;
    const MeshGroup *slave;
    PetscMPIInt      rank;
    ContactFits      fits;
    ContactGaps      gaps;
    ContactQuality   quality;
    PetscInt         joined;
    ContactPlace     place;
    char             text[512];

    PetscCallMPI(MPI_Comm_rank(ContactComm(contact), &rank));
    PetscCall(ContactPairPenalty(contact, p, &least, &most));
    PetscCall(ContactPairGaps(contact, p, &gaps));
    PetscCall(ContactPairQuality(contact, p, &quality));
    PetscCall(ContactPairFits(contact, p, &fits));
    PetscCall(ContactPairJoined(contact, p, &joined, &place));
    PetscCall(ContactPairSurface(contact, p, &slave, &size));
    if (rank) continue;
    PetscCall(ContactPairText(contact, p, text, sizeof(text)));
    fprintf(file, "contact  %s: %s\n", ContactPairName(contact, p), text);
    PrintPenalty(ContactPairScene(contact, p), most, file);
    PrintGaps(&gaps, file);
    PrintSides(&quality, file);
    PrintJoined(joined, &place, file);
    if (fits.points)
      PrintFits(&fits, size, file);
    else if (quality.sagitta > 0)
      fprintf(file,
              "           facet error about %.3g (length; sagitta of the master's facets over the curve that their "
              "normals turn along)\n",
              (double)quality.sagitta);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
