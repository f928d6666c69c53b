/* What all machines share: see softkin.h. */

#include "softkin.h"

#define READY UINT32_C(0x50F7C1C5)
#define MOST_TURNS 1e18 /* with more turns than this there is no nearest angle */
#define SAME 2e-3 /* axes (degrees, lengths) that differ by less are one solution of a searched branch */
#define PI 3.14159265358979323846

static const char *const MEANINGS[] = SOFTKIN_MEANINGS;
static const char *const NO_MEANING[] = SOFTKIN_NO_MEANING;

const char *softkin_meaning(softkin_status status) {
  const int number = (int)status;
  return number >= 0 && number < (int)(sizeof MEANINGS/sizeof *MEANINGS) ? MEANINGS[number] : "no status";
}

softkin_status softkin_refuse(softkin_refusal *why, softkin_status status, const char *reason,
    const char *unit, double missing, int turn) {
  if (why != NULL) {
    *why = (softkin_refusal){status, reason[0] == '\0' ? softkin_meaning(status) : reason, unit, missing,
        turn, ""};
  }
  return status;
}

softkin_status softkin_refuse_parameters(softkin_refusal *why, const char *reason, const char *parameters) {
  if (why != NULL) {
    *why = (softkin_refusal){SOFTKIN_NOT_INITIALIZED, reason, "", 0.0, 0, parameters};
  }
  return SOFTKIN_NOT_INITIALIZED;
}

static softkin_status bad(softkin_refusal *why, const char *reason) {
  return softkin_refuse(why, SOFTKIN_BAD_INPUT, reason, "", 0.0, 0);
}

/* ---- numbers ---- */

/* value + 360 k in [centre - 180, centre + 180), in degrees; the interval is shifted down by SOFTKIN_EDGE: so
 * a value
 * on an edge stays on its side in spite of rounding. */
double softkin_nearest_period(double value, double centre) {
  const double turns = (value - centre + (180.0 + SOFTKIN_EDGE))/360.0;
  return turns > -MOST_TURNS && turns < MOST_TURNS ? value - 360.0*floor(turns) : NAN;
}

/* The angle of the arc centre ± half that is nearest to an angle, in radians. */
double softkin_nearest_on_arc(double angle, double centre, double half) {
  const double away = angle - centre;
  const double turns = (away + PI)/(2.0*PI);
  if (!(turns > -MOST_TURNS && turns < MOST_TURNS)) {
    return NAN;
  }
  return centre + fmin(fmax(away - 2.0*PI*floor(turns), -half), half);
}

/* LU decomposition with partial pivoting. Singular, or not solved: a number that is NaN or beyond
 * SOFTKIN_SOLVABLE. */
double softkin_solve(double *system, int rows, int columns) {
  const int width = rows + columns;
  double largest = 0.0, determinant = 1.0;
  bool is_solvable = true;
  for (int i = 0; i < rows; i += 1) {
    for (int j = 0; j < width; j += 1) {
      const double size = fabs(system[i*width + j]);
      is_solvable = is_solvable && size <= SOFTKIN_SOLVABLE;
      largest = j < rows && size > largest ? size : largest;
    }
  }
  is_solvable = is_solvable && largest >= 1.0/SOFTKIN_SOLVABLE;
  for (int k = 0; k < rows && is_solvable; k += 1) {
    int best = k;
    for (int i = k + 1; i < rows; i += 1) {
      best = fabs(system[i*width + k]) > fabs(system[best*width + k]) ? i : best;
    }
    if (!(fabs(system[best*width + k]) > SOFTKIN_PIVOT*largest)) {
      is_solvable = false;
      break;
    }
    if (best != k) {
      for (int j = 0; j < width; j += 1) {
        const double held = system[k*width + j];
        system[k*width + j] = system[best*width + j];
        system[best*width + j] = held;
      }
      determinant = -determinant;
    }
    determinant *= system[k*width + k];
    system[k*width + k] = 1.0/system[k*width + k];
    for (int i = k + 1; i < rows; i += 1) {
      const double factor = system[i*width + k]*system[k*width + k];
      for (int j = k + 1; j < width; j += 1) {
        system[i*width + j] -= factor*system[k*width + j];
      }
    }
  }
  if (!is_solvable) {
    for (int i = 0; i < rows*width; i += 1) {
      system[i] = 0.0;
    }
    return 0.0;
  }
  for (int k = rows - 1; k >= 0; k -= 1) {
    for (int j = rows; j < width; j += 1) {
      for (int i = k + 1; i < rows; i += 1) {
        system[k*width + j] -= system[k*width + i]*system[i*width + j];
      }
      system[k*width + j] *= system[k*width + k];
    }
  }
  return determinant;
}

/* ---- turns, branches, limits ---- */

int8_t softkin_branch_byte(double margin) {
  return fabs(margin) <= SOFTKIN_COINCIDENT ? 3 : margin > 0.0 ? 1 : 2;
}

int8_t softkin_turn_of(double value) {
  const double turn = floor((value + 180.0 + SOFTKIN_EDGE)/360.0);
  const double number = turn >= 0.0 ? turn + 1.0 : turn;
  return (int8_t)(number >= -127.0 && number <= 127.0 ? number : 0.0);
}

