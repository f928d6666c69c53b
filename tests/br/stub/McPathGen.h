/* The declarations of a custom mechanical system, written for the tests from what is known of them: names of structures and
 * members, lengths and types, each where a function reads or writes it. */
#ifndef MCPATHGEN_H
#define MCPATHGEN_H
#include "bur/plctypes.h"

typedef enum {
  mcPATHGEN_CUSMECH_SUCCESS, mcPATHGEN_CUSMECH_INFO, mcPATHGEN_CUSMECH_WARNING, mcPATHGEN_CUSMECH_ERROR
} McPathGenCusMechStatusEnum;

struct McTranslation {
  LREAL X, Y, Z;
};
struct McToolGeometryType {
  struct McTranslation Translation;
};
struct McStatus {
  UDINT Code;
};
struct McInfo {
  struct McStatus Status;
};
struct McParameter {
  UDINT MechDimensionsAddr;
  struct McToolGeometryType Tool;
  UDINT JointCount, TcpCount;
};

#define CALL(name, inputs, outputs) \
  struct name { \
    struct { LREAL inputs; } Input; \
    struct { LREAL outputs; } Output; \
    struct McParameter Parameter; \
    struct McInfo Info; \
  };
#define AND ,
CALL(McPathGenCusMechDirType, JointPos[15] AND TcpRefPos[15], TcpPos[15])
CALL(McPathGenCusMechInvType, TcpPos[15] AND JointRefPos[15], JointPos[15])
CALL(McPathGenCusMechDirDerType, JointPos[15] AND JointDer[15] AND TcpRefPos[15], TcpDer[15])
CALL(McPathGenCusMechInvDerType, TcpPos[15] AND TcpDer[15] AND JointRefPos[15], JointDer[15])

struct McEdge {
  UDINT ID;
  struct McTranslation Point1, Point2;
  LREAL Distance;
};
struct McPathGenCusMechWMType {
  struct { LREAL JointPos[15]; } Input;
  struct { struct McEdge Edge[16]; UDINT EdgeCount; } Output;
  struct {
    UDINT MechDimensionsAddr, WfmDescriptionAddr;
    struct McToolGeometryType Tool;
    UDINT JointCount;
    BOOL CheckSelfCollision;
  } Parameter;
  struct {
    struct McStatus Status;
    struct { BOOL Detected; UDINT EdgeID1, EdgeID2; } SelfCollision;
  } Info;
};
#endif
