/* Answers questions from a stream of doubles about one mechanism: see machine.py. Arrays have exactly the size that
 * the calls name, so that the address sanitizer sees each step beyond them; they hold NaN before a call, and a call
 * that refuses must leave it there. */

#include "softkin.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

extern const softkin_mechanism *const tested;

static void fail(const char *what) {
  fprintf(stderr, "driver: %s\n", what);
  exit(3);
}

static bool read_number(double *number) {
  return fread(number, sizeof *number, 1, stdin) == 1;
}

static double number(void) {
  double found;
  if (!read_number(&found)) {
    fail("the stream ends");
  }
  return found;
}

static void *array(size_t count, size_t size) {
  void *found = malloc(count*size);
  if (found == NULL && count > 0) {
    fail("no memory");
  }
  return found;
}

static double *empty(int count) {
  double *found = array((size_t)count, sizeof *found);
  for (int i = 0; i < count; i += 1) {
    found[i] = NAN;
  }
  return found;
}

static double *numbers(int count) {
  double *found = empty(count);
  for (int i = 0; i < count; i += 1) {
    found[i] = number();
  }
  return found;
}

/* Numbers, where the first one says that there are any. */
static double *optional(int count) {
  return number() != 0.0 ? numbers(count) : NULL;
}

static int8_t *bytes(int count) {
  int8_t *found = array((size_t)count, sizeof *found);
  for (int i = 0; i < count; i += 1) {
    const int given = (int)number();
    found[i] = (int8_t)(given > 127 ? given - 256 : given);
  }
  return found;
}

static void frame_of(softkin_frame *frame) {
  for (int i = 0; i < 12; i += 1) {
    *(i < 3 ? &frame->position[i] : &frame->rotation[(i - 3)/3][(i - 3)%3]) = number();
  }
}

static void tell(double value) {
  if (fwrite(&value, sizeof value, 1, stdout) != 1) {
    fail("nobody reads");
  }
}

static void tell_all(const double *values, int count) {
  for (int i = 0; i < count; i += 1) {
    tell(values[i]);
  }
}

static void tell_bytes(const int8_t *values, int count) {
  for (int i = 0; i < count; i += 1) {
    tell(values[i]);
  }
}

static void tell_text(const char *text) {
  double length = 0.0;
  while (text[(size_t)length] != '\0') {
    length += 1.0;
  }
  tell(length);
  fputs(text, stdout);
}

/* The status, and where it is not 0 the refusal. */
static bool succeeds(softkin_status status, const softkin_refusal *why) {
  tell((double)status);
  if (status != SOFTKIN_OK) {
    if (why->status != status) {
      fail("the refusal has another status");
    }
    tell_text(why->reason);
    tell_text(why->unit);
    tell(why->missing);
    tell(why->turn);
    tell_text(why->parameters);
  }
  return status == SOFTKIN_OK;
}

static void untouched(const double *values, int count) {
  for (int i = 0; i < count; i += 1) {
    if (!isnan(values[i])) {
      fail("a call that refuses has written a result");
    }
  }
}

/* The status, and the results of a call; where it refuses, it must have written none. */
static void tell_results(softkin_status status, const softkin_refusal *why, const double *values, int count) {
  if (succeeds(status, why)) {
    tell_all(values, count);
  } else {
    untouched(values, count);
  }
}

static void forward(const void *machine) {
  const int size = tested->branch_count + tested->period_count;
  double *axes = numbers(tested->axis_count), *margins = empty(tested->branch_count);
  int8_t *configuration = array((size_t)size, 1);
  softkin_frame start, frame;
  softkin_refusal why;
  const bool has_start = number() != 0.0;
  if (has_start) {
    frame_of(&start);
  }
  frame.position[0] = NAN;
  if (succeeds(softkin_forward(tested, machine, axes, has_start ? &start : NULL, &frame, configuration, margins, &why),
               &why)) {
    tell_all(frame.position, 3);
    for (int i = 0; i < 3; i += 1) {
      tell_all(frame.rotation[i], 3);
    }
    tell_bytes(configuration, size);
    tell_all(margins, tested->branch_count);
  } else {
    untouched(frame.position, 1);
    untouched(margins, tested->branch_count);
  }
  free(axes);
  free(margins);
  free(configuration);
}

