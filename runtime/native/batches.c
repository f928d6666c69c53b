/* Calls of many rows. */

#include <string.h>

#include "batches.h"

static double real_at(const softkin_table *table, ptrdiff_t row, int column) {
  double value;
  memcpy(&value, table->data + row*table->row + column*table->column, sizeof value);
  return value;
}

static int64_t whole_at(const softkin_table *table, ptrdiff_t row, int column) {
  int64_t value;
  memcpy(&value, table->data + row*table->row + column*table->column, sizeof value);
  return value;
}

static void take(const softkin_table *table, ptrdiff_t row, int count, double *values) {
  for (int i = 0; i < count; i += 1) {
    values[i] = real_at(table, row, i);
  }
}

static void take_frame(const softkin_table *positions, const softkin_table *rotations, ptrdiff_t row,
    softkin_frame *frame) {
  take(positions, row, 3, frame->position);
  for (int i = 0; i < 9; i += 1) {
    frame->rotation[i/3][i%3] = rotations->data != NULL ? real_at(rotations, row, i) : i % 4 == 0 ? 1.0 : 0.0;
  }
}

static void clear(double *values, int count) {
  for (int i = 0; i < count; i += 1) {
    values[i] = NAN;
  }
}

void softkin_forward_rows(const softkin_rows *rows, const softkin_table *axes, double *positions,
    double *rotations, int8_t *configurations, uint8_t *statuses) {
  const int size = rows->kind->branch_count + rows->kind->period_count;
  double values[SOFTKIN_MOST_AXES];
  softkin_frame frame;
  for (ptrdiff_t row = rows->start; row < rows->stop; row += 1) {
    take(axes, row, rows->kind->axis_count, values);
    const softkin_status status = softkin_forward(rows->kind, rows->machine, values, NULL, &frame,
        &configurations[row*size], NULL, NULL);
    statuses[row] = (uint8_t)status;
    if (status == SOFTKIN_OK) {
      memcpy(&positions[3*row], frame.position, sizeof frame.position);
      memcpy(&rotations[9*row], frame.rotation, sizeof frame.rotation);
    } else {
      clear(&positions[3*row], 3);
      clear(&rotations[9*row], 9);
      memset(&configurations[row*size], 0, (size_t)size);
    }
  }
}

/* The bytes of a row; false if a number is none. */
static bool take_bytes(const softkin_table *table, ptrdiff_t row, int count, int8_t *bytes) {
  for (int i = 0; i < count; i += 1) {
    const int64_t value = whole_at(table, row, i);
    if (value < -128 || value > 255) {
      return false;
    }
    bytes[i] = (int8_t)(value > 127 ? value - 256 : value);
  }
  return true;
}

/* ---- several rows at a time ---- */

/* What inverse kinematics reads of rows; without configurations every branch is wanted. */
typedef struct {
  const softkin_table *positions, *rotations, *configurations, *references;
} asked;

/* Lanes miss where the number of one is none, or is not of reasonable size. */
static void find_unreasonable(int count, double (*numbers)[SOFTKIN_LANES], double *misses) {
  for (int i = 0; i < count; i += 1) {
    for (int lane = 0; lane < SOFTKIN_LANES; lane += 1) {
      misses[lane] += fabs(numbers[i][lane]) <= SOFTKIN_LARGEST ? 0.0 : 1.0;
    }
  }
}

/* Put the axes with turns on the turn that is nearest; lanes miss where that is none. */
static void choose_turns(const softkin_mechanism *kind, double (*near)[SOFTKIN_LANES],
    double (*axes)[SOFTKIN_LANES], double *misses) {
  for (int i = 0; i < kind->period_count; i += 1) {
    double *own = axes[kind->period_axes[i]];
    for (int lane = 0; lane < SOFTKIN_LANES; lane += 1) {
      own[lane] = softkin_lane_turn(own[lane], near[i][lane]);
      misses[lane] += fabs(own[lane] - near[i][lane]) <= 180.0 + 2.0*SOFTKIN_EDGE ? 0.0 : 1.0;
    }
  }
}

/* The signs of a row that names one branch and no turn; false if it does not. */
static bool take_signs(const softkin_mechanism *kind, const softkin_table *configurations, ptrdiff_t row,
    int lane, softkin_lanes *lanes) {
  bool is_named = true;
  for (int i = 0; i < kind->branch_count; i += 1) {
    const int64_t byte = whole_at(configurations, row, i);
    lanes->signs[i][lane] = byte == 1 ? 1.0 : -1.0;
    is_named = is_named && (byte == 1 || byte == 2);
  }
  for (int i = 0; i < kind->period_count; i += 1) {
    is_named = is_named && whole_at(configurations, row, kind->branch_count + i) == 0;
  }
  return is_named;
}

