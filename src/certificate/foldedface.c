/* Faces that fold over themselves in a step, see stand.h. */
#include "stand.h"
#include <math.h>
#include <string.h>

/* Two pieces that share all vertices but one: these first, then the other one of each. */
typedef struct {
  int shared[2], other[2]; /* shared: numbers in the first piece; other: in each of both */
} Hinge;

/* Finds what two pieces share. Returns 0 where they are no neighbours. */
static int FindHinge(int dim, const Piece *a, const Piece *b, Hinge *hinge)
{
  int n = 0;

  *hinge = (Hinge){.shared = {0, 0}};
  for (int i = 0; i < dim; i++) {
    if (!HasTag(b, dim, a->tag[i]))
      hinge->other[0] = i;
    else if (n++ < dim - 1)
      hinge->shared[n - 1] = i;
    if (!HasTag(a, dim, b->tag[i])) hinge->other[1] = i;
  }
  return n == dim - 1;
}

/* Keeps that a face has folded about what two of its pieces share. */
static void KeepFolded(int dim, const Piece *piece, const Hinge *hinge, Finding *worst)
{
  Finding finding = {.kind  = FINDING_FOLDED,
                     .ratio = INFINITY,
                     .face  = piece->face,
                     .tag   = {piece->tag[hinge->shared[0]], 0}};

  if (dim == 3) finding.tag[1] = piece->tag[hinge->shared[1]];
  for (int k = 0; k < dim - 1; k++)
    for (int d = 0; d < 3; d++) finding.X[d] += piece->X[hinge->shared[k]][d] / (dim - 1);
  FindingKeep(&finding, worst);
}

/*@
  FoldFinding - judges whether a face has folded over itself in the step.

  Not collective

  Input Parameters:
+ dim    - 2 or 3
. n      - number of its pieces
- pieces - all pieces of the face

  Input/Output Parameter:
. worst - the worst finding so far

  Note:
  Contact never holds two pieces of one face apart. A face whose pieces have turned through each other bends to a loop,
  in which it and its neighbours stand in each other; its tip would explain any depth there.
@*/
void FoldFinding(int dim, int n, const Piece pieces[], Finding *worst)
{
  for (int k = 0; k < n; k++) {
    for (int l = 0; l < k; l++) {
      const Piece *a = &pieces[k], *b = &pieces[l];
      Place        x[2][3];
      Hinge        hinge;

      if (!FindHinge(dim, a, b, &hinge)) continue;
      for (int state = 0; state < 2; state++) {
        for (int i = 0; i < dim - 1; i++) memcpy(x[state][i], a->x[state][hinge.shared[i]], sizeof(Place));
        memcpy(x[state][dim - 1], a->x[state][hinge.other[0]], sizeof(Place));
      }
      if (SweepHinge(dim, (const Place *)x[0], (const Place *)x[1], b->x[0][hinge.other[1]], b->x[1][hinge.other[1]]))
        KeepFolded(dim, a, &hinge, worst);
    }
  }
}
