/* Arguments of the program, its help and its version, see commandline.h. */
#include "scene/commandline.h"
#include "base/blas.h"
#include "schema.h"
#include <stdlib.h>
#include <string.h>

static const char Usage[] =
  "usage: burnish [-check | -mesh] SCENE.yaml [-o DIR] [-set KEY=VALUE]... [-overwrite] [-quiet] [-trust] [PETSc "
  "options]\n"
  "       burnish -restart DIR [-set KEY=VALUE]... [-quiet] [-trust] [PETSc options]\n"
  "       burnish -import DECK.inp [SCENE.yaml]\n"
  "       burnish -evaluate DIR PROBES.yaml\n"
  "       burnish -explain CODE\n"
  "       burnish -help | -version";

/* Keeps a complaint with the usage, unless an earlier argument has caused one already. */
static void CommandLineComplain(CommandLine *line, const char *what, const char *about)
{
  if (line->complaint[0]) return;
  snprintf(line->complaint, sizeof line->complaint, "%.300s: %s [B120]\n%s", about, what, Usage);
}

static int IsOption(const char *word)
{
  return word[0] == '-';
}

static int IsOneOf(const char *word, const char *a, const char *b, const char *c)
{
  return !strcmp(word, a) || !strcmp(word, b) || !strcmp(word, c);
}

static int IsSceneFile(const char *word)
{
  const char *dot = strrchr(word, '.');

  return dot && (!strcmp(dot, ".yaml") || !strcmp(dot, ".yml"));
}

/* Returns the value of option argv[*i] and advances *i to it. Returns NULL after a complaint. */
static char *CommandLineValue(CommandLine *line, int argc, char **argv, int *i, const char *what)
{
  if (*i + 1 < argc && argv[*i + 1][0] && !IsOption(argv[*i + 1])) return argv[++*i];
  CommandLineComplain(line, what, argv[*i]);
  return NULL;
}

static void CommandLineSetScene(CommandLine *line, char *word)
{
  if (line->scene)
    CommandLineComplain(line, "a second scene file; one run takes one", word);
  else
    line->scene = word;
}

static void CommandLineSetMode(CommandLine *line, CommandMode mode, const char *word)
{
  if (line->mode != COMMAND_RUN && line->mode != mode) CommandLineComplain(line, "only one of -check and -mesh", word);
  line->mode = mode;
}

static void CommandLineSetLimit(CommandLine *line, const char *value)
{
  char *end;

  if (!value) return;
  line->time_limit = strtod(value, &end);
  if (*end || !(line->time_limit > 0)) CommandLineComplain(line, "-time_limit needs seconds, more than 0", value);
}

/* Makes edits of the scene of -to 1% and -probe NAME. */
static void CommandLineSetAccuracy(CommandLine *line, const char *word, const char *value)
{
  char        *edit = line->accuracy[word[1] == 'p'];
  const size_t room = sizeof line->accuracy[0];

  if (!value) return;
  if (edit[0]) CommandLineComplain(line, "given twice", word);
  if (snprintf(edit, room, "accuracy.%s=%s", word + 1, value) >= (int)room)
    CommandLineComplain(line, "is too long", value);
  if (word[1] == 't' && edit[strlen(edit) - 1] == '%') edit[strlen(edit) - 1] = 0;
  line->set[line->n_set++] = edit;
}

/* Makes an edit of the scene of -sensitivity PROBE:KEY. */
static void CommandLineAddSensitivity(CommandLine *line, const char *value)
{
  char *edit = line->sensitivity[line->n_sensitivities];

  if (!value) return;
  if (snprintf(edit, sizeof line->sensitivity[0], "sensitivity.%d=%s", line->n_sensitivities, value) >=
      (int)sizeof line->sensitivity[0])
    CommandLineComplain(line, "is too long", value);
  line->n_sensitivities++;
  line->set[line->n_set++] = edit;
}

/* Complains of options that exclude each other, and of a missing scene file. */
static void CommandLineCheck(CommandLine *line)
{
  if (line->restart && line->scene)
    CommandLineComplain(line, "-restart goes on with the scene of its checkpoint; leave the scene file out",
                        line->scene);
  if (line->restart && line->directory)
    CommandLineComplain(line, "-restart goes on in its own directory; leave -o out", line->directory);
  if (line->restart && line->overwrite)
    CommandLineComplain(line, "goes without -restart, which overwrites nothing", "-overwrite");
  if (line->restart && line->mode != COMMAND_RUN)
    CommandLineComplain(line, "goes without -check and -mesh", "-restart");
  if (line->mode == COMMAND_IMPORT && (line->restart || line->directory || line->n_set))
    CommandLineComplain(line, "goes with a deck and the name of a scene only", "-import");
  if (line->mode == COMMAND_EVALUATE && (line->restart || line->directory || line->n_set))
    CommandLineComplain(line, "goes with the directory of a run and a file of probes only", "-evaluate");
  if (line->mode == COMMAND_EXPLAIN && line->scene) CommandLineComplain(line, "goes without a scene", "-explain");
  if (!line->restart && !line->scene && line->mode != COMMAND_IMPORT && line->mode != COMMAND_EXPLAIN)
    CommandLineComplain(line, "no scene file", "command line");
}