/* The number of the turn on which an axis that is beyond its limits (degrees) would be inside. Of several the
 * one nearest to the limit that it exceeds; 0 if there is none, or none that a byte can name. */
int softkin_turn_inside(double axis, double lowest, double highest) {
  const double turns = axis > highest ? floor((highest - axis)/360.0) : -floor((axis - lowest)/360.0);
  const int number = softkin_turn_of(fmin(fmax(axis + 360.0*turns, -360.0*127.0), 360.0*126.0));
  const double inside = softkin_nearest_period(axis, number > 0 ? 360.0*number - 360.0 : 360.0*number);
  return lowest <= inside && inside <= highest ? number : 0;
}

/* The range of an axis or of another quantity. otherwise: the range if no limits are given, or NULL; turns:
 * with a gear, those of the joint per turn of the axis, else 0. */
softkin_status softkin_window_of(const softkin_limit *limit, double lower, double upper, bool is_tested,
    const double *otherwise, double turns, softkin_window *window, softkin_ends *ends, softkin_refusal *why) {
  const bool is_given = fabs(lower) + fabs(upper) > 0.0 && !(isinf(lower) && isinf(upper));
  if (is_given && !(lower < upper)) {
    return softkin_refuse_parameters(why, limit->refused, limit->parameters);
  }
  double low = is_given ? lower : otherwise != NULL ? otherwise[0] : 0.0;
  double high = is_given ? upper : otherwise != NULL ? otherwise[1] : 0.0;
  const double tolerance = SOFTKIN_LIMIT + (isfinite(low) ? SOFTKIN_LIMIT*fabs(low) : 0.0)
      + (isfinite(high) ? SOFTKIN_LIMIT*fabs(high) : 0.0);
  const bool is_open = !(isfinite(low) && isfinite(high));
  if (is_open && otherwise != NULL) {
    low = fmax(low, otherwise[0]);
    high = fmin(high, otherwise[1]);
    if (!(low < high)) {
      return softkin_refuse_parameters(why, limit->refused, limit->parameters);
    }
  }
  const bool has_limits = is_given || otherwise != NULL;
  const bool is_wide = !(has_limits && is_tested);
  *ends = (softkin_ends){has_limits ? low : -INFINITY, has_limits ? high : INFINITY};
  if (is_open) {
    window->lowest = is_tested && isfinite(low) ? low - tolerance : -SOFTKIN_LARGEST;
    window->highest = is_tested && isfinite(high) ? high + tolerance : SOFTKIN_LARGEST;
    window->single = false;
    window->middle = 0.0;
    return SOFTKIN_OK;
  }
  const bool is_single = turns == 0.0 ? high - low <= SOFTKIN_ONE_TURN + tolerance
                                      : (high - low + 2.0*tolerance)*turns <= SOFTKIN_GEARED_TURN;
  window->lowest = is_wide ? -SOFTKIN_LARGEST : low - tolerance;
  window->highest = is_wide ? SOFTKIN_LARGEST : high + tolerance;
  window->single = has_limits && is_single;
  window->middle = 0.5*low + 0.5*high;
  return SOFTKIN_OK;
}

/* ---- the rotation of a caller ---- */

#include "softkin_rotation.h"

/* ---- machines ---- */

static double number_at(const void *parameters, const softkin_parameter *parameter) {
  return *(const double *)(const void *)((const char *)parameters + parameter->place);
}

void softkin_defaults(const softkin_mechanism *kind, void *parameters) {
  for (int i = 0; i < kind->parameter_count; i += 1) {
    *(double *)(void *)((char *)parameters + kind->parameters[i].place) = kind->parameters[i].initial;
  }
}

static bool is_allowed(const softkin_parameter *parameter, double value) {
  if (parameter->has_two_values) {
    return value == parameter->low || value == parameter->high;
  }
  if (parameter->end != 0 && isinf(value)) {
    return (value < 0.0) == (parameter->end < 0);
  }
  if (parameter->is_never_zero && !(fabs(value) > SOFTKIN_LEAST)) {
    return false;
  }
  const bool is_above = parameter->low_is_open ? value > parameter->low : value >= parameter->low;
  return is_above && value <= parameter->high && value <= SOFTKIN_LARGEST;
}

softkin_status softkin_init(const softkin_mechanism *kind, void *machine, const void *parameters,
    softkin_refusal *why) {
  if (machine == NULL || parameters == NULL) {
    return softkin_refuse_parameters(why, "parameters are missing", "");
  }
  for (int i = 0; i < kind->parameter_count; i += 1) {
    const softkin_parameter *one = &kind->parameters[i];
    const double value = number_at(parameters, one);
    if (!is_allowed(one, value)) {
      return softkin_refuse_parameters(why, one->refused, one->name);
    }
  }
  const softkin_status status = kind->init(machine, parameters, why);
  if (status == SOFTKIN_OK) {
    ((softkin_base *)machine)->ready = READY;
  }
  return status;
}

/* Whether there is a machine, and nothing else is missing. */
static softkin_status refused(const void *machine, bool is_given, softkin_refusal *why) {
  if (machine == NULL || ((const softkin_base *)machine)->ready != READY) {
    return softkin_refuse(why, SOFTKIN_NOT_INITIALIZED, "not initialized", "", 0.0, 0);
  }
  return is_given ? SOFTKIN_OK : bad(why, "an array is missing");
}

