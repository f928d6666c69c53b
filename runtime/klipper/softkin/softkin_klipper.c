/**
 * @file softkin_klipper.c
 * A machine in Klipper, whose solver asks for the position of a stepper at a time of a move. Every stepper solves the whole
 * machine from where it was asked last, so that turns go on: steppers may run in threads of their own.
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

/* The place of the coordinate that a row of the Jacobian is; -1 for the miss of a surplus rod. */
static int coordinate_of(int row) {
  return KIND->rows[row][1] == '\0' ? KIND->rows[row][0] - 'x' : -1;
}

/* A position, and the axes there. */
typedef struct {
  double position[3], axes[SOFTKIN_MOST_AXES];
} softkin_spot;

typedef struct {
  void *machine;
  softkin_frame frame;
  int8_t bytes[2*SOFTKIN_MOST_AXES], signs[SOFTKIN_MOST_AXES], turns[SOFTKIN_MOST_AXES];
  softkin_spot home;
  softkin_spot stands; /* where the next line begins: turns are near these axes */
  softkin_spot next;   /* where the last tested line ends; the machine goes there only if nothing else refuses that line */
} softkin_printer;

typedef struct {
  struct stepper_kinematics sk; /* first: Klipper has its address */
  const softkin_printer *printer;
  int axis;
  double unit; /* of a stepper per unit of the axis */
  double axes[SOFTKIN_MOST_AXES]; /* where it was asked last */
} softkin_stepper;

static softkin_frame frame_at(const softkin_printer *printer, const double *at) {
  softkin_frame frame = printer->frame;
  for (int i = 0; i < KIND->row_count; i += 1) {
    const int letter = coordinate_of(i);
    if (letter >= 0) {
      frame.position[letter] = at[letter];
    }
  }
  return frame;
}

static softkin_status solve(const softkin_printer *printer, const double *at, double *axes, softkin_refusal *why) {
  const softkin_frame frame = frame_at(printer, at);
  return softkin_inverse(KIND, printer->machine, &frame, printer->bytes, axes, axes, why);
}

/* Lines are tested before: limits are not tested again, where rounding at the end of a line could refuse it. */
static double position_of(struct stepper_kinematics *sk, struct move *m, double time) {
  softkin_stepper *one = (softkin_stepper *)sk;
  const softkin_printer *printer = one->printer;
  const double way = (m->start_v + m->half_accel*time)*time;
  const double at[3] = {
    m->start_pos.x + m->axes_r.x*way, m->start_pos.y + m->axes_r.y*way, m->start_pos.z + m->axes_r.z*way,
  };
  const softkin_frame frame = frame_at(printer, at);
  double axes[SOFTKIN_MOST_AXES];
  if (softkin_branch(KIND, printer->machine, &frame, printer->signs, printer->turns, one->axes, axes, NULL) == SOFTKIN_OK) {
    memcpy(one->axes, axes, sizeof(double)*(size_t)KIND->axis_count);
  }
  return one->axes[one->axis]*one->unit; /* at what is out of reach it stands */
}

/* Whether the branches are those of the axes of home, and these inside their limits. */
static bool stands_at_home(softkin_printer *made, const int8_t *at_home, char *reason, int size) {
  for (int i = 0; i < KIND->branch_count; i += 1) {
    const softkin_byte *byte = &KIND->configuration[i];
    if (at_home[i] != made->bytes[i] && at_home[i] != 3) { /* 3: both branches meet */
      const char *word = at_home[i] == 1 ? byte->first : byte->second;
      snprintf(reason, (size_t)size, "%s: at position_home it is %s", byte->name, word);
      return false;
    }
  }
  softkin_refusal why;
  double axes[SOFTKIN_MOST_AXES];
  memcpy(axes, made->home.axes, sizeof(axes));
  if (solve(made, made->home.position, axes, &why) != SOFTKIN_OK) {
    snprintf(reason, (size_t)size, "position_home: %s", why.reason);
    return false;
  }
  return true;
}

/** A machine with the values of its parameters, and the bytes of its branches. NULL: refused, and `reason` says why. */
softkin_printer *softkin_klipper_new(const double *values, const int8_t *branches, const double *home, double *pose, char *reason, int size) {
  softkin_printer *made = calloc(1, sizeof(*made));
  void *parameters = calloc(1, KIND->parameters_size), *machine = calloc(1, KIND->machine_size);
  softkin_refusal why = {SOFTKIN_OK, "no memory", "", 0.0, 0, ""};
  int8_t at_home[2*SOFTKIN_MOST_AXES];
  bool is_made = made != NULL && parameters != NULL && machine != NULL;
  for (int i = 0; is_made && i < KIND->parameter_count; i += 1) {
    memcpy((char *)parameters + KIND->parameters[i].place, &values[i], sizeof(double));
  }
  is_made = is_made && softkin_init(KIND, machine, parameters, &why) == SOFTKIN_OK
      && softkin_forward(KIND, machine, home, NULL, &made->frame, at_home, NULL, &why) == SOFTKIN_OK;
  free(parameters);
  if (is_made) {
    made->machine = machine;
    for (int i = 0; i < KIND->branch_count; i += 1) {
      made->bytes[i] = branches[i];
      made->signs[i] = branches[i] == 1 ? 1 : -1;
    }
    memcpy(made->home.axes, home, sizeof(double)*(size_t)KIND->axis_count);
    memcpy(made->home.position, made->frame.position, sizeof(made->home.position));
    memcpy(pose, made->home.position, sizeof(made->home.position));
    made->stands = made->next = made->home;
    if (stands_at_home(made, at_home, reason, size)) {
      return made;
    }
  } else {
    snprintf(reason, (size_t)size, "%s", why.reason);
  }
  free(machine);
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
    memcpy(made->axes, printer->home.axes, sizeof(made->axes));
    made->sk.calc_position_cb = position_of;
    for (int i = 0; i < KIND->row_count; i += 1) {
      made->sk.active_flags |= coordinate_of(i) < 0 ? 0 : AF_X << coordinate_of(i);
    }
  }
  return made != NULL ? &made->sk : NULL;
}

/** The axes are those of home, also their turns. */
void softkin_klipper_home(softkin_printer *printer) {
  printer->stands = printer->next = printer->home;
}

/** The stepper is where the last tested line ends. */
void softkin_klipper_keep(struct stepper_kinematics *sk) {
  softkin_stepper *one = (softkin_stepper *)sk;
  memcpy(one->axes, one->printer->next.axes, sizeof(one->axes));
}

/** Whether the machine reaches a line, tested at so many points of it, its end the last; else `reason` says why not. */
bool softkin_klipper_reaches(softkin_printer *printer, const double *start, const double *end, int points, char *reason, int size) {
  if (memcmp(start, printer->next.position, sizeof(printer->next.position)) == 0) {
    printer->stands = printer->next; /* nothing else refused the line before */
  }
  softkin_refusal why;
  softkin_spot next = printer->stands;
  for (int k = 1; k <= points; k += 1) {
    const double part = (double)k/points;
    for (int i = 0; i < 3; i += 1) {
      next.position[i] = k < points ? start[i] + part*(end[i] - start[i]) : end[i];
    }
    if (solve(printer, next.position, next.axes, &why) != SOFTKIN_OK) {
      snprintf(reason, (size_t)size, "%s", why.reason);
      return false;
    }
  }
  printer->next = next;
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