/* Takes argv[*i] with its value if it is an option of Burnish. Returns 0 if it is none. */
static int CommandLineOption(CommandLine *line, int argc, char **argv, int *i)
{
  const char *word = argv[*i];
  char       *value;

  if (!strcmp(word, "-o")) {
    if (line->directory) CommandLineComplain(line, "given twice", word);
    line->directory = CommandLineValue(line, argc, argv, i, "needs a directory");
  } else if (!strcmp(word, "-set")) {
    value = CommandLineValue(line, argc, argv, i, "needs KEY=VALUE, such as contact.0.smoother=facet");
    if (value && (value[0] == '=' || !strchr(value, '=')))
      CommandLineComplain(line, "-set needs KEY=VALUE, such as contact.0.smoother=facet", value);
    line->set[line->n_set++] = value;
  } else if (!strcmp(word, "-to") || !strcmp(word, "-probe")) {
    CommandLineSetAccuracy(line, word, CommandLineValue(line, argc, argv, i, "needs an error in per cent, or a probe"));
  } else if (!strcmp(word, "-sensitivity")) {
    CommandLineAddSensitivity(line, CommandLineValue(line, argc, argv, i, "needs PROBE:KEY or PROBE:KEY,KEY"));
  } else if (!strcmp(word, "-check") || !strcmp(word, "-mesh")) {
    CommandLineSetMode(line, word[1] == 'c' ? COMMAND_CHECK : COMMAND_MESH, word);
    if (*i + 1 < argc && !IsOption(argv[*i + 1])) CommandLineSetScene(line, argv[++*i]);
  } else if (!strcmp(word, "-overwrite")) {
    line->overwrite = 1;
  } else if (!strcmp(word, "-quiet")) {
    line->quiet = 1;
  } else if (!strcmp(word, "-trust")) {
    line->trust = 1;
  } else if (!strcmp(word, "-restart")) {
    line->restart = CommandLineValue(line, argc, argv, i, "needs the directory of a run");
  } else if (!strcmp(word, "-import")) {
    line->mode = COMMAND_IMPORT;
    line->deck = CommandLineValue(line, argc, argv, i, "needs a deck of Abaqus or CalculiX (.inp)");
  } else if (!strcmp(word, "-evaluate")) {
    line->mode    = COMMAND_EVALUATE;
    line->results = CommandLineValue(line, argc, argv, i, "needs the directory of a run");
  } else if (!strcmp(word, "-explain")) {
    line->mode = COMMAND_EXPLAIN;
    line->code = CommandLineValue(line, argc, argv, i, "needs the code at the end of a message, such as B202, or all");
  } else if (!strcmp(word, "-time_limit")) {
    CommandLineSetLimit(line, CommandLineValue(line, argc, argv, i, "needs seconds"));
  } else
    return 0;
  return 1;
}

/*@
  CommandLineParse - sorts the arguments into those of Burnish and those of PETSc.

  Not collective

  Input Parameters:
+ argc - number of arguments
- argv - arguments, the program's name first; they must live longer than the result, which points into them

  Output Parameter:
. line - the sorted arguments, to be freed with CommandLineDestroy()

  Note:
  Plain C, to be called before MPI starts. It never prints. A mistake is described in line->complaint, and PETSc then
  gets no argument but the program's name.

  A bare word that ends in .yaml or .yml and follows no PETSc option is the scene file. If such a word follows a PETSc
  option, it may be the value of that option. It is therefore the scene file only if there is no other one. Other bare
  words after a PETSc option are its values and stay in line->argv.
@*/
void CommandLineParse(int argc, char **argv, CommandLine *line)
{
  int maybe = 0; /* index in line->argv of a word that is the scene file or the value of the option before it */

  memset(line, 0, sizeof *line);
  line->set         = calloc((size_t)argc + 1, sizeof *line->set);
  line->sensitivity = calloc((size_t)argc + 1, sizeof *line->sensitivity);
  line->argv        = calloc((size_t)argc + 1, sizeof *line->argv);
  if (!line->set || !line->argv || !line->sensitivity) {
    CommandLineComplain(line, "out of memory", "command line");
    return;
  }
  line->argv[line->argc++] = argv[0];
  for (int i = 1; i < argc; i++) {
    const int value = i > 1 && line->argc > 1 && line->argv[line->argc - 1] == argv[i - 1] && IsOption(argv[i - 1]);

    if (IsOneOf(argv[i], "-help", "--help", "-h") || IsOneOf(argv[i], "-version", "--version", "-v")) {
      line->mode         = strstr(argv[i], "-h") ? COMMAND_HELP : COMMAND_VERSION;
      line->argc         = 1;
      line->complaint[0] = 0;
      line->argv[1]      = NULL;
      return;
    }
    if (CommandLineOption(line, argc, argv, &i)) continue;
    if (!IsOption(argv[i]) && !value) {
      if (IsSceneFile(argv[i]))
        CommandLineSetScene(line, argv[i]);
      else
        CommandLineComplain(line, "neither an option nor a scene file (.yaml or .yml)", argv[i]);
      continue;
    }
    if (value && !maybe && IsSceneFile(argv[i])) maybe = line->argc;
    line->argv[line->argc++] = argv[i];
  }
  if (!line->scene && !line->restart && maybe) {
    line->scene = line->argv[maybe];
    memmove(line->argv + maybe, line->argv + maybe + 1, (size_t)(line->argc - maybe) * sizeof *line->argv);
    line->argc--;
  }
  CommandLineCheck(line);
  if (line->complaint[0]) {
    line->argc    = 1;
    line->argv[1] = NULL;
  }
}