/* The machine, or one whose forward kinematics starts at the frame that follows in the stream. */
static void *started(const void *machine, softkin_status *status, softkin_refusal *why) {
  softkin_frame start;
  void *moved = array(1, tested->machine_size);
  memcpy(moved, machine, tested->machine_size);
  *status = SOFTKIN_OK;
  if (number() != 0.0) {
    frame_of(&start);
    *status = softkin_start_at(tested, machine, &start, moved, why);
  }
  return moved;
}

static void singularity(const void *machine) {
  double *axes = numbers(tested->axis_count), *margins = empty(tested->margin_count);
  bool is_singular = false;
  softkin_refusal why;
  softkin_status status;
  void *moved = started(machine, &status, &why);
  if (status == SOFTKIN_OK) {
    status = softkin_singularity(tested, moved, axes, margins, &is_singular, &why);
  }
  free(moved);
  if (succeeds(status, &why)) {
    tell(is_singular);
    tell_all(margins, tested->margin_count);
  } else {
    untouched(margins, tested->margin_count);
  }
  free(axes);
  free(margins);
}

static void jacobian(const void *machine) {
  const int size = tested->row_count*tested->axis_count;
  double *axes = numbers(tested->axis_count), *rows = empty(size);
  softkin_refusal why;
  softkin_status status;
  void *moved = started(machine, &status, &why);
  if (status == SOFTKIN_OK) {
    status = softkin_jacobian(tested, moved, axes, rows, &why);
  }
  free(moved);
  tell_results(status, &why, rows, size);
  free(axes);
  free(rows);
}

/* Velocities, or accelerations at velocities, of the axes. */
static void motion(const void *machine, bool has_velocities) {
  double *axes = numbers(tested->axis_count);
  double *velocities = has_velocities ? numbers(tested->axis_count) : NULL;
  double *given = numbers(tested->row_count), *found = empty(tested->axis_count);
  softkin_refusal why;
  softkin_status status;
  void *moved = started(machine, &status, &why);
  if (status == SOFTKIN_OK) {
    status = has_velocities ? softkin_axis_accelerations(tested, moved, axes, velocities, given, found, &why)
        : softkin_axis_velocities(tested, moved, axes, given, found, &why);
  }
  free(moved);
  tell_results(status, &why, found, tested->axis_count);
  free(axes);
  free(velocities);
  free(given);
  free(found);
}

static void axis_velocities(const void *machine) {
  motion(machine, false);
}

static void axis_accelerations(const void *machine) {
  motion(machine, true);
}

static void limits(const void *machine) {
  double *axes = numbers(tested->axis_count), *values = empty(tested->quantity_count);
  softkin_refusal why;
  succeeds(softkin_limits(tested, machine, axes, &why), &why);
  if (succeeds(softkin_quantities(tested, machine, axes, values, &why), &why)) {
    tell_all(values, tested->quantity_count);
  }
  free(axes);
  free(values);
}

static void inverse(const void *machine) {
  const int size = tested->branch_count + tested->period_count;
  softkin_frame frame;
  softkin_refusal why;
  frame_of(&frame);
  int8_t *configuration = number() != 0.0 ? bytes(size) : NULL;
  double *reference = optional(tested->axis_count), *axes = empty(tested->axis_count);
  const softkin_status status = softkin_inverse(tested, machine, &frame, configuration, reference, axes, &why);
  tell_results(status, &why, axes, tested->axis_count);
  free(configuration);
  free(reference);
  free(axes);
}