/* Rows from one on, at most as many as there are lanes; those miss that are not good input, or name no
 * branch. Where
 * rows end, the last one stands in the other lanes: what a row is answered does not depend on those around
 * it. */
static void take_lanes(const softkin_mechanism *kind, const asked *given, ptrdiff_t first, int count,
    softkin_lanes *lanes, double *misses) {
  for (int lane = 0; lane < SOFTKIN_LANES; lane += 1) {
    const ptrdiff_t row = first + (lane < count ? lane : count - 1);
    for (int i = 0; i < 3; i += 1) {
      lanes->position[i][lane] = real_at(given->positions, row, i);
    }
    for (int i = 0; kind->reads_rotation && i < 9; i += 1) {
      lanes->rotation[i][lane] = real_at(given->rotations, row, i);
    }
    for (int i = 0; i < kind->axis_count; i += 1) {
      lanes->reference[i][lane] = real_at(given->references, row, i);
    }
    const bool is_named = given->configurations == NULL
        || take_signs(kind, given->configurations, row, lane, lanes);
    misses[lane] += is_named ? 0.0 : 1.0;
  }
  find_unreasonable(3, lanes->position, misses);
  find_unreasonable(kind->axis_count, lanes->reference, misses);
  if (kind->reads_rotation) {
    softkin_lanes_inexact(lanes, misses);
  }
}

/* ---- one solution of each row ---- */

static softkin_status inverse_of(const softkin_rows *rows, const asked *given, ptrdiff_t row, double *axes) {
  double reference[SOFTKIN_MOST_AXES];
  int8_t bytes[SOFTKIN_MOST_BRANCHES + SOFTKIN_MOST_AXES];
  softkin_frame frame;
  if (!take_bytes(given->configurations, row, rows->kind->branch_count + rows->kind->period_count, bytes)) {
    return SOFTKIN_BAD_INPUT;
  }
  take_frame(given->positions, given->rotations, row, &frame);
  take(given->references, row, rows->kind->axis_count, reference);
  return softkin_inverse(rows->kind, rows->machine, &frame, bytes, reference, axes, NULL);
}

/* How many rows from one on are taken together. */
static int taken(const softkin_rows *rows, ptrdiff_t first) {
  return rows->stop - first < SOFTKIN_LANES ? (int)(rows->stop - first) : SOFTKIN_LANES;
}

/* Some rows; those without an answer there are asked by themselves. */
static void inverse_in_lanes(const softkin_rows *rows, const asked *given, ptrdiff_t first, double *axes,
    uint8_t *statuses) {
  const int width = rows->kind->axis_count, count = taken(rows, first);
  softkin_lanes lanes;
  double found[SOFTKIN_MOST_AXES][SOFTKIN_LANES], near[SOFTKIN_MOST_AXES][SOFTKIN_LANES],
      misses[SOFTKIN_LANES] = {0.0};
  take_lanes(rows->kind, given, first, count, &lanes, misses);
  rows->in_lanes.one(rows->machine, &lanes, found, near, misses);
  choose_turns(rows->kind, near, found, misses);
  for (int lane = 0; lane < count; lane += 1) {
    double *own = &axes[(first + lane)*width];
    for (int i = 0; i < width; i += 1) {
      own[i] = found[i][lane];
    }
    const bool is_found = misses[lane] == 0.0
        && softkin_limits(rows->kind, rows->machine, own, NULL) == SOFTKIN_OK;
    statuses[first + lane] = (uint8_t)(is_found ? SOFTKIN_OK : inverse_of(rows, given, first + lane, own));
  }
}

void softkin_inverse_rows(const softkin_rows *rows, const softkin_table *positions,
    const softkin_table *rotations, const softkin_table *configurations, const softkin_table *references,
    double *axes, uint8_t *statuses) {
  const asked given = {positions, rotations, configurations, references};
  const int width = rows->kind->axis_count;
  ptrdiff_t row = rows->start;
  for (; rows->in_lanes.one != NULL && row < rows->stop; row += SOFTKIN_LANES) {
    inverse_in_lanes(rows, &given, row, axes, statuses);
  }
  for (; row < rows->stop; row += 1) {
    statuses[row] = (uint8_t)inverse_of(rows, &given, row, &axes[row*width]);
  }
  for (row = rows->start; row < rows->stop; row += 1) {
    if (statuses[row] != SOFTKIN_OK) {
      clear(&axes[row*width], width);
    }
  }
}

