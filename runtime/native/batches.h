/** @file batches.h  Calls of many rows. They know nothing of Python: its lock may be free meanwhile. */

#ifndef SOFTKIN_BATCHES_H
#define SOFTKIN_BATCHES_H

#include "lanes.h"

/** Rows of numbers of the size of a double or an int64_t, anywhere in memory: the bytes from one to the next.
 * */
typedef struct {
  const char *data;
  ptrdiff_t row, column;
} softkin_table;

/** Rows from `start` to before `stop`. Results of a row that is refused are NaN, and zeros in a
 * configuration. */
typedef struct {
  const softkin_mechanism *kind;
  softkin_in_lanes in_lanes;
  const void *machine;
  ptrdiff_t start, stop;
} softkin_rows;

void softkin_forward_rows(const softkin_rows *rows, const softkin_table *axes, double *positions,
    double *rotations, int8_t *configurations, uint8_t *statuses);

/** rotations: without data where the machine reads none. Configurations are whole numbers, 128 to 255 stand
 * for the negative bytes. */
void softkin_inverse_rows(const softkin_rows *rows, const softkin_table *positions,
    const softkin_table *rotations, const softkin_table *configurations, const softkin_table *references,
    double *axes, uint8_t *statuses);

/** Of a machine that is not searched. */
void softkin_inverse_all_rows(const softkin_rows *rows, const softkin_table *positions,
    const softkin_table *rotations, const softkin_table *references, double *axes, uint8_t *statuses);

void softkin_jacobian_rows(const softkin_rows *rows, const softkin_table *axes, double *matrices,
    uint8_t *statuses);

#endif
