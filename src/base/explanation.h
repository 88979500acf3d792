/* Codes of messages, and what -explain says about them. Plain C.

   Every message with which a run ends, and every warning, ends with a code such as [B202]. ExplanationOf() finds the
   code of a message by a phrase of it, so that a message needs no code where it is made; a message without an entry of
   its own gets that of its kind. Warnings have their codes in their texts, because each is printed where it is made.
   The table in explanation.c is also the table of the page troubleshooting.md (scripts/reference.py). */
#pragma once
#include <stddef.h>
#include <stdio.h>

typedef enum { EXPLANATION_INPUT, EXPLANATION_UNSOLVED, EXPLANATION_STOPPED, EXPLANATION_FAILURE } ExplanationKind;

/* Characters that a code needs behind a message, with the end of the text. */
#define EXPLANATION_ROOM 16

const char *ExplanationOf(const char *message, ExplanationKind kind);
void        ExplanationAppend(char *message, size_t size, ExplanationKind kind);
int         ExplanationPrint(const char *code, FILE *file);