/* ---- all solutions of each row ---- */

static void inverse_all_of(const softkin_rows *rows, const asked *given, ptrdiff_t row, double *axes,
    uint8_t *statuses) {
  const int slots = 1 << rows->kind->branch_count;
  double reference[SOFTKIN_MOST_AXES];
  softkin_status outcomes[1 << SOFTKIN_MOST_BRANCHES];
  softkin_frame frame;
  take_frame(given->positions, given->rotations, row, &frame);
  take(given->references, row, rows->kind->axis_count, reference);
  const softkin_status status = softkin_inverse_all(rows->kind, rows->machine, &frame, reference, outcomes,
      axes, NULL, NULL, NULL);
  for (int slot = 0; slot < slots; slot += 1) {
    statuses[slot] = (uint8_t)(status == SOFTKIN_OK ? outcomes[slot] : status);
  }
}

static void inverse_all_in_lanes(const softkin_rows *rows, const asked *given, ptrdiff_t first, double *axes,
    uint8_t *statuses) {
  const int width = rows->kind->axis_count, slots = 1 << rows->kind->branch_count, count = taken(rows, first);
  softkin_lanes lanes;
  double found[SOFTKIN_MOST_TOGETHER*SOFTKIN_MOST_AXES][SOFTKIN_LANES],
      outcomes[SOFTKIN_MOST_TOGETHER][SOFTKIN_LANES];
  double near[SOFTKIN_MOST_AXES][SOFTKIN_LANES], misses[SOFTKIN_LANES] = {0.0};
  take_lanes(rows->kind, given, first, count, &lanes, misses);
  rows->in_lanes.all(rows->machine, &lanes, outcomes, found, near, misses);
  for (int slot = 0; slot < slots; slot += 1) {
    choose_turns(rows->kind, near, &found[slot*width], misses);
  }
  for (int lane = 0; lane < count; lane += 1) {
    double *own = &axes[(first + lane)*slots*width];
    uint8_t *states = &statuses[(first + lane)*slots];
    if (misses[lane] != 0.0) {
      inverse_all_of(rows, given, first + lane, own, states);
      continue;
    }
    for (int i = 0; i < slots*width; i += 1) {
      own[i] = found[i][lane];
    }
    for (int slot = 0; slot < slots; slot += 1) {
      const softkin_status outcome = (softkin_status)outcomes[slot][lane];
      states[slot] = (uint8_t)(outcome == SOFTKIN_OK
          ? softkin_limits(rows->kind, rows->machine, &own[slot*width], NULL) : outcome);
    }
  }
}

void softkin_inverse_all_rows(const softkin_rows *rows, const softkin_table *positions,
    const softkin_table *rotations, const softkin_table *references, double *axes, uint8_t *statuses) {
  const asked given = {positions, rotations, NULL, references};
  const int width = rows->kind->axis_count, slots = 1 << rows->kind->branch_count;
  ptrdiff_t row = rows->start;
  for (; rows->in_lanes.all != NULL && row < rows->stop; row += SOFTKIN_LANES) {
    inverse_all_in_lanes(rows, &given, row, axes, statuses);
  }
  for (; row < rows->stop; row += 1) {
    inverse_all_of(rows, &given, row, &axes[row*slots*width], &statuses[row*slots]);
  }
  for (row = rows->start*slots; row < rows->stop*slots; row += 1) {
    if (statuses[row] != SOFTKIN_OK) {
      clear(&axes[row*width], width);
    }
  }
}

void softkin_jacobian_rows(const softkin_rows *rows, const softkin_table *axes, double *matrices,
    uint8_t *statuses) {
  const int size = rows->kind->row_count*rows->kind->axis_count;
  double values[SOFTKIN_MOST_AXES];
  for (ptrdiff_t row = rows->start; row < rows->stop; row += 1) {
    take(axes, row, rows->kind->axis_count, values);
    const softkin_status status = softkin_jacobian(rows->kind, rows->machine, values, &matrices[row*size],
        NULL);
    statuses[row] = (uint8_t)status;
    if (status != SOFTKIN_OK) {
      clear(&matrices[row*size], size);
    }
  }
}
