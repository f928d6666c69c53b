/**
 * @file softkin.h
 * The common part of all machines: statuses, refusals with their reasons, frames, the description of a
 * machine,
 * and its calls.
 *
 * It needs only C99 and libm, allocates no memory and has no global state. A machine is a struct of constants
 * that its
 * `_init` fills from a struct of parameters; afterwards every call only reads it, so that any number of
 * threads and tasks may use one machine. Every call returns a status for any input: numbers that are
 * NaN, infinite or larger than SOFTKIN_LARGEST in size are refused. Results are written only where the status
 * is SOFTKIN_OK.
 *
 * Lengths and linear axes are in the user's unit of length (u), rotary axes in degrees, the Jacobian per
 * radian. It does not compile with -ffast-math, /fp:fast or another option that removes tests for NaN. With
 * -ffp-contract=off all processors agree to the last digits.
 *
 * A call needs little stack (about 5 kB), except for machines whose inverse is a root search: these need
 * about 36 kB.
 */

#ifndef SOFTKIN_H
#define SOFTKIN_H

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) || defined(_M_FP_FAST)
#error "compile without -ffast-math, -Ofast, -ffinite-math-only, /fp:fast: they remove the tests for NaN"
#endif

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "softkin_constants.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The largest number of roots of a scan that a call of all branches keeps. */
#define SOFTKIN_MOST_SOLUTIONS 128

/** The reason why a call refuses. Every call takes a pointer to one, or NULL, and fills it where it refuses.
 * */
typedef struct {
  softkin_status status;
  const char *reason;  /**< a sentence that names the axis, the leg or the parameter; constant text */
  const char *unit;    /**< of the missing amount: "u", "deg", or "" for a number without a unit */
  double missing;      /**< the missing amount; 0 where there is no amount */
  int turn;            /**< where the turn of an axis is the reason: a turn inside the limits; else 0 */
  const char *parameters; /**< of a refused machine: the parameters at fault, with commas; else "" */
} softkin_refusal;

/** Position (u) and rotation by rows; the columns are the axes of the frame. */
typedef struct {
  double position[3];
  double rotation[3][3];
} softkin_frame;

/** The range that is tested of an axis or of another quantity: infinite if there is no limit. */
typedef struct {
  double lower, upper;
} softkin_ends;

/** The first members of all machines. */
typedef struct {
  uint32_t ready; /**< set by `_init` */
  bool check_limits;
  bool is_searched; /**< whether the inverse is a root search: then a branch may have several solutions */
  double warning_distance;
  double tie; /**< squared distances (degrees, or u without rotary axes) that differ by less are equal */
} softkin_base;

/** Further solutions of a machine with a root search; the caller owns the arrays. */
typedef struct {
  int capacity; /**< in: the size of the arrays in solutions, at least SOFTKIN_MOST_SOLUTIONS */
  double *axes; /**< capacity times the number of axes */
  int *slots;   /**< the slot of each */
  int count;    /**< out */
} softkin_others;

/** The description of an axis. */
typedef struct {
  const char *name, *kind, *unit, *meaning;
  bool multi_turn; /**< it may turn more than once */
  bool is_held;    /**< it keeps the value of the reference */
} softkin_axis;

/** The description of a parameter: a double in the struct of parameters, also a flag (0, 1) and a sign (-1,
 * 1). */
typedef struct {
  const char *name, *kind, *unit, *meaning;
  double low, high;
  bool low_is_open;      /**< more than `low`, not at least */
  bool is_never_zero;
  bool has_two_values;   /**< a flag or a sign: `low` or `high`, nothing between */
  int end;               /**< -1, 1: a lower or an upper limit, which may be infinite (no limit); else 0 */
  double initial;        /**< the default; NaN where it must be given */
  double nominal;        /**< of the pictures and tests */
  const char *refused;   /**< the sentence that refuses it */
  size_t place;          /**< its offset in the struct of parameters, in bytes */
} softkin_parameter;

/** The description of a byte of the configuration; branch bytes come first, then the turns of axes. */
typedef struct {
  const char *name;
  const char *first, *second; /**< the words of bytes 1 and 2 of a branch; "" of a turn */
  int8_t initial;
} softkin_byte;

/** A margin: dimensionless and signed, zero at its singularity. */
typedef struct {
  const char *name, *kind;
} softkin_margin;

/** A quantity with limits: the axes come first, then other quantities. */
typedef struct {
  const char *name, *unit;
  const char *parameters; /**< "lower_…, upper_…" */
  const char *refused;    /**< the sentence that refuses them */
} softkin_limit;

/** Receives the values of a root; false ends the search. */
typedef bool (*softkin_take)(void *context, const double *values);

