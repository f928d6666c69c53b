/**
 * @file softkin_fmu.c
 * A machine as an FMU of FMI 3.0, for Co-Simulation and Model Exchange: its outputs are functions of its inputs, and
 * there are no states. Whatever is read is computed when it is read first after an input has changed.
 *
 * The only allocations are in fmi3Instantiate…, and in fmi3GetFMUState and fmi3DeserializeFMUState where the caller has
 * no state yet.
 */

#include "softkin_fmu.h"

#include <stdlib.h>
#include <string.h>

/* The groups of variables, in the order of their value references, as in modelDescription.xml. */
enum {
  TIME, PARAMETERS, AXES, TARGET, REFERENCE, CONFIGURATION,
  POSE, POSE_CONFIGURATION, POSE_STATUS, POSE_REASON,
  SOLUTION, MISSING, UNIT, TURN, SOLUTION_STATUS, SOLUTION_REASON,
  JACOBIAN, JACOBIAN_STATUS, JACOBIAN_REASON,
  MARGINS, IS_SINGULAR, MARGINS_STATUS, MARGINS_REASON,
  LIMITS_STATUS, LIMITS_REASON, GROUPS
};
enum { FRAME = 12 };
typedef enum { FLOAT64, INT8, INT32, INT64, BOOLEAN, TEXT } kind_of_value;

static const softkin_mechanism *const kind = SOFTKIN_FMU_MECHANISM;

/* What fmi3GetFMUState keeps: all that an instance has, without what it computes of it. */
typedef struct {
  uint8_t is_running; /* behind the initialization: parameters are fixed */
  uint8_t is_made;    /* the machine has the present parameters */
  uint8_t is_stale;   /* an input has changed since the outputs were computed */
} flags;

typedef struct {
  fmi3InstanceEnvironment environment;
  fmi3LogMessageCallback log;
  size_t starts[GROUPS + 1];
  flags flags;
  double *values; /* of every variable; integers and flags as numbers */
  const char **texts;
  void *machine, *parameters;
} fmu;

static size_t size_of(int group) {
  switch (group) {
    case PARAMETERS: return (size_t)kind->parameter_count;
    case AXES: case REFERENCE: case SOLUTION: return (size_t)kind->axis_count;
    case CONFIGURATION: case POSE_CONFIGURATION: return (size_t)(kind->branch_count + kind->period_count);
    case TARGET: case POSE: return FRAME;
    case JACOBIAN: return (size_t)(kind->row_count*kind->axis_count);
    case MARGINS: return (size_t)kind->margin_count;
    default: return 1;
  }
}

static int group_of(const fmu *m, size_t reference) {
  int group = 0;
  while (reference >= m->starts[group + 1]) {
    group += 1;
  }
  return group;
}

static kind_of_value kind_of(const fmu *m, size_t reference) {
  const int group = group_of(m, reference);
  switch (group) {
    case PARAMETERS: {
      const softkin_parameter *one = &kind->parameters[reference - m->starts[PARAMETERS]];
      return !one->has_two_values ? FLOAT64 : one->low == 0.0 ? BOOLEAN : INT8;
    }
    case CONFIGURATION: case POSE_CONFIGURATION: return INT8;
    case POSE_STATUS: case SOLUTION_STATUS: case JACOBIAN_STATUS: case MARGINS_STATUS: case LIMITS_STATUS:
      return INT64;
    case UNIT: case POSE_REASON: case SOLUTION_REASON: case JACOBIAN_REASON: case MARGINS_REASON: case LIMITS_REASON:
      return TEXT;
    case IS_SINGULAR: return BOOLEAN;
    case TURN: return INT32;
    default: return FLOAT64;
  }
}

static void report(const fmu *m, const char *message) {
  if (m->log != NULL) {
    m->log(m->environment, fmi3Error, "error", message);
  }
}

static fmi3Status fault(const fmu *m, const char *message) {
  if (m != NULL) {
    report(m, message);
  }
  return fmi3Error;
}

