/**
 * @file softkin_br.h
 * The functions of a custom mechanical system of B&R mapp Motion, for any machine. Each machine has a file that calls them.
 *
 * MechDimensionsAddr is the address of the dimensions of the machine: its parameters, then the bytes of its configuration
 * (0: nearest to the reference). TcpPos has X, Y, Z at 0, 1, 2; the angle about Z at 3 of a machine that turns about Z
 * alone, or A, B, C at 3, 4, 5, where the rotation is Rz(C) Ry(B) Rx(A); degrees. Coordinates that are not commanded are 0,
 * and not read. Nothing is kept between calls: every call sets its machine up in the memory that it is given.
 *
 * Info.Status.Code is a softkin_status, or SOFTKIN_BR_TOOL where the tool has no place on this machine.
 */

#ifndef SOFTKIN_BR_H
#define SOFTKIN_BR_H

#include "McPathGen.h"
#include "softkin.h"

#define SOFTKIN_BR_TOOL 100u

/* machine: memory for the machine, twice. */
McPathGenCusMechStatusEnum softkin_br_direct(
    const softkin_mechanism *kind, void *machine, struct McPathGenCusMechDirType *call);
McPathGenCusMechStatusEnum softkin_br_inverse(
    const softkin_mechanism *kind, void *machine, struct McPathGenCusMechInvType *call);
McPathGenCusMechStatusEnum softkin_br_direct_derivative(
    const softkin_mechanism *kind, void *machine, struct McPathGenCusMechDirDerType *call);
McPathGenCusMechStatusEnum softkin_br_inverse_derivative(
    const softkin_mechanism *kind, void *machine, struct McPathGenCusMechInvDerType *call);

/* The points of the drawing at joint values and the frame of the flange there. */
typedef softkin_status (*softkin_br_points)(
    const void *parameters, const double *axes, const softkin_frame *frame, double *points, softkin_refusal *why);

/* The numbers of its points, -1 for the point of the tool. */
typedef struct {
  int start, end;
} softkin_br_edge;

/* Edges have numbers from 1, and no distance; collisions are not looked for. */
McPathGenCusMechStatusEnum softkin_br_wire_frame(const softkin_mechanism *kind, void *machine, softkin_br_points find,
    const softkin_br_edge *edges, int count, struct McPathGenCusMechWMType *call);

#endif
