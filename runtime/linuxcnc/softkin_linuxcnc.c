/**
 * @file softkin_linuxcnc.c
 * A kinematics module of LinuxCNC, for any machine: what motion calls, and the pins. A module is this source
 * behind the C of its machine and its `softkin_this`.
 */

#include "rtapi.h"
#include "rtapi_app.h"
#include "hal.h"
#include "emcmotcfg.h"
#include "kinematics.h"

#include "softkin_linuxcnc.h"

#define THIS softkin_this
#define KIND (THIS.kind)
#define JOINTS (KIND->axis_count)
#define LETTERS SOFTKIN_LETTERS
#define Z_WORD 2
#define A_WORD 3
#define C_WORD 5

/* ---- the HAL: 2.9 has pins that are pointers, master pins that functions read and write ---- */

#ifdef HAL_REAL
typedef hal_real_t real_pin;
typedef hal_bool_t bit_pin;
typedef hal_sint_t number_pin;
#define NEW_REAL(pin, direction, name) hal_pin_new_real(component, direction, pin, 0.0, "%s", name)
#define NEW_BIT(pin, direction, name) hal_pin_new_bool(component, direction, pin, 0, "%s", name)
#define NEW_NUMBER(pin, direction, name) hal_pin_new_si32(component, direction, pin, 0, "%s", name)
#define GET_REAL(pin) hal_get_real(pin)
#define GET_BIT(pin) hal_get_bool(pin)
#define SET_REAL(pin, value) (void)hal_set_real(pin, value)
#define SET_BIT(pin, value) (void)hal_set_bool(pin, value)
#define SET_NUMBER(pin, value) (void)hal_set_si32(pin, value)
#else
typedef hal_float_t *real_pin;
typedef hal_bit_t *bit_pin;
typedef hal_s32_t *number_pin;
#define NEW_REAL(pin, direction, name) hal_pin_float_newf(direction, pin, component, "%s", name)
#define NEW_BIT(pin, direction, name) hal_pin_bit_newf(direction, pin, component, "%s", name)
#define NEW_NUMBER(pin, direction, name) hal_pin_s32_newf(direction, pin, component, "%s", name)
#define GET_REAL(pin) (*(pin))
#define GET_BIT(pin) (*(pin))
#define SET_REAL(pin, value) (*(pin) = (value))
#define SET_BIT(pin, value) (*(pin) = (value))
#define SET_NUMBER(pin, value) (*(pin) = (value))
#endif

/* The pin of a parameter. */
typedef union {
  real_pin real;
  bit_pin bit;
} given_pin;

/* The pins, in the memory of the HAL. */
typedef struct {
  real_pin tool_offset;
  bit_pin is_refused, is_singular;
  number_pin refused, forward_status, inverse_status;
  real_pin missing;
  bit_pin types[2];
  given_pin given[];
} pins;

static int component;
static pins *hal;
static int kinematics_type; /* 0: the machine, 1: identity */

/* ---- parameters ---- */

static softkin_numbers numbers;
static bool has_read;
static double tool_offset; /* which LinuxCNC adds to Z, and the machine has along its tool */

static bool is_flag(int number) {
  return KIND->parameters[number].has_two_values && KIND->parameters[number].low == 0.0;
}

static double value_of_pin(int number) {
  const given_pin pin = hal->given[number];
  return is_flag(number) ? (GET_BIT(pin.bit) ? 1.0 : 0.0) : GET_REAL(pin.real);
}

static bool is_same_number(double one, double other) {
  return one == other || (isnan(one) && isnan(other));
}

/* Whether a list of names, with commas, begins with a name. */
static bool begins_with(const char *names, const char *name) {
  int i = 0;
  while (name[i] != '\0' && names[i] == name[i]) {
    i += 1;
  }
  return name[i] == '\0' && (names[i] == '\0' || names[i] == ',');
}