static void inverse_all(const void *machine) {
  const int slots = 1 << tested->branch_count, axes = tested->axis_count;
  const int size = tested->branch_count + tested->period_count;
  softkin_frame frame;
  frame_of(&frame);
  double *reference = optional(axes), *found = empty(slots*axes), *own = empty(SOFTKIN_MOST_SOLUTIONS*axes);
  softkin_status *statuses = array((size_t)slots, sizeof *statuses);
  int8_t *configurations = array((size_t)(slots*size), 1);
  softkin_refusal *whys = array((size_t)slots, sizeof *whys);
  int *kept = array(SOFTKIN_MOST_SOLUTIONS, sizeof *kept);
  softkin_others others = {SOFTKIN_MOST_SOLUTIONS, own, kept, 0};
  const softkin_status status = softkin_inverse_all(tested, machine, &frame, reference, statuses, found, configurations,
                                                    whys, &others);
  tell((double)status);
  for (int i = 0; status == SOFTKIN_OK && i < slots; i += 1) {
    tell_results(statuses[i], &whys[i], &found[i*axes], axes);
    tell_bytes(&configurations[i*size], size);
  }
  tell(others.count);
  for (int i = 0; i < others.count; i += 1) {
    tell(others.slots[i]);
    tell_all(&others.axes[i*axes], axes);
  }
  free(reference);
  free(found);
  free(own);
  free(statuses);
  free(configurations);
  free(whys);
  free(kept);
}

/* What the mechanism says of itself. */
static void describe(const void *machine) {
  (void)machine;
  const int counts[] = {tested->axis_count, tested->branch_count, tested->period_count, tested->row_count,
                        tested->margin_count, tested->limit_count, tested->parameter_count, tested->quantity_count};
  for (size_t i = 0; i < sizeof counts/sizeof counts[0]; i += 1) {
    tell(counts[i]);
  }
  tell_text(tested->name);
  for (int i = 0; i < tested->axis_count; i += 1) {
    const softkin_axis *axis = &tested->axes[i];
    tell_text(axis->name);
    tell_text(axis->kind);
    tell_text(axis->unit);
    tell_text(axis->meaning);
    tell(axis->multi_turn);
  }
  for (int i = 0; i < tested->parameter_count; i += 1) {
    const softkin_parameter *one = &tested->parameters[i];
    tell_text(one->name);
    tell_text(one->kind);
    tell_text(one->unit);
    tell_text(one->meaning);
    tell(one->low);
    tell(one->high);
    tell(one->low_is_open);
    tell(one->initial);
    tell(one->nominal);
  }
  for (int i = 0; i < tested->branch_count + tested->period_count; i += 1) {
    tell_text(tested->configuration[i].name);
    tell_text(tested->configuration[i].first);
    tell_text(tested->configuration[i].second);
    tell(tested->configuration[i].initial);
  }
  for (int i = 0; i < tested->margin_count; i += 1) {
    tell_text(tested->margins[i].name);
  }
  for (int i = 0; i < tested->row_count; i += 1) {
    tell_text(tested->rows[i]);
  }
}

int main(void) {
  static void (*const calls[])(const void *) = {NULL, forward, singularity, jacobian, inverse, inverse_all, limits,
                                                 axis_velocities, axis_accelerations, describe};
  void *machine = calloc(1, tested->machine_size);
  double call;
  while (read_number(&call)) {
    if (call == 0.0) { /* a machine of these parameters; its limits */
      double *parameters = empty(tested->parameter_count);
      softkin_refusal why;
      softkin_defaults(tested, parameters);
      for (double i = number(); i >= 0.0; i = number()) {
        parameters[(int)i] = number();
      }
      succeeds(softkin_init(tested, machine, parameters, &why), &why);
      free(parameters);
    } else {
      calls[(int)call](machine);
    }
    fflush(stdout);
  }
  free(machine);
  return 0;
}
