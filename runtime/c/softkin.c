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
    window->lowest = is_tested && isfinite(low) ? low - tolerance : -SOFTKIN_UNLIMITED;
    window->highest = is_tested && isfinite(high) ? high + tolerance : SOFTKIN_UNLIMITED;
    window->single = false;
    window->middle = 0.0;
    return SOFTKIN_OK;
  }
  const bool is_single = turns == 0.0 ? high - low <= SOFTKIN_ONE_TURN + tolerance
                                      : (high - low + 2.0*tolerance)*turns <= SOFTKIN_GEARED_TURN;
  window->lowest = is_wide ? -SOFTKIN_UNLIMITED : low - tolerance;
  window->highest = is_wide ? SOFTKIN_UNLIMITED : high + tolerance;
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

/* All roots of a scan for each choice of signs that a scan knows. */
static softkin_status all_roots(sorting *in, softkin_refusal *why) {
  in->others->count = 0;
  for (int scan = 0; scan < 1 << in->kind->side_count; scan += 1) {
    int8_t signs[SOFTKIN_MOST_BRANCHES] = {0};
    double given[2*SOFTKIN_MOST_AXES];
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

/* ---- roots of a trial along one joint, by the rules of the Python package ----
 *
 * A trial has a value, which is zero at a root, with its slope; a guard, which is negative where there is no
 * solution, with its slope; then cosine and sine of every direction. The circle is cut into cells until each
 * holds at most one root. A cell is its map (joint = base + scale s, or base + scale s² with the other side
 * at s < 0), its number of cuts, and both ends: s, and the trial there. Every constant is explained in the
 * sources of the compiler. */

#define MOST_RESULTS (4 + 2*SOFTKIN_MOST_DIRECTIONS)
#define MOST_CELLS 64
#define MOST_PLACES 128

static const double SHIFTS[] = SOFTKIN_SHIFTS;

typedef struct {
  double base, scale;
  bool is_curved;
} path;

typedef struct {
  path map;
  int cuts;
  double low, high, first[MOST_RESULTS], last[MOST_RESULTS];
} cell;

/* The cells that are still to be looked at, and the places found so far. */
typedef struct {
  const softkin_search *search;
  int trials, waiting, found;
  cell cells[MOST_CELLS];
  softkin_place places[MOST_PLACES];
} scan;

static softkin_place place_of(const path *map, double s) {
  const double way = map->is_curved ? s*s : s;
  return (softkin_place){map->base + map->scale*way, 0.0, map->is_curved && s < 0.0 ? -1 : 1, -1};
}

/* The distance that the joint travels from one end of a cell to the other. */
static double extent_of(const path *map, double low, double high) {
  return fabs(map->scale)*(high - low)*(map->is_curved ? fabs(low) + fabs(high) : 1.0);
}

static void try_at(const scan *on, const softkin_place *place, double *results) {
  if (on->search->trial(on->search->machine, on->search->arguments, place, results) != SOFTKIN_OK) {
    for (int i = 0; i < MOST_RESULTS; i += 1) {
      results[i] = NAN;
    }
  }
}

/* The results of the trial at s, with slopes by s. */
static void evaluate(scan *on, const path *map, double s, double *results) {
  const softkin_place place = place_of(map, s);
  const double rate = map->is_curved ? 2.0*map->scale*s : map->scale;
  on->trials += 1;
  try_at(on, &place, results);
  results[1] *= rate;
  results[3] *= rate;
}

static void copy(double *target, const double *results) {
  for (int i = 0; i < MOST_RESULTS; i += 1) {
    target[i] = results[i];
  }
}

static void push(scan *on, const cell *one) {
  if (on->waiting < MOST_CELLS) {
    on->cells[on->waiting] = *one;
    on->waiting += 1;
  }
}

static void add(scan *on, softkin_place place) {
  if (on->found < MOST_PLACES) {
    on->places[on->found] = place;
    on->found += 1;
  }
}

/* Store the place of a trial if it is a root. Where the guard vanishes, the value has half of its digits. */
static void offer(scan *on, const path *map, double s, const double *results) {
  const double value = fabs(results[0]), guard = results[2];
  if (!((value <= SOFTKIN_VANISHING && guard >= 0.0)
      || (value <= SOFTKIN_NEXT && fabs(guard) <= SOFTKIN_VANISHING))) {
    return;
  }
  const softkin_place place = place_of(map, s);
  for (int i = 0; i < on->found; i += 1) {
    const softkin_place *other = &on->places[i];
    if (other->side == place.side && other->freed == -1 && fabs(place.tried - other->tried) < SOFTKIN_FLAT) {
      return;
    }
  }
  add(on, place);
}

/* The two parts of a cell that is cut at s. */
static void halves(scan *on, const cell *whole, double s) {
  cell part = *whole;
  evaluate(on, &whole->map, s, part.last);
  offer(on, &whole->map, s, part.last);
  part.cuts += 1;
  part.high = s;
  push(on, &part);
  copy(part.first, part.last);
  copy(part.last, whole->last);
  part.low = s;
  part.high = whole->high;
  push(on, &part);
}

/* The cosine of the angle by which a direction turns. */
static double turn_between(const double *first, const double *last, int k) {
  return first[4 + 2*k]*last[4 + 2*k] + first[5 + 2*k]*last[5 + 2*k];
}

/* The same of the direction that turns most. */
static double turned_most(const scan *on, const double *first, const double *last) {
  double least = on->search->directions > 0 ? INFINITY : 1.0;
  for (int k = 0; k < on->search->directions; k += 1) {
    least = fmin(least, turn_between(first, last, k));
  }
  return least;
}

/* The distance from the first end at which the tangents of both ends meet; about half the cell if they do
 * not. */
static double between(double f, double df, double f1, double df1, double width) {
  if (df == df1) {
    return SOFTKIN_ASIDE*width;
  }
  const double met = (f1 - f - df1*width)/(df - df1);
  return met > 0.0 && met < width ? met : SOFTKIN_ASIDE*width;
}

/* The place of the cut: where tangents meet, and near the middle in every third step. */
static double where_to_cut(int cuts, double f, double df, double f1, double df1, double width) {
  if (cuts % 3 == 2) {
    return SOFTKIN_ASIDE*width;
  }
  return fmin(fmax(between(f, df, f1, df1, width), 0.02*width), 0.98*width);
}

/* Whether a value with one sign at both ends falls towards zero from both, and its tangents nearly meet
 * beyond it. Where they do not meet in between, the value has an inflection and may reach zero, too. Tangents
 * are no bound on a value with kinks. */
static bool comes_back(double f, double df, double f1, double df1, double width) {
  const double sign = f < 0.0 ? -1.0 : 1.0;
  if (!(f*f1 > 0.0 && sign*df < 0.0 && sign*df1 > 0.0)) {
    return false;
  }
  const double rest = f1 - f - df1*width;
  if (!(rest*(df - df1) > 0.0 && fabs(rest) < fabs(df - df1)*width)) {
    return true;
  }
  const double margin = SOFTKIN_TOUCHED + SOFTKIN_NEAR_ZERO*fmin(fabs(f), fabs(f1))
      + SOFTKIN_BENT*fabs(df1 - df)*width;
  return sign*(f + df*between(f, df, f1, df1, width)) <= margin;
}

/* Whether the cubic with these values and slopes has an extremum in the cell that may hide two roots. */
static bool is_doubtful(double f, double a, double f1, double b) {
  const double rise = f1 - f;
  const double sign = (f*f1 < 0.0 ? rise : f) < 0.0 ? -1.0 : 1.0;
  const double cube = a + b - 2.0*rise, square = 3.0*rise - 2.0*a - b;
  const double radicand = square*square - 3.0*cube*a;
  if (radicand <= 0.0 || cube == 0.0) {
    return false;
  }
  const double root = sqrt(radicand);
  double lowest = INFINITY;
  bool is_inside = false;
  for (int side = -1; side <= 1; side += 2) {
    const double divisor = 3.0*cube;
    const double u = divisor != 0.0 ? (side*root - square)/divisor : INFINITY;
    if (u > 0.0 && u < 1.0) {
      is_inside = true;
      lowest = fmin(lowest, sign*(f + u*(a + u*(square + u*cube))));
    }
  }
  if (!is_inside) {
    return false;
  }
  if (f*f1 < 0.0) {
    return sign*a >= 0.0 && sign*b >= 0.0;
  }
  return f*f1 > 0.0 && lowest <= SOFTKIN_NEAR_ZERO*fmin(fabs(f), fabs(f1));
}

/* Whether there may be more roots within a cell than the signs at its ends show. */
static bool hides_roots(double f, double df, double f1, double df1, double width) {
  const double sign = f < 0.0 ? -1.0 : 1.0;
  const bool crosses = sign*(f + df*width) < 0.0 || sign*(f1 - df1*width) < 0.0;
  if (f*f1 > 0.0 && df*df1 > 0.0 && crosses) {
    return true; /* a tangent reaches zero, extrema on both sides */
  }
  return comes_back(f, df, f1, df1, width) || is_doubtful(f, df*width, f1, df1*width);
}

/* Where a column equals a level: both ends, the better one, and the value there. Newton's method from the end
 * nearer to zero; bisection outside the cell, and in every third step. */
typedef struct {
  double low, high, best, value;
} closed;

static closed closing(scan *on, const cell *one, int column, double level) {
  double low = one->low, high = one->high, first[MOST_RESULTS], last[MOST_RESULTS], results[MOST_RESULTS];
  copy(first, one->first);
  copy(last, one->last);
  double a = first[column] - level, b = last[column] - level;
  for (int number = 0; number < SOFTKIN_CLOSING && a != 0.0 && b != 0.0; number += 1) {
    const bool is_better = fabs(a) <= fabs(b);
    const double slope = (is_better ? first : last)[column + 1];
    double s = (is_better ? low : high) - (slope != 0.0 ? (is_better ? a : b)/slope : 0.0);
    if (!(low < s && s < high) || slope == 0.0 || number % 3 == 2) {
      s = low + SOFTKIN_ASIDE*(high - low);
    }
    evaluate(on, &one->map, s, results);
    const double value = results[column] - level;
    if ((value < 0.0) == (a < 0.0)) {
      low = s;
      copy(first, results);
      a = value;
    } else {
      high = s;
      copy(last, results);
      b = value;
    }
    if (fabs(value) <= SOFTKIN_FINEST*fabs(results[column + 1])
        || extent_of(&one->map, low, high) <= SOFTKIN_FINEST) {
      break;
    }
  }
  const bool is_low = fabs(a) <= fabs(b);
  return (closed){low, high, is_low ? low : high, (is_low ? first : last)[0]};
}

/* The cells around a zero of the guard, from the end with solutions to the other side. The sides join where
 * the guard is slightly above zero; on the strip from there to zero they are one curve. */
static void over_the_end(scan *on, const cell *one) {
  const double level = fmax(one->first[2], one->last[2]) > SOFTKIN_TOUCHED ? SOFTKIN_TOUCHED : 0.0;
  const double meet = closing(on, one, 2, level).best;
  const double rim = closing(on, one, 2, 0.0).best;
  const double end = one->map.base + one->map.scale*meet;
  const double within = one->map.base + one->map.scale*(one->first[2] >= 0.0 ? one->low : one->high);
  const path curve = {end, within - end, true}, strip = {end, one->map.scale*(rim - meet), false};
  const double ends[3][2] = {{-0.5, 0.5}, {0.5, 1.0}, {0.0, SOFTKIN_RIM}};
  for (int i = 0; i < 3; i += 1) {
    cell part = {.map = i < 2 ? curve : strip, .cuts = one->cuts, .low = ends[i][0], .high = ends[i][1]};
    evaluate(on, &part.map, part.low, part.first);
    evaluate(on, &part.map, part.high, part.last);
    push(on, &part);
  }
  for (int i = 0; i < 3 && on->waiting >= 3; i += 1) {
    const cell *part = &on->cells[on->waiting - 3 + i];
    offer(on, &part->map, part->low, part->first);
  }
}

/* Store the roots at a constant joint, where the angle that turns most is free: the angles of value 0. */
static void jump(scan *on, const path *map, double low, const double *first, double high,
    const double *last) {
  if (on->search->directions == 0) {
    return;
  }
  const softkin_place middle = place_of(map, 0.5*(low + high));
  int freed = 0;
  for (int k = 1; k < on->search->directions; k += 1) {
    freed = turn_between(first, last, k) < turn_between(first, last, freed) ? k : freed;
  }
  on->trials += 3;
  double values[3], results[MOST_RESULTS];
  softkin_place place = {middle.tried, 0.0, middle.side, freed};
  for (int k = 0; k < 3; k += 1) {
    place.freed_angle = k*(2.0*PI/3.0);
    try_at(on, &place, results);
    values[k] = results[0];
  }
  const double level = (values[0] + values[1] + values[2])/3.0;
  const double along = values[0] - level, across = (values[1] - values[2])/sqrt(3.0);
  const double swing = sqrt(along*along + across*across), centre = atan2(across, along);
  const double half = swing > 0.0 ? acos(fmin(fmax(-level/swing, -1.0), 1.0)) : 0.5*PI;
  const double angles[] = {centre - half, centre + half, centre - half + PI, centre + half + PI};
  const int count = fabs(level) + swing <= SOFTKIN_NEXT ? 4 : 2;
  for (int i = 0; i < count; i += 1) {
    place.freed_angle = angles[i];
    add(on, place);
  }
}

/* Store the root of a cell that holds one and, where the value jumps, the roots with a free angle. */
static void close_in(scan *on, const cell *one) {
  const closed at = closing(on, one, 0, 0.0);
  add(on, place_of(&one->map, at.best));
  if (fabs(at.value) > SOFTKIN_TOUCHED) {
    double first[MOST_RESULTS], last[MOST_RESULTS];
    evaluate(on, &one->map, at.low, first);
    evaluate(on, &one->map, at.high, last);
    jump(on, &one->map, at.low, first, at.high, last);
  }
}

/* Store the end that is nearer to zero. Where the two sides join, both roots of the parabola with the slopes
 * of
 * both ends, or its extremum where it has none. */
static void touch(scan *on, const cell *one, bool is_seam) {
  const double width = one->high - one->low, f = one->first[0];
  const double a = one->first[1]*width, b = one->last[1]*width, bend = b - a;
  if (!is_seam || !(a*b < 0.0)) {
    add(on, place_of(&one->map, fabs(f) <= fabs(one->last[0]) ? one->low : one->high));
    return;
  }
  const double half = sqrt(fmax(a*a - 2.0*bend*f, 0.0))/fabs(bend);
  for (int side = half > 0.0 ? -1 : 1; side <= 1; side += 2) {
    add(on, place_of(&one->map, one->low + width*fmin(fmax(side*half - a/bend, 0.0), 1.0)));
  }
}

/* Cut a cell, or find its root, or see that it has none. */
static void cut(scan *on, const cell *one) {
  const bool is_curved = one->map.is_curved;
  const double low = one->low, high = one->high, width = high - low;
  const double extent = extent_of(&one->map, low, high);
  const double f = one->first[0], df = one->first[1], g = one->first[2], dg = one->first[3];
  const double f1 = one->last[0], df1 = one->last[1], g1 = one->last[2], dg1 = one->last[3];
  const bool is_seam = is_curved && -2.0*SOFTKIN_SEAM <= low && high <= 2.0*SOFTKIN_SEAM;
  if (on->trials > SOFTKIN_TRIALS - SOFTKIN_RESERVE) {
    return;
  }
  if (turned_most(on, one->first, one->last) < SOFTKIN_TURNED) {
    if (extent > SOFTKIN_NARROW && !is_seam) {
      halves(on, one, low + SOFTKIN_ASIDE*width);
    } else if (g >= -SOFTKIN_GAP || g1 >= -SOFTKIN_GAP) {
      jump(on, &one->map, low, one->first, high, one->last);
      if (is_seam) {
        touch(on, one, is_seam);
      }
    }
    return;
  }
  if (!is_curved && extent > SOFTKIN_NARROW && hides_roots(g, dg, g1, dg1, width)) {
    halves(on, one, low + where_to_cut(one->cuts, g, dg, g1, dg1, width));
    return;
  }
  if (!is_curved && (g < 0.0) != (g1 < 0.0)) {
    over_the_end(on, one);
    return;
  }
  if (!is_curved && g < 0.0) {
    return;
  }
  const bool changes = f*f1 <= 0.0, doubtful = hides_roots(f, df, f1, df1, width);
  const bool small = fmin(fabs(f), fabs(f1)) <= SOFTKIN_TOUCHED;
  if (doubtful && extent > SOFTKIN_FINEST && !small && !is_seam) {
    const double s = low + where_to_cut(one->cuts, f, df, f1, df1, width);
    const double beside = high > 1.5*SOFTKIN_SEAM ? SOFTKIN_SEAM : -SOFTKIN_SEAM;
    halves(on, one, is_curved && fabs(s) < SOFTKIN_SEAM ? beside : s);
  } else if (changes) {
    close_in(on, one);
  } else if (doubtful && (small || is_seam)) {
    touch(on, one, is_seam);
  }
}

/* Candidates for roots, in no order; only the complete closure decides whether a candidate is a root. */
static void find_roots(scan *on, double start, double shift) {
  const double width = 2.0*PI/SOFTKIN_CELLS;
  const path still = {start, 0.0, false};
  double results[MOST_RESULTS], begin[MOST_RESULTS], next[MOST_RESULTS];
  on->found = 0;
  path map = {width*shift, width, false};
  evaluate(on, &map, 0.0, begin);
  /* Those at the ends of the other cells are made when they are needed. */
  on->trials += SOFTKIN_CELLS - 1;
  evaluate(on, &still, 0.0, results);
  offer(on, &still, 0.0, results);
  copy(results, begin);
  for (int k = 0; k < SOFTKIN_CELLS; k += 1) {
    cell one = {.map = {width*(k + shift), width, false}, .cuts = 0, .low = 0.0, .high = 1.0};
    if (k + 1 < SOFTKIN_CELLS) {
      map.base = width*(k + 1 + shift);
      evaluate(on, &map, 0.0, next);
      on->trials -= 1;
    } else {
      copy(next, begin);
    }
    copy(one.first, results);
    copy(one.last, next);
    on->waiting = 0;
    push(on, &one);
    while (on->waiting > 0) {
      on->waiting -= 1;
      one = on->cells[on->waiting];
      cut(on, &one);
    }
    copy(results, next);
  }
}

static double away_from(double start, const softkin_place *place) {
  const double way = place->tried - start - SOFTKIN_AHEAD + PI;
  return fabs(way - 2.0*PI*floor(way/(2.0*PI)) - PI);
}

/* Sort the places, the nearest to the start first; equal ones keep their order. */
static void sort_places(scan *on, double start) {
  for (int i = 1; i < on->found; i += 1) {
    const softkin_place place = on->places[i];
    int k = i;
    while (k > 0 && away_from(start, &on->places[k - 1]) > away_from(start, &place)) {
      on->places[k] = on->places[k - 1];
      k -= 1;
    }
    on->places[k] = place;
  }
}

/* The candidates that the trial lists. */
static void list_roots(scan *on) {
  const softkin_search *search = on->search;
  const softkin_place nowhere = {0.0, 0.0, 1, -1};
  double results[2*SOFTKIN_MOST_LISTED];
  on->found = 0;
  if (search->trial(search->machine, search->arguments, &nowhere, results) != SOFTKIN_OK) {
    return;
  }
  for (int i = 0; i < search->listed; i += 1) {
    if (results[2*i + 1] != 0.0) {
      add(on, (softkin_place){results[2*i], 0.0, search->sides[i], -1});
    }
  }
}

/* Give the values of the roots that fit, the nearest to the start first, until they are not taken any more.
 * */
static void finished(const softkin_search *search, double start, int most, softkin_take take, void *context) {
  scan on;
  int looked = 0;
  on.search = search;
  on.trials = 0;
  on.waiting = 0;
  for (int i = 0; i < (int)(sizeof SHIFTS/sizeof SHIFTS[0]); i += 1) {
    if (i > 0 && on.trials + SOFTKIN_CELLS > SOFTKIN_TRIALS - SOFTKIN_RESERVE) {
      return;
    }
    if (search->listed > 0) {
      list_roots(&on);
    } else {
      find_roots(&on, start, SHIFTS[i]);
    }
    sort_places(&on, start);
    bool is_there = false;
    for (int k = 0; k < on.found && k < most - looked; k += 1) {
      double values[SOFTKIN_MOST_AXES + 1];
      if (search->finish(search->machine, search->arguments, &on.places[k], values) == SOFTKIN_OK
          && values[0] != 0.0) {
        is_there = true;
        if (!take(context, values)) {
          return;
        }
      }
    }
    if (is_there || search->listed > 0) {
      return;
    }
    looked = most < looked + on.found ? most : looked + on.found;
  }
}

typedef struct {
  double *values;
  int count;
} kept;

static bool take_one(void *context, const double *values) {
  const kept *target = context;
  for (int i = 0; i < target->count; i += 1) {
    target->values[i] = values[i];
  }
  return false;
}

/* True and the results of `finish` at the root that fits and is nearest to the start; false and zeros where
 * there is none, or none is wanted. */
void softkin_nearest_root(const softkin_search *search, double start, bool is_wanted, double *values) {
  kept target = {values, search->count};
  for (int i = 0; i < search->count; i += 1) {
    values[i] = 0.0;
  }
  if (is_wanted) {
    finished(search, start, SOFTKIN_FINISHED, take_one, &target);
  }
}

typedef struct {
  softkin_take take;
  void *context;
} handed;

static bool hand_on(void *context, const double *values) {
  const handed *to = context;
  return to->take(to->context, values + 1);
}

/* The results of `finish` at all roots that fit, without the first. */
void softkin_every_root(const softkin_search *search, double start, bool is_wanted, softkin_take take,
    void *context) {
  handed to = {take, context};
  if (is_wanted) {
    finished(search, start, SOFTKIN_TRIALS, hand_on, &to);
  }
}