static void sizes_of(const softkin_mechanism *kind, const void *machine, double *sizes) {
  for (int i = 0; i < kind->period_count; i += 1) {
    sizes[i] = 1.0;
  }
  if (kind->turn_sizes != NULL) {
    kind->turn_sizes(machine, sizes);
  }
}

static void write_turns(const softkin_mechanism *kind, const void *machine, const double *axes,
    int8_t *bytes) {
  double sizes[SOFTKIN_MOST_AXES];
  sizes_of(kind, machine, sizes);
  for (int i = 0; i < kind->period_count; i += 1) {
    bytes[kind->branch_count + i] = softkin_turn_of(sizes[i]*axes[kind->period_axes[i]]);
  }
}

softkin_status softkin_start_at(const softkin_mechanism *kind, const void *machine,
    const softkin_frame *start, void *moved, softkin_refusal *why) {
  softkin_status status = refused(machine, start != NULL && moved != NULL, why);
  softkin_frame begin;
  if (status == SOFTKIN_OK && kind->start_at == NULL) {
    return bad(why, "forward kinematics needs no start");
  }
  if (status == SOFTKIN_OK) {
    begin = *start;
    status = find_rotation(start, &begin, why);
  }
  if (status == SOFTKIN_OK) {
    kind->start_at(machine, &begin, moved);
  }
  return status;
}

softkin_status softkin_forward(const softkin_mechanism *kind, const void *machine, const double *axes,
    const softkin_frame *start, softkin_frame *frame, int8_t *configuration, double *margins,
    softkin_refusal *why) {
  softkin_status status = refused(machine, axes != NULL && frame != NULL, why);
  softkin_frame begin, found;
  double own[SOFTKIN_MOST_BRANCHES];
  if (status == SOFTKIN_OK && start != NULL) {
    if (kind->forward_from == NULL) {
      return bad(why, "forward kinematics needs no start");
    }
    begin = *start;
    status = find_rotation(start, &begin, why);
    if (status == SOFTKIN_OK) {
      status = kind->forward_from(machine, axes, &begin, &found, own, why);
    }
  } else if (status == SOFTKIN_OK) {
    status = kind->forward(machine, axes, &found, own, why);
  }
  if (status != SOFTKIN_OK) {
    return status;
  }
  if (configuration != NULL) {
    for (int i = 0; i < kind->branch_count; i += 1) {
      configuration[i] = softkin_branch_byte(own[i]);
    }
    write_turns(kind, machine, axes, configuration);
  }
  for (int i = 0; margins != NULL && i < kind->branch_count; i += 1) {
    margins[i] = own[i];
  }
  *frame = found;
  return SOFTKIN_OK;
}

/* What an inverse is asked, ready for the programs: the repaired rotation, and a reference. */
typedef struct {
  softkin_frame frame;
  double reference[SOFTKIN_MOST_AXES];
} asked;

static softkin_status asked_of(const softkin_mechanism *kind, const softkin_frame *frame,
    const double *reference, asked *given, softkin_refusal *why) {
  if (reference == NULL && kind->needs_reference != NULL) {
    return bad(why, kind->needs_reference);
  }
  for (int i = 0; i < kind->axis_count; i += 1) {
    given->reference[i] = reference == NULL ? 0.0 : reference[i];
  }
  given->frame = *frame;
  return kind->reads_rotation ? find_rotation(frame, &given->frame, why) : SOFTKIN_OK;
}

/* The squared distance from the reference over the counted axes; 0 for a reference that is no number of
 * reasonable size: then the first branch is taken. */
static double squared_distance(const softkin_mechanism *kind, const double *axes, const double *reference) {
  double total = 0.0;
  for (int i = 0; i < kind->distance_count; i += 1) {
    const int axis = kind->distance_axes[i];
    if (!(fabs(reference[axis]) <= SOFTKIN_LARGEST)) {
      return 0.0;
    }
    total += (axes[axis] - reference[axis])*(axes[axis] - reference[axis]);
  }
  return total;
}

static softkin_status beyond(const softkin_mechanism *kind, const void *machine, const double *axes,
    softkin_refusal *why) {
  return ((const softkin_base *)machine)->check_limits ? kind->limit(machine, axes, why) : SOFTKIN_OK;
}

/* The signs of a slot among those that bytes leave open; the first open byte varies fastest. */
static void signs_of(const int8_t *bytes, int count, unsigned number, int8_t *signs) {
  for (int i = 0; i < count; i += 1) {
    if (bytes[i] == 1 || bytes[i] == 2) {
      signs[i] = bytes[i] == 1 ? 1 : -1;
    } else {
      signs[i] = (number & 1u) == 0u ? 1 : -1;
      number >>= 1;
    }
  }
}

/* The axes on the slot that bytes name, or on the nearest of the open ones; if all refuse, the first
 * reason. */
