/* A stand-in for the headers of LinuxCNC, for tests: poses, and what a kinematics module is asked. */
#ifndef STUB_KINEMATICS_H
#define STUB_KINEMATICS_H

typedef struct {
  double x, y, z;
} PmCartesian;

typedef struct {
  PmCartesian x, y, z;
} PmRotationMatrix;

typedef struct EmcPose {
  PmCartesian tran;
  double a, b, c, u, v, w;
} EmcPose;

typedef enum {
  KINEMATICS_IDENTITY = 1,
  KINEMATICS_FORWARD_ONLY = 2,
  KINEMATICS_INVERSE_ONLY = 3,
  KINEMATICS_BOTH = 4
} KINEMATICS_TYPE;

typedef unsigned long int KINEMATICS_FORWARD_FLAGS;
typedef unsigned long int KINEMATICS_INVERSE_FLAGS;

KINEMATICS_TYPE kinematicsType(void);
int kinematicsSwitchable(void);
int kinematicsSwitch(int type);
int kinematicsForward(const double *joint, struct EmcPose *world, const KINEMATICS_FORWARD_FLAGS *fflags,
    KINEMATICS_INVERSE_FLAGS *iflags);
int kinematicsInverse(const struct EmcPose *world, double *joint, const KINEMATICS_INVERSE_FLAGS *iflags,
    KINEMATICS_FORWARD_FLAGS *fflags);

#endif
