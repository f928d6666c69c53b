/**
 * @file softkin_br.c
 * See the header. A tool is a shift of the flange's origin; where no turn is commanded it must be one that the turns of the
 * flange do not move.
 */

#include <string.h>

#include "softkin_br.h"

#define COORDINATES 15
#define MOST_POINTS 64
#define STILL 1e-9 /* of a tool, per its length */

typedef struct {
  const softkin_mechanism *kind;
  const void *machine;
  void *moved; /* memory for the machine whose forward kinematics begins at a frame */
  const int8_t *configuration;
  double tool[3];
  int turns; /* rows that are turns: 0, 1, 3 */
} robot;

static int turns_of(const softkin_mechanism *kind) {
  int turns = 0;
  for (int i = 0; i < kind->row_count; i += 1) {
    turns += kind->rows[i][1] != '\0';
  }
  return turns;
}

/* Where a row of the Jacobian is in a position of the TCP, and in a twist: "x" or "turn x". */
static int axis_of(const char *row) {
  return row[row[1] == '\0' ? 0 : 5] - 'x';
}

static softkin_status begin(robot *one, const softkin_mechanism *kind, void *machine, UDINT address,
    const struct McToolGeometryType *tool) {
  const char *dimensions = (const char *)(uintptr_t)address;
  one->kind = kind;
  one->machine = machine;
  one->moved = (char *)machine + kind->machine_size;
  one->configuration = (const int8_t *)(dimensions + kind->parameters_size);
  one->tool[0] = tool->Translation.X, one->tool[1] = tool->Translation.Y, one->tool[2] = tool->Translation.Z;
  one->turns = turns_of(kind);
  if (dimensions == NULL) {
    return SOFTKIN_NOT_INITIALIZED;
  }
  memset(machine, 0, kind->machine_size);
  return softkin_are_reasonable(one->tool, 3) ? softkin_init(kind, machine, dimensions, NULL) : SOFTKIN_BAD_INPUT;
}

static McPathGenCusMechStatusEnum answer(unsigned status, UDINT *code) {
  *code = status;
  return status == SOFTKIN_OK ? mcPATHGEN_CUSMECH_SUCCESS : mcPATHGEN_CUSMECH_ERROR;
}

/* The tool in the directions of the machine. */
static void carried(const robot *one, const softkin_frame *frame, double *arm) {
  for (int i = 0; i < 3; i += 1) {
    const double *row = frame->rotation[i];
    arm[i] = row[0]*one->tool[0] + row[1]*one->tool[1] + row[2]*one->tool[2];
  }
}

/* Whether a machine of which no turn is commanded carries the tool as it is. */
static bool is_still(const robot *one, const softkin_frame *frame) {
  double arm[3], apart = 0.0, size = 0.0;
  carried(one, frame, arm);
  for (int i = 0; i < 3; i += 1) {
    apart = fmax(apart, fabs(arm[i] - one->tool[i]));
    size += fabs(one->tool[i]);
  }
  return one->turns > 0 || apart <= STILL*size;
}

/* The frame of the flange at a position of the TCP. down: the flange points down, of a machine that turns about Z. */
static softkin_status frame_of(const robot *one, const LREAL *tcp, bool down, softkin_frame *frame) {
  double arm[3];
  if (!softkin_are_reasonable(tcp, 3 + one->turns)) {
    return SOFTKIN_BAD_INPUT;
  }
  const double about_z[3] = {down ? 180.0 : 0.0, 0.0, one->turns == 1 ? tcp[3] : 0.0};
  softkin_rotation_of_angles(one->turns == 3 ? &tcp[3] : about_z, frame->rotation);
  carried(one, frame, arm);
  for (int i = 0; i < 3; i += 1) {
    frame->position[i] = tcp[i] - (one->turns > 0 ? arm[i] : one->tool[i]);
  }
  return SOFTKIN_OK;
}

static unsigned direct(const robot *one, const LREAL *joints, const LREAL *near, softkin_frame *frame, LREAL *tcp) {
  double arm[3];
  softkin_frame start;
  softkin_status status = frame_of(one, near, false, &start);
  if (status == SOFTKIN_OK) {
    status = softkin_forward_near(one->kind, one->machine, joints, &start, frame, NULL);
  }
  if (status != SOFTKIN_OK) {
    return status;
  }
  if (!is_still(one, frame)) {
    return SOFTKIN_BR_TOOL;
  }
  memset(tcp, 0, COORDINATES*sizeof(*tcp));
  carried(one, frame, arm);
  for (int i = 0; i < one->kind->row_count - one->turns; i += 1) {
    const int place = axis_of(one->kind->rows[i]);
    tcp[place] = frame->position[place] + arm[place];
  }
  if (one->turns == 1) {
    tcp[3] = softkin_nearest_period(atan2(frame->rotation[1][0], frame->rotation[0][0])*SOFTKIN_RADIAN, near[3]);
  } else if (one->turns == 3) {
    softkin_angles_of_rotation(frame, &near[3], &tcp[3]);
  }
  return SOFTKIN_OK;
}