static softkin_status choose(const softkin_mechanism *kind, const void *machine, const asked *given,
    const int8_t *bytes, double *axes, softkin_refusal *why) {
  unsigned slots = 1u;
  for (int i = 0; i < kind->branch_count; i += 1) {
    slots *= bytes[i] == 1 || bytes[i] == 2 ? 1u : 2u;
  }
  softkin_status outcome = SOFTKIN_OK;
  softkin_refusal first;
  bool is_found = false;
  double nearest = 0.0, found[SOFTKIN_MOST_AXES];
  for (unsigned number = 0; number < slots; number += 1) {
    int8_t signs[SOFTKIN_MOST_BRANCHES];
    signs_of(bytes, kind->branch_count, number, signs);
    softkin_refusal reason;
    const softkin_status status = kind->branch(machine, &given->frame, signs, bytes + kind->branch_count,
        given->reference, found, &reason);
    if (status != SOFTKIN_OK) {
      if (number == 0) {
        outcome = status;
        first = reason;
      }
      continue;
    }
    const double distance = squared_distance(kind, found, given->reference);
    if (!is_found || distance < nearest - ((const softkin_base *)machine)->tie) {
      nearest = distance;
      for (int i = 0; i < kind->axis_count; i += 1) {
        axes[i] = found[i];
      }
    }
    is_found = true;
  }
  if (is_found) {
    return SOFTKIN_OK;
  }
  if (why != NULL) {
    *why = first;
  }
  return outcome;
}

softkin_status softkin_inverse(const softkin_mechanism *kind, const void *machine,
    const softkin_frame *frame, const int8_t *configuration, const double *reference, double *axes,
    softkin_refusal *why) {
  softkin_status status = refused(machine, frame != NULL && axes != NULL, why);
  int8_t bytes[SOFTKIN_MOST_BRANCHES + SOFTKIN_MOST_AXES];
  asked given;
  double found[SOFTKIN_MOST_AXES];
  if (status != SOFTKIN_OK) {
    return status;
  }
  for (int i = 0; i < kind->branch_count + kind->period_count; i += 1) {
    bytes[i] = configuration == NULL ? kind->configuration[i].initial : configuration[i];
    if (i < kind->branch_count && (bytes[i] < 0 || bytes[i] > 3)) {
      return bad(why, NO_MEANING[i]);
    }
  }
  status = asked_of(kind, frame, reference, &given, why);
  if (status == SOFTKIN_OK) {
    status = choose(kind, machine, &given, bytes, found, why);
  }
  if (status == SOFTKIN_OK) {
    status = beyond(kind, machine, found, why);
  }
  for (int i = 0; status == SOFTKIN_OK && i < kind->axis_count; i += 1) {
    axes[i] = found[i];
  }
  return status;
}

softkin_status softkin_branch(const softkin_mechanism *kind, const void *machine, const softkin_frame *frame,
    const int8_t *signs, const int8_t *turns, const double *reference, double *axes, softkin_refusal *why) {
  const bool is_given = frame != NULL && reference != NULL && axes != NULL
      && (signs != NULL || kind->branch_count == 0)
      && (turns != NULL || kind->period_count == 0);
  const softkin_status status = refused(machine, is_given, why);
  return status == SOFTKIN_OK ? kind->branch(machine, frame, signs, turns, reference, axes, why) : status;
}

softkin_status softkin_jacobian(const softkin_mechanism *kind, const void *machine, const double *axes,
    double *rows, softkin_refusal *why) {
  const softkin_status status = refused(machine, axes != NULL && rows != NULL, why);
  return status == SOFTKIN_OK ? kind->jacobian(machine, axes, rows, why) : status;
}

softkin_status softkin_singularity(const softkin_mechanism *kind, const void *machine, const double *axes,
    double *margins, bool *is_singular, softkin_refusal *why) {
  softkin_status status = refused(machine, axes != NULL && margins != NULL, why);
  if (status == SOFTKIN_OK) {
    status = kind->singularity(machine, axes, margins, why);
  }
  if (status == SOFTKIN_OK && is_singular != NULL) {
    *is_singular = false;
    for (int i = 0; i < kind->margin_count; i += 1) {
      *is_singular = *is_singular || fabs(margins[i]) < ((const softkin_base *)machine)->warning_distance;
    }
  }
  return status;
}

/* The values of the axes whose product with the Jacobian is given. */
static softkin_status solved_for_axes(const softkin_mechanism *kind, const void *machine, const double *axes,
    const double *given, double *found, softkin_refusal *why) {
  double rows[SOFTKIN_MOST_ROWS*SOFTKIN_MOST_AXES], margins[SOFTKIN_MOST_MARGINS];
  double system[SOFTKIN_MOST_ROWS*(SOFTKIN_MOST_ROWS + 1)];
  const int count = kind->row_count, width = count + 1;
  bool is_singular = false;
  softkin_status status = softkin_jacobian(kind, machine, axes, rows, why);
  if (status == SOFTKIN_OK) {
    status = softkin_singularity(kind, machine, axes, margins, &is_singular, why);
  }
  if (status != SOFTKIN_OK) {
    return status;
  }
  for (int i = 0; i < count; i += 1) {
    for (int j = 0, column = 0; j < kind->axis_count && column < count; j += 1) {
      if (!kind->axes[j].is_held) {
        system[i*width + column] = rows[i*kind->axis_count + j];
        column += 1;
      }
    }
    system[i*width + count] = given[i];
  }
  if (is_singular || (count > 0 && softkin_solve(system, count, 1) == 0.0)) {
    return softkin_refuse(why, SOFTKIN_IMPOSSIBLE, "the pose is singular", "", 0.0, 0);
  }
  for (int j = 0, row = 0; j < kind->axis_count; j += 1) {
    found[j] = 0.0;
    if (!kind->axes[j].is_held && row < count) {
      found[j] = system[row*width + count];
      row += 1;
    }
  }
  return SOFTKIN_OK;
}

