/* The solver, as far as a test asks it: one position on a line. */
#include "itersolve.h"
#include "trapq.h"

double ask(struct stepper_kinematics *sk, const double *start, const double *direction, double speed, double half_accel, double time) {
  struct move m = {speed, half_accel, {start[0], start[1], start[2]}, {direction[0], direction[1], direction[2]}};
  return sk->calc_position_cb(sk, &m, time);
}

int flags(struct stepper_kinematics *sk) {
  return sk->active_flags;
}