/**
 * A mechanism as data, and its programs. Each machine has one, `…_mechanism`, for code that works with any
 * machine: interfaces, tests, simulators. The typed calls of a machine are the same with its own types.
 */
typedef struct {
  const char *name, *summary, *source;
  int axis_count, branch_count, period_count, row_count, margin_count, limit_count, parameter_count;
  int quantity_count, distance_count, side_count;
  bool reads_rotation;
  size_t machine_size, parameters_size;
  const softkin_axis *axes;
  const softkin_parameter *parameters;
  const softkin_byte *configuration;
  const softkin_limit *limits;
  const softkin_margin *margins;
  const char *const *rows;
  const int *period_axes;   /**< whose turns the last bytes of the configuration name */
  const int *distance_axes; /**< whose distance to the reference decides an automatic choice */
  const char
      *needs_reference; /**< the reason to refuse an inverse without a reference; NULL if it is allowed */
  softkin_status (*init)(void *machine, const void *parameters, softkin_refusal *why);
  softkin_status (*forward)(const void *machine, const double *axes, softkin_frame *frame, double *margins,
      softkin_refusal *why);
  softkin_status (*forward_from)(const void *machine, const double *axes, const softkin_frame *start,
      softkin_frame *frame, double *margins, softkin_refusal *why); /**< or NULL */
  void (*start_at)(const void *machine, const softkin_frame *start, void *moved); /**< or NULL */
  softkin_status (*branch)(const void *machine, const softkin_frame *frame, const int8_t *signs,
      const int8_t *turns, const double *reference, double *axes, softkin_refusal *why);
  softkin_status (*limit)(const void *machine, const double *axes, softkin_refusal *why);
  softkin_status (*singularity)(const void *machine, const double *axes, double *margins,
      softkin_refusal *why);
  softkin_status (*jacobian)(const void *machine, const double *axes, double *rows, softkin_refusal *why);
  softkin_status (*bias)(const void *machine, const double *axes, const double *speeds, double *accelerations,
      softkin_refusal *why);
  softkin_status (*quantities)(const void *machine, const double *axes, double *values, softkin_refusal *why);
  softkin_status (*search_given)(const void *machine, const softkin_frame *frame, const int8_t *signs,
      const int8_t *turns, const double *reference, double *given, softkin_refusal *why);
  softkin_status (*from_joints)(const void *machine, const double *joints, const int8_t *turns,
      const double *reference, double *axes, softkin_refusal *why);
  bool (*every_branch)(const void *machine, const softkin_frame *frame, const double *reference,
      softkin_status *statuses, double *axes); /**< all branches in one straight line, or NULL */
  void (*every_root)(const void *machine, const double *given, softkin_take take, void *context);
  void (*turn_sizes)(const void *machine, double *sizes); /**< or NULL, where all are 1 */
} softkin_mechanism;

/** The meaning of a status. */
const char *softkin_meaning(softkin_status status);

/** Parameters with their defaults; those that must be given are NaN, which `softkin_init` refuses. */
void softkin_defaults(const softkin_mechanism *kind, void *parameters);

/**
 * Fill the constants of a machine.
 *
 * @return SOFTKIN_OK, or SOFTKIN_NOT_INITIALIZED where a parameter is not allowed: the machine stays as it
 *   was
 */
softkin_status softkin_init(const softkin_mechanism *kind, void *machine, const void *parameters,
    softkin_refusal *why);

/**
 * The frame at axis values. Limits are not tested.
 *
 * @param start where the search for the frame begins, of a machine that has `forward_from`; NULL: its home
 *   pose
 * @param configuration bytes of the pose, NULL if not wanted; margins: signed, of the branches, NULL likewise
 * @return SOFTKIN_OK, SOFTKIN_NOT_INITIALIZED, SOFTKIN_BAD_INPUT, SOFTKIN_IMPOSSIBLE
 */
softkin_status softkin_forward(const softkin_mechanism *kind, const void *machine, const double *axes,
    const softkin_frame *start, softkin_frame *frame, int8_t *configuration, double *margins,
    softkin_refusal *why);

/**
 * The machine whose forward kinematics begins at `start`: with it, every call of axis values answers for the
 * frame that
 * they have there.
 *
 * @param start the frame that the axes have, or one nearby; `kind` must have `start_at`
 * @param moved `kind->machine_size` bytes
 */
softkin_status softkin_start_at(const softkin_mechanism *kind, const void *machine,
    const softkin_frame *start, void *moved, softkin_refusal *why);