softkin_status softkin_axis_velocities(const softkin_mechanism *kind, const void *machine, const double *axes,
    const double *twist, double *velocities, softkin_refusal *why) {
  const softkin_status status = refused(machine, axes != NULL && twist != NULL && velocities != NULL, why);
  if (status != SOFTKIN_OK) {
    return status;
  }
  if (!softkin_are_reasonable(twist, kind->row_count)) {
    return bad(why, "");
  }
  return solved_for_axes(kind, machine, axes, twist, velocities, why);
}

softkin_status softkin_axis_accelerations(const softkin_mechanism *kind, const void *machine,
    const double *axes, const double *velocities, const double *twist_rate, double *accelerations,
    softkin_refusal *why) {
  double given[SOFTKIN_MOST_ROWS];
  softkin_status status = refused(machine,
      axes != NULL && velocities != NULL && twist_rate != NULL && accelerations != NULL, why);
  if (status == SOFTKIN_OK && !softkin_are_reasonable(twist_rate, kind->row_count)) {
    status = bad(why, "");
  }
  if (status == SOFTKIN_OK) {
    status = kind->bias(machine, axes, velocities, given, why);
  }
  if (status != SOFTKIN_OK) {
    return status;
  }
  for (int i = 0; i < kind->row_count; i += 1) {
    given[i] = twist_rate[i] - given[i];
  }
  return solved_for_axes(kind, machine, axes, given, accelerations, why);
}

softkin_status softkin_limits(const softkin_mechanism *kind, const void *machine, const double *axes,
    softkin_refusal *why) {
  const softkin_status status = refused(machine, axes != NULL, why);
  return status == SOFTKIN_OK ? beyond(kind, machine, axes, why) : status;
}

softkin_status softkin_quantities(const softkin_mechanism *kind, const void *machine, const double *axes,
    double *values, softkin_refusal *why) {
  const softkin_status status = refused(machine, axes != NULL && values != NULL, why);
  return status == SOFTKIN_OK && kind->quantities != NULL ? kind->quantities(machine, axes, values, why)
      : status;
}

/* ---- for controllers: what is near, and angles ---- */

softkin_status softkin_forward_near(const softkin_mechanism *kind, const void *machine, const double *axes,
    const softkin_frame *start, softkin_frame *frame, int8_t *configuration) {
  if (start != NULL && kind->forward_from != NULL
      && softkin_forward(kind, machine, axes, start, frame, configuration, NULL, NULL) == SOFTKIN_OK) {
    return SOFTKIN_OK;
  }
  return softkin_forward(kind, machine, axes, NULL, frame, configuration, NULL, NULL);
}

softkin_status softkin_jacobian_near(const softkin_mechanism *kind, const void *machine, const double *axes,
    const softkin_frame *start, void *moved, double *rows) {
  if (kind->start_at == NULL) {
    return softkin_jacobian(kind, machine, axes, rows, NULL);
  }
  const softkin_status status = softkin_start_at(kind, machine, start, moved, NULL);
  return status == SOFTKIN_OK ? softkin_jacobian(kind, moved, axes, rows, NULL) : status;
}

void softkin_rotation_of_angles(const double *angles, double rotation[3][3]) {
  const double sa = sin(angles[0]*SOFTKIN_DEGREE), ca = cos(angles[0]*SOFTKIN_DEGREE);
  const double sb = sin(angles[1]*SOFTKIN_DEGREE), cb = cos(angles[1]*SOFTKIN_DEGREE);
  const double sc = sin(angles[2]*SOFTKIN_DEGREE), cc = cos(angles[2]*SOFTKIN_DEGREE);
  const double rows[3][3] = {
    {cc*cb, cc*sb*sa - sc*ca, cc*sb*ca + sc*sa},
    {sc*cb, sc*sb*sa + cc*ca, sc*sb*ca - cc*sa},
    {-sb, cb*sa, cb*ca},
  };
  for (int i = 0; i < 9; i += 1) {
    rotation[i/3][i%3] = rows[i/3][i%3];
  }
}

void softkin_angles_of_rotation(const softkin_frame *frame, const double *given, double *angles) {
  const double (*r)[3] = frame->rotation;
  const double across = hypot(r[0][0], r[1][0]);
  const double first = across > SOFTKIN_COINCIDENT ? atan2(r[1][0], r[0][0]) : given[2]*SOFTKIN_DEGREE;
  const double s = sin(first), c = cos(first);
  const double a = atan2(s*r[0][2] - c*r[1][2], c*r[1][1] - s*r[0][1])*SOFTKIN_RADIAN;
  const double b = atan2(-r[2][0], c*r[0][0] + s*r[1][0])*SOFTKIN_RADIAN;
  double least = INFINITY;
  for (int other = 0; other < 2; other += 1) { /* two triples turn alike */
    const double shift = 180.0*other;
    double found[3] = {a + shift, other == 0 ? b : 180.0 - b, first*SOFTKIN_RADIAN + shift}, distance = 0.0;
    for (int i = 0; i < 3; i += 1) {
      found[i] = softkin_nearest_period(found[i], given[i]);
      distance += (found[i] - given[i])*(found[i] - given[i]);
    }
    if (other == 0 || distance < least - SOFTKIN_TIE) {
      least = distance;
      angles[0] = found[0], angles[1] = found[1], angles[2] = found[2];
    }
  }
}

