/* Lists of the objects that a scene chooses by name: elastic laws, smoothers, contact laws, step controls. Plain C.

   A new object is a file of its own that defines it, and one line here:

     LINE(enumerator, word of the scene, object)

   The enumerations, the tables, the key of the scene and its reference follow from these lists. material.h, smoother.h,
   contactlaw.h and stepcontrol.h say what each object holds. */
#pragma once

#define ELASTIC_LAWS(LINE)                                                                       \
  LINE(MATERIAL_LINEAR, "linear", MaterialLaw_Linear)                                            \
  LINE(MATERIAL_SVK, "svk", MaterialLaw_Svk)                                                     \
  LINE(MATERIAL_NEO_HOOKEAN, "neo_hookean", MaterialLaw_NeoHookean)                              \
  LINE(MATERIAL_ISOCHORIC_NEO_HOOKEAN, "isochoric_neo_hookean", MaterialLaw_IsochoricNeoHookean) \
  LINE(MATERIAL_MOONEY_RIVLIN, "mooney_rivlin", MaterialLaw_MooneyRivlin)                        \
  LINE(MATERIAL_YEOH, "yeoh", MaterialLaw_Yeoh)                                                  \
  LINE(MATERIAL_OGDEN, "ogden", MaterialLaw_Ogden)                                               \
  LINE(MATERIAL_ARRUDA_BOYCE, "arruda_boyce", MaterialLaw_ArrudaBoyce)                           \
  LINE(MATERIAL_HYPERFOAM, "hyperfoam", MaterialLaw_Hyperfoam)                                   \
  LINE(MATERIAL_VON_MISES, "von_mises", MaterialLaw_VonMises)                                    \
  LINE(MATERIAL_UMAT, "umat", MaterialLaw_Umat)

#define SMOOTHERS(LINE)                         \
  LINE(SMOOTHER_FACET, "facet", Smoother_Facet) \
  LINE(SMOOTHER_DIFFUSE, "diffuse", Smoother_Diffuse)

#define CONTACT_LAWS(LINE) LINE(LAW_PENALTY, "penalty", Law_Penalty)

#define STEP_CONTROLS(LINE)                                   \
  LINE(STEP_FIXED, "fixed", StepControl_Fixed)                \
  LINE(STEP_ITERATIONS, "iterations", StepControl_Iterations) \
  LINE(STEP_CONTACT, "contact", StepControl_Contact)

#define CHOICE_ENUMERATOR(kind, word, object) kind,
typedef enum { ELASTIC_LAWS(CHOICE_ENUMERATOR) MATERIAL_LAWS } MaterialLaw;
typedef enum { SMOOTHERS(CHOICE_ENUMERATOR) SMOOTHER_KINDS } SmootherKind;
typedef enum { CONTACT_LAWS(CHOICE_ENUMERATOR) CONTACT_LAW_KINDS } ContactLawKind;
typedef enum { STEP_CONTROLS(CHOICE_ENUMERATOR) STEP_CONTROL_KINDS } StepControlKind;

/* For tables that are indexed by the kind */
#define CHOICE_NAME(kind, word, object)    [kind] = word,
#define CHOICE_POINTER(kind, word, object) [kind] = &object,
#define CHOICE_BAR(kind, word, object)     " | " word
/* "word | word", as schemakeys.h needs them */
#define CHOICE_WORDS(LIST) (&LIST(CHOICE_BAR)[sizeof " | " - 1])
