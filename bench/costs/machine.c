/* Calls a machine at poses, with a call of `mark` before and behind each call that is counted: see counted.c. The header
 * defines KIND, MACHINE, PARAMETERS, SET (assignments), AXES, and rows of axis values, POSES. */

#include "measured.h"

enum { MOST = 40 };

static MACHINE machine;
static PARAMETERS parameters;
static const double poses[][AXES] = {POSES};
static double rows[SOFTKIN_MOST_ROWS*SOFTKIN_MOST_AXES];

__attribute__((noinline)) void mark(void) {
  __asm__ volatile("");
}

/* The configuration of the pose, with every branch named; turns are automatic. */
static bool has_one_solution(const double *axes, softkin_frame *frame, int8_t *bytes) {
  double found[AXES];
  bool is_same = softkin_forward(&KIND, &machine, axes, NULL, frame, bytes, NULL, NULL) == SOFTKIN_OK;
  for (int i = 0; i < KIND.branch_count + KIND.period_count; i += 1) {
    bytes[i] = i >= KIND.branch_count ? 0 : bytes[i] == 2 ? 2 : 1;
  }
  is_same = is_same && softkin_inverse(&KIND, &machine, frame, bytes, axes, found, NULL) == SOFTKIN_OK;
  for (int i = 0; is_same && i < KIND.axis_count; i += 1) {
    is_same = fabs(found[i] - axes[i]) < 1e-3;
  }
  return is_same;
}

int main(void) {
  softkin_frame frame, again;
  int8_t bytes[SOFTKIN_MOST_BRANCHES + SOFTKIN_MOST_AXES], own[sizeof bytes];
  double found[AXES];
  int count = 0;
  softkin_defaults(&KIND, &parameters);
  SET
  if (softkin_init(&KIND, &machine, &parameters, NULL) != SOFTKIN_OK) {
    return 1;
  }
  mark();
  mark();
  for (size_t i = 0; i < sizeof poses/sizeof *poses && count < MOST; i += 1) {
    if (has_one_solution(poses[i], &frame, bytes)) {
      count += 1;
      mark();
      softkin_forward(&KIND, &machine, poses[i], NULL, &again, own, NULL, NULL);
      mark();
      softkin_inverse(&KIND, &machine, &frame, bytes, poses[i], found, NULL);
      mark();
      softkin_jacobian(&KIND, &machine, poses[i], rows, NULL);
      mark();
    }
  }
  return count > 0 ? 0 : 2;
}

#if defined(__ARM_ARCH_PROFILE) && __ARM_ARCH_PROFILE == 'M'
/* The C library of the Cortex-M7 knows no Linux, which QEMU offers: begin at main, end by the call that ends a process. */
void _start(void) {
  register int status __asm__("r0") = main();
  register int call __asm__("r7") = 1;
  __asm__ volatile("svc 0" : : "r"(status), "r"(call));
}
#endif
