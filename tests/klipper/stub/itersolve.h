/* What a kinematics needs of Klipper's solver, declared for the tests: the members in another order than there. */
#ifndef ITERSOLVE_H
#define ITERSOLVE_H

enum { AF_X = 1, AF_Y = 2, AF_Z = 4 };
struct move;
struct stepper_kinematics {
  int active_flags;
  double commanded_pos;
  double (*calc_position_cb)(struct stepper_kinematics *sk, struct move *m, double move_time);
};
#endif