/**
 * The axis values that reach a frame.
 *
 * @param frame a rotation with few exact digits, as from single precision, is repaired
 * @param configuration a byte for each branch (1, 2; 0 and 3: whichever is nearer to the reference), then one
 *   for the turn of each multi-turn axis (1: [-180, 180), 2: [180, 540), -1: [-540, -180) …; 0: the nearest
 *   to the reference); NULL: the default
 * @param reference a value for each axis, usually the present ones; NULL: zeros
 * @return SOFTKIN_OK, SOFTKIN_NOT_INITIALIZED, SOFTKIN_BAD_INPUT, SOFTKIN_UNREACHABLE (out of reach, or
 *   beyond a limit), SOFTKIN_IMPOSSIBLE
 */
softkin_status softkin_inverse(const softkin_mechanism *kind, const void *machine,
    const softkin_frame *frame, const int8_t *configuration, const double *reference, double *axes,
    softkin_refusal *why);

/**
 * Every branch of the inverse, in fixed slots: branch 1 before branch 2, the first byte varies fastest.
 *
 * No slot is left out: a slot without axes has a status and a reason, also where its axes are beyond limits.
 * Turns are automatic. The number of slots is 2 to the power of the number of branches.
 *
 * @param statuses one for each slot
 * @param axes of each slot; those of a slot that refuses are not written
 * @param configurations bytes of each slot, NULL if not wanted; whys: the reasons, NULL likewise
 * @param others further solutions; needed where the machine is searched, else it may be NULL
 * @return SOFTKIN_OK, SOFTKIN_NOT_INITIALIZED; SOFTKIN_BAD_INPUT for a missing array
 */
softkin_status softkin_inverse_all(const softkin_mechanism *kind, const void *machine,
    const softkin_frame *frame, const double *reference, softkin_status *statuses, double *axes,
    int8_t *configurations, softkin_refusal *whys, softkin_others *others);

/**
 * One branch, for inner loops: no limits, no choice, no repair of the rotation, which must be one.
 *
 * @param signs of each branch: 1 for byte 1, -1 for byte 2
 * @param turns of each multi-turn axis, as in a configuration
 */
softkin_status softkin_branch(const softkin_mechanism *kind, const void *machine, const softkin_frame *frame,
    const int8_t *signs, const int8_t *turns, const double *reference, double *axes, softkin_refusal *why);

/**
 * Every branch with automatic turns, for inner loops, in the slots of `softkin_inverse_all`: no limits, no
 * repair of
 * the rotation, which must be exact.
 *
 * @param statuses one for each slot; axes: of each slot, without a meaning where it refuses
 * @return SOFTKIN_OK, SOFTKIN_NOT_INITIALIZED; SOFTKIN_BAD_INPUT for a missing array and for numbers that are
 * none
 */
softkin_status softkin_branches(const softkin_mechanism *kind, const void *machine,
    const softkin_frame *frame, const double *reference, softkin_status *statuses, double *axes);

/** The Jacobian by rows, per radian: `row_count` times `axis_count`, rows as in `rows`. */
softkin_status softkin_jacobian(const softkin_mechanism *kind, const void *machine, const double *axes,
    double *rows, softkin_refusal *why);

/**
 * The velocities of the axes for a twist of the frame, both per radian: the inverse of the Jacobian. An axis
 * that is held does not move.
 *
 * @param twist `row_count` numbers, rows as in `rows`; velocities: `axis_count`
 * @return SOFTKIN_OK, SOFTKIN_IMPOSSIBLE at a singular pose, or as `softkin_jacobian`
 */
softkin_status softkin_axis_velocities(const softkin_mechanism *kind, const void *machine, const double *axes,
    const double *twist, double *velocities, softkin_refusal *why);

/**
 * The accelerations of the axes that give the frame an acceleration, per radian.
 *
 * @param velocities those of the axes, as `softkin_axis_velocities` finds them
 * @param twist_rate the rate of the twist; zeros on a straight line at constant speed
 * @return as `softkin_axis_velocities`
 */
softkin_status softkin_axis_accelerations(const softkin_mechanism *kind, const void *machine,
    const double *axes, const double *velocities, const double *twist_rate, double *accelerations,
    softkin_refusal *why);

/**
 * The margins, each zero at its singularity.
 *
 * @param is_singular whether one is smaller in size than the parameter `warning_distance`; NULL if not wanted
 * @return SOFTKIN_OK, or why the axis values allow no pose: then they are singular, and have no margins
 */
softkin_status softkin_singularity(const softkin_mechanism *kind, const void *machine, const double *axes,
    double *margins, bool *is_singular, softkin_refusal *why);

/** Whether axis values are inside the limits, if these are tested: SOFTKIN_OK, or SOFTKIN_UNREACHABLE. */
softkin_status softkin_limits(const softkin_mechanism *kind, const void *machine, const double *axes,
    softkin_refusal *why);

/** The quantities other than axes that have limits, `quantity_count` of them. */
softkin_status softkin_quantities(const softkin_mechanism *kind, const void *machine, const double *axes,
    double *values, softkin_refusal *why);

