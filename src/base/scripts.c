/* The scripts of the program, see scripts.h. */
#include "base/scripts.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Joins a folder, a name and another name; returns 0 if the path is too long. */
static int Join(char path[SCRIPTS_PATH], const char *folder, const char *first, const char *second)
{
  return snprintf(path, SCRIPTS_PATH, "%s/%s%s", folder, first, second) < SCRIPTS_PATH;
}

/* The folder of the program that runs. */
static int ProgramFolder(char folder[SCRIPTS_PATH])
{
  const ssize_t n = readlink("/proc/self/exe", folder, SCRIPTS_PATH - 1);

  if (n < 0) return 0;
  folder[n]             = '\0';
  *strrchr(folder, '/') = '\0';
  return 1;
}

/* Finds the folder that has the script in `scripts`. */
static int FindHome(const char *name, char home[SCRIPTS_PATH], char script[SCRIPTS_PATH])
{
  static const char *const places[] = {"..", "../share/burnish", "../.."};
  const char              *given    = getenv(SCRIPTS_VARIABLE);
  char                     program[SCRIPTS_PATH];

  if (given)
    return snprintf(home, SCRIPTS_PATH, "%s", given) < SCRIPTS_PATH && Join(script, home, "scripts/", name) &&
           !access(script, R_OK);
  if (!ProgramFolder(program)) return 0;
  for (size_t i = 0; i < sizeof(places) / sizeof(*places); i++)
    if (Join(home, program, places[i], "") && Join(script, home, "scripts/", name) && !access(script, R_OK)) return 1;
  return 0;
}

/*@
  ScriptsFind - finds a script of the program and the Python that runs it.

  Not collective

  Input Parameter:
. name - file name, such as "convert_mesh.py"

  Output Parameters:
+ script - its path
- python - path of the Python that `make deps` has made, or the name of that of PATH

  Note:
  Returns 0 if there is no such script. Plain C.
@*/
int ScriptsFind(const char *name, char script[SCRIPTS_PATH], char python[SCRIPTS_PATH])
{
  static const char *const places[] = {"build/venv", "venv"};
  char                     home[SCRIPTS_PATH];

  if (!FindHome(name, home, script)) return 0;
  for (size_t i = 0; i < sizeof(places) / sizeof(*places); i++)
    if (Join(python, home, places[i], "/bin/python") && !access(python, X_OK)) return 1;
  snprintf(python, SCRIPTS_PATH, "python3");
  return 1;
}