void softkin_turns_by_angles(const double *angles, double turns[3][3]) {
  const double sb = sin(angles[1]*SOFTKIN_DEGREE), cb = cos(angles[1]*SOFTKIN_DEGREE);
  const double sc = sin(angles[2]*SOFTKIN_DEGREE), cc = cos(angles[2]*SOFTKIN_DEGREE);
  const double rows[3][3] = {{cb*cc, -sc, 0.0}, {cb*sc, cc, 0.0}, {-sb, 0.0, 1.0}};
  for (int i = 0; i < 9; i += 1) {
    turns[i/3][i%3] = rows[i/3][i%3];
  }
}

double softkin_unit_of(const softkin_mechanism *kind, int axis) {
  return kind->axes[axis].unit[0] == 'd' ? SOFTKIN_DEGREE : 1.0;
}

/* ---- all branches ---- */

/* What sorts the roots of a search into slots. */
typedef struct {
  const softkin_mechanism *kind;
  const void *machine;
  const asked *given;
  const int8_t *turns;
  softkin_others *others;
} sorting;

/* Whether axes differ by full turns alone. */
static bool is_same(const sorting *in, const double *axes, const double *other) {
  double apart[SOFTKIN_MOST_AXES], sizes[SOFTKIN_MOST_AXES];
  sizes_of(in->kind, in->machine, sizes);
  for (int i = 0; i < in->kind->axis_count; i += 1) {
    apart[i] = fabs(axes[i] - other[i]);
  }
  for (int i = 0; i < in->kind->period_count; i += 1) {
    double *one = &apart[in->kind->period_axes[i]];
    const double turned = sizes[i]**one + 180.0;
    *one = fabs(turned - 360.0*floor(turned/360.0) - 180.0)/sizes[i];
  }
  for (int i = 0; i < in->kind->axis_count; i += 1) {
    if (!(apart[i] < SAME)) {
      return false;
    }
  }
  return true;
}

static void keep(const sorting *in, const double *axes, int slot) {
  softkin_others *others = in->others;
  const int count = in->kind->axis_count;
  for (int i = 0; i < others->count; i += 1) {
    if (others->slots[i] == slot && is_same(in, axes, &others->axes[i*count])) {
      return;
    }
  }
  if (others->count < others->capacity) {
    for (int i = 0; i < count; i += 1) {
      others->axes[others->count*count + i] = axes[i];
    }
    others->slots[others->count] = slot;
    others->count += 1;
  }
}

/* Keep the axes of a root in the slot of its branch; where branches meet, in the slots of both. */
static bool sort_in(void *context, const double *joints) {
  const sorting *in = context;
  double axes[SOFTKIN_MOST_AXES], margins[SOFTKIN_MOST_BRANCHES];
  softkin_frame frame;
  if (in->kind->from_joints(in->machine, joints, in->turns, in->given->reference, axes, NULL) != SOFTKIN_OK
      || in->kind->forward(in->machine, axes, &frame, margins, NULL) != SOFTKIN_OK) {
    return true;
  }
  const int branches = in->kind->branch_count;
  for (int slot = 0; slot < 1 << branches; slot += 1) {
    bool fits = true;
    for (int i = 0; i < branches; i += 1) {
      const bool is_second = (slot >> i & 1) != 0;
      fits = fits && (fabs(margins[i]) < SOFTKIN_COINCIDENT || (margins[i] > 0.0) != is_second);
    }
    if (fits) {
      keep(in, axes, slot);
    }
  }
  return true;
}

/* All roots of a search for each choice of signs that it knows. */
static softkin_status all_roots(sorting *in, softkin_refusal *why) {
  in->others->count = 0;
  for (int scan = 0; scan < 1 << in->kind->side_count; scan += 1) {
    int8_t signs[SOFTKIN_MOST_BRANCHES] = {0};
    double given[SOFTKIN_MOST_GIVEN];
    for (int i = 0; i < in->kind->side_count; i += 1) {
      signs[i] = (scan >> i & 1) == 0 ? 1 : -1;
    }
    const softkin_status status = in->kind->search_given(in->machine, &in->given->frame, signs, in->turns,
        in->given->reference, given, why);
    if (status != SOFTKIN_OK) {
      return status;
    }
    in->kind->every_root(in->machine, given, sort_in, in);
  }
  return SOFTKIN_OK;
}