/** The byte of a branch by its signed margin: 1, 2, or 3 where both branches meet. */
int8_t softkin_branch_byte(double margin);

/** The number of the turn of a value in degrees: 1 is [-180, 180), -1 is [-540, -180) …; 0: beyond a byte. */
int8_t softkin_turn_of(double value);

/**
 * As `softkin_forward` from a frame nearby; if the machine has no start, or no frame is found from there,
 * from the home pose.
 *
 * @param start NULL: from the home pose
 */
softkin_status softkin_forward_near(const softkin_mechanism *kind, const void *machine, const double *axes,
    const softkin_frame *start, softkin_frame *frame, int8_t *configuration);

/**
 * As `softkin_jacobian`, for the frame that the axes have at or near `start`.
 *
 * @param moved `kind->machine_size` bytes, of a machine that has `start_at`
 */
softkin_status softkin_jacobian_near(const softkin_mechanism *kind, const void *machine, const double *axes,
    const softkin_frame *start, void *moved, double *rows);

/** The rotation Rz(c) Ry(b) Rx(a) of angles {a, b, c}, degrees. */
void softkin_rotation_of_angles(const double *angles, double rotation[3][3]);

/** The angles {a, b, c} of a rotation that are nearest to given ones; if b is a right angle, with their c. */
void softkin_angles_of_rotation(const softkin_frame *frame, const double *given, double *angles);

/** The rates of turning about x, y, z (rows) by those of angles {a, b, c}. */
void softkin_turns_by_angles(const double *angles, double turns[3][3]);

/** The radians in the unit of a rotary axis, and 1 of a linear one. */
double softkin_unit_of(const softkin_mechanism *kind, int axis);

/* From here on: declarations for the sources of machines. */

#define SOFTKIN_DEGREE (3.14159265358979323846/180.0)
#define SOFTKIN_RADIAN (180.0/3.14159265358979323846)

/** The range of an axis in the form that programs read. */
typedef struct {
  double lowest, highest; /* with their tolerance */
  bool single;            /* at most one turn is inside */
  double middle;
} softkin_window;

/** The program that finds a root: whether there is one, how far it is from the start, and the joints; with
 * twins also whether other joints stand there, too, and these. And its arguments, with the places of the
 * start among them, and of the flag that asks for the next root. */
typedef struct {
  softkin_status (*find)(const void *machine, const double *given, double *results, softkin_refusal *why);
  const void *machine;
  const double *given;
  int count, start, onward, joints;
  bool has_twins;
} softkin_roots;

/** Fill a refusal, if there is one to fill, and return the status. */
softkin_status softkin_refuse(softkin_refusal *why, softkin_status status, const char *reason,
    const char *unit, double missing, int turn);
softkin_status softkin_refuse_parameters(softkin_refusal *why, const char *reason, const char *parameters);
double softkin_nearest_period(double value, double centre);
double softkin_nearest_on_arc(double angle, double centre, double half);
/** Write a status into all slots; true. */
bool softkin_refuse_all(softkin_status status, softkin_status *statuses, int count);
int softkin_turn_inside(double axis, double lowest, double highest);
/** Solve `system` (rows, rows + columns) in place; the determinant. All is zero if it is singular. */
double softkin_solve(double *system, int rows, int columns);
softkin_status softkin_window_of(const softkin_limit *limit, double lower, double upper, bool is_tested,
    const double *otherwise, double turns, softkin_window *window, softkin_ends *ends, softkin_refusal *why);
/** Hand over the joints at all roots that fit, the nearest to the start first. */
void softkin_every_root(const softkin_roots *of, softkin_take take, void *context);

/** Whether all are numbers of reasonable size. */
static inline bool softkin_are_reasonable(const double *numbers, int count) {
  for (int i = 0; i < count; i += 1) {
    if (!(fabs(numbers[i]) <= SOFTKIN_LARGEST)) {
      return false;
    }
  }
  return true;
}

/** The square root of x, and 0 for a negative x. */
static inline double softkin_root(double x) {
  return x > 0.0 ? sqrt(x) : 0.0;
}

/** The angle of (x, y) in radians, in (-pi, pi]; 0 for (0, 0). Zeros have no sign. */
static inline double softkin_angle_of(double y, double x) {
  return atan2(y + 0.0, x + 0.0);
}

/** `softkin_nearest_period`, which nearly always is the value itself. */
static inline double softkin_on_turn(double value, double centre) {
  const double away = value - centre;
  return away >= -180.0 - SOFTKIN_EDGE && away < 180.0 - SOFTKIN_EDGE ? value
      : softkin_nearest_period(value, centre);
}

#ifdef __cplusplus
}
#endif

#endif