static unsigned inverse(const robot *one, const LREAL *tcp, const LREAL *near, softkin_frame *frame, LREAL *joints) {
  softkin_frame there;
  LREAL commanded[6] = {0.0}, found[COORDINATES] = {0.0};
  const bool is_known = softkin_forward(one->kind, one->machine, near, NULL, &there, NULL, NULL, NULL) == SOFTKIN_OK;
  for (int i = 0; i < one->kind->row_count; i += 1) {
    const bool is_turn = one->kind->rows[i][1] != '\0';
    const int place = is_turn ? (one->turns == 1 ? 3 : 3 + axis_of(one->kind->rows[i])) : axis_of(one->kind->rows[i]);
    commanded[place] = tcp[place];
  }
  softkin_status status = frame_of(one, commanded, is_known && there.rotation[2][2] < 0.0, frame);
  if (status == SOFTKIN_OK) {
    status = softkin_inverse(one->kind, one->machine, frame, one->configuration, near, found, NULL);
  }
  if (status != SOFTKIN_OK) {
    return status;
  }
  if (one->turns == 0 && softkin_forward(one->kind, one->machine, found, NULL, &there, NULL, NULL, NULL) == SOFTKIN_OK
      && !is_still(one, &there)) {
    return SOFTKIN_BR_TOOL;
  }
  memcpy(joints, found, sizeof(found));
  return SOFTKIN_OK;
}

static void cross(const double *w, const double *arm, double *found) {
  found[0] = w[1]*arm[2] - w[2]*arm[1];
  found[1] = w[2]*arm[0] - w[0]*arm[2];
  found[2] = w[0]*arm[1] - w[1]*arm[0];
}

McPathGenCusMechStatusEnum softkin_br_direct(
    const softkin_mechanism *kind, void *machine, struct McPathGenCusMechDirType *call) {
  robot one;
  softkin_frame frame;
  unsigned status = begin(&one, kind, machine, call->Parameter.MechDimensionsAddr, &call->Parameter.Tool);
  if (status == SOFTKIN_OK) {
    status = direct(&one, call->Input.JointPos, call->Input.TcpRefPos, &frame, call->Output.TcpPos);
  }
  return answer(status, &call->Info.Status.Code);
}

McPathGenCusMechStatusEnum softkin_br_inverse(
    const softkin_mechanism *kind, void *machine, struct McPathGenCusMechInvType *call) {
  robot one;
  softkin_frame frame;
  unsigned status = begin(&one, kind, machine, call->Parameter.MechDimensionsAddr, &call->Parameter.Tool);
  if (status == SOFTKIN_OK) {
    status = inverse(&one, call->Input.TcpPos, call->Input.JointRefPos, &frame, call->Output.JointPos);
  }
  return answer(status, &call->Info.Status.Code);
}

McPathGenCusMechStatusEnum softkin_br_direct_derivative(
    const softkin_mechanism *kind, void *machine, struct McPathGenCusMechDirDerType *call) {
  robot one;
  softkin_frame frame;
  LREAL tcp[COORDINATES], rates[COORDINATES] = {0.0};
  double rows[SOFTKIN_MOST_ROWS*SOFTKIN_MOST_AXES], twist[6] = {0.0}, arm[3], swept[3];
  unsigned status = begin(&one, kind, machine, call->Parameter.MechDimensionsAddr, &call->Parameter.Tool);
  if (status == SOFTKIN_OK) {
    status = direct(&one, call->Input.JointPos, call->Input.TcpRefPos, &frame, tcp);
  }
  if (status == SOFTKIN_OK) {
    status = softkin_are_reasonable(call->Input.JointDer, kind->axis_count)
        ? softkin_jacobian_near(kind, machine, call->Input.JointPos, &frame, one.moved, rows) : SOFTKIN_BAD_INPUT;
  }
  if (status != SOFTKIN_OK) {
    return answer(status, &call->Info.Status.Code);
  }
  for (int i = 0; i < kind->row_count; i += 1) {
    double *sum = &twist[axis_of(kind->rows[i]) + (kind->rows[i][1] != '\0' ? 3 : 0)];
    for (int j = 0; j < kind->axis_count; j += 1) {
      *sum += rows[i*kind->axis_count + j]*call->Input.JointDer[j]*softkin_unit_of(kind, j);
    }
  }
  carried(&one, &frame, arm);
  cross(&twist[3], arm, swept);
  for (int i = 0; i < kind->row_count - one.turns; i += 1) {
    const int place = axis_of(kind->rows[i]);
    rates[place] = twist[place] + swept[place];
  }
  if (one.turns == 1) {
    rates[3] = twist[5]*SOFTKIN_RADIAN;
  } else if (one.turns == 3) {
    double by[3][3], system[12];
    softkin_turns_by_angles(&tcp[3], by);
    for (int i = 0; i < 3; i += 1) {
      memcpy(&system[4*i], by[i], sizeof(by[i]));
      system[4*i + 3] = twist[3 + i]*SOFTKIN_RADIAN;
    }
    if (softkin_solve(system, 3, 1) == 0.0) {
      return answer(SOFTKIN_IMPOSSIBLE, &call->Info.Status.Code);
    }
    for (int i = 0; i < 3; i += 1) {
      rates[3 + i] = system[4*i + 3];
    }
  }
  memcpy(call->Output.TcpDer, rates, sizeof(rates));
  return answer(SOFTKIN_OK, &call->Info.Status.Code);
}