/*@
  CommandLineDestroy - frees the lists that CommandLineParse() has made.

  Not collective

  Input Parameter:
. line - from CommandLineParse()

  Note:
  It must be called after PetscFinalize(), which still reads line->argv.
@*/
void CommandLineDestroy(CommandLine *line)
{
  free(line->set);
  free(line->argv);
  free(line->sensitivity);
  line->set = line->argv = NULL;
  line->sensitivity      = NULL;
}

/*@
  CommandLineHelp - prints the commands, the options and the scene reference.

  Not collective

  Input Parameter:
. file - the stream to print to

  Note:
  For one rank.
@*/
void CommandLineHelp(FILE *file)
{
  fputs(
    "Burnish: contact of deformable bodies, from a scene file to results, in parallel.\n\n"
    "  [mpirun -n N] burnish SCENE.yaml   runs the scene\n"
    "  [mpirun -n N] burnish -restart DIR goes on from the checkpoint in DIR, on any number of ranks\n"
    "  burnish -check SCENE.yaml          reads, meshes, validates and reports; solves nothing\n"
    "  burnish -mesh SCENE.yaml           only makes the mesh file\n"
    "  burnish -import DECK.inp           makes a scene and a mesh of a deck of Abaqus or CalculiX\n"
    "  burnish -evaluate DIR PROBES.yaml  finds more probes of a finished run in its results\n"
    "  burnish -explain CODE              says what a message that ends with this code means\n"
    "  burnish -help | -version\n\n"
    "  -o DIR           where results go (default out/NAME)\n"
    "  -set KEY=VALUE   overrides or adds one value of the scene by its path, such as contact.0.smoother=facet or\n"
    "                   'loads.0={surface: top, uy: -1}'; repeatable, the last one wins; with -restart only of "
    "output,\n"
    "                   solver and stepping\n"
    "  -to E -probe P   makes meshes until the error of probe P is below E per cent (the scene's accuracy.to and\n"
    "                   accuracy.probe)\n"
    "  -sensitivity P:K derivative of probe P by the number K of the scene; P:K,K for more, repeatable (the scene's\n"
    "                   sensitivity)\n"
    "  -overwrite       lets DIR hold another scene's results\n"
    "  -quiet           no progress on the terminal\n"
    "  -trust           lets the scene load libraries (law: umat), run programs and write files of its own (gmsh's "
    "SystemCall\n"
    "                   and Save, PETSc options that name files); for scenes of people whom you trust\n"
    "  -time_limit S    ends the run after the step that leaves just the time to write a checkpoint, S seconds "
    "from its start\n"
    "All other options are PETSc's.\n\n"
    "A run writes DIR/checkpoint.h5 every output.checkpoint steps, when it fails, and when SIGUSR1 (to mpirun, "
    "which passes it\n"
    "on, or to any rank), SIGTERM (to any rank) or -time_limit ends it after the current step.\n\n"
    "Exit status: 0 done, 1 wrong input, 2 did not converge, 3 stopped after a checkpoint, 4 machine or internal "
    "error,\n5 the accuracy that was asked for is not reached.\n\n"
    "Scene file (YAML; file names in it start at its own folder):\n\n",
    file);
  SchemaReference(file);
}

/*@
  CommandLineVersion - prints the program's name and version, the version of PETSc and the BLAS library.

  Not collective

  Input Parameter:
. file - the stream to print to

  Note:
  For one rank.
@*/
void CommandLineVersion(FILE *file)
{
  Blas blas;

  BlasFind(&blas);
  fprintf(file, "burnish %s, PETSc %d.%d.%d\n", BURNISH_VERSION, PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR,
          PETSC_VERSION_SUBMINOR);
  fprintf(file, "BLAS ");
  BlasPrint(&blas, file);
}
