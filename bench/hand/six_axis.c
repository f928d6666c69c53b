/*
 * A program for bench/in_c.py: one branch of an arm with six axes and a spherical wrist, as it is written by hand,
 * beside the generated one. The text by hand tests its reach and nothing else; with the wrist straight or on axis 1 its
 * answers are wrong. It prints the nanoseconds of a call of each, the least of all rounds, and the worst difference.
 */

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "articulatedrobot_6dof.h"

#define DEGREES (180.0/3.14159265358979323846)

enum { POSES = 256, ROUNDS = 400, CALLS = 4 };

typedef struct {
  double a1, a2, c1, c2, c3, c4, square, fold, twice;
} arm;

/* Brandstötter, Angerer, Hofbaur 2014. */
static int by_hand(const arm *k, const softkin_frame *frame, const int8_t *signs, double *axes) {
  const double(*r)[3] = frame->rotation;
  const double side = signs[0], elbow = signs[1], wrist = signs[2];
  const double x = frame->position[0] - k->c4*r[0][2], y = frame->position[1] - k->c4*r[1][2],
      z = frame->position[2] - k->c4*r[2][2] - k->c1;
  const double ahead = side*sqrt(x*x + y*y) - k->a1, first = atan2(side*y, side*x);
  const double reach = ahead*ahead + z*z, folded = (reach - k->c2*k->c2 - k->square)/k->twice;
  if (!(folded >= -1.0 && folded <= 1.0)) {
    return 1;
  }
  const double second = atan2(ahead, z) - elbow*acos((reach + k->c2*k->c2 - k->square)/(2.0*sqrt(reach)*k->c2));
  const double third = elbow*acos(folded) - k->fold;
  const double s1 = sin(first), k1 = cos(first), s = sin(second + third), c = cos(second + third);
  const double height = r[0][2]*k1 + r[1][2]*s1, straight = r[2][2]*c + height*s;
  const double bent = 1.0 - straight*straight;
  axes[0] = first*DEGREES;
  axes[1] = second*DEGREES;
  axes[2] = third*DEGREES;
  axes[3] = atan2(wrist*(r[1][2]*k1 - r[0][2]*s1), wrist*(height*c - r[2][2]*s))*DEGREES;
  axes[4] = atan2(wrist*(bent > 0.0 ? sqrt(bent) : 0.0), straight)*DEGREES;
  axes[5] = atan2(wrist*((r[0][1]*k1 + r[1][1]*s1)*s + r[2][1]*c), -wrist*((r[0][0]*k1 + r[1][0]*s1)*s + r[2][0]*c))*DEGREES;
  return 0;
}

static double seconds(void) {
  return (double)clock()/CLOCKS_PER_SEC;
}

static double drawn(unsigned *state) {
  *state = *state*1664525u + 1013904223u;
  return (double)(*state >> 8)/16777216.0;
}

/* How far the machine is from where it should be (u, and entries of the rotation times the size of the arm). */
static double missed(const articulatedrobot_6dof_machine *machine, const double *axes, const softkin_frame *frame) {
  softkin_frame found;
  double worst = 0.0;
  if (articulatedrobot_6dof_forward(machine, axes, &found, NULL, NULL) != SOFTKIN_OK) {
    return INFINITY;
  }
  for (int i = 0; i < 3; i += 1) {
    worst = fmax(worst, fabs(found.position[i] - frame->position[i]));
    for (int j = 0; j < 3; j += 1) {
      worst = fmax(worst, 1000.0*fabs(found.rotation[i][j] - frame->rotation[i][j]));
    }
  }
  return worst;
}

int main(void) {
  static softkin_frame frames[POSES];
  static int8_t signs[POSES][3];
  static const int8_t turns[6];
  const double reference[6] = {0.0};
  articulatedrobot_6dof_parameters sizes;
  articulatedrobot_6dof_machine machine;
  softkin_refusal why;
  unsigned state = 7u;
  double axes[6], least_generated = INFINITY, least_by_hand = INFINITY, sum = 0.0, worst = 0.0;
  articulatedrobot_6dof_defaults(&sizes);
  sizes.d1 = 400.0, sizes.a1 = 25.0, sizes.a2 = 455.0, sizes.a3 = 35.0, sizes.d4 = 420.0, sizes.d6 = 80.0;
  if (articulatedrobot_6dof_init(&machine, &sizes, &why) != SOFTKIN_OK) {
    return puts(why.reason), 1;
  }
  arm k = {25.0, -35.0, 400.0, 455.0, 420.0, 80.0, 0.0, 0.0, 0.0};
  k.square = k.a2*k.a2 + k.c3*k.c3;
  k.fold = atan2(k.a2, k.c3);
  k.twice = 2.0*k.c2*sqrt(k.square);
  for (int i = 0; i < POSES; i += 1) {
    int8_t bytes[9];
    do {
      for (int j = 0; j < 6; j += 1) {
        axes[j] = 340.0*drawn(&state) - 170.0;
      }
    } while (articulatedrobot_6dof_forward(&machine, axes, &frames[i], bytes, NULL) != SOFTKIN_OK);
    for (int j = 0; j < 3; j += 1) {
      signs[i][j] = bytes[j] == 2 ? -1 : 1;
    }
    if (articulatedrobot_6dof_branch(&machine, &frames[i], signs[i], turns, reference, axes, &why) != SOFTKIN_OK) {
      return puts(why.reason), 1;
    }
    worst = fmax(worst, missed(&machine, axes, &frames[i]));
    if (by_hand(&k, &frames[i], signs[i], axes) != 0) {
      return puts("by hand: out of reach"), 1;
    }
  }
  for (int round = 0; round < ROUNDS; round += 1) {
    double begun = seconds();
    for (int call = 0; call < CALLS*POSES; call += 1) {
      const int i = call % POSES;
      articulatedrobot_6dof_branch(&machine, &frames[i], signs[i], turns, reference, axes, NULL);
      sum += axes[5];
    }
    least_generated = fmin(least_generated, seconds() - begun);
    begun = seconds();
    for (int call = 0; call < CALLS*POSES; call += 1) {
      const int i = call % POSES;
      by_hand(&k, &frames[i], signs[i], axes);
      sum += axes[5];
    }
    least_by_hand = fmin(least_by_hand, seconds() - begun);
  }
  printf("%.1f %.1f %.1e\n", 1e9*least_generated/(CALLS*POSES), 1e9*least_by_hand/(CALLS*POSES), worst);
  return isfinite(sum) ? 0 : 1;
}
