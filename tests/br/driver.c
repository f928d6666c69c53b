/* One function of a machine, called with dimensions at an address of 32 bits, as on a controller. */
#define _GNU_SOURCE
#include <string.h>
#include <sys/mman.h>

#include MACHINE_HEADER

#define PASTE(a, b) a##b
#define NAMED(a, b) PASTE(a, b)
#define DIMENSIONS NAMED(MACHINE, _dimensions)
#define CALLED(name) NAMED(MACHINE, name)

static DIMENSIONS *dimensions;

int prepare(const double *parameters, const signed char *bytes, int count) {
  if (dimensions == NULL) {
    void *made = mmap(NULL, sizeof(DIMENSIONS), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_32BIT, -1, 0);
    if (made == MAP_FAILED) {
      return -1;
    }
    dimensions = made;
  }
  memcpy(dimensions, parameters, sizeof(dimensions->parameters));
  memset(dimensions->configuration, 0, sizeof(dimensions->configuration));
  memcpy(dimensions->configuration, bytes, (size_t)count);
  return (int)(sizeof(dimensions->parameters)/sizeof(double));
}

/* The status, negative where the function says that there is an error. given: 15 numbers each. */
static int run(int which, const double *tool, const double *a, const double *b, const double *c, double *found) {
#define SET(call) \
  call.Parameter.MechDimensionsAddr = (UDINT)(uintptr_t)dimensions; \
  call.Parameter.Tool.Translation.X = tool[0], call.Parameter.Tool.Translation.Y = tool[1], call.Parameter.Tool.Translation.Z = tool[2]
#define RUN(type, function, first, second, third, output) { \
    struct type call = {0}; \
    SET(call); \
    memcpy(call.Input.first, a, sizeof(call.Input.first)); \
    memcpy(call.Input.second, b, sizeof(call.Input.second)); \
    memcpy(call.Input.third, c, sizeof(call.Input.third)); \
    const McPathGenCusMechStatusEnum status = CALLED(function)(&call); \
    memcpy(found, call.Output.output, sizeof(call.Output.output)); \
    return status == mcPATHGEN_CUSMECH_SUCCESS ? (int)call.Info.Status.Code : -(int)call.Info.Status.Code; \
  }
  switch (which) {
    case 0: RUN(McPathGenCusMechDirType, _br_direct, JointPos, TcpRefPos, TcpRefPos, TcpPos)
    case 1: RUN(McPathGenCusMechInvType, _br_inverse, TcpPos, JointRefPos, JointRefPos, JointPos)
    case 2: RUN(McPathGenCusMechDirDerType, _br_direct_derivative, JointPos, JointDer, TcpRefPos, TcpDer)
    default: RUN(McPathGenCusMechInvDerType, _br_inverse_derivative, TcpPos, TcpDer, JointRefPos, JointDer)
  }
}

int call(int which, const double *tool, const double *a, const double *b, const double *c, double *found) {
  return run(which, tool, a, b, c, found);
}

#ifdef WIRE_FRAME
/* The number of edges, or the status, negative. found: both points of each edge. */
int wire_frame(const double *tool, const double *joints, double *found) {
  struct McPathGenCusMechWMType call = {0};
  SET(call);
  memcpy(call.Input.JointPos, joints, sizeof(call.Input.JointPos));
  if (CALLED(_br_wire_frame)(&call) != mcPATHGEN_CUSMECH_SUCCESS) {
    return -(int)call.Info.Status.Code;
  }
  for (UDINT i = 0; i < call.Output.EdgeCount; i += 1) {
    if (call.Output.Edge[i].ID != i + 1) {
      return -99;
    }
    memcpy(&found[6*i], &call.Output.Edge[i].Point1, 6*sizeof(double));
  }
  return (int)call.Output.EdgeCount;
}
#endif