static void begin(fmu *m) {
  m->flags = (flags){.is_stale = true};
  for (size_t i = 0; i < m->starts[GROUPS]; i += 1) {
    m->values[i] = 0.0;
    m->texts[i] = "";
  }
  for (int i = 0; i < kind->parameter_count; i += 1) {
    const double initial = kind->parameters[i].initial;
    m->values[m->starts[PARAMETERS] + (size_t)i] = isnan(initial) ? 0.0 : initial;
  }
  for (size_t i = 0; i < 3; i += 1) {
    m->values[m->starts[TARGET] + 3 + 4*i] = 1.0;
    m->values[m->starts[POSE] + 3 + 4*i] = 1.0;
  }
  for (size_t i = 0; i < size_of(CONFIGURATION); i += 1) {
    m->values[m->starts[CONFIGURATION] + i] = kind->configuration[i].initial;
  }
}

static softkin_status make(fmu *m, softkin_refusal *why) {
  softkin_defaults(kind, m->parameters);
  for (int i = 0; i < kind->parameter_count; i += 1) {
    char *place = (char *)m->parameters + kind->parameters[i].place;
    memcpy(place, &m->values[m->starts[PARAMETERS] + (size_t)i], sizeof(double));
  }
  memset(m->machine, 0, kind->machine_size);
  m->flags.is_made = true;
  return softkin_init(kind, m->machine, m->parameters, why);
}

/* Write a status, and its reason into the next group. */
static void write_status(fmu *m, int group, softkin_status status, const softkin_refusal *why) {
  m->values[m->starts[group]] = status;
  m->texts[m->starts[group + 1]] = status == SOFTKIN_OK ? "" : why->reason;
}

static void find_pose(fmu *m, softkin_refusal *why) {
  softkin_frame frame;
  int8_t bytes[SOFTKIN_MOST_BRANCHES + SOFTKIN_MOST_AXES];
  const double *axes = m->values + m->starts[AXES];
  const softkin_status status = softkin_forward(kind, m->machine, axes, NULL, &frame, bytes, NULL, why);
  write_status(m, POSE_STATUS, status, why);
  if (status == SOFTKIN_OK) {
    double *pose = m->values + m->starts[POSE];
    memcpy(pose, frame.position, sizeof frame.position);
    memcpy(pose + 3, frame.rotation, sizeof frame.rotation);
    for (size_t i = 0; i < size_of(POSE_CONFIGURATION); i += 1) {
      m->values[m->starts[POSE_CONFIGURATION] + i] = bytes[i];
    }
  }
}

/* A byte of a configuration: a state that was damaged may hold any number. */
static int8_t byte_of(double value) {
  return value >= -128.0 && value <= 127.0 ? (int8_t)value : 0;
}

static void find_solution(fmu *m, softkin_refusal *why) {
  softkin_frame frame;
  int8_t bytes[SOFTKIN_MOST_BRANCHES + SOFTKIN_MOST_AXES];
  const double *target = m->values + m->starts[TARGET];
  memcpy(frame.position, target, sizeof frame.position);
  memcpy(frame.rotation, target + 3, sizeof frame.rotation);
  for (size_t i = 0; i < size_of(CONFIGURATION); i += 1) {
    bytes[i] = byte_of(m->values[m->starts[CONFIGURATION] + i]);
  }
  const double *reference = m->values + m->starts[REFERENCE];
  double *axes = m->values + m->starts[SOLUTION];
  const softkin_status status = softkin_inverse(kind, m->machine, &frame, bytes, reference, axes, why);
  write_status(m, SOLUTION_STATUS, status, why);
  const bool is_refused = status != SOFTKIN_OK;
  m->values[m->starts[MISSING]] = is_refused ? why->missing : 0.0;
  m->values[m->starts[TURN]] = is_refused ? why->turn : 0;
  m->texts[m->starts[UNIT]] = is_refused ? why->unit : "";
}