/* Read every pin. If one has changed the machine is set up again; if it is refused it stays as it was. */
static void read_parameters(void) {
  const double offset = THIS.tool_pin != NULL ? GET_REAL(hal->tool_offset) : 0.0;
  bool is_new = !has_read;
  for (int i = 0; i < KIND->parameter_count; i += 1) {
    double *last = (double *)(void *)((char *)THIS.parameters + KIND->parameters[i].place);
    const double value = value_of_pin(i) + (THIS.tool_pin != NULL && i == THIS.tool_length ? offset : 0.0);
    is_new = is_new || !is_same_number(value, *last);
    *last = value;
  }
  if (!is_new) {
    return;
  }
  has_read = true;
  softkin_refusal why;
  const bool is_refused = softkin_init(KIND, THIS.machine, THIS.parameters, &why) != SOFTKIN_OK;
  int refused = 0;
  for (int i = KIND->parameter_count; is_refused && i > 0; i -= 1) {
    refused = begins_with(why.parameters, KIND->parameters[i - 1].name) ? i : refused;
  }
  SET_BIT(hal->is_refused, is_refused);
  SET_NUMBER(hal->refused, refused);
  if (is_refused) {
    rtapi_print_msg(RTAPI_MSG_ERR, "%s: %s\n", THIS.name, why.reason);
    return;
  }
  tool_offset = offset;
  THIS.find_numbers(&numbers);
}

/* ---- poses ---- */

static void copy(double *to, const double *from, int count) {
  for (int i = 0; i < count; i += 1) {
    to[i] = from[i];
  }
}

static void read_words(const EmcPose *pose, double *words) {
  const double found[LETTERS] = {
    pose->tran.x, pose->tran.y, pose->tran.z, pose->a, pose->b, pose->c, pose->u, pose->v, pose->w,
  };
  copy(words, found, LETTERS);
}

static void write_words(EmcPose *pose, const double *words) {
  pose->tran.x = words[0], pose->tran.y = words[1], pose->tran.z = words[2];
  pose->a = words[3], pose->b = words[4], pose->c = words[5];
  pose->u = words[6], pose->v = words[7], pose->w = words[8];
}

/* A number of reasonable size as it is, any other as 0: where a call begins, not what it is asked. */
static double usable(double value) {
  return softkin_are_reasonable(&value, 1) ? value : 0.0;
}

/* The last pose of the machine, and for how many calls it stands for the pose before: behind identity mode
 * the poses of LinuxCNC are joint values. */
static double last_words[LETTERS];
static bool has_last;
static int calls_after_identity;

static void words_before(const EmcPose *pose, double *words) {
  const bool is_ours = has_last && calls_after_identity > 0;
  read_words(pose, words);
  for (int i = 0; i < LETTERS; i += 1) {
    words[i] = is_ours ? last_words[i] : usable(words[i]);
  }
  calls_after_identity -= calls_after_identity > 0 ? 1 : 0;
}

/* Which of x, y, z the motion of a row of the Jacobian is along; -1 if the row is a turn. */
static int coordinate_of(int row) {
  return KIND->rows[row][1] == '\0' ? KIND->rows[row][0] - 'x' : -1;
}

