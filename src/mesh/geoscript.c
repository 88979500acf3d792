/* Commands of gmsh's language that reach beyond the geometry, see geoscript.h. The list follows gmsh's reference
   manual, sections "Other general commands", "Post-processing commands", "List of all gmsh options" and "Gmsh mesh size
   fields". */
#include "geoscript.h"
#include <string.h>

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
+ option - full name of the option, such as "Mesh.Algorithm"
- length - its length

  Note:
  Returns NULL for an option that only changes geometry, mesh or pictures, and otherwise what it does, to follow the
name of the option in a message.
@*/
const char *GeoOptionForbidden(const char *option, int length)
{
  if (!strncmp(option, "Solver.", 7) || !strncmp(option, "Solver[", 7))
    return "is an option of programs that gmsh runs";
  if (EndsWith(option, length, "Command") || EndsWith(option, length, "Editor"))
    return "names a program that gmsh runs";
  if (!strncmp(option, "General.", 8) &&
      (EndsWith(option, length, "FileName") || EndsWith(option, length, "FilePattern") ||
       EndsWith(option, length, "SaveOptions") || EndsWith(option, length, "SaveSession")))
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

/* Returns what the option does that begins at token `at`, as in General.LogFileName. */
static const char *OptionForbidden(const GeoTokens *tokens, int at)
{
  const GeoToken *token = tokens->token + at, *last;

  if (at + 2 >= tokens->n || (at && GeoTokenIs(token - 1, "."))) return NULL;
  if (!GeoTokenIs(token + 1, ".") && !GeoTokenIs(token, "Solver")) return NULL;
  if (GeoTokenIs(token, "Solver") && !GeoTokenIs(token + 1, ".") && !GeoTokenIs(token + 1, "[")) return NULL;
  last = GeoTokenIs(token + 1, ".") && token[2].kind == GEO_WORD ? token + 2 : token + 1;
  return GeoOptionForbidden(token->at, (int)(last->at + last->length - token->at));
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
