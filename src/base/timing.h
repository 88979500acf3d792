/* Wall seconds by purpose, for summary.json; -log_view tells more. Pairs of Begin and End nest: while an inner purpose
   runs the outer one stands still, so that no second counts twice (the search of the set-up is search, not set-up). */
#pragma once

typedef enum {
  TIMING_SETUP,
  TIMING_SEARCH,
  TIMING_FIT,
  TIMING_ASSEMBLY_ELASTIC,
  TIMING_ASSEMBLY_CONTACT,
  TIMING_SOLVE,
  TIMING_OUTPUT,
  TIMING_KINDS
} TimingKind;
extern const char *const TimingNames[];

void   TimingBegin(TimingKind);
void   TimingEnd(TimingKind);     /* also ends what was begun after it and never ended */
double TimingSeconds(TimingKind); /* of what has ended or stood still so far */