McPathGenCusMechStatusEnum softkin_br_inverse_derivative(
    const softkin_mechanism *kind, void *machine, struct McPathGenCusMechInvDerType *call) {
  robot one;
  softkin_frame frame;
  LREAL joints[COORDINATES], rates[COORDINATES] = {0.0};
  const LREAL *der = call->Input.TcpDer;
  double rows[SOFTKIN_MOST_ROWS*SOFTKIN_MOST_AXES], system[SOFTKIN_MOST_ROWS*(SOFTKIN_MOST_ROWS + 1)], turn[3] = {0.0}, arm[3], swept[3];
  const int n = kind->axis_count;
  unsigned status = begin(&one, kind, machine, call->Parameter.MechDimensionsAddr, &call->Parameter.Tool);
  if (status == SOFTKIN_OK) {
    status = inverse(&one, call->Input.TcpPos, call->Input.JointRefPos, &frame, joints);
  }
  if (status == SOFTKIN_OK) {
    status = softkin_are_reasonable(der, 3 + one.turns)
        ? softkin_jacobian_near(kind, machine, joints, &frame, one.moved, rows) : SOFTKIN_BAD_INPUT;
  }
  if (status != SOFTKIN_OK) {
    return answer(status, &call->Info.Status.Code);
  }
  if (one.turns == 1) {
    turn[2] = der[3]*SOFTKIN_DEGREE;
  } else if (one.turns == 3) {
    double by[3][3];
    softkin_turns_by_angles(&call->Input.TcpPos[3], by);
    for (int i = 0; i < 3; i += 1) {
      turn[i] = (by[i][0]*der[3] + by[i][1]*der[4] + by[i][2]*der[5])*SOFTKIN_DEGREE;
    }
  }
  carried(&one, &frame, arm);
  cross(turn, arm, swept);
  for (int i = 0; i < n; i += 1) {
    const int place = axis_of(kind->rows[i]);
    for (int j = 0; j < n; j += 1) {
      system[i*(n + 1) + j] = rows[i*n + j]*softkin_unit_of(kind, j);
    }
    system[i*(n + 1) + n] = kind->rows[i][1] != '\0' ? turn[place] : der[place] - swept[place];
  }
  if (softkin_solve(system, n, 1) == 0.0) {
    return answer(SOFTKIN_IMPOSSIBLE, &call->Info.Status.Code);
  }
  for (int i = 0; i < n; i += 1) {
    rates[i] = system[i*(n + 1) + n];
  }
  memcpy(call->Output.JointDer, rates, sizeof(rates));
  return answer(SOFTKIN_OK, &call->Info.Status.Code);
}

McPathGenCusMechStatusEnum softkin_br_wire_frame(const softkin_mechanism *kind, void *machine, softkin_br_points find,
    const softkin_br_edge *edges, int count, struct McPathGenCusMechWMType *call) {
  robot one;
  softkin_frame frame;
  double points[3*MOST_POINTS], arm[3], tip[3];
  const void *dimensions = (const void *)(uintptr_t)call->Parameter.MechDimensionsAddr;
  unsigned status = begin(&one, kind, machine, call->Parameter.MechDimensionsAddr, &call->Parameter.Tool);
  if (status == SOFTKIN_OK) {
    status = softkin_forward(kind, machine, call->Input.JointPos, NULL, &frame, NULL, NULL, NULL);
  }
  if (status == SOFTKIN_OK) {
    status = find(dimensions, call->Input.JointPos, &frame, points, NULL);
  }
  if (status != SOFTKIN_OK) {
    return answer(status, &call->Info.Status.Code);
  }
  carried(&one, &frame, arm);
  for (int i = 0; i < 3; i += 1) {
    tip[i] = frame.position[i] + arm[i];
  }
  for (int i = 0; i < count; i += 1) {
    const double *start = edges[i].start < 0 ? tip : &points[3*edges[i].start];
    const double *end = edges[i].end < 0 ? tip : &points[3*edges[i].end];
    call->Output.Edge[i].ID = (UDINT)i + 1u;
    call->Output.Edge[i].Point1.X = start[0], call->Output.Edge[i].Point1.Y = start[1], call->Output.Edge[i].Point1.Z = start[2];
    call->Output.Edge[i].Point2.X = end[0], call->Output.Edge[i].Point2.Y = end[1], call->Output.Edge[i].Point2.Z = end[2];
    call->Output.Edge[i].Distance = 0.0;
  }
  call->Output.EdgeCount = (UDINT)count;
  call->Info.SelfCollision.Detected = 0;
  return answer(SOFTKIN_OK, &call->Info.Status.Code);
}
