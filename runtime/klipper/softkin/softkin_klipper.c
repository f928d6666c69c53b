/**
 * @file softkin_klipper.c
 * A machine in Klipper, whose solver asks for the position of a stepper at a time of a move. Every stepper solves the whole
 * machine and keeps what it found last, where turns are near: steppers may run in threads of their own.
 *
 * It is compiled with the header of a machine, and with SOFTKIN_MECHANISM, the description of that machine. The two other
 * headers are Klipper's.
 */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "itersolve.h"
#include "softkin.h"
#include "trapq.h"

#define KIND (&SOFTKIN_MECHANISM)

typedef struct {
  void *machine;
  softkin_frame frame;
  int8_t bytes[2*SOFTKIN_MOST_AXES];
  double near[SOFTKIN_MOST_AXES]; /* where the last checked line ended */
} softkin_printer;

typedef struct {
  struct stepper_kinematics sk; /* first: Klipper has its address */
  const softkin_printer *printer;
  int axis;
  double unit; /* of a stepper per unit of the axis */
  double near[SOFTKIN_MOST_AXES], found[SOFTKIN_MOST_AXES];
} softkin_stepper;

static softkin_status solve(const softkin_printer *printer, const double *at, const double *near, double *axes, softkin_refusal *why) {
  softkin_frame frame = printer->frame;
  for (int i = 0; i < KIND->row_count; i += 1) {
    const int letter = KIND->rows[i][0] - 'x';
    frame.position[letter] = at[letter];
  }
  return softkin_inverse(KIND, printer->machine, &frame, printer->bytes, near, axes, why);
}

static double position_of(struct stepper_kinematics *sk, struct move *m, double time) {
  softkin_stepper *one = (softkin_stepper *)sk;
  const double way = (m->start_v + m->half_accel*time)*time;
  const double at[3] = {
    m->start_pos.x + m->axes_r.x*way, m->start_pos.y + m->axes_r.y*way, m->start_pos.z + m->axes_r.z*way,
  };
  double axes[SOFTKIN_MOST_AXES];
  if (solve(one->printer, at, one->near, axes, NULL) == SOFTKIN_OK) {
    memcpy(one->found, axes, sizeof(axes));
  }
  return one->found[one->axis]*one->unit; /* a move that was checked is not refused; else it stands */
}

static void keep(struct stepper_kinematics *sk) {
  softkin_stepper *one = (softkin_stepper *)sk;
  memcpy(one->near, one->found, sizeof(one->near));
}

/** A machine with the values of its parameters, and the bytes of its branches. NULL: refused, and `reason` says why. */
softkin_printer *softkin_klipper_new(const double *values, const int8_t *branches, const double *home, double *pose, char *reason, int size) {
  softkin_printer *made = calloc(1, sizeof(*made));
  void *parameters = calloc(1, KIND->parameters_size);
  softkin_refusal why = {SOFTKIN_OK, "no memory", "", 0.0, 0, ""};
  if (made != NULL && parameters != NULL && (made->machine = calloc(1, KIND->machine_size)) != NULL) {
    for (int i = 0; i < KIND->parameter_count; i += 1) {
      memcpy((char *)parameters + KIND->parameters[i].place, &values[i], sizeof(double));
    }
    memcpy(made->bytes, branches, (size_t)KIND->branch_count);
    memcpy(made->near, home, sizeof(double)*(size_t)KIND->axis_count);
    if (softkin_init(KIND, made->machine, parameters, &why) == SOFTKIN_OK
        && softkin_forward(KIND, made->machine, home, NULL, &made->frame, NULL, NULL, &why) == SOFTKIN_OK) {
      memcpy(pose, made->frame.position, sizeof(made->frame.position));
      free(parameters);
      return made;
    }
  }
  snprintf(reason, (size_t)size, "%s", why.reason);
  free(parameters);
  free(made);
  return NULL;
}

/** What Klipper calls for the stepper of an axis. */
struct stepper_kinematics *softkin_klipper_stepper(const softkin_printer *printer, int axis, double unit) {
  softkin_stepper *made = calloc(1, sizeof(*made));
  if (made != NULL) {
    made->printer = printer;
    made->axis = axis;
    made->unit = unit;
    memcpy(made->near, printer->near, sizeof(made->near));
    memcpy(made->found, printer->near, sizeof(made->found));
    made->sk.calc_position_cb = position_of;
    made->sk.post_cb = keep;
    for (int i = 0; i < KIND->row_count; i += 1) {
      made->sk.active_flags |= AF_X << (KIND->rows[i][0] - 'x');
    }
  }
  return made != NULL ? &made->sk : NULL;
}

/** The stepper stands where it was last asked for. */
void softkin_klipper_keep(struct stepper_kinematics *sk) {
  keep(sk);
}

/** Whether the machine reaches a line, tested at so many points of it, its end the last; else `reason` says why not. */
bool softkin_klipper_reaches(softkin_printer *printer, const double *start, const double *end, int points, char *reason, int size) {
  softkin_refusal why;
  double near[SOFTKIN_MOST_AXES];
  memcpy(near, printer->near, sizeof(near));
  for (int k = 1; k <= points; k += 1) {
    const double part = (double)k/points;
    const double at[3] = {
      start[0] + part*(end[0] - start[0]), start[1] + part*(end[1] - start[1]), start[2] + part*(end[2] - start[2]),
    };
    if (solve(printer, at, near, near, &why) != SOFTKIN_OK) {
      snprintf(reason, (size_t)size, "%s", why.reason);
      return false;
    }
  }
  memcpy(printer->near, near, sizeof(near));
  return true;
}

/** The position at axis values; false: there is none. */
bool softkin_klipper_position(const softkin_printer *printer, const double *axes, double *position) {
  softkin_frame frame;
  if (softkin_forward(KIND, printer->machine, axes, NULL, &frame, NULL, NULL, NULL) != SOFTKIN_OK) {
    return false;
  }
  memcpy(position, frame.position, sizeof(frame.position));
  return true;
}