static const softkin_frame ORIGIN = {{0.0, 0.0, 0.0}, {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};

/* Turn a frame as the angles of a pose say. With C alone the flange stays along z, and may look down. */
static void turn(softkin_frame *frame, const double *words) {
  double angles[3] = {0.0, 0.0, 0.0};
  const int first = 3 - THIS.angles;
  if (THIS.angles == 0) {
    return;
  }
  copy(&angles[first], &words[A_WORD + first], THIS.angles);
  softkin_rotation_of_angles(angles, frame->rotation);
  for (int i = 0; i < 3; i += 1) {
    frame->rotation[i][1] *= numbers.flange;
    frame->rotation[i][2] *= numbers.flange;
  }
}

/* The frame of a pose, where an iteration begins. */
static softkin_frame frame_at(const double *words) {
  softkin_frame start = ORIGIN;
  copy(start.position, words, 3);
  turn(&start, words);
  return start;
}

static double angle_about_z(const softkin_frame *frame) {
  return atan2(frame->rotation[1][0], frame->rotation[0][0])*SOFTKIN_RADIAN;
}

/* C at joint values: their sum, with the part of a turn that is constant. */
static double counted_turn(const double *axes, const softkin_frame *frame) {
  double sum = 0.0;
  for (int i = 0; i < JOINTS; i += 1) {
    sum += numbers.turn_factors[i]*axes[i];
  }
  return sum + softkin_nearest_period(angle_about_z(frame) - sum, 0.0);
}

/* ---- the machine ---- */

/* The frame at joint values. before: the pose before, where iterations begin, or NULL. */
static softkin_status frame_of(
    const double *axes, const double *before, softkin_frame *frame, int8_t *bytes) {
  const bool has_start = before != NULL && KIND->forward_from != NULL;
  const softkin_frame start = has_start ? frame_at(before) : ORIGIN;
  return softkin_forward_near(KIND, THIS.machine, axes, has_start ? &start : NULL, frame, bytes);
}

/* Forward kinematics: the words of the pose at joint values; angles near those of the pose before. */
static softkin_status forward(const double *axes, const double *before, double *words, int8_t *bytes) {
  softkin_frame frame;
  const softkin_status status = frame_of(axes, before, &frame, bytes);
  if (status != SOFTKIN_OK) {
    return status;
  }
  for (int i = 0; i < LETTERS; i += 1) {
    words[i] = 0.0;
  }
  for (int row = 0; row < KIND->row_count; row += 1) {
    const int i = coordinate_of(row);
    if (i >= 0) {
      words[i] = frame.position[i] + (i == Z_WORD ? tool_offset : 0.0);
    }
  }
  if (THIS.angles == 3) {
    softkin_angles_of_rotation(&frame, &before[A_WORD], &words[A_WORD]);
  } else if (THIS.counts_turns) {
    words[C_WORD] = counted_turn(axes, &frame);
  } else if (THIS.angles == 1) {
    words[C_WORD] = softkin_nearest_period(angle_about_z(&frame), before[C_WORD]);
  }
  for (int i = 0; i < JOINTS; i += 1) {
    if (THIS.own_letters[i] >= 0) {
      words[THIS.own_letters[i]] = axes[i];
    }
  }
  return SOFTKIN_OK;
}

static softkin_status bad_input(softkin_refusal *why) {
  return softkin_refuse(why, SOFTKIN_BAD_INPUT, "", "", 0.0, 0);
}

/* The rates of the joints by those of the pose, in front of them the matrix that is solved. */
static bool rates_of(const double *joint, const double *words, double *system) {
  double rows[SOFTKIN_MOST_ROWS*LETTERS], turns[3][3];
  const softkin_frame there = frame_at(words);
  char *const moved = (char *)THIS.machine + KIND->machine_size;
  double *line = system, *letters = system + JOINTS;
  softkin_frame about = ORIGIN;
  if (softkin_jacobian_near(KIND, THIS.machine, joint, &there, moved, rows) != SOFTKIN_OK) {
    return false;
  }
  /* rows "tilt x" and "tilt y" are about axes of the tool */
  if (THIS.angles > 0 && KIND->rows[KIND->row_count - 1][1] == 'i') {
    const softkin_frame *begin = KIND->forward_from == NULL ? NULL : &there;
    if (softkin_forward(KIND, THIS.machine, joint, begin, &about, NULL, NULL, NULL) != SOFTKIN_OK) {
      return false;
    }
  }
  softkin_turns_by_angles(&words[A_WORD], turns);
  for (int row = 0; row < KIND->row_count; row += 1) {
    const int coordinate = coordinate_of(row);
    if (coordinate < 0 && THIS.angles == 0) {
      continue;
    }
    for (int i = 0; i < JOINTS; i += 1) {
      line[i] = rows[row*JOINTS + i]*softkin_unit_of(KIND, i);
    }
    if (coordinate >= 0) {
      letters[coordinate] = 1.0;
    }
    const int axis = coordinate < 0 ? KIND->rows[row][5] - 'x' : 0; /* "turn x" */
    for (int i = 3 - THIS.angles; coordinate < 0 && i < 3; i += 1) {
      for (int j = 0; j < 3; j += 1) {
        letters[A_WORD + i] += about.rotation[j][axis]*turns[j][i]*SOFTKIN_DEGREE;
      }
    }
    line += JOINTS + LETTERS;
    letters += JOINTS + LETTERS;
  }
  for (int i = 0; i < JOINTS; i += 1) {
    if (THIS.own_letters[i] >= 0) {
      line[i] = 1.0;
      letters[THIS.own_letters[i]] = 1.0;
      line += JOINTS + LETTERS;
      letters += JOINTS + LETTERS;
    }
  }
  return softkin_solve(system, JOINTS, LETTERS) != 0.0;
}

/* Inverse kinematics of a machine whose rotary joints are letters: the position follows from the linear
 * joints in a straight line, which one step finds. */
static softkin_status inverse_of_axes(const double *words, double *axes, softkin_refusal *why) {
  double system[LETTERS*2*LETTERS] = {0.0};
  softkin_frame frame;
  for (int i = 0; i < JOINTS; i += 1) {
    axes[i] = THIS.own_letters[i] >= 0 ? words[THIS.own_letters[i]] : 0.0;
  }
  const softkin_status status = softkin_forward(KIND, THIS.machine, axes, NULL, &frame, NULL, NULL, why);
  if (status != SOFTKIN_OK) {
    return status;
  }
  bool is_found = rates_of(axes, words, system);
  for (int row = 0; row < KIND->row_count; row += 1) {
    const int letter = coordinate_of(row);
    is_found = is_found && (letter < 0 || softkin_are_reasonable(&words[letter], 1));
    for (int i = 0; is_found && letter >= 0 && i < JOINTS; i += 1) {
      const double rate = THIS.own_letters[i] < 0 ? system[i*(JOINTS + LETTERS) + JOINTS + letter] : 0.0;
      axes[i] += rate*(words[letter] - frame.position[letter]);
    }
  }
  is_found = is_found && softkin_are_reasonable(axes, JOINTS);
  return is_found ? softkin_limits(KIND, THIS.machine, axes, why) : bad_input(why);
}

/* Inverse kinematics of a frame, on the branch that bytes name, near a reference. */
static softkin_status inverse_of_frame(
    const double *words, const int8_t *bytes, double *reference, double *axes, softkin_refusal *why) {
  softkin_frame frame = ORIGIN;
  if (THIS.reads_still) { /* if there is none, the origin stays */
    (void)softkin_forward(KIND, THIS.machine, reference, NULL, &frame, NULL, NULL, NULL);
  }
  for (int row = 0; row < KIND->row_count; row += 1) {
    if (coordinate_of(row) >= 0) {
      frame.position[coordinate_of(row)] = words[coordinate_of(row)];
    }
  }
  if (!softkin_are_reasonable(&words[C_WORD + 1 - THIS.angles], THIS.angles)) {
    return bad_input(why);
  }
  turn(&frame, words);
  for (int i = 0; i < JOINTS; i += 1) {
    reference[i] = THIS.own_letters[i] >= 0 ? words[THIS.own_letters[i]] : reference[i];
  }
  softkin_status status = softkin_inverse(KIND, THIS.machine, &frame, bytes, reference, axes, why);
  for (int pass = 0; THIS.counts_turns && status == SOFTKIN_OK && pass < 2; pass += 1) {
    const double turns = nearbyint((words[C_WORD] - counted_turn(axes, &frame))/360.0);
    if (turns == 0.0) {
      return SOFTKIN_OK;
    }
    if (pass > 0 || THIS.carrier < 0) {
      return softkin_refuse(
          why, SOFTKIN_UNREACHABLE, "C: its turn is beyond the limits", "deg", 360.0*fabs(turns), 0);
    }
    copy(reference, axes, JOINTS);
    reference[THIS.carrier] += 360.0*turns/numbers.turn_factors[THIS.carrier];
    status = softkin_inverse(KIND, THIS.machine, &frame, bytes, reference, axes, why);
  }
  return status;
}

/* ---- what LinuxCNC calls ---- */

KINEMATICS_TYPE kinematicsType(void) {
  return KINEMATICS_BOTH;
}

int kinematicsSwitchable(void) {
  return 1;
}

int kinematicsSwitch(int type) {
  if (type != 0 && type != 1) {
    return -1;
  }
  if (kinematics_type == 1 && type == 0) {
    calls_after_identity = 2; /* of the pose that is commanded, and of the one that is fed back */
  }
  kinematics_type = type;
  SET_BIT(hal->types[0], type == 0);
  SET_BIT(hal->types[1], type == 1);
  return 0;
}

int kinematicsForward(const double *joint, EmcPose *world, const KINEMATICS_FORWARD_FLAGS *fflags,
    KINEMATICS_INVERSE_FLAGS *iflags) {
  double words[LETTERS] = {0.0};
  softkin_status status = SOFTKIN_OK;
  bool is_singular = false;
  (void)fflags;
  read_parameters();
  if (kinematics_type == 1) {
    status = softkin_are_reasonable(joint, JOINTS) ? SOFTKIN_OK : SOFTKIN_BAD_INPUT;
    for (int i = 0; i < JOINTS; i += 1) {
      words[THIS.joint_letters[i]] = joint[i];
    }
  } else {
    int8_t bytes[SOFTKIN_MOST_BRANCHES + SOFTKIN_MOST_AXES];
    double margins[SOFTKIN_MOST_MARGINS], before[LETTERS];
    words_before(world, before);
    status = forward(joint, before, words, bytes);
    if (status == SOFTKIN_OK) {
      KINEMATICS_INVERSE_FLAGS flags = 0;
      for (int i = 0; i < KIND->branch_count; i += 1) {
        flags |= ((KINEMATICS_INVERSE_FLAGS)bytes[i] & 3u) << (2*i);
      }
      *iflags = flags;
      is_singular = softkin_singularity(KIND, THIS.machine, joint, margins, &is_singular, NULL) != SOFTKIN_OK
          || is_singular;
      copy(last_words, words, LETTERS);
      has_last = true;
    }
  }
  SET_NUMBER(hal->forward_status, (int)status);
  SET_BIT(hal->is_singular, is_singular || status != SOFTKIN_OK);
  if (status != SOFTKIN_OK) {
    return -1;
  }
  write_words(world, words);
  return 0;
}

int kinematicsInverse(const EmcPose *world, double *joint, const KINEMATICS_INVERSE_FLAGS *iflags,
    KINEMATICS_FORWARD_FLAGS *fflags) {
  double found[LETTERS], reference[LETTERS], words[LETTERS];
  softkin_status status = SOFTKIN_OK;
  softkin_refusal why = {SOFTKIN_OK, "", "", 0.0, 0, ""};
  read_parameters();
  read_words(world, words);
  if (kinematics_type == 1) {
    for (int i = 0; i < JOINTS; i += 1) {
      found[i] = words[THIS.joint_letters[i]];
    }
    status = softkin_are_reasonable(found, JOINTS) ? SOFTKIN_OK : SOFTKIN_BAD_INPUT;
  } else {
    int8_t bytes[SOFTKIN_MOST_BRANCHES + SOFTKIN_MOST_AXES] = {0};
    for (int i = 0; i < KIND->branch_count; i += 1) {
      bytes[i] = (int8_t)(*iflags >> (2*i) & 3u);
    }
    for (int i = 0; i < JOINTS; i += 1) {
      reference[i] = usable(joint[i]);
    }
    words[Z_WORD] -= tool_offset;
    status = THIS.are_axes ? inverse_of_axes(words, found, &why)
        : inverse_of_frame(words, bytes, reference, found, &why);
  }
  SET_NUMBER(hal->inverse_status, (int)status);
  SET_REAL(hal->missing, status == SOFTKIN_OK ? 0.0 : why.missing);
  if (status != SOFTKIN_OK) {
    return -1;
  }
  copy(joint, found, JOINTS);
  *fflags = 0;
  return 0;
}

EXPORT_SYMBOL(kinematicsType);
EXPORT_SYMBOL(kinematicsSwitchable);
EXPORT_SYMBOL(kinematicsSwitch);
EXPORT_SYMBOL(kinematicsForward);
EXPORT_SYMBOL(kinematicsInverse);
MODULE_LICENSE("Dual MIT/GPL");

/* ---- rates of the joints by rates of the pose: proposed for LinuxCNC, in no release yet ---- */

#if (defined(KINS_JACOBIAN_STEP) || defined(SOFTKIN_WITH_JACOBIAN)) && !defined(SOFTKIN_NO_JACOBIAN)
int kinematicsJacobian(const double *joint, const EmcPose *world,
    double jac[EMCMOT_MAX_JOINTS][EMCMOT_MAX_AXIS], const KINEMATICS_INVERSE_FLAGS *iflags);

/* jac[j][a]: the rate of joint j by a unit rate of letter a, in their own units. */
int kinematicsJacobian(const double *joint, const EmcPose *world,
    double jac[EMCMOT_MAX_JOINTS][EMCMOT_MAX_AXIS], const KINEMATICS_INVERSE_FLAGS *iflags) {
  double system[LETTERS*2*LETTERS] = {0.0}, words[LETTERS];
  (void)iflags;
  read_parameters();
  read_words(world, words);
  if (kinematics_type == 0 && !rates_of(joint, words, system)) {
    return -1;
  }
  for (int i = 0; i < EMCMOT_MAX_JOINTS; i += 1) {
    for (int j = 0; j < EMCMOT_MAX_AXIS; j += 1) {
      const double same = i < JOINTS && j == THIS.joint_letters[i] ? 1.0 : 0.0;
      jac[i][j] = kinematics_type == 1 || i >= JOINTS ? same : system[i*(JOINTS + LETTERS) + JOINTS + j];
    }
  }
  return 0;
}
EXPORT_SYMBOL(kinematicsJacobian);
#endif

/* ---- the tool and the work against the machine: in LinuxCNC since August 2026, in no release yet ---- */

#if defined(TOOL_FRAME_MAX_SOLUTIONS) || defined(SOFTKIN_WITH_FRAMES)
int kinematicsToolFrame(const double *joint, PmRotationMatrix *rot, const KINEMATICS_FORWARD_FLAGS *fflags);
int kinematicsWorkFrame(const double *joint, PmRotationMatrix *rot, const KINEMATICS_FORWARD_FLAGS *fflags);

static void write_columns(PmRotationMatrix *rot, double columns[3][3]) {
  PmCartesian *const written[] = {&rot->x, &rot->y, &rot->z};
  for (int i = 0; i < 3; i += 1) {
    written[i]->x = columns[i][0];
    written[i]->y = columns[i][1];
    written[i]->z = columns[i][2];
  }
}

/* The frame at joint values, of which those of a table, or all others, turn nothing. */
static softkin_status turned_frame(const double *joint, bool is_table_still, softkin_frame *frame) {
  double axes[LETTERS];
  for (int i = 0; i < JOINTS; i += 1) {
    axes[i] = THIS.has_table && THIS.on_table[i] == is_table_still ? numbers.zeros[i] : joint[i];
  }
  return frame_of(axes, has_last ? last_words : NULL, frame, NULL);
}

/* The columns are the axes of the tool, whose z axis leads from its tip to its holder. */
int kinematicsToolFrame(const double *joint, PmRotationMatrix *rot, const KINEMATICS_FORWARD_FLAGS *fflags) {
  softkin_frame frame = ORIGIN;
  (void)fflags;
  read_parameters();
  const double sense = kinematics_type == 0 ? numbers.tool_sense : 1.0;
  if (kinematics_type == 0 && turned_frame(joint, true, &frame) != SOFTKIN_OK) {
    return -1;
  }
  double columns[3][3];
  for (int i = 0; i < 3; i += 1) {
    columns[0][i] = frame.rotation[i][0];
    columns[1][i] = sense*frame.rotation[i][1];
    columns[2][i] = sense*frame.rotation[i][2];
  }
  write_columns(rot, columns);
  return 0;
}

/* The columns are the axes of the work, in which the frame is told; they stay if there is no table. */
int kinematicsWorkFrame(const double *joint, PmRotationMatrix *rot, const KINEMATICS_FORWARD_FLAGS *fflags) {
  softkin_frame frame = ORIGIN;
  (void)fflags;
  read_parameters();
  if (THIS.has_table && kinematics_type == 0 && turned_frame(joint, false, &frame) != SOFTKIN_OK) {
    return -1;
  }
  write_columns(rot, frame.rotation);
  return 0;
}
EXPORT_SYMBOL(kinematicsToolFrame);
EXPORT_SYMBOL(kinematicsWorkFrame);
#endif

/* ---- the module ---- */

static int make_pins(void) {
  int result = 0;
  for (int i = 0; i < KIND->parameter_count && result == 0; i += 1) {
    const double initial = KIND->parameters[i].initial;
    given_pin *const pin = &hal->given[i];
    if (is_flag(i) && (result = NEW_BIT(&pin->bit, HAL_IN, THIS.pins[i])) == 0) {
      SET_BIT(pin->bit, initial != 0.0);
    } else if (!is_flag(i) && (result = NEW_REAL(&pin->real, HAL_IN, THIS.pins[i])) == 0) {
      SET_REAL(pin->real, isnan(initial) ? 0.0 : initial);
    }
  }
  if (result == 0 && THIS.tool_pin != NULL) {
    result = NEW_REAL(&hal->tool_offset, HAL_IN, THIS.tool_pin);
    if (result == 0) {
      SET_REAL(hal->tool_offset, 0.0);
    }
  }
  if (result != 0 || (result = NEW_BIT(&hal->is_refused, HAL_OUT, "softkin.parameters-refused")) != 0
      || (result = NEW_NUMBER(&hal->refused, HAL_OUT, "softkin.parameter-refused")) != 0
      || (result = NEW_BIT(&hal->is_singular, HAL_OUT, "softkin.is-singular")) != 0
      || (result = NEW_NUMBER(&hal->forward_status, HAL_OUT, "softkin.forward-status")) != 0
      || (result = NEW_NUMBER(&hal->inverse_status, HAL_OUT, "softkin.inverse-status")) != 0
      || (result = NEW_REAL(&hal->missing, HAL_OUT, "softkin.missing")) != 0
      || (result = NEW_BIT(&hal->types[0], HAL_OUT, "kinstype.is-0")) != 0
      || (result = NEW_BIT(&hal->types[1], HAL_OUT, "kinstype.is-1")) != 0) {
    return result;
  }
  return kinematicsSwitch(0);
}

int rtapi_app_main(void) {
  int result;
  component = hal_init(THIS.name);
  if (component < 0) {
    return component;
  }
  hal = hal_malloc((long)(sizeof(pins) + (size_t)KIND->parameter_count*sizeof(given_pin)));
  result = hal == NULL ? -1 : make_pins();
  if (result != 0) {
    hal_exit(component);
    return result;
  }
  return hal_ready(component);
}

void rtapi_app_exit(void) {
  hal_exit(component);
}