/* Move the first solution of a slot that is inside the limits out of the others; those beyond limits go. */
static bool take_first(const sorting *in, int slot, double *axes) {
  softkin_others *others = in->others;
  const int count = in->kind->axis_count;
  bool is_found = false;
  int kept = 0;
  for (int i = 0; i < others->count; i += 1) {
    const double *own = &others->axes[i*count];
    const bool is_own = others->slots[i] == slot;
    const bool is_inside = !is_own || beyond(in->kind, in->machine, own, NULL) == SOFTKIN_OK;
    const bool is_first = is_own && is_inside && !is_found;
    for (int j = 0; is_inside && j < count; j += 1) {
      *(is_first ? &axes[j] : &others->axes[kept*count + j]) = own[j];
    }
    is_found = is_found || is_first;
    if (is_inside && !is_first) {
      others->slots[kept] = others->slots[i];
      kept += 1;
    }
  }
  others->count = kept;
  return is_found;
}

bool softkin_refuse_all(softkin_status status, softkin_status *statuses, int count) {
  for (int i = 0; i < count; i += 1) {
    statuses[i] = status;
  }
  return true;
}

/* Every branch with automatic turns together; false if each has to be solved by itself. */
static bool together(const softkin_mechanism *kind, const void *machine, const asked *given,
    softkin_status *statuses, double *axes) {
  return kind->every_branch != NULL && softkin_are_reasonable(given->frame.position, 3)
      && softkin_are_reasonable(given->reference, kind->axis_count)
      && kind->every_branch(machine, &given->frame, given->reference, statuses, axes);
}

softkin_status softkin_branches(const softkin_mechanism *kind, const void *machine,
    const softkin_frame *frame, const double *reference, softkin_status *statuses, double *axes) {
  const softkin_status missing = refused(machine,
      frame != NULL && reference != NULL && statuses != NULL && axes != NULL, NULL);
  static const int8_t open[SOFTKIN_MOST_BRANCHES + SOFTKIN_MOST_AXES] = {0};
  if (missing != SOFTKIN_OK) {
    return missing;
  }
  if (kind->every_branch != NULL) {
    if (!softkin_are_reasonable(frame->position, 3) || !softkin_are_reasonable(reference, kind->axis_count)) {
      return SOFTKIN_BAD_INPUT;
    }
    if (kind->every_branch(machine, frame, reference, statuses, axes)) {
      return SOFTKIN_OK;
    }
  }
  for (int slot = 0; slot < 1 << kind->branch_count; slot += 1) {
    int8_t signs[SOFTKIN_MOST_BRANCHES];
    signs_of(open, kind->branch_count, (unsigned)slot, signs);
    statuses[slot] = kind->branch(machine, frame, signs, open, reference, &axes[slot*kind->axis_count], NULL);
    if (statuses[slot] == SOFTKIN_BAD_INPUT) {
      return SOFTKIN_BAD_INPUT;
    }
  }
  return SOFTKIN_OK;
}

/* The axes of one slot, or why there are none. */
static softkin_status fill_slot(const sorting *in, const int8_t *signs, double *axes, softkin_refusal *why) {
  const softkin_status status = in->kind->branch(in->machine, &in->given->frame, signs, in->turns,
      in->given->reference, axes, why);
  return status == SOFTKIN_OK ? beyond(in->kind, in->machine, axes, why) : status;
}

softkin_status softkin_inverse_all(const softkin_mechanism *kind, const void *machine,
    const softkin_frame *frame, const double *reference, softkin_status *statuses, double *axes,
    int8_t *configurations, softkin_refusal *whys, softkin_others *others) {
  softkin_refusal why;
  const softkin_status missing = refused(machine, frame != NULL && statuses != NULL && axes != NULL, &why);
  if (missing != SOFTKIN_OK || (reference == NULL && kind->needs_reference != NULL)) {
    return missing != SOFTKIN_OK ? missing : SOFTKIN_BAD_INPUT;
  }
  const bool is_searched = ((const softkin_base *)machine)->is_searched;
  if (is_searched && (others == NULL || others->axes == NULL || others->slots == NULL)) {
    return SOFTKIN_BAD_INPUT;
  }
  if (others != NULL) {
    others->count = 0;
  }
  asked given;
  const int8_t open[SOFTKIN_MOST_BRANCHES + SOFTKIN_MOST_AXES] = {0};
  const int size = kind->branch_count + kind->period_count;
  sorting in = {kind, machine, &given, open, others};
  softkin_status all = asked_of(kind, frame, reference, &given, &why);
  if (all == SOFTKIN_OK && is_searched) {
    all = all_roots(&in, &why);
  }
  double line[SOFTKIN_MOST_TOGETHER*SOFTKIN_MOST_AXES];
  softkin_status outcomes[SOFTKIN_MOST_TOGETHER];
  const bool is_together = all == SOFTKIN_OK && !is_searched
      && 1 << kind->branch_count <= SOFTKIN_MOST_TOGETHER
      && together(kind, machine, &given, outcomes, line);
  for (int slot = 0; slot < 1 << kind->branch_count; slot += 1) {
    int8_t signs[SOFTKIN_MOST_BRANCHES], bytes[SOFTKIN_MOST_BRANCHES + SOFTKIN_MOST_AXES] = {0};
    double own[SOFTKIN_MOST_AXES], *found = own;
    softkin_status status = all;
    signs_of(open, kind->branch_count, (unsigned)slot, signs);
    if (is_together && (whys == NULL || outcomes[slot] == SOFTKIN_OK)) {
      found = &line[slot*kind->axis_count];
      status = outcomes[slot] == SOFTKIN_OK ? beyond(kind, machine, found, &why) : outcomes[slot];
    } else if (all == SOFTKIN_OK && !(is_searched && take_first(&in, slot, found))) {
      status = fill_slot(&in, signs, found, &why);
      if (is_searched
          && status == SOFTKIN_OK) { /* a root that only the search for one branch finds is none */
        status = softkin_refuse(&why, SOFTKIN_UNREACHABLE, "", "", 0.0, 0);
      }
    }
    for (int i = 0; i < kind->branch_count; i += 1) {
      bytes[i] = signs[i] > 0 ? 1 : 2;
    }
    if (status == SOFTKIN_OK) {
      if (configurations != NULL) {
        write_turns(kind, machine, found, bytes);
      }
      for (int i = 0; i < kind->axis_count; i += 1) {
        axes[slot*kind->axis_count + i] = found[i];
      }
    } else if (whys != NULL) {
      whys[slot] = why;
    }
    for (int i = 0; configurations != NULL && i < size; i += 1) {
      configurations[slot*size + i] = bytes[i];
    }
    statuses[slot] = status;
  }
  return SOFTKIN_OK;
}

