/* Where the Python scripts are that belong to the program, and which Python runs them. Plain C.

   ScriptsFind() finds a script of the folder `scripts` and a Python: in the source tree above build/, or below
   share/burnish of an installed program, or where the environment variable BURNISH_HOME says. */
#pragma once

/* Folder that holds `scripts`, where it is not found beside the program. */
#define SCRIPTS_VARIABLE "BURNISH_HOME"
/* Room for a path, in bytes. */
enum { SCRIPTS_PATH = 4096 };

int ScriptsFind(const char *name, char script[SCRIPTS_PATH], char python[SCRIPTS_PATH]);
