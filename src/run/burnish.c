/* The public interface of the library: what the user asks for, and what is left of a run. */
#include "burnish.h"
#include <math.h>
#include "base/errorlog.h"
#include "base/explanation.h"
#include "base/refusal.h"
#include "refinement.h"

struct _n_Burnish {
  MPI_Comm   comm;
  RunInput   input;
  char      *scene_file, *directory, *restart; /* owned; input borrows them */
  char      *message;                          /* of the last run; NULL: none */
  char       mesh_file[PETSC_MAX_PATH_LEN];    /* of the last BurnishMesh() */
  int        n_probes;
  char     **probe_name; /* of the last run */
  PetscReal *probe_value;
};

/*@
  BurnishCreate - creates an object that runs scenes.

  Collective

  Input Parameter:
. comm - the ranks that share the work, for instance PETSC_COMM_WORLD

  Output Parameter:
. burnish - the object, freed with BurnishDestroy()

  Note:
  One object runs at a time in a process, because PETSc's options and error handlers belong to the process.
@*/
PetscErrorCode BurnishCreate(MPI_Comm comm, Burnish *burnish)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(burnish));
  (*burnish)->comm = comm;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReplaceText(char **text, const char *by)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(*text));
  PetscCall(PetscStrallocpy(by, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ClearEdits(Burnish burnish)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < burnish->input.n_set; i++) PetscCall(PetscFree(burnish->input.set[i]));
  PetscCall(PetscFree(burnish->input.set));
  burnish->input.n_set = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BurnishSetScene - names the scene file of the next run.

  Logically collective

  Input Parameters:
+ burnish - the object
- file    - scene file (YAML), as rank 0 can open it

  Note:
  Edits by BurnishSet() and a restart by BurnishSetRestart() that belong to an earlier scene are forgotten. The file is
  read by BurnishRun().
@*/
PetscErrorCode BurnishSetScene(Burnish burnish, const char *file)
{
  PetscFunctionBeginUser;
  PetscCall(ClearEdits(burnish));
  PetscCall(ReplaceText(&burnish->restart, NULL));
  PetscCall(ReplaceText(&burnish->scene_file, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BurnishSet - overrides or adds one value of the scene.

  Logically collective

  Input Parameters:
+ burnish   - the object
- key_value - KEY=VALUE, where KEY is the path of the value, such as contact.0.smoother=facet

  Note:
  Edits are made in order, after BurnishSetScene(). A wrong one is refused by BurnishRun(). With BurnishSetRestart()
  only values of output, solver and stepping may be changed.
@*/
PetscErrorCode BurnishSet(Burnish burnish, const char *key_value)
{
  RunInput *input = &burnish->input;
  char    **set;

  PetscFunctionBeginUser;
  PetscCheck(key_value, burnish->comm, PETSC_ERR_ARG_NULL, "BurnishSet() needs KEY=VALUE");
  PetscCall(PetscMalloc1(input->n_set + 1, &set));
  PetscCall(PetscArraycpy(set, input->set, input->n_set));
  PetscCall(PetscStrallocpy(key_value, &set[input->n_set]));
  PetscCall(PetscFree(input->set));
  input->set = set;
  input->n_set++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BurnishSetDirectory - says where the results go.

  Logically collective

  Input Parameters:
+ burnish   - the object
- directory - is made if it does not exist; NULL: out/NAME, where NAME is that of the scene
@*/
PetscErrorCode BurnishSetDirectory(Burnish burnish, const char *directory)
{
  PetscFunctionBeginUser;
  PetscCall(ReplaceText(&burnish->directory, directory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BurnishSetRestart - lets the next run go on from the checkpoint of an earlier one.

  Logically collective

  Input Parameters:
+ burnish   - the object
- directory - of the earlier run, which holds checkpoint.h5; the results go there too

  Note:
  Takes the place of BurnishSetScene(): the scene is that of the checkpoint. The number of ranks may be another one. The
  results go to that directory, whatever BurnishSetDirectory() and BurnishSetOverwrite() say. BurnishCheck() and
  BurnishMesh() refuse a restart.
@*/
PetscErrorCode BurnishSetRestart(Burnish burnish, const char *directory)
{
  PetscFunctionBeginUser;
  PetscCall(BurnishSetScene(burnish, NULL));
  PetscCall(ReplaceText(&burnish->restart, directory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BurnishSetOverwrite - lets a run overwrite the results of another scene in its directory; it is refused otherwise.

  Logically collective

  Input Parameters:
+ burnish   - the object
- overwrite - PETSC_TRUE: may overwrite
@*/
PetscErrorCode BurnishSetOverwrite(Burnish burnish, PetscBool overwrite)
{
  PetscFunctionBeginUser;
  burnish->input.overwrite = overwrite;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BurnishSetQuiet - switches the progress of a run on stdout off; warnings still go to stderr.

  Logically collective

  Input Parameters:
+ burnish - the object
- quiet   - PETSC_TRUE: BurnishRun() prints nothing on stdout
@*/
PetscErrorCode BurnishSetQuiet(Burnish burnish, PetscBool quiet)
{
  PetscFunctionBeginUser;
  burnish->input.quiet = quiet;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BurnishSetTrust - lets scenes load libraries, run programs and write files of their own choice.

  Logically collective

  Input Parameters:
+ burnish - the object
- trust   - PETSC_TRUE: a .geo may use commands such as SystemCall and Save, PETSc options of a scene may name files,
and a body may have a routine of the user's (law: umat)

  Note:
  Without it such a scene is refused as wrong input. Set it for scenes of people whom you trust only.
@*/
PetscErrorCode BurnishSetTrust(Burnish burnish, PetscBool trust)
{
  PetscFunctionBeginUser;
  burnish->input.trust = trust;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forgets what is left of the last run. */
static PetscErrorCode ForgetRun(Burnish burnish)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(burnish->message));
  for (int i = 0; i < burnish->n_probes; i++) PetscCall(PetscFree(burnish->probe_name[i]));
  PetscCall(PetscFree2(burnish->probe_name, burnish->probe_value));
  burnish->n_probes     = 0;
  burnish->mesh_file[0] = '\0';
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps what may be asked for after a run, before its objects are freed. */
static PetscErrorCode KeepRun(Burnish burnish, const Run *run)
{
  const PetscReal *values;

  PetscFunctionBeginUser;
  PetscCall(ReplaceText(&burnish->message, run->message));
  PetscCall(PetscStrncpy(burnish->mesh_file, run->mesh_file, sizeof(burnish->mesh_file)));
  if (!run->results) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ResultsGetProbes(run->results, &values));
  PetscCall(PetscMalloc2(run->scene->n_probes, &burnish->probe_name, run->scene->n_probes, &burnish->probe_value));
  for (int i = 0; i < run->scene->n_probes; i++) {
    PetscCall(PetscStrallocpy(run->scene->probes[i].name, &burnish->probe_name[i]));
    burnish->probe_value[i] = values ? values[i] : NAN;
    burnish->n_probes++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps the message of the refusal, with its code. */
static PetscErrorCode TakeRefusal(Burnish burnish)
{
  char  *message;
  size_t length;

  PetscFunctionBeginUser;
  PetscCall(RefusalTake(&message));
  PetscCall(PetscStrlen(message, &length));
  PetscCall(PetscMalloc1(length + EXPLANATION_ROOM, &burnish->message));
  PetscCall(PetscStrncpy(burnish->message, message, length + EXPLANATION_ROOM));
  ExplanationAppend(burnish->message, length + EXPLANATION_ROOM, EXPLANATION_INPUT);
  PetscCall(PetscFree(message));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Runs what the user asks for and turns a refusal into its status. After another error nothing that is collective may
   be called, because the other ranks may be elsewhere: the run's objects stay. */
static PetscErrorCode Execute(Burnish burnish, RunTask task, BurnishStatus *status)
{
  RunInput       input = burnish->input;
  Run            run   = {.comm = burnish->comm};
  PetscErrorCode code;

  PetscFunctionBeginUser;
  input.task      = task;
  input.scene     = burnish->scene_file;
  input.directory = burnish->directory;
  input.restart   = burnish->restart;
  PetscCall(ForgetRun(burnish));
  PetscCall(ErrorLogBegin());
  TimingReset();
  code = RunScene(&run, &input, status);
  if (!code && run.refines && *status == BURNISH_DONE) code = RefinementRun(&run, &input, status);
  if (!code) code = KeepRun(burnish, &run);
  if (code == REFUSED && RefusalIsPending()) {
    *status = BURNISH_WRONG_INPUT;
    code    = TakeRefusal(burnish);
  }
  if (!code) code = RunDestroy(&run);
  if (code) {
    *status = BURNISH_FAILED;
    PetscCall(ReplaceText(&burnish->message, ErrorLogMessage()));
  }
  PetscCall(ErrorLogEnd());
  PetscFunctionReturn(code);
}

/*@
  BurnishRun - runs the scene from its file to its results.

  Collective

  Input Parameter:
. burnish - the object, with a scene from BurnishSetScene() or a restart from BurnishSetRestart()

  Output Parameter:
. status - how the run ended, the same on all ranks unless it is BURNISH_FAILED

  Note:
  Returns a code other than 0, with the status BURNISH_FAILED, for internal errors and failures of the machine only. The
  trace is then in error.log of the directory, and the objects of the run are not freed, because other ranks may still
  be at work. In all other cases everything is freed but what BurnishGetMessage() and BurnishGetProbe() give.
@*/
PetscErrorCode BurnishRun(Burnish burnish, BurnishStatus *status)
{
  PetscErrorCode code;

  PetscFunctionBeginUser;
  code = Execute(burnish, RUN_SOLVE, status);
  PetscFunctionReturn(code);
}

/*@
  BurnishCheck - reads, meshes and validates the scene, and reports on stdout; solves nothing and writes no results.

  Collective

  Input Parameter:
. burnish - the object

  Output Parameter:
. status - BURNISH_DONE or BURNISH_WRONG_INPUT

  Note:
  See BurnishRun() for the code that is returned.
@*/
PetscErrorCode BurnishCheck(Burnish burnish, BurnishStatus *status)
{
  PetscErrorCode code;

  PetscFunctionBeginUser;
  code = Execute(burnish, RUN_CHECK, status);
  PetscFunctionReturn(code);
}

/*@
  BurnishMesh - makes the mesh file of the scene and nothing else.

  Collective

  Input Parameter:
. burnish - the object

  Output Parameters:
+ status - BURNISH_DONE or BURNISH_WRONG_INPUT
- file   - path of the mesh file; valid until the next run

  Note:
  See BurnishRun() for the code that is returned.
@*/
PetscErrorCode BurnishMesh(Burnish burnish, BurnishStatus *status, const char **file)
{
  PetscErrorCode code;

  PetscFunctionBeginUser;
  code  = Execute(burnish, RUN_MESH, status);
  *file = burnish->mesh_file;
  PetscFunctionReturn(code);
}

/*@
  BurnishGetMessage - says in words why the last run did not end with BURNISH_DONE.

  Not collective

  Input Parameter:
. burnish - the object

  Output Parameter:
. message - empty after BURNISH_DONE, the same on all ranks unless a rank had an internal error; valid until the next
run
@*/
PetscErrorCode BurnishGetMessage(Burnish burnish, const char **message)
{
  PetscFunctionBeginUser;
  *message = burnish->message ? burnish->message : "";
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  BurnishGetProbe - gives the value of a probe after the last accepted load step of the last run.

  Not collective

  Input Parameters:
+ burnish - the object, after BurnishRun()
- name    - of the probe in the scene

  Output Parameter:
. value - the same on all ranks, in the scene's units; NaN where the probe has no value, for instance without contact

  Note:
  Errors: PETSC_ERR_ARG_OUTOFRANGE if the last run has no probe of this name.
@*/
PetscErrorCode BurnishGetProbe(Burnish burnish, const char *name, PetscReal *value)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < burnish->n_probes; i++) {
    PetscBool same;

    PetscCall(PetscStrcmp(name, burnish->probe_name[i], &same));
    if (!same) continue;
    *value = burnish->probe_value[i];
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "The last run has no probe %s", name);
}

/*@
  BurnishDestroy - frees the object.

  Collective

  Input Parameter:
. burnish - is NULL afterwards
@*/
PetscErrorCode BurnishDestroy(Burnish *burnish)
{
  PetscFunctionBeginUser;
  if (!*burnish) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ForgetRun(*burnish));
  PetscCall(ClearEdits(*burnish));
  PetscCall(PetscFree((*burnish)->scene_file));
  PetscCall(PetscFree((*burnish)->directory));
  PetscCall(PetscFree((*burnish)->restart));
  PetscCall(PetscFree(*burnish));
  PetscFunctionReturn(PETSC_SUCCESS);
}
