/* A move, as far as a kinematics reads it. */
#ifndef TRAPQ_H
#define TRAPQ_H

struct coord {
  double x, y, z;
};
struct move {
  double start_v, half_accel;
  struct coord start_pos, axes_r;
};
#endif