static void find_derivatives(fmu *m, softkin_refusal *why) {
  bool is_singular = false;
  const double *axes = m->values + m->starts[AXES];
  double *rows = m->values + m->starts[JACOBIAN], *margins = m->values + m->starts[MARGINS];
  write_status(m, JACOBIAN_STATUS, softkin_jacobian(kind, m->machine, axes, rows, why), why);
  const softkin_status status = softkin_singularity(kind, m->machine, axes, margins, &is_singular, why);
  write_status(m, MARGINS_STATUS, status, why);
  m->values[m->starts[IS_SINGULAR]] = status != SOFTKIN_OK || is_singular;
  write_status(m, LIMITS_STATUS, softkin_limits(kind, m->machine, axes, why), why);
}

/* Compute all outputs if an input has changed. The calls write no results where they refuse: these keep their last
 * values. */
static void answer(fmu *m) {
  softkin_refusal why = {SOFTKIN_OK, "", "", 0.0, 0, ""};
  if (!m->flags.is_stale) {
    return;
  }
  if (!m->flags.is_made) {
    make(m, &why);
  }
  find_pose(m, &why);
  find_solution(m, &why);
  find_derivatives(m, &why);
  m->flags.is_stale = false;
}

/* Whether these variables exist, have this type, and may be written where that is wanted. */
static bool is_allowed(const fmu *m, const fmi3ValueReference *references, size_t count, size_t size,
    kind_of_value wanted, bool is_written) {
  bool is_fine = m != NULL && count == size && (count == 0 || references != NULL);
  for (size_t i = 0; is_fine && i < count; i += 1) {
    is_fine = references[i] < m->starts[GROUPS] && kind_of(m, references[i]) == wanted;
    if (is_fine && is_written) {
      const int group = group_of(m, references[i]);
      is_fine = group >= PARAMETERS && group <= CONFIGURATION && !(group == PARAMETERS && m->flags.is_running);
    }
  }
  if (!is_fine && m != NULL) {
    report(m, is_written ? "no such input, or a parameter after the initialization" : "no such variable");
  }
  return is_fine;
}

static void change(fmu *m, size_t reference, double value) {
  m->values[reference] = value;
  m->flags.is_stale = true;
  m->flags.is_made = m->flags.is_made && reference >= m->starts[AXES];
}

