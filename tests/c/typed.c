/* The calls of a machine with its own types answer as those with any machine. MODULE and HEADER name the machine, POSE is
 * possible axis values of its nominal dimensions. */

#include HEADER

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define JOINED(first, second) first##second
#define NAME(first, second) JOINED(first, second)
#define OWN(call) NAME(MODULE, call)
#define EXPECT(condition) ((condition) ? (void)0 : fail(__LINE__))
#define MOST 64

static void fail(int line) {
  fprintf(stderr, "typed.c: line %d\n", line);
  exit(1);
}

int main(void) {
  const softkin_mechanism *kind = &OWN(_mechanism);
  static OWN(_parameters) parameters;
  static OWN(_machine) machine;
  static softkin_refusal why, whys[2][MOST];
  static double kept[SOFTKIN_MOST_SOLUTIONS*SOFTKIN_MOST_AXES], axes[SOFTKIN_MOST_AXES];
  static int slots[SOFTKIN_MOST_SOLUTIONS];
  static double found[2][MOST*SOFTKIN_MOST_AXES];
  static int8_t bytes[2][MOST*SOFTKIN_MOST_AXES], signs[SOFTKIN_MOST_BRANCHES];
  static softkin_status statuses[2][MOST];
  static const double given[] = {POSE};
  softkin_others others = {SOFTKIN_MOST_SOLUTIONS, kept, slots, 0};
  softkin_frame frames[2];
  bool singular[2];
  const int slot_count = 1 << kind->branch_count;

  EXPECT(OWN(_forward)(&machine, axes, &frames[0], NULL, &why) == SOFTKIN_NOT_INITIALIZED);
  OWN(_defaults)(&parameters);
  EXPECT(OWN(_init)(&machine, &parameters, &why) == SOFTKIN_NOT_INITIALIZED && why.parameters[0] != '\0');
  EXPECT(OWN(_init)(NULL, &parameters, NULL) == SOFTKIN_NOT_INITIALIZED);
  for (int i = 0; i < kind->parameter_count; i += 1) {
    memcpy((char *)&parameters + kind->parameters[i].place, &kind->parameters[i].nominal, sizeof(double));
  }
  EXPECT(OWN(_init)(&machine, &parameters, &why) == SOFTKIN_OK);
  for (int i = 0; i < kind->axis_count; i += 1) {
    axes[i] = given[i];
  }
  EXPECT(OWN(_forward)(&machine, axes, &frames[0], bytes[0], NULL) == SOFTKIN_OK);
  EXPECT(softkin_forward(kind, &machine, axes, NULL, &frames[1], bytes[1], NULL, NULL) == SOFTKIN_OK);
  EXPECT(memcmp(&frames[0], &frames[1], sizeof frames[0]) == 0 && memcmp(bytes[0], bytes[1], sizeof bytes[0]) == 0);
#ifdef STARTS
  EXPECT(OWN(_forward_from)(&machine, axes, &frames[0], &frames[0], NULL, NULL) == SOFTKIN_OK); /* one frame for both */
  EXPECT(fabs(frames[0].position[0] - frames[1].position[0]) < 1e-6);
  frames[0] = frames[1];
#else
  EXPECT(softkin_forward(kind, &machine, axes, &frames[0], &frames[1], NULL, NULL, NULL) == SOFTKIN_BAD_INPUT);
#endif
  EXPECT(OWN(_inverse)(&machine, &frames[0], bytes[0], axes, found[0], &why) == SOFTKIN_OK);
  EXPECT(softkin_inverse(kind, &machine, &frames[0], bytes[0], axes, found[1], &why) == SOFTKIN_OK);
  EXPECT(memcmp(found[0], found[1], sizeof found[0]) == 0);
  for (int i = 0; i < kind->axis_count; i += 1) {
    EXPECT(fabs(found[0][i] - axes[i]) < 1e-6);
  }
  for (int i = 0; i < kind->branch_count; i += 1) {
    signs[i] = bytes[0][i] == 1 ? 1 : -1;
  }
  EXPECT(OWN(_branch)(&machine, &frames[0], signs, bytes[0] + kind->branch_count, axes, found[1], &why) == SOFTKIN_OK);
  EXPECT(memcmp(found[0], found[1], sizeof found[0]) == 0);
  EXPECT(OWN(_inverse)(&machine, &frames[0], NULL, NULL, NULL, NULL) == SOFTKIN_BAD_INPUT);
  EXPECT(OWN(_limits)(&machine, axes, &why) == softkin_limits(kind, &machine, axes, &why));
#ifdef SEARCHED
  EXPECT(OWN(_inverse_all)(&machine, &frames[0], axes, statuses[0], found[0], bytes[0], whys[0], NULL) == SOFTKIN_OK);
#else
  EXPECT(OWN(_inverse_all)(&machine, &frames[0], axes, statuses[0], found[0], bytes[0], whys[0]) == SOFTKIN_OK);
#endif
  EXPECT(softkin_inverse_all(kind, &machine, &frames[0], axes, statuses[1], found[1], bytes[1], whys[1], &others)
         == SOFTKIN_OK);
  EXPECT(memcmp(statuses[0], statuses[1], sizeof statuses[0]) == 0 && memcmp(found[0], found[1], sizeof found[0]) == 0);
  EXPECT(memcmp(bytes[0], bytes[1], sizeof bytes[0]) == 0);
  for (int i = 0; i < slot_count; i += 1) {
    EXPECT(statuses[0][i] == SOFTKIN_OK || (whys[0][i].status == statuses[0][i] && whys[0][i].reason[0] != '\0'));
  }
  EXPECT(softkin_inverse_all(kind, &machine, &frames[0], axes, statuses[1], found[1], NULL, NULL, &others) == SOFTKIN_OK);
  EXPECT(OWN(_jacobian)(&machine, axes, found[0], &why) == SOFTKIN_OK);
  EXPECT(softkin_jacobian(kind, &machine, axes, found[1], &why) == SOFTKIN_OK);
  EXPECT(memcmp(found[0], found[1], sizeof found[0]) == 0);
  EXPECT(OWN(_singularity)(&machine, axes, found[0], &singular[0], &why) == SOFTKIN_OK);
  EXPECT(softkin_singularity(kind, &machine, axes, found[1], &singular[1], &why) == SOFTKIN_OK);
  EXPECT(memcmp(found[0], found[1], sizeof found[0]) == 0 && singular[0] == singular[1]);
  EXPECT(strcmp(softkin_meaning(SOFTKIN_OK), "no error") == 0);
  return 0;
}
