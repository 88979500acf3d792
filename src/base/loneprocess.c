/* The short start of a process that runs alone, see loneprocess.h. */
#include "base/loneprocess.h"
#include <stdlib.h>
#include <string.h>

extern char **environ;

/* How the names of variables begin by which launchers tell a process of its job: PMI and PMIx, Open MPI's mpirun, Hydra
   of MPICH and Intel MPI, Slurm's srun, Cray's aprun. */
static const char *const launchers[] = {"PMI_",       "PMIX_", "OMPI_COMM_WORLD_", "HYDI_", "MPI_LOCAL",
                                        "SLURM_STEP", "ALPS_"};

/* What Open MPI is told instead: start no daemon for processes that are started later, look for no fast network, share
   no file pointers, and make no folder of the session. All such processes would share that folder, and the first that
   ends removes it: of 75 that were started at once 4 failed. */
static const char *const settings[][2] = {{"OMPI_MCA_ess_singleton_isolated", "1"},
                                          {"OMPI_MCA_orte_create_session_dirs", "0"},
                                          {"OMPI_MCA_pml", "ob1"},
                                          {"OMPI_MCA_sharedfp", "individual"}};

/* Did a launcher start this process? */
static int Launched(void)
{
  for (char **variable = environ; variable && *variable; variable++)
    for (size_t i = 0; i < sizeof(launchers) / sizeof(*launchers); i++)
      if (!strncmp(*variable, launchers[i], strlen(launchers[i]))) return 1;
  return 0;
}

/*@
  LoneProcessPrepare - has Open MPI leave out what a process that runs alone does not need.

  Not collective

  Note:
  It is called before MPI_Init(). It spares such a process half of the CPU time of its start. What the user has set
  stays, and so does all where a launcher has started the process. Other MPIs do not read these variables. Plain C.
@*/
void LoneProcessPrepare(void)
{
  if (Launched()) return;
  for (size_t i = 0; i < sizeof(settings) / sizeof(*settings); i++) setenv(settings[i][0], settings[i][1], 0);
}