#define VARIABLES(Name, wanted) \
  FMI_EXPORT fmi3Status FMI(Get##Name)(fmi3Instance instance, const fmi3ValueReference references[], size_t count, \
      fmi3##Name values[], size_t size) { \
    fmu *m = instance; \
    if (!is_allowed(m, references, count, size, wanted, false)) { \
      return fmi3Error; \
    } \
    answer(m); \
    for (size_t i = 0; i < count; i += 1) { \
      values[i] = (fmi3##Name)m->values[references[i]]; \
    } \
    return fmi3OK; \
  } \
  FMI_EXPORT fmi3Status FMI(Set##Name)(fmi3Instance instance, const fmi3ValueReference references[], size_t count, \
      const fmi3##Name values[], size_t size) { \
    fmu *m = instance; \
    if (!is_allowed(m, references, count, size, wanted, true)) { \
      return fmi3Error; \
    } \
    for (size_t i = 0; i < count; i += 1) { \
      change(m, references[i], (double)values[i]); \
    } \
    return fmi3OK; \
  }
VARIABLES(Float64, FLOAT64)
VARIABLES(Int8, INT8)
VARIABLES(Int32, INT32)
VARIABLES(Int64, INT64)
VARIABLES(Boolean, BOOLEAN)

FMI_EXPORT fmi3Status FMI(GetString)(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
    fmi3String values[], size_t size) {
  fmu *m = instance;
  if (!is_allowed(m, references, count, size, TEXT, false)) {
    return fmi3Error;
  }
  answer(m);
  for (size_t i = 0; i < count; i += 1) {
    values[i] = m->texts[references[i]];
  }
  return fmi3OK;
}

/* No variable has these types. */
#define NO_VARIABLES(Name) \
  FMI_EXPORT fmi3Status FMI(Get##Name)(fmi3Instance instance, const fmi3ValueReference references[], size_t count, \
      fmi3##Name values[], size_t size) { \
    (void)references, (void)values, (void)size; \
    return count == 0 ? fmi3OK : fault(instance, "no variable has this type"); \
  } \
  FMI_EXPORT fmi3Status FMI(Set##Name)(fmi3Instance instance, const fmi3ValueReference references[], size_t count, \
      const fmi3##Name values[], size_t size) { \
    (void)references, (void)values, (void)size; \
    return count == 0 ? fmi3OK : fault(instance, "no input has this type"); \
  }
NO_VARIABLES(Float32)
NO_VARIABLES(UInt8)
NO_VARIABLES(Int16)
NO_VARIABLES(UInt16)
NO_VARIABLES(UInt32)
NO_VARIABLES(UInt64)

FMI_EXPORT fmi3Status FMI(SetString)(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
    const fmi3String values[], size_t size) {
  (void)references, (void)values, (void)size;
  return count == 0 ? fmi3OK : fault(instance, "no input has this type");
}

FMI_EXPORT void FMI(FreeInstance)(fmi3Instance instance) {
  fmu *m = instance;
  if (m != NULL) {
    free(m->values);
    free((void *)m->texts);
    free(m->machine);
    free(m->parameters);
    free(m);
  }
}

static fmu *instantiate(fmi3String token, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log) {
  fmu *m = token != NULL && strcmp(token, SOFTKIN_FMU_TOKEN) == 0 ? calloc(1, sizeof *m) : NULL;
  if (m == NULL) {
    return NULL;
  }
  m->environment = environment;
  m->log = log;
  for (int group = 0; group < GROUPS; group += 1) {
    m->starts[group + 1] = m->starts[group] + size_of(group);
  }
  m->values = calloc(m->starts[GROUPS], sizeof *m->values);
  m->texts = calloc(m->starts[GROUPS], sizeof *m->texts);
  m->machine = calloc(1, kind->machine_size);
  m->parameters = calloc(1, kind->parameters_size);
  if (m->values == NULL || m->texts == NULL || m->machine == NULL || m->parameters == NULL) {
    FMI(FreeInstance)(m);
    return NULL;
  }
  begin(m);
  return m;
}

FMI_EXPORT fmi3Instance FMI(InstantiateCoSimulation)(fmi3String name, fmi3String token, fmi3String resources,
    fmi3Boolean visible, fmi3Boolean logging, fmi3Boolean event_mode, fmi3Boolean early_return,
    const fmi3ValueReference required[], size_t count, fmi3InstanceEnvironment environment,
    fmi3LogMessageCallback log, softkin_unused update) {
  (void)name, (void)resources, (void)visible, (void)logging, (void)event_mode, (void)early_return, (void)required;
  (void)count, (void)update;
  return instantiate(token, environment, log);
}

FMI_EXPORT fmi3Instance FMI(InstantiateModelExchange)(fmi3String name, fmi3String token, fmi3String resources,
    fmi3Boolean visible, fmi3Boolean logging, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log) {
  (void)name, (void)resources, (void)visible, (void)logging;
  return instantiate(token, environment, log);
}

FMI_EXPORT fmi3Instance FMI(InstantiateScheduledExecution)(void) {
  return NULL;
}

FMI_EXPORT const char *FMI(GetVersion)(void) {
  return "3.0";
}

FMI_EXPORT fmi3Status FMI(SetDebugLogging)(fmi3Instance instance, fmi3Boolean logging, size_t count,
    const fmi3String categories[]) {
  (void)logging, (void)count, (void)categories;
  return instance == NULL ? fmi3Error : fmi3OK;
}

FMI_EXPORT fmi3Status FMI(EnterInitializationMode)(fmi3Instance instance, fmi3Boolean has_tolerance,
    fmi3Float64 tolerance, fmi3Float64 start, fmi3Boolean has_stop, fmi3Float64 stop) {
  fmu *m = instance;
  (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
  if (m == NULL) {
    return fmi3Error;
  }
  m->values[TIME] = start;
  return fmi3OK;
}

/* From here on the parameters are fixed. Those that the machine refuses are an error, with its reason. */
FMI_EXPORT fmi3Status FMI(ExitInitializationMode)(fmi3Instance instance) {
  fmu *m = instance;
  softkin_refusal why = {SOFTKIN_OK, "", "", 0.0, 0, ""};
  if (m == NULL) {
    return fmi3Error;
  }
  if (make(m, &why) != SOFTKIN_OK) {
    return fault(m, why.reason);
  }
  m->flags.is_running = true;
  return fmi3OK;
}

FMI_EXPORT fmi3Status FMI(Reset)(fmi3Instance instance) {
  if (instance == NULL) {
    return fmi3Error;
  }
  begin(instance);
  return fmi3OK;
}

FMI_EXPORT fmi3Status FMI(SetTime)(fmi3Instance instance, fmi3Float64 time) {
  if (instance == NULL) {
    return fmi3Error;
  }
  ((fmu *)instance)->values[TIME] = time;
  return fmi3OK;
}

FMI_EXPORT fmi3Status FMI(DoStep)(fmi3Instance instance, fmi3Float64 time, fmi3Float64 step, fmi3Boolean is_final,
    fmi3Boolean *needs_events, fmi3Boolean *terminates, fmi3Boolean *is_early, fmi3Float64 *last) {
  (void)is_final;
  *needs_events = *terminates = *is_early = false;
  *last = time + step;
  return FMI(SetTime)(instance, time + step);
}

/* Functions of modes that nothing depends on here, as there are no states and no events. */
#define MODE(Name) \
  FMI_EXPORT fmi3Status FMI(Name)(fmi3Instance instance) { \
    return instance == NULL ? fmi3Error : fmi3OK; \
  }
MODE(EnterEventMode)
MODE(EnterStepMode)
MODE(EnterContinuousTimeMode)
MODE(EnterConfigurationMode)
MODE(ExitConfigurationMode)
MODE(EvaluateDiscreteStates)
MODE(Terminate)

FMI_EXPORT fmi3Status FMI(UpdateDiscreteStates)(fmi3Instance instance, fmi3Boolean *needs_update,
    fmi3Boolean *terminates, fmi3Boolean *changes_nominals, fmi3Boolean *changes_states, fmi3Boolean *has_next,
    fmi3Float64 *next) {
  *needs_update = *terminates = *changes_nominals = *changes_states = *has_next = false;
  *next = 0.0;
  return instance == NULL ? fmi3Error : fmi3OK;
}

FMI_EXPORT fmi3Status FMI(CompletedIntegratorStep)(fmi3Instance instance, fmi3Boolean is_final,
    fmi3Boolean *enters_events, fmi3Boolean *terminates) {
  (void)is_final;
  *enters_events = *terminates = false;
  return instance == NULL ? fmi3Error : fmi3OK;
}

#define NO_NUMBERS(Name) \
  FMI_EXPORT fmi3Status FMI(Name)(fmi3Instance instance, fmi3Float64 values[], size_t count) { \
    (void)values; \
    return count == 0 ? fmi3OK : fault(instance, "there are no states and no event indicators"); \
  }
NO_NUMBERS(GetContinuousStates)
NO_NUMBERS(GetContinuousStateDerivatives)
NO_NUMBERS(GetNominalsOfContinuousStates)
NO_NUMBERS(GetEventIndicators)

FMI_EXPORT fmi3Status FMI(SetContinuousStates)(fmi3Instance instance, const fmi3Float64 values[], size_t count) {
  (void)values;
  return count == 0 ? fmi3OK : fault(instance, "there are no states");
}

#define NO_COUNT(Name) \
  FMI_EXPORT fmi3Status FMI(Name)(fmi3Instance instance, size_t *count) { \
    *count = 0; \
    return instance == NULL ? fmi3Error : fmi3OK; \
  }
NO_COUNT(GetNumberOfContinuousStates)
NO_COUNT(GetNumberOfEventIndicators)

static size_t size_of_state(const fmu *m) {
  return sizeof(flags) + m->starts[GROUPS]*sizeof(double);
}

FMI_EXPORT fmi3Status FMI(GetFMUState)(fmi3Instance instance, fmi3FMUState *state) {
  fmu *m = instance;
  if (m == NULL || state == NULL) {
    return fmi3Error;
  }
  *state = *state == NULL ? malloc(size_of_state(m)) : *state;
  if (*state == NULL) {
    return fault(m, "no memory for the state");
  }
  answer(m);
  memcpy(*state, &m->flags, sizeof m->flags);
  memcpy((char *)*state + sizeof m->flags, m->values, size_of_state(m) - sizeof m->flags);
  return fmi3OK;
}

/* The texts of the outputs are computed again; outputs of a call that refuses keep the values of the state. */
FMI_EXPORT fmi3Status FMI(SetFMUState)(fmi3Instance instance, fmi3FMUState state) {
  fmu *m = instance;
  if (m == NULL || state == NULL) {
    return fmi3Error;
  }
  memcpy(&m->flags, state, sizeof m->flags);
  memcpy(m->values, (char *)state + sizeof m->flags, size_of_state(m) - sizeof m->flags);
  m->flags.is_made = false;
  m->flags.is_stale = true;
  return fmi3OK;
}

FMI_EXPORT fmi3Status FMI(FreeFMUState)(fmi3Instance instance, fmi3FMUState *state) {
  if (instance == NULL || state == NULL) {
    return fmi3Error;
  }
  free(*state);
  *state = NULL;
  return fmi3OK;
}

FMI_EXPORT fmi3Status FMI(SerializedFMUStateSize)(fmi3Instance instance, fmi3FMUState state, size_t *size) {
  (void)state;
  if (instance == NULL || size == NULL) {
    return fmi3Error;
  }
  *size = size_of_state(instance);
  return fmi3OK;
}

FMI_EXPORT fmi3Status FMI(SerializeFMUState)(fmi3Instance instance, fmi3FMUState state, fmi3Byte bytes[],
    size_t size) {
  if (instance == NULL || state == NULL || size != size_of_state(instance)) {
    return fault(instance, "the size of a state is another one");
  }
  memcpy(bytes, state, size);
  return fmi3OK;
}

FMI_EXPORT fmi3Status FMI(DeserializeFMUState)(fmi3Instance instance, const fmi3Byte bytes[], size_t size,
    fmi3FMUState *state) {
  if (instance == NULL || state == NULL || size != size_of_state(instance)) {
    return fault(instance, "the size of a state is another one");
  }
  *state = *state == NULL ? malloc(size) : *state;
  if (*state == NULL) {
    return fault(instance, "no memory for the state");
  }
  memcpy(*state, bytes, size);
  return fmi3OK;
}

/* Functions of abilities that modelDescription.xml does not claim; a tool may ask whether they exist. */
#define NOT_OFFERED(Name) \
  FMI_EXPORT fmi3Status FMI(Name)(fmi3Instance instance) { \
    return fault(instance, "not offered: " #Name); \
  }
NOT_OFFERED(GetBinary)
NOT_OFFERED(SetBinary)
NOT_OFFERED(GetClock)
NOT_OFFERED(SetClock)
NOT_OFFERED(GetNumberOfVariableDependencies)
NOT_OFFERED(GetVariableDependencies)
NOT_OFFERED(GetDirectionalDerivative)
NOT_OFFERED(GetAdjointDerivative)
NOT_OFFERED(GetIntervalDecimal)
NOT_OFFERED(GetIntervalFraction)
NOT_OFFERED(GetShiftDecimal)
NOT_OFFERED(GetShiftFraction)
NOT_OFFERED(SetIntervalDecimal)
NOT_OFFERED(SetIntervalFraction)
NOT_OFFERED(SetShiftDecimal)
NOT_OFFERED(SetShiftFraction)
NOT_OFFERED(GetOutputDerivatives)
NOT_OFFERED(ActivateModelPartition)