/* ---- all roots of a search along one joint: the next one ahead, again and again around the circle ---- */

#define MOST_ROOTS 48
#define LONGEST 0.5 /* the longest step (radians) where every joint value is a root */
#define NEAR 3e-5   /* roots that are nearer to each other (radians) nearly join */

typedef struct {
  double away, joints[SOFTKIN_MOST_AXES];
} root;

/* How far a joint is from the start: a root as far to the other side is behind one ahead. */
static double distance_to(double difference) {
  const double away = difference - SOFTKIN_AHEAD;
  return fabs(away - 2.0*PI*round(away/(2.0*PI)));
}

/* Put the root that a search found behind others, and its twin; their number. */
static int put(const softkin_roots *of, root *found, int count, double away, const double *results) {
  const double *twin = &results[2 + of->joints];
  const int number = of->has_twins && twin[0] != 0.0 ? 2 : 1;
  for (int k = 0; k < number && count < MOST_ROOTS; k += 1, count += 1) {
    found[count].away = away;
    for (int i = 0; i < of->joints; i += 1) {
      found[count].joints[i] = k == 0 ? results[2 + i] : twin[1 + i];
    }
  }
  return count;
}

/* The nearest roots first. */
static void sort_roots(root *found, int count) {
  for (int k = 1; k < count; k += 1) {
    const root one = found[k];
    int at = k;
    for (; at > 0 && found[at - 1].away > one.away; at -= 1) {
      found[at] = found[at - 1];
    }
    found[at] = one;
  }
}

/* All roots, found onward from an angle. Where the arm moves while its tool rests, every joint value is a
   root: a stretch of them has one, and the nearest to the start is added. */
static int roots_from(const softkin_roots *of, double begin, root *found) {
  double given[SOFTKIN_MOST_GIVEN], results[2*SOFTKIN_MOST_AXES + 3];
  double left = 2.0*PI - SOFTKIN_AHEAD, skip = 0.0;
  int count = 0;
  bool moves = false, is_near = false;
  for (int i = 0; i < of->count; i += 1) {
    given[i] = of->given[i];
  }
  given[of->onward] = 1.0;
  given[of->start] = begin;
  for (int searches = 0; searches < MOST_ROOTS && count < MOST_ROOTS; searches += 1) {
    if (of->find(of->machine, given, results, NULL) != SOFTKIN_OK || results[0] == 0.0) {
      break;
    }
    left -= count > 0 ? results[1] : 0.0;
    if (left <= 0.0) {
      break;
    }
    given[of->start] += results[1];
    const bool was_near = is_near;
    is_near = count > 0 && results[1] < NEAR;
    if (count > 0 && results[1] < 1.1*SOFTKIN_AHEAD) { /* roots without end: nothing new is near */
      skip = fmin(fmax(4.0*skip, SOFTKIN_AHEAD), LONGEST);
      given[of->start] += skip;
      left -= skip;
      moves = moves || skip == LONGEST;
    } else { /* between two roots that nearly join the pose is as good as met */
      skip = 0.0;
      count -= is_near && was_near ? 1 : 0;
      count = put(of, found, count, distance_to(given[of->start] - of->given[of->start]), results);
    }
  }
  given[of->onward] = 0.0;
  given[of->start] = of->given[of->start];
  if (moves && of->find(of->machine, given, results, NULL) == SOFTKIN_OK && results[0] != 0.0) {
    count = put(of, found, count, results[1], results);
  }
  sort_roots(found, count);
  return count;
}

void softkin_every_root(const softkin_roots *of, softkin_take take, void *context) {
  root found[MOST_ROOTS];
  const double begin = of->given[of->start] + SOFTKIN_ELSEWHERE;
  int count = roots_from(of, begin, found);
  count = count > 0 ? count : roots_from(of, begin + 1.0, found); /* a root may stand at the first, too */
  for (int i = 0; i < count && take(context, found[i].joints); i += 1) {
  }
}
