/**
 * @file lanes.h  Several poses at a time: one number of each stands in a lane.
 *
 * Every loop over lanes is free of branches and calls, so that compilers take several lanes in one
 * instruction. Rounding
 * is that of plain arithmetic on every processor.
 */

#ifndef SOFTKIN_LANES_H
#define SOFTKIN_LANES_H

#include "softkin.h"

#define SOFTKIN_LANES 8
#ifdef _MSC_VER
#define SOFTKIN_RESTRICT __restrict
#else
#define SOFTKIN_RESTRICT restrict
#endif
#define SOFTKIN_LANE_PI 3.14159265358979323846
#define SOFTKIN_LANE_OCTANT 0.41421356237309503 /* tan 22.5 degrees */

/** What is asked, by columns: all lanes of a number stand beside each other. Signs are +1 and -1. */
typedef struct {
  double position[3][SOFTKIN_LANES], rotation[9][SOFTKIN_LANES];
  double signs[SOFTKIN_MOST_BRANCHES][SOFTKIN_LANES], reference[SOFTKIN_MOST_AXES][SOFTKIN_LANES];
} softkin_lanes;

/**
 * The axes of every lane on its branch, before any limit.
 *
 * @param near what each axis with turns is nearest to; an axis may be in another turn
 * @param misses more is added where a lane has no answer: its pose is singular or out of reach, and is asked
 * by itself
 */
typedef void softkin_regular(const void *machine, const softkin_lanes *given, double (*axes)[SOFTKIN_LANES],
    double (*near)[SOFTKIN_LANES], double *misses);

/** The same of every slot, each with its status; no signs are read. */
typedef void softkin_regular_all(const void *machine, const softkin_lanes *given,
    double (*statuses)[SOFTKIN_LANES], double (*axes)[SOFTKIN_LANES], double (*near)[SOFTKIN_LANES],
    double *misses);

/** What a machine has of these; NULL: poses are computed one by one. */
typedef struct {
  softkin_regular *one;
  softkin_regular_all *all;
} softkin_in_lanes;

#include "lane_programs.h"

/** The square root of x, and 0 for a negative x. */
static inline double softkin_lane_root(double x) {
  return sqrt(x > 0.0 ? x : 0.0);
}

/** `softkin_angle_of` to rounding: the angle of (x, y) in radians, in (-pi, pi]; 0 for (0, 0). Zeros have no
 * sign. */
static inline double softkin_lane_angle(double y, double x) {
  const double along = fabs(x), across = fabs(y);
  const double small = across < along ? across : along, large = across < along ? along : across;
  const bool is_far = small > SOFTKIN_LANE_OCTANT*large; /* then 45 degrees are taken off */
  const double above = is_far ? small - large : small, below = is_far ? small + large : large;
  const double t = above/(below > 0.0 ? below : 1.0);
  const double z = t*t, zz = z*z;
  const double even = softkin_lane_even(zz);
  const double odd = softkin_lane_odd(zz);
  const double first = (is_far ? 0.25*SOFTKIN_LANE_PI : 0.0) + (t + t*z*(even + z*odd));
  const double quarter = across > along ? 0.5*SOFTKIN_LANE_PI - first : first;
  const double half = x < 0.0 ? SOFTKIN_LANE_PI - quarter : quarter;
  return y < 0.0 ? -half : half;
}

/** `softkin_on_turn`, for numbers of reasonable size; else some turn. */
static inline double softkin_lane_turn(double value, double centre) {
  const double away = value - centre;
  const double turns = (away + (180.0 + SOFTKIN_EDGE))/360.0;
  const double counted = fabs(turns) <= SOFTKIN_LARGEST ? turns : 0.0;
  const double whole = (int)counted;
  const double below = whole > counted ? whole - 1.0 : whole;
  return away >= -180.0 - SOFTKIN_EDGE && away < 180.0 - SOFTKIN_EDGE ? value : value - 360.0*below;
}

#endif
