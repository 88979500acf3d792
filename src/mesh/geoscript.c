/* Commands of gmsh's language that reach beyond the geometry, see geoscript.h. The list follows gmsh's reference
   manual, sections "Other general commands", "Post-processing commands", "List of all gmsh options" and "Gmsh mesh size
   fields". */
#include "geoscript.h"
#include <ctype.h>
#include <stdio.h>
#include <string.h>

/* Room for the name of an option. gmsh knows none half as long. */
#define OPTION_LENGTH 256

static const char RunsProgram[] = "runs a program", WritesFile[] = "writes a file";

typedef struct {
  const char *word, *what;
  PetscBool with_argument; /* only in front of a text, a name or a bracket; elsewhere it may be a name of the user's */
} Command;

static const Command Commands[] = {
  {"System", RunsProgram, PETSC_TRUE},
  {"SystemCall", RunsProgram, PETSC_FALSE},
  {"NonBlockingSystemCall", RunsProgram, PETSC_FALSE},
  {"OnelabRun", RunsProgram, PETSC_FALSE},
  {"ExternalProcess", RunsProgram, PETSC_FALSE},
  {"Plugin", "runs a plugin, which may write files", PETSC_TRUE},
  {"Print", WritesFile, PETSC_TRUE},
  {"Save", WritesFile, PETSC_TRUE},
  {"CreateDir", "makes a folder", PETSC_FALSE},
  {"SendToServer", "sends data to another program", PETSC_TRUE},
  {"StringToName", "makes a name while it runs, which may be any command", PETSC_FALSE},
  {"S2N", "makes a name while it runs, which may be any command", PETSC_TRUE},
};

static PetscBool TakesArgument(const GeoToken *next)
{
  return next->kind == GEO_TEXT || next->kind == GEO_WORD || GeoTokenIs(next, "(") || GeoTokenIs(next, "[")
           ? PETSC_TRUE
           : PETSC_FALSE;
}

static PetscBool EndsWith(const char *name, int length, const char *end)
{
  const int n = (int)strlen(end);

  return length >= n && !strncmp(name + length - n, end, (size_t)n) ? PETSC_TRUE : PETSC_FALSE;
}

/*@
  GeoOptionForbidden - tells what an option of gmsh does besides geometry.

  Not collective

  Input Parameters:
+ option - full name of the option, such as "Mesh.Algorithm"; blanks and an index, as in "View[0].Name", do not count
- length - its length

  Note:
  Returns NULL for an option that only changes geometry, mesh or pictures, and otherwise what it does, to follow the
name of the option in a message.
@*/
const char *GeoOptionForbidden(const char *option, int length)
{
  char name[OPTION_LENGTH] = "";
  int  n = 0, depth = 0;

  for (int i = 0; i < length; i++) {
    depth += (option[i] == '[') - (i && option[i - 1] == ']');
    if (!depth && option[i] && n < OPTION_LENGTH - 1 && (isalnum((unsigned char)option[i]) || strchr("._", option[i])))
      name[n++] = option[i];
  }
  name[n] = '\0';
  if (strstr(name, "Solver.") == name) return "is an option of programs that gmsh runs";
  if (EndsWith(name, n, "Command") || EndsWith(name, n, "Editor")) return "names a program that gmsh runs";
  if (strstr(name, "General.") == name && strcmp(name, "General.BackgroundImageFileName") &&
      (EndsWith(name, n, "FileName") || EndsWith(name, n, "FilePattern") || EndsWith(name, n, "SaveOptions") ||
       EndsWith(name, n, "SaveSession")))
    return "has gmsh write files of its own";
  return NULL;
}

/* Tells whether the text printed from token `at` on, a Printf, goes to a file. */
static PetscBool PrintsToFile(const GeoTokens *tokens, int at)
{
  int depth = 0, i = at + 1;

  do {
    depth += GeoTokenIs(&tokens->token[i], "(") - GeoTokenIs(&tokens->token[i], ")");
    i++;
  } while (depth > 0 && i < tokens->n - 1);
  return i < tokens->n && GeoTokenIs(&tokens->token[i], ">") ? PETSC_TRUE : PETSC_FALSE;
}

/* Returns what the option does that begins at token `at`, as in General.LogFileName or View[0].Name. */
static const char *OptionForbidden(const GeoTokens *tokens, int at)
{
  const GeoToken *token = tokens->token + at, *end = tokens->token + tokens->n - 1, *dot = token + 1;
  char            name[OPTION_LENGTH];

  if (dot < end && GeoTokenIs(dot, "[")) {
    while (dot < end && !GeoTokenIs(dot, "]")) dot++;
    dot++;
  }
  if (dot + 1 >= end || !GeoTokenIs(dot, ".") || dot[1].kind != GEO_WORD) return NULL;
  snprintf(name, sizeof(name), "%.*s.%.*s", PetscMin(token->length, OPTION_LENGTH / 2), token->at,
           PetscMin(dot[1].length, OPTION_LENGTH / 2 - 2), dot[1].at);
  return GeoOptionForbidden(name, (int)strlen(name));
}

/*@
  GeoScriptForbidden - finds the first command that runs a program or writes a file.

  Not collective

  Input Parameter:
. tokens - tokens of the file

  Output Parameter:
. at - index of the token where the command begins

  Note:
  Returns what the command does, to follow its name in a message, or NULL if there is none. A command counts where gmsh
  would not come to it, too, for example behind If (0).
@*/
const char *GeoScriptForbidden(const GeoTokens *tokens, int *at)
{
  for (*at = 0; *at < tokens->n; (*at)++) {
    const GeoToken *token = tokens->token + *at;
    const char     *what;

    if (token->kind != GEO_WORD || (*at && GeoTokenIs(token - 1, "."))) continue;
    for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(Commands); k++) {
      if (GeoTokenIs(token, Commands[k].word) && (!Commands[k].with_argument || TakesArgument(token + 1)))
        return Commands[k].what;
    }
    if (GeoTokenIs(token, "Printf") && PrintsToFile(tokens, *at)) return WritesFile;
    what = OptionForbidden(tokens, *at);
    if (what) return what;
  }
  return NULL;
}
